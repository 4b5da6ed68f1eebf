"""Steps in which nothing crosses zero: nearly all are, and seen to be so with little work."""

from __future__ import annotations

import numpy as np

from tracewire.solve.core.arrays import flow_of, plan_of, trial_of, watch_of
from tracewire.solve.core.codes import FRACTION, GUARD
from tracewire.solve.core.flow import RESTING, SLIDING
from tracewire.solve.core.methods import BENT, INNER
from tracewire.solve.core.units import helper

SAMPLES = 5  # of the margins over a step, both ends included
SLACK = 0.25  # a parabola that stays above zero by less than bend/32 may be wrong about it
EDGE = 2.2  # times the bend: a parabola may be wrong about which side of a sample it turns on
HELD_NOISE = 1e-9  # of a fraction, and of what the force of a contact balances


@helper
def keeps_away(core: int, method: int, count: int) -> bool:
    """Whether no margin of a step can be below zero at a sample, or dip below it between two.

    The margins at both ends are known: `start`, and the last sample. Inside they are no farther
    from the straight line between these than the states are from theirs, times the weights of
    straight guards: a quarter of what `inner` has, as theta*(1 - theta) is at most a quarter. The
    parabola through three samples bends by four such quarters at most, and is not taken for a dip
    where it is farther from zero than 0.64 of its bend. All margins must be armed.
    """
    flow, plan, trial, watched = flow_of(core), plan_of(core), trial_of(core), watch_of(core)
    if flow.counts[SLIDING] + flow.counts[RESTING]:  # the margins of what is held are no guards
        return False
    start, end, armed = watched.start, watched.rows[SAMPLES - 1], watched.armed
    bent, inner = trial.at, trial.inner
    for j in range(len(bent)):
        total = 0.0
        for k in range(BENT[method], INNER[method]):
            total += abs(inner[k, j])
        bent[j] = total
    for row in range(count):
        i, bend = np.uint64(watched.mode[row]), 0.0  # unsigned: no place is counted from the end
        for term in range(plan.first_term[i], plan.first_term[i + np.uint64(1)]):
            place = np.uint64(term)
            bend += flow.weights[place] * bent[np.uint64(plan.term_state[place])]
        away = start[row] > bend and end[row] > bend
        if not (away and armed[row] and plan.straight[i]):
            return False
    return True


@helper
def all_armed(core: int, count: int) -> bool:
    """Whether all margins have been positive."""
    armed = True
    for row in range(count):
        armed = armed and watch_of(core).armed[row] != 0
    return armed


@helper
def is_quiet(core: int, count: int) -> bool:
    """Whether no margin is below zero at a sample, and none may dip below it.

    What rounding may explain is asked later. Most margins vary less than they are away from zero:
    no parabola through three of their samples comes near it.
    """
    rows, kind = watch_of(core).rows, watch_of(core).kind
    for i in range(count):
        least, most = rows[0, i], rows[0, i]
        for k in range(1, SAMPLES):
            least, most = min(least, rows[k, i]), max(most, rows[k, i])
        if 2.0 * least <= most and not _stays_above(core, i, kind[i]):
            return False
    return True


@helper
def _stays_above(core: int, i: int, kind: int) -> bool:
    """Whether a margin is above zero at all samples, and no parabola says that it may dip. What is
    held may begin at its limit, and is looked at."""
    rows = watch_of(core).rows
    if kind != GUARD and not watch_of(core).armed[i]:
        return False
    floor = HELD_NOISE if kind == FRACTION else 0.0
    least = min(rows[0, i], 0.0) - floor
    for k in range(1, SAMPLES):
        if rows[k, i] < least:
            return False
    for k in range(1, SAMPLES - 1):
        before, here, after = rows[k - 1, i], rows[k, i], rows[k + 1, i]
        bend, slope = after - 2 * here + before, after - before
        dips = slope * slope > bend * (8 * here - SLACK * bend)
        if dips and bend > 0 and before > floor and abs(slope) <= EDGE * bend:
            return False
    return True
