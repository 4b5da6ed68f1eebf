"""Which modes hold when guards are zero: the joint derivative test, and the entry of a slide.

The modes of all guards that are zero are decided together. A combination is consistent when the
first derivative that is not zero of each of these guards along the field of that combination has
the sign of its mode. None consistent: slide. Several: the stored one.
"""

from __future__ import annotations

import numpy as np

from tracewire.solve.core.arrays import Ints, Vector, flow_of, plan_of, progress_of
from tracewire.solve.core.codes import LENGTH
from tracewire.solve.core.contact import bend
from tracewire.solve.core.flow import (
    AFFINE,
    FREE,
    GRADIENTS,
    GUARD_RATES,
    RATE_SIZES,
    RESTING,
    SECOND,
    SECOND_SIZES,
    SLIDING,
    bind,
    evaluate,
    held,
    is_affine,
    is_independent,
    patterns,
    rates,
    sizes,
)
from tracewire.solve.core.modes import NOTHING, rate_levels
from tracewire.solve.core.readings import guard_rates, guard_values
from tracewire.solve.core.units import helper, unit

MOST_TOGETHER = 6
MOST_TRIED = 9  # 20 000 assignments, where the pivots end at none
SLACK = 1e-9
AHEAD = 1e-6  # of the span
BLOCK_ROUNDS = 6
MOST_ROUNDS = 500
HELD = -1  # in place of a mode: the guard stays on its surface
UNIQUE, NOT_ALONE, NONE, NO_BLEND = range(4)
NO, BARELY, YES = range(3)  # whether modes are consistent; BARELY: nothing drives a guard away


@unit
def decide(core: int, t: float, x: Vector, zero: Ints, fresh: bool) -> int:
    """Set the modes of the guards `zero`, all of kind sign.

    Every guard on which the flow slides must be among them. The stored modes are unique wherever
    they are consistent, unless the run is `fresh`. UNIQUE, NOT_ALONE; NONE where no combination
    and no slide is consistent, NO_BLEND where modes of a slide multiply each other.
    """
    flow = flow_of(core)
    stored = np.empty(len(zero), dtype=np.int64)
    for n, i in enumerate(zero):
        stored[n] = HELD if flow.bound[i] == SLIDING else int(flow.m[i] > 0.5)
    small = _nothing(core, t, x, zero)
    count, chosen = 0, stored
    if len(zero) > MOST_TOGETHER:
        count, chosen = _pivots(core, t, x, zero, stored, small)
    if count == 0 and len(zero) <= MOST_TRIED:
        count, chosen = _combinations(core, t, x, zero, stored, fresh, small)
    if count == 0:
        return NONE
    assign(core, zero, chosen)
    if flow.counts[SLIDING] > 1 and not is_affine(core, t, x):
        return NO_BLEND
    kept = bool(np.all(chosen == stored))
    return UNIQUE if count == 1 or (kept and not fresh) else NOT_ALONE


@unit
def _nothing(core: int, t: float, x: Vector, zero: Ints) -> Vector:
    """Below what the rate of each guard counts as zero: a part of its size on any side."""
    flow = flow_of(core)
    assign(core, zero, np.ones(len(zero), dtype=np.int64))
    level, largest = np.empty(len(flow.bound)), np.zeros(len(flow.bound))
    for n in range(-1, len(zero)):
        if n >= 0:
            flow.m[zero[n]] = 0.0
        rate_levels(core, t, x, level)
        for i in range(len(level)):
            largest[i] = max(largest[i], level[i])
        if n >= 0:
            flow.m[zero[n]] = 1.0
    return largest


