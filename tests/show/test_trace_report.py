"""The report of a trace has the answer first, and a figure for all that can be drawn."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from show.traces import FOUND, NULL, UNEXPLAINED, missing_of_two
from tracewire.show import report
from tracewire.show.trace_figures import plot_candidates, plot_free_runs, plot_residuals
from tracewire.show.trace_law import plot_forces, plot_law
from tracewire.show.trace_maps import (
    drawable,
    plot_confusable,
    plot_experiments,
    plot_missing,
    plot_remainder_where,
    plot_where,
)
from tracewire.show.trace_shares import plot_held_out
from tracewire.trace import Found
from tracewire.trace.found import Dependence, Explained, Force, HeldOut, Means, Remainder

Draw = Callable[[Found, Path], Path]


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[[Draw, Found], Any]:
    """The figure that a function draws, as matplotlib has it."""
    kept: list[Any] = []

    def save(figure: Any, path: Path) -> Path:
        figure.savefig(path)
        kept.append(figure)
        return path

    for module in (
        "trace_figures",
        "trace_law",
        "trace_maps",
        "trace_shares",
        "comparison_figures",
    ):
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


HELD_OUT = (
    HeldOut(0.5, ("swing_2",) * 6 + ("swing_3",) * 6, np.arange(12.0), np.full(12, 8.0),
            np.full(12, 1.4), np.full(12, 1.1)),
    HeldOut(5.0, ("swing_2",) * 3, np.arange(3.0), np.full(3, 40.0), np.full(3, 2.0), np.zeros(0)),
)  # fmt: skip
JUDGED = replace(
    FOUND,
    explained=Explained(0.98, 0.96, 0.99),
    remainder=(Remainder("theta", "rad", 0.005, 1.25, 0.04, 0.0045),),
    remainder_depends=(
        Dependence("torque", ("q", "v"), 0.35), Dependence("torque", ("q",), 0.05),
    ),
    held_out=HELD_OUT,
)  # fmt: skip
"""With what held-out blocks say."""


def test_an_effect_is_reported_with_the_answer_first(tmp_path: Path) -> None:
    text = report(FOUND).write(tmp_path / "swing.md").read_text(encoding="utf-8")
    assert text.startswith(
        "# Trace of Swing & rest\n\n## What was found\n\nThe diagram lacks 'coulomb' at the sum "
    )
    for words in (
        "VERDICT effect: coulomb @ torque is missing",
        "- every third window of the train series is kept back as the gate.",
        "| coulomb | torque | level | 0.2500 | 0.2430 to 0.2570 | N m | 62 % | 905.3 |",
        "step 2          windows of 1.5 s",
        "+  coulomb: {type: coulomb, rate: omega, level: {value: 0.25}}",
        "![The force that the data need, and the law that was found](swing_law.png)",
    ):
        assert words in text
    for name in figures(FOUND):
        assert (tmp_path / f"swing_{name}").stat().st_size > 1000
    picture = (tmp_path / "swing_diagram.svg").read_text(encoding="utf-8")
    assert 'class="block effect" data-block="coulomb"' in picture


def test_a_report_has_the_sections_that_there_is_something_to_say_in() -> None:
    assert headings(FOUND) == [
        "What was found", "The effects", "In words", "How well it predicts",
        "What these data leave open", "How it was found", "The change of the diagram",
        "What the words mean",
    ]  # fmt: skip
    assert headings(JUDGED)[:4] == [
        "What was found", "The effects", "How much of the error is explained", "What is left",
    ]  # fmt: skip
    assert headings(NULL) == [
        "What was found", "In words", "How well it predicts", "What these data leave open",
        "How it was found", "What the words mean",
    ]  # fmt: skip
    assert headings(UNEXPLAINED)[1] == "Where, and on what it depends"


def test_a_figure_is_drawn_for_what_there_is() -> None:
    assert figures(FOUND) == [
        "diagram.svg", "law.png", "forces.png", "free_runs.png", "residuals.png", "confusable.png",
        "experiments.png", "candidates.png",
    ]  # fmt: skip
    assert {"shares.png", "remainder.png"} < set(figures(JUDGED))
    assert figures(NULL) == ["diagram.svg", "free_runs.png", "residuals.png"]
    assert {"where.png", "missing.png"} < set(figures(UNEXPLAINED))
    bare = replace(NULL, curves=(), errors=(), power=(), steps=())
    assert figures(bare) == ["diagram.svg"]


def test_forces_that_cannot_be_computed_cost_their_figures_only(tmp_path: Path) -> None:
    def fail() -> tuple[Force, ...]:
        raise ZeroDivisionError("no window is left")

    told: list[str] = []
    broken = replace(FOUND, find_forces=fail)
    text = report(broken).write(tmp_path / "a.md", told.append).read_text(encoding="utf-8")
    said = "could not be drawn: ZeroDivisionError('no window is left')."
    assert [line.endswith(said) for line in told] == [True, True]
    assert told[0].startswith("The figure 'The force that the data need, and the law that was")
    assert told[0] in text
    assert "a_law.png" not in text
    assert (tmp_path / "a_free_runs.png").is_file()


def test_held_out_blocks_have_declared_best_and_floor_at_each_horizon(drawn: Any) -> None:
    share, short, long = drawn(plot_held_out, JUDGED).axes
    assert share.get_title(loc="left") == (
        "explained: 98 % (95 % interval: 96 to 99 %) of the excess error"
    )
    labels = {line.get_label(): line.get_ydata() for line in short.lines}
    assert list(labels["declared model"]) == [8.0] * 12
    assert list(labels["with the effects"]) == [1.4] * 12
    assert list(labels["floor: the best smooth map"]) == [1.1] * 12
    assert "floor: the best smooth map" not in [line.get_label() for line in long.lines]
    assert [text.get_text() for text in short.texts] == ["swing_2", "swing_3"]
    assert "predicted over 5 s" in long.get_title(loc="left")
    alone = drawn(plot_held_out, replace(JUDGED, explained=None)).axes
    assert len(alone) == 2


def test_the_map_of_the_remainder_has_its_shares(drawn: Any) -> None:
    panel = drawn(plot_remainder_where, JUDGED).axes[0]
    assert {"35 %", "5 %"} <= {text.get_text() for text in panel.texts}
    assert list(panel.patches) == []


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


def test_residuals_far_apart_are_on_one_linear_scale_and_the_small_one_enlarged(
    drawn: Any,
) -> None:
    far = replace(FOUND.curves[0], windowed_before=300 * FOUND.curves[0].windowed_before)
    assert len(drawn(plot_residuals, replace(FOUND, curves=(FOUND.curves[0],))).axes) == 1
    both, alone = drawn(plot_residuals, replace(FOUND, curves=(far,))).axes
    assert both.get_yscale() == alone.get_yscale() == "linear"
    assert both.get_ylim()[1] > far.windowed_before.max()
    assert far.windowed_after.max() < alone.get_ylim()[1] < 0.1 * both.get_ylim()[1]
    assert [text.get_text() for text in alone.get_legend().texts] == ["after", "±2 σ"]
    assert "enlarged" in alone.get_title(loc="left")


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


def test_free_runs_are_of_every_series_first_what_played_no_part(drawn: Any) -> None:
    figure = drawn(plot_free_runs, FOUND)
    titles = [text.get_text().strip() for panel in figure.axes for text in panel.texts]
    assert titles == ["validate: swing_3", "gate: swing_2", "train: swing_1"]
    lines = {line.get_label(): line.get_ydata() for line in figure.axes[0].lines}
    curve = FOUND.curves[2]
    np.testing.assert_allclose(lines["measured"], curve.measured)
    np.testing.assert_allclose(lines["before"], curve.before)
    np.testing.assert_allclose(lines["after"], curve.after)


def test_free_runs_have_the_residual_before_and_after_on_one_scale(drawn: Any) -> None:
    strip = drawn(plot_free_runs, FOUND).axes[1]
    curve = FOUND.curves[2]
    before, after = (line.get_ydata() for line in strip.lines if len(line.get_ydata()) > 2)
    np.testing.assert_allclose(before, curve.measured - curve.before)
    np.testing.assert_allclose(after, curve.measured - curve.after)
    low, high = strip.get_ylim()
    assert low < before.min()
    assert before.max() < high
    assert strip.get_yscale() == "linear"


def test_a_much_smaller_residual_after_is_enlarged_below(drawn: Any) -> None:
    strip, enlarged = drawn(plot_free_runs, FOUND).axes[1:3]  # they differ by a factor of 40
    curve = FOUND.curves[2]
    (after,) = (line.get_ydata() for line in enlarged.lines if len(line.get_ydata()) > 2)
    np.testing.assert_allclose(after, curve.measured - curve.after)
    assert enlarged.get_ylim()[1] < 0.2 * strip.get_ylim()[1]
    assert [text.get_text() for text in enlarged.get_legend().texts] == ["±2 σ"]
    assert "enlarged" in enlarged.get_title(loc="left")


def test_free_runs_are_in_the_unit_of_the_users_file(drawn: Any) -> None:
    degrees = replace(FOUND, users_units={"theta": ("deg", np.pi / 180)})
    upper, strip = drawn(plot_free_runs, degrees).axes[:2]
    assert (upper.get_ylabel(), strip.get_ylabel()) == ("theta [deg]", "residual\n[deg]")
    measured = next(line for line in upper.lines if line.get_label() == "measured")
    np.testing.assert_allclose(measured.get_ydata(), np.degrees(FOUND.curves[2].measured))


def test_laws_and_maps_are_over_variables_in_the_units_of_the_users_file(drawn: Any) -> None:
    own = {"theta": ("deg", np.pi / 180), "omega": ("rpm", np.pi / 30)}
    for plot, found in ((plot_law, FOUND), (plot_missing, UNEXPLAINED)):
        si, users = (drawn(plot, one).axes[0] for one in (found, replace(found, users_units=own)))
        assert users.get_xlabel() in ("theta [deg]", "omega [rpm]")
        factor = dict(own.values())[users.get_xlabel().partition("[")[2][:-1]]
        assert users.get_xlim() == pytest.approx([x / factor for x in si.get_xlim()])
        assert users.get_ylabel() == si.get_ylabel()


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


def test_the_needed_force_stands_over_coordinate_and_rate(drawn: Any) -> None:
    left, right = drawn(plot_forces, FOUND).axes
    force = FOUND.forces[0]
    for panel, values in ((left, force.q), (right, force.v)):
        samples = next(x for x in panel.lines if x.get_label() == "needed at each sample")
        np.testing.assert_array_equal(samples.get_xdata(), values)
        np.testing.assert_array_equal(samples.get_ydata(), force.needed)
        law = next(line for line in panel.lines if line.get_label() == "after: the fitted law")
        order = np.argsort(values, kind="stable")
        np.testing.assert_array_equal(law.get_ydata(), force.fitted[order])
    assert left.get_ylabel() == "needed at torque [N m]"
    assert (left.get_xlabel(), right.get_xlabel()) == ("theta [rad]", "omega [rad/s]")


def test_the_law_is_a_line_over_the_variable_on_which_it_depends(drawn: Any) -> None:
    (panel,) = drawn(plot_law, FOUND).axes
    assert panel.get_xlabel() == "omega [rad/s]"
    law = next(line for line in panel.lines if line.get_label() == "after: the fitted law")
    assert law.get_linestyle() == "-"
    before = next(line for line in panel.lines if line.get_label().startswith("before"))
    assert list(before.get_ydata()) == [0, 0]
    over_q = drawn(plot_forces, FOUND).axes[0]
    law = next(line for line in over_q.lines if line.get_label() == "after: the fitted law")
    assert law.get_linestyle() == "None"  # dry friction is no function of the coordinate


def test_the_mean_in_bins_is_that_of_the_law_within_its_error(drawn: Any) -> None:
    right = drawn(plot_forces, FOUND).axes[1]
    line, _, bars = right.containers[0]
    rates, means = line.get_xdata(), line.get_ydata()
    assert len(rates) == 24
    away = np.abs(rates) > 0.2
    np.testing.assert_allclose(means[away], -0.25 * np.sign(rates[away]), atol=0.03)
    ends = np.array([bar[:, 1] for bar in bars[0].get_segments()])
    np.testing.assert_allclose(ends.mean(axis=1), means)


def test_means_of_the_fit_are_drawn_in_place_of_those_of_samples(drawn: Any) -> None:
    at = np.array([-1.0, 0.0, 1.0])
    means = Means(at, np.array([0.25, 9.0, -0.25]), np.array([0.01, 5.0, 0.01]))
    noise = 50 * np.random.default_rng(1).standard_normal(len(FOUND.forces[0].needed))
    force = replace(FOUND.forces[0], means=(means, means))
    found = replace(FOUND, find_forces=lambda: (replace(force, needed=noise),))
    figure = drawn(plot_law, found)
    (panel,) = figure.axes
    np.testing.assert_array_equal(panel.containers[0][0].get_ydata(), means.mean)
    assert panel.get_ylim()[1] < 1  # a mean of which little is known sets no limits
    labels = [text.get_text() for text in figure.legends[0].texts]
    assert "needed at each sample" not in labels  # all noise
    figure = drawn(plot_law, replace(FOUND, find_forces=lambda: (force,)))
    assert "needed at each sample" in [text.get_text() for text in figure.legends[0].texts]


def test_axes_hold_the_means_and_the_law_and_not_the_scatter(drawn: Any) -> None:
    force = FOUND.forces[0]
    noise = 5 * np.random.default_rng(1).standard_normal(len(force.needed))
    noisy = replace(force, needed=force.needed + noise)
    low, high = drawn(plot_law, replace(FOUND, find_forces=lambda: (noisy,))).axes[0].get_ylim()
    assert np.max(noisy.needed) > 2 * high
    assert low < -0.25 < 0.25 < high


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
    assert (panel.get_xlabel(), panel.get_ylabel()) == (
        "theta [rad]", "missing at torque [N m]"
    )  # fmt: skip
    both = replace(UNEXPLAINED, missing=missing_of_two())
    panel = drawn(plot_missing, both).axes[0]
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("theta [rad]", "omega [rad/s]")


def no_labels_touch(figure: Any) -> bool:
    """Whether the numbers and names of the first panel's lower axis stand apart."""
    panel = figure.axes[0]
    labels = [one for one in panel.get_xticklabels() if one.get_text()]
    if any(one.get_rotation() for one in labels):  # slanted: their ends are as far as the columns
        return True
    boxes = sorted((one.get_window_extent() for one in labels), key=lambda box: box.x0)
    return all(one.x1 < other.x0 for one, other in pairwise(boxes))


