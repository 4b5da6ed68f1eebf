"""Profiles beside straight theory, open ends in words, and every message."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from residual.models import LINE, OSCILLATOR, T, made, oscillation, series
from tracewire.errors import FitError, OptionError
from tracewire.fit import Fit, fit
from tracewire.fit.profile import profile
from tracewire.residual import Measured

RELEASED = OSCILLATOR.replace("value: 0.9", "value: 1")


@pytest.fixture(scope="module")
def line() -> Fit:
    noisy = 2 * T + 1 + 0.1 * np.random.default_rng(1).standard_normal(len(T))
    return fit(made(LINE), [series(noisy)], method="least_squares")


def test_the_profile_of_a_line_is_a_parabola_with_the_textbooks_interval(line: Fit) -> None:
    found = profile(line, "a")
    expected = ((found.values - line.values["a"]) / line.errors["a"]) ** 2
    assert found.rise == pytest.approx(expected, rel=1e-4, abs=1e-6)
    assert found.interval == pytest.approx(line.intervals["a"], rel=1e-5)
    assert found.words.startswith("a lies between 1.9")


def test_the_others_follow_along_the_profile(line: Fit) -> None:
    """b moves by -mean(t) times what a does."""
    found = profile(line, "a")
    moved = found.others["b"] - line.values["b"]
    assert moved == pytest.approx(-T.mean() * (found.values - line.values["a"]), rel=1e-4, abs=1e-7)


def test_free_start_values_are_refitted_too() -> None:
    noisy = oscillation(T) + 0.02 * np.random.default_rng(2).standard_normal(len(T))
    run = Measured("run", "train", T, {"x": noisy}, start={"x": None, "v": None})
    found = fit(made(RELEASED), [run], method="least_squares")
    shown = profile(found, "k")
    assert shown.interval == pytest.approx(found.intervals["k"], rel=1e-3)
    assert set(shown.others) == {"c"}


def test_several_series_of_different_noise_agree_with_the_standard_errors() -> None:
    rng = np.random.default_rng(3)
    runs = [
        series(2 * T + 1 + size * rng.standard_normal(len(T)), name)
        for name, size in (("fine", 0.05), ("coarse", 0.5))
    ]
    found = fit(made(LINE), runs, method="least_squares")
    assert profile(found, "a").interval == pytest.approx(found.intervals["a"], rel=1e-4)


def test_an_end_at_a_bound_is_open_and_told() -> None:
    """A damping of 0.02 that noise hides: nothing below, down to the bound at 0."""
    noisy = oscillation(T, c=0.005) + 0.3 * np.random.default_rng(4).standard_normal(len(T))
    found = fit(made(RELEASED), [series(noisy)], method="least_squares")
    shown = profile(found, "c")
    assert shown.interval[0] == -np.inf and np.isfinite(shown.interval[1])
    assert shown.values[0] == 0.0
    assert "no lower end within the bounds: c is not determined from below" in shown.words


def test_a_value_that_is_not_determined_is_open_on_both_sides() -> None:
    text = RELEASED.replace("-k*x", "-k/J*x").replace(
        "  x0:", "  J: {value: 1, fit: [0.5, 2]}\n  x0:"
    )
    noisy = oscillation(T) + 0.02 * np.random.default_rng(5).standard_normal(len(T))
    found = fit(made(text), [series(noisy)], method="least_squares")
    shown = profile(found, "J")
    assert shown.interval == (-np.inf, np.inf)
    assert np.abs(shown.rise).max() < 0.01
    assert "not determined from below" in shown.words and "not determined from above" in shown.words


def test_a_span_limits_the_profile(line: Fit) -> None:
    best, error = line.values["a"], line.errors["a"]
    shown = profile(line, "a", span=(best - 0.5 * error, best + 10 * error))
    assert shown.values[0] == pytest.approx(best - 0.5 * error)
    assert shown.interval[0] == -np.inf and np.isfinite(shown.interval[1])


def test_a_fit_that_had_not_converged_is_told(line: Fit) -> None:
    values = {**line.values, "a": line.values["a"] + 2 * line.errors["a"]}
    shown = profile(replace(line, values=values), "a")
    assert "a better fit was found" in shown.words


def test_a_value_that_was_not_fitted_is_refused(line: Fit) -> None:
    with pytest.raises(OptionError, match="unknown fitted value 'q'"):
        profile(line, "q")


def test_too_few_points_are_refused(line: Fit) -> None:
    with pytest.raises(OptionError, match="1 points on each side show no profile"):
        profile(line, "a", points=1)


def test_a_span_without_the_best_is_refused(line: Fit) -> None:
    with pytest.raises(OptionError, match="outside the span 5 to 6"):
        profile(line, "a", span=(5.0, 6.0))


def test_a_residual_of_zero_has_no_profile() -> None:
    found = fit(
        made(LINE), [series(np.zeros(len(T)))], method="least_squares", parameters={"a": 0.0}
    )
    with pytest.raises(FitError, match="without noise there is no profile"):
        profile(found, "a")
