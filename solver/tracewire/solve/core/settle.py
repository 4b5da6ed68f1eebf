"""The modes at an instant: by the values of the guards, and by decision where these are zero."""

from __future__ import annotations

import numpy as np

from tracewire.solve.core import contact
from tracewire.solve.core.arrays import (
    Ints,
    Matrix,
    Vector,
    crossings_of,
    flow_of,
    plan_of,
    progress_of,
)
from tracewire.solve.core.codes import (
    CHANGES,
    FINISHED,
    FLOOR,
    MEMORY,
    NO_MODE,
    NO_SLIDE,
    NOT_UNIQUE,
    SIGN,
    TIME,
    UNSETTLED,
    WARNINGS,
)
from tracewire.solve.core.decide import (
    MOST_TOGETHER,
    NO_BLEND,
    NONE,
    UNIQUE,
    decide,
    first_higher,
    note_undetermined,
)
from tracewire.solve.core.flow import FREE, GUARD_RATES, RESTING, SLIDING, bind, held, patterns
from tracewire.solve.core.modes import (
    JUMP,
    NOTHING,
    inside,
    levels,
    margin,
    mode_value,
    rate_levels,
)
from tracewire.solve.core.readings import guard_rates, guard_values
from tracewire.solve.core.resets import fire_transitions
from tracewire.solve.core.surface import pin
from tracewire.solve.core.units import helper, unit

MOST_ROUNDS = 200
MOST_EDGES = 20
KNOWN, LEFT = 1, 2  # marks: a guard known to be zero; a slide that was left, its mode stays


@unit
def settle(core: int, t: float, x: Vector, marks: Ints, fresh: bool) -> int:
    """Set every mode that is not timed until all stand still; fire transitions; a status.

    `marks`: KNOWN are guards that are known to be zero although rounding may hide it; LEFT are
    those whose slide has just ended: their stored mode stays. `fresh`: nothing is stored yet, so
    that two consistent modes are not unique, which is a warning. `x` is changed by the resets of
    transitions, and by contacts that close.
    """
    flow = flow_of(core)
    plan = plan_of(core)
    progress = progress_of(core)
    modes = len(plan.kind)
    numbers = np.empty((5, modes))
    guards, after, level, marked = numbers[0], numbers[1], numbers[2], numbers[3:]
    seen = np.empty((0, 3 * modes))  # until a second round needs it, which is rare
    flags = np.empty((3, modes), dtype=np.int64)
    zero, moved = flags[0], flags[1]
    rounds = 0
    _floor_edges(core, t, x, marks)
    while True:
        levels(core, t, x, level)
        guard_values(core, t, x, guards)
        flags[:] = 0
        for i in range(modes):
            if plan.is_timed[i]:
                if _is_carried(core, i, guards[i], level[i]):
                    flow.m[i] = mode_value(core, i, guards[i])
                continue
            if plan.kind[i] == MEMORY or flow.bound[i] == RESTING:
                continue
            if flow.bound[i] == SLIDING and abs(guards[i]) > JUMP * level[i]:
                bind(core, i, FREE)  # a jump has carried the run off the surface
                flow.m[modes + i] = 0.0
                flow.m[i] = mode_value(core, i, guards[i])
                continue
            if marks[i] == KNOWN or flow.bound[i] == SLIDING:
                zero[i] = 1
            elif marks[i] == LEFT and margin(core, i, guards[i]) >= -JUMP * level[i]:
                continue
            elif plan.kind[i] == SIGN and abs(guards[i]) <= level[i]:
                zero[i] = 1
            elif margin(core, i, guards[i]) < -level[i]:
                # modes of one algebraic loop change one at a time, the first one first: this ends
                # where every mode moves its own guard the right way (Murty)
                loop = plan.loop[i]
                if loop < 0 or not moved[loop]:
                    flow.m[i] = mode_value(core, i, guards[i])
                if loop >= 0:
                    moved[loop] = 1
        _close_contacts(core, t, x, zero)
        if np.any(zero):
            undecided = np.flatnonzero(zero)
            how = decide(core, t, x, undecided, fresh)
            if how in (NONE, NO_BLEND):
                return _refuse(core, NO_MODE if how == NONE else NO_SLIDE, t, undecided)
            if how != UNIQUE and fresh:
                progress.ints[WARNINGS] |= NOT_UNIQUE
            note_undetermined(core, t, x, undecided)
            guard_values(core, t, x, after)
            for i in undecided:
                if abs(after[i] - guards[i]) > JUMP * level[i]:
                    marks[i] = zero[i] = 0
        if _open_contacts(core, t, x, marks):
            continue
        guard_values(core, t, x, guards)
        wrong = flags[2]
        for i in range(modes):
            fixed = zero[i] == 1 or marks[i] == LEFT
            if not fixed and not margin(core, i, guards[i]) >= -level[i]:
                wrong[i] = 1
            if plan.is_timed[i] and _is_carried(core, i, guards[i], level[i]):
                wrong[i] = 1
        if not np.any(wrong):
            if flow.counts[SLIDING]:
                pin(core, t, x)  # what is held stands still, also behind a gear
            if rounds < MOST_EDGES and _floor_edges(core, t, x, marks):
                rounds += 1
                continue
            marked_guards(core, t, x, marks, marked)
            status = fire_transitions(core, t, x, wrong)
            if status != FINISHED or not np.any(wrong):
                return status
            forget(core, t, x, marked, marks)
        if len(seen) == 0:
            seen = np.full((MOST_ROUNDS, 3 * modes), np.nan)
        key = seen[min(rounds, MOST_ROUNDS - 1)]
        key[: 2 * modes] = flow.m
        key[2 * modes :] = flow.bound
        for row in range(min(rounds, MOST_ROUNDS - 1)):
            if np.all(seen[row] == key) and not _only_one(core, t, x, wrong, level):
                return _refuse(core, UNSETTLED, t, np.flatnonzero(wrong))
        rounds += 1
        if rounds == MOST_ROUNDS:
            return _refuse(core, UNSETTLED, t, np.flatnonzero(wrong))


