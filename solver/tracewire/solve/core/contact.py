"""Contacts: impacts, the end of a Zeno sequence, and contacts that rest.

An impact is a reset that turns the rate of its guard: g' < 0 before, g' >= 0 after (on the side
where g >= 0). With g'' < 0 the next flight lasts 2g'/|g''|. Where two flights in a row are below
what can be resolved and the second is the shorter one, or where the next could not be seen at all,
the contact closes at t + flight/(1 - ratio), the sum of the geometric series, and rests: its guard
is held at zero by a force along the jump of its reset. A guard of an impact that is zero with
g' = 0 and g'' < 0, at the start or when a force comes back, rests at once.
"""

from __future__ import annotations

import numpy as np

from tracewire.solve.core.arrays import Vector, flow_of, plan_of, progress_of
from tracewire.solve.core.codes import LENGTH, SIGN, UP
from tracewire.solve.core.flow import (
    CURVES,
    FREE,
    RESETS,
    RESTING,
    RHS,
    SECOND_SIZES,
    bind,
    evaluate,
    rates,
    sizes,
)
from tracewire.solve.core.linear import dot
from tracewire.solve.core.modes import NOTHING, levels
from tracewire.solve.core.readings import guard_rates, guard_values, guard_values_then
from tracewire.solve.core.surface import pin
from tracewire.solve.core.units import helper, unit

RESOLVED = 32.0  # a flight is resolved if it rises over so many times the noise of a guard
SHORTEST = 1e-11  # of the span
STOPPED = 1e-12  # of the rate before the impact
FLIES = -1.0


@unit
def curve(core: int, t: float, x: Vector, i: int) -> Vector:
    """The gradient of a guard's rate in the states, and behind it its change with t alone."""
    flow = flow_of(core)
    curves = np.empty((len(flow.bound), len(x) + 1))
    evaluate(core, CURVES, t, x, curves)
    return curves[i].copy()


@unit
def bend(core: int, t: float, x: Vector, i: int) -> float:
    """The second derivative of a guard along the flow."""
    slope, field, n = curve(core, t, x, i), np.empty(len(x)), len(x)
    rates(core, t, x, field)
    return float(dot(slope[:n], field) + slope[n])


@unit
def turns(
    core: int,
    t: float,
    before: Vector,
    then: Vector,
    after: Vector,
    i: int,
    old: float,
    side: float,
) -> bool:
    """Whether a reset is an impact: it turns the guard's rate, was `old`, and keeps the guard.

    `then` are the modes before: a guard that jumps with a mode that follows the reset is not kept.
    `side` is 1 where the guard stays above zero, -1 where below; `old` counts along it.
    """
    flow = flow_of(core)
    modes, n = len(flow.bound), len(before)
    along, here, there = np.empty(modes), np.empty(modes), np.empty(modes)
    guard_rates(core, t, after, along)
    if not (old < 0 and side * along[i] >= STOPPED * old):
        return False
    slope = curve(core, t, after, i)[:n]
    if not side * dot(slope, after - before) > 0:
        return False
    level = np.empty(modes)
    guard_values_then(core, t, before, then, flow.bound, here)
    guard_values(core, t, after, there)
    levels(core, t, before, level)
    return bool(abs(there[i] - here[i]) <= level[i])


@unit
def wait(core: int, t: float, x: Vector, i: int, old: float, side: float) -> float:
    """The time until the contact closes; FLIES where it flies on."""
    flow = flow_of(core)
    progress = progress_of(core)
    along, level = np.empty(len(flow.bound)), np.empty(len(flow.bound))
    guard_rates(core, t, x, along)
    levels(core, t, x, level)
    rate = max(0.0, side * along[i])
    down = side * bend(core, t, x, i)
    if not down < 0:
        progress.flights[i, 0], progress.flights[i, 1] = np.inf, 0.0
        return FLIES
    flight = -2 * rate / down
    height = rate * flight / 4
    small = height <= RESOLVED * level[i] or flight <= SHORTEST * progress.now[LENGTH]
    last, was_small = progress.flights[i, 0], progress.flights[i, 1]
    progress.flights[i, 0], progress.flights[i, 1] = flight, 1.0 if small else 0.0
    if rate <= -STOPPED * old:
        return 0.0
    lost = height <= level[i]  # the next impact could not be seen
    closes = flight < last and (lost or (small and was_small > 0))
    return flight / (1 - flight / last) if closes else FLIES


