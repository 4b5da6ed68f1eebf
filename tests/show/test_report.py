"""Reports are documents that say what was done, with tables, and figures beside them."""

from __future__ import annotations

import html.parser
import math
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import OptionError
from tracewire.fit import Comparison, Fit
from tracewire.show import Report, report
from tracewire.show.document import Figure, Section
from tracewire.show.report import (
    comparison_table,
    fit_table,
    fit_tables,
    fit_text,
    trace_text,
)
from tracewire.show.summary import Table
from tracewire.solve import simulate
from tracewire.trace import Found, FoundEffect
from tracewire.trace.found import HeldOut, Ranked

TEXT = """\
title: Swing & rest
span: [0, 2]
parameters: {k: {value: 4, unit: N m/rad, fit: [0, 10]}, J: {value: 1, unit: kg m^2, fit: free}}
blocks:
  x: {type: integrator, of: v, start: 1, unit: rad}
  v: {type: integrator, of: a}
  a: {type: expression, formula: -k/J*x}
"""
MODEL = compile(read_text(TEXT))
T = np.linspace(0, 2, 21)
X = np.cos(2 * T)
FIT = Fit(
    model=MODEL,
    method="fminsearch",
    measured=(),
    began={"k": 4.0, "J": 1.0, "offset.x": 0.0},
    values={"k": 10.0, "J": 2.0, "offset.x": 0.1},
    errors={"k": 0.25, "J": math.nan, "offset.x": 0.01},
    bounds={"k": (0.0, 10.0), "J": (-math.inf, math.inf), "offset.x": (-1.0, 1.0)},
    starts={},
    criterion_before=0.5,
    criterion=0.005,
    evaluations=42,
    iterations=21,
    exitflag=1,
    message="It\nconverged.\n",
    seconds=1.25,
    comparisons=(Comparison("run", "train", "x", "rad", T, X, X + 0.2, X + 0.1),),
)
FOUND = Found(
    verdict="effect",
    effects=(FoundEffect("coulomb", "a", {"level": 0.25}, ("bias @ a",)),),
    dropped=("c",),
    values={"k": 4.5, "coulomb.level": 0.25},
    declared={"k": 4.0},
    rmse_before=0.2,
    rmse_after=0.1,
    sigma={"x": 0.05},
    s2_before=16.0,
    s2_after=4.0,
    fitted_before=0.2,
    fitted_after=0.1,
    ranking=(Ranked("coulomb @ a", -120.0, 4.0, "gate: accepted"),),
    held_out=(HeldOut("run", "x", "rad", T, X, X + 0.2, X + 0.1),),
    words=("the last sixth of 'run' is held back",),
    original=MODEL.diagram,
    diagram=read_text(TEXT.replace("value: 4,", "value: 4.5,")),
)


