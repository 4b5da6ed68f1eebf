"""A formula as a reader likes it: `a + b/2` for `a - -b/2`, and `x` for `x/1`."""

from __future__ import annotations

from tracewire.errors import FormulaError
from tracewire.formula import Call, Expression, Number, parse, to_text

ONE = Number(1.0)


def tidy_formula(text: str) -> str:
    """The text of a formula without double signs and factors of 1; other text as it is."""
    try:
        return to_text(_tidy(parse(text)))
    except FormulaError:  # a guard that is told in words
        return text


def _tidy(node: Expression) -> Expression:
    if not isinstance(node, Call):
        return node
    arguments = tuple(_tidy(argument) for argument in node.arguments)
    match node.function, arguments:
        case (("*" | "/"), (first, last)) if last == ONE:
            return first
        case "*", (first, last) if first == ONE:
            return last
        case "neg", (inner,) if (positive := _without_sign(inner)) is not None:
            return positive
        case (("+" | "-"), (first, last)) if (positive := _without_sign(last)) is not None:
            return Call("-" if node.function == "+" else "+", (first, positive))
    return Call(node.function, arguments)


def _without_sign(node: Expression) -> Expression | None:
    """The formula without the minus that it begins with; None where it begins with none."""
    if isinstance(node, Number):
        return Number(-node.value) if node.value < 0 else None
    if not isinstance(node, Call):
        return None
    if node.function == "neg":
        return node.arguments[0]
    if node.function in ("*", "/"):
        first = _without_sign(node.arguments[0])
        return None if first is None else Call(node.function, (first, *node.arguments[1:]))
    return None
