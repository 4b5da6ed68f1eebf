"""States that events alone change: what counts, holds or samples, and has no rate."""

from __future__ import annotations

from collections.abc import Iterable

from tracewire.compile.flat import Flat, FlatEvent
from tracewire.formula import Expression, Number, names_of


def kept_states(flat: Flat) -> frozenset[int]:
    """The numbers of the states that stand still between events.

    They have no rate, and no contact pushes them: while one rests, the states that its reset jumps
    are under its force.
    """
    kept = {state.name for state in flat.states if state.rate == Number(0.0)}
    for event in flat.events:
        if not kept.isdisjoint(event.set) and _may_rest(flat, event):
            kept.difference_update(event.set)
    return frozenset(number for number, state in enumerate(flat.states) if state.name in kept)


def _may_rest(flat: Flat, event: FlatEvent) -> bool:
    """Whether a reset may be that of a contact: it writes a rate of its guard, and no place."""
    if event.clocked:
        return False
    rates = {state.name: state.rate for state in flat.states}
    places = _states_read(flat, [event.when])
    turned = _states_read(flat, [rates[name] for name in places])
    return places.isdisjoint(event.set) and not turned.isdisjoint(event.set)


def _states_read(flat: Flat, formulas: Iterable[Expression]) -> set[str]:
    """The names of the states that formulas read, by whatever signals."""
    states = {state.name for state in flat.states}
    due = [name for formula in formulas for name in names_of(formula)]
    seen: set[str] = set()
    while due:
        name = due.pop()
        if name not in seen:
            seen.add(name)
            due += names_of(flat.signals[name]) if name in flat.signals else ()
    return seen & states
