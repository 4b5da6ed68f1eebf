"""How the states change with parameters and start values, beside the states themselves.

Between events S' = J(t) S + f_p(t), by the collocation method Radau IIA of order 5 on the dense
output of the states, in intervals of its own, shorter than the steps or over several of them (E.
Hairer, G. Wanner, Solving ODEs II, sections IV.5 and IV.8), with a dense output of its own for
samples inside. At an event g(t, x, p) = 0 that moves by dtau:

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
    AHEAD,
    DENSE,
    INSIDE_ERROR,
    INSIDE_TOLERANCE,
    INTERVAL,
    KNOWN,
    PENDING,
    SLOPED,
    TIME,
    TOLERANCE,
    collocate,
    fill_between,
    put_total,
)
from tracewire.solve.core.flow import OUTPUTS, RESTING, SLIDING, held, patterns
from tracewire.solve.core.history import find_lags, is_delayed, recall
from tracewire.solve.core.locate import smallest_step
from tracewire.solve.core.trail import step_at
from tracewire.solve.core.units import helper, unit
from tracewire.solve.core.variation import OF_OUTPUTS, derive, derive_blended, held_parts

SMALLEST = 1e-5  # of a step of the states
MANY = 100  # intervals of a step: more of them count as steps, for which a run has a limit
FAR_WITHIN = 0.2  # then an interval was cut off: the next one may be as long as those before
# What the estimate of an interval's error may be, in units of the power 0.8 of the tolerance: as it
# is of order 4, intervals become shorter with the tolerance as the steps of the states do, by its
# power of 0.2. Most of the error of S is that of the states then. Inside of an interval the error
# is larger, of order 5.
MOST, MOST_INSIDE = 2.2, 0.15


@helper
def flag(core: int, kind: int, mode: int, t: float) -> None:
    """Remember that a sensitivity is not defined, or not known."""
    sensitivity = sensitivity_of(core)
    if sensitivity.flags[kind, 0] == 0:
        sensitivity.flags[kind, 1] = mode
        sensitivity.flag_times[kind] = t
    sensitivity.flags[kind, 0] += 1


@unit
def begin_to_follow(core: int) -> None:
    """Set what a run does not change."""
    sensitivity, rtol = sensitivity_of(core), progress_of(core).now[RTOL]
    chain, filled, now = sensitivity.chain, sensitivity.filled, sensitivity.now
    a, q = chain.shape
    now[TOLERANCE], now[INSIDE_TOLERANCE] = MOST * rtol**0.8, MOST_INSIDE * rtol**0.8
    delayed = 2 * len(history_of(core).mode)  # their rows are others at each time
    for k in range(a):
        filled[k, 0], filled[k, 1] = 0, q
        if k < a - delayed:
            while filled[k, 1] > 0 and chain[k, filled[k, 1] - 1] == 0.0:
                filled[k, 1] -= 1
            while filled[k, 0] < filled[k, 1] and chain[k, filled[k, 0]] == 0.0:
                filled[k, 0] += 1


@unit
def follow(core: int, end: float) -> None:
    """Go on to the time `end`, which lies in the kept steps."""
    now, intervals = sensitivity_of(core).now, 0
    while now[TIME] < end:
        if now[PENDING] == 0.0:
            intervals += 1
            if intervals > MANY:
                progress_of(core).ints[STEPS] += 1
            _try(core, np.inf, end)
        if now[PENDING] > 0.0:
            _accept(core)


@unit
def reach(core: int, t: float, end: float) -> None:
    """Fill in S in `between` at the time `t` of a sample, on the way to `end` in the kept steps.

    An interval goes on behind the sample where S is known inside of it as well as at its end.
    """
    sensitivity, intervals = sensitivity_of(core), 0
    now = sensitivity.now
    while now[TIME] < t:
        if now[PENDING] == 0.0:
            intervals += 1
            if intervals > MANY:
                progress_of(core).ints[STEPS] += 1
            _try(core, t, end)
        if now[PENDING] > 0.0:
            if t < now[AHEAD]:
                fill_between(core, now[PENDING], (t - now[TIME]) / now[PENDING])
                return
            _accept(core)
    for i in range(len(sensitivity.s)):
        copy(sensitivity.s[i], sensitivity.between[i])


@unit
def _try(core: int, sample: float, end: float) -> None:
    """Try an interval that ends at `end` or before, and is taken next where its error is small.

    It ends behind the next sample only where the error inside is small, too.
    """
    now, left = sensitivity_of(core).now, end - sensitivity_of(core).now[TIME]
    step_at(core, now[TIME])
    step = trial_of(core).ends[1]  # its length says how fast all is where the interval begins
    least = max(SMALLEST * step, smallest_step(core))
    h = min(now[INTERVAL], 3.0 * step) if now[INTERVAL] > 0.0 else step
    until, stop = sample - now[TIME], end
    if h > until and 0.0 < now[DENSE] < h:
        h = min(max(now[DENSE], until), left)
    else:  # as many of one length as it takes
        goal = min(left, until) if 0.0 < now[DENSE] < h else left
        h = min(max(goal / np.ceil(goal / h), least), left)
    inside = h > until
    if h < left:
        stop = now[TIME] + h if h != until else sample
    error = collocate(core, h) / now[TOLERANCE]
    if not math.isfinite(error):
        flag(core, LOST, 0, now[TIME])
        sensitivity_of(core).change[:] = 0.0
        sensitivity_of(core).slopes[:] = 0.0
        error = 1.0
        now[INSIDE_ERROR] = np.inf
    longer = h * min(5.0, max(0.2, _longer(error)))
    if error > 1.0 and h > least:
        now[INTERVAL] = longer
        return
    beyond = now[INSIDE_ERROR] / now[INSIDE_TOLERANCE]
    now[DENSE] = max(h * _longer(beyond), least)
    if inside and beyond > 1.0 and h > least:
        return
    now[INTERVAL] = max(now[INTERVAL], longer) if error < FAR_WITHIN else longer
    now[PENDING], now[AHEAD] = h, stop


@helper
def _longer(error: float) -> float:
    """By what an interval may be longer whose estimate is that large, in parts of the tolerance."""
    return 0.95 / math.sqrt(math.sqrt(max(error, 1e-9)))


@unit
def _accept(core: int) -> None:
    """Take the change of an interval; its end is the next one's beginning."""
    sensitivity = sensitivity_of(core)
    s, peak, nodes = sensitivity.s, sensitivity.peak, sensitivity.nodes
    change, slopes, now = sensitivity.change, sensitivity.slopes, sensitivity.now
    n, q = s.shape
    for i in range(n):
        for j in range(q):
            s[i, j] += change[i, j]
            peak[i, j] = max(peak[i, j], abs(s[i, j]))
            slopes[i, j] = slopes[3 * n + i, j]
        for k in range(nodes.shape[1]):
            nodes[i, k] = nodes[3 * n + i, k]
    if is_delayed(core):
        node_lags = history_of(core).node_lags
        copy(node_lags[3], node_lags[0])
    now[KNOWN], now[TIME], now[PENDING] = 1.0, now[AHEAD], 0.0
    now[SLOPED] = 1.0 if now[INSIDE_ERROR] < np.inf else 0.0


@unit
def sample(core: int, row: int, t: float, x: Vector, s: Matrix) -> None:
    """Fill in how the recorded signals change, for S (n, q) at this time."""
    flow, plan = flow_of(core), plan_of(core)
    sensitivity = sensitivity_of(core)
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
    one = sensitivity.parts  # of its rows, the first
    for column in range(count):
        state = plan.direct[column]
        if state >= 0:
            copy(s[state], one[0])
        else:
            put_total(core, rows[column], 0, len(sensitivity.chain), s, one, 0, len(s))
        for j in range(q):
            value = one[0, j]
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
