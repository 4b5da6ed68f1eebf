"""What is left of a fit is judged rightly: white, correlated, driven, with outliers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from residual.made_noise import autoregression
from residual.models import LINE, OSCILLATOR, T, made, oscillation, series
from tracewire.fit import Fit, fit
from tracewire.fit.diagnostics import (
    Diagnosis,
    autocorrelation,
    diagnose,
    independence,
    ljung_box,
    sign_change_probability,
)
from tracewire.show.fit_tables import fit_words

Vector = NDArray[np.float64]
LONG = np.linspace(0.0, 6.0, 601)


def line(noise: Vector, **more: Any) -> Fit:
    """A line fitted to 2 t + 1 and noise."""
    return fit(made(LINE), [series(2 * LONG + 1 + noise, t=LONG, **more)], method="least_squares")


def one(noise: Vector, **more: Any) -> Diagnosis:
    (found,) = diagnose(line(noise, **more))
    return found


def test_white_noise_is_white_and_at_the_noise() -> None:
    found = one(0.1 * np.random.default_rng(1).standard_normal(601))
    assert found.is_white
    assert found.words == "white, at the noise"
    assert found.size == pytest.approx(0.1, rel=0.1)
    assert found.noise == pytest.approx(0.1, rel=0.15)
    assert found.correlation[0] == pytest.approx(1.0)
    assert found.band == pytest.approx(1.96 / 601**0.5, rel=1e-3)


def test_an_effect_that_the_model_lacks_is_told_with_its_size_and_memory() -> None:
    """A sine of 1 Hz falls to 1/e of its correlation in arccos(1/e)/2 pi = 0.19 s."""
    white = 0.01 * np.random.default_rng(2).standard_normal(601)
    found = one(0.1 * np.sin(2 * np.pi * LONG) + white)
    assert not found.is_white
    assert found.memory == pytest.approx(0.19, abs=0.02)
    assert "Something is missing. `tracewire trace` looks for it" in found.words
    assert f"{found.size / found.noise:.2g} times the noise" in found.words
    assert found.sign_changes < 1e-6


def test_a_series_that_is_too_short_for_a_trace_is_not_sent_there() -> None:
    t = np.linspace(0.0, 2.6, 39)
    record = 2 * t + 1 + 0.5 * np.sin(2 * np.pi * t / 1.3)
    found = fit(made(LINE), [series(record, t=t, sigma={"x": 0.01})], method="least_squares")
    (told,) = diagnose(found)
    assert "`tracewire trace` takes no series below 40 samples" in told.words


def test_a_fit_that_has_not_come_to_its_end_is_not_sent_to_a_trace() -> None:
    """It is told first, as the residual of each series would lead elsewhere."""
    few = {"MaxIter": 3}
    found = fit(made(LINE), [series(2 * LONG + 1, t=LONG)], method="fminsearch", options=few)
    (told,) = diagnose(found)
    assert "times the noise and correlated over" in told.words
    assert not told.is_missing
    assert "trace" not in told.words
    words = fit_words(found)
    assert words[0].startswith("the search ended before a minimum: ")
    assert words[0].endswith(". Until it reaches one, no residual tells that something is missing.")


def test_noise_larger_than_declared_is_no_missing_effect() -> None:
    found = one(0.1 * np.random.default_rng(3).standard_normal(601), sigma={"x": 0.02})
    assert found.declared
    assert "yet white: the noise is larger than declared" in found.words


def test_a_sigma_declared_too_large_is_told() -> None:
    found = one(0.1 * np.random.default_rng(4).standard_normal(601), sigma={"x": 0.5})
    assert found.words == "white, and 0.2 times the declared noise: sigma is declared too large"


def test_correlated_noise_of_the_declared_size_is_told_as_such() -> None:
    noise = 0.1 * autoregression((0.6,), 601, np.random.default_rng(5))
    found = one(noise, sigma={"x": 0.125})
    assert found.words.startswith("at the declared noise, yet correlated over 0.02 s")


def test_a_noise_that_cannot_be_told_from_the_signal_is_no_missing_effect() -> None:
    t = np.linspace(0, 60, 3000)
    slow = autoregression((0.98,), len(t), np.random.default_rng(5))
    measured = series(3 * t + slow, t=t, start={"x": None})
    (found,) = diagnose(fit(made(LINE), [measured], method="least_squares"))
    assert found.estimate is not None and not found.estimate.is_sure
    assert found.size > 1.5 * found.noise
    assert "It may be noise alone: the noise is estimated to lie between" in found.words
    assert "Something is missing" not in found.words


def test_outliers_are_counted_and_told() -> None:
    noise = 0.1 * np.random.default_rng(6).standard_normal(601)
    noise[::60] += 3.0
    found = one(noise)
    assert found.outliers == pytest.approx(11 / 601)
    assert "1.8 % are outliers" in found.words


def test_what_a_model_lacks_now_and_then_is_no_outlier() -> None:
    white = 0.02 * np.random.default_rng(7).standard_normal(601)
    found = one(white + np.where(np.arange(601) % 100 < 8, 1.0, 0.0))
    assert found.outliers > 0.05
    assert "Something is missing" in found.words
    assert "are outliers" not in found.words


def test_noise_that_is_correlated_may_be_all_that_is_left() -> None:
    random = np.random.default_rng(5)
    slow = autoregression((0.88,), 601, random)
    found = one(0.15 * slow / np.std(slow) + 0.12 * random.standard_normal(601))
    assert found.noise < found.size < 3 * found.noise
    assert "or the noise itself is correlated: its estimate counts the white part" in found.words


def test_dependence_on_a_measured_input_is_told() -> None:
    rng = np.random.default_rng(7)
    drive = autoregression((0.9,), 601, rng)
    noise = 0.05 * np.roll(drive, 3) + 0.05 * rng.standard_normal(601)
    text = LINE.replace("title:", "inputs:") + "inputs: [u]\n"
    model = made(text)
    run = series(2 * LONG + 1 + noise, t=LONG, inputs={"u": (LONG, drive)})
    (found,) = diagnose(fit(model, [run], method="least_squares"))
    assert found.independence["u"] < 1e-6
    assert "The residual depends on u, which drives the model" in found.words


def test_dependence_on_a_drive_of_the_diagram_is_told() -> None:
    """A drive that the sensor sees, and the model's output does not."""
    text = LINE.replace("value: a}", "value: a}\n  hum: {type: sine, amplitude: 1, omega: w}\n")
    text = text.replace("fit: free}}", "fit: free}, w: 30}").replace("of: slope", "of: rate")
    text += "  rate: {type: sum, of: [slope, hum]}\n"
    hum = 0.05 * np.sin(30 * LONG + 0.8)
    own = (1 - np.cos(30 * LONG)) / 30
    noise = hum + own + 0.02 * np.random.default_rng(12).standard_normal(601)
    run = series(2 * LONG + 1 + noise, t=LONG)
    (found,) = diagnose(fit(made(text), [run], method="least_squares"))
    assert found.independence["hum"] < 0.01
    assert "The residual depends on hum, which drives the model" in found.words


