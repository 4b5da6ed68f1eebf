"""What guards and resets read while a slide holds something: a friction that sticks has the force
that it takes, between those of its sides.

So the value of a guard is the blend of those on the sides, too, with the fractions of the slide,
and its rate has a part from the rates of the fractions.
"""

from __future__ import annotations

import numpy as np

from tracewire.solve.core.arrays import Ints, Vector, copy, flow_of, progress_of
from tracewire.solve.core.codes import LENGTH
from tracewire.solve.core.flow import (
    CURVES,
    DIFFERENCE,
    GRADIENTS,
    GUARD_RATES,
    GUARDS,
    READING,
    RESETS,
    RESTING,
    ROUNDING,
    SLIDING,
    TIME_PART,
    bind,
    blended,
    evaluate,
    held,
    patterns,
    push,
    rates,
)
from tracewire.solve.core.linear import dot, solved
from tracewire.solve.core.units import helper, unit


@helper
def guard_values(core: int, t: float, x: Vector, out: Vector) -> None:
    """The guards."""
    flow = flow_of(core)
    evaluate(core, GUARDS, t, x, out)
    if flow.counts[READING] and flow.counts[SLIDING]:
        _add_held(core, GUARDS, t, x, held(core, t, x), out)


@unit
def reset_values(core: int, t: float, x: Vector, out: Vector) -> None:
    """What all resets would write."""
    evaluate(core, RESETS, t, x, out)
    if flow_of(core).counts[SLIDING]:
        _add_held(core, RESETS, t, x, held(core, t, x), out)


@unit
def guard_rates(core: int, t: float, x: Vector, out: Vector) -> None:
    """d(guard)/dt along the flow, for all modes."""
    flow = flow_of(core)
    if flow.counts[SLIDING] + flow.counts[RESTING] == 0:
        evaluate(core, GUARD_RATES, t, x, out)
        return
    both = held(core, t, x)
    blended(core, GUARD_RATES, t, x, both, out)
    if flow.counts[RESTING]:
        gradients, more = np.empty((len(out), len(x))), np.zeros(len(x))
        evaluate(core, GRADIENTS, t, x, gradients)
        push(core, both[flow.counts[SLIDING] :], more)
        for i in range(len(out)):
            out[i] += dot(gradients[i], more)
    if flow.counts[READING] and flow.counts[SLIDING]:
        _add_held(core, GUARDS, t, x, _fraction_rates(core, t, x, both), out)


@unit
def guard_values_then(
    core: int, t: float, x: Vector, modes: Vector, bound: Ints, out: Vector
) -> None:
    """The guards with other modes, and with what was held then."""
    flow = flow_of(core)
    now, now_bound = flow.m.copy(), flow.bound.copy()
    copy(modes, flow.m)
    for i in range(len(bound)):
        bind(core, i, bound[i])
    guard_values(core, t, x, out)
    copy(now, flow.m)
    for i in range(len(bound)):
        bind(core, i, now_bound[i])


@unit
def _add_held(core: int, which: int, t: float, x: Vector, parts: Vector, out: Vector) -> None:
    """Add `parts` times the changes of a function from side to side of each slide."""
    rows = patterns(core, which, t, x, len(out))
    for row in range(1, len(rows)):
        for i in range(len(out)):
            if rows[row, i] != 0.0:  # what does not change does not ask for the part
                out[i] += parts[row - 1] * rows[row, i]


@unit
def _fraction_rates(core: int, t: float, x: Vector, both: Vector) -> Vector:
    """How the fractions of the slides change along the flow: from what keeps d2(guard)/dt2 = 0, by
    a difference beside contacts and where a fraction is 0/0."""
    flow = flow_of(core)
    n, modes, some = len(x), len(flow.bound), flow.counts[SLIDING]
    field, right = np.empty(n), np.empty(some)
    rates(core, t, x, field)
    if flow.counts[RESTING] == 0:
        matrix, slides = np.empty((some, some)), np.flatnonzero(flow.bound == SLIDING)
        moves = patterns(core, GUARD_RATES, t, x, modes)
        curves = patterns(core, CURVES, t, x, modes * (n + 1))
        for row in range(some):
            first, total = slides[row] * (n + 1), 0.0
            for j in range(n + 1):
                slope = curves[0, first + j]
                for column in range(some):
                    slope += both[column] * curves[1 + column, first + j]
                total += slope * (field[j] if j < n else 1.0)
            right[row] = -total
            for column in range(some):
                matrix[row, column] = moves[1 + column, slides[row]]
        right = solved(matrix, right)
        if np.all(np.isfinite(right)):
            return right
    h = max(DIFFERENCE * TIME_PART * progress_of(core).now[LENGTH], ROUNDING * abs(t))
    return (held(core, t + h, x + h * field) - both)[:some] / h
