"""What `trace` prints and writes of a result, whatever the search behind it found."""

from __future__ import annotations

import json
import subprocess
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from show.traces import FOUND, NULL, TEXT, UNEXPLAINED, missing_of_two
from tracewire.cli.progress import stages
from tracewire.diagram import read, read_text
from tracewire.trace import Found
from tracewire.trace.found import Force

CHANGED = TEXT.replace("[column, damper]}", "[column, damper, coulomb]}\n"
                       "  coulomb: {type: coulomb, rate: omega, level: {value: 0.25}}")  # fmt: skip


@pytest.fixture
def traced(call: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """`trace` of a diagram, run in its folder, with a result that is known."""
    monkeypatch.chdir(tmp_path)
    file = Path("swing.yaml")

    def command(found: Found, *arguments: str, text: str = TEXT) -> Any:
        file.write_text(text, encoding="utf-8")
        original = read(file)
        changed = CHANGED if found.diagram.text != found.original.text else TEXT
        changed = changed[: len(changed) - len(TEXT) + len(text)]  # as `text` ends
        result = replace(found, original=original, diagram=read_text(changed, file))
        module = import_module("tracewire.trace")
        monkeypatch.setattr(module, "trace", lambda model, **options: result)
        return call("trace", file, *arguments)

    return command


def test_the_answer_comes_first_and_the_change_last(traced: Any) -> None:
    told = traced(FOUND)
    assert told.code == 0
    lines = told.out.splitlines()
    assert lines[0] == "VERDICT effect: coulomb @ torque is missing"
    order = [
        told.out.index(text)
        for text in ("VERDICT", "declared model", "step 1", "errors", "note: every third window",
                     "the change of the diagram:\n--- a/swing.yaml")
    ]  # fmt: skip
    assert order == sorted(order)
    assert lines[-1].startswith("+  coulomb: {type: coulomb")


def test_a_patch_is_what_git_and_patch_take(traced: Any, tmp_path: Path) -> None:
    assert traced(FOUND, "--patch", "x.patch").code == 0
    subprocess.run(["git", "apply", "x.patch"], cwd=tmp_path, check=True, capture_output=True)
    assert (tmp_path / "swing.yaml").read_text(encoding="utf-8") == CHANGED


def test_a_patch_of_a_file_without_a_last_line_end_applies(traced: Any, tmp_path: Path) -> None:
    assert traced(FOUND, "--patch", "x.patch", text=TEXT.rstrip("\n")).code == 0
    subprocess.run(["git", "apply", "x.patch"], cwd=tmp_path, check=True, capture_output=True)
    assert (tmp_path / "swing.yaml").read_text(encoding="utf-8") == CHANGED.rstrip("\n")


def test_what_only_approximates_is_written_where_it_is_asked_for(
    traced: Any, tmp_path: Path
) -> None:
    approximation = replace(
        UNEXPLAINED,
        effects=FOUND.effects,
        find_diagram=lambda effects: read_text(CHANGED, tmp_path / "swing.yaml"),
    )
    told = traced(approximation, "--apply")
    assert told.code == 0
    assert "the diagram stays as it is: --approximation writes what only approximates" in told.out
    assert (tmp_path / "swing.yaml").read_text(encoding="utf-8") == TEXT
    told = traced(approximation, "--apply", "--approximation")
    assert told.code == 0
    assert "+  coulomb: {type: coulomb" in told.out
    assert (tmp_path / "swing.yaml").read_text(encoding="utf-8") == CHANGED


def test_a_missing_torque_is_written_as_a_table_and_wired(traced: Any, tmp_path: Path) -> None:
    told = traced(UNEXPLAINED, "--table", "missing.csv", "--output", "with.yaml", "--json")
    assert told.code == 0
    assert told.data["written"] == ["missing.csv", "with.yaml"]
    assert told.data["depends_on"] == ["q"]
    text = (tmp_path / "missing.csv").read_text(encoding="utf-8")
    assert text.startswith("# Empirical")
    rows = np.loadtxt(text.splitlines(), delimiter=",", skiprows=4)
    np.testing.assert_allclose(rows[:, 1], 0.2 * np.sin(12 * rows[:, 0]), atol=1e-6)
    diagram = read(tmp_path / "with.yaml")
    assert diagram.blocks["missing"].type == "table"
    assert "k: {value: 4.01," in diagram.text  # as it was fitted without the table


def test_a_table_of_two_variables_is_written_but_not_wired(traced: Any, tmp_path: Path) -> None:
    both = replace(UNEXPLAINED, missing=missing_of_two())
    told = traced(both, "--table", "missing.csv", "--patch", "x.patch", "--json")
    assert told.code == 0
    assert "the diagram gets no table: the missing torque depends on q and v" in told.err
    assert (tmp_path / "missing.csv").is_file()
    assert (tmp_path / "x.patch").read_text(encoding="utf-8") == ""


def test_nothing_missing_writes_no_table(traced: Any, tmp_path: Path) -> None:
    told = traced(NULL, "--table", "missing.csv", "--json")
    assert told.code == 0
    assert "nothing is missing that a table could hold: 'missing.csv' was not written" in told.err
    assert not (tmp_path / "missing.csv").exists()
    assert told.data["written"] == []


def test_an_interrupted_trace_is_told_and_written(traced: Any, tmp_path: Path) -> None:
    told = traced(replace(FOUND, interrupted=True), "--report", "so_far.md")
    assert told.code == 130
    assert told.out.startswith("VERDICT effect (interrupted: what was known by then)")
    assert "written: so_far.md" in told.out
    assert (tmp_path / "so_far.md").is_file()


def failing() -> tuple[Force, ...]:
    raise KeyError("start.x")


def test_a_figure_that_fails_costs_nothing_but_itself(traced: Any, tmp_path: Path) -> None:
    broken = replace(FOUND, find_forces=failing)
    told = traced(broken, "--report", "a.html", "--output", "b.yaml", "--save", "c.json")
    assert told.code == 0
    assert told.out.startswith("VERDICT effect")
    assert told.out.endswith("written: c.json\nwritten: b.yaml\nwritten: a.html\n")
    assert "could not be drawn: KeyError('start.x')." in told.err
    text = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert "could not be drawn: KeyError(&#x27;start.x&#x27;)." in text
    assert text.count('src="data:image/png') == 5


@pytest.mark.parametrize("as_json", [False, True])
def test_all_is_printed_saved_and_applied_before_anything_is_drawn(
    traced: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any, as_json: bool
) -> None:
    seen: dict[str, Any] = {}

    def look(*_: object) -> Any:
        seen["out"] = capsys.readouterr().out
        seen["files"] = sorted(file.name for file in tmp_path.iterdir())
        seen["text"] = (tmp_path / "swing.yaml").read_text(encoding="utf-8")
        raise MemoryError("no picture today")

    monkeypatch.setattr(import_module("tracewire.show"), "report", look, raising=False)
    told = traced(FOUND, "--report", "a.html", "--apply", "--patch", "b.patch", "--save", "c.json",
                  *(["--json"] if as_json else []))  # fmt: skip
    assert told.code == 1
    assert "no picture today" in told.err
    assert seen["files"] == ["b.patch", "c.json", "swing.yaml"]
    assert seen["text"] == CHANGED
    assert "coulomb" in seen["out"]
    assert told.out == ""  # all of it was there before
    if as_json:
        assert json.loads(seen["out"])["verdict"] == "effect"


@pytest.mark.parametrize("as_json", [False, True])
def test_a_file_that_cannot_be_written_does_not_keep_others_from_it(
    traced: Any, tmp_path: Path, as_json: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object) -> None:
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(import_module("tracewire.trace.saved"), "write_file", refused)
    told = traced(FOUND, "--save", "c.json", "--report", "a.md", "--patch", "b.patch",
                  *(["--json"] if as_json else []))  # fmt: skip
    assert told.code == 2
    assert "'c.json' cannot be written" in told.err
    assert (tmp_path / "a.md").is_file()
    assert (tmp_path / "b.patch").is_file()
    if as_json:
        assert told.data["not_written"] == ["'c.json' cannot be written: Read-only file system"]
        assert told.data["written"] == ["b.patch", "a.md"]
    else:
        assert told.out.startswith("VERDICT effect")


def test_a_saved_trace_is_reported_again_without_the_work(
    traced: Any, call: Any, tmp_path: Path
) -> None:
    first = traced(FOUND, "--save", "c.json")
    assert first.out.endswith("written: c.json\n")
    told = call("report", "c.json")
    assert told.code == 0
    assert told.out in first.out
    assert told.out.startswith("VERDICT effect: coulomb @ torque is missing\n")
    told = call("report", "c.json", "--report", "d.md")
    assert told.out == "written: d.md\n"
    assert (tmp_path / "d_law.png").is_file()
    data = call("report", "c.json", "--json").data
    assert data["effects"][0]["name"] == "coulomb"
    assert data["written"] == []


def test_what_is_no_saved_trace_is_told_in_one_line(traced: Any, call: Any) -> None:
    traced(FOUND)
    for arguments, said in (
        (("swing.yaml",), "swing.yaml: this is no saved trace. Name a file that"),
        (("none.json",), "none.json: the saved trace cannot be read: No such file"),
        (("c.json", "--report", "a.pdf"), "unknown file ending '.pdf'"),
    ):
        told = call("report", *arguments)
        assert (told.code, told.out) == (2, "")
        assert said in told.err
        assert told.err.count("\n") == 1


def test_a_remark_of_several_series_is_printed_once(traced: Any) -> None:
    words = tuple(f"the last sixth of 'swing_{n}' is held back" for n in (1, 2, 3))
    told = traced(replace(FOUND, words=words))
    assert "note: the last sixth of 'swing_1', 'swing_2' and 'swing_3' is held back" in told.out
    assert told.out.count("held back") == 1


def test_stages_have_the_time_since_the_start_and_what_is_left_of_counted_parts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock, shown = [0.0], list[str]()
    monkeypatch.setattr("tracewire.cli.progress.time.monotonic", lambda: clock[0])
    tell = stages(shown.append)
    for now, text in (
        (0.4, "screening"),
        (10.0, "refitting with bias (1 of 3)"),
        (14.0, "refitting with coulomb (2 of 3)"),
        (20.0, "refitting with viscous (3 of 3)"),
        (21.0, "refitting with bias (1 of 2)"),
        (21.5, "refitting with viscous (2 of 2)"),
    ):
        clock[0] = now
        tell(text)
    assert shown == [
        "   0 s  screening",
        "  10 s  refitting with bias (1 of 3)",
        "  14 s  refitting with coulomb (2 of 3), about 8 s left for these",
        "  20 s  refitting with viscous (3 of 3), about 5 s left for these",
        "  21 s  refitting with bias (1 of 2)",
        "  22 s  refitting with viscous (2 of 2)",
    ]
