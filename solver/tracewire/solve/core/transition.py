"""What happens at an instant: resets from x⁻ to x⁺, then the modes come to rest, then the log."""

from __future__ import annotations

import numpy as np

from tracewire.solve.core import contact
from tracewire.solve.core.arrays import (
    Ints,
    Matrix,
    Vector,
    copy,
    crossings_of,
    flow_of,
    plan_of,
    progress_of,
)
from tracewire.solve.core.codes import (
    BOTH,
    CHANGES,
    CHATTER,
    CHATTER_EVENTS,
    CROSSED,
    CROSSING,
    DELAY,
    DOWN,
    ENDLESS,
    FINISHED,
    FORCE,
    FRACTION,
    GUARD,
    LENGTH,
    MEMORY,
    NO_END,
    PASSED,
    RECENT,
    REST,
    SCHEDULED,
    SEGMENT,
    SIGN,
    SLIP,
    STICK,
    TIME,
    UP,
    WAITS,
)
from tracewire.solve.core.flow import FREE, RESTING, SLIDING, bind
from tracewire.solve.core.history import is_delayed, mark_jumps
from tracewire.solve.core.modes import JUMP, levels
from tracewire.solve.core.readings import guard_rates, guard_values
from tracewire.solve.core.record import log
from tracewire.solve.core.resets import (
    MOST_RESETS,
    begin_stage,
    carried,
    driven_together,
    fire_carried,
    follow,
    later,
    write,
)
from tracewire.solve.core.saltation import enter, leave, reset_sensitivities
from tracewire.solve.core.settle import KNOWN, LEFT, forget, marked_guards, settle, stands
from tracewire.solve.core.units import helper, unit

CHATTER_PART = 1e-6


@helper
def no_crossings(core: int) -> None:
    """Nothing happens yet."""
    crossings = crossings_of(core)
    crossings.how[:] = -1


@unit
def happen(core: int, t: float, x: Vector) -> int:
    """Fire what is due, settle the modes and log it; `x` becomes x⁺. A status."""
    flow = flow_of(core)
    plan = plan_of(core)
    progress = progress_of(core)
    crossings = crossings_of(core)
    modes = len(plan.kind)
    enter(core, t, x)
    if _only_pass_points(core, t, x):
        return FINISHED
    for j in range(len(x)):
        x[j] += progress.beyond[j]
    progress.beyond[:] = 0.0
    begin_stage(core, x)
    before, old, bound = x.copy(), flow.m.copy(), flow.bound.copy()
    flags, numbers = np.zeros((3, modes), dtype=np.int64), np.zeros((2, modes))
    fired = flags[0]  # the last reset that the guard of a mode fired
    fired[:] = -1
    turned, marks = flags[1], flags[2]
    speed = numbers[0]  # the guard's rate before it fired, along its side
    done = np.zeros(len(plan.resets), dtype=np.int64)
    jumps = np.zeros((modes if len(done) else 0, len(x)))
    status = _resets(core, t, x, done, fired, speed, turned, jumps)
    if status != FINISHED:
        return status
    for reset in range(len(done)):
        i = plan.resets[reset, 0]
        own = i >= 0 and (crossings.how[i] >= 0 or fired[i] >= 0)
        crossings.due[reset] = CROSSED if own else 0
    _cross(core, t, before, x, turned, marks)
    for i in range(modes):
        if turned[i]:
            marks[i] = LEFT
            flow.m[i] = 1.0 if contact.side_of(core, fired[i]) > 0 else 0.0
    status = settle(core, t, x, marks, False)
    if status == FINISHED and _unturned(core, t, x, fired, speed, turned, marks):
        status = settle(core, t, x, marks, False)
    if status != FINISHED:
        return status
    waits = numbers[1]
    waits[:] = contact.FLIES
    closed = False
    for i in range(modes):
        if not turned[i] or flow.bound[i] != FREE:
            continue
        side = contact.side_of(core, fired[i])
        waits[i] = contact.wait(core, t, x, i, speed[i], side)
        if waits[i] >= 0:
            contact.close(core, t, jumps[i], x, i)
            closed = True
    if closed:
        for i in range(modes):
            marks[i] = LEFT if turned[i] else 0
        status = settle(core, t, x, marks, False)
        if status != FINISHED:
            return status
    _write_log(core, t, before, x, done, fired, waits, old, bound)
    for i in range(modes):
        shrinks = progress.flights[i, 0] < np.inf
        if crossings.how[i] in (GUARD, FRACTION, FORCE, PASSED) and not shrinks:
            status = _count(core, t, i)
            if status != FINISHED:
                return status
    status = _carry_on(core, t, x, fired, marks)
    crossings.known[0] = 0
    if is_delayed(core):
        mark_jumps(core, t, before, x, old, bound)
    leave(core, t, before, x, old, waits)
    return status