@unit
def stands(core: int, t: float, x: Vector, guards: Vector, level: Vector) -> bool:
    """Whether all modes that are not timed stand as they are, so that `settle` changes none.

    Fills in the guards and their levels. What is held, floors, resets and memories are for `settle`
    to see, and so is a guard at zero.
    """
    flow, plan = flow_of(core), plan_of(core)
    if len(plan.resets) + len(plan.transitions) + flow.counts[SLIDING] + flow.counts[RESTING] > 0:
        return False
    levels(core, t, x, level)
    guard_values(core, t, x, guards)
    for i in range(len(guards)):
        if plan.is_timed[i]:
            if _is_carried(core, i, guards[i], level[i]):
                return False
            continue
        zero = plan.kind[i] == SIGN and abs(guards[i]) <= level[i]
        if plan.kind[i] in (FLOOR, MEMORY) or zero:
            return False
        if not margin(core, i, guards[i]) >= -level[i]:
            return False
    return True


@unit
def marked_guards(core: int, t: float, x: Vector, marks: Ints, out: Matrix) -> None:
    """The guards (row 0) and their rates (row 1) before resets, where `forget` asks for them."""
    if np.any(marks != 0):
        guard_values(core, t, x, out[0])
    if np.any(marks == LEFT):
        guard_rates(core, t, x, out[1])


@unit
def forget(core: int, t: float, x: Vector, before: Matrix, marks: Ints) -> None:
    """Take the marks away after resets, but for those of guards that the resets do not concern.

    A guard that is known to be zero still is: it was located there, but for the rounding of the
    time. One whose slide has just ended, decided anew, might be held again, with a fraction of 1.
    """
    if not np.any(marks != 0):
        return
    modes = len(marks)
    numbers = np.empty((4, modes))
    guards, along, level, small = numbers[0], numbers[1], numbers[2], numbers[3]
    guard_values(core, t, x, guards)
    levels(core, t, x, level)
    if np.any(marks == LEFT):
        guard_rates(core, t, x, along)
        rate_levels(core, t, x, small)
    for i in range(modes):
        if marks[i] == KNOWN and abs(guards[i] - before[0, i]) > level[i]:
            marks[i] = 0
        elif marks[i] == LEFT:
            same = abs(along[i] - before[1, i]) <= small[i]
            if not (same and margin(core, i, guards[i]) >= -JUMP * level[i]):
                marks[i] = 0


