"""The linear system of the three stages of Radau IIA: the slopes of S at the nodes of an interval.

K_b - J_b h sum_c RADAU_bc K_c = r_b, with r_b = J_b S + f_p at the node b and S where the interval
begins. The states P that read none of each other are eliminated by hand: for mechanical systems,
whose positions are such states, half of the unknowns are left.
"""

from __future__ import annotations

import math

import numpy as np

from tracewire.solve.core.arrays import Ints, Matrix, sensitivity_of
from tracewire.solve.core.history import is_delayed
from tracewire.solve.core.linear import add_rows, factor, substitute_all
from tracewire.solve.core.rows import put_three
from tracewire.solve.core.units import helper, inlined, unit

ROOT = math.sqrt(6.0)
NODES = np.array([(4 - ROOT) / 10, (4 + ROOT) / 10, 1.0])
RADAU = np.array(
    [
        [(88 - 7 * ROOT) / 360, (296 - 169 * ROOT) / 1800, (-2 + 3 * ROOT) / 225],
        [(296 + 169 * ROOT) / 1800, (88 + 7 * ROOT) / 360, (-2 - 3 * ROOT) / 225],
        [(16 - ROOT) / 36, (16 + ROOT) / 36, 1 / 9],
    ]
)
SQUARE = RADAU @ RADAU


@unit
def solve_stages(core: int, h: float) -> bool:
    """Replace r in the last three parts of `slopes` by K; whether there is one solution.

    The states are sorted by `eliminate`.
    """
    n = len(sensitivity_of(core).s)
    first = sensitivity_of(core).order[n]
    if n == 2 and first == 1:
        found = _solve(core, h, 2, 1)
    elif n == 3 and first == 1:
        found = _solve(core, h, 3, 1)
    elif n == 4 and first == 2:
        found = _solve(core, h, 4, 2)
    else:
        found = _solve(core, h, n, first)
    return found


@inlined
def _solve(core: int, h: float, n: int, first: int) -> bool:
    """The same, built in with its size: short loops are faster where the compiler knows them."""
    sensitivity = sensitivity_of(core)
    size = 3 * (n - first)
    matrix, pivots = sensitivity.system[:size], sensitivity.pivots[:size]
    _fill_right(core, h, n, first)
    _fill(core, h, matrix, n, first)
    if factor(matrix, pivots) == 0.0:
        return False
    substitute_all(matrix, pivots, sensitivity.right[:size])
    _fill_slopes(core, h, n, first)
    return True


@unit
def eliminate(core: int) -> None:
    """Sort the states: first those whose rates read none of each other, as those of positions.

    Behind them stands how many there are, and 1 where their rates change in the same way at all
    nodes, as those of positions do.
    """
    sensitivity = sensitivity_of(core)
    order, nodes, n = sensitivity.order, sensitivity.nodes, sensitivity.s.shape[0]
    count, behind, steady = 0, n, not is_delayed(core)
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
            for k in range(nodes.shape[1]):
                steady = steady and nodes[n + i, k] == nodes[2 * n + i, k]
                steady = steady and nodes[n + i, k] == nodes[3 * n + i, k]
        else:
            behind -= 1
            order[behind] = i
    order[n], order[n + 1] = count, int(steady)


@inlined
def _fill_right(core: int, h: float, n: int, first: int) -> None:
    """The right sides of the states that are left: r, and what r of the others adds to it."""
    sensitivity = sensitivity_of(core)
    nodes, slopes, order = sensitivity.nodes, sensitivity.slopes, sensitivity.order
    right, parts, weights = sensitivity.right, sensitivity.parts, sensitivity.weights
    picks, q = sensitivity.picks, sensitivity.s.shape[1]
    steady = order[n + 1] > 0
    m = n - first
    for b in range(3):
        if not steady:
            one, two, three = h * RADAU[b, 0], h * RADAU[b, 1], h * RADAU[b, 2]
            for p in range(first):
                own = order[p]
                put_three(parts, own, one, slopes, n + own, two, 2 * n + own, three, 3 * n + own)
        for v in range(m):
            row, into, count = (b + 1) * n + order[first + v], b * m + v, 0
            for j in range(q):
                right[into, j] = slopes[row, j]
            for p in range(first):
                part = nodes[row, order[p]]
                if part != 0.0:
                    picks[count] = n + order[p] if steady else order[p]
                    weights[count] = part * h * NODES[b] if steady else part
                    count += 1
            add_rows(count, weights, picks, slopes if steady else parts, right, into)


@inlined
def _fill_slopes(core: int, h: float, n: int, first: int) -> None:
    """K of the states that are left from the solution, and K of the others that follows."""
    sensitivity = sensitivity_of(core)
    nodes, slopes, order = sensitivity.nodes, sensitivity.slopes, sensitivity.order
    right, parts, weights = sensitivity.right, sensitivity.parts, sensitivity.weights
    picks, q = sensitivity.picks, sensitivity.s.shape[1]
    steady = order[n + 1] > 0
    m = n - first
    for b in range(2, -1, -1):  # where r is the same at all nodes, the first of them has it
        one, two, three = h * RADAU[b, 0], h * RADAU[b, 1], h * RADAU[b, 2]
        for v in range(m):
            row, into = (b + 1) * n + order[first + v], b * m + v
            for j in range(q):
                slopes[row, j] = right[into, j]
            put_three(parts, v, one, right, v, two, m + v, three, 2 * m + v)
        for p in range(first):
            row, count = (b + 1) * n + order[p], 0
            if steady and b > 0:
                for j in range(q):
                    slopes[row, j] = slopes[n + order[p], j]
            for v in range(m):
                part = nodes[row, order[first + v]]
                if part != 0.0:
                    weights[count], picks[count] = part, v
                    count += 1
            add_rows(count, weights, picks, parts, slopes, row)


@inlined
def _fill(core: int, h: float, matrix: Matrix, n: int, first: int) -> None:
    """The matrix of the stages of the states that are left."""
    sensitivity = sensitivity_of(core)
    nodes, order = sensitivity.nodes, sensitivity.order
    steady = order[n + 1] > 0
    m = n - first
    for b in range(3):
        for v in range(m):
            row, into = (b + 1) * n + order[first + v], b * m + v
            for k in range(m):
                column = order[first + k]
                own = h * nodes[row, column]
                one = h * h * _through(nodes, order, first, row, n, column)
                if steady:
                    for c in range(3):
                        matrix[into, c * m + k] = -(RADAU[b, c] * own + SQUARE[b, c] * one)
                else:
                    two = h * h * _through(nodes, order, first, row, 2 * n, column)
                    three = h * h * _through(nodes, order, first, row, 3 * n, column)
                    for c in range(3):
                        whole = RADAU[b, c] * own + RADAU[b, 0] * RADAU[0, c] * one
                        whole += RADAU[b, 1] * RADAU[1, c] * two
                        matrix[into, c * m + k] = -(whole + RADAU[b, 2] * RADAU[2, c] * three)
            matrix[into, into] += 1.0


@helper
def _through(nodes: Matrix, order: Ints, first: int, row: int, node: int, column: int) -> float:
    """How a state acts on another through those that are eliminated, as these are at a node."""
    total = 0.0
    for p in range(first):
        total += nodes[row, order[p]] * nodes[node + order[p], column]
    return total
