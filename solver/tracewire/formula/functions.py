"""The functions and constants of the formula language."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Function:
    """A function of the language: how many arguments it takes (`most` None: any) and what it is."""

    least: int
    most: int | None
    doc: str


FUNCTIONS = {
    "sin": Function(1, 1, "sine of an angle in rad"),
    "cos": Function(1, 1, "cosine of an angle in rad"),
    "tan": Function(1, 1, "tangent of an angle in rad"),
    "asin": Function(1, 1, "inverse sine, in rad"),
    "acos": Function(1, 1, "inverse cosine, in rad"),
    "atan": Function(1, 1, "inverse tangent, in rad"),
    "atan2": Function(2, 2, "angle of the point (x, y) given as atan2(y, x), in rad"),
    "sinh": Function(1, 1, "hyperbolic sine"),
    "cosh": Function(1, 1, "hyperbolic cosine"),
    "tanh": Function(1, 1, "hyperbolic tangent"),
    "exp": Function(1, 1, "exponential"),
    "log": Function(1, 1, "natural logarithm"),
    "sqrt": Function(1, 1, "square root"),
    "abs": Function(1, 1, "absolute value; its kink is a guard"),
    "sign": Function(1, 1, "1 above zero, -1 below, set-valued at zero; its jump is a guard"),
    "min": Function(2, None, "the least argument; every change of it is a guard"),
    "max": Function(2, None, "the largest argument; every change of it is a guard"),
    "floor": Function(1, 1, "the largest whole number not above; every jump is a guard"),
    "mod": Function(2, 2, "a - b*floor(a/b); every jump is a guard"),
    "dry": Function(
        3,
        3,
        "dry(u, slip, stick): slip*sign(u); at u = 0 any value within +-stick that holds u there",
    ),
    "is_held": Function(
        1, 1, "is_held(u): 1 while a closed contact or sticking friction holds u at zero, else 0"
    ),
    "interp": Function(2, 2, "interp(u, points): straight lines through points, held beyond them"),
    "sum": Function(1, 1, "sum(port): the sum of all wires of an input that takes several"),
    "product": Function(1, 1, "product(port): the product of all wires of such an input"),
    "join": Function(1, 1, "join(port): the vector of all wires of such an input, end to end"),
    "dot": Function(
        2, 2, "dot(a, b): the sum of products of two vectors, or a matrix times a vector"
    ),
    "solve": Function(2, 2, "solve(M, f): the x with M x = f, of a square matrix and a vector"),
}

CONSTANTS = {"pi": math.pi}
"""Names with a fixed value. `t` is the time and is no constant."""
