"""The event loop: steps with frozen modes up to the next event, then the event, then again."""

from __future__ import annotations

import math

import numpy as np

from tracewire.solve.core import locate, methods, polish, schedule
from tracewire.solve.core.arrays import (
    Vector,
    copy,
    crossings_of,
    flow_of,
    plan_of,
    progress_of,
    trial_of,
    watch_of,
)
from tracewire.solve.core.codes import (
    ABSOLUTE,
    BUDGET,
    CURRENT,
    END,
    FINISHED,
    FIXED,
    GUARD,
    HISTORY_FULL,
    LAST,
    LENGTH,
    LOG_FULL,
    LOGGED,
    LONGEST,
    NEVER,
    PACED,
    PASSED,
    PAUSED,
    RATIO,
    REJECTED,
    RTOL,
    STAGE,
    STEPS,
    STIFF_STEPS,
    SUSPICIOUS,
    UNDEFINED,
    UNDERFLOW,
    WHILE_HELD,
    H,
    T,
)
from tracewire.solve.core.flow import (
    GUARD_WEIGHTS,
    PACE,
    RATE_SIZES,
    RESTING,
    SLIDING,
    evaluate,
    rates,
    sizes,
)
from tracewire.solve.core.history import (
    begin_history,
    has_room,
    is_delayed,
    longest_followed,
    point_to_history,
)
from tracewire.solve.core.locate import AT_ONCE, LEAVES, NOTHING, TOO_LONG
from tracewire.solve.core.methods import EXPONENT, FIXED_STEP, IMPLICIT, SAFETY
from tracewire.solve.core.record import sample_end, sample_inside
from tracewire.solve.core.saltation import begin_sensitivities
from tracewire.solve.core.scheduled import happen_at_known_time
from tracewire.solve.core.start import begin, reach_sides
from tracewire.solve.core.stiffness import choose, watch_stiffness
from tracewire.solve.core.surface import pin
from tracewire.solve.core.transition import happen, no_crossings
from tracewire.solve.core.units import helper, unit

TOGETHER = 1e-12
SOON = 1e-9
NEAR = 32.0
PAUSED_INSIDE = 2  # in ints[STAGE]: between two steps of a smooth part
LARGEST_PART = 0.1  # of the span, for one step
TURN = 1.5  # of what a guard reads, in a step: five samples see its dips
RESOLVED = 1e-15  # of the largest value of a state: its rounding
FADING = 0.95  # in a step: how a state's size is forgotten
SOON_PART = LARGEST_PART  # of the span, as long as a step may be
ROUNDING = 1e-9  # of what a state moves by: to so much do derivatives by differences round
DEPTH = 2  # integrators behind each other, from what moves to a state
SMALLEST_PART = 1e-12  # of the span: no pace asks for a shorter step


@unit
def advance(core: int) -> int:
    """Go on with a run until it ends, its budget of steps or its log is used up, or it fails.

    Returns FINISHED, PAUSED, LOG_FULL, HISTORY_FULL, or the status of an error.
    """
    plan = plan_of(core)
    progress = progress_of(core)
    now, ints, x = progress.now, progress.ints, progress.x
    modes = len(plan.kind)
    ahead = np.empty(len(plan.timed))
    if is_delayed(core):
        point_to_history(core)
    if ints[STAGE] == 0:
        if is_delayed(core):
            begin_history(core)
        evaluate(core, GUARD_WEIGHTS, now[T], x, flow_of(core).weights)
        _first_sizes(core)
        status = begin(core)
        if status != FINISHED:
            return status
        begin_sensitivities(core)
        ints[STAGE] = 1
        rate = trial_of(core).rate
        rates(core, now[T], x, rate)
        if not np.all(np.isfinite(rate)) and not reach_sides(core, now[T], x):
            return UNDEFINED
    budget = ints[STEPS] + ints[BUDGET]
    while now[T] < now[END]:
        if ints[LOGGED] + 8 * (modes + 1) > len(progress.log):
            return LOG_FULL
        if ints[STEPS] >= budget:
            return PAUSED
        status = _smooth(core, ahead, budget)
        if status != FINISHED:
            return status
    sample_end(core, now[T], x)
    return FINISHED


