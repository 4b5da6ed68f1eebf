"""Tables whose points are lists: straight lines with jumps, and bilinear tables of two signals.

Straight lines through (x[k], y[k]) are y[0] and a step of each interval:

    y = y[0] + sum over k of (y[k+1] - y[k])*s(k)

where s(k) is the share of the interval that lies behind u: 0 before x[k], 1 from x[k+1] on. Where
both are the same number the step is a jump, to the later value. A bilinear table is such a sum over
the columns, whose values are such sums over the rows.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from tracewire.compile.elements import Elements, Mismatch, shape_text
from tracewire.errors import FormulaError
from tracewire.formula import CONSTANTS, Call, Expression, Number, evaluate, names_of

ZERO, ONE = Number(0.0), Number(1.0)


def straight_lines(parts: Sequence[Elements], text: str) -> Elements:
    """straight_lines(u, x, y): straight lines through points, with jumps; held beyond them."""
    u, x, y = parts
    shares = _shares(u.items[0], _numbers(x, "time", jumps=True))
    if y.shape != x.shape:
        raise Mismatch(f"there are {len(x.items)} times and {len(y.items)} values: give one each")
    return Elements((), (_through(y.items, shares),))


def bilinear(parts: Sequence[Elements], text: str) -> Elements:
    """bilinear(u, v, rows, columns, values): values[i][j] at (rows[i], columns[j]), held beyond."""
    u, v, rows, columns, values = parts
    if u.shape or v.shape:
        shape = shape_text(u.shape or v.shape)
        raise Mismatch(f"an input is {shape}, and it takes numbers: name an element, such as [0]")
    along, across = (
        _shares(of.items[0], _numbers(given, what, jumps=False))
        for of, given, what in ((u, rows, "row"), (v, columns, "column"))
    )
    count, width = len(rows.items), len(columns.items)
    if values.shape != (count, width):
        wanted = f"{count} rows of {width} values"
        raise Mismatch(f"the values are {shape_text(values.shape)}, and not {wanted}")
    lines = [values.items[i * width : (i + 1) * width] for i in range(count)]
    return Elements((), (_through([_through(line, across) for line in lines], along),))


def _numbers(given: Elements, what: str, *, jumps: bool) -> list[float]:
    """Numbers that ascend; with jumps also twice the same. Raises Mismatch."""
    if len(given.shape) != 1 or len(given.items) < 2:
        shape = shape_text(given.shape)
        raise Mismatch(f"the numbers of its {what}s are {shape}: write a list of two or more")
    if any(names_of(item) - CONSTANTS.keys() for item in given.items):
        raise Mismatch(f"the {what}s are not all plain numbers: write them down in SI")
    try:
        numbers = [evaluate(item, CONSTANTS) for item in given.items]
    except FormulaError as error:
        raise Mismatch(f"a {what} is no number: {str(error).removesuffix('.')}") from error
    for before, after in pairwise(numbers):
        if after < before or (after == before and not jumps):
            raise Mismatch(f"the {what}s must ascend, and {after:g} is not above {before:g}")
    if jumps and any(a == c for a, c in zip(numbers, numbers[2:], strict=False)):
        raise Mismatch(f"a {what} stands three times: a jump is the same number twice")
    return numbers


def _shares(u: Expression, x: Sequence[float]) -> list[Expression]:
    """What part of each interval lies behind u."""
    return [_share(u, begin, end) for begin, end in pairwise(x)]


def _share(u: Expression, begin: float, end: float) -> Expression:
    beyond = Call(">=", (u, Number(end)))
    if begin == end:
        return Call("if", (beyond, ONE, ZERO))
    inside = Call("/", (Call("-", (u, Number(begin))), Number(end - begin)))
    return Call("if", (beyond, ONE, Call("if", (Call(">=", (u, Number(begin))), inside, ZERO))))


def _through(y: Sequence[Expression], shares: Sequence[Expression]) -> Expression:
    steps = [
        Call("*", (Call("-", (after, before)), share))
        for (before, after), share in zip(pairwise(y), shares, strict=True)
        if before != after
    ]
    return _sum([y[0], *steps])


def _sum(terms: Sequence[Expression]) -> Expression:
    """The sum in halves of halves: a formula of a long table is not deep."""
    if len(terms) == 1:
        return terms[0]
    half = len(terms) // 2
    return Call("+", (_sum(terms[:half]), _sum(terms[half:])))
