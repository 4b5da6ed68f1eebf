"""What an event does to the sensitivities: it moves, and the fields before and after differ."""

from __future__ import annotations

import numpy as np

from tracewire.solve.core.arrays import (
    Ints,
    Vector,
    crossings_of,
    flow_of,
    is_sensitive,
    plan_of,
    progress_of,
    sensitivity_of,
)
from tracewire.solve.core.codes import (
    CHANGES,
    DELAY,
    FRACTION,
    GRAZES,
    GUARD,
    LOST,
    PASSED,
    SEGMENT,
    SIMULTANEOUS,
    TIME,
    TOUCHES,
    WAITS,
    ZENO,
    T,
)
from tracewire.solve.core.collocation import KNOWN, SMOOTH
from tracewire.solve.core.collocation import TIME as TIME_REACHED
from tracewire.solve.core.contact import reset_jump, side_of
from tracewire.solve.core.flow import (
    CURVES,
    GUARD_RATES,
    GUARDS,
    RESETS,
    RESTING,
    RHS,
    SECOND,
    SLIDING,
    TIMED,
    evaluate,
    patterns,
    rates,
)
from tracewire.solve.core.history import find_lags, is_delayed, jump_moves, recall
from tracewire.solve.core.linear import dot, factor, substitute
from tracewire.solve.core.modes import fires_reset, levels
from tracewire.solve.core.readings import guard_rates
from tracewire.solve.core.record import catch_up
from tracewire.solve.core.sensitivity import begin_to_follow, flag, total_of
from tracewire.solve.core.units import helper, unit
from tracewire.solve.core.variation import (
    OF_GUARD_RATES,
    OF_GUARDS,
    OF_RESETS,
    OF_TIMED,
    derive,
    derive_read,
    held_parts,
)

SHALLOW = 8.0  # times the noise of a guard: what dips no deeper grazes
STILL = 1e-9
AGREE = 1e-6
KINK = 1e-9  # of rates: by what they differ at the point of a table is rounding


@unit
def begin_sensitivities(core: int) -> None:
    """Put S at the start onto the surfaces that hold the run there."""
    if not is_sensitive(core):
        return
    sensitivity, progress = sensitivity_of(core), progress_of(core)
    begin_to_follow(core)
    _settle(core, progress.now[T], progress.x)
    sensitivity.now[TIME_REACHED] = progress.now[T]


@unit
def enter(core: int, t: float, x: Vector) -> None:
    """Before anything happens at an instant: S becomes the change of the states at the event."""
    if not is_sensitive(core):
        return
    catch_up(core)
    flow, crossings = flow_of(core), crossings_of(core)
    sensitivity = sensitivity_of(core)
    s, moved, instants = sensitivity.s, sensitivity.moved, sensitivity.instants
    moved[:] = 0.0
    instants[:] = 0.0
    old, here, there = flow.m.copy(), np.empty(len(x)), np.empty(len(x))
    rates(core, t, x, here)
    smooth = _is_smooth(core, t, x, here, there)
    sensitivity.now[SMOOTH] = 1.0 if smooth else 0.0
    if smooth:
        return
    main, plain = -1, -1
    happening = np.flatnonzero((crossings.how >= 0) & (crossings.how != WAITS))
    for i in happening:
        if not _is_plain(core, i):
            main = i if main < 0 else main
            continue
        # changes of modes at scheduled times move on their own, one after the other
        if plain >= 0:
            _pass(core, t, x, plain, here, there)
        plain = i
    if main >= 0 and plain >= 0:
        _pass(core, t, x, plain, here, there)
    for i in happening:
        if i == plain or not _is_plain(core, i):
            _instant(core, t, x, here, i, instants[i])
    main = plain if main < 0 else main
    if main >= 0:
        moved[:] = instants[main]
        if np.all(np.isfinite(here)):
            for j in range(len(moved)):
                s[:, j] += moved[j] * here
    flow.m[:] = old
    for i in happening:
        if i == main or _is_plain(core, i):
            continue
        for j in range(len(moved)):
            apart = abs(instants[i, j] - moved[j])
            if apart > AGREE * (abs(instants[i, j]) + abs(moved[j])):
                flag(core, SIMULTANEOUS, i, t)
                break


