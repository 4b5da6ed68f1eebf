"""Figures of fits say what is known and what is not, in pictures that are files."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib import pyplot
from show.fits import compared, made_fit
from show.test_figures import pixels
from show.test_figures import texts as comments
from tracewire.errors import OptionError
from tracewire.show import (
    comparison_figures,
    plot_comparisons,
    plot_convergence,
    plot_correlation,
    plot_parameters,
)
from tracewire.show.comparison_figures import _uncounted
from tracewire.show.style import cut

FIT = made_fit()


def texts(path: Path) -> str:
    """The texts of an SVG file, a line each."""
    return "\n".join(line.strip() for line in comments(path).splitlines())


def test_parameters_are_shown_with_what_is_not_known(tmp_path: Path) -> None:
    fit = replace(FIT, uncertainty=replace(FIT.uncertainty, unmoved=("J",)))
    said = texts(plot_parameters(fit, tmp_path / "p.svg"))
    for words in ("Parameters", "k", "offset.x", "no effect on the data", "5 %", "20 %"):
        assert words in said.splitlines()
    assert "nan" not in said


@pytest.mark.parametrize("count", [1, 12, 50])
def test_any_number_of_parameters_is_drawn(tmp_path: Path, count: int) -> None:
    values = {f"subsystem.with.a.very.long.name.p{n}": float(n - 3) for n in range(count)}
    fit = made_fit(values, [math.nan if n % 3 else 0.1 for n in range(count)])
    said = texts(plot_parameters(fit, tmp_path / "p.svg"))
    assert ("the first 40 of 50 parameters" in said) == (count == 50)
    pixels(plot_convergence(fit, tmp_path / "c.png"))


def test_nothing_known_is_drawn(tmp_path: Path) -> None:
    fit = made_fit({"k": 0.0, "J": 1.0}, (math.nan, math.nan))
    said = texts(plot_parameters(fit, tmp_path / "p.svg"))
    assert said.count("not determined") == 2
    assert texts(plot_correlation(fit, tmp_path / "c.svg")).count("–") == 4


def test_a_correlation_has_numbers(tmp_path: Path) -> None:
    strong = made_fit({"k": 1.0, "J": 2.0}, (0.1, 0.2), correlation=-0.9987)
    said = texts(plot_correlation(strong, tmp_path / "c.svg"))
    assert said.splitlines().count("−.9987") == 2  # not -1.00, which would be a tie
    assert texts(plot_correlation(FIT, tmp_path / "d.svg")).splitlines().count(".30") == 2


def test_a_large_correlation_has_colours_only(tmp_path: Path) -> None:
    fit = made_fit({f"p{n}": 1.0 for n in range(17)}, [0.1] * 17)
    assert ".30" not in texts(plot_correlation(fit, tmp_path / "c.svg"))


def test_convergence_has_criterion_and_values(tmp_path: Path) -> None:
    said = texts(plot_convergence(FIT, tmp_path / "c.svg")).splitlines()
    for words in ("best criterion", "off the last value", "evaluations of the criterion", "J"):
        assert words in said
    assert "0.1" in said


def test_a_criterion_of_zero_and_a_single_step_are_drawn(tmp_path: Path) -> None:
    one = replace(FIT.history[0], criterion=0.0, values={"k": 0.0})
    assert plot_convergence(replace(FIT, history=(one,)), tmp_path / "c.png").is_file()


def test_what_cannot_be_drawn_is_told(tmp_path: Path) -> None:
    file = tmp_path / "x.png"
    with pytest.raises(OptionError, match="a figure of no parameters cannot be drawn"):
        plot_parameters(made_fit({}, (), bounds={}), file)
    with pytest.raises(OptionError, match=r"needs two parameters. Free a second parameter."):
        plot_correlation(made_fit({"k": 1.0}, (0.1,)), file)
    with pytest.raises(OptionError, match="no history of its search"):
        plot_convergence(replace(FIT, history=()), file)
    with pytest.raises(OptionError, match=r"no measured signal cannot be drawn. Compare at least"):
        plot_comparisons(file, [])
    assert not file.exists()


def test_a_comparison_names_series_use_noise_and_burn_in(tmp_path: Path) -> None:
    shown = [compared("run", sigma=0.05, burn=5), compared("hold", "validate", "v", 40)]
    said = texts(plot_comparisons(tmp_path / "c.svg", shown, "A swing")).splitlines()
    for words in (
        "A swing", "train: run", "validate: hold", "measured", "before", "after",
        "does not count", "±2 σ", "x [rad]", "v [rad]",
        "rms of the residual before: 0.2 rad, after: 0.1 rad",
    ):  # fmt: skip
        assert any(words in line for line in said), words
    assert sum("does not count" in line for line in said) == 1
    assert any(line.endswith(" σ") and "before: " in line for line in said)


def test_a_signal_modulo_a_period_is_drawn_on_its_branch(tmp_path: Path) -> None:
    """The residual does not see the jumps of the measurement by 2 pi."""
    turning = compared(count=200, period=2 * np.pi)
    assert np.ptp(turning.measured) < 2 * np.pi < np.ptp(turning.after)
    said = texts(plot_comparisons(tmp_path / "c.svg", [turning]))
    assert "before: 0.2 rad, after: 0.1 rad" in said


def test_runs_that_failed_and_long_series_are_drawn(tmp_path: Path) -> None:
    failed = replace(compared(), before=np.full(21, np.nan), after=np.full(21, np.nan))
    far = replace(compared(), before=np.geomspace(1, 1e200, 21))
    long = compared(count=20_000, sigma=0.1)
    said = texts(plot_comparisons(tmp_path / "c.svg", [failed, far, long]))
    assert "before: no run, after: no run" in said
    assert (tmp_path / "c.svg").stat().st_size < 2_000_000


def test_more_signals_than_are_readable_are_cut(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(comparison_figures.FIT, "most_comparisons", 2)
    said = texts(plot_comparisons(tmp_path / "c.svg", [compared(f"run_{n}") for n in range(3)]))
    assert "(the first 2 of 3 signals)" in said
    assert "run_2" not in said


@pytest.mark.parametrize(
    ("counts", "spans"),
    [
        ([1, 1, 1, 1, 1], []),
        ([0, 0, 1, 1, 1], [(0.0, 1.5)]),
        ([1, 0, 0, 1, 0], [(0.5, 2.5)]),  # a single sample that does not count is pale only
        ([0, 0, 0, 0, 0], [(0.0, 4.0)]),
    ],
)
def test_stretches_that_do_not_count(counts: list[int], spans: list[tuple[float, float]]) -> None:
    assert _uncounted(np.arange(5.0), np.array(counts, dtype=bool)) == spans


def test_long_names_lose_their_middle() -> None:
    assert cut("short") == "short"
    name = cut("subsystem.left.friction.coulomb_level")
    assert len(name) <= 24
    assert name.startswith("subsystem")
    assert name.endswith("level")


def test_no_figure_stays_open(tmp_path: Path) -> None:
    plot_comparisons(tmp_path / "c.png", [compared()])
    plot_parameters(FIT, tmp_path / "p.png")
    assert pyplot.get_fignums() == []
