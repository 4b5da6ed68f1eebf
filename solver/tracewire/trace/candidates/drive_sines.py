"""Drive sines: the sine that a measured drive is, in each series."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from tracewire.array_types import Vector
from tracewire.residual import Measured
from tracewire.trace.thresholds import CandidateOptions


@dataclass(frozen=True)
class Sine:
    """amplitude*sin(2*pi*t/period + phase), around a mean; period in s, phase in rad at t = 0."""

    amplitude: float
    period: float
    phase: float


def fit_sine(t: Vector, u: Vector, pure: float) -> Sine | None:
    """The sine that a drive u (N,) is at times t (N,), fitted by least squares; None where it
    leaves more than the part `pure` of the variance."""
    centred = u - np.mean(u)
    total = float(centred @ centred)
    span = float(t[-1] - t[0])
    if len(t) < 8 or not total > 1e-20 * float(u @ u) or span <= 0:
        return None
    even = np.interp(np.linspace(t[0], t[-1], len(t)), t, centred)
    padded = np.abs(np.fft.rfft(even * np.hanning(len(t)), 8 * len(t)))
    step = span / (len(t) - 1)
    first = float(np.argmax(padded[4:]) + 4) / (8 * len(t) * step)

    def linear(frequency: float) -> tuple[Vector, Vector]:
        angle = 2 * np.pi * frequency * t
        matrix = np.stack([np.sin(angle), np.cos(angle), np.ones(len(t))], axis=1)
        found = np.linalg.lstsq(matrix, u, rcond=None)[0]
        return np.asarray(found), np.asarray((matrix @ found - u) / math.sqrt(total))

    def left_at(waves: Vector) -> Vector:  # waves in the record: its error is of the order of one
        return linear(float(waves[0]) / span)[1]

    best = least_squares(left_at, [first * span], xtol=1e-12, ftol=1e-14, gtol=1e-14)
    frequency = float(best.x[0]) / span
    (sine, cosine, _), left = linear(frequency)
    if not frequency > 0 or float(left @ left) > pure:
        return None
    return Sine(math.hypot(sine, cosine), 1 / frequency, math.atan2(cosine, sine))


def drive_sines_of(
    measured: Sequence[Measured], options: CandidateOptions
) -> dict[str, dict[str, Sine]]:
    """The sine of each measured input in each series, for inputs that are sines in all of them."""
    found: dict[str, dict[str, Sine]] = {}
    missing: set[str] = set()
    inputs = set[str]().union(*(series.inputs for series in measured))
    for series in measured:
        for name in inputs:
            if series.series in found.get(name, {}):  # another window of the same record
                continue
            known = series.inputs.get(name)
            sine = fit_sine(*known, options.pure_tone) if known else None
            if sine is None:
                missing.add(name)
            else:
                found.setdefault(name, {})[series.series or series.name] = sine
    return {name: sines for name, sines in found.items() if name not in missing}


def own_values(
    tone: Mapping[str, str], sines: Mapping[str, Sine] | None
) -> dict[str, dict[str, float]]:
    """The parameters of an effect that follow the drive: by series and parameter."""
    return {
        series: {parameter: float(getattr(sine, of)) for parameter, of in tone.items()}
        for series, sine in (sines or {}).items()
    }
