"""Noise that is correlated in a known way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter


def autoregression(
    coefficients: tuple[float, ...], count: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Noise e_k = sum of coefficients e_(k-i) + white, begun long before."""
    white = rng.standard_normal(count + 500)
    return np.asarray(lfilter([1.0], [1.0, *(-c for c in coefficients)], white)[500:])
