"""Resets: what an event writes, those of transitions, and those whose guard a jump carries over.

A guard that passes through zero is located, and its reset is due there (`transition`). A guard that
a jump carries over zero, that of a square wave with a ripple, fires at the instant of the jump,
when all modes stand still there: its reset reads what the others wrote.
"""

from __future__ import annotations

import math

import numpy as np

from tracewire.solve.core import contact
from tracewire.solve.core.arrays import (
    Ints,
    Vector,
    copy,
    crossings_of,
    flow_of,
    plan_of,
    progress_of,
)
from tracewire.solve.core.codes import (
    ARRIVED,
    BAD_RESET,
    BOTH,
    CARRIED,
    CROSSED,
    DOWN,
    FINISHED,
    IMPACT,
    NO_END,
    SIGN,
    TRANSITION,
    TWO_WRITES,
    UP,
)
from tracewire.solve.core.decide import first_higher
from tracewire.solve.core.flow import FREE, RESTING, SLIDING
from tracewire.solve.core.modes import JUMP, levels, margin, mode_value, rate_levels
from tracewire.solve.core.readings import guard_rates, guard_values, guard_values_then, reset_values
from tracewire.solve.core.record import log
from tracewire.solve.core.saltation import reset_sensitivities
from tracewire.solve.core.units import helper, unit

MOST_RESETS = 100
MOST_FOLLOWED = 4  # rounds in which guards follow the modes of others


@unit
def write(core: int, t: float, before: Vector, x: Vector, due: Ints) -> int:
    """Write the new values of all resets that are due, each of which reads x⁻. A status:
    TWO_WRITES where two of them give one state different values, BAD_RESET for no number."""
    plan = plan_of(core)
    progress = progress_of(core)
    values, by = np.empty(len(plan.writes)), np.full(len(x), -1)
    reset_values(core, t, before, values)
    for reset in np.flatnonzero(due):
        first = plan.resets[reset, 2]
        for row in range(first, first + plan.resets[reset, 3]):
            state, value = plan.writes[row], values[row]
            other = by[state] >= 0 and x[state] != value
            if not math.isfinite(value) or other:
                progress.info[0], progress.info[1], progress.info[2] = t, value, x[state]
                progress.which[0], progress.which[1] = state, reset
                progress.which[2] = by[state]
                return TWO_WRITES if other else BAD_RESET
            x[state] = value
            by[state] = reset
    return FINISHED


@unit
def fire_transitions(core: int, t: float, x: Vector, moved: Ints) -> int:
    """Fire every transition that is due, at most one of a memory; `moved` marks the memories that
    moved. All their resets read x before and write together. A status."""
    flow, plan = flow_of(core), plan_of(core)
    moved[:] = 0
    if len(plan.transitions) == 0:
        return FINISHED
    before, old, to = x.copy(), flow.m.copy(), flow.m.copy()
    fired = np.zeros(len(plan.resets), dtype=np.int64)
    still = np.zeros(len(plan.kind), dtype=np.int64)
    if flow.counts[SLIDING] or flow.counts[RESTING]:
        _stand_still(core, t, x, still)
    for row in range(len(plan.transitions)):
        memory, trigger = plan.transitions[row, 0], plan.transitions[row, 2]
        if moved[memory] or old[memory] != plan.transitions[row, 1]:
            continue
        if flow.bound[trigger] == FREE and not still[trigger]:
            ready = old[trigger] == plan.transitions[row, 5]
        else:
            ready = plan.transitions[row, 6] == 1
        if not ready:
            continue
        moved[memory], to[memory] = 1, plan.transitions[row, 3]
        reset = plan.transitions[row, 4]
        if reset >= 0:
            fired[reset] = 1
    along = np.empty(len(plan.kind))
    if np.any(fired):
        guard_rates(core, t, x, along)
        status = _join_carried(core, t, x, fired)
        if status == FINISHED:
            status = write(core, t, before, x, fired)
        if status != FINISHED:
            return status
    copy(to, flow.m)
    if np.any(fired):
        reset_sensitivities(core, t, before, fired, old)
        contact.struck(core, t, before, x)
    for memory in np.flatnonzero(moved):
        log(core, t, TRANSITION, memory, int(np.sign(flow.m[memory] - old[memory])), before, x)
    for reset in np.flatnonzero(fired):
        i = plan.resets[reset, 0]
        if i >= 0:
            log(core, t, plan.resets[reset, 4], i, UP if old[i] > 0.5 else DOWN, before, x)
    return _fire_driven(core, t, x, along) if np.any(fired) else FINISHED