@unit
def _smooth(core: int, ahead: Vector, budget: int) -> int:
    """Steps until something happens, and what happens. A status."""
    flow = flow_of(core)
    progress = progress_of(core)
    trial = trial_of(core)
    now, ints, x = progress.now, progress.ints, progress.x
    rate, start, hit = trial.rate, watch_of(core).start, watch_of(core).hit
    if ints[STAGE] == PAUSED_INSIDE:  # nothing has changed: what was armed is still so
        ints[STAGE] = 1
    else:
        locate.watch(core)
        rates(core, now[T], x, rate)
    due = schedule.upcoming(core, now[T], x, ahead)
    limit = min(due, now[END])
    choose(core)
    if now[H] <= 0.0 and limit > now[T]:
        now[H] = _first_step(core, rate, limit)
    longest = _longest_step(core, now[T], x)
    while now[T] < limit:
        if ints[STEPS] >= budget:
            ints[STAGE] = PAUSED_INSIDE
            return PAUSED
        if is_delayed(core):
            if not has_room(core):
                ints[STAGE] = PAUSED_INSIDE
                return HISTORY_FULL
            now[H] = min(now[H], longest_followed(core, now[T], x))
        if locate.passed(core, hit):  # so slowly that no step has seen it
            return _cross(core, PASSED)
        now[H] = min(now[H], longest)
        status, after = _attempt(core, rate, limit), longest
        if status == FINISHED and longest < np.inf:
            h = trial.ends[1]
            after = _longest_step(core, trial.ends[0] + h, trial.x_end)
            if h > 2.0 * after:  # the guards turn faster at its end than it can follow
                now[H] = max(2.0 * after, h / 4)
                continue
        if status == UNDEFINED:
            return _undefined(core)
        if status != FINISHED:
            return status
        method, ratio = ints[CURRENT], now[RATIO]
        end = trial.ends[0] + trial.ends[1]
        last = limit - end < locate.smallest_step(core)  # the sum of its start and length rounds
        if last:
            end = limit
        how = locate.find(core, method, last)
        at_once = how == AT_ONCE and trial.ends[1] > SOON * now[LENGTH]
        if at_once or how == TOO_LONG:
            now[H] = trial.ends[1] / 16
            continue
        if how == LEAVES:
            return _cross(core, PASSED)
        if how != NOTHING:
            return _crossed(core)
        longest = after
        sample_inside(core, method, end)
        now[T] = end
        copy(trial.x_end, x)
        if flow.counts[SLIDING] + flow.counts[RESTING]:
            pin(core, now[T], x)
            longest = _longest_step(core, now[T], x)
        _remember(core, x)
        now[H] = max(now[H], trial.ends[1] * ratio) if last else trial.ends[1] * ratio
        if IMPLICIT[method] or flow.counts[SLIDING] + flow.counts[RESTING]:
            rates(core, now[T], x, rate)
        else:
            copy(trial.rate_end, rate)
        if last or flow.counts[SLIDING] + flow.counts[RESTING]:
            locate.margins(core, now[T], x, start)
        else:  # the last sample is that of the same time and states
            locate.margins_at_end(core)
        if watch_stiffness(core):
            choose(core)
    if limit == due:
        return happen_at_known_time(core, ahead)
    return FINISHED


@unit
def _first_sizes(core: int) -> None:
    """Of what size the states are at the begin: as large as they are, or as they may move soon.

    What a state at zero moves by follows from the sizes of rates, and these from those of other
    states, which may be at zero, too. Of a state of which all that says nothing the size is 1. The
    tolerance of a state begins with what it is, as far as that is more than rounding.
    """
    progress = progress_of(core)
    now, x, n = progress.now, progress.x, len(progress.x)
    soon, moves = SOON_PART * now[LENGTH], np.empty(n)
    progress.sizes[:] = 0.0
    for _ in range(DEPTH):
        sizes(core, RATE_SIZES, now[T] + soon, x, moves)
        for j in range(n):
            progress.sizes[n + j] = max(progress.sizes[n + j], soon * moves[j])
    for j in range(n):
        size = progress.sizes[n + j] if progress.sizes[n + j] > 0.0 else 1.0
        progress.least[j] = min(1.0, size)
        rounding = ROUNDING / now[RTOL] * progress.least[j]
        progress.largest[j] = max(abs(x[j]), rounding)
        progress.sizes[n + j] = max(abs(x[j]), progress.least[j])
        if progress.given[j] == 0.0:
            progress.atol[j] = _usual_tolerance(now[RTOL], progress.largest[j])


