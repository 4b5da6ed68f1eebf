"""What is wrong with the modes, transitions and events of a block declaration."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from tracewire.errors import Location, Problem, unknown
from tracewire.formula import is_name
from tracewire.library.check_formula import Use, check_formula
from tracewire.library.parts import ByMode, Event, Parts, Transition

DIRECTIONS = ("up", "down", "both")
KINDS = ("reset", "impact")


def check_memory(
    block: Parts, visible: Mapping[str, Use], fixed: Mapping[str, Use], place: Location
) -> list[Problem]:
    """Every problem of modes, transitions and events, in this order.

    `visible` is what formulas of the block may read, `fixed` what does not change during a run.
    """
    problems = [*_check_modes(block, visible, place)]
    for transition in block.transitions:
        problems += _check_transition(block, transition, visible, place)
    problems += _check_reached(block, place)
    names = [event.name for event in block.events]
    outputs = {output.name for output in block.outputs}
    for name in dict.fromkeys(names):
        if names.count(name) > 1:
            hint = "One event may have several guards: when=(..., ...)."
            problems.append(Problem(f"two events are called '{name}'", place, (), hint))
        if name in outputs:
            what = f"'{name}' is an event and an output"
            hint = "A diagram could not tell which of them it names: rename one."
            problems.append(Problem(what, place, (), hint))
    for event in block.events:
        problems += _check_event(block, event, visible, fixed, place)
    clocks = [event.name for event in block.events if event.every is not None]
    for port in block.inputs:
        if port.sampled is not None and port.sampled not in clocks:
            hint = f"It samples the port '{port.name}'."
            problems.append(unknown("clock", port.sampled, clocks, place, hint))
    return problems


def formulas(block: Parts, given: ByMode, what: str, place: Location) -> Iterator[str | Problem]:
    """The texts of a formula, one for each mode where it has several, and problems of that form."""
    if isinstance(given, str):
        yield given
        return
    modes = [mode.name for mode in block.modes]
    for name, text in given.items():
        yield text if name in modes else unknown("mode", name, modes, place, f"It is of {what}.")
    missing = [name for name in modes if name not in given]
    if missing:
        yield Problem(f"{what} has no formula for the mode {' and '.join(missing)}", place)
    if not modes and not given:
        yield Problem(f"{what} has no formula", place)


def check_by_mode(
    block: Parts, given: ByMode, what: str, visible: Mapping[str, Use], place: Location
) -> list[Problem]:
    """The problems of a formula that may be one for each mode."""
    problems: list[Problem] = []
    for item in formulas(block, given, what, place):
        problems += [item] if isinstance(item, Problem) else check_formula(item, visible, place)
    return problems


def _check_modes(block: Parts, visible: Mapping[str, Use], place: Location) -> Iterator[Problem]:
    names = [mode.name for mode in block.modes]
    if len(names) == 1:
        hint = "Declare a second one, or none."
        yield Problem(f"'{names[0]}' is the only mode of the block", place, (), hint)
    for name in dict.fromkeys(names):
        if not is_name(name):
            hint = "Use letters, digits and _, and no word of the formula language."
            yield Problem(f"'{name}' cannot be the name of a mode", place, (), hint)
        if names.count(name) > 1:
            yield Problem(f"two modes are called '{name}'", place)
    without = {name: use for name, use in visible.items() if name != "mode"}
    for mode in block.modes:
        if mode.start is not None:
            yield from check_formula(mode.start, without, place, condition=True)


def _check_transition(
    block: Parts, transition: Transition, visible: Mapping[str, Use], place: Location
) -> list[Problem]:
    modes = [mode.name for mode in block.modes]
    ends = (transition.source, transition.target)
    shown = f"the transition from '{ends[0]}' to '{ends[1]}'"
    problems = [
        unknown("mode", name, modes, place, f"It is of {shown}.")
        for name in dict.fromkeys(ends)
        if name not in modes
    ]
    if ends[0] == ends[1]:
        hint = "It would never end; a reset that changes no mode is an event."
        problems.append(Problem(f"{shown} leads nowhere", place, (), hint))
    problems += check_formula(transition.when, visible, place, condition=True)
    return problems + _check_set(block, transition.set, shown, visible, place)


def _check_reached(block: Parts, place: Location) -> list[Problem]:
    """The modes that no run can reach: no start, and no way from one that is."""
    reached = {mode.name for mode in block.modes if mode.start is not None}
    reached |= {mode.name for mode in block.modes[:1]}
    for _ in block.modes:  # as often as a way can be long; networkx would be slow to import
        reached |= {move.target for move in block.transitions if move.source in reached}
    return [
        Problem(
            f"the mode '{mode.name}' is never reached",
            place,
            (),
            "Give it a start condition, or a transition that leads to it.",
        )
        for mode in block.modes
        if mode.name not in reached
    ]


def _check_event(
    block: Parts,
    event: Event,
    visible: Mapping[str, Use],
    fixed: Mapping[str, Use],
    place: Location,
) -> list[Problem]:
    shown, problems = f"event '{event.name}'", []
    if not is_name(event.name):
        hint = "Use letters, digits and _, and no word of the formula language."
        problems.append(Problem(f"'{event.name}' cannot be the name of an event", place, (), hint))
    if bool(event.guards) == (event.every is not None):
        what = f"{shown} needs 'when' or 'every'{', and not both' if event.guards else ''}"
        problems.append(Problem(what, place))
    for kind, word, allowed in (
        ("direction", event.crosses, DIRECTIONS),
        ("kind of event", event.kind, KINDS),
    ):
        if word not in allowed:
            problems.append(unknown(kind, word, allowed, place))
    for guard in event.guards:
        problems += check_formula(guard, visible, place)
    if event.every is not None:
        problems += check_formula(event.every, fixed, place)
        problems += check_formula(event.offset, fixed, place)
    if not event.set:
        hint = "Say which: set={state: formula}."
        problems.append(Problem(f"{shown} sets no state", place, (), hint))
    return problems + _check_set(block, event.set, shown, visible, place)


def _check_set(
    block: Parts,
    values: Mapping[str, ByMode],
    shown: str,
    visible: Mapping[str, Use],
    place: Location,
) -> list[Problem]:
    states = [state.name for state in block.states]
    problems = []
    for name, formula in values.items():
        if name not in states:
            problems.append(unknown("state", name, states, place, f"It is set by {shown}."))
        problems += check_by_mode(block, formula, f"what {shown} sets", visible, place)
    return problems
