"""`paper a`, `paper b`, `paper c`: what is printed and written, and what is said when wrong."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from tracewire.diagram import read_text
from tracewire.paper import figure_of, reproduction

SWING = """
title: Pendulum
span: [0, 20]
blocks: {phi: {type: integrator, of: w, start: 1}, w: {type: expression, formula: -phi}}
expect:
  - {name: C07 one, says: It swings., source: Eq 8, that: "at(phi, 0)", above: 0.5, unit: s}
  - {name: C07 two, says: It stops., source: Eq 9, that: "2*at(phi, 0)", below: 0,
     erratum: A misprint.}
"""


@pytest.fixture(autouse=True)
def two_statements(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    diagram = read_text(SWING, Path("swing.yaml"))
    monkeypatch.setattr(reproduction, "diagrams_of", lambda paper: (diagram,))
    monkeypatch.setattr(reproduction, "figures_of", lambda paper: (figure_of(paper, "18"),))


def test_a_paper_prints_what_it_states_and_what_came_out(call: Any) -> None:
    found = call("paper", "c")
    assert found.code == 0
    assert all(text in found.out for text in ("C07 one", "1 s", "≥ 0.5 s", "agrees"))
    assert "C07 two: the print is wrong. A misprint." in found.out
    assert "2 statements: agrees: 1; the print is wrong: 1." in found.out
    assert "written: paper_c.html" in found.out
    assert "It swings." in Path("paper_c.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("ending", ["html", "md"])
def test_the_report_is_written(call: Any, tmp_path: Path, ending: str) -> None:
    file = tmp_path / f"c.{ending}"
    found = call("paper", "c", "--report", file)
    assert found.code == 0 and f"written: {file}" in found.out
    text = file.read_text(encoding="utf-8")
    assert "reproduction report" in text and "It swings." in text and "A misprint." in text
    assert "Fig. 18 of paper C" in text
    assert "data:image/png" in text if ending == "html" else (tmp_path / "c_18.png").exists()


def test_json_has_every_statement(call: Any, tmp_path: Path) -> None:
    file = tmp_path / "c.md"
    data = call("paper", "c", "--json", "--report", file).data
    assert [row["name"] for row in data["statements"]] == ["C07 one", "C07 two"]
    assert data["counts"]["agrees"] == 1
    assert data["written"] == [str(file)]


def test_a_report_of_another_ending_is_refused_before_the_work(call: Any, tmp_path: Path) -> None:
    found = call("paper", "c", "--report", tmp_path / "c.pdf")
    assert found.code == 2
    assert "unknown file ending '.pdf'. End the name of the report in .md or .html." in found.err


def test_an_unknown_paper_is_told_with_those_that_exist(
    call: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.undo()
    found = call("paper", "d")
    assert found.code == 2
    assert "unknown paper 'd'; there are: a, b, c" in found.err
