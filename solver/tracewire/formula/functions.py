"""The operators, functions and constants of the formula language: one record says all of each.

What the compiler does with a function that needs more than arithmetic (a guard, a table, the
elements of vectors) is code of `tracewire.compile`, and so are derivatives by two arguments.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

Reads = Literal["", "wires", "points"]
UnitRule = Literal[
    "number",
    "same",
    "compared",
    "levels",
    "delayed",
    "kept",
    "lost",
    "root",
    "product",
    "quotient",
    "power",
    "any",
]


@dataclass(frozen=True)
class Function:
    """A function of the language, or an operator.

    It takes from `least` to `most` arguments (None: any number, and a port with several wires for
    as many); `doc` says what it is.

    value: what it is of numbers, such as parameters; None: nothing. numpy: the name of the same in
    numpy, which takes two arguments at a time.

    unit: a `number` of numbers; of arguments of the `same` unit, which the value has, too; of those
    that are `compared`, the value has none; of `levels` behind the first argument, which the value
    has; of a signal `delayed` by a time, the value has the unit of the first and third argument; of
    `any`, nothing is known of the value. Of one argument, or the first: its unit is `kept`, or
    `lost`, or the value is its `root`. Of two: their `product`, `quotient` or `power`.

    slope: of one argument u, the derivative, a formula of u and of the value f. pace: whether it
    `turns` again and again as u grows, as a sine does, or `fades` where u is large.

    library, intrinsic, instruction: the name of the function of the C library, of the function of
    LLVM, or of the instruction that computes it. base: the function of this table of which
    `compile.hyperbolic` makes it. None of them: it is made of others.

    reads: the last argument is no value, but the name of a port with several `wires` or of a table
    of `points`. instead: what to write in a formula of a diagram, for a function that only the
    declarations of blocks have.
    """

    least: int
    most: int | None
    doc: str
    value: Callable[..., float] | None = None
    numpy: str = ""
    unit: UnitRule = "number"
    slope: str = ""
    pace: Literal["", "turns", "fades"] = ""
    library: str = ""
    intrinsic: str = ""
    instruction: str = ""
    base: str = ""
    reads: Reads = ""
    instead: str = ""


# What formulas write as signs and words. `a if c else b` has no record: it works out one of two.
# fmt: off
OPERATORS = {
    "+": Function(2, 2, "the sum", operator.add, numpy="add", unit="same", instruction="fadd"),
    "-": Function(2, 2, "the difference", operator.sub, numpy="subtract", unit="same",
        instruction="fsub"),
    "*": Function(2, 2, "the product", operator.mul, numpy="multiply", unit="product",
        instruction="fmul"),
    "/": Function(2, 2, "the quotient", operator.truediv, numpy="divide", unit="quotient",
        instruction="fdiv"),
    "**": Function(2, 2, "the power", math.pow, numpy="power", unit="power", library="pow"),
    "neg": Function(1, 1, "the sign turned round", operator.neg, numpy="negative", unit="kept"),
    "<": Function(2, 2, "less", operator.lt, numpy="less", unit="compared"),
    "<=": Function(2, 2, "less or equal", operator.le, numpy="less_equal", unit="compared"),
    ">": Function(2, 2, "greater", operator.gt, numpy="greater", unit="compared"),
    ">=": Function(2, 2, "greater or equal", operator.ge, numpy="greater_equal", unit="compared"),
    "and": Function(2, None, "all hold", lambda *terms: all(terms), numpy="logical_and",
        unit="lost"),
    "or": Function(2, None, "one of them holds", lambda *terms: any(terms), numpy="logical_or",
        unit="lost"),
    "not": Function(1, 1, "it does not hold", operator.not_, numpy="logical_not", unit="lost"),
}
# fmt: on


def _sech(u: float) -> float:
    return 1.0 / math.cosh(u)


# What formulas call by name.
# fmt: off
FUNCTIONS = {
    "sin": Function(1, 1, "sine of an angle in rad", math.sin, numpy="sin", slope="cos(u)",
        pace="turns", library="sin"),
    "cos": Function(1, 1, "cosine of an angle in rad", math.cos, numpy="cos", slope="-sin(u)",
        pace="turns", library="cos"),
    "tan": Function(1, 1, "tangent of an angle in rad", math.tan, numpy="tan", slope="1 + f*f",
        pace="turns", library="tan"),
    "asin": Function(1, 1, "inverse sine, in rad", math.asin, numpy="arcsin",
        slope="1/sqrt(1 - u*u)", library="asin"),
    "acos": Function(1, 1, "inverse cosine, in rad", math.acos, numpy="arccos",
        slope="-(1/sqrt(1 - u*u))", library="acos"),
    "atan": Function(1, 1, "inverse tangent, in rad", math.atan, numpy="arctan",
        slope="1/(1 + u*u)", pace="fades", library="atan"),
    "atan2": Function(2, 2, "angle of the point (x, y) given as atan2(y, x), in rad", math.atan2,
        numpy="arctan2", library="atan2"),
    "sinh": Function(1, 1, "hyperbolic sine", math.sinh, numpy="sinh", slope="cosh(u)",
        pace="fades", base="exp"),
    "cosh": Function(1, 1, "hyperbolic cosine", math.cosh, numpy="cosh", slope="sinh(u)",
        pace="fades", base="exp"),
    "tanh": Function(1, 1, "hyperbolic tangent", math.tanh, numpy="tanh", slope="1 - f*f",
        pace="fades", base="exp"),
    "sech": Function(1, 1, "hyperbolic secant, 1/cosh", _sech, slope="-(f*tanh(u))", pace="fades",
        base="exp"),
    "exp": Function(1, 1, "exponential", math.exp, numpy="exp", slope="f", pace="fades",
        library="exp"),
    "log": Function(1, 1, "natural logarithm", math.log, numpy="log", slope="1/u", library="log"),
    "sqrt": Function(1, 1, "square root", math.sqrt, numpy="sqrt", unit="root", slope="0.5/f",
        intrinsic="llvm.sqrt.f64"),
    "abs": Function(1, 1, "absolute value; its kink is a guard", abs, numpy="abs", unit="kept",
        intrinsic="llvm.fabs.f64"),
    "sign": Function(1, 1, "1 above zero, -1 below, set-valued at zero; its jump is a guard",
        lambda u: (u > 0) - (u < 0), numpy="sign", unit="lost"),
    "min": Function(2, None, "the least argument; every change of it is a guard", min,
        numpy="minimum", unit="same"),
    "max": Function(2, None, "the largest argument; every change of it is a guard", max,
        numpy="maximum", unit="same"),
    "floor": Function(1, 1, "the largest whole number not above; every jump is a guard", math.floor,
        numpy="floor", unit="kept", intrinsic="llvm.floor.f64"),
    "mod": Function(2, 2, "a - b*floor(a/b); every jump is a guard",
        lambda a, b: a - b * math.floor(a / b), unit="same"),
    "dry": Function(3, 3,
        "dry(u, slip, stick): slip*sign(u); at u = 0 any value within +-stick that holds u there",
        lambda u, slip, stick: slip * ((u > 0) - (u < 0)), unit="levels"),
    "is_held": Function(1, 1,
        "is_held(u): 1 while a closed contact or sticking friction holds u at zero, else 0",
        lambda u: 0.0, unit="lost"),
    "delayed": Function(3, 5,
        "delayed(u, time, before): u as it was so long ago, and before the start what `before` is;"
        " delayed(u, time, before, shortest, longest): with a time that changes between these",
        unit="delayed", instead="Use a block of type delay or variable_delay."),
    "shifted": Function(2, 2,
        "shifted(u, time): u, a signal of t alone, as it was so long ago, before the start, too",
        unit="kept", instead="Use a block of type delay."),
    "interp": Function(2, 2, "interp(u, points): straight lines through points, held beyond them",
        reads="points", instead="Use a block that has a table of points."),
    "cubic_spline": Function(2, 2,
        "cubic_spline(u, points): the natural cubic spline, held beyond the points",
        reads="points", instead="Use a block of type spline_table."),
    "monotone_cubic": Function(2, 2,
        "monotone_cubic(u, points): cubics without overshoot, held beyond the points",
        reads="points", instead="Use a block of type monotone_table."),
    "sum": Function(1, 1, "sum(port): the sum of all wires of an input that takes several",
        reads="wires", instead="Use a block of type sum, or write a + b."),
    "product": Function(1, 1, "product(port): the product of all wires of such an input",
        reads="wires", instead="Use a block of type product, or write a*b."),
    "join": Function(1, 1, "join(port): the vector of all wires of such an input, end to end",
        reads="wires", instead="Use a block of type mux, or write the list [a, b]."),
    "dot": Function(2, 2,
        "dot(a, b): the sum of products of two vectors, or a matrix times a vector", operator.mul,
        unit="product"),
    "solve": Function(2, 2, "solve(M, f): the x with M x = f, of a square matrix and a vector",
        lambda matrix, right: right / matrix, unit="any"),
    "random_number": Function(2, 2,
        "random_number(seed, k): number k of a random stream, uniform between 0 and 1",
        instead="Use a block of type noise or random_steps."),
    # what linear systems need of vectors; it is written out by elements before units are compared
    "one_number": Function(1, 1, "one_number(u): u, which must be one number and no vector",
        unit="any", instead="Name one element of the vector, such as q[0]."),
    "matrix_times": Function(2, 2,
        "matrix_times(M, u): a matrix, or a row, times a vector that fits it",
        unit="any", instead="Use a block of type matrix_gain, or write dot(M, u)."),
    "shift_in": Function(2, 2,
        "shift_in(x, u): the vector x without its first element, and u behind",
        unit="any", instead="Use a block of type unit_delay for each sample that is kept."),
    "bit_register": Function(1, 1,
        "bit_register(r): the bits of a list of two or more, 1 where an element is at least 1/2",
        unit="any", instead="Use a block of type prbs."),
    "direct_gain": Function(2, 2,
        "direct_gain(b, a): b[0]/a[0] of polynomials of one degree, else 0",
        unit="any", instead="Use a block of type transfer_function."),
    "monic_coefficients": Function(3, 3,
        "monic_coefficients(b, a, w): b[k]/(a[0]*w**k), k from 1, with b padded to the length of a",
        unit="any", instead="Use a block of type transfer_function."),
    "settled_states": Function(3, 3,
        "settled_states(b, a, w): the states of b/a, scaled by w, settled to an output of 1",
        unit="any", instead="Use a block of type transfer_function."),
    "zeros_like": Function(1, 1, "zeros_like(u): zero, or the vector of zeros, of the shape of u",
        unit="any", instead="Write 0, or a list of zeros."),
    "root_scale": Function(1, 1, "root_scale(a): the size of the largest root of a polynomial",
        unit="any", instead="Use a block of type transfer_function."),
    "pick_element": Function(2, 2,
        "pick_element(v, i): the element of v whose number is nearest to i",
        unit="any", instead="Use a block of type select."),
    "straight_lines": Function(3, 3,
        "straight_lines(u, x, y): straight lines through points of two lists, with jumps",
        unit="any", instead="Use a block of type signal_builder."),
    "bilinear": Function(5, 5,
        "bilinear(u, v, rows, columns, values): a table of two signals, held beyond its points",
        unit="any", instead="Use a block of type lookup_table_2d."),
}
# fmt: on

OPERATIONS = OPERATORS | FUNCTIONS

CONSTANTS = {"pi": math.pi}
"""Names with a fixed value. `t` is the time and is no constant."""
