"""What is done to the numbers of a record: filters, splines and trends of plain arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.data.limits import CLEANING

NORMAL = 1.4826  # a normal distribution's standard deviation over its median absolute deviation
FOURTH = 70.0  # 1 + 16 + 36 + 16 + 1: the variance of a fourth difference of white noise of 1


def jitter(t: Vector) -> tuple[float, float]:
    """The median step of times (N,), and the largest relative deviation of a step from it."""
    steps = np.diff(t)
    median = float(np.median(steps))
    return median, float(np.max(np.abs(steps - median))) / median


def interpolate(t: Vector, y: Vector, grid: Vector, method: str) -> Vector:
    """Values (N,) at other times: on straight lines, or on the cubic spline through them."""
    if method == "linear":
        return np.asarray(np.interp(grid, t, y))
    from scipy.interpolate import CubicSpline  # as below: half a second that only cleaning pays

    return np.asarray(CubicSpline(t, y)(grid))


def trend(t: Vector, y: Vector, order: int) -> Vector:
    """The polynomial of an order in t that is nearest to y in the sum of squares, (N,)."""
    return np.asarray(np.polynomial.Polynomial.fit(t, y, order)(t))


def low_pass(y: Vector, step: float, cutoff: float, order: int) -> Vector:
    """Values (N,), `step` s apart, through a Butterworth low pass forward and backward.

    There is no shift of phase; the gain is 1/2 at `cutoff` (Hz), that of both ways together.
    """
    from scipy.signal import butter, sosfiltfilt

    sections = butter(order, cutoff, fs=1.0 / step, output="sos")
    return np.asarray(sosfiltfilt(sections, y))


def low_pass_needs(order: int) -> int:
    """The least number of samples that `low_pass` takes."""
    sections = (order + 1) // 2
    return 3 * (2 * sections + 1) + 1


def smooth(u: Vector, y: Vector, lam: float) -> Vector:
    """The natural cubic spline f at its knots u (N,) that minimises a sum over samples and a bend.

    sum((y - f)^2) + lam*integral(f''^2). Source: Green and Silverman 1994, Nonparametric Regression
    and Generalized Linear Models, section 2.3 (Reinsch's algorithm), in time linear in N.
    """
    from scipy.linalg import solveh_banded

    h = np.diff(u)
    left, right = 1.0 / h[:-1], 1.0 / h[1:]
    middle = -(left + right)
    bands = np.zeros((3, len(u) - 2))  # of R + lam*Q'Q, the diagonal last
    bands[2] = (h[:-1] + h[1:]) / 3.0 + lam * (left**2 + middle**2 + right**2)
    bands[1, 1:] = h[1:-1] / 6.0 + lam * (middle[:-1] * left[1:] + right[:-1] * middle[1:])
    bands[0, 2:] = lam * right[:-2] * left[2:]
    bend = solveh_banded(bands, np.diff(np.diff(y) / h))
    back = np.zeros_like(y)
    back[:-2] += left * bend
    back[1:-1] += middle * bend
    back[2:] += right * bend
    return np.asarray(y - lam * back)


def white_noise(y: Vector) -> float:
    """The standard deviation of white noise on a slow signal, from its fourth differences."""
    return float(np.sqrt(np.mean(np.diff(y, 4) ** 2) / FOURTH))


def derivative(t: Vector, y: Vector, noise: float) -> tuple[Vector, float]:
    """The derivative (N,) of a smoothing spline through y(t), and what it left out (rms).

    The spline is the smoothest that leaves out `noise` (rms), as far as there is one: the principle
    of discrepancy (Reinsch 1967, Numer. Math. 10, 177).
    """
    from scipy.interpolate import CubicSpline
    from scipy.optimize import brentq

    step = float(np.median(np.diff(t)))
    u = (t - t[0]) / step  # steps of about one: the size of lam says the same for every rate
    scale = float(np.std(y)) or 1.0
    z = (y - y[0]) / scale

    def excess(logarithm: float) -> float:
        left = smooth(u, z, 10.0**logarithm) - z
        return float(np.sqrt(np.mean(left**2))) - noise / scale

    low, high = CLEANING.logarithms
    if excess(low) >= 0:
        best = low
    elif excess(high) <= 0:
        best = high
    else:
        best = float(brentq(excess, low, high, xtol=1e-3))
    made = smooth(u, z, 10.0**best)
    slope = CubicSpline(u, made, bc_type="natural").derivative()(u)
    return np.asarray(slope) * (scale / step), float(np.sqrt(np.mean((made - z) ** 2))) * scale


def far_from_median(y: Vector, width: int, limit: float) -> NDArray[np.bool_]:
    """Which values (N,) are outliers: |y - m| > limit*1.4826*MAD in a window of `width` samples.

    m is the median of the window and MAD the median of |y_j - m| in it; beyond the ends the record
    is mirrored. The spread 1.4826*MAD counts as no less than that of y - m over the whole record,
    nor than the step of a reading. Source: Hampel 1974, J. Am. Stat. Ass. 69, 383.
    """
    half = width // 2
    windows = np.lib.stride_tricks.sliding_window_view(np.pad(y, half, mode="reflect"), width)
    median, spread = np.empty_like(y), np.empty_like(y)
    rows = max(CLEANING.most_at_once // width, 1)
    for first in range(0, len(y), rows):
        part = windows[first : first + rows]
        middle = np.median(part, axis=1)
        median[first : first + rows] = middle
        spread[first : first + rows] = np.median(np.abs(part - middle[:, None]), axis=1)
    away = np.abs(y - median)
    levels = np.unique(y)
    reading = float(np.min(np.diff(levels))) if len(levels) > width else 0.0
    least = np.maximum(NORMAL * np.maximum(spread, np.median(away)), reading)
    return np.asarray(away > limit * least)