class Outline(html.parser.HTMLParser):
    """The text of a page by tag; it fails where tags do not match."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.texts: dict[str, list[str]] = {}
        self.images: list[str] = []
        self.feed(page)
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "img":
            self.images.append(str(dict(attrs)["src"]))
        elif tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and data.strip():
            self.texts.setdefault(self.open[-1], []).append(data)


DOCUMENT = Report(
    "A < B",
    (
        Section(
            "First",
            ("One & one.",),
            (Table("sizes", ("name", "size"), (("a|b", "1"), ("<i>", "2")), frozenset({1})),),
            "x < y\n",
            (Figure("f.png", "A figure", lambda path: path.write_bytes(b"drawn")),),
        ),
        Section("Second"),
    ),
)


def test_a_report_is_markdown(tmp_path: Path) -> None:
    path = DOCUMENT.write(tmp_path / "report.md")
    assert path.read_text(encoding="utf-8").splitlines() == [
        "# A < B", "", "## First", "", "One & one.", "", "**sizes**", "",
        "| name | size |", "| --- | ---: |", "| a\\|b | 1 |", "| <i> | 2 |", "",
        "```", "x < y", "```", "", "![A figure](f.png)", "", "## Second",
    ]  # fmt: skip
    assert (tmp_path / "f.png").read_bytes() == b"drawn"


def test_a_report_is_html_with_escaped_text(tmp_path: Path) -> None:
    page = DOCUMENT.write(str(tmp_path / "report.html")).read_text(encoding="utf-8")
    outline = Outline(page.removeprefix("<!doctype html>"))
    assert outline.texts["h1"] == ["A < B"]
    assert outline.texts["h2"] == ["First", "Second"]
    assert outline.texts["p"] == ["One & one."]
    assert outline.texts["caption"] == ["sizes"]
    assert outline.texts["td"] == ["a|b", "1", "<i>", "2"]
    assert outline.texts["pre"] == ["x < y\n"]
    assert outline.texts["figcaption"] == ["A figure"]
    assert outline.images == ["f.png"]


def test_another_ending_is_told(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"unknown file ending '.pdf'. End it in .md or .html."):
        DOCUMENT.write(tmp_path / "report.pdf")


def test_a_folder_that_does_not_exist_is_told(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"cannot be written: No such file.*Name a folder that"):
        DOCUMENT.write(tmp_path / "no" / "report.md")


def test_a_run_as_a_report(tmp_path: Path) -> None:
    path = report(simulate(MODEL)).write(tmp_path / "run.md")
    text = path.read_text(encoding="utf-8")
    assert text.startswith("# Swing & rest\n")
    assert "From 0 to 2 s, 1001 samples. Events: none." in text
    assert (tmp_path / "run.png").is_file()


def test_the_text_of_a_fit_is_one_sentence() -> None:
    assert fit_text(FIT) == (
        "fminsearch: the criterion fell from 0.5 to 0.005, 100-fold, in 42 evaluations and 1.2 s: "
        "It converged."
    )
    assert "inf-fold" in fit_text(replace(FIT, criterion=0.0))


def test_the_table_of_a_fit_has_units_errors_and_bounds() -> None:
    assert fit_table(FIT).rows == (
        ("k", "4", "10", "0.25", "N m/rad", "at its bound"),
        ("J", "1", "2", "not determined", "kg m^2", ""),
        ("offset.x", "0", "0.1", "0.01", "rad", ""),
    )


@pytest.mark.parametrize(
    ("k", "remark"), [(9.9999999, "at its bound"), (9.99, ""), (0.0, "at its bound")]
)
def test_a_value_at_its_bound_is_marked(k: float, remark: str) -> None:
    assert fit_table(replace(FIT, values={"k": k})).rows[0][-1] == remark


def test_start_values_are_shown_where_they_were_fitted() -> None:
    assert [table.title for table in fit_tables(FIT)] == [
        "fitted parameters",
        "measured against simulated",
    ]
    started = replace(FIT, starts={"run": {"x": 1.25}, "fixed": {}})
    assert fit_tables(started)[1].rows == (("run", "x", "1.25", "rad"),)


def test_the_comparison_has_errors_by_series_and_signal() -> None:
    assert comparison_table(FIT).rows == (("run", "train", "x", "rad", "0.2", "0.1"),)


def test_a_fit_as_a_report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = report(FIT).write(tmp_path / "fit.md").read_text(encoding="utf-8")
    assert text.startswith("# Fit of Swing & rest\n")
    for words in ("mean(residual²)/2", "**fitted parameters**", "Fix one of them", "(fit.png)"):
        assert words in text
    assert (tmp_path / "fit.png").is_file()
    seen: list[str] = []
    module = sys.modules["tracewire.show.report"]  # the attribute is the function
    monkeypatch.setattr(module, "plot_fit", lambda _, rows, *more: seen.extend(r[0] for r in rows))
    other = replace(FIT.comparisons[0], series="other", use="validate")
    report(replace(FIT, comparisons=(*FIT.comparisons, other))).write(tmp_path / "both.md")
    assert seen == ["run: x", "other (validate): x"]
    known = replace(FIT, errors=dict.fromkeys(FIT.errors, 0.1))
    assert "Fix one of them" not in report(known).markdown()


def test_a_trace_as_a_report(tmp_path: Path) -> None:
    text = report(FOUND).write(tmp_path / "trace.md").read_text(encoding="utf-8")
    assert text.startswith("# Trace of Swing & rest\n")
    for words in (
        "At a: coulomb with level 0.25 (SI). Went to zero: c.",
        "the error goes from 0.2 to 0.1",
        "these effects are not the whole truth",
        "The last sixth of 'run' is held back.",
        "| coulomb | a | level = 0.25 | bias @ a |",
        "| k | 4 | 4.5 |",
        "BIC is relative to the diagram before them",
        "| coulomb @ a | -120 | 4 | gate: accepted |",
        "+parameters: {k: {value: 4.5,",
        "(held_out.png)",
        "(residual.png)",
    ):
        assert words in text
    assert (tmp_path / "held_out.png").is_file()
    assert (tmp_path / "residual.png").is_file()


@pytest.mark.parametrize(
    ("verdict", "said"),
    [
        ("null", "Nothing is missing beyond the noise of the data."),
        ("unexplained", "Something is missing, and no effect of the library explains it."),
    ],
)
def test_a_verdict_without_effects(verdict: Any, said: str) -> None:
    found = replace(
        FOUND, verdict=verdict, effects=(), dropped=(), ranking=(), diagram=FOUND.original
    )
    assert trace_text(found)[0] == said
    assert "whole truth" not in " ".join(trace_text(found))
    headings = [section.heading for section in report(found).sections]
    assert headings == ["Verdict"]