@unit
def _only_pass_points(core: int, t: float, x: Vector) -> bool:
    """Let tables of t go on to their next points, and clocks; whether that is all that happens, as
    at most samples of a measured input."""
    flow, plan, crossings = flow_of(core), plan_of(core), crossings_of(core)
    modes = len(plan.kind)
    if is_delayed(core):
        return False
    for i in range(modes):
        passes = crossings.how[i] == TIME and plan.kind[i] == SEGMENT
        if crossings.how[i] >= 0 and not (passes or crossings.how[i] == CHANGES):
            return False
    numbers = np.empty((4, modes))
    old, waits = numbers[0], numbers[1]
    for i in range(modes):
        old[i], waits[i] = flow.m[i], contact.FLIES
        if crossings.how[i] >= 0:
            flow.m[i] = crossings.to[i]
    if stands(core, t, x, numbers[2], numbers[3]):
        leave(core, t, x, x, old, waits)
        return True
    for i in range(modes):
        flow.m[i] = old[i]
    return False


@unit
def _unturned(
    core: int, t: float, x: Vector, fired: Ints, speed: Vector, turned: Ints, marks: Ints
) -> bool:
    """Let guards cross after all that only seemed to turn: with the modes that have come to rest
    they go on over their level. Whether there were any; they, and those that turned, are marked."""
    flow = flow_of(core)
    found = False
    if not np.any(turned):
        return found
    along = np.empty(len(turned))
    guard_rates(core, t, x, along)
    for i in range(len(turned)):
        marks[i] = LEFT if turned[i] else 0
        if not turned[i] or flow.bound[i] != FREE:
            continue
        side = contact.side_of(core, fired[i])
        if side * along[i] < contact.STOPPED * speed[i]:
            turned[i], marks[i], found = 0, KNOWN, True
            flow.m[i] = 0.0 if side > 0 else 1.0
    return found


@unit
def _resets(
    core: int,
    t: float,
    x: Vector,
    done: Ints,
    fired: Ints,
    speed: Vector,
    turned: Ints,
    jumps: Matrix,
) -> int:
    """Fire the resets that are due, and those of contacts that they drive together."""
    plan = plan_of(core)
    progress = progress_of(core)
    crossings = crossings_of(core)
    count, modes = len(plan.resets), len(plan.kind)
    if count == 0:
        return FINISHED
    due, along = np.zeros(count, dtype=np.int64), np.empty(modes)
    guard_rates(core, t, x, along)
    for reset in range(count):
        i, direction = plan.resets[reset, 0], plan.resets[reset, 1]
        if i >= 0 and (crossings.how[i] in (GUARD, TIME, PASSED)):
            due[reset] = direction == 0 or direction == (UP if crossings.up[i] else DOWN)
    for _ in range(MOST_RESETS):
        if not np.any(due):
            return FINISHED
        before, modes_before = x.copy(), flow_of(core).m.copy()
        status = write(core, t, before, x, due)
        if status != FINISHED:
            return status
        reset_sensitivities(core, t, before, due, flow_of(core).m)
        contact.struck(core, t, before, x)
        follow(core, t, x)  # whether a rate has turned is a matter of the field that holds now
        for reset in np.flatnonzero(due):
            i = plan.resets[reset, 0]
            side = contact.side_of(core, reset)
            done[reset], fired[i], speed[i] = 1, reset, side * along[i]
            timed = crossings.how[i] == TIME
            turned[i] = not timed and contact.turns(
                core, t, before, modes_before, x, i, speed[i], side
            )
            jumps[i] = x - before
        driven_together(core, t, x, along, due)
        guard_rates(core, t, x, along)
        copy(modes_before, flow_of(core).m)
    progress.info[0] = t
    progress.which[0], progress.which[1] = 1, plan.resets[np.flatnonzero(due)[0], 0]
    return NO_END


@unit
def _carry_on(core: int, t: float, x: Vector, fired: Ints, marks: Ints) -> int:
    """Fire the resets whose guards the jumps of this instant have carried over zero, then those
    that these carry over in turn. `fired` marks the guards whose resets have fired. A status."""
    flow, plan, crossings = flow_of(core), plan_of(core), crossings_of(core)
    if len(plan.resets) == 0:
        return FINISHED
    progress, due = progress_of(core), np.zeros(len(plan.resets), dtype=np.int64)
    no_crossings(core)
    waits, marked = np.full(len(plan.kind), contact.FLIES), np.empty((2, len(plan.kind)))
    for _ in range(MOST_RESETS):
        for reset in range(len(due)):
            due[reset] = crossings.due[reset]
        status = carried(core, t, crossings.x, x, crossings.m, crossings.bound, due)
        for reset in range(len(due)):
            crossings.due[reset] = later(crossings.due[reset])
        if status != FINISHED or not np.any(due):
            return status
        fired[:] = -1
        for reset in np.flatnonzero(due):
            i = plan.resets[reset, 0]
            fired[i], progress.which[0], progress.which[1] = reset, 1, i
        begin_stage(core, x)
        states, modes, held = x.copy(), flow.m.copy(), flow.bound.copy()
        marked_guards(core, t, x, marks, marked)
        status = fire_carried(core, t, x, due)
        if status == FINISHED:
            forget(core, t, x, marked, marks)
            status = settle(core, t, x, marks, False)
        if status != FINISHED:
            return status
        _write_log(core, t, states, x, due, fired, waits, modes, held)
    progress.info[0] = t
    return ENDLESS


