"""The sine that a drive is: its amplitude, period and phase in each series."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from tracewire.residual import Measured
from tracewire.trace.candidates.drive_sines import Sine, drive_sines_of, fit_sine, own_values
from tracewire.trace.options import TraceOptions

OPTIONS = TraceOptions()

T = np.arange(501) / 50


def measured(name: str, use: str, u: NDArray[np.float64]) -> Measured:
    return Measured(f"{name} ({use})", use, T, {"x": 0 * T}, inputs={"u": (T, u)}, series=name)


@pytest.mark.parametrize("omega", [0.7, 1.3, 6.0, 20.0, 60.0])
def test_a_sine_around_a_mean_is_found_exactly(omega: float) -> None:
    found = fit_sine(T, 0.02 * np.sin(omega * T - 2.0) + 0.5, OPTIONS.candidate.pure_tone)
    assert found is not None
    assert found.amplitude == pytest.approx(0.02, rel=1e-9)
    assert found.period == pytest.approx(2 * np.pi / omega, rel=1e-9)
    assert found.phase == pytest.approx(-2.0, abs=1e-8)


def test_noise_a_square_wave_and_a_constant_are_no_sines() -> None:
    assert (
        fit_sine(T, np.random.default_rng(1).standard_normal(len(T)), OPTIONS.candidate.pure_tone)
        is None
    )
    assert fit_sine(T, np.sign(np.sin(3 * T)), OPTIONS.candidate.pure_tone) is None
    assert fit_sine(T, np.full(len(T), 2.0), OPTIONS.candidate.pure_tone) is None


def test_each_series_has_its_own_sine_and_windows_of_it_share_it() -> None:
    one, other = np.sin(3 * T), 2 * np.sin(4 * T + 1)
    sines = drive_sines_of(
        [measured("a", "train", one), measured("a", "gate", one), measured("b", "train", other)],
        OPTIONS.candidate,
    )
    assert set(sines) == {"u"} and set(sines["u"]) == {"a", "b"}
    own = own_values({"size": "amplitude", "start": "phase"}, sines["u"])
    assert own["b"] == pytest.approx({"size": 2.0, "start": 1.0})
    assert own_values({"size": "amplitude"}, None) == {}
    assert isinstance(sines["u"]["a"], Sine)


def test_a_drive_that_is_no_sine_in_one_series_has_no_tones() -> None:
    square = np.sign(np.sin(3 * T))
    assert (
        drive_sines_of(
            [measured("a", "train", np.sin(T)), measured("b", "train", square)], OPTIONS.candidate
        )
        == {}
    )
