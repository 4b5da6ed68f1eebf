"""A diagram whose measured file is not there: it is read as any other, and told what it lacks."""

from __future__ import annotations

from pathlib import Path

import pytest
from tracewire.compile import compile
from tracewire.diagram import absent_series, read, read_text, write
from tracewire.errors import DataError
from tracewire.residual import load_measured
from tracewire.solve import simulate

TEXT = """\
span: [0, 1]
inputs: {drive: {default: 0}}
blocks: {x: {type: integrator, of: drive, start: 1}}
measured:
  one: {file: one.csv, time: t, signals: {x: x}}
  two: {file: tow.csv, time: t, signals: {x: x}}
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    for name in ("one", "two"):
        (tmp_path / f"{name}.csv").write_text("t,x\n0,1\n1,1\n", encoding="utf-8")
    return tmp_path / "a.yaml"


def test_it_can_be_run_and_says_what_is_absent(file: Path) -> None:
    diagram = read_text(TEXT, file)
    assert simulate(compile(diagram)).signals["x"][-1] == 1.0
    (problem,) = absent_series(diagram).values()
    assert str(problem).startswith(f"{file}:6:3: series 'two': unknown file 'tow.csv' in")
    assert str(problem).endswith("Did you mean 'two.csv'?")


def test_data_that_are_there_are_read_without_the_others(file: Path) -> None:
    model = compile(read_text(TEXT, file))
    (one,) = load_measured(model, series=["one"])
    assert one.name == "one"
    with pytest.raises(DataError, match=r"6:3: unknown file 'tow.csv'"):
        load_measured(model)


def test_a_copy_in_another_folder_finds_the_files_that_are_there(
    file: Path, tmp_path: Path
) -> None:
    (tmp_path / "other").mkdir()
    copy = read(write(read_text(TEXT, file), tmp_path / "other" / "b.yaml"))
    assert copy.measured["one"].file.is_file()
    assert list(absent_series(copy)) == list(absent_series(read_text(TEXT, file)))
