"""The values of a formula along samples: names stand for arrays that broadcast together."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from typing import Any

import numpy as np

from tracewire.array_types import Vector
from tracewire.errors import FormulaError
from tracewire.formula.expression import Expression, Name, Number
from tracewire.formula.functions import CONSTANTS, OPERATIONS
from tracewire.formula.text import to_text


def _of_numpy(name: str) -> Callable[..., Any]:
    function = getattr(np, name)
    return function if function.nin == 1 else lambda *terms: reduce(function, terms)


ALONG = {name: _of_numpy(one.numpy) for name, one in OPERATIONS.items() if one.numpy}
ALONG |= {
    "if": np.where,
    "dry": lambda u, slip, stick: slip * np.sign(u),
    "sech": lambda u: 1.0 / np.cosh(u),
    "mod": lambda a, b: a - b * np.floor(a / b),  # np.mod differs where a/b is rounded to a whole
}
"""What numpy has for operators and functions, and what it does not have."""


def evaluate_along(
    expression: Expression, values: Mapping[str, float | Vector], shape: int | tuple[int, ...]
) -> Vector:
    """The values of a formula in an array of this shape, as (N,) of samples or (N, k) of samples
    and choices; those of its names are numbers or arrays that broadcast to it.

    A sign, or a friction, of exactly 0 is 0. Raises FormulaError where a value is not finite, a
    name has no value, or a function has no meaning for samples alone.
    """
    try:
        with np.errstate(all="ignore"):  # the branch of a choice that is not taken
            found = np.broadcast_to(_value(expression, values), shape).astype(float)
    except KeyError as error:
        what = f"'{to_text(expression)}' cannot be evaluated along samples: no '{error.args[0]}'"
        raise FormulaError.one(what) from error
    if not np.isfinite(found).all():
        raise FormulaError.one(f"'{to_text(expression)}' is not finite at each sample")
    return found


def _value(node: Expression, values: Mapping[str, float | Vector]) -> float | Vector:
    if isinstance(node, Number):
        return node.value
    if isinstance(node, Name):
        return CONSTANTS[node.name] if node.name in CONSTANTS else values[node.name]
    found: Vector = ALONG[node.function](*(_value(a, values) for a in node.arguments))
    return found
