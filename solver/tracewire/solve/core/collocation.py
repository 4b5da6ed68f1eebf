"""The variational equation S' = J S + f_p over an interval, by Radau IIA of three stages.

E. Hairer, G. Wanner, Solving ODEs II, sections IV.5 (the method, order 5) and IV.8 (the estimate of
its error, order 3). It is linear, so that one factorisation solves it for all columns of S.
"""

from __future__ import annotations

import math

import numpy as np

from tracewire.solve.core import methods
from tracewire.solve.core.arrays import Ints, Matrix, flow_of, history_of, sensitivity_of, trial_of
from tracewire.solve.core.flow import RESTING, SLIDING
from tracewire.solve.core.history import find_lags, is_delayed, recall
from tracewire.solve.core.linear import factor, substitute_all
from tracewire.solve.core.units import helper, unit
from tracewire.solve.core.variation import field

ROOT = math.sqrt(6.0)
NODES = np.array([(4 - ROOT) / 10, (4 + ROOT) / 10, 1.0])
RADAU = np.array(
    [
        [(88 - 7 * ROOT) / 360, (296 - 169 * ROOT) / 1800, (-2 + 3 * ROOT) / 225],
        [(296 + 169 * ROOT) / 1800, (88 + 7 * ROOT) / 360, (-2 - 3 * ROOT) / 225],
        [(16 - ROOT) / 36, (16 + ROOT) / 36, 1 / 9],
    ]
)
ERROR = np.array([-(13 + 7 * ROOT) / 3, (-13 + 7 * ROOT) / 3, -1 / 3])
REAL = 30.0 / (6.0 + 81 ** (1 / 3) - 9 ** (1 / 3))  # the real eigenvalue of the inverse of RADAU
NOTHING = 1e-7
"""Of the largest part of a column of S: what is smaller is rounding where a slide holds it."""
STILL = 1e-10
"""A column of S that is this small while something is held: what holds it cancels what moves it,
and what is left is rounding, which no shorter interval makes less."""
TIME, INTERVAL, KNOWN, UNCHECKED, LONGEST, SMOOTH = range(6)  # places in Sensitivity.now


@unit
def _slopes(core: int, node: int, place: int, t: float) -> None:
    """J S + f_p at a node, at the time t, with S where the interval begins, as one of three parts
    of `slopes`."""
    sensitivity = sensitivity_of(core)
    s, chain, out = sensitivity.s, sensitivity.chain, sensitivity.slopes
    nodes = sensitivity.nodes
    n, q = s.shape
    if is_delayed(core):
        history = history_of(core)
        for j in range(len(history.mode)):
            history.lag[j] = history.node_lags[node, j]
        recall(core, t)
    for i in range(n):
        row, into = node * n + i, place * n + i
        for j in range(q):
            out[into, j] = 0.0
        for k in range(n):
            part = nodes[row, k]
            if part != 0.0:
                for j in range(q):
                    out[into, j] += part * s[k, j]
        for k in range(chain.shape[0]):
            part = nodes[row, n + 1 + k]
            if part != 0.0:
                for j in range(q):
                    out[into, j] += part * chain[k, j]


@unit
def _fill_nodes(core: int, method: int, h: float) -> None:
    """The derivatives of the rates at the nodes of an interval, and where it begins."""
    sensitivity, trial = sensitivity_of(core), trial_of(core)
    nodes, begin = sensitivity.nodes, sensitivity.now[TIME]
    n = len(trial.x)
    for node in range(4):
        if node == 0 and sensitivity.now[KNOWN] > 0.0:
            continue
        time = begin + (h * NODES[node - 1] if node else 0.0)
        theta = min(1.0, max(0.0, (time - trial.ends[0]) / trial.ends[1]))
        methods.inside(core, method, theta, trial.at)
        field(core, time, trial.at, nodes[node * n : node * n + n])
        if is_delayed(core):
            find_lags(core, time, trial.at)
            history = history_of(core)
            for j in range(len(history.mode)):
                history.node_lags[node, j] = history.lag[j]
    sensitivity.now[KNOWN] = 1.0


@unit
def collocate(core: int, method: int, h: float, check: bool) -> float:
    """Fill in the change of S over an interval at its nodes; its error over the size of S.

    0 where the error is not to be looked at.
    """
    sensitivity = sensitivity_of(core)
    change, slopes = sensitivity.change, sensitivity.slopes
    n, q = sensitivity.s.shape
    _fill_nodes(core, method, h)
    for node in range(3):
        _slopes(core, node + 1, node, sensitivity.now[TIME] + h * NODES[node])
    for a in range(3):
        first, second, third = h * RADAU[a, 0], h * RADAU[a, 1], h * RADAU[a, 2]
        for i in range(n):
            for j in range(q):
                total = first * slopes[i, j] + second * slopes[n + i, j]
                change[a * n + i, j] = total + third * slopes[2 * n + i, j]
    if not _solve(core, h):
        return np.nan
    return _error(core, h) if check else 0.0


@unit
def _eliminated(core: int) -> None:
    """Sort the states: first those whose rates read none of each other, as those of positions."""
    sensitivity = sensitivity_of(core)
    order, nodes, n = sensitivity.order, sensitivity.nodes, sensitivity.s.shape[0]
    count, behind = 0, n
    for i in range(n):
        free = True
        for node in range(1, 4):
            free = free and nodes[node * n + i, i] == 0.0
            for k in range(count):
                other = order[k]
                free = free and nodes[node * n + i, other] == 0.0
                free = free and nodes[node * n + other, i] == 0.0
        if free:
            order[count] = i
            count += 1
        else:
            behind -= 1
            order[behind] = i
    order[n] = count