def test_labels_of_maps_do_not_touch(drawn: Any) -> None:
    missing = missing_of_two()
    far = np.linspace(120000.1, 120000.9, missing.grid[0].size)
    far_off = replace(missing, grid=(far, missing.grid[1]))
    assert no_labels_touch(drawn(plot_missing, replace(UNEXPLAINED, missing=far_off)))
    names = ("travel", "rate", "travel, rate", "rate, history", "travel, history")
    sets = tuple(Dependence("torque", tuple(name.split(", ")), 0.5) for name in names)
    assert no_labels_touch(drawn(plot_where, replace(UNEXPLAINED, dependences=sets)))


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
    assert panel.get_xlabel() == "start.theta [rad]"


def test_an_experiment_that_tells_nothing_apart_is_not_drawn() -> None:
    assert drawable(FOUND.experiments[0])
    assert not drawable(replace(FOUND.experiments[0], separation=0.001))


def test_a_body_that_rests_does_not_make_a_map_pale(drawn: Any) -> None:
    assert UNEXPLAINED.missing is not None
    density = np.full(161, 30.0)
    density[80] = 1e4
    resting = replace(UNEXPLAINED, missing=replace(UNEXPLAINED.missing, density=density))
    panel = drawn(plot_missing, resting).axes[0]
    known = next(x for x in panel.lines if x.get_label() == "as the data ask for it").get_ydata()
    assert np.isfinite(known).sum() == 161


def test_of_an_experiment_only_what_is_like_the_best_is_drawn(drawn: Any) -> None:
    """Releases and drives have other settings: each has a map of its own."""
    rows = (
        *({"start.theta": a, "start.x": 2 * a, "separation": a} for a in (0.1, 0.5, 1.0)),
        *(
            {"F amplitude": a, "F frequency": f, "separation": a * f}
            for a in (1, 2)
            for f in (1, 3)
        ),
    )
    driven = replace(
        FOUND.experiments[0], settings={"F amplitude": 2, "F frequency": 3}, separation=6, map=rows
    )
    units = {**FOUND.units, "F": "N"}
    panel = drawn(plot_experiments, replace(FOUND, experiments=(driven,), units=units)).axes[0]
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("F amplitude [N]", "F frequency [Hz]")
    assert len(panel.collections[0].get_array()) == 4
    released = replace(driven, settings={"start.theta": 1.0, "start.x": 2.0}, separation=1.0)
    panel = drawn(plot_experiments, replace(FOUND, experiments=(released,), units=units)).axes[0]
    assert panel.get_xlabel() == "start.theta [rad]"
    assert list(panel.lines[0].get_xdata()) == [0.1, 0.5, 1.0]


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