@unit
def close(core: int, t: float, jump: Vector, x: Vector, i: int) -> None:
    """Let the contact rest: a force along `jump`; the guard and its rate become zero in `x`."""
    flow = flow_of(core)
    modes = len(flow.bound)
    flow.push[i] = jump / np.max(np.abs(jump))
    bind(core, i, RESTING)
    flow.m[modes + i] = 1.0
    progress = progress_of(core)
    pin(core, t, x)  # what the location of the impact has left
    progress.flights[i, 0], progress.flights[i, 1] = np.inf, 0.0


@unit
def force_sizes(core: int, t: float, x: Vector) -> Vector:
    """Of what size are the forces on the contacts that rest, which their forces balance."""
    flow = flow_of(core)
    n, modes, row = len(x), len(flow.bound), 0
    found, field, curves = np.zeros(flow.counts[RESTING]), np.empty(n), np.empty((modes, n + 1))
    evaluate(core, RHS, t, x, field)
    evaluate(core, CURVES, t, x, curves)
    for i in range(modes):
        if flow.bound[i] == RESTING:
            total, turned = abs(curves[i, n]), 0.0
            for j in range(n):
                total += abs(curves[i, j] * field[j])
                turned += abs(curves[i, j] * flow.push[i, j])
            found[row] = total / turned if turned > 0.0 else 0.0
            row += 1
    return found


@helper
def release(core: int, i: int) -> None:
    """Let a contact go."""
    flow = flow_of(core)
    bind(core, i, FREE)
    flow.m[len(flow.bound) + i] = 0.0


@unit
def struck(core: int, t: float, before: Vector, after: Vector) -> None:
    """Let the contacts go whose guard's rate a reset has changed."""
    flow = flow_of(core)
    jump, n = after - before, len(before)
    if flow.counts[RESTING] == 0 or not np.any(jump != 0):
        return
    for i in np.flatnonzero(flow.bound == RESTING):
        slope = curve(core, t, after, i)[:n]
        change = dot(slope, jump)
        if abs(change) > STOPPED * dot(np.abs(slope), np.abs(jump)):
            release(core, i)


@helper
def side_of(core: int, reset: int) -> float:
    """On which side of its guard a contact lies: 1 where the guard is positive."""
    plan = plan_of(core)
    return -1.0 if plan.resets[reset, 1] == UP else 1.0


@unit
def reset_jump(core: int, t: float, x: Vector, reset: int, out: Vector) -> None:
    """What a reset that reads x would change."""
    plan = plan_of(core)
    total = len(plan.writes)
    values = np.empty(total)
    evaluate(core, RESETS, t, x, values)
    out[:] = 0.0
    first = plan.resets[reset, 2]
    for row in range(first, first + plan.resets[reset, 3]):
        out[plan.writes[row]] = values[row] - x[plan.writes[row]]


@unit
def touching(core: int, t: float, x: Vector, reset: int, level: Vector, higher: float) -> bool:
    """Whether a contact whose guard is zero stays closed; it then rests. `level`: of the rates,
    `higher`: the first derivative of the guard, from the second on, that is not zero.

    It does where g' = 0 and g'' < 0 and its reset, had the bodies met, would push them apart; where
    g'' = 0, as when a friction lets go that has held the body there, the next one decides.
    """
    flow = flow_of(core)
    plan = plan_of(core)
    i, side, n = plan.resets[reset, 0], side_of(core, reset), len(x)
    if plan.kind[i] != SIGN or plan.resets[reset, 1] == 0 or flow.bound[i] != FREE:
        return False
    along = np.empty(len(flow.bound))
    guard_rates(core, t, x, along)
    if abs(along[i]) > level[i]:
        return False
    bends = np.empty(len(flow.bound))
    sizes(core, SECOND_SIZES, t, x, bends)
    old = flow.m[i]
    flow.m[i] = 1.0 if side > 0 else 0.0
    slope = curve(core, t, x, i)[:n]
    square = dot(slope, slope)
    jump = np.zeros(n)
    second, nothing = side * bend(core, t, x, i), NOTHING * bends[i]
    pressed = second < -nothing or (second <= nothing and side * higher < 0)
    if square > 0 and pressed:
        # the reset of bodies that approach tells the direction in which it pushes
        reset_jump(core, t, x - slope * (side / square), reset, jump)
    if side * dot(slope, jump) > 0:
        close(core, t, jump, x, i)
        return True
    flow.m[i] = old
    return False
