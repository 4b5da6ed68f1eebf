"""How the readings of a sensor stand: on steps, with samples put between, with single outliers."""

from __future__ import annotations

import numpy as np

from tracewire.array_types import Vector
from tracewire.residual.limits import NOISE, READING, WINDOW
from tracewire.residual.local_quartics import LocalQuartics, rows_around

MAD = 1.4826
"""The standard deviation of normal numbers over their median absolute value."""
INTERPOLATED = {1: 1, 2: 1, 4: 3}
"""By the order of differences that vanish between the own samples of an interpolated record (held,
straight lines, cubic pieces): how many of them see an own sample."""


def replace_outliers(values: Vector) -> Vector:
    """A signal whose single samples far from both neighbours are between these."""
    off = values[1:-1] - (values[2:] + values[:-2]) / 2
    size = np.abs(off)
    spread = MAD * float(np.median(size))
    around = np.maximum(np.append(size[1:], 0.0), np.append(0.0, size[:-1]))
    outliers = (
        (size > READING.outlier * spread)
        & (size > around)
        & (size > 2 * np.abs(values[2:] - values[:-2]))
    )
    if spread == 0 or not outliers.any():
        return values
    repaired = values.copy()
    repaired[1:-1][outliers] -= off[outliers]
    return repaired


def rounding_step(values: Vector, t: Vector | None = None) -> float:
    """The step to which readings (N,) are rounded, at times t (N,), even ones unless given; 0 where
    there is none, as where the samples were taken when a counter stepped."""
    step = _common_step(values)
    return 0.0 if step and t is not None and _is_timed_by_steps(values, t, step) else step


def _is_timed_by_steps(values: Vector, t: Vector, step: float) -> bool:
    """Whether each sample was taken where a counter stepped: its times are uneven then, and where
    it moves quartics leave far less than rounding would."""
    if np.ptp(np.diff(t)) <= NOISE.uneven * np.median(np.diff(t)):
        return False
    points = WINDOW.points[-1]
    rows = np.unique(np.linspace(0, len(t) - 1, WINDOW.places).astype(np.intp))
    near = rows_around(rows, points, len(t))
    near = near[(np.diff(values[near], axis=1) != 0).all(axis=1)]
    if len(near) < READING.moving_places:
        return False
    left = LocalQuartics(t[near] - t[near[:, :1]], values[near]).mean_squares
    return bool(np.median(left) < (READING.timed * step) ** 2 / 12)


def _common_step(values: Vector) -> float:
    """The step of which the readings' differences are multiples; 0 where there is none."""
    distinct = np.unique(values)
    steps = np.diff(distinct)
    size = float(np.ptp(values))
    steps = steps[steps > 1e-9 * size]
    often = len(values) >= READING.times_each * len(distinct)
    if len(steps) < (READING.few_steps if often else READING.fewest_steps):
        return 0.0
    if _is_even(values):
        return 0.0
    least = float(np.median(steps[steps < 1.2 * np.min(steps)]))
    for parts in range(1, READING.most_parts + 1):  # the least gap may be several steps
        multiples = steps * parts / least
        near = np.abs(multiples - np.round(multiples)) < 0.05
        if np.median(multiples) < READING.coarse and np.mean(near) > 0.95:
            return least / parts
    return 0.0


def _is_even(values: Vector) -> bool:
    """Whether readings rise, or fall, by the same from sample to sample: a steady motion does so,
    while one that is rounded also does steps of one more or less."""
    changes = np.diff(values)
    usual = float(np.median(changes))
    return bool(np.mean(np.abs(changes - usual) < READING.even * abs(usual)) > READING.mostly)


def interpolation(values: Vector) -> tuple[int, int]:
    """By which factor a record was interpolated, and the first of its own samples; 1 if not.

    Between its own samples the differences of an order 1 (held), 2 (straight lines) or 4 (cubic
    pieces) are far smaller than at them.
    """
    for order, loud in INTERPOLATED.items():
        bent = np.abs(np.diff(values, order))
        found = 1, 0
        largest = min(READING.largest_factor, len(bent) // READING.fewest_own)
        for factor in range(loud + 1, largest + 1):
            rows = len(bent) // factor
            by_phase = bent[: rows * factor].reshape(rows, factor)
            usual = np.median(by_phase, axis=0)
            between = np.argsort(usual)[:-loud]
            rest = np.max(np.mean(by_phase[:, between], axis=0))
            if rest < READING.quiet * np.sort(usual)[-loud]:
                first = int(np.argmax(np.convolve(np.tile(usual, 2), np.ones(loud), "valid")))
                found = factor, (first + (order + 1) // 2 + loud // 2) % factor
        if found[0] > 1:
            return found
    return 1, 0
