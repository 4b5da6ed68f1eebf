"""What is no table of text is named as what it is, whatever its name says."""

from __future__ import annotations

import io
import pickle
import zipfile
from pathlib import Path

import numpy as np
import pytest
from tracewire.data import read_columns
from tracewire.errors import DataError


def zipped(*names: str) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        for name in names:
            archive.writestr(name, "content " * 2000)
    return file.getvalue()


def saved(**arrays: np.ndarray) -> bytes:
    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()


ODS = "mimetypeapplication/vnd.oasis.opendocument.spreadsheet"


@pytest.mark.parametrize(
    ("content", "name", "hint"),
    [
        (zipped(ODS, "content.xml"), "a spreadsheet of OpenDocument (.ods)", "as CSV"),
        (zipped("run.csv"), "a zip archive", "Unpack it"),
        (saved(x=np.arange(3)), "an archive of numpy (.npz)", "numpy.savetxt"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1", "an old Excel workbook (.xls)", "as CSV"),
        (b"%PDF-1.7\n", "a PDF", "Ask for the numbers as CSV."),
        (b"\x1f\x8b\x08\0", "a gzip archive", "Unpack it"),
        (b"\x93NUMPY\1\0", "an array of numpy (.npy)", "numpy.savetxt"),
        (pickle.dumps([1, 2]), "a pickle of Python", "It is never opened"),
        (b"<!DOCTYPE html><html><table>", "a web page or XML", "as CSV"),
        (b"\x89PNG\r\n\x1a\n", "a picture", "as CSV"),
        (b"SQLite format 3\0", "an SQLite database", "Export"),
    ],
)
def test_kinds(content: bytes, name: str, hint: str, tmp_path: Path) -> None:
    path = tmp_path / "run.xls"
    path.write_bytes(content)
    with pytest.raises(DataError) as caught:
        read_columns(path, {"x": "x"}, "t")
    said = str(caught.value)
    assert said.startswith(f"{path}: the file is {name}")
    assert "and not a table of text. " in said
    assert hint in said


def test_a_pickle_is_not_opened(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self) -> tuple[object, tuple[str]]:
            return Path.touch, (Path(tmp_path / "sprung"),)  # type: ignore[return-value]

    path = tmp_path / "run.csv"
    path.write_bytes(pickle.dumps(Trap()))
    with pytest.raises(DataError, match="pickle"):
        read_columns(path, {"x": "x"})
    assert not (tmp_path / "sprung").exists()
