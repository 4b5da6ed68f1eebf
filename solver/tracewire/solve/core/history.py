"""What delayed signals were: kept at each accepted step, and read by the functions of the model.

Over a step each signal is a polynomial of degree 8 through its values at Chebyshev's nodes in the
dense output, or several, where one does not follow it. When something happens a new stretch of the
signals begins, as far as they feel it: `order` integrators away a jump of the derivative of order r
is one of order r + order, and beyond MOST_RANK it is left to the error of the steps. A run steps on
the ends of stretches, and within one it reads no other: so what it reads is smooth between events.
"""

from __future__ import annotations

import numpy as np

from tracewire.solve.core import methods
from tracewire.solve.core.arrays import (
    FIRST,
    History,
    Ints,
    Vector,
    crossings_of,
    flow_of,
    history_of,
    is_sensitive,
    plan_of,
    progress_of,
    sensitivity_of,
    trial_of,
)
from tracewire.solve.core.codes import DELAY, DROPPED, LENGTH, MOVES, NODE, POINTS, RTOL, T
from tracewire.solve.core.flow import DELAYED, LAGS, RESTING, SLIDING, blended, evaluate, held
from tracewire.solve.core.memory import ints_at
from tracewire.solve.core.surface import pin
from tracewire.solve.core.units import helper, unit

MOST_RANK = 5  # of the methods of order 5: what is smoother they do not see
DEGREE = 8
HEAD, EACH = 3, DEGREE + 2
NODES = np.array([-np.cos(np.pi * k / DEGREE) for k in range(DEGREE + 1)])


def powers_from_nodes(nodes: Vector) -> Vector:
    """The matrix from values at Chebyshev's nodes to coefficients of powers of z."""
    degree = len(nodes) - 1
    series = np.array(
        [
            [
                np.cos(np.pi * row * (degree - k) / degree)
                * (0.5 if k in (0, degree) else 1.0)
                * (0.5 if row in (0, degree) else 1.0)
                * 2.0
                / degree
                for k in range(degree + 1)
            ]
            for row in range(degree + 1)
        ]
    )
    polynomials = np.zeros((degree + 1, degree + 1))
    for row in range(degree + 1):
        unit_vector = np.zeros(row + 1)
        unit_vector[row] = 1.0
        polynomials[row, : row + 1] = np.polynomial.chebyshev.cheb2poly(unit_vector)
    return np.asarray(polynomials.T @ series)


POWERS = powers_from_nodes(NODES)
LARGEST = 2.0 ** (DEGREE - 1)  # the coefficient of z**8 in Chebyshev's polynomial, 128
EXACT = 0.1  # of the relative tolerance, of the size of a signal
FINEST = 1e-13
SMALLEST = 2.0**-11  # of a step: the shortest piece
ROOM = 2100  # pieces that a step may need
SPARE = 64  # points
SHORTEST = 1e-12  # of the span: no piece asks for a shorter step
PIECES = FIRST[History] + History._fields.index("pieces")


@helper
def is_delayed(core: int) -> bool:
    """Whether the model reads what signals were."""
    return len(history_of(core).mode) > 0


@unit
def point_to_history(core: int) -> None:
    """Tell the functions of the model where the pieces are."""
    table = ints_at(core, (3 * (PIECES + 1),))
    flow_of(core).c[history_of(core).first[0]] = float(table[3 * PIECES])


@unit
def begin_history(core: int) -> None:
    """Nothing has been, and at the start each signal jumps from what is declared to what it is."""
    history, progress = history_of(core), progress_of(core)
    t = progress.now[T]
    history.counts[:], history.along[:] = 0, 0
    history.size[:] = 0.0
    history.pieces[:2] = 0.0  # a choice computes what it does not take
    history.pieces[0, 1] = history.pieces.shape[1]
    for j in range(len(history.mode)):
        history.points[j, 0], history.ranks[j, 0], history.counts[j, POINTS] = t, 0, 1
        flow_of(core).m[history.mode[j]] = 0.0
        if is_sensitive(core):
            history.shifts[j, : len(sensitivity_of(core).moved)] = 0.0


@helper
def find_lags(core: int, t: float, x: Vector) -> None:
    """Fill in the delays as they are now."""
    evaluate(core, LAGS, t, x, history_of(core).lag)


@helper
def stretch_now(core: int, j: int) -> float:
    """The number of the stretch of a signal that has begun last."""
    history = history_of(core)
    return float(history.counts[j, POINTS] + history.counts[j, DROPPED])


