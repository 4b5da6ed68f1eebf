"""Drives as functions of the time: sums of sines, and values between the points of a table."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.rigs.record import Array

Wave = Callable[[float], float]
"""A value by the time [s]."""
Times = NDArray[np.floating[Any]]


def tabulated(values: Times, step: float) -> Wave:
    """Straight lines between values that are `step` seconds apart, from t = 0 on."""
    last = len(values) - 2

    def wave(t: float) -> float:
        at = t / step
        i = min(last, int(at))
        return float(values[i] + (values[i + 1] - values[i]) * (at - i))

    return wave


def sines(random: np.random.Generator, tones: Times, deviation: float, times: Times) -> Array:
    """A sum of sines of these frequencies in Hz, with a standard deviation, at the times."""
    phases = random.uniform(0, 2 * math.pi, len(tones))
    size = deviation * math.sqrt(2 / len(tones))
    total = np.zeros(len(times))
    for tone, phase in zip(tones, phases, strict=True):
        total += size * np.sin(2 * math.pi * tone * times + phase)
    return total
