"""Finding the guards that cross zero inside a step, and the time of the first of them.

A crossing is on the half-open interval (t0, t1]: a guard that is zero where a step begins does not
fire there. Guards are sampled inside the step, and a sampled minimum is refined by a parabola, so
that two crossings inside one step are not missed. Not so where all guards are straight in the
states and so far from zero at both ends that no sample can be near it (`quiet`).
"""

from __future__ import annotations

import math

import numpy as np

from tracewire.solve.core import contact, methods
from tracewire.solve.core.arrays import (
    Ints,
    Vector,
    copy,
    flow_of,
    plan_of,
    progress_of,
    trial_of,
    watch_of,
)
from tracewire.solve.core.codes import (
    DELAY,
    FLOOR,
    FORCE,
    FRACTION,
    GUARD,
    LENGTH,
    MEMORY,
    SIGN,
    WATCHED,
    T,
)
from tracewire.solve.core.flow import FREE, RESTING, SLIDING, held
from tracewire.solve.core.modes import held_levels, jump_time, levels, piece
from tracewire.solve.core.quiet import (
    EDGE,
    HELD_NOISE,
    SAMPLES,
    SLACK,
    all_armed,
    is_quiet,
    keeps_away,
)
from tracewire.solve.core.readings import guard_rates, guard_values
from tracewire.solve.core.units import helper, inlined, unit

CLOSE = 1.0 / 16.0  # of a sample's distance: where a dip is looked at more closely
ROOT = 1e-14
CLEARLY = 4.0  # beyond its level, in units of the noise
MOST_ROUNDS = 200
SOON = 0.01  # of a step
SHOWS = 100.0  # so many times its noise a guard rises until the first sample, if it does
NOTHING, INSIDE, AT_ONCE, TOO_LONG, LEAVES = range(5)


@helper
def watched_count(core: int) -> int:
    """How many margins are watched now."""
    return progress_of(core).ints[WATCHED]


@unit
def watch(core: int) -> None:
    """Fill in what to watch with the modes as they stand, and the margins now."""
    flow, plan, progress = flow_of(core), plan_of(core), progress_of(core)
    watched = watch_of(core)
    count = 0
    for i in range(len(plan.kind)):
        if plan.is_timed[i] or plan.kind[i] == MEMORY or flow.bound[i] != FREE:
            continue
        value = flow.m[i]
        if plan.kind[i] == SIGN:
            sign = 1.0 if value > 0.5 else -1.0
            count = _add(core, count, i, GUARD, 1.0 - value, 0.0, sign)
            continue
        low, high = value, value + 1.0
        if plan.kind[i] == DELAY:
            low = jump_time(core, plan.table[i], value)
            high = jump_time(core, plan.table[i], value + 1.0)
        elif plan.kind[i] != FLOOR:
            low, high = piece(core, plan.table[i], value)
        if low > -np.inf:
            count = _add(core, count, i, GUARD, value - 1.0, low, 1.0)
        if high < np.inf:
            count = _add(core, count, i, GUARD, value + 1.0, high, -1.0)
    for i in range(len(plan.kind)):
        if flow.bound[i] == SLIDING:
            count = _add(core, count, i, FRACTION, 0.0, 0.0, 1.0)
            count = _add(core, count, i, FRACTION, 1.0, 1.0, -1.0)
    for i in range(len(plan.kind)):
        if flow.bound[i] == RESTING:
            count = _add(core, count, i, FORCE, flow.m[i], 0.0, 1.0)
    watched.armed[:] = 0
    progress.ints[WATCHED] = count
    if flow.counts[SLIDING]:
        held(core, progress.now[T], progress.x)
        for i in range(len(flow.grip)):  # where it begins at nothing it is to hold, as all do
            watched.grip[i] = flow.grip[i] if flow.grip[i] != 0.0 else -1.0
    margins(core, progress.now[T], progress.x, watched.start)


@helper
def margins_at_end(core: int) -> None:
    """Let the margins with which the next step begins be those of the last sample of this one."""
    watched = watch_of(core)
    _copy_watched(watched.rows[SAMPLES - 1], watched.start, watched_count(core))


@helper
def _copy_watched(values: Vector, to: Vector, count: int) -> None:
    """Copy the margins that are watched: arrays have room for three times as many."""
    for row in range(count):
        to[row] = values[row]