@helper
def _combinations(
    core: int, t: float, x: Vector, zero: Ints, stored: Ints, fresh: bool, small: Vector
) -> tuple[int, Ints]:
    """How many assignments fit, and the one to take.

    Every assignment is tried: friction that holds goes on holding, then friction that can hold,
    then signs, then slides of few surfaces, each group from those that change little. Where signs
    are barely consistent, a slide is preferred: a force that just reaches friction moves nothing.
    """
    plan = plan_of(core)
    size = len(zero)
    total = 3**size
    ranks, all_ = np.zeros(total, dtype=np.int64), np.empty((total, size), dtype=np.int64)
    for number in range(total):
        rest, released, plain, loose, changed = number, 0, 0, 0, 0
        for n in range(size - 1, -1, -1):
            value = 1 - rest % 3  # 1, 0, HELD
            rest //= 3
            all_[number, n] = value
            holds = plan.can_hold[zero[n]] == 1
            plain += value == HELD and not holds
            loose += value != HELD and holds
            released += value != HELD and holds and stored[n] == HELD
            changed += value != stored[n]
        for part in (released, plain, loose, changed):
            ranks[number] = ranks[number] * (size + 1) + part
    found, chosen, barely = 0, stored.copy(), False
    for number in np.argsort(ranks, kind="mergesort"):
        assignment = all_[number]
        slides = bool(np.any(assignment == HELD))
        if found and slides and not barely:
            break
        assign(core, zero, assignment)
        fits = _consistent(core, t, x, zero, assignment, stored, small, fresh)
        if fits == NO:
            continue
        same = bool(np.all(assignment == stored))
        better = barely and fits == YES and (slides or not fresh)
        if found == 0 or same or better:
            chosen, barely = assignment.copy(), fits == BARELY
        if not (better and slides):
            found += 1
        if not barely and (slides or (same and not fresh)):
            break
    return found, chosen


@helper
def _pivots(
    core: int, t: float, x: Vector, zero: Ints, stored: Ints, small: Vector
) -> tuple[int, Ints]:
    """How many assignments fit, and the one to take: the complementarity problem of many surfaces.

    All guards whose rate depends on their own mode begin on the surface; a fraction outside [0, 1]
    leaves it, a mode against its guard's rate comes back. After a few rounds only the first of
    these changes, which ends for friction between bodies (K. G. Murty, Note on a Bard-type scheme
    for solving the complementarity problem, Opsearch 11, 1974).
    """
    flow = flow_of(core)
    now = np.full(len(zero), HELD)
    assign(core, zero, now)
    modes = len(flow.bound)
    moves = patterns(core, GUARD_RATES, t, x, modes)
    slides = np.flatnonzero(flow.bound == SLIDING)
    free = np.zeros(len(zero), dtype=np.int64)
    for n, i in enumerate(zero):
        row = np.searchsorted(slides, i)
        if moves[1 + row, i] != 0.0:
            free[n] = 1
        else:
            now[n] = stored[n]
    along = np.empty(modes)
    for round_ in range(MOST_ROUNDS):
        assign(core, zero, now)
        if _consistent(core, t, x, zero, now, stored, small, False) != NO:
            return 1, now
        guard_rates(core, t, x, along)
        fractions = held(core, t, x)
        slides = np.flatnonzero(flow.bound == SLIDING)
        for n, i in enumerate(zero):
            if not free[n]:
                continue
            wrong = False
            if now[n] == HELD:
                part = fractions[np.searchsorted(slides, i)]
                if not -SLACK <= part <= 1 + SLACK:
                    now[n], wrong = int(part > 0.5), True
            elif (along[i] > 0) != (now[n] == 1):
                now[n], wrong = HELD, True
            if wrong and round_ >= BLOCK_ROUNDS:
                break
    return 0, now


@helper
def assign(core: int, zero: Ints, assignment: Ints) -> None:
    """Give the modes of the guards `zero` their values, HELD included."""
    flow = flow_of(core)
    plan = plan_of(core)
    modes = len(flow.bound)
    for n, i in enumerate(zero):
        value = assignment[n]
        flow.m[modes + i] = 1.0 if value == HELD and plan.can_hold[i] else 0.0
        flow.m[i] = 0.0 if value == HELD else float(value)
        bind(core, i, SLIDING if value == HELD else FREE)