@helper
def _usual_tolerance(rtol: float, largest: float) -> float:
    """The absolute tolerance of a state that was as large as that: no finer than its rounding,
    which is all that moves a state of size 1e12 where friction holds it at zero."""
    usual = max(ABSOLUTE * rtol * min(1.0, largest), RESOLVED * largest)
    return max(usual, 1e-300)  # of a state of 1e-310 it would be zero


@helper
def _remember(core: int, x: Vector) -> None:
    """Keep of what size the states are; the tolerances that nobody gave follow."""
    progress, n = progress_of(core), len(x)
    for j in range(n):
        size = abs(x[j])
        if size > progress.largest[j]:
            progress.largest[j] = size
            if progress.given[j] == 0.0:
                progress.atol[j] = _usual_tolerance(progress.now[RTOL], size)
        progress.least[j] = max(progress.least[j], min(1.0, size))
        progress.sizes[n + j] = max(size, progress.least[j], FADING * progress.sizes[n + j])


@helper
def _longest_step(core: int, t: float, x: Vector) -> float:
    """The longest step in which guards and forces that the states do not feel are seen to turn."""
    now, counts = progress_of(core).now, flow_of(core).counts
    holds = counts[SLIDING] + counts[RESTING] > 0
    if now[PACED] == NEVER or (now[PACED] == WHILE_HELD and not holds):
        return now[LONGEST]
    paces = trial_of(core).paces
    evaluate(core, PACE, t, x, paces)
    pace = paces[0]
    if holds:  # until it breaks loose
        pace = max(pace, paces[1])
    if not pace > 0.0:
        return min(now[LONGEST], LARGEST_PART * now[LENGTH])
    return min(now[LONGEST], max(TURN / pace, SMALLEST_PART * now[LENGTH]))


@helper
def _size(values: Vector, x: Vector, rtol: float, atol: Vector) -> float:
    total = 0.0
    for i in range(len(x)):
        total += (values[i] / (atol[i] + rtol * abs(x[i]))) ** 2
    return math.sqrt(total / max(len(x), 1))


@unit
def _first_step(core: int, rate: Vector, limit: float) -> float:
    """Hairer's starting step for a method of order 5 (Solving ODEs I, section II.4)."""
    progress = progress_of(core)
    now, x = progress.now, progress.x
    length = now[LENGTH]
    if FIXED_STEP[progress.ints[CURRENT]]:
        return now[FIXED]
    size = _size(x, x, now[RTOL], progress.atol)
    speed = _size(rate, x, now[RTOL], progress.atol)
    h = 1e-6 * length if size < 1e-5 or speed < 1e-5 else 0.01 * size / speed
    h = min(h, limit - now[T])
    moved = np.empty(len(x))
    rates(core, now[T] + h, x + h * rate, moved)
    bend = _size(moved - rate, x, now[RTOL], progress.atol) / h
    if not math.isfinite(bend):
        return h * 1e-3
    largest = max(bend, speed)
    after = max(1e-6 * length, h * 1e-3) if largest <= 1e-15 else (0.01 / largest) ** 0.2
    return min(100 * h, after, length)


@helper
def _power(error: float, exponent: float) -> float:
    """The error to this power: a step length needs none of the last digits, which `**` takes as
    much time for as for all others."""
    return math.exp(exponent * math.log(error))