@helper
def _add(core: int, row: int, mode: int, kind: int, to: float, level: float, sign: float) -> int:
    watched = watch_of(core)
    watched.mode[row], watched.kind[row], watched.to[row] = mode, kind, to
    watched.level[row], watched.sign[row] = level, sign
    return row + 1


@unit
def passed(core: int, out: Ints) -> int:
    """Mark what is clearly beyond its level: guards that move away from it, and fractions, which
    have left so slowly that no step has seen it; how many."""
    watched, progress, count, beyond = watch_of(core), progress_of(core), 0, False
    start = watched.start
    if not _is_any_below(start, watched_count(core)):  # as nearly always
        return 0
    for row in range(watched_count(core)):
        out[row] = 0
        if watched.kind[row] == FRACTION and start[row] < -CLEARLY * HELD_NOISE:
            out[row] = 1
            count += 1
        beyond = beyond or (watched.kind[row] == GUARD and start[row] < 0.0)
    if not beyond:
        return count
    rates, level = trial_of(core).guards, np.empty(len(trial_of(core).guards))
    levels(core, progress.now[T], progress.x, level)
    guard_rates(core, progress.now[T], progress.x, rates)
    for row in range(watched_count(core)):
        clearly = -CLEARLY * level[watched.mode[row]]
        if watched.kind[row] != GUARD or start[row] >= clearly:
            continue
        if watched.sign[row] * rates[watched.mode[row]] < 0.0:
            out[row] = 1
            count += 1
    return count


@helper
def _is_any_below(values: Vector, count: int) -> bool:
    """Whether one of the first values is below zero."""
    below = False
    for row in range(count):
        below = below or values[row] < 0.0
    return below


@unit
def margins(core: int, t: float, x: Vector, out: Vector) -> None:
    """All margins."""
    flow = flow_of(core)
    watched = watch_of(core)
    guards = trial_of(core).guards
    guard_values(core, t, x, guards)
    some, total = flow.counts[SLIDING], watched_count(core)
    count = total - 2 * some - flow.counts[RESTING]
    for row in range(count):
        guard = guards[np.uint64(watched.mode[row])]  # unsigned: no place is counted from the end
        out[row] = watched.sign[row] * (guard - watched.level[row])
    if count < total:
        both = held(core, t, x)
        for slide in range(flow.counts[SLIDING]):
            row = count + 2 * slide
            out[row], out[row + 1] = both[slide], 1.0 - both[slide]
            _mind_grip(core, row, out)
        for rest in range(flow.counts[RESTING]):
            row = count + 2 * flow.counts[SLIDING] + rest
            out[row] = both[flow.counts[SLIDING] + rest]


@helper
def _mind_grip(core: int, row: int, out: Vector) -> None:
    """Let the margins of a fraction be negative where its mode moves the guard the other way.

    A friction whose normal force falls through zero has a fraction that grows to infinity and comes
    back from below. Beyond, it lies between 0 and 1 again, and nothing is held.
    """
    mode = watch_of(core).mode[row]
    grip = flow_of(core).grip[mode]
    if grip == 0.0 and np.isnan(out[row]):
        out[row], out[row + 1] = -1.0, -1.0
    elif grip * watch_of(core).grip[mode] < 0.0:
        out[row], out[row + 1] = -out[row], -out[row + 1]