def test_every_series_and_those_to_validate_are_judged() -> None:
    rng = np.random.default_rng(8)
    runs = [
        series(2 * T + 1 + 0.1 * rng.standard_normal(len(T)), "one"),
        series(2 * T + 1.5 + 0.1 * rng.standard_normal(len(T)), "two", use="validate"),
    ]
    found = diagnose(fit(made(LINE), runs, method="least_squares"))
    assert [(d.series, d.use) for d in found] == [("one", "train"), ("two", "validate")]
    assert found[0].is_white and not found[1].is_white


def test_samples_that_do_not_count_are_not_judged() -> None:
    noise = 0.1 * np.random.default_rng(9).standard_normal(601)
    noise[:100] += 5.0
    found = one(noise, counts_from=1.0)
    assert len(found.residual) == 501
    assert found.words == "white, at the noise"


def shares_below(probabilities: list[float], level: float) -> float:
    return float(np.mean(np.array(probabilities) < level))


def test_probabilities_of_white_noise_are_even() -> None:
    rng = np.random.default_rng(10)
    noises = [rng.standard_normal(300) for _ in range(400)]
    white = [ljung_box(autocorrelation(x, 21), 300) for x in noises]
    signs = [sign_change_probability(x) for x in noises]
    for level in (0.05, 0.5):
        assert shares_below(white, level) == pytest.approx(level, abs=0.08)
        assert shares_below(signs, level) == pytest.approx(level, abs=0.1)


def test_two_independent_slow_signals_are_not_taken_for_dependent() -> None:
    """By plain correlation these look dependent most of the time."""
    rng = np.random.default_rng(11)
    pairs = [
        (autoregression((0.9,), 600, rng), autoregression((0.95,), 600, rng)) for _ in range(40)
    ]
    wave = np.sin(0.3 * np.arange(600))
    assert shares_below([independence(x, y, 20) for x, y in pairs], 0.05) <= 0.15
    assert shares_below([independence(x, wave, 20) for x, _ in pairs], 0.05) <= 0.15


def test_what_follows_a_signal_depends_on_it_and_what_leads_it_by_far_does_not() -> None:
    rng = np.random.default_rng(13)
    other = autoregression((0.9,), 600, rng)
    noise = rng.standard_normal(600)
    assert independence(np.roll(other, 3) + noise, other, 20) < 1e-6
    assert independence(np.roll(other, -100) + noise, other, 20) > 1e-3
    assert (
        independence(np.sin(0.3 * np.arange(600)) + noise, np.cos(0.3 * np.arange(600)), 20) < 1e-6
    )
    assert independence(noise, np.zeros(600), 20) == 1.0
    assert independence(noise, np.ones(600), 20) == 1.0


@pytest.mark.parametrize(
    ("record", "method", "told"),
    [
        (np.cos(6 * T), "least_squares", True),
        (np.cos(6 * T), "growing_windows", False),
        (oscillation(T) + 0.05 * np.cos(7 * T), "least_squares", False),
    ],
    ids=["out of step", "after growing windows", "in step"],
)
def test_before_a_trace_other_minima_are_to_be_looked_for(
    record: Vector, method: str, told: bool
) -> None:
    """The nearest minimum leaves most of a wave of twice the frequency."""
    found = fit(made(OSCILLATOR), [series(record, sigma={"x": 0.01})], method=method)
    words = fit_words(found)
    assert any("is missing" in text for text in words)
    assert any("Fit once more with --method growing_windows" in text for text in words) == told