@unit
def _floor_edges(core: int, t: float, x: Vector, marks: Ints) -> bool:
    """Move the floors that stand on a whole number to the side that their guards go to."""
    flow, plan, changed, some = flow_of(core), plan_of(core), False, False
    for kind in plan.kind:
        some = some or kind == FLOOR
    if not some:
        return False
    modes = len(plan.kind)
    guards, along = np.empty(modes), np.empty(modes)
    level, small = np.empty(modes), np.empty(modes)
    guard_values(core, t, x, guards)
    guard_rates(core, t, x, along)
    levels(core, t, x, level)
    rate_levels(core, t, x, small)
    moves = patterns(core, GUARD_RATES, t, x, modes)
    for i in range(modes):
        whole = np.rint(guards[i])
        is_held = bool(np.any(moves[1:, i] != 0.0))  # by a slide, which moves its rate
        near = abs(guards[i] - whole) <= level[i] and (marks[i] != LEFT or is_held)
        if plan.kind[i] != FLOOR or plan.is_timed[i] or not near:
            continue
        rate = along[i]
        if abs(rate) <= small[i]:
            rate = first_higher(core, t, x, i)
        value = whole if rate > 0.0 else whole - 1.0
        if rate == 0.0:  # what a slide holds there is that number, but for rounding
            value = whole if is_held else flow.m[i]
        elif marks[i] == LEFT:
            continue
        changed = changed or value != flow.m[i]
        flow.m[i] = value
    return changed


@helper
def _is_carried(core: int, i: int, guard: float, level: float) -> bool:
    """Whether the jump of another mode has carried a timed guard over zero: that of
    `t - 0.7 + wave/2` is a line between the jumps of the wave. What is nearer to zero changes at
    the time that is computed for it."""
    plan = plan_of(core)
    if plan.kind[i] != SIGN or crossings_of(core).how[i] in (TIME, CHANGES):
        return False
    return inside(core, i, guard) < -2 * JUMP * level


@helper
def _refuse(core: int, status: int, t: float, guards: Ints) -> int:
    progress = progress_of(core)
    progress.which[0] = len(guards)
    progress.which[1 : 1 + len(guards)] = guards
    progress.info[0] = t
    return status


@unit
def _close_contacts(core: int, t: float, x: Vector, zero: Ints) -> None:
    """Let contacts rest whose guard is zero, with a rate of zero, and pressed."""
    plan = plan_of(core)
    some = False
    for reset in range(len(plan.resets)):
        i = plan.resets[reset, 0]
        some = some or (i >= 0 and zero[i] == 1)
    if not some:
        return
    level = np.empty(len(plan.kind))
    rate_levels(core, t, x, level)
    for reset in range(len(plan.resets)):
        i = plan.resets[reset, 0]
        if i < 0 or not zero[i]:
            continue
        higher = first_higher(core, t, x, i)
        if contact.touching(core, t, x, reset, level, higher):
            zero[i] = 0


@unit
def _open_contacts(core: int, t: float, x: Vector, marks: Ints) -> bool:
    """Let contacts go that would have to pull; whether there were any."""
    flow = flow_of(core)
    if flow.counts[RESTING] == 0:
        return False
    forces = held(core, t, x)[flow.counts[SLIDING] :]
    size = contact.force_sizes(core, t, x)
    opened = False
    for row, i in enumerate(np.flatnonzero(flow.bound == RESTING)):
        if not forces[row] >= -NOTHING * size[row]:
            contact.release(core, i)
            marks[i], opened = LEFT, True
    return opened


@unit
def _only_one(core: int, t: float, x: Vector, wrong: Ints, level: Vector) -> bool:
    """Try all values of modes whose guards read what they change; whether just one fits, taken."""
    flow = flow_of(core)
    plan = plan_of(core)
    some = np.flatnonzero(wrong)
    modes = len(plan.kind)
    if len(some) > MOST_TOGETHER:
        return False
    guards, found = np.empty(modes), -1
    for number in range(2 ** len(some)):
        for bit, i in enumerate(some):
            if plan.kind[i] != SIGN:
                return False
            flow.m[i] = float((number >> bit) & 1)
        guard_values(core, t, x, guards)
        good = True
        for i in some:
            good = good and margin(core, i, guards[i]) >= -level[i]
        if good:
            if found >= 0:
                return False
            found = number
    for bit, i in enumerate(some):
        flow.m[i] = float((found >> bit) & 1) if found >= 0 else flow.m[i]
    return found >= 0
