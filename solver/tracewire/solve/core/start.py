"""The modes at the start of a run, the clocks that are due there, and its first rates."""

from __future__ import annotations

import numpy as np

from tracewire.solve.core import schedule
from tracewire.solve.core.arrays import Vector, crossings_of, flow_of, plan_of, progress_of
from tracewire.solve.core.codes import (
    BEYOND,
    DOWN,
    FINISHED,
    FLOOR,
    GUARD,
    IMPACT,
    MEMORY,
    ON_GUARD,
    SIGN,
    TIME,
    UP,
    T,
)
from tracewire.solve.core.flow import FREE, TIMED, evaluate, rates
from tracewire.solve.core.modes import NOISE, levels, mode_value
from tracewire.solve.core.readings import guard_rates, guard_values
from tracewire.solve.core.settle import settle
from tracewire.solve.core.transition import happen, no_crossings
from tracewire.solve.core.units import unit


@unit
def begin(core: int) -> int:
    """Set all modes, let memories take their start, fire the clocks that are due. A status."""
    flow = flow_of(core)
    plan = plan_of(core)
    progress, crossings = progress_of(core), crossings_of(core)
    t, x, modes = progress.now[T], progress.x, len(plan.kind)
    schedule.begin(core, t, x)
    guards = np.empty(modes)
    for _ in range(2):  # a guard may read what another mode changes
        guard_values(core, t, x, guards)
        for i in range(modes):
            if not plan.is_timed[i] and plan.kind[i] != MEMORY:
                flow.m[i] = mode_value(core, i, guards[i])
    for i in range(modes):
        if plan.kind[i] == MEMORY:
            flow.m[i] = guards[i]
    marks = np.zeros(modes, dtype=np.int64)
    status = settle(core, t, x, marks, True)
    if status != FINISHED:
        return status
    no_crossings(core)
    due = _strike(core, t, x)
    lines = np.empty(2 * len(plan.timed))
    if len(plan.timed):
        evaluate(core, TIMED, t, x, lines)
    for row, i in enumerate(plan.timed):
        guard = lines[2 * row] * t + lines[2 * row + 1]
        small = NOISE * 100 * max(1.0, abs(guard))
        if plan.kind[i] == FLOOR and abs(guard - flow.m[i]) <= small:
            for reset in range(len(plan.resets)):
                if plan.resets[reset, 0] == i:
                    crossings.how[i], crossings.to[i], crossings.up[i] = TIME, flow.m[i], 1
                    due = True
    return happen(core, t, x) if due else FINISHED


@unit
def _strike(core: int, t: float, x: Vector) -> bool:
    """Let the impacts happen whose guard is zero at the start and moves beyond; whether there are
    any. Mark the impacts whose guard is beyond zero there, and the resets whose guard is zero and
    leaves it as if they fired."""
    flow, plan = flow_of(core), plan_of(core)
    progress, crossings = progress_of(core), crossings_of(core)
    guards, level = np.empty(len(plan.kind)), np.empty(len(plan.kind))
    guard_values(core, t, x, guards)
    levels(core, t, x, level)
    found = False
    for reset in range(len(plan.resets)):
        i = plan.resets[reset, 0]
        if i < 0 or plan.kind[i] != SIGN or plan.is_timed[i] or flow.bound[i] != FREE:
            continue
        way = UP if flow.m[i] > 0.5 else DOWN
        if plan.resets[reset, 1] != way:
            continue
        impact, on_guard = plan.resets[reset, 4] == IMPACT, abs(guards[i]) <= level[i]
        if on_guard and impact:
            crossings.how[i], crossings.to[i], crossings.up[i] = GUARD, flow.m[i], way == UP
            flow.m[i] = 1.0 - flow.m[i]
            found = True
        elif on_guard:
            progress.overlooked[reset] = ON_GUARD
        elif impact:
            progress.overlooked[reset] = BEYOND
    return found


@unit
def reach_sides(core: int, t: float, x: Vector) -> bool:
    """Move the states by less than rounding, to those sides of guards that their modes have taken;
    whether there were any.

    A guard within its noise counts as zero, and its mode is that to come. The formula of that mode
    need not be defined where the guard is, as that of a root of `-h` is not at h = 1e-18.
    """
    flow, plan = flow_of(core), plan_of(core)
    modes, far = len(plan.kind), 0.0
    numbers, taken = np.empty((3, modes)), flow.m.copy()
    guards, level, along = numbers[0], numbers[1], numbers[2]
    guard_values(core, t, x, guards)
    levels(core, t, x, level)
    for i in range(modes):
        if plan.kind[i] == SIGN and flow.bound[i] == FREE and abs(guards[i]) <= level[i]:
            flow.m[i] = mode_value(core, i, guards[i])
    rate = np.empty(len(x))
    rates(core, t, x, rate)
    guard_rates(core, t, x, along)
    for i in range(modes):
        if flow.m[i] != taken[i] and along[i] != 0.0:
            far = max(far, 2.0 * abs(guards[i] / along[i]))
        flow.m[i] = taken[i]
    if far == 0.0 or not np.all(np.isfinite(rate)):
        return False
    for j in range(len(x)):
        x[j] += far * rate[j]
    return True
