"""The errors of values whose residuals are slow, or differ between parts of a record."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter
from tracewire.trace.results.intervals import errors_over_blocks

Array = NDArray[np.float64]
T = np.linspace(0, 1, 600)
SLOPES = np.stack([np.sin(50 * T), 3e4 * np.cos(70 * T)], axis=1)
"""Of a large and a small value."""


def white(random: np.random.Generator) -> Array:
    return random.standard_normal(len(T))


def slow(random: np.random.Generator) -> Array:
    """It forgets within about ten samples."""
    return np.asarray(lfilter([1.0], [1.0, -0.9], random.standard_normal(len(T) + 99))[99:])


def loud_at_times(random: np.random.Generator) -> Array:
    return white(random) * np.where(np.sin(50 * T) ** 2 > 0.7, 3.0, 0.3)


@pytest.mark.parametrize("windows", [1, 3, 60])
@pytest.mark.parametrize("draw", [white, slow, loud_at_times])
def test_errors_are_as_large_as_estimates_spread(
    draw: Callable[[np.random.Generator], Array], windows: int
) -> None:
    estimates, errors = [], []
    for seed in range(300):
        residual = draw(np.random.default_rng(seed))
        estimates.append(np.linalg.lstsq(SLOPES, residual, rcond=None)[0])
        left = residual - SLOPES @ estimates[-1]
        slopes = np.array_split(SLOPES, windows)
        errors.append(errors_over_blocks(slopes, np.array_split(left, windows), 12))
    mean = np.sqrt(np.mean(np.square(errors), axis=0))
    np.testing.assert_allclose(mean, np.std(estimates, axis=0), rtol=0.25)


def test_a_value_that_no_residual_reads_has_no_error() -> None:
    slopes = np.stack([np.sin(50 * T), np.zeros(len(T))], axis=1)
    errors = errors_over_blocks([slopes], [white(np.random.default_rng(1))], 12)
    assert errors[0] < 0.2
    assert errors[1] == np.inf
