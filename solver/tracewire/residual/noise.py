"""The noise of measured signals: its level, and how it is correlated in time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracewire.array_types import Matrix, Vector


@dataclass(frozen=True, eq=False)
class Noise:
    """Noise e_k = sum_i coefficients_i e_(k-i) + white, of standard deviation `level`.

    `covariance` holds those of lags 0 to `order`, in units of level^2. Samples count by their
    index: where they are not evenly spaced, so is the correlation.
    """

    level: float
    coefficients: Vector
    covariance: Vector

    @property
    def order(self) -> int:
        """The order of the autoregression: 0 for white noise."""
        return len(self.coefficients)

    def correlation(self, count: int) -> Vector:
        """The autocorrelation (count,) of lags 0 to count - 1."""
        known = self.covariance
        if self.order == 0:
            return np.asarray(np.concatenate([[1.0], np.zeros(count - 1)]))
        if count <= len(known):
            return known[:count]
        bands = np.zeros((self.order + 1, count))  # rho_k - sum_i coefficients_i rho_(k-i)
        bands[0] = 1.0
        begun = np.zeros(count)
        begun[: len(known)] = known
        for lag, coefficient in enumerate(self.coefficients, 1):
            bands[lag, len(known) - lag : count - lag] = -coefficient
        from scipy.linalg import solve_banded

        return np.asarray(solve_banded((self.order, 0), bands, begun))

    def spread(self, matrix: Vector) -> Vector:
        """The covariance of the noise times a matrix (N, n)."""
        if self.order == 0:
            return np.asarray(self.level**2 * matrix)
        rho = self.correlation(len(matrix))
        from scipy.linalg import matmul_toeplitz

        return np.asarray(self.level**2 * matmul_toeplitz((rho, rho), matrix, check_finite=False))

    def degrees(self, count: int) -> float:
        """How many independent samples tell the level as well as `count` of these do.

        N/sum rho_k^2 over all lags (Bayley and Hammersley, 1946): N where the noise is white.
        """
        rho = self.correlation(count)
        lags = 1 - np.arange(count) / count
        return float(count / (2 * np.sum(lags * rho**2) - 1))


def noise_of(residual: Vector, level: float, correlated: bool = True) -> Noise:
    """The noise behind a residual (N,): white, or an autoregression as long as BIC asks for.

    Burg's estimate (1967) for each order, which is always stable; the order with the least
    N ln(variance) + order ln N of the one-step error, up to 10 log10(N). White noise is found white
    in more than nine of ten cases. `level` is its standard deviation.
    """
    count = len(residual)
    energy = float(residual @ residual) / max(count, 1)
    best = Noise(level, np.zeros(0), np.ones(1))
    if not correlated or count < 8 or energy <= 0:
        return best
    ahead, behind = residual[1:], residual[:-1]
    variance, coefficients, covariance = energy, np.zeros(0), np.ones(1)
    least = count * np.log(variance)
    for order in range(1, min(int(10 * np.log10(count)), count // 4) + 1):
        squares = float(ahead @ ahead + behind @ behind)
        if squares <= 1e-24 * energy:
            break
        reflection = 2 * float(ahead @ behind) / squares
        longer = np.append(coefficients - reflection * coefficients[::-1], reflection)
        variance *= 1 - reflection**2
        covariance = np.append(covariance, longer @ covariance[::-1])
        coefficients = longer
        if variance <= 1e-12 * energy:
            break
        measure = count * np.log(variance) + order * np.log(count)
        if measure < least:
            least, best = measure, Noise(level, coefficients, covariance)
        ahead, behind = (ahead - reflection * behind)[1:], (behind - reflection * ahead)[:-1]
    return best


def noises_beside(
    residuals: Sequence[Matrix], correlated: bool, basis: Matrix
) -> list[list[Noise]]:
    """The noise behind each signal, of which a fit has taken the part in `basis` (M, n).

    The mean sum of squares that is left is level^2 (N - tr basis' R basis), R the autocorrelation:
    N - n where the noise is white, and much less where it is as smooth as the derivatives.
    """
    found, at = [], 0
    for r in residuals:
        rows = basis[at : at + r.size].reshape(*r.shape, -1)
        at += r.size
        channels = []
        for n, x in enumerate(r.T):
            unit = noise_of(x, 1.0, correlated)
            taken = float(np.sum(rows[:, n] * unit.spread(rows[:, n])))
            left = max(len(x) - taken, 1.0)
            channels.append(replace(unit, level=float(np.sqrt(x @ x / left))))
        found.append(channels)
    return found


def noise_in(basis: Matrix, weights: Sequence[Matrix], noises: Sequence[Sequence[Noise]]) -> Matrix:
    """basis' w S w basis (n, n), S the covariance of the noise, a signal at a time.

    basis (M, n): rows by segment, sample and signal; weights (N, signals) of each segment.
    """
    total = np.zeros((basis.shape[1], basis.shape[1]))
    at = 0
    for w, channels in zip(weights, noises, strict=True):
        rows = basis[at : at + w.size].reshape(*w.shape, -1)
        at += w.size
        for n, noise in enumerate(channels):
            part = w[:, n, None] * rows[:, n]
            total += part.T @ noise.spread(part)
    return total


def degrees_of(
    residuals: Sequence[Matrix], noises: Sequence[Sequence[Noise]], unknowns: int
) -> int:
    """Of the independent samples the part that the unknowns leave, at least 1."""
    samples = sum(r.size for r in residuals)
    independent = sum(
        noise.degrees(len(r)) for r, row in zip(residuals, noises, strict=True) for noise in row
    )
    return max(round(independent * (1 - unknowns / samples)), 1)