@helper
def _is_smooth(core: int, t: float, x: Vector, here: Vector, there: Vector) -> bool:
    """Whether all that happens is that tables of t go on to their next points, and clocks, where
    the rates have a kink and no jump: when that is does not matter then."""
    flow, plan, crossings = flow_of(core), plan_of(core), crossings_of(core)
    if flow.counts[SLIDING] + flow.counts[RESTING]:
        return False
    for i in range(len(plan.kind)):
        passes = plan.kind[i] == SEGMENT and _is_plain(core, i)
        if crossings.how[i] >= 0 and not (passes or crossings.how[i] == CHANGES):
            return False
    old = flow.m.copy()
    for i in range(len(plan.kind)):
        if crossings.how[i] >= 0:
            flow.m[i] = crossings.to[i]
    rates(core, t, x, there)
    flow.m[:] = old
    same = True
    for i in range(len(x)):
        same = same and abs(there[i] - here[i]) <= KINK * (abs(there[i]) + abs(here[i]))
    return same


@helper
def _is_plain(core: int, i: int) -> bool:
    """Whether a mode changes at a known time, and nothing fires with it."""
    how = crossings_of(core).how[i]
    return how == CHANGES or (how == TIME and not _fires(core, i))


@helper
def _fires(core: int, i: int) -> bool:
    """Whether the guard of a mode fires resets or moves memories."""
    plan = plan_of(core)
    found = fires_reset(core, i)
    for row in range(len(plan.transitions)):
        found = found or plan.transitions[row, 2] == i
    return found


@unit
def _pass(core: int, t: float, x: Vector, i: int, here: Vector, there: Vector) -> None:
    """Let a timed mode change, as if nothing else happened now."""
    flow, crossings = flow_of(core), crossings_of(core)
    sensitivity = sensitivity_of(core)
    row = sensitivity.instants[i]
    _instant(core, t, x, here, i, row)
    flow.m[i] = crossings.to[i]
    rates(core, t, x, there)
    if np.all(np.isfinite(there)):
        for j in range(len(row)):
            sensitivity.s[:, j] += row[j] * (here - there)
    here[:] = there


@unit
def _instant(core: int, t: float, x: Vector, rate: Vector, i: int, out: Vector) -> None:
    """How the instant moves at which a mode changes: (q,); 0 where that is not defined."""
    flow, plan, crossings = flow_of(core), plan_of(core), crossings_of(core)
    sensitivity, _progress = sensitivity_of(core), progress_of(core)
    s, chain = sensitivity.s, sensitivity.chain
    n, modes, w = len(x), len(flow.bound), sensitivity.nodes.shape[1]
    if is_delayed(core):
        find_lags(core, t, x)
        recall(core, t)
    how, row, speed = crossings.how[i], np.zeros(w), 0.0
    if how in (TIME, CHANGES):
        line = int(np.searchsorted(plan.timed, i))
        lines, rows = np.empty(2 * len(plan.timed)), np.empty((2 * len(plan.timed), w))
        evaluate(core, TIMED, t, x, lines)
        derive(core, OF_TIMED, t, x, rows)
        row[n + 1 :] = t * rows[2 * line, n + 1 :] + rows[2 * line + 1, n + 1 :]
        speed = lines[2 * line]
    elif how in (GUARD, PASSED):  # PASSED: it went by so slowly that no step has seen it
        rows, along, bends = np.empty((modes, w)), np.empty(modes), np.empty(modes)
        level = np.empty(modes)
        levels(core, t, x, level)
        derive_read(core, OF_GUARDS, GUARDS, t, x, rows)
        guard_rates(core, t, x, along)
        row[:] = rows[i]
        speed = along[i]
        evaluate(core, SECOND, t, x, bends)
        if not speed * speed > 2.0 * abs(bends[i]) * SHALLOW * level[i]:
            speed = 0.0
    else:
        rows = np.empty((flow.counts[SLIDING] + flow.counts[RESTING], w))
        held_parts(core, t, x, rows)
        kind = SLIDING if how == FRACTION else RESTING
        at = int(np.sum(flow.bound[:i] == kind))
        row[:] = rows[at if how == FRACTION else flow.counts[SLIDING] + at]
        speed = dot(row[:n], rate) + row[n]
        size = dot(np.abs(row[:n]), np.abs(rate)) + abs(row[n])
        if abs(speed) <= STILL * size:
            speed = 0.0
    out[:] = 0.0
    if speed == 0.0 or not np.isfinite(speed):
        flag(core, GRAZES, i, t)
        return
    for j in range(len(out)):
        out[j] = -total_of(row, s, chain, j) / speed
        if plan.kind[i] == DELAY:  # what it reaches moves, too
            number = max(crossings.to[i], flow.m[i])
            out[j] += jump_moves(core, plan.table[i], number, j) / speed
        if not np.isfinite(out[j]):
            out[j] = 0.0
            flag(core, LOST, i, t)


