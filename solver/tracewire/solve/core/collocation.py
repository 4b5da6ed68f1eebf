"""The variational equation S' = J S + f_p over an interval, by Radau IIA of three stages.

E. Hairer, G. Wanner, Solving ODEs II, sections IV.5 (the method, order 5) and IV.8 (the estimate of
its error, order 3). It is linear, so that one factorisation solves it for all columns of S.
"""

from __future__ import annotations

import math

import numpy as np

from tracewire.solve.core import methods
from tracewire.solve.core.arrays import (
    Matrix,
    Vector,
    copy,
    flow_of,
    history_of,
    sensitivity_of,
    trial_of,
)
from tracewire.solve.core.flow import RESTING, SLIDING
from tracewire.solve.core.history import find_lags, is_delayed, recall
from tracewire.solve.core.linear import factor, put_rows, substitute_all
from tracewire.solve.core.rows import add_row, add_two, put_three
from tracewire.solve.core.stages import NODES, RADAU, eliminate, solve_stages
from tracewire.solve.core.trail import step_at
from tracewire.solve.core.units import helper, inlined, unit
from tracewire.solve.core.variation import field

ROOT = math.sqrt(6.0)
OF_CHANGES = np.array([-(13 + 7 * ROOT) / 3, (-13 + 7 * ROOT) / 3, -1 / 3])
ERROR = OF_CHANGES @ RADAU  # of the slopes at the nodes, beside that where the interval begins
REAL = 30.0 / (6.0 + 81 ** (1 / 3) - 9 ** (1 / 3))  # the real eigenvalue of the inverse of RADAU
NOTHING = 1e-7
"""Of the largest part of a column of S: what is smaller is rounding where a slide holds it."""
STILL = 1e-10
"""A column of S that is this small while something is held: what holds it cancels what moves it,
and what is left is rounding, which no shorter interval makes less."""
# places in Sensitivity.now
TIME, INTERVAL, KNOWN, SMOOTH = range(4)
DENSE, AHEAD, PENDING, TOLERANCE, INSIDE_ERROR, INSIDE_TOLERANCE, SLOPED = range(4, 11)


def _weights_inside() -> Matrix:
    """The integrals from 0 to theta of the Lagrange polynomials of 0 and the nodes, by the powers
    1 to 4 of theta."""
    places, rows = np.array([0.0, *NODES]), np.zeros((4, 4))
    for k in range(4):
        others = np.delete(places, k)
        rows[k] = np.poly(others)[::-1] / np.prod(places[k] - others) / np.arange(1, 5)
    return rows


INSIDE = _weights_inside()


@unit
def _slopes(core: int, node: int, t: float) -> None:
    """J S + f_p at a node, at the time t, with S where the interval begins."""
    n = len(sensitivity_of(core).s)
    if n == 2:
        _fill_sized(core, node, t, 2)
    elif n == 3:
        _fill_sized(core, node, t, 3)
    elif n == 4:
        _fill_sized(core, node, t, 4)
    else:
        _fill_sized(core, node, t, n)


@inlined
def _fill_sized(core: int, node: int, t: float, n: int) -> None:
    """The same, built in with the number of states.

    What is the same at all nodes is filled in at the first one only.
    """
    sensitivity = sensitivity_of(core)
    order = sensitivity.order
    a = len(sensitivity.chain)
    counts = flow_of(core).counts
    some_held = counts[SLIDING] + counts[RESTING] > 0
    if is_delayed(core):
        history = history_of(core)
        for j in range(len(history.mode)):
            history.lag[j] = history.node_lags[node, j]
        recall(core, t)
    for place in range(order[n] if node > 1 and order[n + 1] > 0 else 0, n):
        state = order[place]
        row, begin, behind = node * n + state, 0, a
        if not some_held:
            begin, behind = sensitivity.reads[state, 0], sensitivity.reads[state, 1]
        derivatives, s = sensitivity.nodes[row], sensitivity.s
        put_total(core, derivatives, begin, behind, s, sensitivity.slopes, row, n)


@inlined
def put_total(
    core: int,
    derivatives: Vector,
    begin: int,
    behind: int,
    s: Matrix,
    out: Matrix,
    into: int,
    n: int,
) -> None:
    """Let a row of `out` be what derivatives (w,) in x, t and parameters are in all, t fixed.

    Those in the parameters from `begin` to `behind`; of the others they are zero.
    """
    sensitivity = sensitivity_of(core)
    chain, filled = sensitivity.chain, sensitivity.filled
    weights, picks, count = sensitivity.weights, sensitivity.picks, 0
    for k in range(n):
        if derivatives[k] != 0.0:
            weights[count], picks[count] = derivatives[k], k
            count += 1
    put_rows(count, weights, picks, s, out, into)
    for k in range(begin, behind):
        part = derivatives[n + 1 + k]
        if part != 0.0:
            first, end = filled[k, 0], filled[k, 1]
            if end == first + 1:  # of most parameters: what is asked for is the parameter itself
                out[into, first] += part * chain[k, first]
            else:
                for j in range(first, end):
                    out[into, j] += part * chain[k, j]