@unit
def find(core: int, method: int, whole: bool) -> int:
    """The first crossings inside a step whose margins at the start are known.

    Fills `found` with theta in (0, 1] for what crosses first, else with infinity, and `rows` with
    all samples of a step that is looked at as a `whole`, or where a margin may cross. AT_ONCE: it
    crosses right where the step begins. TOO_LONG: it rises first and falls before the first sample.
    LEAVES: what is held is at its limit where the step begins, and then beyond it.
    """
    watched = watch_of(core)
    rows, start, found = watched.rows, watched.start, watched.found
    count = watched_count(core)
    if count == 0:
        return NOTHING
    _margins_inside(core, method, 1.0, rows[SAMPLES - 1])
    if not whole and keeps_away(core, method, count):
        return NOTHING
    for k in range(1, SAMPLES - 1):
        _margins_inside(core, method, k / (SAMPLES - 1), rows[k])
    _copy_watched(start, rows[0], count)
    quiet = is_quiet(core, count)
    if quiet and all_armed(core, count):
        return NOTHING
    floors = np.empty(count)
    _floors(core, floors)
    how = _leaves(core, method, floors)
    if how != NOTHING:
        return how
    if quiet:
        _arm(core, floors)
        return NOTHING
    found[:] = np.inf
    first, fresh = SAMPLES - 1, False
    for k in range(1, SAMPLES):
        for i in range(count):
            floor = floors[i]
            if rows[k, i] < min(start[i], 0.0) - floor:
                first = min(first, k - 1)
                if watched.armed[i] or np.max(rows[:k, i]) > floor:
                    found[i] = 0.0  # to be located
                else:
                    fresh = True
        if first == k - 1:
            break
    if fresh:
        for i in range(count):
            below = rows[first + 1, i] < min(start[i], 0.0) - floors[i]
            found[i] = 1.0 if below and found[i] > 0.0 else np.inf
        return TOO_LONG if _rises(core, floors) else AT_ONCE
    any_found = False
    for i in range(count):
        if found[i] == 0.0:
            low, high = first / (SAMPLES - 1), (first + 1) / (SAMPLES - 1)
            found[i] = _root(core, method, i, low, high)
        # three samples at least: a dip may come before a crossing between the first two
        dip = _dip(core, method, min(max(first + 2, 3), SAMPLES), i, floors[i])
        found[i] = min(found[i], dip)
        any_found = any_found or found[i] < np.inf
    if not any_found:
        _arm(core, floors)
        return NOTHING
    earliest = np.min(found)  # beyond the count it is infinite
    for i in range(count):
        if found[i] - earliest > 4 * ROOT:
            found[i] = np.inf
    return INSIDE


@unit
def _leaves(core: int, method: int, floors: Vector) -> int:
    """Whether what is held begins at its limit, as where an earlier step has ended at a known time,
    and is beyond it right after. Of a force that is so for a part of a step no sample may tell.

    LEAVES: it is at its limit or just beyond; marked in `hit`. AT_ONCE: it reaches it so early
    that no sample may be beyond it; where one is, it is armed, to be located.
    """
    watched, how = watch_of(core), NOTHING
    values = np.empty(len(watched.mode))
    watched.hit[:], watched.found[:] = 0, np.inf
    for i in range(len(floors)):
        start, floor = watched.start[i], floors[i]
        if watched.kind[i] == GUARD or watched.armed[i] or start > floor:
            continue
        beyond = _first_beyond(core, method, i, floor, values)
        if beyond <= 1.0 and start <= 0.0:
            watched.hit[i], how = 1, LEAVES
        elif beyond < 1.0 / (SAMPLES - 1):
            watched.found[i], how = 1.0, max(how, AT_ONCE)
        elif beyond <= 1.0:
            watched.armed[i] = 1
    return how


@helper
def _first_beyond(core: int, method: int, item: int, floor: float, values: Vector) -> float:
    """Where in the step a margin that begins at zero is first seen below, before it has risen."""
    least, theta = min(watch_of(core).start[item], 0.0) - floor, CLOSE**3
    while theta <= 1.0:
        _margins_inside(core, method, theta, values)
        if values[item] > floor:
            return np.inf
        if values[item] < least:
            return theta
        theta *= 4.0
    return np.inf


@helper
def _arm(core: int, floors: Vector) -> None:
    """Arm the margins that have been positive."""
    rows, armed = watch_of(core).rows, watch_of(core).armed
    for i in range(len(floors)):
        for k in range(SAMPLES):
            armed[i] = int(armed[i] or rows[k, i] > floors[i])


@unit
def _rises(core: int, floors: Vector) -> bool:
    """Whether a guard that is found below zero by a sample moves away from zero where the step
    begins, and so fast that a shorter step shows it."""
    watched, trial, rates = watch_of(core), trial_of(core), trial_of(core).guards
    guard_rates(core, trial.ends[0], progress_of(core).x, rates)
    first = trial.ends[1] / (SAMPLES - 1)
    for i in range(len(floors)):
        rises = watched.sign[i] * rates[watched.mode[i]] * first > SHOWS * floors[i]
        if rises and watched.kind[i] == GUARD and watched.found[i] < np.inf:
            return True
    return False


@unit
def _floors(core: int, out: Vector) -> None:
    """How far below zero each margin may be by rounding."""
    flow, trial, watched = flow_of(core), trial_of(core), watch_of(core)
    level, total = np.empty(len(flow.bound)), len(out)
    held_levels(core, trial.ends[0], trial.x, level)
    forces = total - flow.counts[RESTING]
    for row in range(total):
        guard = watched.kind[row] == GUARD
        out[row] = level[watched.mode[row]] if guard else HELD_NOISE
    if forces < total:
        size = contact.force_sizes(core, trial.ends[0], trial.x)
        for row in range(forces, total):
            out[row] = HELD_NOISE * size[row - forces]


