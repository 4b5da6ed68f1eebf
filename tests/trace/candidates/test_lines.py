"""Lines in the spectrum of a residual: found where they are, and none in noise."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import Criterion, Measured, Section, cut_windows, evaluate_windows
from tracewire.trace.candidates.lines import line_periods, modulating_periods
from tracewire.trace.thresholds import CandidateOptions

Vector = NDArray[np.float64]
OPTIONS = CandidateOptions()
OSCILLATOR = """
span: [0, 60]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  a: {type: gain, of: x, k: -50}
"""


def found(*series: tuple[float, float, int], level: float = 1.0, coloured: float = 0.0) -> Vector:
    """The lines of series with a sine: of this period in s, every so many s, with this seed."""
    model = compile(read_text(OSCILLATOR), record=["x"])
    segments = []
    for number, (period, interval, seed) in enumerate(series):
        t = np.arange(0, 60, interval)
        random = np.random.default_rng(seed)
        noise = random.standard_normal(len(t))
        for n in range(1, len(t)):
            noise[n] += coloured * noise[n - 1]
        values = level * np.sin(2 * np.pi * t / period + seed) + noise
        measured = Measured(f"run {number}", "train", t, {"x": values}, start={"x": None, "v": 0.0})
        segments += cut_windows(model, Section(measured, 0, len(t)), 120, ("x", "v"))
    windows = evaluate_windows(
        Criterion(model, segments, [], {}, sigma={"x": 1.0}, weighting="sum")
    )
    return np.array(line_periods(windows, OPTIONS))


@pytest.mark.parametrize("period", [0.0534, 0.2421, 0.7])
def test_a_sine_of_hundreds_of_periods_is_found(period: float) -> None:
    """A refit needs its phase right all along the record: a small part of a wave in 60 s."""
    first = found((period, 0.01, 3))[0]
    assert abs(60 / first - 60 / period) < 0.1


def test_series_with_phases_and_intervals_of_their_own_add_up() -> None:
    both = found((0.31, 0.01, 1), (0.31, 0.02, 2), level=0.25)
    assert abs(60 / both[0] - 60 / 0.31) < 0.2


@pytest.mark.parametrize("coloured", [0.0, 0.9])
def test_noise_has_hardly_a_line(coloured: float) -> None:
    counts = [len(found((1.0, 0.01, n), level=0.0, coloured=coloured)) for n in range(20)]
    assert sum(count > 0 for count in counts) <= 1


def test_a_record_with_a_gap_of_years_is_passed_over() -> None:
    """Its spectrum would take more memory than there is."""
    model = compile(read_text(OSCILLATOR), record=["x"])
    t = np.r_[np.arange(0, 30, 0.01), 1e9 + np.arange(0, 30, 0.01)]
    measured = Measured("run", "train", t, {"x": np.sin(20 * t)}, start={"x": None, "v": 0.0})
    segments = cut_windows(model, Section(measured, 0, 2400), 120, ("x", "v"))
    windows = evaluate_windows(
        Criterion(model, segments, [], {}, sigma={"x": 1.0}, weighting="sum")
    )
    assert line_periods(windows, OPTIONS) == []


def test_a_wave_that_modulates_a_swing_is_looked_for_beside_both_lines() -> None:
    """x*sin(w t) with a swing x: the residual has a line at the sum and one at the difference."""
    t = np.arange(0, 40, 0.01)
    swing = np.exp(-t / 30) * np.sin(2 * np.pi * 0.83 * t) + 0.2
    tried = np.array(modulating_periods([1 / (1.58 - 0.83)], [(t, swing)], OPTIONS))
    assert np.min(np.abs(1 / tried - 1.58)) * 40 < 0.15
    assert len(tried) < 100


def test_a_signal_that_rests_or_has_a_gap_of_years_modulates_nothing() -> None:
    t = np.r_[np.arange(0, 30, 0.01), 1e9 + np.arange(0, 30, 0.01)]
    assert modulating_periods([0.5], [(t, np.sin(20 * t))], OPTIONS) == []
    still = np.arange(0, 30, 0.01)
    assert modulating_periods([0.5], [(still, np.ones(len(still)))], OPTIONS) == []
