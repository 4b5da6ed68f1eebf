"""`tracewire check --expect`: the table, JSON, the exit code, and what is said when wrong."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import pytest

SWING = """\
title: Swing
span: [0, 10]
parameters: {w: {value: 2, unit: 1/s}}
blocks:
  x: {type: integrator, of: v, start: 1, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  a: {type: gain, of: x, k: -w**2}
"""
RIGHT = """\
expect:
  - {that: max(v), is: 2, within: 1 %, unit: m/s, source: Eq 3}
  - {name: rest, that: steady_stability(), is: neutral}
  - {that: min(x), above: 0, unit: m, erratum: It swings to both sides.}
"""
FALSE = "  - {that: period(x), is: 3, within: 0.1, unit: s}\n"
LOST = "  - {that: time(impact), above: 0}\n"


def diagram(folder: Path, statements: str, name: str = "swing.yaml") -> Path:
    file = folder / name
    file.write_text(SWING + statements, encoding="utf-8")
    return file


def test_a_table_tells_what_holds(call: Any, tmp_path: Path) -> None:
    told = call("check", "--expect", diagram(tmp_path, RIGHT))
    assert told.code == 0
    lines = told.out.splitlines()
    (row,) = [line.split("  ") for line in lines if line.strip().startswith("max(v)")]
    cells = [cell.strip() for cell in row if cell.strip()]
    assert cells == ["max(v)", cells[1], "2 ± 0.02 m/s", "yes", "Eq 3"]
    assert cells[1].startswith("1.99")
    assert any("no, as its erratum says" in line for line in lines)
    assert lines[-1] == "3 of 3 statements hold"


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (FALSE, "swing.yaml:12:12: period(x): 3 ± 0.1 was expected."),
        (LOST, "swing.yaml:12:12: time(impact): there is no event 'impact' number 1: there are 0."),
    ],
)
def test_the_exit_code_is_1_where_one_fails(
    call: Any, tmp_path: Path, more: str, said: str
) -> None:
    told = call("check", "--expect", diagram(tmp_path, RIGHT + more))
    assert told.code == 1
    assert said in told.out and "3 of 4 statements hold" in told.out


def test_json_has_every_statement_of_every_file(call: Any, tmp_path: Path) -> None:
    diagram(tmp_path, RIGHT)
    diagram(tmp_path, "expect:\n" + FALSE, "other.yaml")
    told = call("check", "--expect", tmp_path, "--json")
    assert told.code == 1
    assert told.data["holds"] is False
    assert told.data["counts"]["agrees"] == 2
    files = {Path(one["file"]).name: one["statements"] for one in told.data["diagrams"]}
    assert [row["name"] for row in files["swing.yaml"]] == ["max(v)", "rest", "min(x)"]
    (period,) = files["other.yaml"]
    assert period["value"] == pytest.approx(3.14159, abs=1e-3)
    assert (period["low"], period["high"], period["verdict"]) == (2.9, 3.1, "does not agree")


def test_a_solution_is_held_against_a_lesson(call: Any, tmp_path: Path) -> None:
    lesson = diagram(tmp_path, RIGHT, "lesson.yaml")
    right = diagram(tmp_path, "", "right.yaml")
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text(SWING.replace("-w**2", "-w"), encoding="utf-8")
    assert call("check", right, "--against", lesson).code == 0
    told = call("check", wrong, "--against", lesson)
    assert told.code == 1 and "2 of 3 statements hold" in told.out


def test_a_diagram_without_statements_is_told(call: Any, tmp_path: Path) -> None:
    told = call("check", "--expect", diagram(tmp_path, ""))
    assert (told.code, told.out) == (2, "")
    assert "there is no statement to check in" in told.err
    assert "Write expect: [{that: end(x), is: 2, within: 0.1}]" in told.err


@pytest.mark.parametrize("options", [("--expect",), ()])
def test_a_unit_that_is_not_that_of_the_quantity_is_refused(
    call: Any, tmp_path: Path, options: tuple[str, ...]
) -> None:
    statement = "expect: [{that: max(v), is: 2, within: 1, unit: m}]\n"
    told = call("check", *options, diagram(tmp_path, statement))
    assert told.code == 2
    assert "swing.yaml:8:17: 'max(v)' is in m/s, and its unit is 'm'" in told.err


def test_units_that_contradict_each_other_are_refused_as_without_statements(
    call: Any, tmp_path: Path
) -> None:
    wrong = "  odd: {type: sum, of: [x, v]}\nexpect: [{that: max(v), is: 2, within: 1}]\n"
    told = [call("check", *way, diagram(tmp_path, wrong)) for way in (["--expect"], [])]
    assert [one.code for one in told] == [2, 2]
    assert "'x' (line" in told[0].err and told[0].err == told[1].err


def test_a_diagram_from_stdin_is_measured(call: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    content = (SWING + RIGHT).encode()
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(content)))
    told = call("check", "--expect", "-")
    assert (told.code, told.err) == (0, "")
    assert told.out.splitlines()[-1] == "3 of 3 statements hold"


def test_all_files_that_are_wrong_are_told(call: Any, tmp_path: Path) -> None:
    unit = "expect: [{that: max(v), is: 2, within: 1, unit: m}]\n"
    wrong = diagram(tmp_path, unit, "unit.yaml")
    broken = diagram(tmp_path, "expect: [{that: max(q), above: 0}]\n", "name.yaml")
    told = call("check", "--expect", wrong, broken, tmp_path / "lost.yaml")
    assert (told.code, told.out) == (2, "")
    assert "'max(v)' is in m/s, and its unit is 'm'" in told.err
    assert "unknown signal or parameter 'q'" in told.err
    assert "lost.yaml" in told.err


def test_units_of_a_lesson_are_those_of_the_solution(call: Any, tmp_path: Path) -> None:
    lesson = diagram(tmp_path, RIGHT, "lesson.yaml")
    solution = tmp_path / "solution.yaml"
    solution.write_text(SWING.replace("m/s", "rad/s").replace("unit: m}", "unit: rad}"), "utf-8")
    told = call("check", solution, "--against", lesson)
    assert told.code == 2
    assert "lesson.yaml:9:12: 'max(v)' is in 1/s, and its unit is 'm/s'" in told.err


def test_a_solution_that_lacks_a_signal_of_the_lesson_does_not_hold(
    call: Any, tmp_path: Path
) -> None:
    lesson = diagram(tmp_path, RIGHT, "lesson.yaml")
    solution = tmp_path / "solution.yaml"
    solution.write_text(SWING.replace("v:", "rate:").replace("of: v", "of: rate"), encoding="utf-8")
    told = call("check", solution, "--against", lesson)
    assert told.code == 1 and "unknown signal 'v'" in told.out


def test_a_sweep_keeps_quantities(call: Any, tmp_path: Path) -> None:
    """The period is 2 pi/w, and the largest rate w."""
    file = diagram(tmp_path, "")
    keep = ("--keep", "period(x)", "--keep", "max(abs(v))/w")
    data = call("sweep", file, "--over", "w=2,4,8", *keep, "--json").data
    assert data["values"]["period(x)"] == pytest.approx([3.1416, 1.5708, 0.7854], rel=1e-3)
    assert data["values"]["max(abs(v))/w"] == pytest.approx([1, 1, 1], rel=1e-3)
