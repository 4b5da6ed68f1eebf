"""Plain numbers with units in a measured series: times, counts, sizes of a column."""

from __future__ import annotations

from tracewire.diagram.body import Body
from tracewire.diagram.grammar import TIME
from tracewire.diagram.strict import Entries, Node
from tracewire.formula import Unit, quantity_hint, same_quantity

SECOND = Unit("s", 1.0)


def read_time(node: Node, body: Body, what: str) -> float | None:
    """A time in s: a number, or {value: 10, unit: ms}."""
    if not isinstance(node, Entries):
        return body.number(node, what)
    body.check_keys(node, TIME, "key of a time")
    given = body.required(node, "value", what)
    value = None if given is None else body.number(given, what)
    unit = SECOND if "unit" not in node.values else read_unit_like(node.values["unit"], body, "s")
    return None if value is None else value * unit.factor


def read_unit_like(node: Node, body: Body, quantity: str) -> Unit:
    """A unit of the same quantity as another, such as ms for s; a problem is noted if not."""
    unit = body.unit(node)
    text = body.text(node, "a unit") or ""
    if unit.text and text != quantity and not same_quantity(text, quantity):
        what, hint = f"'{text}' is not a unit like '{quantity or 1}'", quantity_hint(text, quantity)
        body.problems.add(what, body.place(node), (), hint)
        return Unit(quantity, 1.0)
    return unit


def read_above_zero(node: Node, body: Body, what: str, hint: str = "") -> float | None:
    """A number above zero."""
    value = body.number(node, what)
    if value is not None and value <= 0:
        body.problems.add(f"{what} must be above zero, not {value:g}", body.place(node), (), hint)
        return None
    return value


def read_count(node: Node, body: Body, what: str) -> int | None:
    """A whole number, from 0 on."""
    value = body.number(node, what)
    if value is None:
        return None
    if value != int(value) or value < 0:
        body.problems.add(f"{what} must be a whole number, not {value:g}", body.place(node))
        return None
    return int(value)
