"""Measured inputs between their samples: held, joined by straight lines, or on a cubic spline."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tracewire.array_types import Vector
from tracewire.diagram import Hold
from tracewire.residual.limits import INPUT
from tracewire.solve import Driving, Held

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline  # scipy is slow to import: who needs a part does it

NODES, WEIGHTS = np.polynomial.legendre.leggauss(3)


def between_samples(name: str, t: Vector, u: Vector, hold: Hold | None) -> tuple[Driving, str]:
    """An input with samples u (N,) at times t (N,) as a run takes it, and how in words.

    As `hold` says: each value acts until the next (`previous`), straight lines join the samples
    (`linear`), or a cubic spline does (`smooth`). With None it is the spline where
    `spline_if_smooth` finds the input smooth, else straight lines.
    """
    said = "" if hold is None else ", as declared"
    if hold == "previous":
        return Held(t, u), f"input '{name}' is held from sample to sample{said}"
    points = spline_if_smooth(t, u) if hold is None else None
    if hold == "smooth":
        points = fit_spline(t, u)
    if points is None:
        return (t, u), f"input '{name}' is joined by straight lines{said}"
    return points, f"input '{name}' is smooth{said}: a cubic spline, in {len(points[0])} points"


def looks_held(u: Vector) -> bool:
    """Whether an input is constant for most of the time and jumps between, as one that is held."""
    changes = np.abs(np.diff(u))
    jumps = changes[changes > 0]
    if not len(jumps) or np.mean(changes == 0) < INPUT.repeated:
        return False
    moves = changes > 0
    if np.sum(moves[:-1] & moves[1:]) > INPUT.moving * np.sum(moves):  # it goes, and rests between
        return False
    return bool(np.median(jumps) > INPUT.jump * np.ptp(u))


def line_error(t: Vector, u: Vector) -> float:
    """The part of the amplitude of an input that straight lines between its samples lose.

    A sine of angular frequency omega, sampled each dt, loses (omega*dt)^2/12; that is averaged over
    the power of the input. 0 where the samples are few or not evenly spaced.
    """
    if len(t) < INPUT.fewest_samples:
        return 0.0
    if np.ptp(np.diff(t)) > INPUT.uneven * (t[-1] - t[0]) / (len(t) - 1):
        return 0.0
    power = np.abs(np.fft.rfft((u - np.mean(u)) * np.hanning(len(u)))) ** 2
    angle = 2 * np.pi * np.fft.rfftfreq(len(u))
    return float(np.sum(power * angle**2 / 12) / max(float(np.sum(power)), 1e-300))


def spline_if_smooth(t: Vector, u: Vector) -> tuple[Vector, Vector] | None:
    """The points of a smooth input with samples u (N,) at times t (N,); None for others.

    A run joins points by straight lines. Joined so, samples of a sine lose (omega*dt)^2/12 of its
    amplitude, which is more than the noise of a good record. Whether an input is smooth is asked of
    the record itself: every second sample is predicted from the others, by a cubic spline and by
    straight lines. Where the largest error of the spline is below 0.3 of that of the lines, the
    input is the spline through all samples. A step, a corner or noise is predicted no better by a
    spline, and stays as it is.

    The points are those whose straight lines come closest to the spline in the mean square (the L2
    projection on linear splines). What is left changes its sign twice from point to point, so that
    a mechanism integrates it away; it is at most about a thousandth of the input's range, for which
    there are up to 8 points for each sample, or 1000 in all: a run takes as much longer as there
    are more.
    """
    if len(t) < INPUT.fewest_samples or not np.all(np.diff(t) > 0):
        return None
    lines, spline = _errors(t, u)
    if not lines > INPUT.visible * float(np.ptp(u)) or not spline < INPUT.better * lines:
        return None
    return fit_spline(t, u)


def fit_spline(t: Vector, u: Vector) -> tuple[Vector, Vector]:
    """The points whose straight lines come closest to the cubic spline through an input."""
    from scipy.interpolate import CubicSpline

    spline, size = CubicSpline(t, u), float(np.ptp(u)) or 1.0
    finest = max(INPUT.finest, INPUT.few_points // len(t))
    lines, _ = _errors(t, u)
    # lines err by the square of the interval: a quarter of `lines` on all samples
    factor = int(np.clip(np.ceil(np.sqrt(lines / (4 * INPUT.fine * size))), 1, finest))
    while True:
        count = (len(t) - 1) * factor + 1
        times = np.interp(np.arange(count) / factor, np.arange(len(t)), t)
        points = project_on_lines(spline, times)
        # few samples say too little of the curve between them: what is left at them shows it
        if 2 * factor > finest or np.max(np.abs(points[::factor] - u)) <= INPUT.fine * size:
            return times, points
        factor *= 2


def _errors(t: Vector, u: Vector) -> tuple[float, float]:
    """By how much straight lines, and a spline, miss every second sample, from the others."""
    kept, left = slice(0, None, 2), slice(1, len(t) - 1, 2)
    if len(t) < 4:
        return 0.0, 0.0
    lines = np.interp(t[left], t[kept], u[kept]) - u[left]
    from scipy.interpolate import CubicSpline

    spline = CubicSpline(t[kept], u[kept])(t[left]) - u[left]
    return float(np.max(np.abs(lines))), float(np.max(np.abs(spline)))


def project_on_lines(spline: CubicSpline, times: Vector) -> Vector:
    """The values at `times` (N,) whose straight lines are closest to a cubic spline, which is a
    cubic between any two of them."""
    from scipy.linalg import solveh_banded

    h = np.diff(times)
    share = (1 + NODES) / 2
    values = spline(times[:-1, None] + h[:, None] * share) * (h[:, None] * WEIGHTS / 2)
    moments = np.zeros(len(times))
    moments[:-1] += values @ (1 - share)
    moments[1:] += values @ share
    banded = np.zeros((2, len(times)))
    banded[0, 1:] = h / 6
    banded[1, :-1] += h / 3
    banded[1, 1:] += h / 3
    return np.asarray(solveh_banded(banded, moments))
