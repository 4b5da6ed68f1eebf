"""How large noise is found on made signals, how sure, and in any units."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from residual.made_noise import autoregression
from scipy.interpolate import CubicSpline
from scipy.signal import butter, filtfilt, lfilter, resample
from tracewire.residual import Measured
from tracewire.residual.noise_estimate import noise_of_signal
from tracewire.residual.noise_of_channels import channel_noise, estimate_noise
from tracewire.residual.readings import interpolation, rounding_step

Vector = NDArray[np.float64]
N = np.arange(4000)
RANDOM = np.random.default_rng(11)
FIRST = RANDOM.bit_generator.state


@pytest.fixture(autouse=True)
def _same_numbers() -> None:
    """Each test draws the same numbers, whichever tests ran before it in its process."""
    RANDOM.bit_generator.state = FIRST


def sine(period: float, n: Vector = N) -> Vector:
    return np.asarray(np.sin(2 * np.pi * n / period))


def white(level: float, count: int = len(N)) -> Vector:
    return np.asarray(level * RANDOM.standard_normal(count))


def multisine() -> Vector:
    """Of rms 1, with content up to an eighth of the sampling rate."""
    lines = np.arange(1, len(N) // 8, 4)
    phases = RANDOM.uniform(0, 2 * np.pi, len(lines))
    made = np.sum(np.sin(2 * np.pi * lines[:, None] / len(N) * N + phases[:, None]), axis=0)
    return np.asarray(made / np.std(made))


def steps(b: list[float], a: list[float]) -> Vector:
    return np.asarray(lfilter(b, a, np.repeat(RANDOM.standard_normal(40), 100)))


def decay() -> Vector:
    return np.asarray(np.exp(-N / 800) * sine(60))


def coloured(coefficient: float, level: float) -> Vector:
    made = autoregression((coefficient,), len(N), RANDOM)
    return np.asarray(level * made * (1 - coefficient**2) ** 0.5)


def filtered(edge: float, level: float) -> Vector:
    """White noise through a filter with its edge at this part of the sampling rate."""
    made = filtfilt(*butter(4, 2 * edge), white(1.0))
    return np.asarray(level * made / np.std(made))


def sampled(period: float = 100.0) -> Vector:
    return sine(period, np.arange(400)) + white(1e-3, 400)


def between(y: Vector, straight: bool) -> Vector:
    """A record interpolated tenfold."""
    knots, fine = np.arange(len(y)), np.arange(10 * len(y) - 9) / 10
    return np.asarray(np.interp(fine, knots, y) if straight else CubicSpline(knots, y)(fine))


KNOWN: dict[str, tuple[Callable[[], Vector], float]] = {
    "sine": (lambda: sine(200) + white(1e-3), 1e-3),
    "sine, little noise": (lambda: sine(200) + white(1e-5), 1e-5),
    "decay": (lambda: decay() + white(1e-3), 1e-3),
    "multisine, much noise": (lambda: multisine() + white(0.1), 0.1),
    "multisine": (lambda: multisine() + white(1e-3), 1e-3),
    "multisine, little noise": (lambda: multisine() + white(1e-5), 1e-5),
    "fast steps": (lambda: steps([0.3], [1, -0.7]) + white(1e-3), 1e-3),
    "ringing steps": (lambda: steps([0.05], [1, -1.8, 0.85]) + white(1e-3), 1e-3),
    "correlated": (lambda: sine(500) + coloured(0.5, 0.01), 0.01),
    "filtered": (lambda: sine(300) + filtered(0.1, 1e-3), 1e-3),
    "filtered little": (lambda: sine(60) + filtered(0.2, 1e-3), 1e-3),
    "lines between": (lambda: between(sampled(), True), 1e-3),
    "cubics between": (lambda: between(sampled(), False), 1e-3),
    "waves between": (lambda: np.asarray(resample(sampled(), 4000)), 1e-3),
    "held between": (lambda: np.repeat(sampled(), 10), 1e-3),
    "printed": (lambda: np.round(between(sampled(), True), 6), 1e-3),
    "encoder": (lambda: np.round(sine(200) / 0.01) * 0.01, 0.01 / 12**0.5),
    "coarse encoder": (lambda: np.round(sine(200) / 0.1) * 0.1, 0.1 / 12**0.5),
    "encoder and noise": (lambda: np.round(sine(200) + white(0.02), 2), 0.02),
    "at rest for most of it": (lambda: (sine(200) + white(1e-3)) * (N < 1200), 1e-3),
    "nothing else": (lambda: white(1e-3), 1e-3),
    "rather short": (lambda: sampled(50)[:150], 1e-3),
}


USUALLY: dict[str, tuple[Callable[[], Vector], float]] = {
    "short": (lambda: sampled(40)[:60], 1e-3),
    "long correlated": (lambda: sine(500) + coloured(0.9, 0.01), 0.01),
}
"""Where one record in twenty tells too little."""


@pytest.mark.parametrize("name", KNOWN)
def test_noise_is_found_within_a_factor_of_two(name: str) -> None:
    made, level = KNOWN[name]
    assert is_found(made(), level)


@pytest.mark.parametrize("name", USUALLY)
def test_noise_is_usually_found_within_a_factor_of_two(name: str) -> None:
    made, level = USUALLY[name]
    assert sum(is_found(made(), level) for _ in range(30)) >= 26


def is_found(values: Vector, level: float) -> bool:
    """Whether the level is within a factor of two, in an interval that covers it, and told how."""
    found = noise_of_signal(values)
    near = level / 2 < found.level < 2 * level
    return near and found.low / 1.35 < level < 1.35 * found.high and bool(found.method)


UNKNOWN: dict[str, tuple[Callable[[], Vector], float]] = {
    "as slow as the signal": (lambda: sine(500) + coloured(0.98, 0.01), 0.01),
    "filtered as slow as the signal": (lambda: sine(60) + filtered(0.05, 1e-3), 1e-3),
}


@pytest.mark.parametrize("name", UNKNOWN)
def test_noise_that_cannot_be_told_from_the_signal_has_a_wide_interval(name: str) -> None:
    made, level = UNKNOWN[name]
    found = noise_of_signal(made())
    assert not found.is_sure
    assert found.low < level < found.high


def test_white_noise_is_found_as_well_as_it_can_be() -> None:
    found = [noise_of_signal(sine(80) + white(0.01)) for _ in range(20)]
    assert np.mean([one.level for one in found]) == pytest.approx(0.01, rel=0.03)
    assert np.std([one.level for one in found]) < 4e-4
    assert all(one.is_sure and "white" in one.method for one in found)


def test_uneven_times_count() -> None:
    t = np.sort(np.arange(400) + RANDOM.uniform(-0.4, 0.4, 400))
    values = sine(40, t) + white(1e-4, 400)
    assert noise_of_signal(values, t).level == pytest.approx(1e-4, rel=0.3)
    assert noise_of_signal(values).level > 1e-3


@cache
def signal_of(name: str) -> Vector:
    """The same numbers each time, for a test that draws many examples."""
    return {**KNOWN, **USUALLY, **UNKNOWN}[name][0]()


@settings(deadline=None, max_examples=30)
@given(
    st.sampled_from([*KNOWN, *USUALLY, *UNKNOWN]),
    st.floats(-9, 9),
    st.floats(-6, 6),
    st.sampled_from([-1.0, 1.0]),
)
def test_units_of_value_and_time_do_not_count(
    name: str, power: float, slower: float, sign: float
) -> None:
    values = signal_of(name)
    t, scale, clock = np.arange(len(values)) * 0.01, 10.0**power, 10.0**slower
    one = noise_of_signal(values, t)
    other = noise_of_signal(sign * scale * values, clock * t)
    assert (one.method, one.is_sure) == (other.method, other.is_sure)
    assert other.level == pytest.approx(scale * one.level, rel=1e-3)
    assert other.step == pytest.approx(scale * one.step, rel=1e-6)


@pytest.mark.parametrize(("factor", "order"), [(10, 1), (4, 1), (3, 3), (25, 3)])
def test_the_factor_of_an_interpolation_is_found(factor: int, order: int) -> None:
    y, fine = sampled(), np.arange(factor * 399 + 1) / factor
    if order == 1:
        values = np.interp(fine, np.arange(400), y)
    else:
        values = CubicSpline(np.arange(400), y)(fine)
    found, first = interpolation(values[2:])
    assert (found, first) == ((factor, factor - 2) if factor > 3 else (1, 0))


@pytest.mark.parametrize("period", [20, 50, 100])
def test_steps_at_even_times_are_no_interpolation(period: int) -> None:
    held = np.repeat(RANDOM.standard_normal(4000 // period), period)
    values = lfilter([0.1], [1, -0.9], held) + white(1e-3)
    assert interpolation(np.asarray(values)) == (1, 0)


def test_the_step_of_readings_is_found_where_some_are_missing() -> None:
    counts = RANDOM.integers(0, 100_000, 3000)
    assert rounding_step(0.3 + 5e-8 * counts) == pytest.approx(5e-8, rel=1e-3)
    assert rounding_step(white(1.0)) == 0.0
    assert rounding_step(np.arange(4.0)) == 0.0
    assert rounding_step(0.25 * np.repeat(np.arange(3.0), 17)) == 0.25  # little happens
    assert rounding_step(np.repeat(np.arange(2.0), 17)) == 0.0  # a switch


def test_a_steady_motion_is_not_rounded_to_what_it_moves_by() -> None:
    """A rotor at a constant rate: its angle at even times was read as that of a coarse encoder."""
    t = np.linspace(0, 6, 121)
    noisy = 2 * t + white(1e-3, len(t))
    assert rounding_step(noisy) == 0.0
    assert noise_of_signal(noisy, t).level == pytest.approx(1e-3, rel=0.5)
    counted = 1e-3 * np.round(0.37 * t / 0.05)
    assert rounding_step(counted) == pytest.approx(1e-3)


def test_a_declared_sigma_wins_and_says_so() -> None:
    values = sine(200) + white(1e-3)
    declared = Measured("run", "train", N * 0.01, {"x": values}, {"x": 0.25})
    (found,) = estimate_noise([declared]).values()
    assert (found.level, found.method, found.is_sure) == (0.25, "declared", True)


def test_several_series_have_the_median() -> None:
    series = [
        Measured(f"run {n}", "train", N * 0.01, {"x": sine(200) + white(level)})
        for n, level in enumerate((1e-3, 1.1e-3, 0.1))
    ]
    assert channel_noise(series)["x"] == pytest.approx(1.1e-3, rel=0.15)


@pytest.mark.parametrize("count", [1, 3, 5, 9, 40])
def test_a_constant_or_a_few_samples_do_no_harm(count: int) -> None:
    for values in (np.full(count, 2.5), np.arange(float(count))):
        measured = Measured("run", "train", np.arange(float(count)), {"x": values})
        assert 0 < channel_noise([measured])["x"] < 1


@pytest.mark.parametrize("value", [0.0, 1.0, 1e-310])
def test_a_signal_that_stands_still_has_no_noise(value: float) -> None:
    assert noise_of_signal(np.full(500, value)).level == 0.0