@inlined
def _margins_inside(core: int, method: int, theta: float, out: Vector) -> None:
    trial = trial_of(core)
    if theta == 1.0:
        copy(trial.x_end, trial.at)
    else:
        methods.inside(core, method, theta, trial.at)
    margins(core, trial.ends[0] + theta * trial.ends[1], trial.at, out)


@unit
def _root(core: int, method: int, item: int, low: float, high: float) -> float:
    """Where a margin falls through zero between two samples: false position."""
    values = np.empty(len(watch_of(core).mode))
    _margins_inside(core, method, low, values)
    above = values[item]
    if above <= 0.0:
        return low
    _margins_inside(core, method, high, values)
    below = values[item]
    if below >= 0.0:
        return high
    side = 0
    for round_ in range(MOST_ROUNDS):
        width = high - low
        if width <= ROOT:
            break
        theta = low + width * above / (above - below)
        if round_ % 4 == 3 or not low < theta < high:
            theta = low + 0.5 * width
        _margins_inside(core, method, theta, values)
        value = values[item]
        if value == 0.0:
            return theta
        if value > 0.0:  # the end that stays twice counts half: Illinois
            low, above = theta, value
            below *= 0.5 if side > 0 else 1.0
            side = 1
        else:
            high, below = theta, value
            above *= 0.5 if side < 0 else 1.0
            side = -1
    return high


@helper
def _dip(core: int, method: int, count: int, item: int, floor: float) -> float:
    """Where a margin dips below zero between positive samples, foretold by a parabola; inf: not."""
    rows = watch_of(core).rows
    step = 1.0 / (SAMPLES - 1)
    for k in range(1, count - 1):
        before, here, after = rows[k - 1, item], rows[k, item], rows[k + 1, item]
        bend, slope = after - 2 * here + before, after - before
        if not (bend > 0 and abs(slope) <= EDGE * bend):
            continue
        if not (slope * slope > bend * (8 * here - SLACK * bend) and before > floor):
            continue
        place = min(SAMPLES - 1 - CLOSE, max(CLOSE, k - slope / (2 * bend)))
        values = np.empty((3, rows.shape[1]))
        for i in range(3):  # closer by, where the parabola is better
            _margins_inside(core, method, (place + CLOSE * (i - 1)) * step, values[i])
        bend = values[2, item] - 2 * values[1, item] + values[0, item]
        if bend > 0:
            place -= CLOSE * (values[2, item] - values[0, item]) / (2 * bend)
        place = min(SAMPLES - 1.0, max(0.0, place))
        _margins_inside(core, method, place * step, values[1])
        if values[1, item] < -floor:
            return _root(core, method, item, math.ceil(place - 1.0) * step, place * step)
    return np.inf


@unit
def reached(core: int, t: float, x: Vector, reach: float, out: Ints) -> int:
    """Mark the guards whose level is passed, or will be within the time `reach`; how many.

    One that has come so near that it counts as zero, and goes on, may take longer, up to a small
    part of the step: with the modes of this instant it would pass without a word.
    """
    watched = watch_of(core)
    total, start = watched_count(core), watched.start
    out[:] = 0
    if total == 0 or watched.kind[0] != GUARD:
        return 0
    rates = trial_of(core).guards
    guard_rates(core, t, x, rates)
    level, count = np.empty(len(rates)), 0
    levels(core, t, x, level)
    for row in range(total):
        if watched.kind[row] != GUARD:
            continue
        falls, floor = -watched.sign[row] * rates[watched.mode[row]], level[watched.mode[row]]
        near = watched.armed[row] and start[row] <= floor
        soon = max(reach, SOON * trial_of(core).ends[1]) if near else reach
        if start[row] < -floor or (falls > 0 and start[row] <= soon * falls):
            out[row] = 1
            count += 1
    return count


@helper
def smallest_step(core: int) -> float:
    """The step below which a run cannot go on."""
    progress = progress_of(core)
    t = abs(progress.now[T])
    return max(1e-15 * progress.now[LENGTH], 16 * (np.nextafter(t, np.inf) - t))
