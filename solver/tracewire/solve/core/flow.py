"""The smooth flow between two events: rates with frozen modes, and Filippov's blend on a slide.

On a slide over surfaces S the field is the sum over patterns of (product of m or 1 - m) times the
frozen field, with the fractions m for which every sliding guard keeps d(guard)/dt = 0. A contact
that rests adds force times push, with the forces for which d2(guard)/dt2 = 0.

Where no mode moves a sliding guard and its rate is zero (friction whose level passes through zero)
the fraction is 0/0, and its limit along the flow follows from the first higher derivative that is
not zero on all sides: the rule of de l'Hopital.
"""

from __future__ import annotations

import numpy as np

from tracewire.solve.core.arrays import Matrix, Vector, copy, flow_of, progress_of
from tracewire.solve.core.codes import LENGTH
from tracewire.solve.core.linear import dot, factor, solved
from tracewire.solve.core.memory import invoke
from tracewire.solve.core.units import helper, unit

FUNCTIONS = (
    "rhs",
    "guards",
    "guard_rates",
    "outputs",
    "timed",
    "resets",
    "jacobian",
    "guard_gradients",
    "guard_curves",
    "guard_second",
    "guard_third",
    "guard_fourth",
    "pace",
    "guard_sizes",
    "guard_rate_sizes",
    "guard_second_sizes",
    "guard_third_sizes",
    "guard_fourth_sizes",
    "rate_sizes",
    "delayed",
    "lags",
    "guard_weights",
)
RHS, GUARDS, GUARD_RATES, OUTPUTS, TIMED, RESETS, JACOBIAN, GRADIENTS, CURVES, SECOND = range(10)
PACE, GUARD_SIZES, GUARD_RATE_SIZES, SECOND_SIZES = range(12, 16)
RATE_SIZES, DELAYED, LAGS, GUARD_WEIGHTS = range(18, 22)
FREE, SLIDING, RESTING = range(3)
# counts[SLIDING] and counts[RESTING] hold how many guards are so; counts[READING] is 1 where guards
# read what a slide may hold
READING, EVALUATIONS = 0, 3
DIFFERENCE = 1e-7
TIME_PART = 1e-3  # of the span: in it a state may move as far as it is large
ROUNDING = 1e-10  # of t, for a difference
AFFINE = 1e-9
INDEPENDENT = 1e-10


@helper
def evaluate(core: int, which: int, t: float, x: Vector, out: Vector) -> None:
    """One of the model's functions with the modes as they stand."""
    flow = flow_of(core)
    if which > GUARD_RATES:  # the others write all of it
        out[:] = 0.0
    invoke(flow.address[which], t, x, flow.m, flow.c, flow.k, out)


@unit
def patterns(core: int, which: int, t: float, x: Vector, size: int) -> Matrix:
    """A function at all sliding modes 0 (row 0), and its change as each of them becomes 1."""
    flow = flow_of(core)
    rows = np.empty((1 + flow.counts[SLIDING], size))
    for i in range(len(flow.bound)):
        if flow.bound[i] == SLIDING:
            flow.m[i] = 0.0
    evaluate(core, which, t, x, rows[0])
    row = 0
    for i in range(len(flow.bound)):
        if flow.bound[i] != SLIDING:
            continue
        row += 1
        flow.m[i] = 1.0
        evaluate(core, which, t, x, rows[row])
        for j in range(size):
            rows[row, j] -= rows[0, j]
        flow.m[i] = 0.0
    return rows


@unit
def sizes(core: int, which: int, t: float, x: Vector, out: Vector) -> None:
    """What the values of a function are made of, in their units; 0 where that is not finite.

    On a slide the larger one of those on its sides.
    """
    both, n = progress_of(core).sizes, len(x)
    for j in range(n):
        both[j] = x[j]
        both[n + j] = max(both[n + j], abs(x[j]))
    if flow_of(core).counts[SLIDING]:
        rows = patterns(core, which, t, both, len(out))
        copy(rows[0], out)
        for row in range(1, len(rows)):
            for i in range(len(out)):
                out[i] = max(out[i], rows[0, i] + rows[row, i])
    else:
        evaluate(core, which, t, both, out)
    for i in range(len(out)):
        if not out[i] < np.inf:
            out[i] = 0.0


