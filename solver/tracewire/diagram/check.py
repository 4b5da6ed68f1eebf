"""The wiring of one diagram: every name that it uses exists, and is of the right kind."""

from __future__ import annotations

from tracewire.diagram.body import Body, Reference
from tracewire.diagram.diagram import Diagram
from tracewire.diagram.names import (
    events,
    find_event,
    find_signal,
    find_state,
    outputs_of,
    own_states,
    signals,
    split_index,
)
from tracewire.diagram.problems import clip
from tracewire.errors import Location
from tracewire.formula import is_name, number_hint


def check_names(diagram: Diagram, body: Body) -> None:
    """Note each name in a formula, wire, reset or output that does not exist in the diagram."""
    for reference in body.references:
        if not _exists(diagram, reference) and not body.problems.skips():
            _explain(diagram, reference, body)
    for reference, crosses in body.happenings:
        _check_happening(diagram, reference, crosses, body)
    for name, place in body.resets:
        _check_reset(diagram, name, place, body)
    _check_outputs(diagram, body)


def _exists(diagram: Diagram, reference: Reference) -> bool:
    name, sees = reference.name, reference.sees
    if sees != "signal" and name in diagram.parameters:
        return True
    if sees == "either" and name == "t":
        return True
    return sees != "parameter" and find_signal(diagram, name) is not None


def _explain(diagram: Diagram, reference: Reference, body: Body) -> None:
    name, sees, place = reference.name, reference.sees, reference.place
    problems, shown = body.problems, clip(reference.name)
    head, _, port = name.partition(".")
    use = diagram.blocks.get(head)
    is_signal = find_signal(diagram, name) is not None
    length = sum(use.row == head for use in diagram.blocks.values())
    if length and sees != "parameter":
        what = f"'{head}' is a row of {length} blocks, and '{shown}' is no signal"
        end = f".{port}" if port else ""
        hint = f"Name one, as in {head}.first{end}, {head}.last{end} or {head}_2{end}"
        problems.add(what, place, (), f"{hint}; in a list {head}.all{end}.")
        return
    if sees == "parameter" and (is_signal or name == "t"):
        what = f"'{shown}' is {'the time' if name == 't' else 'a signal'}, and a value is fixed"
        hint = "A value may use parameters only; for a formula of signals use an expression block."
        problems.add(what, place, tuple(sorted(diagram.parameters)), hint)
    elif sees == "parameter":
        hint = number_hint(name) or _new_parameter(name)
        problems.unknown("parameter", name, diagram.parameters, place, hint)
    elif sees == "signal" and name in diagram.parameters:
        hint = "Put it into a block of type constant, and name that."
        problems.add(f"'{shown}' is a parameter, and not a signal", place, (), hint)
    elif sees == "signal" and name == "t":
        hint = "Use a block of type time or expression."
        problems.add("'t' is the time, and not a signal", place, (), hint)
    elif use is not None:
        outputs = outputs_of(use, diagram.library) or ()
        several = tuple(f"{head}.{output}" for output in outputs)
        if port:
            problems.unknown("output", name, several, place)
        else:
            what = f"block '{head}' has {len(outputs) or 'no'} outputs"
            problems.add(what, place, several, "Name one of them." if outputs else "")
    elif sees == "signal":
        problems.unknown("signal", name, signals(diagram), place)
    else:
        existing = [*signals(diagram), *diagram.parameters, "t"]
        problems.unknown("signal or parameter", name, existing, place, _new_parameter(name))


def _new_parameter(name: str) -> str:
    """What to write where a parameter is meant that is not there yet."""
    return f"A new parameter is written parameters: {{{clip(name)}: ...}}." if is_name(name) else ""


def _check_happening(
    diagram: Diagram, reference: Reference, crosses: Location | None, body: Body
) -> None:
    """A name that stands alone as `when`: the event of a block, else a signal."""
    name, head = reference.name, reference.name.partition(".")[0]
    event = find_event(diagram, name)
    if event is not None:
        if crosses is not None:
            what = f"'{clip(name)}' is an event of a block, which has a direction of its own"
            body.problems.add(what, crosses, (), "Take 'crosses' away.")
    elif not _exists(diagram, reference) and not body.problems.skips():
        there = [name for name in events(diagram) if name.startswith(f"{head}.")]
        if there:
            known = [*there, *(s for s in signals(diagram) if s.startswith(f"{head}."))]
            body.problems.unknown("event or output", name, known, reference.place)
        else:
            _explain(diagram, reference, body)


def _check_reset(diagram: Diagram, name: str, place: Location, body: Body) -> None:
    head = split_index(name)[0].partition(".")[0]
    use = diagram.blocks.get(head)
    inside = use is not None and use.subsystem is not None
    if not inside and find_state(diagram, name) is not None:
        return
    several = [state for state in own_states(diagram) if state.startswith(f"{head}.")]
    if use is not None and name == head and not inside and len(several) != 1:
        count = len(several) or "no"
        what = f"block '{name}' has {count} states, and an event sets one"
        body.problems.add(what, place, tuple(several or own_states(diagram)))
    else:
        body.problems.unknown("state", name, own_states(diagram), place)


def _check_outputs(diagram: Diagram, body: Body) -> None:
    """An output port may have the name of a part of the subsystem only if it carries just that.

    Both have the same path from outside, so that `bearing.torque` would mean two things.
    """
    for name, wire in diagram.outputs.items():
        carried = find_signal(diagram, wire.signal)
        itself = carried == find_signal(diagram, name) and not (wire.negative or wire.index)
        if carried and name in body.defined and not itself:
            kind, place = body.defined[name]
            what = f"two definitions of '{name}': an output here, and {kind} in line {place.line}"
            body.problems.add(what, wire.place, (), "Rename one.")
