"""The mode that belongs to the value of a guard, and how far a guard is inside its mode."""

from __future__ import annotations

import math

import numpy as np

from tracewire.solve.core.arrays import Vector, flow_of, history_of, plan_of, progress_of
from tracewire.solve.core.codes import DELAY, DROPPED, FLOOR, MEMORY, POINTS, SIGN
from tracewire.solve.core.flow import (
    FREE,
    GRADIENTS,
    GUARD_RATE_SIZES,
    GUARD_SIZES,
    RESTING,
    SLIDING,
    evaluate,
    sizes,
)
from tracewire.solve.core.units import helper, unit

NOISE = 1e-14  # of the size of a guard
NOTHING = 1e-12  # of the size of a rate
JUMP = 1e-9 / NOISE  # times its level a guard moves at once


@unit
def levels(core: int, t: float, x: Vector, out: Vector) -> None:
    """How large each guard may be and still count as zero: a part of what it is made of."""
    sizes(core, GUARD_SIZES, t, x, out)
    for i in range(len(out)):
        out[i] *= NOISE


@unit
def held_levels(core: int, t: float, x: Vector, out: Vector) -> None:
    """As `levels`, where states may be held: these are moved there by the rounding of what they
    were before, which a guard behind a gear shows, whose own level is zero there."""
    flow, largest = flow_of(core), progress_of(core).largest
    levels(core, t, x, out)
    if flow.counts[SLIDING] + flow.counts[RESTING] == 0:
        return
    gradients = np.empty((len(out), len(x)))
    evaluate(core, GRADIENTS, t, x, gradients)
    for i in range(len(out)):
        for j in range(len(x)):
            out[i] = max(out[i], NOISE * abs(gradients[i, j]) * largest[j])


@unit
def rate_levels(core: int, t: float, x: Vector, out: Vector) -> None:
    """How large the rate of each guard may be and still count as zero."""
    sizes(core, GUARD_RATE_SIZES, t, x, out)
    for i in range(len(out)):
        out[i] *= NOTHING


@helper
def mode_value(core: int, i: int, guard: float) -> float:
    """The mode that belongs to the value of a guard."""
    flow = flow_of(core)
    plan = plan_of(core)
    if plan.kind[i] == SIGN:
        return 1.0 if guard > 0 or (guard == 0 and plan.at_zero[i]) else 0.0
    if plan.kind[i] == FLOOR:
        return float(math.floor(guard))
    if plan.kind[i] == DELAY:
        return stretch_at(core, plan.table[i], guard)
    offset = int(flow.k[plan.table[i]])
    points = int(flow.k[offset])
    return float(np.searchsorted(flow.k[offset + 1 : offset + 1 + points], guard, side="right"))


@helper
def jump_time(core: int, delay: int, number: float) -> float:
    """The time of a jump of a delayed signal by its number, from 1 on; inf where it has not been,
    -inf where it is forgotten."""
    history = history_of(core)
    place = int(number) - 1 - history.counts[delay, DROPPED]
    if place < 0:
        return -np.inf
    return history.points[delay, place] if place < history.counts[delay, POINTS] else np.inf


@helper
def stretch_at(core: int, delay: int, s: float) -> float:
    """The number of the smooth stretch of a delayed signal that begins at s or before."""
    history = history_of(core)
    number = history.counts[delay, DROPPED] + history.counts[delay, POINTS]
    while number > 0 and jump_time(core, delay, float(number)) > s:
        number -= 1
    return float(number)


@helper
def right_limit(core: int, i: int, slope: float, t: float, offset: float) -> float:
    """The mode of a timed guard slope*t + offset just after now."""
    plan = plan_of(core)
    guard, size = slope * t + offset, abs(slope * t) + abs(offset)
    if plan.kind[i] == SIGN:
        if abs(guard) <= NOISE * size:
            return 1.0 if slope > 0 or (slope == 0 and plan.at_zero[i]) else 0.0
        return 1.0 if guard > 0 else 0.0
    near = NOISE * 100 * (max(1.0, size) if plan.kind[i] == FLOOR else size)
    return mode_value(core, i, guard + near if slope >= 0 else guard - near)


@helper
def piece(core: int, table: int, value: float) -> tuple[float, float]:
    """The ends of a piece of a table."""
    flow = flow_of(core)
    offset = int(flow.k[table])
    points, i = int(flow.k[offset]), int(value)
    low = flow.k[offset + i] if i > 0 else -np.inf
    high = flow.k[offset + 1 + i] if i < points else np.inf
    return low, high


@helper
def inside(core: int, i: int, guard: float) -> float:
    """How far the value of a guard is inside the range of its mode; negative where outside."""
    value, kind = flow_of(core).m[i], plan_of(core).kind[i]
    if kind == SIGN:
        return guard if value > 0.5 else -guard
    if kind == FLOOR:
        return min(guard - value, value + 1.0 - guard)
    if kind == DELAY:
        table = plan_of(core).table[i]
        low, high = jump_time(core, table, value), jump_time(core, table, value + 1.0)
    else:
        low, high = piece(core, plan_of(core).table[i], value)
    return min(guard - low, high - guard)


@helper
def margin(core: int, i: int, guard: float) -> float:
    """As `inside`; infinite for modes that no value of a guard decides: known times, memories,
    guards that are held."""
    plan = plan_of(core)
    if plan.is_timed[i] or plan.kind[i] == MEMORY or flow_of(core).bound[i] != FREE:
        return np.inf
    return inside(core, i, guard)


@helper
def fires_reset(core: int, i: int) -> bool:
    """Whether the guard of a mode fires a reset."""
    plan = plan_of(core)
    found = False
    for row in range(len(plan.resets)):
        found = found or plan.resets[row, 0] == i
    return found