@helper
def _held_alone(core: int, t: float, x: Vector) -> Vector:
    """The fraction of the only slide; NaN where none holds it."""
    flow = flow_of(core)
    modes, fraction = len(flow.bound), np.empty(1)
    moves = patterns(core, GUARD_RATES, t, x, modes)
    for i in range(modes):
        if flow.bound[i] == SLIDING:
            change = moves[1, i]
            flow.grip[i] = change
            if change == 0.0 and moves[0, i] == 0.0:
                row, right = np.zeros(1), 0.0
                right = _limit(core, t, x, i, row)
                change, moves[0, i] = row[0], -right
            fraction[0] = -moves[0, i] / change if 0.0 < abs(change) < np.inf else np.nan
    return fraction


@unit
def _limit(core: int, t: float, x: Vector, i: int, row: Vector) -> float:
    """The right side of the equation of the fraction of a slide where it is 0/0, and its row: how
    the first higher derivative that is not zero changes with each fraction.

    Zeros where the field differs with its mode: the mode then never moves the guard's rate itself,
    as that of a relay on a position does not.
    """
    flow = flow_of(core)
    fields, column = patterns(core, RHS, t, x, len(x)), np.sum(flow.bound[: i + 1] == SLIDING)
    if np.any(fields[column] != 0.0):
        row[:] = 0.0
        return 0.0
    for order in range(3):
        moves = patterns(core, SECOND + order, t, x, len(flow.bound))
        for column in range(flow.counts[SLIDING]):
            row[column] = moves[1 + column, i]
        if moves[0, i] != 0.0 or np.any(row != 0.0):
            return -moves[0, i]
    return 0.0


@unit
def slide_equations(core: int, t: float, x: Vector, matrix: Matrix, right: Vector) -> None:
    """The equations of the fractions: a row (of at least as many columns) for each slide."""
    flow = flow_of(core)
    some, slides = flow.counts[SLIDING], np.flatnonzero(flow.bound == SLIDING)
    moves, parts = patterns(core, GUARD_RATES, t, x, len(flow.bound)), np.empty(some)
    for row in range(some):
        right[row], still = -moves[0, slides[row]], moves[0, slides[row]] == 0.0
        flow.grip[slides[row]] = moves[1 + row, slides[row]]
        for column in range(some):
            parts[column] = moves[1 + column, slides[row]]
            still = still and parts[column] == 0.0
        if still:
            right[row] = _limit(core, t, x, slides[row], parts)
        for column in range(some):
            matrix[row, column] = parts[column]


@unit
def held(core: int, t: float, x: Vector) -> Vector:
    """The fractions of the slides, then the forces of the contacts; NaN where none hold them."""
    flow = flow_of(core)
    n, modes = len(x), len(flow.bound)
    if flow.counts[SLIDING] == 1 and flow.counts[RESTING] == 0:  # the usual case, made fast
        return _held_alone(core, t, x)
    slides = np.flatnonzero(flow.bound == SLIDING)
    rests = np.flatnonzero(flow.bound == RESTING)
    some, count = len(slides), len(slides) + len(rests)
    matrix, right = np.empty((count, count)), np.empty(count)
    slide_equations(core, t, x, matrix, right)
    if len(rests):
        fields = patterns(core, RHS, t, x, n)
        curves, gradients = np.empty((modes, n + 1)), np.empty((modes, n))
        evaluate(core, CURVES, t, x, curves)
        evaluate(core, GRADIENTS, t, x, gradients)
        for row in range(count):
            slope = gradients[slides[row]] if row < some else curves[rests[row - some], :n]
            for column in range(some, count):
                matrix[row, column] = dot(slope, flow.push[rests[column - some]])
            if row >= some:
                right[row] = -dot(slope, fields[0]) - curves[rests[row - some], n]
                for column in range(some):
                    matrix[row, column] = dot(slope, fields[1 + column])
    return solved(matrix, right)


@helper
def push(core: int, forces: Vector, out: Vector) -> None:
    """Add what the contacts do to the rates."""
    flow = flow_of(core)
    row = 0
    for i in range(len(flow.bound)):
        if flow.bound[i] == RESTING:
            for j in range(len(out)):
                out[j] += forces[row] * flow.push[i, j]
            row += 1