@unit
def record_step(core: int, method: int) -> None:
    """Keep the signals over the step in `trial`, which is accepted up to its end."""
    history, trial, flow = history_of(core), trial_of(core), flow_of(core)
    count, t, h = len(history.mode), trial.ends[0], trial.ends[1]
    x, values = np.empty(len(trial.x)), history.at
    exact = EXACT * max(progress_of(core).now[RTOL], FINEST)
    is_held = flow.counts[SLIDING] + flow.counts[RESTING] > 0
    begin, width = 0.0, 1.0
    while begin < 1.0:
        for node in range(DEGREE + 1):
            theta = begin + width * 0.5 * (1.0 + NODES[node])
            methods.inside(core, method, theta, x)
            if is_held:
                pin(core, t + theta * h, x)
            if flow.counts[SLIDING]:
                both = held(core, t + theta * h, x)
                blended(core, DELAYED, t + theta * h, x, both, values[node, :count])
            else:
                evaluate(core, DELAYED, t + theta * h, x, values[node, :count])
        row = int(history.pieces[0, 0]) + 1
        piece, good = history.pieces[row], True
        for j in range(count):
            good = _fit(core, j, piece, exact) and good
        if not good and width > SMALLEST:
            width *= 0.5
            continue
        piece[0], piece[1] = t + begin * h, t + (begin + 0.5 * width) * h
        piece[2] = 2.0 / (width * h)
        history.pieces[0, 0] = row
        begin += width
        width = min(2.0 * width, 1.0 - begin)
    history.along[NODE] = 0


@unit
def _fit(core: int, j: int, piece: Vector, exact: float) -> bool:
    """Write the polynomial of a signal into a piece; whether it follows the signal closely.

    By its last coefficients: those of Chebyshev's polynomials are far below the tolerance.
    """
    history = history_of(core)
    own, base, size = HEAD + EACH * j, history.at[0, j], history.size[j]
    for node in range(DEGREE + 1):
        size = max(size, abs(history.at[node, j]))
    history.size[j] = size
    piece[own] = stretch_now(core, j)
    for k in range(DEGREE + 1):
        total = 0.0
        for node in range(1, DEGREE + 1):
            total += POWERS[k, node] * (history.at[node, j] - base)
        piece[own + 1 + k] = total
    piece[own + 1] += base
    last = abs(piece[own + 1 + DEGREE]) / LARGEST
    before = abs(piece[own + DEGREE]) / LARGEST * 2.0
    return not (last > exact * size or before > 10.0 * exact * size)


@unit
def mark_jumps(core: int, t: float, before: Vector, x: Vector, old: Vector, bound: Ints) -> bool:
    """Begin new stretches of the signals that feel what has just happened.

    before, old, bound: the states, modes and what was held before it. Whether there are any.
    """
    history, flow, plan = history_of(core), flow_of(core), plan_of(core)
    modes, found = len(plan.kind), False
    for j in range(len(history.mode)):
        rank, cause = MOST_RANK + 1, -1
        for i in range(modes):
            if flow.m[i] == old[i] and flow.bound[i] == bound[i]:
                continue
            own = history.order[i, j] if flow.bound[i] == bound[i] else 0
            if plan.kind[i] == DELAY:
                own += _rank(core, plan.table[i], flow.m[i])
            if own < rank:
                rank, cause = own, i
        for k in range(len(x)):
            if x[k] != before[k] and history.order[modes + k, j] < rank:
                rank, cause = history.order[modes + k, j], -1
        if rank <= MOST_RANK:
            _add_point(core, j, t, rank, cause)
            found = True
    return found


@helper
def _rank(core: int, j: int, number: float) -> int:
    """The order of the derivative that jumps where a stretch begins."""
    history = history_of(core)
    place = int(number) - 1 - history.counts[j, DROPPED]
    return history.ranks[j, place] if place >= 0 else 0


@unit
def _add_point(core: int, j: int, t: float, rank: int, cause: int) -> None:
    """Begin a stretch now, or have the one that has begun now begin with a larger jump."""
    history = history_of(core)
    place = history.counts[j, POINTS]
    if place > 0 and history.points[j, place - 1] == t:
        place -= 1
        if history.ranks[j, place] <= rank:
            return
    else:
        history.counts[j, POINTS] = place + 1
    history.points[j, place], history.ranks[j, place] = t, rank
    if is_sensitive(core):
        sensitivity = sensitivity_of(core)
        q = len(sensitivity.moved)
        for k in range(q):
            own = cause >= 0 and crossings_of(core).how[cause] >= 0
            moves = sensitivity.instants[cause, k] if own else sensitivity.moved[k]
            history.shifts[j, place * q + k] = moves


@helper
def jump_moves(core: int, j: int, number: float, k: int) -> float:
    """How the time of a jump moves with one of what is asked for."""
    history = history_of(core)
    place = int(number) - 1 - history.counts[j, DROPPED]
    q = len(sensitivity_of(core).moved)
    return history.shifts[j, place * q + k] if place >= 0 else 0.0


