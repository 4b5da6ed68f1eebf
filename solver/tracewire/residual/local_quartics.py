"""Local quartics: what a sampled signal and its rate are at a time, from the samples around it."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Matrix, Vector
from tracewire.residual.limits import WINDOW

Rows = NDArray[np.intp]


class LocalQuartics:
    """The quartics that fit signals (N, points) at times t (N, points) best, seen from t = 0."""

    def __init__(self, t: Matrix, signals: Matrix) -> None:
        self.signals = signals
        self.middle, self.half = (t[:, -1] + t[:, 0]) / 2, (t[:, -1] - t[:, 0]) / 2
        self.half[self.half == 0] = 1.0
        self.powers = np.arange(min(WINDOW.degree, t.shape[1] - 1) + 1)
        z = ((t - self.middle[:, None]) / self.half[:, None])[:, :, None] ** self.powers
        self.basis, corner = np.linalg.qr(z)
        self.shares = np.einsum("nij,ni->nj", self.basis, signals)
        self.coefficients = np.linalg.solve(corner, self.shares[:, :, None])[:, :, 0]

    @property
    def values(self) -> Vector:
        """The values (N,) at t = 0."""
        return np.asarray(np.sum(self.coefficients * self._zero**self.powers, axis=1))

    @property
    def slopes(self) -> Vector:
        """The slopes (N,) at t = 0."""
        powers = self.powers
        slopes = self.coefficients[:, 1:] * powers[1:] * self._zero ** powers[:-1]
        return np.asarray(np.sum(slopes, axis=1) / self.half)

    @property
    def mean_squares(self) -> Vector:
        """The mean squares (N,) of what they leave, over the degrees of freedom."""
        left = self.signals - np.einsum("nij,nj->ni", self.basis, self.shares)
        free = max(left.shape[1] - len(self.powers), 1)
        return np.asarray(np.sum(left**2, axis=1) / free)

    @cached_property
    def _zero(self) -> Matrix:
        return (-self.middle / self.half)[:, None]


def rows_around(rows: Rows, points: int, count: int) -> Rows:
    """The so many samples around each of some rows (N,) of a record, shape (N, points)."""
    first = np.clip(rows - points // 2, 0, max(count - points, 0))
    return np.asarray(first[:, None] + np.arange(min(points, count)))


def quartic_points(t: Vector, signal: Vector) -> int:
    """Through how many samples a quartic follows a signal: the most that leave at half of the
    places no more than twice what the fewest leave, root mean square."""
    fewest = WINDOW.points[-1]
    rows = np.unique(np.linspace(0, len(t) - 1, WINDOW.places).astype(np.intp))
    left: dict[int, float] = {}
    for points in WINDOW.points:
        near = rows_around(rows, points, len(t))
        quartics = LocalQuartics(t[near] - t[rows, None], signal[near])
        left[points] = float(np.median(quartics.mean_squares))
    follows = (n for n in WINDOW.points if left[n] <= WINDOW.bends**2 * left[fewest])
    return next(follows, fewest)
