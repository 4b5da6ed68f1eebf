"""Growth rates, spectra, scalograms and the drift of invariants against known signals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from analyse.models import MATHIEU, OSCILLATOR, PENDULUM, made
from hypothesis import given, settings
from hypothesis import strategies as st
from tracewire.analyse import floquet, growth_rate, invariant_drift, scalogram, spectrum
from tracewire.errors import AnalysisError, OptionError
from tracewire.solve import Run, Statistics, simulate

T = np.linspace(0.0, 40.0, 4001)


def run_of(t: np.ndarray[Any, Any] = T, **signals: np.ndarray[Any, Any]) -> Run:
    return Run("", t, signals, dict.fromkeys(signals, "m"), (), {}, {}, {},
               Statistics(1, 0, 1, 0, 0.0))  # fmt: skip


@given(st.floats(-0.3, 0.3), st.floats(2, 20), st.floats(0.01, 100))
@settings(max_examples=40, deadline=None)
def test_the_rate_of_a_growing_wave(rate: float, omega: float, size: float) -> None:
    x = size * np.exp(rate * T) * np.cos(omega * T + 0.4)
    found = growth_rate(run_of(x=x), "x")
    assert found.rate == pytest.approx(rate, abs=2e-4)
    assert found.error < 2e-3
    assert found.unit == "m"


def test_the_error_covers_noise() -> None:
    """In nine of ten records of noisy peaks the rate is within two and a half errors."""
    inside = 0
    for seed in range(40):
        random = np.random.default_rng(seed)
        x = np.exp(0.05 * T) * np.cos(6 * T) * (1 + 0.0 * T)
        x = x * np.exp(0.1 * np.interp(T, T[::52], random.standard_normal(len(T[::52]))))
        found = growth_rate(run_of(x=x), "x")
        inside += abs(found.rate - 0.05) < 2.5 * found.error
    assert inside >= 36


def test_a_beat_needs_its_period() -> None:
    x = np.exp(-0.02 * T) * np.cos(9 * T) * (1.2 + np.cos(1.0 * T))
    found = growth_rate(run_of(x=x), "x", period=2 * math.pi)
    assert found.rate == pytest.approx(-0.02, abs=3e-3)


def test_an_envelope_that_bends_is_told() -> None:
    x = (np.exp(0.3 * T) + 200 * np.exp(-0.5 * T)) * np.cos(9 * T)
    found = growth_rate(run_of(x=x), "x")
    assert found.bends
    assert found.late == pytest.approx(0.3, abs=1e-2)
    assert not growth_rate(run_of(x=x), "x", since=30.0).bends
    straight = growth_rate(run_of(x=np.exp(0.1 * T) * np.cos(9 * T)), "x")
    assert not straight.bends


def test_the_size_of_a_norm() -> None:
    found = growth_rate(run_of(x=3 * np.exp(0.4 * T)), "x", by="size", since=1.0, until=30.0)
    assert found.rate == pytest.approx(0.4, abs=1e-10)
    assert found.level == pytest.approx(math.log(3))
    assert (found.t[0], found.t[-1]) == (1.0, 30.0)


def test_a_growing_mathieu_has_the_rate_of_its_multiplier() -> None:
    model = made(MATHIEU)
    values = {"a": 1.0, "q": 0.3}
    exponent = floquet(model, "pi", parameters=values).exponents[0].real
    run = simulate(model, parameters=values, span=(0, 100), times=np.linspace(0, 100, 8001))
    found = growth_rate(run, "y", since=30, period=2 * math.pi)
    assert found.rate == pytest.approx(exponent, rel=1e-3)


@pytest.mark.parametrize("atol", [None, 1e-8, {"x": 1e-8, "v": 1e-6}])
@pytest.mark.parametrize("rtol", [1e-5, 1e-8])
def test_peaks_of_noise_do_not_count(rtol: float, atol: Any) -> None:
    """x = exp(-t) cos(w t) falls by exp(-40), below all that a run has of it."""
    run = simulate(made(OSCILLATOR), parameters={"k": 400.0, "c": 2.0}, span=(0, 40),
                   times=np.linspace(0, 40, 8001), rtol=rtol, atol=atol)  # fmt: skip
    found = growth_rate(run, "x")
    assert found.rate == pytest.approx(-1.0, rel=1e-3)
    assert not found.bends
    with pytest.raises(AnalysisError, match=r"below .* the tolerances of the run do not resolve"):
        growth_rate(run, "x", since=30.0)


@pytest.mark.parametrize(
    ("options", "error", "said"),
    [
        ({"by": "most"}, OptionError, "unknown envelope 'most'"),
        ({"period": 0.0}, OptionError, "a period of 0 s has no use"),
        ({"since": 39.9}, OptionError, "'x' has 11 samples there, too few"),
        ({"until": 1.0}, AnalysisError, "'x' has . peaks there, too few for a growth rate"),
    ],
)
def test_a_growth_rate_that_cannot_be(options: Any, error: Any, said: str) -> None:
    with pytest.raises(error, match=said):
        growth_rate(run_of(x=np.cos(3 * T)), "x", **options)
    with pytest.raises(OptionError, match="unknown recorded signal 'y'"):
        growth_rate(run_of(x=T), "y")


@given(st.floats(0.5, 20), st.floats(0.01, 10), st.floats(0, 6))
@settings(max_examples=30, deadline=None)
def test_a_line_has_its_frequency_and_amplitude(f: float, size: float, phase: float) -> None:
    found = spectrum(run_of(x=5 + size * np.cos(2 * np.pi * f * T + phase)), "x")
    assert found.lines[0].frequency == pytest.approx(f, abs=5e-4)
    assert found.lines[0].amplitude == pytest.approx(size, rel=5e-3)
    flat = spectrum(run_of(x=size * np.cos(2 * np.pi * f * T + phase)), "x", window="flattop")
    assert flat.amplitude.max() == pytest.approx(size, rel=2e-3)
    assert found.unit == "m"


def test_two_lines_are_told_apart() -> None:
    x = np.cos(2 * np.pi * 1.0 * T) + 0.25 * np.cos(2 * np.pi * 1.2 * T)
    first, second = spectrum(run_of(x=x), "x", lines=2).lines
    assert (first.frequency, second.frequency) == pytest.approx((1.0, 1.2), abs=5e-3)
    assert (first.amplitude, second.amplitude) == pytest.approx((1.0, 0.25), rel=0.05)
    assert spectrum(run_of(x=x), "x").resolution == pytest.approx(0.05, rel=1e-3)
    assert spectrum(run_of(x=0 * T), "x").lines == ()
    assert spectrum(run_of(x=x), "x", lines=0).lines == ()


@given(
    st.sampled_from(["hann", "flattop", "blackman", "boxcar"]),
    st.floats(0.5, 8),
    st.floats(0, 1),
    st.floats(0, 6),
)
@settings(max_examples=60, deadline=None)
def test_no_two_lines_are_nearer_than_is_told(
    window: str, bins: float, offset: float, phase: float
) -> None:
    first, second = (30 + offset) / T[-1], (30 + offset + bins) / T[-1]
    x = np.cos(2 * np.pi * first * T) + np.cos(2 * np.pi * second * T + phase)
    found = spectrum(run_of(x=x), "x", window=window)
    apart = np.diff(sorted(line.frequency for line in found.lines))
    assert np.all(apart >= found.resolution * (1 - 1e-9))
    if second - first > found.resolution + 1.6 / T[-1]:  # the grid of frequencies on both sides
        nearest = [min(abs(line.frequency - f) for line in found.lines) for f in (first, second)]
        assert max(nearest) < 0.5 / T[-1]


def test_a_spectrum_refuses_what_does_not_fit() -> None:
    uneven = run_of(np.cumsum(np.random.default_rng(1).uniform(1, 2, 100)), x=np.arange(100.0))
    with pytest.raises(OptionError, match="the samples of 'x' are not at even times"):
        spectrum(uneven, "x")
    with pytest.raises(OptionError, match="unknown window 'hamming'"):
        spectrum(run_of(x=T), "x", window="hamming")
    with pytest.raises(OptionError, match="-1 lines cannot be told"):
        spectrum(run_of(x=T), "x", lines=-1)


@pytest.mark.parametrize(("f", "size"), [(1.0, 0.1), (3.3, 10.0), (9.0, 1.0)])
def test_a_scalogram_has_the_amplitude_at_all_times(f: float, size: float) -> None:
    found = scalogram(run_of(x=size * np.cos(2 * np.pi * f * T)), "x", low=0.5, high=20, count=100)
    reach = 3 * found.edge[np.argmin(np.abs(found.frequency - f))]
    inner = (found.t > reach) & (found.t < 40 - reach)
    assert inner.sum() > 2000
    assert found.ridge[inner] == pytest.approx(f, rel=0.02)
    assert found.amplitude.max(axis=0)[inner] == pytest.approx(size, rel=0.02)


def test_the_ridge_follows_a_chirp() -> None:
    x = np.cos(2 * np.pi * (1.0 * T + 0.05 * T**2))  # 1 Hz + 0.1 Hz a second
    found = scalogram(run_of(x=x), "x", low=0.5, high=10, waves=12, count=300)
    inner = (found.t > 4) & (found.t < 36)
    assert found.ridge[inner] == pytest.approx(1 + 0.1 * found.t[inner], rel=0.04)
    # more waves reach farther
    assert scalogram(run_of(x=x), "x").edge[0] < scalogram(run_of(x=x), "x", waves=12).edge[0]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"low": 3.0, "high": 2.0}, "frequencies from 3 to 2 Hz are not in samples"),
        ({"high": 80.0}, "are not in samples every 0.01 s. Give low < high, up to 50 Hz"),
        ({"count": 2}, "2 frequencies of 4001 samples make no scalogram"),
        ({"waves": 1.0}, "a wavelet of 1 waves is none of Morlet's"),
    ],
)
def test_a_scalogram_refuses_what_does_not_fit(options: Any, said: str) -> None:
    with pytest.raises(OptionError, match=said):
        scalogram(run_of(x=np.cos(T)), "x", **options)


def test_the_energy_of_a_pendulum_stays() -> None:
    model = made(PENDULUM)
    run = simulate(model, rtol=1e-9)
    (found,) = invariant_drift(run, ["energy"])
    assert found.relative < 1e-7
    assert found.scale == pytest.approx(9.81 * math.cos(0.3))
    (lost,) = invariant_drift(simulate(model, parameters={"b": 0.1}), ["energy"], scale=9.81)
    assert lost.relative == pytest.approx(lost.largest / 9.81)
    assert lost.final < 0
    assert lost.at > 5


def test_a_drift_is_measured_from_the_start() -> None:
    run = run_of(x=2 + 0.1 * np.sin(T), z=0 * T, w=np.sin(T))
    x, z, w = invariant_drift(run, ["x", "z", "w"])
    assert (x.largest, x.relative) == pytest.approx((0.1, 0.05), rel=1e-4)
    assert z.relative == 0.0
    assert w.relative == pytest.approx(1.0)
    assert invariant_drift(run, ["x", "w"], scale={"w": 4.0})[1].relative == pytest.approx(
        0.25, rel=1e-4
    )


@pytest.mark.parametrize(
    ("names", "scale", "said"),
    [
        ([], None, "no invariant is named"),
        (["y"], None, "unknown recorded signal 'y'"),
        (["x"], {"y": 1.0}, "unknown invariant 'y'"),
        (["x"], 0.0, "the scale 0 of 'x' has no use"),
    ],
)
def test_a_drift_refuses_what_does_not_fit(names: Any, scale: Any, said: str) -> None:
    with pytest.raises(OptionError, match=said):
        invariant_drift(run_of(x=T), names, scale=scale)


def test_a_decaying_oscillator_shows_its_damping() -> None:
    run = simulate(made(OSCILLATOR), span=(0, 60), times=np.linspace(0, 60, 6001), rtol=1e-9)
    found = growth_rate(run, "x")
    assert found.rate == pytest.approx(-0.05, abs=1e-5)
