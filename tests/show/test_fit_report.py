"""A fit is told in tables, sentences and a report that a student can read and repeat."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tracewire as tw
from show.fits import TEXT, compared, made_fit
from tracewire.diagram import read_text
from tracewire.fit import Fit
from tracewire.fit.combinations import Direction
from tracewire.fit.profile import Profile
from tracewire.show import report
from tracewire.show.fit_tables import (
    comparison_table,
    fit_table,
    fit_tables,
    fit_text,
    fit_words,
    round_by_error,
    starts_table,
    tied_table,
)

FIT = made_fit()
NOT_A_NUMBER = re.compile(r"\b(nan|inf)\b", re.IGNORECASE)


def with_uncertainty(fit: Fit, **changes: Any) -> Fit:
    return replace(fit, uncertainty=replace(fit.uncertainty, **changes))


def cells(fit: Fit) -> str:
    tables = fit_tables(fit)
    return "\n".join(cell for table in tables for row in table.rows for cell in row)


def test_the_text_of_a_fit_is_one_sentence() -> None:
    assert fit_text(FIT) == (
        "fminsearch: the criterion fell from 0.5 to 0.005, 100-fold, in 42 evaluations and 1.2 s: "
        "It converged."
    )


def test_a_criterion_of_zero_has_no_fold() -> None:
    said = fit_text(replace(FIT, criterion=0.0))
    assert "from 0.5 to 0 in 42 evaluations" in said


def test_a_search_that_found_nothing_better_is_told() -> None:
    assert "stayed at 0.5: nothing better was found" in fit_text(replace(FIT, criterion=0.5))


def test_the_table_of_a_fit_has_errors_intervals_units_and_remarks() -> None:
    assert fit_table(FIT).rows == (
        ("k", "4", "10", "0.25", "9.5 to 10.5", "N m/rad", ""),
        ("J", "1", "2", "–", "not determined", "kg m^2", ""),
        ("offset.x", "0", "0.1", "0.01", "0.08 to 0.12", "rad", ""),
    )


def test_what_the_data_do_not_determine_is_told_with_its_partners() -> None:
    direction = Direction(("k", "J"), (0.7, 0.7), 1e9, "")
    fit = made_fit(errors=(math.nan, math.nan, 0.01))
    fit = replace(fit, bounds=dict.fromkeys(fit.values, (-math.inf, math.inf)))
    rows = fit_table(with_uncertainty(fit, directions=(direction,))).rows
    assert [row[-1] for row in rows] == ["only together with J", "only together with k", ""]
    rows = fit_table(with_uncertainty(fit, unmoved=("J",))).rows
    assert rows[1][-1] == "no effect on the data"


def test_a_value_at_its_bound_is_marked() -> None:
    rows = fit_table(with_uncertainty(FIT, at_bounds=("k",))).rows
    assert [row[-1] for row in rows] == ["at its bound", "", ""]


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (1.23456789, 1e-7, "1.23456789"),
        (1.23456789, 0.1, "1.23457"),
        (1.23456789, math.nan, "1.23457"),
        (0.0, 0.1, "0"),
        (math.pi, 1e-30, "3.14159265359"),
    ],
)
def test_a_value_has_the_digits_that_its_error_leaves(
    value: float, error: float, text: str
) -> None:
    assert round_by_error(value, error) == text


@pytest.mark.parametrize(
    ("name", "unit"), [("offset.x", "rad"), ("gain.x", ""), ("delay.x", "s"), ("k", "N m/rad")]
)
def test_sensors_have_units(name: str, unit: str) -> None:
    fit = made_fit({name: 1.0}, (0.1,))
    assert fit_table(fit).rows[0][5] == unit


def test_parameters_that_follow_from_fitted_ones_are_shown() -> None:
    assert tied_table(FIT).rows == (("w0", "sqrt(k/J)", "2", "2.23607", "rad/s"),)


def test_start_values_are_shown_where_they_were_fitted() -> None:
    started = replace(FIT, starts={"run": {"x": 1.25}, "fixed": {}})
    assert starts_table(started).rows == (("run", "x", "1.25", "rad"),)
    assert starts_table(FIT) not in fit_tables(FIT)


def test_the_comparison_has_errors_by_series_and_signal() -> None:
    assert comparison_table(FIT).rows == (("run", "train", "x", "21", "rad", "0.2", "0.1"),)


def test_the_comparison_is_in_sigma_where_one_is_declared() -> None:
    plain = compared("hold", "validate", burn=11)
    known = replace(plain, series="run", sigma=0.05)
    assert [row[3:] for row in comparison_table(replace(FIT, comparisons=(known, plain))).rows] == [
        ("10", "rad", "0.2", "0.1", "4", "2"),
        ("10", "rad", "0.2", "0.1", "", ""),
    ]


def test_no_table_shows_what_is_not_a_number() -> None:
    failed = compared(sigma=0.1)
    failed = replace(failed, before=np.full(21, np.nan), after=np.full(21, np.inf))
    empty = replace(compared(), counts=np.zeros(21, dtype=bool))
    fit = made_fit(errors=(math.nan,) * 3, comparisons=(failed, empty))
    assert not NOT_A_NUMBER.search(cells(fit))
    assert cells(fit).count("no run") == 4


def test_the_words_of_a_fit_have_open_combinations_and_what_was_odd() -> None:
    said = fit_words(replace(FIT, remarks=("3 runs failed",)))
    for words in (
        "Only k/J is determined: fix J or k.",
        "3 runs failed.",
        "run: the time base jitters by 2 %.",
    ):
        assert words in said


def test_the_report_tells_what_was_fitted_and_each_step(tmp_path: Path) -> None:
    text = report(FIT).write(tmp_path / "fit.md").read_text(encoding="utf-8")
    assert text.startswith("# Fit of Swing & rest\n")
    for words in (
        "**fitted parameters**",
        "- Only k/J is determined: fix J or k.",
        "1 of 3 values have no interval: J.",
        "data/swing.csv",
        "- run: resampled to 10 ms by linear interpolation.",
        "offset fitted, delay 0.01 s",
        "none tests it",
        "mean(residual²)/2",
    ):
        assert words in text
    assert text.index("(fit_diagram.svg)") < text.index("## Result")
    for figure in (
        "fit_diagram.svg",
        "fit.png",
        "fit_parameters.png",
        "fit_correlation.png",
        "fit_convergence.png",
    ):
        assert f"({figure})" in text
        assert (tmp_path / figure).is_file()
    assert not NOT_A_NUMBER.search(text)


def test_the_report_as_html_is_one_file(tmp_path: Path) -> None:
    page = report(FIT).write(tmp_path / "fit.html").read_text(encoding="utf-8")
    assert page.count('src="data:image/png;base64,') >= 4
    assert page.count('<img class="drawing" src="data:image/svg+xml;base64,') == 1
    assert list(tmp_path.iterdir()) == [tmp_path / "fit.html"]


@pytest.mark.parametrize(
    ("exitflag", "said"), [(0, "A limit ended the search"), (-1, "The search was stopped")]
)
def test_a_search_that_did_not_converge_is_told(exitflag: int, said: str) -> None:
    assert said in report(replace(FIT, exitflag=exitflag)).markdown()
    assert said not in report(FIT).markdown()


def test_strong_correlation_and_coloured_residuals_are_told() -> None:
    fit = made_fit({"k": 1.0, "J": 2.0}, (0.1, 0.2), correlation=0.99)
    said = report(with_uncertainty(fit, orders={("run", "x"): 2})).markdown()
    assert "The data determine every fitted value." in said
    assert "Strongly correlated: k and J (0.99)." in said
    assert "The residual of x of run is correlated in time" in said


def test_untouched_data_and_a_series_for_validation_are_told() -> None:
    fit = made_fit(comparisons=(compared(), compared("hold", "validate", burn=3)))
    fit = replace(fit, measured=tuple(replace(m, steps=()) for m in fit.measured))
    said = report(fit).markdown()
    assert "train: run; validate: hold" in said
    assert "- hold: nothing was changed since the file was read." in said
    assert "Samples before the one from which a series counts are pale" in said
    assert "none tests it" not in said


def test_what_is_left_is_told_by_series_and_signal() -> None:
    said = fit_words(FIT)
    assert any(text.startswith("run (train), x: ") and "correlated" in text for text in said)
    window = fit_words(made_fit(comparisons=(compared("run (train)"),)))
    assert any(text.startswith("run (train), x: ") for text in window), "it has its use in its name"
    assert "(residual.png)" in report(FIT).markdown()
    short = made_fit(comparisons=(compared(count=5),))
    assert "No signal has enough samples" in report(short).markdown()


def test_profiles_are_in_the_report_where_they_were_computed(tmp_path: Path) -> None:
    x = np.linspace(-2.5, 2.5, 11)
    one = Profile("k", 10 + x, x**2, {}, (8.0, 12.0), 4.0, "k lies between 8 and 12 (SI, 95 %)")
    text = report(FIT, profiles=[one]).write(tmp_path / "fit.md").read_text(encoding="utf-8")
    assert "- k lies between 8 and 12 (SI, 95 %)." in text
    assert (tmp_path / "fit_profiles.png").is_file()
    assert "profiles.png" not in report(FIT).markdown()


def test_a_fit_of_start_values_only_has_a_report(tmp_path: Path) -> None:
    fit = replace(made_fit({}, (), bounds={}), starts={"run": {"x": 1.25}}, history=())
    text = report(fit).write(tmp_path / "fit.md").read_text(encoding="utf-8")
    assert "fitted start values" in text
    assert "fitted parameters" not in text


def test_the_code_in_the_report_repeats_the_fit(tmp_path: Path) -> None:
    """Run as a program, beside the diagram, it begins where this fit did and has its seed."""
    file = tmp_path / "swing.yaml"
    file.write_text(TEXT, encoding="utf-8")
    model = tw.compile(read_text(TEXT, file))
    fit = replace(
        made_fit(model=model), model=model, began={"k": 5.0, "J": 1.0, "offset.x": 0.0}, seed=7
    )
    (section,) = (s for s in report(fit).sections if s.heading == "How to repeat it")
    called: dict[str, Any] = {}

    class Stub:
        read, compile = staticmethod(tw.read), staticmethod(tw.compile)

        @staticmethod
        def fit(model: object, **arguments: Any) -> None:
            called.update(arguments)

        @staticmethod
        def report(_: object) -> Any:
            return type("Written", (), {"write": staticmethod(lambda path: path)})

    exec(section.code.replace("import tracewire as tw", ""), {"tw": Stub})
    assert called == {
        "method": "fminsearch", "free": ["k", "J"], "parameters": {"k": 5.0}, "seed": 7,
        "rtol": 1e-6,
    }  # fmt: skip
