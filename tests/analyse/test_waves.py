"""The rises of a wave, its period and its growth, against those of waves that are known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from analyse.models import row_of, value_of
from hypothesis import given, settings
from hypothesis import strategies as st
from tracewire.analyse.waves import rises

T = np.linspace(0.0, 40.0, 4001)
NO_FLOOR = np.zeros(len(T))
DAMPING = 5
DAMPED = """
title: Damped
span: [0, 20]
parameters: {c: 5}
blocks:
  x: {type: integrator, of: v, start: 0.005}
  v: {type: integrator, of: a}
  a: {type: expression, formula: -400*x - c*v}
  second: {type: expression, formula: 1000*x}
"""


@given(st.floats(-0.4, 0.4), st.floats(1, 15), st.floats(0, 6.28), st.floats(-5, 5))
@settings(max_examples=60, deadline=None)
def test_the_period_of_a_wave_that_grows_or_decays(
    rate: float, omega: float, phase: float, off: float
) -> None:
    x = off + np.exp(rate * T) * np.cos(omega * T + phase)
    found = np.diff(rises(T, x, NO_FLOOR))
    assert found.mean() == pytest.approx(2 * np.pi / omega, rel=2e-3)


def test_the_period_of_waves_of_other_shapes() -> None:
    for wave in (np.sign, lambda x: np.exp(3 * x), lambda x: x + x * x, lambda x: np.round(3 * x)):
        found = rises(T, wave(np.sin(2 * np.pi * T / 3 + 0.01)), NO_FLOOR)
        assert np.diff(found) == pytest.approx(3.0, abs=0.011)
        assert len(found) in (13, 14)


def test_two_rises_are_enough() -> None:
    few = T <= 5.0
    found = rises(T[few], np.sin(2 * np.pi * T[few] / 3.4 - 0.01), NO_FLOOR[few])
    assert np.diff(found) == pytest.approx([3.4], abs=1e-3)


def test_a_signal_without_waves_has_no_rises() -> None:
    assert len(rises(T, T, NO_FLOOR)) <= 1
    assert len(rises(T, 0 * T, NO_FLOOR)) == 0
    assert len(rises(T, np.exp(-T), NO_FLOOR)) == 0


def test_a_wave_below_the_floor_is_none() -> None:
    x = np.exp(-0.5 * T) * np.sin(6 * T)
    found = rises(T, x, NO_FLOOR + 1e-2)
    assert found[np.isfinite(found)].max() == pytest.approx(-np.log(1e-2) / 0.5, abs=1.0)


@pytest.mark.parametrize("x", ["x", "v", "a", "second"])
@pytest.mark.parametrize("run", ["run: {since: 0}", "run: {since: 2}"])
def test_noise_of_a_run_that_has_decayed_is_no_wave(run: str, x: str) -> None:
    """exp(-c t/2) cos(w t) falls by exp(-50), and a run has nine digits of it."""
    w = math.sqrt(400 - DAMPING**2 / 4)
    rate = value_of(DAMPED, f"growth_rate({x})", run)
    assert rate == pytest.approx(-DAMPING / 2, rel=2e-3)
    found = value_of(DAMPED, f"frequency({x})", run)
    assert found == pytest.approx(w / (2 * math.pi), rel=1e-3)


def test_what_is_noise_only_has_no_rate_and_no_period() -> None:
    run = "run: {since: 10, samples: 1001}"
    why = row_of(DAMPED, "growth_rate(x)", run).why
    assert "'x' has 0 peaks there" in why and "the tolerances of the run do not resolve it" in why
    assert "rises through the middle of its wave 0 times" in row_of(DAMPED, "period(x)", run).why
    slow = "run: {set: {c: 50}}"  # beyond the critical damping it has no waves
    assert "'x' has 0 peaks there" in row_of(DAMPED, "growth_rate(x)", slow).why
