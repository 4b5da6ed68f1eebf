"""Single wrong samples are left out, and nothing else is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.oscillator import model_of, record
from tracewire.residual import Measured
from tracewire.trace.check.outliers import drop_outliers, find_outliers
from tracewire.trace.options import TraceOptions
from tracewire.trace.trace import set_up_search

OPTIONS = TraceOptions()

T = np.arange(0.0, 10.0, 0.01)
NOISE = 1e-3


def swing(seed: int = 0) -> np.ndarray:
    noise = NOISE * np.random.default_rng(seed).standard_normal(len(T))
    return np.exp(-0.1 * T) * np.cos(5.0 * T) + noise


@given(st.integers(5, len(T) - 6), st.floats(30, 1e4), st.sampled_from([-1, 1]))
def test_a_single_wrong_sample_is_found(row: int, size: float, sign: int) -> None:
    y = np.exp(-0.1 * T) * np.cos(5.0 * T)
    y[row] += sign * size * NOISE
    assert np.flatnonzero(find_outliers(T, y, NOISE, OPTIONS.check)).tolist() == [row]


@given(st.integers(5, 94), st.sampled_from([-1e6, -999.0, 60.0, 65535.0]))
def test_a_lost_sample_is_found_where_a_period_has_few(row: int, shown: float) -> None:
    """Twelve samples a period are far off any cubic, in the noise's standard deviation."""
    y = np.cos(2 * np.pi * np.arange(100) / 12)
    y[row] = shown
    assert np.flatnonzero(find_outliers(T[:100], y, NOISE, OPTIONS.check)).tolist() == [row]


@given(st.integers(6, 93), st.floats(0.0, 0.99), st.floats(2.0, 12.0))
def test_a_kink_is_no_spike_where_a_period_has_few_samples(
    row: int, shift: float, period: float
) -> None:
    k = np.arange(100) - row - shift
    bounce = np.abs(np.sin(np.pi * k / (2 * period)))
    assert not find_outliers(T[:100], bounce, NOISE, OPTIONS.check).any()
    step = np.where(k > 0, 1.0, 0.0) * np.cos(np.pi * k / (4 * period))
    assert not find_outliers(T[:100], step, NOISE, OPTIONS.check).any()


def test_noise_hides_a_spike_seldom() -> None:
    """Its neighbours must all be within 3 standard deviations: 97 in 100 are."""
    rows = range(10, 990, 14)
    found = 0
    for row in rows:
        y = swing(row)
        y[row] += 0.05
        there = np.flatnonzero(find_outliers(T, y, NOISE, OPTIONS.check)).tolist()
        assert there in ([row], []), "never another one"
        found += len(there)
    assert found > 0.9 * len(rows)


@given(st.integers(0, 200))
def test_noise_has_no_spikes(seed: int) -> None:
    assert not find_outliers(T, swing(seed), NOISE, OPTIONS.check).any()


@pytest.mark.parametrize("speed", [0.3, 1.0, 3.0, 10.0])
def test_the_kink_of_an_impact_is_no_spike(speed: float) -> None:
    """A ball's bounce, a rate that turns under dry friction, and one of a body that is stopped."""
    for shift in np.linspace(0, 0.01, 7):
        noise = 1e-4 * np.random.default_rng(1).standard_normal(len(T))
        assert not find_outliers(
            T, speed * np.abs(T - 5.0 - shift) + noise, 1e-4, OPTIONS.check
        ).any()
        assert not find_outliers(T, speed * (5.0 + shift > T) + noise, 1e-4, OPTIONS.check).any()


def test_a_series_tells_what_was_left_out() -> None:
    y = swing(3)
    y[[100, 400, 700]] += 0.5
    m = Measured("swing", "train", T, {"x": y, "v": swing(1)})
    found = drop_outliers(m, {"x": NOISE, "v": NOISE}, OPTIONS.check)
    assert len(found.t) == len(found.values["v"]) == len(T) - 3
    assert found.remarks == ("3 single samples left out, far off their neighbours: 3 of x",)
    assert np.abs(np.diff(found.values["x"])).max() < 0.1


def test_many_wrong_samples_are_no_mistake_of_single_ones() -> None:
    y = swing()
    y[10::40] += 0.5
    m = Measured("swing", "train", T, {"x": y})
    assert drop_outliers(m, {"x": NOISE}, OPTIONS.check) is m


def test_a_series_without_spikes_is_the_same() -> None:
    m = Measured("swing", "train", T, {"x": swing()})
    assert drop_outliers(m, {"x": NOISE}, OPTIONS.check) is m
    assert drop_outliers(replace(m, t=T**1.5), {"x": NOISE}, OPTIONS.check).values.keys() == {"x"}


def test_a_trace_leaves_them_out_and_says_so() -> None:
    m = record()
    x = m.values["x"].copy()
    x[[150, 260]] -= 0.3
    search = set_up_search(model_of(), [replace(m, values={"x": x})], 1e-8, str, TraceOptions())
    assert len(search.problem.measured[0].t) == len(m.t) - 2
    assert any("2 single samples left out" in words for words in search.words)
    assert search.fit_declared().reduced_chi2 == pytest.approx(1.0, abs=0.25)


@given(st.integers(6, 593), st.integers(0, 50), st.sampled_from([-1, 1]))
def test_a_wrong_sample_is_found_where_times_jitter(row: int, seed: int, sign: int) -> None:
    """A gyro that sends its time stamps: every 20 ms, give or take 3."""
    rng = np.random.default_rng(seed)
    t = 0.02 * np.arange(600) + rng.uniform(-0.003, 0.003, 600)
    y = 4.0 * np.cos(5.0 * t) + 6e-3 * rng.standard_normal(600)
    assert not find_outliers(t, y, 6e-3, OPTIONS.check).any()
    y[row] += sign * 1.5
    assert set(np.flatnonzero(find_outliers(t, y, 6e-3, OPTIONS.check))) <= {row}
    y[row - 5 : row + 6] = 4.0 * np.cos(5.0 * t[row - 5 : row + 6])
    y[row] += sign * 1.5
    assert np.flatnonzero(find_outliers(t, y, 6e-3, OPTIONS.check)).tolist() == [row]


def test_beside_a_gap_nothing_is_an_outlier() -> None:
    t = np.delete(T, np.s_[500:540])
    y = np.cos(5.0 * t)
    y[500] += 0.5
    assert not find_outliers(t, y, NOISE, OPTIONS.check).any()
