from __future__ import annotations

from pathlib import Path

import pytest
from diagram.alike import said
from tracewire.diagram import read, read_text, write_out

DIAGRAMS = Path(__file__).parents[2] / "diagrams"
FILES = [
    file
    for file in sorted(DIAGRAMS.rglob("*.yaml"))
    if "real" not in file.parts  # their data are fetched when they are needed
    and ("\nblocks:" in (text := file.read_text(encoding="utf-8")) or "\nextends:" in text)
]


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(DIAGRAMS)))
def test_a_diagram_that_is_written_out_says_the_same(file: Path) -> None:
    diagram = read(file)
    text = write_out(diagram)
    again = read_text(text, file)
    assert said(again) == said(diagram)
    assert write_out(again) == text
    assert max(map(len, text.splitlines())) < 400


def test_a_parameter_with_the_name_of_a_section_is_no_subsystem() -> None:
    text = (
        "parameters: {blocks: 5, k: 2}\npresets: {one: {blocks: 1, k: 3}}\n"
        "blocks: {y: {type: constant, value: k*blocks}}\n"
    )
    again = read_text(write_out(read_text(text)))
    assert again.parameters.keys() == {"blocks", "k"}
    assert again.presets["one"].keys() == {"blocks", "k"}


def test_files_of_a_base_are_named_from_where_the_changes_are(tmp_path: Path) -> None:
    inside = tmp_path / "sub"
    inside.mkdir()
    plain = "blocks: {x: {type: integrator, of: y, start: 1}, y: {type: gain, of: x, k: -1}}\n"
    (inside / "other.yaml").write_text(plain)
    (inside / "base.yaml").write_text(
        plain + 'expect: [{that: "end(x)/reference(end(x))", above: 0, '
        "reference: {diagram: other.yaml}}]\n"
    )
    (tmp_path / "top.yaml").write_text("extends: sub/base.yaml\n")
    text = write_out(read(tmp_path / "top.yaml"))
    assert 'diagram: "sub/other.yaml"' in text
