"""How the states change with parameters and start values, beside the states themselves.

Between events S' = J(t) S + f_p(t), by the collocation method Radau IIA of order 5 on the dense
output of the states, in intervals of its own where S moves faster than x (E. Hairer, G. Wanner,
Solving ODEs II, sections IV.5 and IV.8). At an event g(t, x, p) = 0 that moves by dtau:

    dtau = -(g_x S- + g_p)/g'      D = S- + f- dtau
    D+ = R_x D + R_p + R_t dtau    S+ = D+ - f+ dtau

with the resets R and the fields f before and after all modes have settled.
"""

from __future__ import annotations

import math

import numpy as np

from tracewire.solve.core.arrays import (
    Matrix,
    Vector,
    copy,
    flow_of,
    history_of,
    plan_of,
    progress_of,
    sensitivity_of,
    trial_of,
)
from tracewire.solve.core.codes import LOST, RTOL, STEPS
from tracewire.solve.core.collocation import (
    INTERVAL,
    KNOWN,
    LONGEST,
    TIME,
    UNCHECKED,
    collocate,
)
from tracewire.solve.core.flow import OUTPUTS, RESTING, SLIDING, held, patterns
from tracewire.solve.core.history import find_lags, is_delayed, recall
from tracewire.solve.core.units import helper, unit
from tracewire.solve.core.variation import OF_OUTPUTS, derive, derive_blended, held_parts

SMALLEST = 1e-5  # of a step of the states
MANY = 100  # intervals of a step: more of them count as steps, for which a run has a limit
ROUNDING = 1e-14  # of the time: what a step must be to end later than it began
FAR_WITHIN = 0.05  # then an interval may be longer by a half, and its error not looked at
SURE = 3.0  # so often


@helper
def flag(core: int, kind: int, mode: int, t: float) -> None:
    """Remember that a sensitivity is not defined, or not known."""
    sensitivity = sensitivity_of(core)
    if sensitivity.flags[kind, 0] == 0:
        sensitivity.flags[kind, 1] = mode
        sensitivity.flag_times[kind] = t
    sensitivity.flags[kind, 0] += 1


@unit
def follow(core: int, method: int, end: float) -> None:
    """Go on to the time `end`, which lies in the trial step."""
    sensitivity = sensitivity_of(core)
    now, whole = sensitivity.now, trial_of(core).ends[1]
    # the estimate is of order 4 in the interval, the error of order 6
    tolerance = progress_of(core).now[RTOL] ** (2.0 / 3.0)
    intervals = 0
    while now[TIME] < end:
        intervals += 1
        if intervals > MANY:
            progress_of(core).ints[STEPS] += 1
        left = end - now[TIME]
        least = max(SMALLEST * whole, ROUNDING * abs(now[TIME]))
        h = now[INTERVAL]
        if not 0.0 < h < 0.99 * left:
            h = left
        h = min(max(h, least), left)
        sure = now[UNCHECKED] > 0.0 and h <= now[LONGEST]
        error = collocate(core, method, h, not sure) / tolerance
        if not math.isfinite(error):
            flag(core, LOST, 0, now[TIME])
            sensitivity.change[:] = 0.0
            error = 1.0
        longer = h * min(5.0, max(0.2, 0.9 * max(error, 1e-9) ** -0.25))
        if error > 1.0 and h > least:
            now[INTERVAL] = longer
            continue
        _accept(core)
        if sure:  # the interval is as long as the last one that was far within the tolerance
            now[UNCHECKED] -= 1.0
            now[TIME] = end if h == left else now[TIME] + h
            continue
        now[UNCHECKED] = SURE if error < FAR_WITHIN else 0.0
        now[LONGEST] = 1.5 * h
        now[TIME] = end if h == left else now[TIME] + h
        now[INTERVAL] = max(now[INTERVAL], longer) if h == left and error <= 1.0 else longer


@unit
def _accept(core: int) -> None:
    """Take the change of an interval; its end is the next one's beginning."""
    sensitivity = sensitivity_of(core)
    s, peak, nodes = sensitivity.s, sensitivity.peak, sensitivity.nodes
    n, q = s.shape
    for i in range(n):
        for j in range(q):
            s[i, j] += sensitivity.change[2 * n + i, j]
            peak[i, j] = max(peak[i, j], abs(s[i, j]))
        for k in range(nodes.shape[1]):
            nodes[i, k] = nodes[3 * n + i, k]
    if is_delayed(core):
        node_lags = history_of(core).node_lags
        copy(node_lags[3], node_lags[0])
    sensitivity.now[KNOWN] = 1.0


@unit
def sample(core: int, row: int, t: float, x: Vector) -> None:
    """Fill in how the recorded signals change, for S at this time."""
    flow, plan = flow_of(core), plan_of(core)
    sensitivity = sensitivity_of(core)
    s, chain = sensitivity.s, sensitivity.chain
    if is_delayed(core):
        find_lags(core, t, x)
        recall(core, t)
    (_n, q), w, count = s.shape, sensitivity.nodes.shape[1], len(plan.direct)
    rows = np.empty((count, w))
    if np.any(plan.direct < 0):
        some, total = flow.counts[SLIDING], flow.counts[SLIDING] + flow.counts[RESTING]
        if some:
            derive_blended(core, OF_OUTPUTS, t, x, held(core, t, x), rows)
            parts, moves = np.empty((total, w)), patterns(core, OUTPUTS, t, x, count)
            held_parts(core, t, x, parts)
            for k in range(some):
                for column in range(count):
                    rows[column] += moves[1 + k, column] * parts[k]
        else:
            derive(core, OF_OUTPUTS, t, x, rows)
    for j in range(q):
        for column in range(count):
            if plan.direct[column] >= 0:
                value = s[plan.direct[column], j]
            else:
                value = total_of(rows[column], s, chain, j)
            if not math.isfinite(value):
                flag(core, LOST, 0, t)
                value = 0.0
            sensitivity.samples[row, j * count + column] = value


@helper
def total_of(row: Vector, s: Matrix, chain: Matrix, j: int) -> float:
    """What derivatives (w,) in x, t and parameters are in all, t fixed."""
    n, total = len(s), 0.0
    for k in range(n):
        total += row[k] * s[k, j]
    for k in range(chain.shape[0]):
        total += row[n + 1 + k] * chain[k, j]
    return total
