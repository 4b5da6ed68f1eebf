"""The value of a formula whose names are all numbers: parameters, spans, presets."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping

from tracewire.errors import FormulaError, Place, Problem
from tracewire.formula.expression import Expression, Name, Number
from tracewire.formula.functions import CONSTANTS
from tracewire.formula.text import to_text

OPERATIONS: dict[str, Callable[..., float]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "**": math.pow,
    "neg": operator.neg,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "and": lambda *terms: all(terms),
    "or": lambda *terms: any(terms),
    "not": operator.not_,
    "abs": abs,
    "sign": lambda u: (u > 0) - (u < 0),
    "min": min,
    "max": max,
    "floor": math.floor,
    "mod": lambda a, b: a - b * math.floor(a / b),
    "dry": lambda u, slip, stick: slip * ((u > 0) - (u < 0)),
    "is_held": lambda u: 0.0,  # of parameters: nothing moves that could be held
    "dot": operator.mul,  # a parameter is one number, a vector of one element
    "solve": lambda matrix, right: right / matrix,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "asin": math.asin,
    "acos": math.acos,
    "atan": math.atan,
    "atan2": math.atan2,
    "sinh": math.sinh,
    "cosh": math.cosh,
    "tanh": math.tanh,
    "exp": math.exp,
    "log": math.log,
    "sqrt": math.sqrt,
}


def evaluate(expression: Expression, values: Mapping[str, float], place: Place = Place()) -> float:
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
    return OPERATIONS[node.function](*(_value(a, values) for a in node.arguments))
