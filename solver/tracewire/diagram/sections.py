"""The sections that every diagram and subsystem may have, but for its blocks."""

from __future__ import annotations

from typing import get_args

from tracewire.diagram.body import Body
from tracewire.diagram.diagram import Crosses, Event, InputPort, Shown, Value, Wire
from tracewire.diagram.grammar import EVENT, INPUT, MEASURED_INPUT
from tracewire.diagram.problems import clip
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.diagram.values import NO_UNIT, read_formula, read_value
from tracewire.diagram.wires import read_wire
from tracewire.errors import FormulaError
from tracewire.formula import Call, Expression, Name, Number, is_name, name_hint, parse_condition

CROSSES: dict[str, Crosses] = {word: word for word in get_args(Crosses)}
RISING = {">": True, ">=": True, "<": False, "<=": False}
"""Whether left less right rises where a comparison becomes true."""


def read_inputs(node: Node, body: Body) -> dict[str, InputPort]:
    """`inputs`: a list of names, or a mapping of names to {unit, default}."""
    found: dict[str, InputPort] = {}
    if not isinstance(node, Entries):
        for name in body.scalars(node, "'inputs'"):
            body.define("an input", name)
            found.setdefault(name.text, InputPort(name.text, place=body.place(name)))
        return found
    for text, key, value in node:
        body.define("an input", key)
        properties = body.entries(value, f"input '{clip(text)}'", "{unit: N m, default: 0}")
        unit, default, shown = NO_UNIT, None, Shown()
        if properties is not None:
            measured = not (MEASURED_INPUT.keys() - INPUT.keys()).isdisjoint(properties.keys)
            hint = "It belongs to the record: measured: {run: {inputs: {...}}}." if measured else ""
            body.check_keys(properties, INPUT, "key of an input", hint=hint)
            _, shown = body.shown(properties)
            if "unit" in properties.values:
                unit = body.unit(properties.values["unit"])
            if "default" in properties.values:
                default = read_value(properties.values["default"], body, unit=unit, fit=False)
        found[text] = InputPort(text, unit.text, default, body.place(key), shown)
    return found


def read_outputs(node: Node, body: Body) -> dict[str, Wire]:
    """`outputs` of a subsystem: a mapping of ports to signals, or a list of signals."""
    found: dict[str, Wire] = {}
    if isinstance(node, Entries):
        named = list(node)
    else:
        scalars = body.scalars(node, "'outputs'")
        named = [(scalar.text, scalar, scalar) for scalar in scalars]
    for name, key, value in named:
        if name in found:
            what = f"two definitions of the output '{clip(name)}'"
            body.problems.add(what, body.place(key), (), "Remove or rename one.")
        elif not is_name(name):
            hint = f"{name_hint(name)} A port gets a name by 'outputs: {{name: signal}}'."
            what = f"'{clip(name)}' cannot be the name of an output"
            body.problems.add(what, body.place(key), (), hint)
        else:
            wire = read_wire(value, body, f"output '{name}'")
            found[name] = Wire("", place=body.place(key)) if wire is None else wire
    return found


def read_parameters(node: Node, body: Body) -> dict[str, Value]:
    """`parameters`: a mapping of names to values."""
    found: dict[str, Value] = {}
    entries = body.entries(node, "'parameters'", "{k: 2.5, J: {value: 4e-4, unit: kg m^2}}")
    for name, key, given in entries or ():
        body.define("a parameter", key)
        value = read_value(given, body)
        # a name that is there with a wrong value shall not be called unknown elsewhere too
        found[name] = Value(Number(0.0), place=body.place(key)) if value is None else value
    return found


def read_events(node: Node, body: Body) -> tuple[Event, ...]:
    """`events`: a list of {when, crosses, set}, or of {every, offset, set}."""
    if not isinstance(node, Items):
        hint = "Write it like [{when: theta - 1, crosses: up, set: {omega: -omega}}]."
        body.problems.add("'events' must be a list", body.place(node), (), hint)
        return ()
    events = (_read_event(item, body) for item in node.items)
    return tuple(event for event in events if event is not None)


