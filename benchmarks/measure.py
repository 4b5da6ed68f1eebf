"""Times: the least of many runs, taken in turn so that a slow moment hits everyone."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

MOST_RUNS = 200


@dataclass
class Entrant:
    """Something to time: `run` returns its seconds. `times` may hold earlier runs."""

    name: str
    run: Callable[[], float]
    times: list[float] = field(default_factory=list)

    @property
    def seconds(self) -> float:
        """The least time."""
        return min(self.times)


@contextmanager
def undisturbed() -> Iterator[None]:
    """No garbage collection while times are taken."""
    gc.collect()
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


def in_turn(entrants: list[Entrant], seconds_each: float) -> None:
    """Run everyone in turn until each has had its time; what is slow runs once.

    The runs of each are spread over all turns: if the fast ones went on alone at the end, a slow
    moment before would hit only the others.
    """
    with undisturbed():
        for entrant in entrants:
            if not entrant.times:
                entrant.times.append(entrant.run())
        counts = [_runs_left(entrant, seconds_each) for entrant in entrants]
        turns = max(counts, default=0)
        for turn in range(turns):
            for entrant, count in zip(entrants, counts, strict=True):
                if (turn + 1) * count // turns > turn * count // turns:
                    entrant.times.append(entrant.run())


def _runs_left(entrant: Entrant, seconds_each: float) -> int:
    """How many more runs fit in the time that an entrant has."""
    left = seconds_each - sum(entrant.times)
    return max(0, min(MOST_RUNS - len(entrant.times), int(left / entrant.seconds)))


def seconds_of(work: Callable[[], object]) -> float:
    """The time of one call, in s."""
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def least(work: Callable[[], object], seconds: float) -> float:
    """The least time of as many calls as fit in `seconds`, at least one."""
    entrant = Entrant("", lambda: seconds_of(work))
    in_turn([entrant], seconds)
    return entrant.seconds
