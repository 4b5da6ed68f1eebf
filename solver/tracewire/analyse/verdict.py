"""Stable, unstable or neutral: what eigenvalues and multipliers say."""

from __future__ import annotations

from typing import Literal

import numpy as np

from tracewire.array_types import Complexes

Verdict = Literal["stable", "unstable", "neutral"]


def of_eigenvalues(eigenvalues: Complexes, tolerance: float = 1e-9) -> Verdict:
    """Stable where every real part is below zero, unstable where one is above it, else neutral.

    `tolerance` is relative to the largest eigenvalue.
    """
    if not len(eigenvalues):
        return "stable"
    return _of(
        float(eigenvalues.real.max()), tolerance * max(float(np.abs(eigenvalues).max()), 1.0)
    )


def of_multipliers(multipliers: Complexes, tolerance: float = 1e-4) -> Verdict:
    """Stable where all |multipliers| are below 1, unstable where one is above it, else neutral.

    Where two multipliers meet on the unit circle an error e of the monodromy moves them by sqrt(e):
    within `tolerance` of the circle nothing is decided.
    """
    if not len(multipliers):
        return "stable"
    return _of(float(np.abs(multipliers).max()) - 1.0, tolerance)


def _of(largest: float, tolerance: float) -> Verdict:
    if largest > tolerance:
        return "unstable"
    return "stable" if largest < -tolerance else "neutral"
