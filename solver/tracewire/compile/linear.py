"""Small linear systems on the tape: elimination with partial pivoting, written out in entries.

The rows are exchanged at run time, by `select` on the size of the entries. What is zero, or known,
at compile time costs nothing: a diagonal matrix is n divisions.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tracewire.compile.tape import System, Tape


def solve_linear(tape: Tape, matrix: Sequence[int], right: Sequence[int]) -> list[int]:
    """The entries of x in M x = f.

    matrix: the n*n entries of M row by row; right: the n entries of f. The derivative of x is
    dx = M^-1 (df - dM x), with the same elimination. A singular matrix gives NaN or infinity.
    """
    size = len(right)
    if size == 1:
        return [tape.push("/", right[0], matrix[0])]
    known = tape.solved.get((tuple(matrix), tuple(right)))
    if known is not None:
        return list(known)
    before = len(tape.entries)
    rows = [[*matrix[i * size : (i + 1) * size], right[i]] for i in range(size)]
    for column in range(size):
        for below in range(column + 1, size):
            _exchange(tape, rows, column, below)
        for below in range(column + 1, size):
            _eliminate(tape, rows, column, below)
    solution = [0] * size
    for row in reversed(range(size)):
        rest = rows[row][size]
        for column in range(row + 1, size):
            rest = _less(tape, rest, rows[row][column], solution[column])
        solution[row] = tape.push("/", rest, rows[row][row])
    found = tape.solved[tuple(matrix), tuple(right)] = tuple(solution)
    for position, entry in enumerate(solution):
        if entry >= before:  # an older entry has a derivative of its own
            system = System(tuple(matrix), tuple(right), found, position)
            tape.systems.setdefault(entry, system)
    return solution


def work(tape: Tape, matrix: Sequence[int], size: int) -> int:
    """About how many entries the elimination of a matrix takes: what is zero takes none, and rows
    that may change places have the union of what they hold."""
    filled = np.reshape([tape.value(entry) != 0 for entry in matrix], (size, size))
    total = 0
    for column in range(size):
        rows = column + np.flatnonzero(filled[column:, column])
        both = np.any(filled[rows], axis=0)
        total += 4 * max(0, len(rows) - 1) * int(np.sum(both[column:]))
        filled[rows] = both
    return total


def _exchange(tape: Tape, rows: list[list[int]], column: int, below: int) -> None:
    """Bring the larger entry of a column up into its row."""
    first, second = rows[column], rows[below]
    a, b = (tape.value(row[column]) for row in (first, second))
    if b == 0:
        return
    larger = tape.push("gt", _size(tape, second[column]), _size(tape, first[column]))
    if a == 0:  # also where the other turns out to be zero, or NaN
        larger = tape.constant(1.0)
    for j in range(column, len(first)):
        first[j], second[j] = (
            tape.push("select", larger, second[j], first[j]),
            tape.push("select", larger, first[j], second[j]),
        )


def _size(tape: Tape, entry: int) -> int:
    positive = tape.push("ge", entry, tape.constant(0.0))
    return tape.push("select", positive, entry, tape.push("neg", entry))


def _eliminate(tape: Tape, rows: list[list[int]], column: int, below: int) -> None:
    first, second = rows[column], rows[below]
    if tape.value(second[column]) == 0:
        return
    share = tape.push("/", second[column], first[column])
    for j in range(column + 1, len(first)):
        second[j] = _less(tape, second[j], share, first[j])


def _less(tape: Tape, a: int, b: int, c: int) -> int:
    """The entry of a - b*c."""
    return tape.push("-", a, tape.push("*", b, c))
