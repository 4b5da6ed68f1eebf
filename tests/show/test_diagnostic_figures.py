"""The residual and the profile likelihood as pictures."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from show.fits import compared, made_fit
from show.test_figures import texts
from tracewire.errors import OptionError
from tracewire.fit.profile import Profile
from tracewire.show import diagnostic_figures, plot_diagnostics, plot_profiles

X = np.linspace(-3, 3, 13)
CLOSED = Profile("k", 4 + 0.1 * X, X**2, {}, (3.8, 4.2), 4.0, "")


def test_white_and_coloured_residuals_are_told_apart(tmp_path: Path) -> None:
    white, coloured = compared("white", sigma=0.05, count=300, after=0.0), compared("wrong")
    said = texts(plot_diagnostics(made_fit(comparisons=(white,)), tmp_path / "w.svg"))
    assert " white " in said
    assert "correlated over" not in said
    weak = compared("weak", sigma=0.05, count=4000, after=0.01)  # a bias of a fifth of sigma
    said = texts(plot_diagnostics(made_fit(comparisons=(weak,)), tmp_path / "s.svg"))
    assert "too little to matter" in said
    said = texts(plot_diagnostics(made_fit(comparisons=(coloured,)), tmp_path / "c.svg"))
    assert "correlated over" in said
    assert "train: wrong, x" in said


def test_the_correlation_with_inputs_is_drawn_where_there_are_some(tmp_path: Path) -> None:
    """The residual of the first series is its input, and noise."""
    t, rng = np.linspace(0, 2, 400), np.random.default_rng(1)
    u, noise = rng.choice([-1.0, 1.0], 400), 0.01 * rng.standard_normal(400)
    driven = compared("driven", count=400, after=0.0)
    driven = replace(driven, measured=driven.after + 0.02 * u + noise)
    fit = made_fit(comparisons=(driven, compared("alone")))
    inputs = {"T_motor": (t, u), "other": (t, np.zeros(400))}
    fit = replace(fit, measured=(replace(fit.measured[0], inputs=inputs), fit.measured[1]))
    said = texts(plot_diagnostics(fit, tmp_path / "d.svg"))
    for words in ("depends on T_motor", "input earlier by [s]"):
        assert said.count(words) == 1
    assert "input earlier" not in texts(plot_diagnostics(made_fit(), tmp_path / "e.svg"))


def test_a_residual_of_zero_and_many_signals_are_drawn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(diagnostic_figures.FIT, "most_residuals", 2)
    zero = compared("none", after=0.0)
    assert plot_diagnostics(made_fit(comparisons=(zero,)), tmp_path / "z.png").is_file()
    many = tuple(compared(f"run_{n}", count=12) for n in range(3))
    said = texts(plot_diagnostics(made_fit(comparisons=many), tmp_path / "m.svg"))
    assert "the first 2 of 3 signals" in said
    assert "run_2" not in said


def test_a_profile_has_its_interval(tmp_path: Path) -> None:
    said = texts(plot_profiles([CLOSED], tmp_path / "p.svg"))
    assert "95 %: 3.8 to 4.2" in said


@pytest.mark.parametrize(
    ("interval", "said"),
    [
        ((3.8, math.inf), "not determined from above"),
        ((-math.inf, 4.2), "not determined from below"),
        ((-math.inf, math.inf), "not determined from below and above"),
    ],
)
def test_an_open_end_is_told_in_words(
    tmp_path: Path, interval: tuple[float, float], said: str
) -> None:
    shown = texts(plot_profiles([CLOSED, replace(CLOSED, interval=interval)], tmp_path / "p.svg"))
    assert said in shown
    assert "inf" not in shown


def test_what_cannot_be_drawn_is_told(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"no profile cannot be drawn. Compute one with profile"):
        plot_profiles([], tmp_path / "p.png")
    short = made_fit(comparisons=(compared(count=5),))
    with pytest.raises(OptionError, match="no measured signal has enough samples"):
        plot_diagnostics(short, tmp_path / "d.png")
