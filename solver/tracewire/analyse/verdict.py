"""Stable, unstable or neutral: what eigenvalues and multipliers say."""

from __future__ import annotations

from typing import Literal

import numpy as np

from tracewire.analyse.limits import STABILITY
from tracewire.array_types import Complexes

Verdict = Literal["stable", "unstable", "neutral"]


def of_eigenvalues(eigenvalues: Complexes) -> Verdict:
    """Stable where every real part is below zero, unstable where one is above it, else neutral."""
    if not len(eigenvalues):
        return "stable"
    largest = max(float(np.abs(eigenvalues).max()), 1.0)
    return _of(float(eigenvalues.real.max()), STABILITY.on_axis * largest)


def of_multipliers(multipliers: Complexes) -> Verdict:
    """Stable where all |multipliers| are below 1, unstable where one is above it, else neutral."""
    if not len(multipliers):
        return "stable"
    return _of(float(np.abs(multipliers).max()) - 1.0, STABILITY.on_circle)


def _of(largest: float, tolerance: float) -> Verdict:
    if largest > tolerance:
        return "unstable"
    return "stable" if largest < -tolerance else "neutral"