@unit
def _cross(core: int, t: float, before: Vector, after: Vector, turned: Ints, marks: Ints) -> None:
    """Set the modes that are known; mark guards that are zero, and slides that were left."""
    flow = flow_of(core)
    crossings = crossings_of(core)
    plan = plan_of(core)
    modes, some = len(plan.kind), False
    for i in range(modes):
        some = some or (crossings.how[i] >= 0 and not turned[i])
    if not some:
        return
    guards = np.empty((3, modes))
    here, there, level = guards[0], guards[1], guards[2]
    guard_values(core, t, before, here)
    guard_values(core, t, after, there)
    levels(core, t, before, level)
    for i in range(modes):
        how = crossings.how[i]
        if how < 0 or turned[i]:
            continue
        if how == FRACTION:  # to the side that it reached, stored
            bind(core, i, FREE)
            flow.m[i], flow.m[modes + i] = crossings.to[i], 0.0
            marks[i] = LEFT
        elif how == FORCE:
            contact.release(core, i)
            marks[i] = LEFT
        elif how in (TIME, PASSED, CHANGES):
            flow.m[i] = crossings.to[i]
        elif how == WAITS:
            marks[i] = LEFT
        elif plan.kind[i] != SIGN:
            flow.m[i] = crossings.to[i]
            if abs(there[i] - here[i]) <= level[i]:
                marks[i] = LEFT  # though rounding may have located it too early
        elif abs(there[i] - here[i]) <= level[i]:
            # it was seen beyond: this counts where the derivatives do not tell
            flow.m[i], marks[i] = crossings.to[i], KNOWN
    guard_values(core, t, after, here)
    for i in range(modes):
        jumps = abs(here[i] - there[i]) > JUMP * level[i]
        if marks[i] == KNOWN and jumps:  # a guard that its own mode moves is decided by trial
            flow.m[i] = 1.0 - flow.m[i]


@unit
def _write_log(
    core: int,
    t: float,
    before: Vector,
    after: Vector,
    done: Ints,
    fired: Ints,
    waits: Vector,
    old: Vector,
    bound: Ints,
) -> None:
    """Log what crossed, and every other mode that changed with it."""
    flow = flow_of(core)
    plan = plan_of(core)
    crossings = crossings_of(core)
    for reset in range(len(done)):
        if not done[reset]:
            continue
        i = plan.resets[reset, 0]
        way = plan.resets[reset, 1]
        if crossings.how[i] >= 0:
            way = UP if crossings.up[i] else DOWN
        elif way == BOTH:
            way = UP if flow.m[i] > 0.5 else DOWN
        log(core, t, plan.resets[reset, 4], i, way, before, after)
    for i in range(len(plan.kind)):
        how, up = crossings.how[i], UP if crossings.up[i] else DOWN
        entered = flow.bound[i] == SLIDING and bound[i] == FREE
        gone = flow.bound[i] == FREE and bound[i] != FREE
        silent = plan.kind[i] in (SEGMENT, MEMORY, DELAY) or how in (CHANGES, WAITS)
        if how >= 0 and fired[i] < 0 and not (silent or gone or entered):
            log(core, t, SCHEDULED if how == TIME else CROSSING, i, up, before, after)
    for i in range(len(plan.kind)):
        gone = flow.bound[i] == FREE and bound[i] != FREE
        silent = plan.kind[i] in (SEGMENT, MEMORY, DELAY)
        up = UP if flow.m[i] > (0.5 if gone else old[i]) else DOWN
        if flow.bound[i] == SLIDING and bound[i] == FREE:
            log(core, t, STICK, i, 0, before, after)
        elif gone:
            log(core, t, SLIP, i, up, before, after)
        elif flow.bound[i] == RESTING and bound[i] != RESTING:
            log(core, t + max(waits[i], 0.0), REST, i, 0, before, after)
        elif flow.m[i] != old[i] and not silent and crossings.how[i] < 0 and fired[i] < 0:
            log(core, t, CROSSING, i, up, before, after)


@unit
def _count(core: int, t: float, i: int) -> int:
    """Count an event; many in next to no time are chatter."""
    progress = progress_of(core)
    number = progress.ints[RECENT]
    progress.recent[number % CHATTER_EVENTS, 0] = t
    progress.recent[number % CHATTER_EVENTS, 1] = i
    progress.ints[RECENT] = number + 1
    if number + 1 < CHATTER_EVENTS:
        return FINISHED
    first = progress.recent[(number + 1) % CHATTER_EVENTS, 0]
    if t - first >= CHATTER_PART * progress.now[LENGTH]:
        return FINISHED
    often, most = 0, -1
    for row in range(CHATTER_EVENTS):
        same = np.sum(progress.recent[:, 1] == progress.recent[row, 1])
        if same > most:
            most, often = same, int(progress.recent[row, 1])
    progress.info[0], progress.info[1] = t, t - first
    progress.which[0], progress.which[1] = 1, often
    return CHATTER