@unit
def _consistent(
    core: int,
    t: float,
    x: Vector,
    zero: Ints,
    assignment: Ints,
    stored: Ints,
    small: Vector,
    fresh: bool,
) -> int:
    """NO, BARELY or YES."""
    flow = flow_of(core)
    some = flow.counts[SLIDING]
    if some:
        fractions = held(core, t, x)[:some]
        for part in fractions:
            if not -SLACK <= part <= 1 + SLACK:  # NaN is outside too
                return NO
        if not is_independent(core, t, x) or _drives(core, t, x):
            return NO
    along, barely = np.empty(len(flow.bound)), False
    guard_rates(core, t, x, along)
    moves = patterns(core, GUARD_RATES, t, x, len(flow.bound))
    for n, i in enumerate(zero):
        value = assignment[n]
        if value == HELD:
            continue
        rate = along[i]
        if abs(rate) <= small[i]:
            rate = first_higher(core, t, x, i)
        if rate == 0.0:  # it stays on the surface
            # pinned: by what is held there, so that both sides are right
            pinned = bool(np.any(moves[1:, i] != 0.0))
            if compares_at_zero(core, t, x, i, pinned):
                if value != plan_of(core).at_zero[i]:
                    return NO
                continue
            if not pinned and stored[n] != HELD and value != stored[n]:
                return NO  # else what was stored goes on
            barely = barely or (not pinned and (fresh or stored[n] == HELD))
            if pinned and _drives_apart(core, t, x, i):
                return NO
        elif (rate > 0) != (value == 1):
            return NO
    return BARELY if barely else YES


@unit
def compares_at_zero(core: int, t: float, x: Vector, i: int, pinned: bool) -> bool:
    """Whether the mode of a guard that is zero, with a rate of nothing, is what the comparison says
    at zero: where the guard rests there, exactly or because a slide holds it.

    Elsewhere it may be flat: it goes on where no derivative that is known tells it.
    """
    if plan_of(core).compares[i] == 0:
        return False
    if pinned:
        return True
    modes, n = len(flow_of(core).bound), len(x)
    later, field, guards = AHEAD * progress_of(core).now[LENGTH], np.empty(n), np.empty(modes)
    guard_values(core, t, x, guards)
    if guards[i] != 0.0:
        return False
    rates(core, t, x, field)
    guard_values(core, t + later, x + later * field, guards)
    return bool(guards[i] == 0.0)


@unit
def _drives_apart(core: int, t: float, x: Vector, i: int) -> bool:
    """Whether a relay that drives its guard away from zero stays there because another relay on the
    same surface holds it. The two turn together, so that only their difference can hold."""
    flow, plan = flow_of(core), plan_of(core)
    if plan.can_hold[i]:
        return False
    modes, together, value = len(flow.bound), False, flow.m[i]
    gradients = np.empty((modes, len(x)))
    evaluate(core, GRADIENTS, t, x, gradients)
    for j in range(modes):
        if flow.bound[j] == SLIDING and plan.can_hold[j] == 0:
            together = together or _parallel(gradients[i], gradients[j])
    if not together:
        return False
    above, below = np.empty(modes), np.empty(modes)
    flow.m[i] = 1.0
    evaluate(core, GUARD_RATES, t, x, above)
    flow.m[i] = 0.0
    evaluate(core, GUARD_RATES, t, x, below)
    flow.m[i] = value
    return above[i] > below[i]


@helper
def _parallel(one: Vector, other: Vector) -> bool:
    """Whether two gradients are multiples of each other, but for rounding."""
    most = 0
    for k in range(len(one)):
        if abs(one[k]) > abs(one[most]):
            most = k
    if one[most] == 0.0 or other[most] == 0.0:
        return False
    part, same = other[most] / one[most], True
    for k in range(len(one)):
        same = same and abs(other[k] - part * one[k]) <= SLACK * abs(part * one[k])
    return same


@helper
def _drives(core: int, t: float, x: Vector) -> bool:
    """Whether a friction that would hold drives its own rate (a wrong sign), so that it cannot."""
    flow, plan = flow_of(core), plan_of(core)
    slides = np.flatnonzero(flow.bound == SLIDING)
    moves = patterns(core, GUARD_RATES, t, x, len(flow.bound))
    drives = False
    for row, i in enumerate(slides):
        drives = drives or (plan.can_hold[i] == 1 and moves[1 + row, i] > 0.0)
    return drives


