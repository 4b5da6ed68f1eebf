"""The value of a formula whose names are all numbers: parameters, spans, presets."""

from __future__ import annotations

import math
from collections.abc import Mapping

from tracewire.errors import FormulaError, Location, Problem
from tracewire.formula.expression import Expression, Name, Number
from tracewire.formula.functions import CONSTANTS, OPERATIONS
from tracewire.formula.text import to_text


def evaluate(
    expression: Expression, values: Mapping[str, float], place: Location = Location()
) -> float:
    """The number that a formula is, given the values of its names.

    Raises FormulaError where it has no finite value: a division by zero, the root of a negative
    number, a name without a value, a table.
    """
    try:
        value = float(_value(expression, values))
    except (ArithmeticError, ValueError) as error:
        reason = str(error)
    except KeyError as error:
        reason = f"'{error.args[0]}' has no value here"
    else:
        if math.isfinite(value):
            return value
        reason = f"the result is {value}"
    what = f"'{to_text(expression)}' cannot be evaluated: {reason}"
    raise FormulaError([Problem(what, place)])


def _value(node: Expression, values: Mapping[str, float]) -> float:
    if isinstance(node, Number):
        return node.value
    if isinstance(node, Name):
        return CONSTANTS[node.name] if node.name in CONSTANTS else values[node.name]
    if node.function == "if":  # the other branch may be undefined
        condition, then, other = node.arguments
        return _value(then if _value(condition, values) else other, values)
    value = OPERATIONS[node.function].value
    if value is None:
        raise KeyError(node.function)
    return value(*(_value(a, values) for a in node.arguments))