@unit
def _attempt(core: int, rate: Vector, limit: float) -> int:
    """A step within the tolerances, in `trial`; the factor for the next one in now[RATIO].

    UNDEFINED where the rates are undefined however small the step is; UNDERFLOW where the error
    stays large; PAUSED never.
    """
    progress = progress_of(core)
    now, ints = progress.now, progress.ints
    method = ints[CURRENT]
    fixed, safety, power = FIXED_STEP[method], SAFETY[method], EXPONENT[method]
    while True:
        ints[STEPS] += 1
        h = min(now[H], now[FIXED] if fixed else LARGEST_PART * now[LENGTH], now[LONGEST])
        if now[T] + h * (1.0 + 1e-9 if fixed else 1.01) >= limit:
            h = limit - now[T]
        methods.step(core, method, now[T], progress.x, rate, h)
        error = methods.error_of(core, method, now[RTOL], progress.atol, now[LAST])
        if error <= 1.0:
            now[LAST] = h
            if IMPLICIT[method]:
                ints[STIFF_STEPS] += 1
            now[RATIO] = min(6.0, max(0.2, safety * _power(max(error, 1e-10), power)))
            if fixed:
                now[RATIO] = now[FIXED] / h
            return FINISHED
        ints[REJECTED] += 1
        finite = math.isfinite(error)
        now[H] = h * (max(0.1, safety * _power(error, power)) if finite else 0.1)
        if not now[H] >= locate.smallest_step(core):  # or no number, where the rates are none
            return UNDERFLOW if finite else UNDEFINED


@unit
def _undefined(core: int) -> int:
    """Where the rates end to be defined: at a guard it is an event, elsewhere an error.

    The run goes on beyond the guard, where the formula of the mode to come is defined, as that of
    the root of `-h` is below h = 0: no step leads there.
    """
    progress, watched, x = progress_of(core), watch_of(core), progress_of(core).x
    if not np.all(np.isfinite(trial_of(core).rate)) and reach_sides(core, progress.now[T], x):
        return FINISHED
    reach = NEAR * locate.smallest_step(core)
    if locate.reached(core, progress.now[T], x, reach, watched.hit) == 0:
        return UNDEFINED
    along, far = trial_of(core).guards, 0.0  # the rates of the guards, of which some are reached
    for row in range(locate.watched_count(core)):
        falls = -watched.sign[row] * along[watched.mode[row]]
        if watched.hit[row] and falls > 0.0:
            far = max(far, min(2.0 * watched.start[row] / falls, reach))
    for j in range(len(x)):
        progress.beyond[j] = far * trial_of(core).rate[j]
    progress.now[H] = 0.0
    return _cross(core, GUARD)


@unit
def _cross(core: int, how: int) -> int:
    """Let what is marked cross now, guards in this way. A status."""
    progress, watched, crossings = progress_of(core), watch_of(core), crossings_of(core)
    no_crossings(core)
    for row in range(locate.watched_count(core)):
        if watched.hit[row]:
            i, guard = watched.mode[row], watched.kind[row] == GUARD
            crossings.how[i], crossings.to[i] = how if guard else watched.kind[row], watched.to[row]
            crossings.up[i] = int(watched.sign[row] < 0 if guard else watched.to[row] > 0.5)
    return happen(core, progress.now[T], progress.x)


@unit
def _crossed(core: int) -> int:
    """Go to the located time and fire what happens there. A status."""
    progress, trial = progress_of(core), trial_of(core)
    watched, crossings = watch_of(core), crossings_of(core)
    now, ints, x, found = progress.now, progress.ints, progress.x, watched.found
    first = int(np.argmin(found))
    polish.polish(core, found[first], first)
    end = trial.ends[0] + trial.ends[1]
    sample_inside(core, ints[CURRENT], end)
    now[T] = end
    copy(trial.x_end, x)
    if flow_of(core).counts[SLIDING] + flow_of(core).counts[RESTING]:
        pin(core, end, x)
    _remember(core, x)
    hit = watched.hit
    locate.margins(core, end, x, watched.start)
    locate.reached(core, end, x, TOGETHER * now[LENGTH], hit)
    no_crossings(core)
    for row in range(len(found)):
        if not (found[row] < np.inf or hit[row]):
            continue
        i, kind = watched.mode[row], watched.kind[row]
        if crossings.how[i] >= 0 and not found[row] < np.inf:
            continue
        crossings.how[i], crossings.to[i] = kind, watched.to[row]
        up = watched.sign[row] < 0 if kind == GUARD else watched.to[row] > 0.5
        crossings.up[i] = int(up)
    before = x.copy()
    status = happen(core, end, x)
    same = True
    for i in range(len(x)):
        same = same and x[i] == before[i]
    now[H] = now[H] / 4 if same else 0.0
    ints[SUSPICIOUS] = 0
    return status
