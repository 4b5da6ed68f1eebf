"""Rows of matrices, added up.

The library has instructions of its own in the place of these functions, which take two numbers at
once: what LLVM makes of a loop over a few numbers either takes one, or looks first at whether the
rows overlap. A row of `out` may stand among those that are added.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]


def add_row(out: Matrix, into: int, a: float, x: Matrix, i: int) -> None:
    """Add a multiple of a row to a row."""
    out[into] += a * x[i]


def add_two(out: Matrix, into: int, a: float, x: Matrix, i: int, b: float, j: int) -> None:
    """Add multiples of two rows of a matrix to a row."""
    out[into] += a * x[i] + b * x[j]


def put_three(
    out: Matrix, into: int, a: float, x: Matrix, i: int, b: float, j: int, c: float, k: int
) -> None:
    """Let a row be a sum of multiples of three rows of a matrix."""
    out[into] = a * x[i] + b * x[j] + c * x[k]
