"""The numbers by which effects are judged: effective sample size, BIC, scores."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


def effective_part(residuals: Sequence[Vector]) -> float:
    """N_eff/N = 2 arccos(rho)/pi, rho the lag-1 correlation of residuals inside segments.

    For white residuals it is 1. For a smooth, oscillating residual it is twice its number of sign
    changes per sample (Rice), which does not depend on how finely the residual is sampled.
    """
    products = sum(float(np.sum(r[1:] * r[:-1])) for r in residuals)
    squares = sum(float(np.sum(r * r)) for r in residuals)
    rho = min(max(products / squares, 0.0), 1.0) if squares > 0 else 0.0
    return max(2 * float(np.arccos(rho)) / np.pi, 1e-4)


def bic(rss: float, count: int, part: float, unknowns: int) -> float:
    """N_eff ln(RSS/N) + k ln(N): smaller is better."""
    return count * part * float(np.log(max(rss, 1e-300) / count)) + unknowns * float(np.log(count))


@dataclass(frozen=True, eq=False)
class Score:
    """What one or more added coefficients promise without a refit.

    `gain` is the fall of BIC/2, `values` the expected coefficients, `masked` the share of each
    column that the unknowns already there can imitate.
    """

    gain: float
    values: tuple[float, ...]
    masked: tuple[float, ...]


class Screen:
    """The score test: columns of candidates beside the unknowns that are already there.

    residual (N,), jacobian (N, unknowns), columns (N, candidates): d residual / d coefficient.
    """

    def __init__(
        self, residual: Vector, jacobian: Vector, columns: Mapping[str, Vector], part: float
    ) -> None:
        basis = _basis(jacobian)
        self.residual = residual - basis @ (basis.T @ residual)
        self.columns = {name: z - basis @ (basis.T @ z) for name, z in columns.items()}
        self.sizes = {name: float(z @ z) for name, z in columns.items()}
        self.rss = float(self.residual @ self.residual)
        self.count, self.part = len(residual), part

    def score(self, names: Sequence[str]) -> Score:
        """The score of coefficients taken together."""
        matrix = np.stack([self.columns[name] for name in names], axis=1)
        kept = [
            float(z @ z) / max(self.sizes[name], 1e-300)
            for name, z in zip(names, matrix.T, strict=True)
        ]
        if min(kept) < 1e-9:  # the unknowns that are there imitate it completely
            return Score(-np.inf, (0.0,) * len(names), tuple(1 - k for k in kept))
        values, *_ = np.linalg.lstsq(matrix, -self.residual, rcond=1e-10)
        left = self.residual + matrix @ values
        rss = max(float(left @ left), 1e-300)
        gain = 0.5 * self.count * self.part * float(np.log(self.rss / rss))
        gain -= 0.5 * len(names) * float(np.log(self.count))
        return Score(gain, tuple(map(float, values)), tuple(1 - k for k in kept))

    def likeness(self, one: str, other: str) -> float:
        """The correlation of two projected columns: 1 where the data cannot tell them apart."""
        a, b = self.columns[one], self.columns[other]
        return abs(float(a @ b)) / max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-300)


def _basis(matrix: Vector) -> Vector:
    """An orthonormal basis of the columns of a matrix, without its negligible directions."""
    if matrix.shape[1] == 0:
        return np.zeros((matrix.shape[0], 0))
    scaled = matrix / np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
    left, singular, _ = np.linalg.svd(scaled, full_matrices=False)
    return np.asarray(left[:, singular > 1e-10 * singular[0]])
