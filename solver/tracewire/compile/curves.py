"""Smooth curves through the points of a table: cubics between them, joined with equal slopes.

Between the points j and j + 1, with h = x[j+1] - x[j], s = (u - x[j])/h, the slope m of the
straight line and the slopes d of the curve at the points, Hermite's cubic is

    y = line + h*s*(1 - s)*((1 - s)*(d[j] - m) - s*(d[j+1] - m))

Three tables with the same x give d, j + s and h: their straight lines have as values, or as
slopes, what the formula needs. Before the first point and behind the last one h is 0, and the ends
are held.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import accumulate, pairwise

from tracewire.compile.tape import Tape
from tracewire.diagram import Points
from tracewire.formula import Call, Expression, Name

CURVES = ("cubic_spline", "monotone_cubic")
PARTS = SLOPES, PIECES, LENGTHS = "slopes", "pieces", "lengths"
"""What the further tables of a curve are called, behind the name of its own."""


def curve_tables(formula: Expression, tables: dict[str, Points]) -> None:
    """Add the tables that the curves of a formula need to those of the model."""
    if not isinstance(formula, Call):
        return
    for argument in formula.arguments:
        curve_tables(argument, tables)
    table = formula.arguments[-1]
    if formula.function in CURVES and isinstance(table, Name):
        points = tables[table.name]
        x, place = points.x, points.place
        squares = ((b - a) ** 2 for a, b in pairwise(x))
        tables[f"{table.name}.{SLOPES}"] = Points(x, _slopes(formula.function, points), place)
        tables[f"{table.name}.{PIECES}"] = Points(x, tuple(map(float, range(len(x)))), place)
        tables[f"{table.name}.{LENGTHS}"] = Points(x, (0.0, *accumulate(squares)), place)


def _slopes(function: str, points: Points) -> tuple[float, ...]:
    from scipy.interpolate import CubicSpline, PchipInterpolator  # slow to import, seldom needed

    x, y = points.x, points.y
    spline = function == "cubic_spline"
    curve = CubicSpline(x, y, bc_type="natural") if spline else PchipInterpolator(x, y)
    return tuple(float(slope) for slope in curve(x, 1))


def lower_curve(tape: Tape, value: int, line: int, parts: Mapping[str, int]) -> int:
    """The entry of a curve, given that of the straight lines; `parts` are its further tables."""
    push, one = tape.push, tape.constant(1.0)
    table, _, piece = tape.entries[line].operands

    def at(part: str) -> int:
        return push("segment", parts[part], value, piece)

    length = push("slope", parts[LENGTHS], piece)
    s = push("-", at(PIECES), push("-", piece, one))
    m, rest = push("slope", table, piece), push("-", one, s)
    change = push("*", length, push("slope", parts[SLOPES], piece))
    d_left = push("-", at(SLOPES), push("*", s, change))
    d_right = push("+", d_left, change)
    left = push("*", rest, push("-", d_left, m))
    right = push("*", s, push("-", d_right, m))
    size = push("*", length, push("*", s, rest))
    return push("+", line, push("*", size, push("-", left, right)))


def table_name(arguments: tuple[Expression, ...]) -> str:
    """The name of the table that a function of points reads."""
    table = arguments[-1]
    if not isinstance(table, Name):
        raise AssertionError("a function of points reads a table by its name")
    return table.name