@unit
def has_room(core: int) -> bool:
    """Whether another step can be kept, after what is too old has been forgotten."""
    history, flow, progress = history_of(core), flow_of(core), progress_of(core)
    some = len(history.pieces) - 2 - ROOM
    least = len(history.moves) - 2
    points = history.points.shape[1] - SPARE
    crowded = history.pieces[0, 0] > some or history.along[MOVES] > least
    for j in range(len(history.mode)):
        crowded = crowded or history.counts[j, POINTS] > points
    if not crowded:
        return True
    oldest, delays = progress.now[T], len(history.mode)
    find_lags(core, progress.now[T], progress.x)
    for j in range(delays):
        begin = progress.now[T] - history.lag[delays + j]
        oldest = min(oldest, begin)
        _forget_points(core, j, int(flow.m[history.mode[j]]), begin)
    count = int(history.pieces[0, 0])
    history.pieces[0, 0] = _forget(history.pieces, 1, count, oldest)
    history.along[MOVES] = _forget(history.moves, 0, history.along[MOVES], oldest)
    crowded = history.pieces[0, 0] > 0.75 * some or history.along[MOVES] > 0.75 * least
    for j in range(len(history.mode)):
        crowded = crowded or history.counts[j, POINTS] > 0.75 * points
    return not crowded


@helper
def _forget(rows: Vector, first: int, count: int, oldest: float) -> int:
    """Drop the rows that end before a time, but for the last of them; how many are left."""
    drop = 0
    while drop + 2 < count and rows[first + drop + 2, 0] <= oldest:
        drop += 1
    if drop > 0:
        for row in range(count - drop):
            for k in range(rows.shape[1]):
                rows[first + row, k] = rows[first + row + drop, k]
    return count - drop


@helper
def _forget_points(core: int, j: int, number: int, oldest: float) -> None:
    """Drop the points before that of a number whose stretches have ended before a time."""
    history = history_of(core)
    count, gone = history.counts[j, POINTS], history.counts[j, DROPPED]
    drop = 0
    while drop + 1 < min(number - gone, count) and history.points[j, drop + 1] < oldest:
        drop += 1
    if drop == 0:
        return
    q = history.shifts.shape[1] // history.points.shape[1]
    for place in range(count - drop):
        history.points[j, place] = history.points[j, place + drop]
        history.ranks[j, place] = history.ranks[j, place + drop]
        for k in range(q):
            history.shifts[j, place * q + k] = history.shifts[j, (place + drop) * q + k]
    history.counts[j, POINTS], history.counts[j, DROPPED] = count - drop, gone + drop


@unit
def longest_followed(core: int, t: float, x: Vector) -> float:
    """The longest step that meets two pieces at most of each signal that a guard reads."""
    history, flow = history_of(core), flow_of(core)
    count, longest = int(history.pieces[0, 0]), np.inf
    if np.any(history.seen == 1):
        find_lags(core, t, x)
    for j in range(len(history.mode)):
        if history.seen[j] == 0 or flow.m[history.mode[j]] < 1.0 or count == 0:
            continue
        s, low, high = t - history.lag[j], 1, count
        while low < high:
            middle = (low + high + 1) // 2
            if history.pieces[middle, 0] <= s:
                low = middle
            else:
                high = middle - 1
        least = SHORTEST * progress_of(core).now[LENGTH]
        for piece in range(low + 1, count + 1):
            end = history.pieces[piece, 1] + 1.0 / history.pieces[piece, 2]
            if end - s > least:
                longest = min(longest, end - s)
                break
    return longest


@unit
def is_rough(core: int, i: int, number: float) -> bool:
    """Whether a delayed signal, or its rate, jumps where a stretch begins."""
    return _rank(core, plan_of(core).table[i], number) <= 1


@unit
def recall(core: int, t: float) -> None:
    """Let the columns of delayed signals be how these moved, with the stretches as they stand and
    the delays that were found last."""
    history, sensitivity, flow = history_of(core), sensitivity_of(core), flow_of(core)
    chain, count, q = sensitivity.chain, len(history.mode), len(sensitivity.moved)
    first = chain.shape[0] - 2 * count
    for j in range(count):
        for k in range(q):
            chain[first + j, k] = chain[first + count + j, k] = 0.0
        stretch, s, rows = flow.m[history.mode[j]], t - history.lag[j], history.along[MOVES]
        if stretch < 1.0 or rows == 0:
            continue
        low, high = 0, rows - 1
        while low < high:
            middle = (low + high + 1) // 2
            if history.moves[middle, 0] <= s:
                low = middle
            else:
                high = middle - 1
        while low > 0 and history.moves[low, 3 + j] > stretch:
            low -= 1
        while low < rows - 1 and history.moves[low, 3 + j] < stretch:
            low += 1
        piece = history.moves[low]
        z = (s - piece[1]) * piece[2]
        for k in range(q):
            at = HEAD + count + 5 * (j * q + k)
            value, slope = piece[at + 4], 0.0
            for power in range(3, -1, -1):
                slope = slope * z + value
                value = value * z + piece[at + power]
            chain[first + j, k], chain[first + count + j, k] = value, slope * piece[2]
