"""Known times: guards that only read t change at times that are computed, not searched."""

from __future__ import annotations

import numpy as np

from tracewire.solve.core.arrays import Vector, flow_of, plan_of
from tracewire.solve.core.codes import DELAY, FLOOR, SIGN
from tracewire.solve.core.flow import TIMED, evaluate
from tracewire.solve.core.modes import inside, jump_time, right_limit
from tracewire.solve.core.units import helper, unit

TOGETHER = 1e-13
CARRIED = 1e-12  # of the size of a line: what is farther beyond its level was carried there


@unit
def begin(core: int, t: float, x: Vector) -> None:
    """Set the timed modes to their right limit at t."""
    flow = flow_of(core)
    plan = plan_of(core)
    if len(plan.timed) == 0:
        return
    lines = np.empty(2 * len(plan.timed))  # slope a and value b of every timed guard a*t + b
    for _ in range(len(plan.timed) + 1):  # the times of one mode may depend on another
        evaluate(core, TIMED, t, x, lines)
        changed = False
        for row, i in enumerate(plan.timed):
            value = right_limit(core, i, lines[2 * row], t, lines[2 * row + 1])
            changed = changed or value != flow.m[i]
            flow.m[i] = value
        if not changed:
            return


@unit
def upcoming(core: int, t: float, x: Vector, to: Vector) -> float:
    """The next time at which timed modes change; infinity if none.

    Fills `to` with the new value of each timed mode that changes then, else with NaN. A change
    that an event has overtaken by rounding is due now, and so is one of a guard that the jump of
    another mode has carried over its level: the guard of `t - 0.7 + wave/2` is a line between the
    jumps of the wave. Where another mode has it rest at zero, a comparison says what it says there.
    """
    flow, plan = flow_of(core), plan_of(core)
    best, count = np.inf, len(plan.timed)
    if count == 0:
        return best
    numbers = np.empty(4 * count)
    lines, rounding = numbers[: 2 * count], numbers[3 * count :]
    times = numbers[2 * count : 3 * count]
    evaluate(core, TIMED, t, x, lines)
    for row, i in enumerate(plan.timed):
        to[row], times[row], rounding[row] = np.nan, np.inf, 0.0
        slope, offset = lines[2 * row], lines[2 * row + 1]
        if not np.isfinite(slope):
            continue
        size = abs(slope * t) + abs(offset)
        rests = slope == 0.0 and offset == 0.0 and plan.compares[i] == 1
        if inside(core, i, slope * t + offset) < -CARRIED * size or rests:
            now = right_limit(core, i, slope, t, offset)
            if now != flow.m[i]:
                times[row], to[row], best = t, now, t
                continue
        if slope == 0.0:
            continue
        level, value = _change(core, i, slope)
        if np.isfinite(level):
            times[row] = max(t, (level - offset) / slope)
            rounding[row] = TOGETHER * (abs(level) + abs(offset)) / abs(slope)
            to[row] = value
            best = min(best, times[row])
    nearest = 0.0
    for row in range(count):
        if times[row] == best:
            nearest = max(nearest, rounding[row])
    near = best + TOGETHER * abs(best)
    for row in range(count):
        if not times[row] <= near + max(nearest, rounding[row]):
            to[row] = np.nan
    return best


@helper
def _change(core: int, i: int, slope: float) -> tuple[float, float]:
    """The level that a timed guard reaches next (infinity: none), and the mode beyond it."""
    flow = flow_of(core)
    plan = plan_of(core)
    value = flow.m[i]
    if plan.kind[i] == SIGN:
        beyond = 1.0 if slope > 0 else 0.0
        return (np.inf if value == beyond else 0.0), beyond
    if plan.kind[i] == FLOOR:
        return (value + 1.0, value + 1.0) if slope > 0 else (value, value - 1.0)
    if plan.kind[i] == DELAY:
        on = 1.0 if slope > 0 else -1.0
        level = jump_time(core, plan.table[i], value + max(on, 0.0))
        return (level if np.isfinite(level) else np.inf), value + on
    offset = int(flow.k[plan.table[i]])
    points, piece = int(flow.k[offset]), int(value)
    if slope > 0:
        return (flow.k[offset + 1 + piece] if piece < points else np.inf), value + 1.0
    return (flow.k[offset + piece] if piece > 0 else np.inf), value - 1.0
