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
    """Run everyone in turn until each has had its time; what is slow runs once."""
    spent = {id(entrant): sum(entrant.times) for entrant in entrants}
    with undisturbed():
        for _ in range(MOST_RUNS):
            waiting = [
                entrant
                for entrant in entrants
                if not entrant.times or spent[id(entrant)] + entrant.seconds <= seconds_each
            ]
            if not waiting:
                return
            for entrant in waiting:
                entrant.times.append(entrant.run())
                spent[id(entrant)] += entrant.times[-1]


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
