"""The report of a trace has the answer first, and a figure for all that can be drawn."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from show.traces import FOUND, NULL, UNEXPLAINED, missing_of_two
from tracewire.show import report
from tracewire.show.trace_figures import (
    plot_candidates,
    plot_forces,
    plot_free_runs,
    plot_residuals,
)
from tracewire.show.trace_maps import (
    drawable,
    plot_confusable,
    plot_experiments,
    plot_missing,
    plot_where,
)
from tracewire.trace import Found

Draw = Callable[[Found, Path], Path]


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[[Draw, Found], Any]:
    """The figure that a function draws, as matplotlib has it."""
    kept: list[Any] = []

    def save(figure: Any, path: Path) -> Path:
        figure.savefig(path)
        kept.append(figure)
        return path

    for module in ("trace_figures", "trace_maps", "comparison_figures"):
        monkeypatch.setattr(f"tracewire.show.{module}.save", save)

    def draw(function: Draw, found: Found) -> Any:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            function(found, tmp_path / "drawn.png")
        return kept[-1]

    return draw


def headings(found: Found) -> list[str]:
    return [section.heading for section in report(found).sections]


def figures(found: Found) -> list[str]:
    return [figure.name for figure in report(found).figures]


def test_an_effect_is_reported_with_the_answer_first(tmp_path: Path) -> None:
    text = report(FOUND).write(tmp_path / "trace.md").read_text(encoding="utf-8")
    assert text.startswith("# Trace of Swing & rest\n\n## What was found\n\n'Swing & rest' was")
    for words in (
        "- VERDICT effect: coulomb @ torque is missing",
        "- every third window of the train series is kept back as the gate.",
        "| coulomb | torque | level | 0.25 | 0.243 to 0.257 | N m | 905.3 | 62 % | 0.97 |",
        "step 2          windows of 1.5 s",
        "+  coulomb: {type: coulomb, rate: omega, level: {value: 0.25}}",
    ):
        assert words in text
    for name in figures(FOUND):
        assert (tmp_path / name).stat().st_size > 1000


def test_a_report_has_the_sections_that_there_is_something_to_say_in() -> None:
    assert headings(FOUND) == [
        "What was found", "How well it predicts", "The effects", "What these data leave open",
        "How it was found", "The change of the diagram", "What the words mean",
    ]  # fmt: skip
    assert headings(NULL) == [
        "What was found", "How well it predicts", "What these data leave open", "How it was found",
        "What the words mean",
    ]  # fmt: skip
    assert headings(UNEXPLAINED)[1] == "Where, and on what it depends"


def test_a_figure_is_drawn_for_what_there_is() -> None:
    assert figures(FOUND) == [
        "trace_free_runs.png", "trace_residuals.png", "trace_forces.png", "trace_confusable.png",
        "trace_experiments.png", "trace_candidates.png",
    ]  # fmt: skip
    assert figures(NULL) == ["trace_free_runs.png", "trace_residuals.png"]
    assert {"trace_where.png", "trace_missing.png"} < set(figures(UNEXPLAINED))
    bare = replace(NULL, curves=(), errors=(), power=(), steps=())
    assert figures(bare) == []


def test_what_depends_on_no_number_has_no_curve() -> None:
    assert UNEXPLAINED.missing is not None
    history = replace(UNEXPLAINED.missing, variables=("history",), grid=())
    assert "trace_missing.png" not in figures(replace(UNEXPLAINED, missing=history))


def test_residuals_are_those_of_the_windows_before_and_after(drawn: Any) -> None:
    figure = drawn(plot_residuals, FOUND)
    assert len(figure.axes) == 3
    panel, curve = figure.axes[0], FOUND.curves[0]
    before, after = (line.get_ydata() for line in panel.lines if len(line.get_ydata()) > 2)
    np.testing.assert_array_equal(before, curve.windowed_before)
    np.testing.assert_array_equal(after, curve.windowed_after)
    edges = [line.get_xdata()[0] for line in panel.lines if line.get_color() == "white"]
    np.testing.assert_array_equal(edges, curve.edges)
    rms = np.sqrt(np.mean(curve.windowed_before**2))
    assert f"train: swing_1, theta: rms {rms:.3g} σ before" in panel.get_title(loc="left")


def test_residuals_far_apart_are_both_seen(drawn: Any) -> None:
    far = replace(FOUND.curves[0], windowed_before=300 * FOUND.curves[0].windowed_before)
    assert drawn(plot_residuals, FOUND).axes[0].get_yscale() == "linear"
    figure = drawn(plot_residuals, replace(FOUND, curves=(far,)))
    assert figure.axes[0].get_yscale() == "symlog"


def test_residuals_with_gaps_and_several_uses_are_drawn(drawn: Any) -> None:
    curve = FOUND.curves[0]
    left = np.where(curve.t > 5, np.nan, curve.windowed_after)
    split = replace(
        curve, windowed_before=left, windowed_after=left, spans=((0, 4, "train"), (4, 5, "gate"))
    )
    panel = drawn(plot_residuals, replace(FOUND, curves=(split,))).axes[0]
    assert "nan" not in panel.get_title(loc="left")


def test_the_declared_model_alone_is_not_called_before(drawn: Any) -> None:
    panel = drawn(plot_residuals, NULL).axes[0]
    assert "before" not in panel.get_title(loc="left")
    assert [text.get_text() for text in panel.get_legend().texts] == ["declared model", "±2 σ"]


def test_free_runs_are_those_on_data_that_played_no_part(drawn: Any) -> None:
    figure = drawn(plot_free_runs, FOUND)
    assert len(figure.axes) == 2
    lines = {line.get_label(): line.get_ydata() for line in figure.axes[0].lines}
    curve = FOUND.curves[2]
    np.testing.assert_allclose(lines["measured"], curve.measured)
    np.testing.assert_allclose(lines["before"], curve.before)
    np.testing.assert_allclose(lines["after"], curve.after)
    train = drawn(plot_free_runs, replace(FOUND, curves=FOUND.curves[:2]))
    assert [text.get_text().strip() for text in train.axes[0].texts] == ["gate: swing_2"]


def test_candidates_have_bars_as_long_as_their_gain(drawn: Any) -> None:
    left, right = drawn(plot_candidates, FOUND).axes
    assert [bar.get_width() for bar in left.patches] == [905.3, 640.5, 433.0, 88.0]
    assert [line.get_xdata()[0] for line in left.lines[:6]] == [812, 640, 510, 120, 30, 12]
    assert [bar.get_width() for bar in right.patches] == pytest.approx([62, 21, 71, 97, 12, 90])
    assert left.get_yticklabels()[0].get_text() == "coulomb @ torque"


def test_a_step_in_which_nothing_stands_out_is_drawn_only_alone(drawn: Any) -> None:
    quiet = replace(FOUND.steps[1], tried=FOUND.steps[0].tried[4:])
    assert len(drawn(plot_candidates, replace(FOUND, steps=(FOUND.steps[0], quiet))).axes) == 2
    left, _ = drawn(plot_candidates, replace(FOUND, steps=(quiet,))).axes
    assert left.get_title(loc="left").startswith("step 1: nothing stands out")


def test_the_needed_torque_stands_over_coordinate_and_rate(drawn: Any) -> None:
    left, right = drawn(plot_forces, FOUND).axes
    force = FOUND.forces[0]
    for panel, values in ((left, force.q), (right, force.v)):
        np.testing.assert_array_equal(panel.lines[0].get_xdata(), values)
        np.testing.assert_array_equal(panel.lines[0].get_ydata(), force.needed)
        law = next(line for line in panel.lines if line.get_label() == "fitted effect")
        np.testing.assert_array_equal(law.get_ydata(), force.fitted)
    assert left.get_ylabel() == "missing at torque [N m]"
    assert (left.get_xlabel(), right.get_xlabel()) == ("theta [rad]", "omega [rad/s]")


def test_the_mean_in_bins_is_that_of_the_law_within_its_error(drawn: Any) -> None:
    right = drawn(plot_forces, FOUND).axes[1]
    line, _, bars = right.containers[0]
    rates, means = line.get_xdata(), line.get_ydata()
    assert len(rates) == 16
    away = np.abs(rates) > 0.2
    np.testing.assert_allclose(means[away], -0.25 * np.sign(rates[away]), atol=0.02)
    ends = np.array([bar[:, 1] for bar in bars[0].get_segments()])
    np.testing.assert_allclose(ends.mean(axis=1), means)


def test_one_spike_does_not_flatten_the_law(drawn: Any) -> None:
    force = FOUND.forces[0]
    needed = force.needed.copy()
    needed[100] = 1e3
    panel = drawn(
        plot_forces, replace(FOUND, find_forces=lambda: (replace(force, needed=needed),))
    ).axes[0]
    assert panel.get_ylim()[1] < 1


def test_the_map_has_the_share_of_each_place_and_set(drawn: Any) -> None:
    panel = drawn(plot_where, UNEXPLAINED).axes[0]
    shares = panel.images[0].get_array()
    assert shares[0, 0] == 0.97
    assert np.ma.count_masked(np.ma.masked_invalid(shares)) == 6  # not every place has every set
    assert [t.get_text() for t in panel.get_yticklabels()] == ["torque", "sensor.theta"]
    assert {"97 %", "74 %", "0 %"} <= {text.get_text() for text in panel.texts}
    (outline,) = panel.patches
    assert outline.get_x() < 0 < outline.get_x() + outline.get_width()


def test_what_is_missing_is_drawn_over_one_and_two_variables(drawn: Any) -> None:
    panel = drawn(plot_missing, UNEXPLAINED).axes[0]
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("q", "missing at torque [N m]")
    both = replace(UNEXPLAINED, missing=missing_of_two())
    panel = drawn(plot_missing, both).axes[0]
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("q", "v")


def test_effects_that_are_alike_are_outlined(drawn: Any) -> None:
    panel = drawn(plot_confusable, FOUND).axes[0]
    assert len(panel.patches) == 6  # three pairs above 0.985, each twice
    nines = panel.images[0].get_array()
    assert nines[0, 1] == pytest.approx(-np.log10(1 - 0.991))
    assert {".991", ".999", ".500"} <= {text.get_text() for text in panel.texts}


def test_an_experiment_over_one_setting_is_a_curve_with_its_best(drawn: Any) -> None:
    panel = drawn(plot_experiments, FOUND).axes[0]
    star = panel.lines[1]
    assert (star.get_xdata()[0], star.get_ydata()[0]) == (0.2, 6.9)
    assert panel.get_xlabel() == "start.theta"


def test_an_experiment_over_two_settings_is_a_map(drawn: Any) -> None:
    rows = tuple(
        {"amplitude": a, "frequency": f, "separation": a / f}
        for a in (0.1, 1.0, 9.0)
        for f in (1, 3)
    )
    best = replace(
        FOUND.experiments[0],
        settings={"amplitude": 9.0, "frequency": 1.0},
        separation=9.0,
        map=rows,
    )
    panel = drawn(plot_experiments, replace(FOUND, experiments=(best,))).axes[0]
    shown = panel.collections[0].get_array()
    np.testing.assert_allclose(shown, [row["separation"] for row in rows])
    assert (panel.get_xscale(), panel.get_yscale()) == ("log", "linear")
    assert not drawable(replace(best, map=()))
    assert not drawable(replace(best, map=rows[:1]))