@unit
def _solve(core: int, h: float) -> bool:
    """Solve Z_a - h sum_b RADAU_ab J_b Z_b = right_a for Z (3n, q) in place of the right sides.

    The states P that read none of each other are eliminated by hand: for mechanical systems, whose
    positions are such states, half of the unknowns are left.
    """
    sensitivity = sensitivity_of(core)
    nodes, change, order = sensitivity.nodes, sensitivity.change, sensitivity.order
    n, q = sensitivity.s.shape
    _eliminated(core)
    first = order[n]
    m = n - first
    matrix, right, inner = np.empty((3 * m, 3 * m)), np.empty((3 * m, q)), sensitivity.slopes
    pivots = np.empty(3 * m, dtype=np.int64)
    for b in range(3):
        for v in range(m):
            row, into = (b + 1) * n + order[first + v], b * m + v
            for j in range(q):
                inner[into, j] = 0.0
            for p in range(first):
                part, source = h * nodes[row, order[p]], b * n + order[p]
                if part != 0.0:
                    for j in range(q):
                        inner[into, j] += part * change[source, j]
    for a in range(3):
        for v in range(m):
            into, source = a * m + v, a * n + order[first + v]
            for j in range(q):
                more = RADAU[a, 0] * inner[v, j] + RADAU[a, 1] * inner[m + v, j]
                right[into, j] = change[source, j] + more + RADAU[a, 2] * inner[2 * m + v, j]
    for c in range(3):
        for v in range(m):
            for k in range(m):
                column = order[first + k]
                own = h * nodes[(c + 1) * n + order[first + v], column]
                by_first = _through(nodes, order, n, first, 1, c + 1, v, column) * h * h
                by_second = _through(nodes, order, n, first, 2, c + 1, v, column) * h * h
                by_third = _through(nodes, order, n, first, 3, c + 1, v, column) * h * h
                for a in range(3):
                    whole = RADAU[a, c] * own + RADAU[a, 0] * RADAU[0, c] * by_first
                    whole += RADAU[a, 1] * RADAU[1, c] * by_second
                    whole += RADAU[a, 2] * RADAU[2, c] * by_third
                    same = 1.0 if a == c and v == k else 0.0
                    matrix[a * m + v, c * m + k] = same - whole
    if factor(matrix, pivots) == 0.0:
        return False
    substitute_all(matrix, pivots, right)
    for a in range(3):
        for v in range(m):
            for j in range(q):
                change[a * n + order[first + v], j] = right[a * m + v, j]
    for b in range(3):
        for p in range(first):
            row, into = (b + 1) * n + order[p], b * first + p
            for j in range(q):
                inner[into, j] = 0.0
            for k in range(m):
                part = h * nodes[row, order[first + k]]
                if part != 0.0:
                    for j in range(q):
                        inner[into, j] += part * right[b * m + k, j]
    for a in range(3):
        for p in range(first):
            into = a * n + order[p]
            for j in range(q):
                more = RADAU[a, 0] * inner[p, j] + RADAU[a, 1] * inner[first + p, j]
                change[into, j] += more + RADAU[a, 2] * inner[2 * first + p, j]
    return True


@helper
def _through(
    nodes: Matrix, order: Ints, n: int, first: int, outer: int, inner: int, v: int, column: int
) -> float:
    """How a state acts on another through those that are eliminated."""
    total = 0.0
    for p in range(first):
        total += nodes[outer * n + order[first + v], order[p]] * nodes[inner * n + order[p], column]
    return total


@unit
def _error(core: int, h: float) -> float:
    """The largest error over the size of S, as RADAU5 estimates it; NaN where it is not finite."""
    sensitivity = sensitivity_of(core)
    s, peak, change = sensitivity.s, sensitivity.peak, sensitivity.change
    n, q = s.shape
    real, error = sensitivity.real, sensitivity.slopes[:n]
    _slopes(core, 0, 0, sensitivity.now[TIME])
    for i in range(n):
        for k in range(n):
            real[i, k] = -sensitivity.nodes[i, k]
        real[i, i] += REAL / h
        first, second, third = ERROR[0] / h, ERROR[1] / h, ERROR[2] / h
        for j in range(q):
            more = first * change[i, j] + second * change[n + i, j]
            error[i, j] += more + third * change[2 * n + i, j]
    if factor(real, sensitivity.real_pivots) == 0.0:
        return np.nan
    substitute_all(real, sensitivity.real_pivots, error)
    worst, counts = 0.0, flow_of(core).counts
    some_held = counts[SLIDING] + counts[RESTING] > 0
    for j in range(q):
        largest = 0.0
        for i in range(n):
            largest = max(largest, peak[i, j], abs(change[2 * n + i, j]))
        if some_held and largest < STILL:
            continue
        for i in range(n):
            size = max(peak[i, j], abs(s[i, j] + change[2 * n + i, j])) + NOTHING * largest
            if abs(error[i, j]) > worst * size:
                worst = abs(error[i, j]) / size
            elif not abs(error[i, j]) < np.inf:
                return np.nan
    return worst
