"""Outliers: single samples that a sensor or a file got wrong, far off their smooth neighbours."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tracewire.residual import Measured
from tracewire.trace.thresholds import CheckOptions

Vector = NDArray[np.float64]
Flags = NDArray[np.bool_]
CUBIC = np.array([-1.0, 4.0, 0.0, 4.0, -1.0]) / 6
"""A sample from the two before and the two after it, by the cubic through them."""
SIDE = 5
ONWARD = np.linalg.pinv(np.vander(np.arange(-SIDE, 0.0), 3))[-1]
"""A sample from the five before it, by the parabola that fits them best."""
SPREAD, ONWARD_SPREAD = (float(np.sqrt(1 + np.sum(w**2))) for w in (CUBIC, ONWARD))


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
    """Which samples (N,) are outliers beside noise of the standard deviation sigma; none at 0."""
    flags = np.zeros(len(y), dtype=bool)
    if len(y) <= 2 * SIDE or sigma <= 0:
        return flags
    rows = np.flatnonzero(_off(y) > options.spike * SPREAD * sigma)
    for k in rows[(rows >= SIDE) & (rows < len(y) - SIDE)].tolist():
        before, after = y[k - SIDE : k] @ ONWARD, y[k + 1 : k + 1 + SIDE] @ ONWARD[::-1]
        off = min(abs(y[k] - before), abs(y[k] - after))
        mended, steps = y[k - SIDE : k + SIDE + 1].copy(), np.diff(t[k - SIDE : k + SIDE + 1])
        mended[SIDE] = mended[SIDE - 2 : SIDE + 3] @ CUBIC
        alike = (
            max(abs(mended[SIDE] - before), abs(mended[SIDE] - after)) < options.spike_alike * off
        )
        limit = max(options.spike_neighbour * SPREAD * sigma, options.spike_share * off)
        smooth = bool((_off(mended) < limit).all())
        even = np.ptp(steps) < options.even * np.median(steps)
        flags[k] = even and smooth and alike and off > options.spike * ONWARD_SPREAD * sigma
    return flags


def _off(y: Vector) -> Vector:
    """How far each sample is off the cubic through its neighbours; 0 for the two at either end."""
    off = np.zeros(len(y))
    off[2:-2] = np.abs(y[2:-2] - np.convolve(y, CUBIC, mode="valid"))
    return off
