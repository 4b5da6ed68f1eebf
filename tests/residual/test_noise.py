"""Levels and correlation of noise on made-up numbers."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from residual.made_noise import autoregression
from scipy.linalg import toeplitz
from tracewire.residual import Measured
from tracewire.residual.noise import noise_of
from tracewire.residual.noise_estimate import noise_level
from tracewire.residual.noise_of_channels import channel_noise

RANDOM = np.random.default_rng(7)


def test_the_noise_on_a_smooth_signal_is_found() -> None:
    t = np.linspace(0, 10, 2000)
    values = np.sin(3 * t) + RANDOM.normal(0, 0.01, len(t))
    assert noise_level(values) == pytest.approx(0.01, rel=0.08)


def test_a_few_outliers_do_not_change_the_noise() -> None:
    values = RANDOM.normal(0, 0.01, 2000)
    values[::200] += 5.0
    assert noise_level(values) == pytest.approx(0.01, rel=0.15)


def test_readings_on_steps_have_at_least_the_noise_of_a_step() -> None:
    t = np.linspace(0, 10, 400)
    values = np.round(np.sin(0.2 * t) / 0.05) * 0.05
    measured = Measured("run", "train", t, {"x": values}, {"x": None})
    assert channel_noise([measured])["x"] == pytest.approx(0.05 / 12**0.5, rel=0.01)


def test_a_declared_sigma_is_taken_as_it_is() -> None:
    measured = Measured("run", "train", np.arange(9.0), {"x": np.arange(9.0)}, {"x": 0.25})
    assert channel_noise([measured]) == {"x": 0.25}


def test_white_noise_is_found_white() -> None:
    rng = np.random.default_rng(1)
    orders = [noise_of(rng.standard_normal(300), 1.0).order for _ in range(200)]
    assert np.mean(np.array(orders) == 0) > 0.93


@pytest.mark.parametrize("coefficients", [(0.8,), (-0.5,), (1.6, -0.8)])
def test_an_autoregression_is_found_with_its_order_and_correlation(
    coefficients: tuple[float, ...],
) -> None:
    noise = noise_of(autoregression(coefficients, 20_000, np.random.default_rng(2)), 3.0)
    assert noise.coefficients[: len(coefficients)] == pytest.approx(coefficients, abs=0.03)
    first = coefficients[0] / (1 - sum(coefficients[1:]))  # Yule-Walker at lag 1
    assert noise.correlation(3)[:2] == pytest.approx([1.0, first], abs=0.02)


def test_correlated_noise_has_fewer_independent_samples() -> None:
    noise = noise_of(autoregression((0.8,), 20_000, np.random.default_rng(3)), 1.0)
    assert noise.degrees(1000) == pytest.approx(1000 * (1 - 0.64) / (1 + 0.64), rel=0.05)
    assert noise_of(np.ones(5), 1.0).degrees(1000) == pytest.approx(1000)


@settings(deadline=None, max_examples=50)
@given(st.integers(0, 10_000), st.integers(9, 60))
def test_the_covariance_is_toeplitz_of_the_correlation_and_no_variance_is_negative(
    seed: int, count: int
) -> None:
    rng = np.random.default_rng(seed)
    noise = noise_of(np.cumsum(rng.standard_normal(count)), 2.0)
    rho = noise.correlation(count)
    matrix = rng.standard_normal((count, 3))
    product = noise.spread(matrix)
    assert product == pytest.approx(4.0 * toeplitz(rho) @ matrix, abs=1e-9)
    assert np.linalg.eigvalsh(matrix.T @ product).min() > -1e-9
    assert 0 < noise.degrees(count) <= count * (1 + 1e-9)


def test_a_residual_of_zeros_or_of_one_tone_does_no_harm() -> None:
    assert noise_of(np.zeros(100), 0.0).order == 0
    tone = noise_of(np.sin(0.3 * np.arange(200)), 1.0)
    assert np.all(np.isfinite(tone.correlation(200)))
    assert np.abs(tone.correlation(200)).max() <= 1 + 1e-6
