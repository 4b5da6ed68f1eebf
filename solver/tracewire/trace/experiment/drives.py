"""How far a drive goes in the records, and which drives go together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tracewire.array_types import Vector
from tracewire.trace.thresholds import ExperimentOptions


@dataclass(frozen=True)
class Drive:
    """A drive in SI: around which value a sine may swing, how far at most, and the value that it
    has where it is left alone."""

    centre: float
    largest: float
    off: float


def drive_of(parts: Sequence[Vector], options: ExperimentOptions) -> Drive:
    """A drive as the records have it, from its values in each of them.

    A sine around the mean stays between the least and the largest value; where these are about as
    far on both sides of zero, it is a sine around zero. A drive that is never zero has its mean
    where it is left alone, as nobody can switch off the length of a rope.
    """
    values = np.concatenate(parts)
    low, high, mean = (float(f(values)) for f in (np.min, np.max, np.mean))
    off = 0.0 if low <= 0.0 <= high else mean
    both = low < 0.0 < high and min(-low, high) >= options.both_sides * max(-low, high)
    centre = 0.0 if both else mean
    return Drive(centre, min(high - centre, centre - low), off)


def rates_of(t: Vector, drives: Mapping[str, Vector], explained: float) -> dict[str, str]:
    """The drives that are the rate of another one, by the name of that: they move together.

    The integral of the rate explains so much of the variance of the other drive.
    """
    found = {}
    for name, u in drives.items():
        spread = float(np.var(u))
        for rate, v in drives.items():
            if rate == name or not spread > 0:
                continue
            way = np.concatenate(([0.0], np.cumsum(np.diff(t) * (v[1:] + v[:-1]) / 2)))
            if float(np.var(u - way)) <= (1 - explained) * spread:
                found[name] = rate
    return found
