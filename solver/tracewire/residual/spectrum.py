"""The spectral density of a measured signal in half octaves, of the usual stretch of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from tracewire.array_types import Vector
from tracewire.residual.limits import SPECTRUM

QUARTILE = -0.6745
"""Of normal numbers."""


@dataclass(frozen=True, eq=False)
class Spectrum:
    """The density of a signal in bands of half an octave, from half the sampling rate down.

    `high` and `low` (B,) are the ends of the bands, as parts of the sampling rate; `density` (B,)
    is in units of the variance of white noise: that has the density sigma^2 in every band.
    `error` (B,) is the relative standard error of the density, `calm` (B,) the density by the
    calmer stretches: less than `density` where much happens in the others.
    """

    high: Vector
    low: Vector
    density: Vector
    error: Vector
    calm: Vector


def spectrum_of(values: Vector) -> Spectrum:
    """The spectrum of an evenly sampled signal, shape (N,).

    An octave has stretches of its own length, so that each has as many waves. Second differences
    take most of what is slow away beforehand. Each band has the median over the stretches, so that
    a few jumps, outliers or rests do not count; stretches that stand still are left out.
    """
    length = SPECTRUM.long if len(values) >= SPECTRUM.enough else SPECTRUM.short
    bent = np.diff(values - np.mean(values), 2)
    high: list[float] = []
    density: list[float] = []
    error: list[float] = []
    calm: list[float] = []
    top = 0.5
    while len(bent) >= length + (SPECTRUM.fewest - 1) * length // SPECTRUM.overlap or not density:
        window = np.kaiser(length, SPECTRUM.shape)
        rows = sliding_window_view(bent, length)[:: max(length // SPECTRUM.overlap, 1)]
        rows = rows[np.ptp(rows, axis=1) > 0]
        if not len(rows):
            break
        power = np.abs(np.fft.rfft(rows * window)) ** 2 / np.sum(window**2)
        f = np.arange(power.shape[1]) / length
        power[:, 1:] /= (2 * np.sin(np.pi * f[1:])) ** 4
        for end in (top, top / 2**0.5):
            inside = (f > end / 2**0.5) & (f <= end) & (f < 0.5)
            freedom = 2 * max(np.sum(inside) / SPECTRUM.bins, 0.5)
            band = np.mean(power[:, inside], axis=1)
            high.append(end)
            quarter, half = np.quantile(band, (0.25, 0.5)).tolist()
            bend, width = 2 / (9 * freedom), (2 / (9 * freedom)) ** 0.5
            density.append(half / (1 - bend) ** 3)  # chi-square's quantiles: Wilson and Hilferty
            calm.append(quarter / max(1 - bend + QUARTILE * width, 0.1) ** 3)
            apart = 1 + (len(rows) - 1) / 2.0
            error.append(1.25 * (2 / (freedom * apart)) ** 0.5)
        length, top = 2 * length, top / 2
    ends = np.array(high)
    return Spectrum(ends, ends / 2**0.5, np.array(density), np.array(error), np.array(calm))
