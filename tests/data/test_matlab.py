"""MATLAB files: vectors, columns of matrices, fields and cells by their addresses."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import savemat
from tracewire.data import read_columns
from tracewire.errors import DataError

patient = settings(deadline=None)  # the first run may load scipy
T = np.arange(5) * 0.1
FORCE = np.column_stack([T + 1, T + 2, T + 3])


@pytest.fixture
def path(tmp_path: Path) -> Path:
    cells = np.empty((2, 1), dtype=object)
    cells[0, 0], cells[1, 0] = FORCE, T[:3]
    content = {
        "t": T,
        "row": T[None, :] * 2,
        "x_F": FORCE,
        "flat": FORCE.T,
        "count": np.arange(5, dtype=np.int16),
        "data": {"theta": T * 3, "inner": {"omega": T * 4}, "name": "run 3"},
        "runs": cells,
        "Ts": 0.1,
        "z": T * 1j,
        "short": T[:3],
        "cube": np.zeros((2, 3, 4)),
        "drop": np.array([1, 1, 2, 2, 2]),
    }
    savemat(tmp_path / "run.mat", content)
    return tmp_path / "run.mat"


def told(path: Path, column: str, **options: Any) -> str:
    with pytest.raises(DataError) as caught:
        read_columns(path, {"x": column}, options.pop("time", "t"), **options)
    return str(caught.value).replace(str(path), "run.mat")


@pytest.mark.parametrize(
    ("address", "values"),
    [
        ("t", T),
        ("row", T * 2),
        ("x_F[2]", T + 2),
        ("flat[3]", T + 3),
        ("count", np.arange(5)),
        ("data.theta", T * 3),
        ("data.inner.omega", T * 4),
        ("runs[1][2]", T + 2),
    ],
)
def test_addresses(path: Path, address: str, values: np.ndarray) -> None:
    found = read_columns(path, {"x": address}, "t")
    assert found.values["x"] == pytest.approx(values)
    assert found.values["x"].dtype == np.float64
    assert found.time == pytest.approx(T)


def test_rows_without_time_and_rows_that_are_chosen(path: Path) -> None:
    found = read_columns(path, {"x": "x_F[1]"}, every=0.5, where={"drop": 2})
    assert found.time == pytest.approx([0, 0.5, 1.0])
    assert found.values["x"] == pytest.approx(FORCE[2:, 0])
    assert "no row of 'run.mat' has '7' in the column 'drop'; there are: 1, 2." in told(
        path, "t", where={"drop": 7}
    )


@pytest.mark.parametrize(
    ("address", "said"),
    [
        ("x_G", "run.mat: unknown column 'x_G' in 'run.mat'; there are: count, data.inner.omega,"),
        ("x_G[1]", "Did you mean 'x_F[1]'?"),
        ("x_F[4]", "unknown column 'x_F[4]' in 'run.mat'"),
        ("x_F[0]", "unknown column 'x_F[0]' in 'run.mat'"),
        ("data.tehta", "Did you mean 'data.theta'?"),
        ("x_F", "'x_F' of 'run.mat' is an array of 5 x 3. Name one of its 3 columns, 'x_F[1]' to"),
        ("cube", "'cube' of 'run.mat' is an array of 2 x 3 x 4. Save it as a matrix."),
        ("Ts", "'Ts' of 'run.mat' is a single number"),
        ("z", "'z' of 'run.mat' is complex"),
        ("data.name", "'data.name' of 'run.mat' is a text"),
        ("data", "'data' of 'run.mat' is not an array of numbers"),
        ("short", "the columns of 'run.mat' have different lengths; there are: short (3), t (5)."),
    ],
)
def test_messages(path: Path, address: str, said: str) -> None:
    assert said in told(path, address)


def test_numbers_of_rows_stand_for_lines(tmp_path: Path) -> None:
    path = tmp_path / "run.mat"
    savemat(path, {"t": np.array([0, 0.2, 0.1, 0.3]), "x": np.array([1, np.nan, 1, 1])})
    assert told(path, "x") == (
        "run.mat: 'x' is not finite in this row (row 2). Leave out the rows without a value.\n"
        "run.mat: time goes back to 0.1, from 0.2 in row 2 (row 3). Sort the rows, in a "
        "series by clean: [sort]; or split the file, or choose rows by `where`."
    )


def test_a_damaged_file_and_one_without_time(path: Path) -> None:
    with pytest.raises(DataError, match="no first column that could be the time"):
        read_columns(path, {"x": "t"})
    path.write_bytes(path.read_bytes()[:200])
    assert "'run.mat' cannot be read as a MATLAB file" in told(path, "t")


@patient
@given(content=st.binary(max_size=300))
def test_any_content_behind_the_mark_is_refused_with_a_message(
    content: bytes, tmp_path_factory: Any
) -> None:
    path = tmp_path_factory.getbasetemp() / "random.mat"
    path.write_bytes(b"MATLAB 5.0 MAT-file".ljust(124) + b"\0\1IM" + content)
    with pytest.raises(DataError):
        read_columns(path, {"x": "x"}, "t")
