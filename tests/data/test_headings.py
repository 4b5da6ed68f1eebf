"""The columns of a file by their names, units and the texts that find them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat
from tracewire.data import read_columns, read_headings
from tracewire.errors import DataError


def write(folder: Path, text: str) -> Path:
    file = folder / "run.csv"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("text", "names", "units"),
    [
        ("t,theta\n0,1\n1,2\n", ("t", "theta"), ("", "")),
        ("Time [s];angle (deg)\n0,5;1\n1,5;2\n", ("Time", "angle"), ("s", "deg")),
        ("t theta\ns rad\n0 1\n1 2\n", ("t", "theta"), ("s", "rad")),
        ("# a rig\nt\tx\n0\t1\n", ("t", "x"), ("", "")),
        ("made by a rig\n\nt,x\n0,1\n1,1\n", ("t", "x"), ("", "")),
    ],
)
def test_names_and_units(
    tmp_path: Path, text: str, names: tuple[str, ...], units: tuple[str, ...]
) -> None:
    found = read_headings(write(tmp_path, text))
    assert (found.names, found.units) == (names, units)
    assert found.has(names[1]) and found.has("2") and not found.has("3") and not found.has("y")


def test_the_columns_are_texts_that_find_them(tmp_path: Path) -> None:
    file = write(tmp_path, "t,x,x\n0,1,2\n1,3,4\n")
    columns = read_headings(file).columns
    assert columns == ("t", "2", "3")
    read = read_columns(file, {str(n): c for n, c in enumerate(columns)})
    assert [values.tolist() for values in read.values.values()] == [[0, 1], [1, 3], [2, 4]]


def test_vectors_of_a_matlab_file(tmp_path: Path) -> None:
    savemat(tmp_path / "run.mat", {"t": np.arange(5.0), "x": np.ones((5, 2)), "g": 9.81})
    found = read_headings(tmp_path / "run.mat")
    assert set(found.names) == {"t", "x[1]", "x[2]"}
    assert found.has("x[1]")


@pytest.mark.parametrize("text", ["0,1\n1,2\n", "# nothing\n"])
def test_a_file_without_names(tmp_path: Path, text: str) -> None:
    with pytest.raises(DataError, match="the file has no header"):
        read_headings(write(tmp_path, text))
