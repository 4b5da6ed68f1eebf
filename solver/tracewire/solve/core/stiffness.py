"""The method of `auto`: by the tolerance, and by what was found stiff, per mode combination."""

from __future__ import annotations

import numpy as np

from tracewire.solve.core.arrays import Vector, flow_of, plan_of, progress_of, trial_of
from tracewire.solve.core.codes import (
    CALM,
    CURRENT,
    DELAY,
    METHOD,
    RTOL,
    SEGMENT,
    STIFF_ROWS,
    SUSPICIOUS,
)
from tracewire.solve.core.methods import DOP853, DORMAND_PRINCE, EDGE, IMPLICIT, ROSENBROCK
from tracewire.solve.core.units import helper, unit

TIGHT = 1e-8  # where order 8 takes fewer steps, and its errors add up to less
MANY_STIFF = 8
MANY_CALM = 6


@helper
def _key(core: int, out: Vector) -> None:
    """What identifies the mode combination. Points of tables in t and jumps of delayed signals are
    passed over: between any two of them the field is as stiff, and there may be hundreds."""
    flow, plan = flow_of(core), plan_of(core)
    modes = len(plan.kind)
    for i in range(len(flow.m)):
        passed = i < modes and plan.kind[i] == SEGMENT and plan.is_timed[i] != 0
        passed = passed or (i < modes and plan.kind[i] == DELAY)
        out[i] = 0.0 if passed else flow.m[i]
    for i in range(modes):
        out[len(flow.m) + i] = flow.bound[i]


@unit
def choose(core: int) -> None:
    """The method for this mode combination."""
    progress = progress_of(core)
    ints = progress.ints
    ints[CURRENT] = ints[METHOD]
    if ints[METHOD] >= 0:
        return
    ints[CURRENT] = DOP853 if progress.now[RTOL] <= TIGHT else DORMAND_PRINCE
    if ints[STIFF_ROWS] == 0:
        return
    stiff = progress.stiff
    key = np.empty(stiff.shape[1])
    _key(core, key)
    for row in range(ints[STIFF_ROWS]):
        same = True
        for i in range(len(key)):
            same = same and stiff[row, i] == key[i]
        if same:
            ints[CURRENT] = ROSENBROCK
            return


@unit
def watch_stiffness(core: int) -> bool:
    """After enough steps at the edge of stability this combination is called stiff: now."""
    progress = progress_of(core)
    trial = trial_of(core)
    ints = progress.ints
    if ints[METHOD] >= 0 or IMPLICIT[ints[CURRENT]]:
        return False
    if trial.ends[2] > EDGE[ints[CURRENT]]:
        ints[SUSPICIOUS] += 1
        ints[CALM] = 0
    else:
        ints[CALM] += 1
        if ints[CALM] == MANY_CALM:
            ints[SUSPICIOUS] = 0
    if ints[SUSPICIOUS] < MANY_STIFF:
        return False
    ints[SUSPICIOUS] = 0
    row = min(ints[STIFF_ROWS], len(progress.stiff) - 1)  # the last row is used again when full
    _key(core, progress.stiff[row])
    ints[STIFF_ROWS] = row + 1
    return True