@unit
def reset_sensitivities(core: int, t: float, before: Vector, due: Ints, modes: Vector) -> None:
    """What the resets that are due make of the change of the states at the event."""
    if not is_sensitive(core):
        return
    flow, plan, sensitivity = flow_of(core), plan_of(core), sensitivity_of(core)
    n, w = len(before), sensitivity.nodes.shape[1]
    rows, old, now = np.empty((len(plan.writes), w)), sensitivity.s.copy(), flow.m.copy()
    flow.m[:] = modes
    if is_delayed(core):
        find_lags(core, t, before)
        recall(core, t)
    derive_read(core, OF_RESETS, RESETS, t, before, rows)
    flow.m[:] = now
    for reset in np.flatnonzero(due):
        first = plan.resets[reset, 2]
        for row in range(first, first + plan.resets[reset, 3]):
            for j in range(old.shape[1]):
                value = total_of(rows[row], old, sensitivity.chain, j)
                sensitivity.s[plan.writes[row], j] = value + rows[row, n] * sensitivity.moved[j]


@unit
def leave(core: int, t: float, before: Vector, x: Vector, old: Vector, waits: Vector) -> None:
    """After all that happens at an instant: S again at a fixed time, in the new field.

    `before` are x⁻ and `old` the modes before it.
    """
    if not is_sensitive(core):
        return
    flow, plan, sensitivity = flow_of(core), plan_of(core), sensitivity_of(core)
    if sensitivity.now[SMOOTH] > 0.0:
        same = True
        for i in range(len(x)):
            same = same and x[i] == before[i]
        for i in range(len(plan.kind)):
            same = same and (plan.kind[i] == SEGMENT or flow.m[i] == old[i])
            same = same and flow.bound[i] == sensitivity.bound[i]
        if same:  # the rates go on as they were, what moves them with parameters may jump
            sensitivity.now[TIME_REACHED], sensitivity.now[KNOWN] = t, 0.0
            return
    rate = np.empty(len(x))
    rates(core, t, x, rate)
    if np.all(np.isfinite(rate)):
        for j in range(len(sensitivity.moved)):
            sensitivity.s[:, j] -= sensitivity.moved[j] * rate
    for i in np.flatnonzero(flow.bound == RESTING):
        if sensitivity.bound[i] != RESTING and waits[i] > 0.0:
            flag(core, ZENO, i, t)
    _settle(core, t, x)
    sensitivity.moved[:] = 0.0
    sensitivity.now[TIME_REACHED], sensitivity.now[KNOWN] = t, 0.0


@unit
def _settle(core: int, t: float, x: Vector) -> None:
    """Put S onto the surfaces that hold the run from now on."""
    flow, sensitivity = flow_of(core), sensitivity_of(core)
    if is_delayed(core):
        find_lags(core, t, x)
        recall(core, t)
    if not np.all(np.isfinite(sensitivity.s)):
        flag(core, LOST, 0, t)
        n, q = sensitivity.s.shape
        for k in range(n):
            for j in range(q):
                if not np.isfinite(sensitivity.s[k, j]):
                    sensitivity.s[k, j] = 0.0
    for i in np.flatnonzero(flow.bound == RESTING):
        if sensitivity.bound[i] == RESTING:
            continue
        _turns(core, t, x, i)
        _rest(core, t, x, i)
    if flow.counts[SLIDING]:
        _slide(core, t, x)
    sensitivity.bound[:] = flow.bound


