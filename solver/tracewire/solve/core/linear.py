"""Small dense linear systems: one factorisation, several solutions (numba has no such pair)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tracewire.solve.core.rows import add_row, add_two, put_three
from tracewire.solve.core.units import helper, inlined, unit

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
Ints = NDArray[np.int64]
MOST = 1000  # of the exponent of a scale
SCALINGS = 8  # each halves the digits that rows and columns are off; a far one has 300
SINGULAR = 1e-12  # of the largest pivot: a smaller one may be rounding alone


@helper
def towards_one(size: float) -> float:
    """The power of two that brings a size to about 1; no digit changes."""
    if not 0.0 < size < np.inf:
        return 1.0
    return math.ldexp(1.0, -min(max(math.frexp(size)[1], -MOST), MOST))


@helper
def dot(first: Vector, second: Vector) -> float:
    """The sum of the products, from the first to the last."""
    total = 0.0
    for i in range(len(first)):
        total += first[i] * second[i]
    return total


@unit
def factor(matrix: Matrix, pivots: Ints) -> float:
    """Replace a matrix (n, n) by its factors P A = L U; the smallest over the largest |pivot|.

    0 where the matrix is singular or not finite. Its rows may be longer: the rest of them stays.
    """
    n = len(matrix)
    if n == 3:
        found = _factor(matrix, pivots, 3)
    elif n == 4:
        found = _factor(matrix, pivots, 4)
    elif n == 6:
        found = _factor(matrix, pivots, 6)
    else:
        found = _factor(matrix, pivots, n)
    return found


@inlined
def _factor(matrix: Matrix, pivots: Ints, n: int) -> float:
    """The same, built in with its size."""
    smallest, largest = np.inf, 0.0
    for j in range(n):
        best, row = abs(matrix[j, j]), j
        for i in range(j + 1, n):
            if abs(matrix[i, j]) > best:
                best, row = abs(matrix[i, j]), i
        pivots[j] = row
        if not 0.0 < best < np.inf:
            return 0.0
        smallest, largest = min(smallest, best), max(largest, best)
        if row != j:
            for k in range(n):
                matrix[j, k], matrix[row, k] = matrix[row, k], matrix[j, k]
        inverse = 1.0 / matrix[j, j]
        for i in range(j + 1, n):
            if matrix[i, j] != 0.0:
                matrix[i, j] *= inverse
                part = matrix[i, j]
                for k in range(j + 1, n):
                    matrix[i, k] -= part * matrix[j, k]
    return smallest / largest if n else 1.0


@unit
def substitute(factors: Matrix, pivots: Ints, right: Vector) -> None:
    """Replace the right side by the solution."""
    n = len(factors)
    if n == 2:
        _substitute(factors, pivots, right, 2)
    elif n == 3:
        _substitute(factors, pivots, right, 3)
    elif n == 4:
        _substitute(factors, pivots, right, 4)
    elif n == 5:
        _substitute(factors, pivots, right, 5)
    elif n == 6:
        _substitute(factors, pivots, right, 6)
    else:
        _substitute(factors, pivots, right, n)


@inlined
def _substitute(factors: Matrix, pivots: Ints, right: Vector, n: int) -> None:
    """The same, built in with its size: short loops are faster where the compiler knows them."""
    for j in range(n):
        row = pivots[j]
        if row != j:
            right[j], right[row] = right[row], right[j]
    for i in range(n):
        total = right[i]
        for k in range(i):
            total -= factors[i, k] * right[k]
        right[i] = total
    for i in range(n - 1, -1, -1):
        total = right[i]
        for k in range(i + 1, n):
            total -= factors[i, k] * right[k]
        right[i] = total / factors[i, i]


@unit
def solved(matrix: Matrix, right: Vector) -> Vector:
    """The solution of a system; NaN where it is singular, but for rounding. The matrix is lost.

    Each row and each unknown may have a unit of its own: rows and columns are scaled together until
    the largest number of each is about 1 (Ruiz 2001), by powers of two. Rows first and columns then
    would make a small coupling of far units large, and drown one equation in the rounding of the
    other.
    """
    n = len(matrix)
    pivots, scales = np.empty(n, dtype=np.int64), np.ones(n)
    answer, sizes = right.copy(), np.empty(2 * n)
    for _ in range(SCALINGS if n > 1 else 1):
        sizes[:] = 0.0
        for i in range(n):
            for j in range(n):
                size = abs(matrix[i, j])
                sizes[i], sizes[n + j] = max(sizes[i], size), max(sizes[n + j], size)
        done = True
        for k in range(2 * n):
            done = done and 0.25 <= sizes[k] <= 4.0
            sizes[k] = towards_one(math.sqrt(sizes[k]))
        if done:
            break
        for i in range(n):
            answer[i] *= sizes[i]
            scales[i] *= sizes[n + i]
            for j in range(n):
                matrix[i, j] *= sizes[i] * sizes[n + j]
    if factor(matrix, pivots) > SINGULAR:
        substitute(matrix, pivots, answer)
        for j in range(n):
            answer[j] *= scales[j]
    else:
        answer[:] = np.nan
    return answer


@unit
def substitute_all(factors: Matrix, pivots: Ints, right: Matrix) -> None:
    """Replace right sides (n, q), one in each column, by the solutions."""
    n = len(right)
    if n == 3:
        _substitute_all(factors, pivots, right, 3)
    elif n == 4:
        _substitute_all(factors, pivots, right, 4)
    elif n == 6:
        _substitute_all(factors, pivots, right, 6)
    else:
        _substitute_all(factors, pivots, right, n)


@inlined
def _substitute_all(factors: Matrix, pivots: Ints, right: Matrix, n: int) -> None:
    """The same, built in with its size."""
    q = right.shape[1]
    for i in range(n):
        row = pivots[i]
        if row != i:
            for j in range(q):
                right[i, j], right[row, j] = right[row, j], right[i, j]
    for i in range(n):
        _take_rows(factors, i, 0, i, right)
    for i in range(n - 1, -1, -1):
        _take_rows(factors, i, i + 1, n, right)
        inverse = 1.0 / factors[i, i]
        for j in range(q):
            right[i, j] *= inverse


@inlined
def _take_rows(factors: Matrix, i: int, begin: int, end: int, right: Matrix) -> None:
    k = begin
    while k + 1 < end:
        add_two(right, i, -factors[i, k], right, k, -factors[i, k + 1], k + 1)
        k += 2
    if k < end:
        add_row(right, i, -factors[i, k], right, k)


@helper
def put_rows(
    count: int, weights: Vector, picks: Ints, rows: Matrix, out: Matrix, into: int
) -> None:
    """Let a row of `out` be a sum of multiples of some rows."""
    if count == 0:
        for j in range(out.shape[1]):
            out[into, j] = 0.0
        return
    one, first = weights[0], picks[0]
    two, second = (weights[1], picks[1]) if count > 1 else (0.0, first)
    three, third = (weights[2], picks[2]) if count > 2 else (0.0, first)
    put_three(out, into, one, rows, first, two, second, three, third)
    if count == 4:
        add_row(out, into, weights[3], rows, picks[3])
    elif count > 4:
        add_rows(count - 3, weights[3:], picks[3:], rows, out, into)


@helper
def add_rows(
    count: int, weights: Vector, picks: Ints, rows: Matrix, out: Matrix, into: int
) -> None:
    """Add multiples of some rows to a row of `out`."""
    k = 0
    while k + 1 < count:
        add_two(out, into, weights[k], rows, picks[k], weights[k + 1], picks[k + 1])
        k += 2
    if k < count:
        add_row(out, into, weights[k], rows, picks[k])
