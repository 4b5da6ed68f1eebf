"""`schema`, `format`, `rename`, and `check` of a diagram without its data."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest


def test_schema_is_printed_or_written(call: Any, tmp_path: Path) -> None:
    printed = call("schema").data
    assert printed["title"] == "A tracewire diagram"
    target = tmp_path / "s.json"
    assert call("schema", "--output", target).out == f"written: {target}\n"
    assert json.loads(target.read_text("utf-8")) == printed


def test_schema_and_the_line_that_names_it(
    call: Any, swing: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(swing.parent)
    before = swing.read_text("utf-8")
    told = call("schema", "--modeline", swing)
    assert told.out.splitlines() == ["written: .tracewire/schema.json", f"written: {swing}"]
    first, rest = swing.read_text("utf-8").split("\n", 1)
    assert (first, rest) == ("# yaml-language-server: $schema=.tracewire/schema.json", before)
    assert (swing.parent / ".tracewire" / "schema.json").is_file()
    again = call("schema", "--modeline", swing, "--json")
    assert again.data == {"written": [".tracewire/schema.json"]}
    assert call("check", swing).code == 0


def test_schema_changes_no_diagram_unasked(call: Any, swing: Path) -> None:
    told = call("schema", swing)
    assert told.code == 2
    assert told.err.startswith("diagrams and --modeline belong together. Write: tracewire schema")
    assert call("schema", "--modeline").code == 2


def test_schema_has_the_blocks_of_a_library(call: Any, tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(
        "from tracewire.library import Block, Output\n"
        'own = Block(name="own", doc="One.", outputs=(Output("y", "1"),))\n'
    )
    schema = call("schema", "--library", tmp_path / "mine.py").data
    types = schema["else"]["then"]["properties"]["blocks"]
    assert "own" in types["additionalProperties"]["properties"]["type"]["else"]["enum"]


def test_format_writes_only_what_changes(call: Any, swing: Path) -> None:
    assert call("format", swing).out == "the layout is in order\n"
    text = swing.read_text("utf-8")
    swing.write_text(text.replace("theta: {type", "theta:   { type"), encoding="utf-8")
    told = call("format", swing, "--check")
    assert (told.code, told.out) == (1, f"would change: {swing}\n")
    assert swing.read_text("utf-8") != text
    assert call("format", swing.parent, "--json").data == {"files": 1, "written": [str(swing)]}
    assert swing.read_text("utf-8") == text
    assert call("format", swing, "--check").code == 0


def test_format_goes_on_after_a_file_that_is_no_yaml(call: Any, swing: Path) -> None:
    bad = swing.with_name("bad.yaml")
    bad.write_text("a: [1\n", encoding="utf-8")
    swing.write_text("title:  x\n" + swing.read_text("utf-8").split("\n", 1)[1], "utf-8")
    told = call("format", bad, swing)
    assert told.code == 2
    assert "bad.yaml:2:1: this is not YAML" in told.err
    assert swing.read_text("utf-8").startswith("title: x\n")
    assert call("format", bad).out == ""


def test_rename_writes_the_file_and_shows_the_change(call: Any, swing: Path) -> None:
    text = swing.read_text("utf-8")
    told = call("rename", swing, "theta", "angle_1")
    assert told.code == 0
    assert "-record: [theta, omega]\n+record: [angle_1, omega]\n" in told.out
    assert told.out.endswith(f"written: {swing}\n")
    assert call("rename", swing, "angle_1", "theta", "--json").data["written"] == [str(swing)]
    assert swing.read_text("utf-8") == text


def test_rename_into_another_file(call: Any, swing: Path) -> None:
    text = swing.read_text("utf-8")
    other = swing.with_name("other.yaml")
    assert call("rename", swing, "k", "stiff", "--output", other).code == 0
    assert swing.read_text("utf-8") == text
    assert "k: -stiff" in other.read_text("utf-8")
    refused = call("rename", swing, "k", "stiff", "--output", other)
    assert refused.code == 2
    assert "there is a file of this name" in refused.err


def test_rename_refuses(call: Any, swing: Path) -> None:
    text = swing.read_text("utf-8")
    told = call("rename", swing, "theta", "omega")
    assert told.code == 2
    assert "there is a part 'omega' already. Choose another name." in told.err
    assert swing.read_text("utf-8") == text


def test_without_its_data_a_diagram_is_checked_shown_drawn_and_run(
    call: Any, swing: Path, tmp_path: Path
) -> None:
    (tmp_path / "run_1.csv").rename(tmp_path / "run_2.csv")
    told = call("check", swing)
    assert told.code == 0
    assert "!           " in told.out
    assert "series 'run_1': unknown file 'run_1.csv' in" in told.out
    assert "no problems in the diagram, but 1 measured series has no file" in told.out
    assert "Did you mean 'run_2.csv'?" in call("check", swing, "--json").data["remarks"][0]
    for command in (["show"], ["run"], ["draw", "--output", tmp_path / "a.svg"]):
        verb, *options = command
        assert call(verb, swing, *options).code == 0
    for verb in ("fit", "trace"):
        refused = call(verb, swing)
        assert refused.code == 2
        assert "unknown file 'run_1.csv' in" in refused.err
