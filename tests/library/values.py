"""The value of a block's output: the formula language in the words of the math module."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import pairwise

from tracewire.formula import CONSTANTS, Call, Expression, Name, Number, parse
from tracewire.library import Library, load_library

Points = Sequence[tuple[float, float]]
PLAIN: dict[str, Callable[..., float]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "**": math.pow,
    "neg": lambda a: -a,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "not": lambda a: not a,
    "abs": abs,
    "min": min,
    "max": max,
    "sign": lambda u: float((u > 0) - (u < 0)),
    "dry": lambda u, slip, stick: slip * ((u > 0) - (u < 0)),
    "floor": math.floor,
    "mod": lambda a, b: a - b * math.floor(a / b),
    "sum": sum,
    "product": math.prod,
}


@lru_cache(maxsize=1)
def library() -> Library:
    return load_library()


def value(node: Expression, names: dict[str, object]) -> float:
    """The value of a formula; of a choice only the branch that is taken is worked out."""
    if isinstance(node, Number):
        return node.value
    if isinstance(node, Name):
        return CONSTANTS[node.name] if node.name in CONSTANTS else names[node.name]  # type: ignore[return-value]
    assert isinstance(node, Call)
    function, arguments = node.function, node.arguments
    if function == "if":
        return value(arguments[1 if value(arguments[0], names) else 2], names)
    if function == "and":
        return all(value(argument, names) for argument in arguments)
    if function == "or":
        return any(value(argument, names) for argument in arguments)
    given = [value(argument, names) for argument in arguments]
    if function == "interp":
        return straight(*given)  # type: ignore[arg-type]
    return PLAIN[function](*given) if function in PLAIN else getattr(math, function)(*given)


def straight(u: float, points: Points) -> float:
    if u <= points[0][0]:
        return points[0][1]
    for (x0, y0), (x1, y1) in pairwise(points):
        if u <= x1:
            return y0 + (y1 - y0) * (u - x0) / (x1 - x0)
    return points[-1][1]


def output(block_name: str, /, **given: object) -> float:
    """The only output of a shipped block for given inputs, parameters, states and `t`."""
    block = library()[block_name]
    names = dict(given)
    for parameter in block.parameters:
        if parameter.name not in names and parameter.default is not None:
            default = parameter.default
            text = default if isinstance(default, str) else repr(default)
            names[parameter.name] = value(parse(text), names)
    for port in block.inputs:
        if port.name not in names and port.default is not None:
            names[port.name] = value(parse(port.default), names)
    (formula,) = block.formulas.values()
    return value(formula, names)
