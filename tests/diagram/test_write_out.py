from __future__ import annotations

from pathlib import Path

import pytest
from diagram.alike import said
from tracewire.diagram import read, read_text, written_out

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
    text = written_out(diagram)
    again = read_text(text, file)
    assert said(again) == said(diagram)
    assert written_out(again) == text
    assert max(map(len, text.splitlines())) < 400