@unit
def _slide(core: int, t: float, x: Vector) -> None:
    """Along the changes of the field that the sliding modes make, to g_x S + g_p = 0."""
    flow, sensitivity = flow_of(core), sensitivity_of(core)
    modes, w = len(flow.bound), sensitivity.nodes.shape[1]
    slides = np.flatnonzero(flow.bound == SLIDING)
    some = len(slides)
    moves = patterns(core, GUARD_RATES, t, x, modes)
    fields = patterns(core, RHS, t, x, len(x))
    rows = np.empty((modes, w))
    derive(core, OF_GUARDS, t, x, rows)
    matrix, right = np.empty((some, some)), np.empty(some)
    for row in range(some):
        for column in range(some):
            matrix[row, column] = moves[1 + column, slides[row]]
    pivots = np.empty(some, dtype=np.int64)
    if factor(matrix, pivots) == 0.0:
        return
    for j in range(sensitivity.s.shape[1]):
        for row in range(some):
            right[row] = total_of(rows[slides[row]], sensitivity.s, sensitivity.chain, j)
        substitute(matrix, pivots, right)
        for row in range(some):
            sensitivity.s[:, j] -= right[row] * fields[1 + row]


@unit
def _rest(core: int, t: float, x: Vector, i: int) -> None:
    """Keep the guard of a contact and its rate at zero, as `pin` does with the states."""
    flow, sensitivity = flow_of(core), sensitivity_of(core)
    n, modes, w = len(x), len(flow.bound), sensitivity.nodes.shape[1]
    rows, along = np.empty((modes, w)), np.empty((modes, w))
    derive(core, OF_GUARDS, t, x, rows)
    derive(core, OF_GUARD_RATES, t, x, along)
    slope, bend = rows[i, :n], along[i, :n]
    square, pushed = dot(slope, slope), dot(bend, flow.push[i])
    far = False
    s = sensitivity.s
    before = s.copy()
    for j in range(s.shape[1]):
        if square > 0.0:
            s[:, j] -= slope * (total_of(rows[i], s, sensitivity.chain, j) / square)
        if pushed != 0.0:
            s[:, j] -= flow.push[i] * (total_of(along[i], s, sensitivity.chain, j) / pushed)
        for k in range(n):
            size = max(sensitivity.peak[k, j], abs(before[k, j]))
            far = far or abs(s[k, j] - before[k, j]) > AGREE * size
    if far:
        flag(core, TOUCHES, i, t)


@unit
def _turns(core: int, t: float, x: Vector, i: int) -> None:
    """How the push of a contact changes with the parameters: with the jump of its reset.

    Both are read where the bodies approach each other with the rate 1.
    """
    flow, plan, sensitivity = flow_of(core), plan_of(core), sensitivity_of(core)
    n, modes, w = len(x), len(flow.bound), sensitivity.nodes.shape[1]
    turns = sensitivity.push[i]
    turns[:] = 0.0
    a = w - n - 1
    for reset in range(len(plan.resets)):
        if plan.resets[reset, 0] != i:
            continue
        curves, jump, rows = np.empty((modes, n + 1)), np.empty(n), np.empty((len(plan.writes), w))
        evaluate(core, CURVES, t, x, curves)
        slope = curves[i, :n]
        at = x - slope * (side_of(core, reset) / dot(slope, slope))
        reset_jump(core, t, at, reset, jump)
        derive(core, OF_RESETS, t, at, rows)
        largest = dot(jump, flow.push[i]) / dot(flow.push[i], flow.push[i])
        if largest == 0.0 or not np.isfinite(largest):
            continue
        first = plan.resets[reset, 2]
        for row in range(first, first + plan.resets[reset, 3]):
            for k in range(a):
                turns[plan.writes[row] * a + k] = rows[row, n + 1 + k] / largest
        return
