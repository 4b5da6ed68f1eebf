"""From flat equations to the tape of a model: its signals, rates, starts, events and memories."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from tracewire.compile.events import lower_events
from tracewire.compile.flat import Flat
from tracewire.compile.holding import modes_read
from tracewire.compile.lowered import Lowered
from tracewire.compile.lowering import Lowering
from tracewire.compile.memory import declare_memories, lower_memories
from tracewire.compile.solve_loops import lower_loop
from tracewire.formula import CONSTANTS


def lower(flat: Flat) -> Lowered:
    """The tape of flat equations.

    Two things are known when all rates are, and where they are so all is lowered again. A
    comparison may move the rate of what it compares: it is part of a law that may slide. What reads
    only modes is compared on the spot, and needs no guard; not so where a slide may hold one of
    these modes.
    """
    first, laws = _lowering(flat), frozenset[tuple[str, str]]()
    if first.compared and (laws := first.moving_laws()):
        first = _lowering(flat, laws=laws)
    found = first.out
    if not first.on_the_spot:
        return found
    held = first.holding() & modes_read(first.tape, first.on_the_spot)
    if not held:
        return found
    return _lowering(flat, {(found.modes[i].signal, found.modes[i].text) for i in held}, laws).out


def _lowering(
    flat: Flat, held: Collection[tuple[str, str]] = (), laws: Collection[tuple[str, str]] = ()
) -> Lowering:
    """The flat equations on a new tape; `held` are the modes that a slide may hold, `laws` the
    comparisons that move what they compare."""
    lowering = Lowering(flat, held, laws)
    out, tape = lowering.out, lowering.tape
    out.entries["t"] = lowering.t
    for name, value in CONSTANTS.items():
        out.entries[name] = tape.constant(value)
    for number, name in enumerate(flat.parameters):
        out.entries[name] = tape.push("param", payload=number)
    for number, state in enumerate(flat.states):
        entry = tape.push("state", payload=number)
        out.entries[state.name] = entry
        out.states.append(entry)
    declare_memories(lowering)
    out.tables = [*flat.tables, *flat.inputs]
    for name in flat.inputs:
        lowering.signal = name
        out.entries[name] = lowering.interpolated(lowering.t, name)
    loops = {loop.unknowns[0]: loop for loop in flat.loops}
    for name, formula in flat.signals.items():
        if name in loops:
            lower_loop(lowering, loops[name])
        elif name not in out.entries:
            lowering.signal = name
            out.entries[name] = lowering.lower(formula)
    for state in flat.states:
        lowering.signal = state.name
        out.rates.append(lowering.lower(state.rate))
        out.starts.append(lowering.start(state.start, state.name, state.place))
    lower_events(lowering)
    lower_memories(lowering)
    number = 0
    while number < len(out.delays):  # the signal of one may read another
        signal = list(lowering.delayed)[number][0]
        lowering.signal = out.modes[out.delays[number].mode].signal
        out.delays[number] = replace(out.delays[number], signal=lowering.lower(signal))
        number += 1
    return lowering
