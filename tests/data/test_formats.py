"""Files of other programs: each format is written by its own package, and read."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tracewire.data import read_columns, read_headings, read_record
from tracewire.errors import DataError

T = np.linspace(0.0, 0.9, 10)
ANGLE = 10.0 * np.sin(T)
FORCE = np.cos(T)
FORMATS = ("parquet", "h5", "mat", "xlsx", "tdms", "mf4")


def write_parquet(path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    parquet.write_table(pyarrow.table({"t [ms]": 1e3 * T, "angle [deg]": ANGLE, "F": FORCE}), path)


def write_h5(path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        group = file.create_group("run 1")
        for name, values, unit in (("t", 1e3 * T, "ms"), ("angle", ANGLE, "deg"), ("F", FORCE, "")):
            data = group.create_dataset(name, data=values)
            data.attrs["units"] = unit
        group.create_dataset("both", data=np.stack([ANGLE, FORCE]))
        file.create_dataset("spare/t", data=T[:4])


def write_mat(path: Path) -> None:
    """As MATLAB writes version 7.3: a header of 512 bytes, columns on their side, references."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w", userblock_size=512) as file:
        run = file.create_group("run")
        run.attrs["MATLAB_class"] = np.bytes_("struct")
        for name, values in (("t", T), ("angle", ANGLE), ("F", FORCE)):
            run.create_dataset(name, data=values[None]).attrs["MATLAB_class"] = np.bytes_("double")
        note = file.create_dataset("note", data=np.array([[104], [105]], dtype=np.uint16))
        note.attrs["MATLAB_class"] = np.bytes_("char")
        cell = file.create_dataset("#refs#/a", data=np.stack([T, ANGLE]))
        cell.attrs["MATLAB_class"] = np.bytes_("double")
        cells = file.create_dataset("cells", (1, 1), dtype=h5py.ref_dtype)
        cells[0, 0] = cell.ref
        cells.attrs["MATLAB_class"] = np.bytes_("cell")
    content = path.read_bytes()
    path.write_bytes(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512) + content[512:])


def write_xlsx(path: Path) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    notes, sheet = book.active, book.create_sheet("run 1")
    notes.append(["who", 'the "old" rig'])
    sheet.append(["a run of the rig"])
    sheet.append(["t [ms]", "angle [deg]", "F"])
    for row in zip(1e3 * T, ANGLE, FORCE, strict=True):
        sheet.append([float(value) for value in row])
    book.save(path)


def write_tdms(path: Path) -> None:
    nptdms = pytest.importorskip("nptdms")
    wave = {"wf_increment": 0.1, "wf_start_offset": 0.0}
    channels = [
        nptdms.ChannelObject("run 1", "angle", ANGLE, {"unit_string": "deg", **wave}),
        nptdms.ChannelObject("run 1", "F", FORCE, wave),
        nptdms.ChannelObject("run 2", "angle", ANGLE[:3], {}),
    ]
    with nptdms.TdmsWriter(path) as file:
        file.write_segment(channels)


def write_mf4(path: Path) -> None:
    asammdf = pytest.importorskip("asammdf")
    angle = asammdf.Signal(samples=ANGLE, timestamps=T, name="angle", unit="deg")
    force = asammdf.Signal(samples=FORCE, timestamps=T, name="F")
    slow = asammdf.Signal(samples=FORCE[:3], timestamps=T[:3], name="slow")
    with asammdf.MDF() as file:
        file.append([angle, force])
        file.append([slow])
        file.save(path, overwrite=True)


WRITERS: dict[str, Callable[[Path], None]] = {
    "parquet": write_parquet,
    "h5": write_h5,
    "mat": write_mat,
    "xlsx": write_xlsx,
    "tdms": write_tdms,
    "mf4": write_mf4,
}
TIMES = {"mat": "run.t", "tdms": "time", "mf4": "time"}
NAMES = {"mat": ("run.angle", "run.F"), "tdms": ("run 1/angle", "F")}