@unit
def blended(core: int, which: int, t: float, x: Vector, fractions: Vector, out: Vector) -> None:
    """A function on a slide, as the blend of its values on the sides."""
    flow = flow_of(core)
    rows = patterns(core, which, t, x, len(out))
    copy(rows[0], out)
    for row in range(flow.counts[SLIDING]):
        for j in range(len(out)):
            out[j] += fractions[row] * rows[1 + row, j]


@unit
def rates(core: int, t: float, x: Vector, out: Vector) -> None:
    """dx/dt with frozen modes; on a slide or in a contact the field that stays there."""
    stage_rates(core, t, x, out)


@helper
def stage_rates(core: int, t: float, x: Vector, out: Vector) -> None:
    """The same as a part of its caller: of a method, whose stages are most of the calls."""
    flow = flow_of(core)
    flow.counts[EVALUATIONS] += 1
    if flow.counts[SLIDING] + flow.counts[RESTING] == 0:
        evaluate(core, RHS, t, x, out)
    else:
        _held_rates(core, t, x, out)


@unit
def _held_rates(core: int, t: float, x: Vector, out: Vector) -> None:
    """dx/dt on a slide or in a contact."""
    flow = flow_of(core)
    both = held(core, t, x)
    blended(core, RHS, t, x, both, out)
    push(core, both[flow.counts[SLIDING] :], out)


@unit
def outputs(core: int, t: float, x: Vector, out: Vector) -> None:
    """The recorded signals."""
    flow = flow_of(core)
    if flow.counts[SLIDING] == 0:
        evaluate(core, OUTPUTS, t, x, out)
    else:
        blended(core, OUTPUTS, t, x, held(core, t, x), out)


@unit
def jacobian(core: int, t: float, x: Vector, out: Matrix) -> None:
    """d rates / dx and, last, d rates / dt (n, n + 1): from the tape, by differences on a slide."""
    flow = flow_of(core)
    n = len(x)
    if flow.counts[SLIDING] + flow.counts[RESTING] == 0:
        evaluate(core, JACOBIAN, t, x, out)
        return
    base, moved, at = np.empty(n), np.empty(n), x.copy()
    progress = progress_of(core)
    length = progress.now[LENGTH]
    rates(core, t, x, base)
    for j in range(n):
        size = max(abs(x[j]), progress.sizes[n + j], abs(base[j]) * TIME_PART * length)
        at[j] = x[j] + DIFFERENCE * (size if size > 0.0 else 1.0)
        rates(core, t, at, moved)
        out[:, j] = (moved - base) / (at[j] - x[j])
        at[j] = x[j]
    later = t + max(DIFFERENCE * TIME_PART * length, ROUNDING * abs(t))
    rates(core, later, x, moved)
    out[:, n] = (moved - base) / (later - t)


@unit
def is_independent(core: int, t: float, x: Vector) -> bool:
    """Whether the sliding modes move their guards independently, so that one slide fits."""
    flow = flow_of(core)
    some = flow.counts[SLIDING]
    if some < 2:
        return True
    matrix, right = np.empty((some, some)), np.empty(some)
    slide_equations(core, t, x, matrix, right)
    for row in range(some):
        largest = 0.0
        for column in range(some):
            largest = max(largest, abs(matrix[row, column]))
        if not largest > 0.0:
            return False
        matrix[row] /= largest
    return factor(matrix, np.empty(some, dtype=np.int64)) > INDEPENDENT


@unit
def is_affine(core: int, t: float, x: Vector) -> bool:
    """Whether the rates are affine in the sliding modes, so that the blend is Filippov's."""
    flow = flow_of(core)
    n = len(x)
    rows = patterns(core, RHS, t, x, n)
    slides = np.flatnonzero(flow.bound == SLIDING)
    for i in slides:
        flow.m[i] = 1.0
    corner = np.empty(n)
    evaluate(core, RHS, t, x, corner)
    for i in slides:
        flow.m[i] = 0.0
    size = 0.0
    for row in range(1, len(rows)):
        corner -= rows[row]
        size = max(size, np.max(np.abs(rows[row])))
    return bool(np.all(np.abs(corner - rows[0]) <= AFFINE * size))


@helper
def bind(core: int, i: int, how: int) -> None:
    """Let a guard slide or rest, or free it."""
    flow = flow_of(core)
    old = flow.bound[i]
    if old != how:
        if old != FREE:
            flow.counts[old] -= 1
        if how != FREE:
            flow.counts[how] += 1
        flow.bound[i] = how
