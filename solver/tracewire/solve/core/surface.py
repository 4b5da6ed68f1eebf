"""Back onto the surfaces of slides and contacts: what rounding has moved off them."""

from __future__ import annotations

import numpy as np

from tracewire.solve.core.arrays import Matrix, Vector, flow_of
from tracewire.solve.core.flow import CURVES, GRADIENTS, GUARDS, RESTING, SLIDING, evaluate
from tracewire.solve.core.linear import dot, solved
from tracewire.solve.core.readings import guard_rates
from tracewire.solve.core.units import unit


@unit
def pin(core: int, t: float, x: Vector) -> None:
    """Put the states back onto the surfaces on which they are held: what rounding has moved.

    The guards of contacts along their gradients; then those of slides along theirs, and the rates
    of contacts along their push, all together: each may change the others.
    """
    flow = flow_of(core)
    n, modes = len(x), len(flow.bound)
    values, gradients = np.empty(modes), np.empty((modes, n))
    slides = np.flatnonzero(flow.bound == SLIDING)
    rests = np.flatnonzero(flow.bound == RESTING)
    some, count = len(slides), len(slides) + len(rests)
    evaluate(core, GUARDS, t, x, values)
    evaluate(core, GRADIENTS, t, x, gradients)
    rows, ways, off = np.empty((count, n)), np.empty((count, n)), np.empty(count)
    if len(rests):
        for row, i in enumerate(rests):
            rows[row], ways[row], off[row] = gradients[i], gradients[i], values[i]
        _move_back(rows[: len(rests)], ways[: len(rests)], off[: len(rests)], x)
        along, curves = np.empty(modes), np.empty((modes, n + 1))
        guard_rates(core, t, x, along)
        evaluate(core, CURVES, t, x, curves)
        if some:
            evaluate(core, GUARDS, t, x, values)
        for row, i in enumerate(rests):
            rows[some + row], ways[some + row] = curves[i, :n], flow.push[i]
            off[some + row] = along[i]
    for row, i in enumerate(slides):
        rows[row], ways[row], off[row] = gradients[i], gradients[i], values[i]
    _move_back(rows, ways, off, x)


@unit
def _move_back(rows: Matrix, ways: Matrix, off: Vector, x: Vector) -> None:
    """Move x along `ways` until what changes with the gradients `rows` and is `off` is zero.

    One after the other where they depend on each other.
    """
    count = len(off)
    if not np.any(off != 0.0):
        return
    matrix = np.empty((count, count))
    for k in range(count):
        for j in range(count):
            matrix[k, j] = dot(rows[k], ways[j])
    parts = solved(matrix.copy(), off)
    for k in range(count):
        part = parts[k]
        if not np.all(np.isfinite(parts)):
            part = off[k] / matrix[k, k] if matrix[k, k] != 0.0 else 0.0
        for j in range(len(x)):
            x[j] -= ways[k, j] * part
