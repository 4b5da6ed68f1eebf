"""Outliers: single samples that a sensor or a file got wrong, far off their smooth neighbours."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.residual import Measured
from tracewire.trace.data_thresholds import CheckOptions

Flags = NDArray[np.bool_]
BESIDE = np.array([-2, -1, 1, 2])
"""The samples through which a cubic is laid, by their numbers from the one between them."""


def drop_outliers(
    measured: Measured, sigma: Mapping[str, float], options: CheckOptions
) -> Measured:
    """A series without the samples at which a signal has an outlier; its `remarks` tell how many.

    An outlier is more than 8 standard deviations off both parabolas, that of the five samples
    before it and that of the five after it, which agree on what should be there; its neighbours are
    less than 3 off the cubic through theirs, once it stands on its own, or less than a hundredth of
    what the outlier is off: so it is found where few samples a period are far off any cubic, too.
    The kink of an impact, a turn under dry friction and the step of a body that is stopped are
    none.
    """
    t = measured.t
    found = {
        name: find_outliers(t, y, sigma.get(name, 0.0), options)
        for name, y in measured.values.items()
    }
    bad = np.any(list(found.values()), axis=0)
    if not bad.any() or np.mean(bad) > options.most_spikes:
        return measured
    counts = " and ".join(
        f"{flags.sum()} of {name}" for name, flags in found.items() if flags.any()
    )
    plural = "s" * (int(bad.sum()) > 1)
    remark = f"{bad.sum()} single sample{plural} left out, far off their neighbours: {counts}"
    values = {name: y[~bad] for name, y in measured.values.items()}
    return replace(measured, t=t[~bad], values=values, remarks=(*measured.remarks, remark))


def find_outliers(t: Vector, y: Vector, sigma: float, options: CheckOptions) -> Flags:
    """Which samples (N,) at times t (N,) are outliers beside noise of the standard deviation sigma;
    none at 0."""
    flags, side = np.zeros(len(y), dtype=bool), options.spike_side
    if len(y) <= 2 * side or sigma <= 0:
        return flags
    off, noise = _off_cubic(t, y)
    rows = np.flatnonzero(off > options.spike * sigma * noise)
    for k in rows[(rows >= side) & (rows < len(y) - side)].tolist():
        near = slice(k - side, k + side + 1)
        flags[k] = _is_outlier(t[near] - t[k], y[near], sigma, options)
    return flags


def _is_outlier(t: Vector, y: Vector, sigma: float, options: CheckOptions) -> bool:
    """Whether the middle one of eleven samples is off both parabolas, and alone in that."""
    steps, middle = np.diff(t), options.spike_side
    if steps.max() > options.gap * np.median(steps):
        return False
    sides = slice(0, middle), slice(middle + 1, None)
    weights = [np.linalg.pinv(np.vander(t[side], 3))[-1] for side in sides]
    before, after = (float(w @ y[side]) for w, side in zip(weights, sides, strict=True))
    noise = max(float(np.sqrt(1 + w @ w)) for w in weights)
    off = min(abs(y[middle] - before), abs(y[middle] - after))
    if off <= options.spike * noise * sigma:
        return False
    mended, beside = y.copy(), middle + BESIDE
    mended[middle] = _cubic_weights(t[beside][None])[0] @ mended[beside]
    apart = max(abs(mended[middle] - before), abs(mended[middle] - after))
    around, noises = _off_cubic(t, mended)
    limits = np.maximum(options.spike_neighbour * sigma * noises, options.spike_share * off)
    return bool(apart < options.spike_alike * off and (around < limits).all())


def _off_cubic(t: Vector, y: Vector) -> tuple[Vector, Vector]:
    """How far each sample is off the cubic through two on either side, and what that is in white
    noise of a standard deviation of 1; 0 and 1 for the two at either end."""
    off, noise = np.zeros(len(y)), np.ones(len(y))
    near = np.arange(2, len(y) - 2)[:, None] + BESIDE
    weights = _cubic_weights(t[near] - t[2:-2, None])
    off[2:-2] = np.abs(y[2:-2] - np.sum(weights * y[near], axis=1))
    noise[2:-2] = np.sqrt(1 + np.sum(weights**2, axis=1))
    return off, noise


def _cubic_weights(t: Vector) -> Vector:
    """The weights (N, 4) of four samples at times t (N, 4) in their cubic at t = 0."""
    apart = t[:, :, None] - t[:, None, :]
    numbers = np.arange(t.shape[1])
    apart[:, numbers, numbers] = 1.0
    factors = np.where(np.eye(t.shape[1], dtype=bool), 1.0, -t[:, None, :] / apart)
    return np.asarray(np.prod(factors, axis=2))