@helper
def begin_stage(core: int, x: Vector) -> None:
    """Remember how a stage of this instant begins."""
    flow, crossings = flow_of(core), crossings_of(core)
    copy(x, crossings.x)
    copy(flow.m, crossings.m)
    for i in range(len(flow.bound)):
        crossings.bound[i] = flow.bound[i]
    crossings.known[0] = 1


@helper
def later(due: int) -> int:
    """What is known of a reset, in the stages that follow, where it has fired if it was due."""
    return ARRIVED if due < 0 else 0


@unit
def _join_carried(core: int, t: float, x: Vector, fired: Ints) -> int:
    """Beside what transitions fire, mark the resets whose guards this stage has carried over zero:
    all that is due at once reads the same states. A new stage begins. A status."""
    crossings = crossings_of(core)
    if crossings.known[0] == 0:
        return FINISHED
    due = crossings.due.copy()
    status = carried(core, t, crossings.x, x, crossings.m, crossings.bound, due)
    for reset in range(len(due)):
        fired[reset] |= due[reset]
        crossings.due[reset] = later(crossings.due[reset])
    begin_stage(core, x)
    return status


@unit
def _stand_still(core: int, t: float, x: Vector, still: Ints) -> None:
    """Mark the triggers that are zero and stay so because what they read is held: the rate of a
    body behind a gear, while friction holds the body."""
    flow, plan = flow_of(core), plan_of(core)
    modes = len(plan.kind)
    guards, level, along, small = np.empty(modes), np.empty(modes), np.empty(modes), np.empty(modes)
    guard_values(core, t, x, guards)
    levels(core, t, x, level)
    guard_rates(core, t, x, along)
    rate_levels(core, t, x, small)
    for row in range(len(plan.transitions)):
        i = plan.transitions[row, 2]
        if flow.bound[i] != FREE or plan.kind[i] != SIGN or plan.is_timed[i] or still[i]:
            continue
        near = abs(guards[i]) <= level[i] and abs(along[i]) <= small[i]
        if near and first_higher(core, t, x, i) == 0.0:
            still[i] = 1


@unit
def carried(
    core: int, t: float, before: Vector, x: Vector, old: Vector, bound: Ints, due: Ints
) -> int:
    """Mark in `due` the resets whose guard has jumped over zero since the states `before`, with the
    modes `old` and what was held then, `bound`, and the impacts of bodies that are so near to a
    stop that they count as on it, and go on. A status: CARRIED where a body jumps over a stop.

    Not those of guards that crossed on their own in this stage, and not those of guards that have
    since then stood where they arrived: what goes on from there is the same crossing.
    """
    flow, plan, progress = flow_of(core), plan_of(core), progress_of(core)
    some, modes = False, len(plan.kind)
    for reset in range(len(plan.resets)):
        i, direction = plan.resets[reset, 0], plan.resets[reset, 1]
        was, due[reset] = due[reset], 0
        if i < 0 or was == CROSSED or plan.kind[i] != SIGN:
            continue
        if flow.bound[i] != FREE or bound[i] != FREE or flow.m[i] == old[i]:
            continue
        due[reset] = direction == BOTH or direction == (UP if flow.m[i] > 0.5 else DOWN)
        some = some or due[reset] == 1
    if not some:
        return FINISHED
    here, there, level = np.empty(modes), np.empty(modes), np.empty(modes)
    levels(core, t, x, level)
    guard_values(core, t, x, there)
    guard_values_then(core, t, before, old, bound, here)
    for reset in range(len(plan.resets)):
        i = plan.resets[reset, 0]
        if due[reset] == 0:
            continue
        jumped = abs(there[i] - here[i]) > JUMP * level[i]
        stood = crossings_of(core).due[reset] == ARRIVED and abs(here[i]) <= JUMP * level[i]
        impact = plan.resets[reset, 4] == IMPACT
        due[reset] = (jumped or impact) and not stood
        if jumped and impact and not stood:
            progress.which[0], progress.which[1] = reset, i
            progress.info[0], progress.info[1], progress.info[2] = t, here[i], there[i]
            return CARRIED
    return FINISHED