@unit
def note_undetermined(core: int, t: float, x: Vector, zero: Ints) -> None:
    """Keep since when guards have rested at zero whose modes nothing decides, but matter.

    Such is friction on a rate that it does not change: a prescribed one that is exactly zero.
    """
    flow, undetermined = flow_of(core), progress_of(core).undetermined
    modes, n = len(flow.bound), len(x)
    along, beyond, small = np.empty(modes), np.empty(modes), np.empty(modes)
    guard_rates(core, t, x, along)
    rate_levels(core, t, x, small)
    for i in zero:
        free = flow.bound[i] == FREE and undetermined[i] == np.inf
        if not free or abs(along[i]) > small[i] or first_higher(core, t, x, i) != 0.0:
            continue
        if plan_of(core).compares[i]:
            moves = patterns(core, GUARD_RATES, t, x, modes)
            if compares_at_zero(core, t, x, i, bool(np.any(moves[1:, i] != 0.0))):
                continue
        here, there, size = np.empty(n), np.empty(n), np.empty(n)
        sizes(core, RATE_SIZES, t, x, size)
        rates(core, t, x, here)
        flow.m[i] = 1.0 - flow.m[i]
        rates(core, t, x, there)
        guard_rates(core, t, x, beyond)
        fits = abs(beyond[i]) <= small[i]
        if flow.counts[SLIDING]:  # the others may hold with one of the sides alone
            for part in held(core, t, x)[: flow.counts[SLIDING]]:
                fits = fits and -SLACK <= part <= 1 + SLACK
        flow.m[i] = 1.0 - flow.m[i]
        for j in range(n):
            differ = abs(there[j] - here[j]) > AFFINE * size[j]
            if differ and fits:
                undetermined[i] = t


@unit
def _stays(core: int, t: float, x: Vector, i: int) -> bool:
    """Whether a guard whose rate is nothing keeps that rate while contacts rest.

    `bend` does not know what a contact holds: the rate of a gear behind a body on a stop, say,
    whose force goes on to change.
    """
    flow, n = flow_of(core), len(x)
    modes, later = len(flow.bound), AHEAD * progress_of(core).now[LENGTH]
    field, along, small = np.empty(n), np.empty(modes), np.empty(modes)
    rates(core, t, x, field)
    guard_rates(core, t + later, x + later * field, along)
    rate_levels(core, t, x, small)
    return bool(abs(along[i]) <= small[i])


@unit
def first_higher(core: int, t: float, x: Vector, i: int) -> float:
    """The first derivative of a guard, from the second to the fourth, that is not zero; 0: none.

    On a slide each is the blend of those on the sides, as long as no lower one differs between
    these; in a contact the second one alone is known. What is not known counts as zero.
    """
    flow = flow_of(core)
    size, count = np.empty(len(flow.bound)), len(flow.bound)
    moves = patterns(core, GUARD_RATES, t, x, count)
    if np.any(moves[1:, i] != 0.0):
        return 0.0
    if flow.counts[RESTING]:
        sizes(core, SECOND_SIZES, t, x, size)
        second = bend(core, t, x, i)
        nothing = abs(second) <= NOTHING * size[i] or _stays(core, t, x, i)
        return 0.0 if nothing else second
    fractions = held(core, t, x) if flow.counts[SLIDING] else size[:0]
    for order in range(3):
        values = patterns(core, SECOND + order, t, x, count)
        value, differs = values[0, i], False
        for row in range(flow.counts[SLIDING]):
            value += fractions[row] * values[1 + row, i]
            differs = differs or values[1 + row, i] != 0.0
        if value != 0.0:
            sizes(core, SECOND_SIZES + order, t, x, size)
            if abs(value) > NOTHING * size[i]:
                return float(value)
        if differs:
            return 0.0
    return 0.0
