"""The characteristic curve of a block: its output over its input, from the formula of the block."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise

from tracewire.draw.graph import Line
from tracewire.draw.limits import CURVE
from tracewire.errors import FormulaError
from tracewire.formula import Expression, evaluate, names_of
from tracewire.library import Block

SCALES = tuple(10.0 ** (n / 3) for n in range(-12, 13))
"""Ranges of the input that are tried, in its unit; the one with the sharpest bend counts, less
`CURVE.steep` times the largest step between two samples."""


def curve_of(
    block: Block, values: Mapping[str, float], moving: str | None = None
) -> tuple[Line, ...]:
    """The curve of a block in a box from (-1, -1) to (1, 1); () where it has none.

    values: its parameters. moving: the input on the axis, the first unless named; the others are 0.
    A block with states, modes or several outputs has no curve, nor one whose formula needs the
    time, a table or a parameter without a number.
    """
    ports = [port.name for port in block.inputs]
    if len(block.outputs) != 1 or block.states or block.modes or block.events or not ports:
        return ()
    formula = block.formulas[block.outputs[0].name]
    along = moving or ports[0]
    known = {**dict.fromkeys(ports, 0.0), **values}
    if not set(names_of(formula)) <= known.keys() | {"pi"} or along not in names_of(formula):
        return ()
    best, sharpest = 0.0, -2.0
    for scale in sorted(SCALES, key=lambda scale: abs(math.log10(scale))):
        coarse = _sampled(formula, along, known, scale, CURVE.coarse)
        bend = _bend([y for _, y in coarse]) - CURVE.steep * _step([y for _, y in coarse])
        if bend > sharpest + 0.02:
            best, sharpest = scale, bend
    return _scaled(_sampled(formula, along, known, best, CURVE.samples)) if best else ()


def table_curve(x: Sequence[float], y: Sequence[float]) -> tuple[Line, ...]:
    """The points of a table in the same box; () where they have no height or no width."""
    wide, high = (max(map(abs, values), default=0.0) for values in (x, y))
    if len(x) < 2 or wide == 0.0 or high == 0.0:
        return ()
    return (tuple((a / wide, b / high) for a, b in zip(x, y, strict=True)),)


def _sampled(
    formula: Expression, along: str, known: Mapping[str, float], scale: float, count: int
) -> list[tuple[float, float]]:
    """Points of the curve over -scale to scale; those without a value are left out."""
    found = []
    for n in range(count):
        x = scale * (2 * n / (count - 1) - 1)
        try:
            found.append((x / scale, evaluate(formula, {**known, along: x})))
        except FormulaError:
            continue
    return found


def _bend(values: Sequence[float]) -> float:
    """How far a curve is from straight, from 0 to 1."""
    if len(values) < 3:
        return -1.0
    height = max(values) - min(values)
    if height <= CURVE.flat * max(1.0, *map(abs, values)):
        return -0.5
    first, last = values[0], values[-1]
    straight = [first + (last - first) * n / (len(values) - 1) for n in range(len(values))]
    most = max(abs(y - s) for y, s in zip(values, straight, strict=True)) / height
    return most if most > CURVE.straight else 0.0


def _step(values: Sequence[float]) -> float:
    """The largest step between two values that follow each other, as a part of the height."""
    height = max(values, default=0.0) - min(values, default=0.0)
    return max((abs(b - a) for a, b in pairwise(values)), default=0.0) / height if height else 0.0


def _scaled(points: Sequence[tuple[float, float]]) -> tuple[Line, ...]:
    """The points with heights from -1 to 1 around zero; upright where the curve jumps."""
    largest = max((abs(y) for _, y in points), default=0.0)
    if len(points) < 3 or largest == 0.0:
        return ()
    scaled = [(x, y / largest) for x, y in points]
    line = [scaled[0]]
    for (x0, y0), (x1, y1) in pairwise(scaled):
        if abs(y1 - y0) > CURVE.jump:
            middle = 0.5 * (x0 + x1)
            line += [(middle, y0), (middle, y1)]
        line.append((x1, y1))
    return (tuple(line),)
