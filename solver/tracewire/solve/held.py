"""Measured inputs between their samples: joined by straight lines, or held."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracewire.array_types import Vector


class Held(NamedTuple):
    """An input whose values (N,) hold from their times (N,) in s to the next.

    It stands where an input is a pair of times and values, which is joined by straight lines. Its
    steps are scheduled times.
    """

    t: Vector
    values: Vector


Driving = tuple[Vector, Vector]
"""Times and values of an input; `Held` is one, too."""


def with_points(given: Driving, t: Vector, values: Vector) -> Driving:
    """An input with other points, that acts between them as the given one does."""
    return Held(t, values) if isinstance(given, Held) else (t, values)


def values_at(given: Driving, t: Vector) -> Vector:
    """The values (M,) of an input at times t (M,) in s; outside of its own they are held."""
    times, values = given
    if not isinstance(given, Held):
        return np.interp(t, times, values)
    rows = np.searchsorted(times, t, side="right") - 1
    return np.asarray(np.asarray(values)[np.clip(rows, 0, len(times) - 1)])
