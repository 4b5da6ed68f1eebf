"""The noise of each measured signal: as declared, else estimated from its series."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tracewire.array_types import Vector
from tracewire.residual.limits import NOISE
from tracewire.residual.measured import Measured
from tracewire.residual.noise_estimate import NoiseEstimate, noise_of_signal
from tracewire.residual.readings import rounding_step


def channel_noise(measured: Sequence[Measured]) -> dict[str, float]:
    """The noise of each measured signal: as declared, else estimated from the series."""
    return {name: one.level for name, one in estimate_noise(measured).items()}


def estimate_noise(measured: Sequence[Measured]) -> dict[str, NoiseEstimate]:
    """The noise of each measured signal: as declared, else estimated; the median over series.

    At least the step of the readings over the root of 12, and a millionth of the spread, or of its
    size where the signal is constant.
    """
    found: dict[str, list[NoiseEstimate]] = {}
    for series in measured:
        for name, values in series.values.items():
            found.setdefault(name, []).append(_of_channel(series, name, values))
    return {name: _common(estimates) for name, estimates in found.items()}


def _of_channel(series: Measured, name: str, values: Vector) -> NoiseEstimate:
    declared = series.sigma.get(name)
    if declared is not None:
        step = rounding_step(values, series.t)
        return NoiseEstimate(declared, declared, declared, "declared", step)
    estimate = noise_of_signal(values, series.t)
    size = float(np.std(values) if np.ptp(values) else np.max(np.abs(values)))
    least = NOISE.least * size or 1e-300
    if estimate.level >= least:
        return estimate
    return replace(
        estimate, level=least, high=max(estimate.high, least), low=min(estimate.low, least)
    )


def _common(estimates: Sequence[NoiseEstimate]) -> NoiseEstimate:
    """The median over series, with the interval that covers theirs."""
    if len(estimates) == 1:
        return estimates[0]
    level = float(np.median([one.level for one in estimates]))
    middle = min(estimates, key=lambda one: abs(one.level - level))
    low, high = (float(np.median([getattr(e, end) for e in estimates])) for end in ("low", "high"))
    return replace(middle, level=level, low=min(low, level), high=max(high, level))
