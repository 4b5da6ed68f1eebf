"""How far a model follows a measured series."""

from __future__ import annotations

import numpy as np

from tracewire.array_types import Vector
from tracewire.fit.limits import TRACKING
from tracewire.residual import Segment, noise_level


def count_tracked(off: Vector, spread: Vector) -> int:
    """The number of first samples that are followed, of those that are `off` (N, signals), in
    SI."""
    lost = np.any(np.abs(off) > TRACKING.tracked * spread, axis=1)
    return int(np.argmax(lost)) if lost.any() else len(lost)


def spread_of(segment: Segment, parts: int = 1) -> Vector:
    """The standard deviation of each signal of a segment, shape (signals,) in SI.

    With `parts`, the median of those of so many parts: what a signal usually swings, without its
    drift. It is not less than what the noise of the series makes of it.
    """
    noise = np.array([noise_level(values) for values in segment.measured.values.values()])
    samples = segment.samples()
    pieces = np.array_split(samples, min(parts, max(len(samples) // 10, 1)))
    spread = np.median([np.std(piece, axis=0) for piece in pieces], axis=0)
    return np.asarray(np.maximum(np.maximum(spread, TRACKING.noise * noise), 1e-300))
