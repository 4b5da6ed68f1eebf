"""The units of a table's columns: those of the header, or of the diagram, as of a measured file."""

from __future__ import annotations

from pathlib import Path

import pytest
from tracewire.compile import compile, unit_problems
from tracewire.diagram import Diagram, read_text
from tracewire.errors import DiagramError
from tracewire.solve import simulate

HEADER = "s [cm],h [mm]"
TEXT = """\
span: [0, 1]
blocks:
  s: {{type: ramp, slope: 1, unit: m}}
  h: {{type: table, of: s, points: {{file: bump.csv, x: {}, y: {}}}, unit: mm}}
record: [h]
"""


def made(folder: Path, header: str = HEADER, x: str = "s", y: str = "h") -> Diagram:
    (folder / "bump.csv").write_text(f"{header}\n0,0\n25,40\n75,40\n100,0\n", encoding="utf-8")
    return read_text(TEXT.format(x, y), folder / "d.yaml")


def told(diagram: Diagram) -> list[str]:
    return [str(p) for p in unit_problems(compile(diagram, backend="quick").flat)]


@pytest.mark.parametrize(
    ("header", "x", "y"),
    [(HEADER, "s", "h"), ("s,h", "{column: s, unit: cm}", "{column: h, unit: mm}")],
)
def test_the_columns_of_a_table_are_converted(tmp_path: Path, header: str, x: str, y: str) -> None:
    diagram = made(tmp_path, header, x, y)
    assert told(diagram) == []
    run = simulate(compile(diagram, backend="quick"))
    assert run["h"].max() == pytest.approx(0.04)
    assert run["h"][-1] == pytest.approx(0.0, abs=1e-12)


def test_a_column_without_a_unit_is_in_si(tmp_path: Path) -> None:
    diagram = made(tmp_path, "s,h")
    assert told(diagram) == []
    assert simulate(compile(diagram, backend="quick"))["h"][-1] == pytest.approx(1.6)


def test_columns_of_other_quantities_are_told(tmp_path: Path) -> None:
    abscissa, ordinate = told(made(tmp_path, "s [kg],h [V]"))
    assert ":4:3: block 'h': 's' (line 3) is in m and 'h.points.x' is in kg: " in abscissa
    assert ":4:3: block 'h': 'h' is in m, and its formula is in V." in ordinate


def test_a_header_that_says_another_unit_is_told(tmp_path: Path) -> None:
    message = "column 's' is declared in 'm', and in 'cm' by its header"
    with pytest.raises(DiagramError, match=message):
        made(tmp_path, x="{column: s, unit: m}")


def test_a_column_of_a_table_needs_its_name(tmp_path: Path) -> None:
    with pytest.raises(DiagramError, match="a column of a table needs 'column'"):
        made(tmp_path, x="{unit: cm}")