def _read_event(node: Node, body: Body) -> Event | None:
    entries = body.entries(node, "an event", "{when: theta - 1, crosses: up, set: {omega: 0}}")
    if entries is None:
        return None
    body.check_keys(entries, EVENT, "key of an event")
    crosses: Crosses = "both"
    if "crosses" in entries.values:
        given = entries.values["crosses"]
        word = body.text(given, "'crosses'") or ""
        if word in CROSSES:
            crosses = CROSSES[word]
        else:
            body.problems.unknown("direction", word, CROSSES, body.place(given))
    is_clock = "every" in entries.values
    when = None if is_clock else _read_when(entries, body)
    if not is_clock and _comparison(entries.values.get("when", node)) is not None:
        crosses = "up"
    every = _read_clock(entries, body) if is_clock else None
    offset = None
    if "offset" in entries.values:
        offset = read_value(entries.values["offset"], body, fit=False)
        if not is_clock:
            what = "only a clock has 'offset'"
            hint = "Write every: ... for an event that happens in equal intervals."
            body.problems.add(what, body.place(entries.values["offset"]), (), hint)
    set_node = body.required(entries, "set", "an event")
    resets: dict[str, Expression] = {}
    if set_node is not None:
        states = body.entries(set_node, "'set' of an event", "{omega: -0.5*omega}")
        for name, key, given in states or ():
            formula = read_formula(given, body, "either")
            body.resets.append((name, body.place(key)))
            if formula is not None:
                resets[name] = formula
        if states is not None and not states.keys:
            body.problems.add("an event must set a state", body.place(set_node))
    if when is None and every is None:
        return None
    return Event(when, crosses, resets, every, offset, body.place(entries))


def _read_when(entries: Entries, body: Body) -> Expression | None:
    """`when` of an event: a formula, or the name of an event of a block."""
    node = body.required(entries, "when", "an event")
    comparison = None if node is None else _comparison(node)
    if comparison is not None and node is not None:
        return _read_comparison(node, comparison, entries, body)
    when = None if node is None else read_formula(node, body, "either")
    if isinstance(when, Name) and "." in when.name:
        crosses = entries.values.get("crosses")
        place = None if crosses is None else body.place(crosses)
        body.happenings.append((body.references.pop(), place))
    return when


def _comparison(node: Node) -> Call | None:
    """The condition that `when` is, where it is one."""
    try:
        condition = parse_condition(node.text) if isinstance(node, Scalar) else None
    except FormulaError:
        return None
    return condition if isinstance(condition, Call) else None


def _read_comparison(
    node: Node, condition: Call, entries: Entries, body: Body
) -> Expression | None:
    """`a > b` as the formula a - b: it crosses zero upwards where the comparison becomes true."""
    if condition.function not in RISING:
        what = "an event happens where one comparison becomes true, and this joins several"
        hint = "Write an event for each, or a number that crosses zero, such as max(a, b)."
        body.problems.add(what, body.place(node), (), hint)
        return None
    if "crosses" in entries.values:
        what = "a comparison happens where it becomes true, and has no 'crosses'"
        hint = "Leave 'crosses' out, or write when: a - b."
        body.problems.add(what, body.place(entries.values["crosses"]), (), hint)
    if read_formula(node, body, "either", condition=True) is None:
        return None
    left, right = condition.arguments
    return Call("-", (left, right) if RISING[condition.function] else (right, left))


def _read_clock(entries: Entries, body: Body) -> Value | None:
    """`every` of an event: a period in s."""
    for key in ("when", "crosses"):
        if key in entries.values:
            what = f"an event has 'every' or '{key}', and not both"
            body.problems.add(what, body.place(entries.values[key]), (), "Take one away.")
    node = entries.values["every"]
    period = read_value(node, body, fit=False)
    if period is not None and isinstance(period.formula, Number):
        length = period.formula.value * period.factor
        if not length > 0:
            what = f"the period of a clock must be above zero, not {length:g} s"
            body.problems.add(what, body.place(node))
    return period


def read_title(node: Node, body: Body) -> str:
    """`title`: any text."""
    if isinstance(node, Scalar) and node.style in ("|", ">"):
        return " ".join(node.text.split())
    return body.text(node, "'title'") or ""
