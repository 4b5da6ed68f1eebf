"""The unit of a quantity, which may be the one in which a user has it."""

from __future__ import annotations

from tracewire.compile.dimensions import has_units, unit_of, unit_problems
from tracewire.compile.model import Model
from tracewire.diagram import element_name, find_recorded
from tracewire.formula import (
    OPERATIONS,
    QUANTITIES,
    Call,
    Expression,
    Name,
    Number,
    dimension_text,
    rename,
    to_text,
)


def in_full(model: Model, formula: Expression) -> Expression:
    """The formula with the full names of a model; one that the model does not have stays."""
    return rename(formula, lambda name: Name(_full(model, name)))


def unit_of_quantity(model: Model, quantity: Expression) -> tuple[str, float]:
    """The unit in which a user has a quantity, and its factor to SI; '' where it is not known.

    It is that of the signals if these have one and the quantity keeps it, as `rms(x - y)` does.
    """
    formula = in_full(model, quantity)
    known_as = QUANTITIES.get(formula.function) if isinstance(formula, Call) else None
    if known_as is not None and known_as.unit == "Hz":
        return "Hz", 1.0
    known = {*model.flat.signals, *model.flat.inputs, *model.states}
    signals = [name for name in _kept(formula) or () if name in known]
    of_users = {model.users_unit(name) for name in signals}
    of_si = {(model.flat.units.get(name, ""), 1.0) for name in signals}
    for units in (of_users, of_si):
        if len(units) == 1 and (unit := next(iter(units)))[0]:
            return unit
    if not has_units(model.flat):  # all is in plain numbers, but for the time
        own = "" if known_as is None else known_as.unit
        return (own if own in ("s", "1/s") else ""), 1.0
    return _derived(model, formula), 1.0


def _derived(model: Model, formula: Expression) -> str:
    """The unit that the equations give a formula; '' too where units contradict each other."""
    if unit_problems(model.flat):
        return ""
    term, _ = unit_of(model.flat, formula)
    return dimension_text(term) if term else ""


def _kept(node: Expression) -> list[str] | None:
    """The names whose unit a formula keeps; None where it makes another one."""
    if isinstance(node, Name):
        return [node.name]
    if isinstance(node, Number):
        return []
    if node.function == "[]":
        vector, *indices = node.arguments
        index = [int(number.value) for number in indices if isinstance(number, Number)]
        return [element_name(to_text(vector), index)]
    operation, quantity = OPERATIONS.get(node.function), QUANTITIES.get(node.function)
    if operation is not None and operation.unit in ("kept", "same"):
        parts = [_kept(argument) for argument in node.arguments]
    elif operation is None and quantity is not None and quantity.unit in ("kept", "inside"):
        first = [quantity.kind(n) for n in range(len(node.arguments))].index("signal")
        parts = [_kept(node.arguments[first])]
    else:
        return None
    if any(part is None for part in parts):
        return None
    return [name for part in parts for name in part or ()]


def _full(model: Model, name: str) -> str:
    flat = model.flat
    if name in flat.parameters or name in flat.signals or name in model.states:
        return name
    return find_recorded(model.diagram, name) or name