@unit
def fire_carried(core: int, t: float, x: Vector, due: Ints) -> int:
    """Fire the resets that are due because a jump has carried their guards over zero, and the
    impacts that they drive. A status."""
    before, old, along = x.copy(), flow_of(core).m.copy(), np.empty(len(plan_of(core).kind))
    guard_rates(core, t, x, along)
    status = write(core, t, before, x, due)
    if status != FINISHED:
        return status
    reset_sensitivities(core, t, before, due, old)
    contact.struck(core, t, before, x)
    return _fire_driven(core, t, x, along)


@unit
def _fire_driven(core: int, t: float, x: Vector, along: Vector) -> int:
    """Fire the impacts of bodies that lie on a stop and that a reset has driven against it, then
    those that these drive. `along`: the rates of the guards before the reset. A status."""
    flow, plan, progress = flow_of(core), plan_of(core), progress_of(core)
    due = np.zeros(len(plan.resets), dtype=np.int64)
    for _ in range(MOST_RESETS):
        follow(core, t, x)  # a rate is that of the field that holds now
        driven_together(core, t, x, along, due)
        if not np.any(due):
            return FINISHED
        before, old = x.copy(), flow.m.copy()
        guard_rates(core, t, x, along)
        status = write(core, t, before, x, due)
        if status != FINISHED:
            return status
        reset_sensitivities(core, t, before, due, old)
        contact.struck(core, t, before, x)
        for reset in np.flatnonzero(due):
            i = plan.resets[reset, 0]
            way = UP if contact.side_of(core, reset) < 0 else DOWN
            log(core, t, plan.resets[reset, 4], i, way, before, x)
            progress.which[0], progress.which[1] = 1, i
    progress.info[0] = t
    return NO_END


@unit
def follow(core: int, t: float, x: Vector) -> None:
    """Set the modes of the guards that a jump has carried over their levels.

    Not those of what fires now, nor those inside of an algebraic loop: these are decided later.
    """
    flow, plan, crossings = flow_of(core), plan_of(core), crossings_of(core)
    guards, level = np.empty(len(plan.kind)), np.empty(len(plan.kind))
    levels(core, t, x, level)
    for _ in range(MOST_FOLLOWED):
        guard_values(core, t, x, guards)
        changed = False
        for i in range(len(plan.kind)):
            later = crossings.how[i] >= 0 or plan.loop[i] >= 0
            if not later and margin(core, i, guards[i]) < -level[i]:
                flow.m[i], changed = mode_value(core, i, guards[i]), True
        if not changed:
            return


@unit
def driven_together(core: int, t: float, x: Vector, old: Vector, due: Ints) -> None:
    """Mark the resets whose guard is zero and was driven over it by the jump: they are due now."""
    flow = flow_of(core)
    plan = plan_of(core)
    modes = len(plan.kind)
    candidates = 0
    for reset in range(len(plan.resets)):
        i, was = plan.resets[reset, 0], due[reset]
        fits = i >= 0 and plan.kind[i] == SIGN and not plan.is_timed[i]
        due[reset] = fits and was == 0 and plan.resets[reset, 1] != 0 and flow.bound[i] == FREE
        candidates += due[reset]
    if candidates == 0:
        return
    values = np.empty((4, modes))
    guards, level, along, small = values[0], values[1], values[2], values[3]
    guard_values(core, t, x, guards)
    levels(core, t, x, level)
    for reset in np.flatnonzero(due):
        i = plan.resets[reset, 0]
        due[reset] = abs(guards[i]) <= level[i]
    if not np.any(due):
        return
    guard_rates(core, t, x, along)
    rate_levels(core, t, x, small)
    for reset in np.flatnonzero(due):
        i, side = plan.resets[reset, 0], contact.side_of(core, reset)
        due[reset] = side * along[i] < -small[i] and side * old[i] >= -small[i]