@pytest.fixture(params=FORMATS)
def written(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    path = tmp_path / f"run.{request.param}"
    WRITERS[request.param](path)
    return path


def kind(path: Path) -> str:
    return path.suffix[1:]


def wanted(path: Path) -> tuple[dict[str, str], str]:
    angle, force = NAMES.get(kind(path), ("angle", "F"))
    return {"angle": angle, "force": force}, TIMES.get(kind(path), "t")


def test_a_record_is_read_in_si(written: Path) -> None:
    columns, time = wanted(written)
    record = read_record(written, columns, time)
    factor = 1.0 if kind(written) == "mat" else np.pi / 180
    assert record.t == pytest.approx(T)
    assert record.columns["angle"] == pytest.approx(factor * ANGLE)
    assert record.columns["force"] == pytest.approx(FORCE)


def test_a_column_that_is_not_there_is_told_with_those_that_are(written: Path) -> None:
    columns, time = wanted(written)
    with pytest.raises(DataError) as caught:
        read_columns(written, {"x": columns["angle"] + "x"}, time)
    (problem,) = caught.value.problems
    assert problem.what.startswith(f"unknown column '{columns['angle']}x' in '{written}'")
    assert "Did you mean" in problem.hint


def test_headings_name_what_can_be_read(written: Path) -> None:
    headings = read_headings(written)
    assert len(headings.columns) >= 3
    for _, _, column in headings:
        if column not in ("note/who", 'Sheet/the "old" rig', "Sheet/who"):
            read_columns(written, {"x": column}, every=0.1)


def test_a_damaged_file_is_told(written: Path) -> None:
    content = written.read_bytes()
    written.write_bytes(content[: len(content) // 3])
    columns, time = wanted(written)
    with pytest.raises(DataError, match="cannot be read as"):
        read_columns(written, columns, time)


PACKAGES = {
    "parquet": "pyarrow",
    "h5": "h5py",
    "mat": "h5py",
    "xlsx": "openpyxl",
    "tdms": "nptdms",
    "mf4": "asammdf",
}
EXTRAS = {"h5": "hdf5", "mat": "matlab", "mf4": "mdf"}


def test_a_missing_package_is_told_with_its_extra(
    written: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, PACKAGES[kind(written)], None)
    extra = EXTRAS.get(kind(written), kind(written))
    with pytest.raises(DataError, match=rf"pip install 'tracewire\[{extra}\]'"):
        read_columns(written, *wanted(written))


def read(path: Path, column: str, time: str | None = None, **more: Any) -> list[float]:
    return read_columns(path, {"x": column}, time, **more).values["x"].tolist()


def test_columns_of_a_matrix_and_of_a_group(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    write_h5(path)
    assert read(path, "run 1/both[2]", "run 1/t") == FORCE.tolist()
    assert read(path, "/run 1/both[1]", "/run 1/t") == ANGLE.tolist()
    with pytest.raises(DataError, match=r"'t' is the name of 2 columns.*run 1/t, spare/t"):
        read(path, "t", every=1.0)
    with pytest.raises(DataError, match=r"different lengths; there are: run 1/F \(10\)"):
        read(path, "run 1/F", "spare/t")


def test_hdf5_never_opens_another_file(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    write_h5(tmp_path / "secret.h5")
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file["there"] = h5py.ExternalLink("secret.h5", "run 1")
        file["here"] = T
        layout = h5py.VirtualLayout(shape=(10,), dtype="f8")
        layout[:] = h5py.VirtualSource(tmp_path / "secret.h5", "run 1/t", shape=(10,))
        file.create_virtual_dataset("virtual", layout)
    assert read_headings(path).columns == ("here",)


def test_cells_of_matlab_and_what_is_no_number(tmp_path: Path) -> None:
    path = tmp_path / "run.mat"
    write_mat(path)
    assert read(path, "cells[1][2]", "cells[1][1]") == ANGLE.tolist()
    with pytest.raises(DataError, match=r"'note' of .* is a text"):
        read(path, "note", "run.t")


def test_a_table_has_numbered_columns_and_its_first_one_is_the_time(tmp_path: Path) -> None:
    path = tmp_path / "run.parquet"
    write_parquet(path)
    assert read(path, "3") == FORCE.tolist()
    assert read_columns(path, {"x": "F"}).time == pytest.approx(1e3 * T)


def test_rows_and_dates_of_parquet(tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    path = tmp_path / "run.parquet"
    stamps = np.datetime64("2024-03-12T12:00:00", "ms") + np.array([0, 500, 0, 250])
    table = {
        "when": pyarrow.array(stamps.astype("datetime64[ms]"), pyarrow.timestamp("ms", "UTC")),
        "x": pyarrow.array([1, 2, 3, None]),
        "ball": ["golf", "golf", "tennis", "tennis"],
    }
    parquet.write_table(pyarrow.table(table), path)
    chosen = read_columns(path, {"x": "x"}, "when", where={"ball": "golf"})
    assert (chosen.time.tolist(), chosen.values["x"].tolist()) == ([0.0, 0.5], [1.0, 2.0])
    assert chosen.since == "2024-03-12T12:00:00Z"
    with pytest.raises(DataError, match=r"no row .* has 'squash' .*; there are: golf, tennis"):
        read(path, "x", "when", where={"ball": "squash"})
    with pytest.raises(DataError, match=r"'x' is not finite in this row \(row 2\)"):
        read(path, "x", "when", where={"ball": "tennis"})
    with pytest.raises(DataError, match=r"'ball' of .* is text, and not numbers"):
        read(path, "ball", "when")
    with pytest.raises(DataError, match=r"'when' of .* is a date, and only the time may be dates"):
        read(path, "when", every=1.0)


def workbook(path: Path, **sheets: list[list[object]]) -> Path:
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    book.save(path)
    return path


def test_sheets(tmp_path: Path) -> None:
    one = [["t", "x"], [0, 1], [1, 2]]
    path = workbook(tmp_path / "run.xlsx", a=one, b=[["t", "x", "y"], [0, 3, 5], [1, 4, 6]])
    assert read(path, "b/x", "b/t") == read(path, "b/x", "t") == [3.0, 4.0]
    assert read(path, "y", "t") == [5.0, 6.0]
    with pytest.raises(DataError, match=r"'x' is the name of 2 columns of .*there are: a/x, b/x"):
        read(path, "x", "t")
    with pytest.raises(DataError, match="are in several sheets; there are: a/x, b/y, b/t"):
        read_columns(path, {"x": "a/x", "y": "b/y"}, "b/t")


def test_a_faulty_cell_of_a_sheet_is_told_with_its_row(tmp_path: Path) -> None:
    rows = [["t", "x"], [0, 1], ["#DIV/0!", 2], [2, "n/a"], [3, None], [4, 4]]
    path = workbook(tmp_path / "run.xlsx", run=rows)
    with pytest.raises(DataError) as caught:
        read(path, "x", "t")
    assert [problem.place.line for problem in caught.value.problems] == [3, 4, 5]
    assert "column 't' is '#DIV/0!', which is not a number" in str(caught.value)


def test_dates_of_a_sheet_are_times(tmp_path: Path) -> None:
    from datetime import datetime

    begin = datetime(2024, 3, 12, 12)
    rows = [["when", "x"], [begin, 1], [begin.replace(second=2), 2]]
    found = read_columns(workbook(tmp_path / "run.xlsx", run=rows), {"x": "x"})
    assert (found.time.tolist(), found.since) == ([0.0, 2.0], "2024-03-12T12:00:00")


def test_a_group_of_a_measurement_file_has_its_own_time(tmp_path: Path) -> None:
    path = tmp_path / "run.mf4"
    write_mf4(path)
    assert len(read(path, "slow", "time")) == 3
    assert len(read(path, "angle", "time")) == 10


def test_a_sheet_of_notes_has_no_columns(tmp_path: Path) -> None:
    notes = [["# remarks of the day"], ["# and more"]]
    path = workbook(tmp_path / "run.xlsx", run=[["t", "x"], [0, 1], [1, 2]], notes=notes)
    assert read_columns(path, {"x": "run/x"}, "run/t").values["x"].tolist() == [1.0, 2.0]
