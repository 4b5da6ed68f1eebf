"""Events on the tape: the reset of each, and what triggers it."""

from __future__ import annotations

from dataclasses import replace

from tracewire.compile.flat import FlatEvent
from tracewire.compile.jump_events import lower_jumps, only_jumps
from tracewire.compile.lowered import Direction, Reset
from tracewire.compile.lowering import Lowering
from tracewire.compile.memory import values_of


def lower_events(lowering: Lowering) -> None:
    """The resets that have a trigger of their own, in the order of the events."""
    out = lowering.out
    claimed: set[int] = set()
    for event in lowering.flat.events:
        lowering.signal = event.block or event.name
        if not event.clocked and only_jumps(lowering, guard := lowering.lower(event.when)):
            lower_jumps(lowering, event, guard, len(out.resets))
            values = values_of(lowering, event.set)
            out.resets.append(Reset(event.name, "reset", -1, "both", values, event.place))
            continue
        trigger, direction = _trigger(lowering, event)
        if event.block and trigger not in claimed:  # is_held() may have made the mode before
            out.modes[trigger] = replace(out.modes[trigger], signal=event.block)
        claimed.add(trigger)
        values = values_of(lowering, event.set)
        owner = event.block or event.name
        out.resets.append(
            Reset(event.name, event.kind, trigger, direction, values, event.place, owner)
        )


def _trigger(lowering: Lowering, event: FlatEvent) -> tuple[int, Direction]:
    if event.clocked:
        modes, text = lowering.out.modes, f"clock of {event.block or event.name}"
        before = len(modes)
        guard = lowering.lower(event.when)
        modes[before:] = [replace(mode, jumps="clock") for mode in modes[before:]]
        return lowering.mode("floor", guard, text), "up"
    leaf = lowering.condition(event.when, strict=False)
    trigger, level = lowering.side(leaf)
    turned: dict[Direction, Direction] = {"up": "down", "down": "up"}
    return trigger, event.crosses if level else turned.get(event.crosses, "both")