@unit
def _fill_nodes(core: int, h: float) -> None:
    """The derivatives of the rates at the nodes of an interval, and where it begins."""
    sensitivity, trial = sensitivity_of(core), trial_of(core)
    nodes, begin = sensitivity.nodes, sensitivity.now[TIME]
    n = len(trial.x)
    for node in range(4):
        if node == 0:
            if sensitivity.now[KNOWN] > 0.0:
                continue
            sensitivity.now[SLOPED] = 0.0
        time = begin + (h * NODES[node - 1] if node else 0.0)
        method = step_at(core, time)
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
def collocate(core: int, h: float) -> float:
    """Fill in S' where an interval begins and at its nodes, and the change of S over it; its error
    over the size of S."""
    sensitivity = sensitivity_of(core)
    change, slopes = sensitivity.change, sensitivity.slopes
    n = len(sensitivity.s)
    _fill_nodes(core, h)
    eliminate(core)
    for node in range(1, 4):
        _slopes(core, node, sensitivity.now[TIME] + h * NODES[node - 1])
    if not solve_stages(core, h):
        return np.nan
    first, second, third = h * RADAU[2, 0], h * RADAU[2, 1], h * RADAU[2, 2]
    for i in range(n):
        put_three(change, i, first, slopes, n + i, second, 2 * n + i, third, 3 * n + i)
    if sensitivity.now[SLOPED] == 0.0:
        _slopes(core, 0, sensitivity.now[TIME])
        sensitivity.now[SLOPED] = 1.0
    return _error(core, h)


@unit
def _error(core: int, h: float) -> float:
    """The largest error over the size of S, as RADAU5 estimates it; NaN where it is not finite.

    It is damped as stiff parts of S are at the end of the interval, unless it is small without
    that. Inside of it they are not.
    """
    sensitivity = sensitivity_of(core)
    slopes, error = sensitivity.slopes, sensitivity.right
    n = len(sensitivity.s)
    real, pivots, part = sensitivity.system[:n], sensitivity.pivots[:n], h / REAL
    first, second, third = part * ERROR[0], part * ERROR[1], part * ERROR[2]
    for i in range(n):
        put_three(error, i, first, slopes, n + i, second, 2 * n + i, third, 3 * n + i)
        add_row(error, i, part, slopes, i)
    worst = _over_size(core, error)
    sensitivity.now[INSIDE_ERROR] = worst
    if worst <= sensitivity.now[TOLERANCE]:
        return worst
    for i in range(n):
        for k in range(n):
            real[i, k] = -part * sensitivity.nodes[i, k]
        real[i, i] += 1.0
    if factor(real, pivots) == 0.0:
        return np.nan
    substitute_all(real, pivots, error[:n])
    return _over_size(core, error)


@unit
def _over_size(core: int, error: Matrix) -> float:
    """The largest part of an error over the size of S there; NaN where it is not finite."""
    sensitivity, counts = sensitivity_of(core), flow_of(core).counts
    s, peak, change = sensitivity.s, sensitivity.peak, sensitivity.change
    (n, q), columns = s.shape, sensitivity.parts
    worst, total = 0.0, 0.0
    some_held = counts[SLIDING] + counts[RESTING] > 0
    for j in range(q):  # row by row, as each column has a largest number and a sum of its own
        columns[0, j], columns[1, j], columns[2, j] = 0.0, 0.0, 0.0
    for i in range(n):
        for j in range(q):
            columns[0, j] = max(columns[0, j], peak[i, j], abs(change[i, j]))
    for i in range(n):  # no branches: which of the errors is the largest cannot be foreseen
        for j in range(q):
            size = max(peak[i, j], abs(s[i, j] + change[i, j])) + NOTHING * columns[0, j]
            part = abs(error[i, j]) / size if error[i, j] != 0.0 else 0.0
            columns[1, j] = max(columns[1, j], part)
            columns[2, j] += part
    for j in range(q):
        if some_held and columns[0, j] < STILL:
            continue
        worst = max(worst, columns[1, j])
        total += columns[2, j]
    return worst if total < np.inf else np.nan


@unit
def fill_between(core: int, h: float, theta: float) -> None:
    """Fill in S inside of an interval, theta in [0, 1].

    The polynomial of degree 4 whose slopes are those where the interval begins and at its nodes;
    at the end it is S there, as the nodes integrate it exactly. Its error is of order 5.
    """
    sensitivity = sensitivity_of(core)
    s, slopes, out = sensitivity.s, sensitivity.slopes, sensitivity.between
    n = len(s)
    begin, first = h * _weight(0, theta), h * _weight(1, theta)
    second, third = h * _weight(2, theta), h * _weight(3, theta)
    for i in range(n):
        copy(s[i], out[i])
        add_two(out, i, begin, slopes, i, first, n + i)
        add_two(out, i, second, slopes, 2 * n + i, third, 3 * n + i)


@helper
def _weight(k: int, theta: float) -> float:
    total = 0.0
    for power in range(3, -1, -1):
        total = (total + INSIDE[k, power]) * theta
    return total
