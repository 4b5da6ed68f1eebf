"""When a friction sticks, and which signals it holds then."""

from __future__ import annotations

from collections.abc import Iterable

from tracewire.errors import FormulaError
from tracewire.formula import Name, names_of, parse
from tracewire.solve import Run

Interval = tuple[float, float]


def stick_intervals(run: Run) -> dict[str, list[Interval]]:
    """The times in s during which a block sticks, by block.

    A block whose first event is a slip stuck from the start; one that does not slip again sticks to
    the end.
    """
    found: dict[str, list[Interval]] = {}
    for (block, _), intervals in _by_guard(run).items():
        found.setdefault(block, []).extend(intervals)
    return found


def held_intervals(run: Run) -> dict[str, list[Interval]]:
    """The times in s during which a recorded signal is held by a friction that sticks, by signal.

    Held is the rate that the friction reads, the state whose rate that is, and the force of the
    friction itself, which is then what the others leave.
    """
    states = run.model.flat.states if run.model is not None else ()
    found: dict[str, list[Interval]] = {}
    for (block, guard), intervals in _by_guard(run).items():
        try:
            rates = set(names_of(parse(guard)))
        except FormulaError:  # a guard that is told in words
            rates = set()
        held = {
            state.name
            for state in states
            if isinstance(state.rate, Name) and state.rate.name in rates
        }
        for name in run.signals:
            if name in rates | held | {block}:
                found.setdefault(name, []).extend(intervals)
    return {name: join_intervals(intervals) for name, intervals in found.items()}


def join_intervals(intervals: Iterable[Interval], apart: float = 0.0) -> list[Interval]:
    """Intervals in their order, where those that overlap, or are `apart` at most, are one."""
    found: list[Interval] = []
    for begin, end in sorted(intervals):
        if found and begin <= found[-1][1] + apart:
            found[-1] = (found[-1][0], max(end, found[-1][1]))
        else:
            found.append((begin, end))
    return found


def _by_guard(run: Run) -> dict[tuple[str, str], list[Interval]]:
    """The times during which a block sticks, by the block and the guard that it sticks at."""
    begin, end = float(run.t[0]), float(run.t[-1])
    since: dict[tuple[str, str], float] = {}
    found: dict[tuple[str, str], list[Interval]] = {}
    known: set[tuple[str, str]] = set()
    for event in run.events:
        key = (event.block, event.guard)
        if event.kind == "stick":
            since.setdefault(key, event.time)
        elif event.kind == "slip" and (key in since or key not in known):
            found.setdefault(key, []).append((since.pop(key, begin), event.time))
        known.add(key)
    for key, time in since.items():
        found.setdefault(key, []).append((time, end))
    return found
