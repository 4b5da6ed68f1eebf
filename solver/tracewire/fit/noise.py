"""The noise of measured signals: its level, and how it is correlated in time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import comb

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import matmul_toeplitz, solve_banded

from tracewire.fit.measured import Measured

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
ORDER = 6
QUARTIC = 4
STRETCHES, SHORTEST, FEWEST = 15, 12, 3
"""How many stretches a period has, how many samples a stretch at least, how many a series."""


def noise_level(values: Vector) -> float:
    """The standard deviation of the noise on a smooth signal, shape (N,).

    1.4826 times the median absolute sixth difference over the norm of the binomial weights, which
    is that of white noise; or what quartics leave in stretches of a fifteenth of the period, the
    median over these, where that is more: of noise that a filter or an interpolation has smoothed.
    """
    weights = np.array([comb(ORDER, k) for k in range(ORDER + 1)], dtype=float)
    if len(values) <= ORDER + 1:
        return 0.0
    fine = 1.4826 * np.median(np.abs(np.diff(values, ORDER))) / np.linalg.norm(weights)
    return max(float(fine), _beside_quartics(values))


def _beside_quartics(values: Vector) -> float:
    """The median over stretches of what a quartic leaves, per degree of freedom."""
    crossings = int(np.sum(np.diff(np.signbit(values - np.mean(values)))))
    length = max(int(2 * len(values) / max(crossings, 2) / STRETCHES), SHORTEST)
    count = len(values) // length
    if count < FEWEST:
        return 0.0
    powers = np.vander(np.linspace(-1, 1, length), QUARTIC + 1)
    basis, _ = np.linalg.qr(powers)
    rows = values[: count * length].reshape(count, length).T
    left = rows - basis @ (basis.T @ rows)
    return float(np.sqrt(np.median(np.sum(left**2, axis=0)) / (length - QUARTIC - 1)))


def channel_noise(measured: Sequence[Measured]) -> dict[str, float]:
    """The noise of each measured signal: as declared, else estimated from the series.

    At least the step of the sensor over the root of 12, where the readings stand on steps, and a
    millionth of the signal's spread.
    """
    found: dict[str, list[float]] = {}
    for series in measured:
        for name, values in series.values.items():
            declared = series.sigma.get(name)
            if declared is None:
                steps = np.diff(np.unique(values))
                quantum = float(np.median(steps)) / 12**0.5 if len(steps) < len(values) / 4 else 0.0
                declared = max(noise_level(values), quantum, 1e-6 * float(np.std(values)), 1e-300)
            found.setdefault(name, []).append(declared)
    return {name: float(np.median(levels)) for name, levels in found.items()}


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
        return np.asarray(solve_banded((self.order, 0), bands, begun))

    def spread(self, matrix: Vector) -> Vector:
        """The covariance of the noise times a matrix (N, n)."""
        if self.order == 0:
            return np.asarray(self.level**2 * matrix)
        rho = self.correlation(len(matrix))
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
