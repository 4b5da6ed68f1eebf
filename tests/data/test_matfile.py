"""The reader of MATLAB files gives what scipy's gives, and ends with a message on damaged ones."""

from __future__ import annotations

import contextlib
import io
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from scipy.io import loadmat, savemat
from tracewire.data import matfile, read_columns
from tracewire.data.matfile import Cells, Damaged, Other, Structs, variables_of
from tracewire.errors import DataError

patient = settings(deadline=None)  # the first run may load scipy
SHARED = Path(__file__).parents[3] / "shared/data"


def saved(content: dict[str, Any], **options: Any) -> bytes:
    file = io.BytesIO()
    savemat(file, content, **options)
    return file.getvalue()


def cells(*entries: object) -> np.ndarray:
    made = np.empty((len(entries), 1), dtype=object)
    made[:, 0] = [*entries]
    return made


def same(mine: object, theirs: Any) -> bool:
    """Whether a value is what scipy makes of it."""
    if isinstance(mine, Other) and mine == "an object of a class":
        return type(theirs).__name__ == "MatlabOpaque"
    if isinstance(theirs, np.ndarray) and theirs.dtype.names:
        flat = theirs.ravel(order="F")
        return isinstance(mine, Structs) and all(
            same(entry[name], other[name])
            for entry, other in zip(mine, flat, strict=True)
            for name in theirs.dtype.names
        )
    if isinstance(theirs, np.ndarray) and theirs.dtype == object:
        flat = theirs.ravel(order="F")
        return isinstance(mine, Cells) and all(map(same, mine, flat))
    if isinstance(theirs, np.ndarray) and theirs.dtype.kind in "biufc":
        assert isinstance(mine, np.ndarray)
        return mine.shape == theirs.shape and np.array_equal(mine, theirs, equal_nan=True)
    return isinstance(mine, Other)


def check_against_scipy(content: bytes) -> None:
    theirs = {k: v for k, v in loadmat(io.BytesIO(content)).items() if not k.startswith("__")}
    mine = variables_of(content)
    if theirs.pop("None", None) is not None:  # so scipy calls every object of a class
        others = {name: value for name, value in mine.items() if isinstance(value, Other)}
        objects = [name for name, value in others.items() if value == "an object of a class"]
        assert objects
        mine = {name: value for name, value in mine.items() if name not in objects}
    assert mine.keys() == theirs.keys()
    assert [name for name in theirs if not same(mine[name], theirs[name])] == []


numbers = arrays.arrays(
    st.sampled_from(["f8", "f4", "i1", "u2", "i4", "u8", "c16"]),
    arrays.array_shapes(min_dims=2, max_dims=3, max_side=4),
)


@patient
@given(
    one=numbers,
    other=numbers,
    text=st.text("abc ", max_size=5),
    compressed=st.booleans(),
)
def test_every_value_is_that_of_scipy(
    one: np.ndarray, other: np.ndarray, text: str, compressed: bool
) -> None:
    content = {
        "x": one,
        "long_name_of_a_variable": other,
        "text": text,
        "empty": np.zeros((0, 0)),
        "cells": cells(one, text, cells(other)),
        "data": {"theta": one, "inner": {"other": other, "text": text}},
        "list": [{"a": one}, {"a": other}],
    }
    check_against_scipy(saved(content, do_compression=compressed))


@pytest.mark.skipif(not SHARED.is_dir(), reason="the measured series are not here")
def test_files_of_matlab_itself() -> None:
    files = sorted(SHARED.glob("*/*.mat"))
    assert len(files) > 5
    for file in files:
        check_against_scipy(file.read_bytes())


def test_the_other_order_of_bytes() -> None:
    def element(kind: int, data: bytes) -> bytes:
        return struct.pack(">II", kind, len(data)) + data + b"\0" * (-len(data) % 8)

    parts = [
        element(6, struct.pack(">II", 6, 0)),
        element(5, struct.pack(">ii", 1, 2)),
        element(1, b"x"),
        element(9, struct.pack(">dd", 1.5, -2.0)),
    ]
    content = b"MATLAB 5.0 MAT-file".ljust(124) + b"\1\0MI" + element(14, b"".join(parts))
    assert variables_of(content)["x"].tolist() == [[1.5, -2.0]]  # type: ignore[union-attr]


DAMAGES = st.lists(
    st.tuples(st.integers(0, 2000), st.integers(0, 255), st.sampled_from(["set", "cut", "drop"])),
    min_size=1,
    max_size=5,
)
WHOLE = saved(
    {"t": np.arange(9.0), "s": {"a": np.arange(9.0)}, "c": cells(np.eye(3), "a")},
    do_compression=False,
)
PACKED = saved({"t": np.arange(9.0), "s": {"a": np.arange(9.0)}}, do_compression=True)
OLD = saved({"t": np.arange(9.0), "x": np.eye(9)}, format="4")


@patient
@given(content=st.sampled_from([WHOLE, PACKED, OLD]), damages=DAMAGES)
def test_a_damaged_file_is_read_or_refused_with_a_message(
    content: bytes, damages: list[tuple[int, int, str]], tmp_path_factory: Any
) -> None:
    broken = bytearray(content)
    for place, byte, how in damages:
        at = place % max(len(broken), 1)
        if how == "set" and broken:
            broken[at] = byte
        elif how == "cut":
            broken = broken[: at + 1]
        else:
            del broken[at : at + byte // 16]
    path = tmp_path_factory.getbasetemp() / "damaged.mat"
    path.write_bytes(bytes(broken))
    with contextlib.suppress(DataError):
        read_columns(path, {"x": "t"}, "t")


def test_files_of_version_4_are_read(tmp_path: Path) -> None:
    path = tmp_path / "old.mat"
    path.write_bytes(saved({"t": np.arange(3.0), "x": np.eye(3)}, format="4"))
    found = read_columns(path, {"x": "x[2]"}, "t")
    assert found.values["x"].tolist() == [0, 1, 0]


def test_what_unpacks_to_too_much_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(matfile.FILE, "most_unpacked", 1000)
    bomb = zlib.compress(b"\0" * 100_000)
    content = WHOLE[:128] + struct.pack("<II", 15, len(bomb)) + bomb
    with pytest.raises(Damaged, match="it holds more than"):
        variables_of(content)


def test_what_is_nested_too_deeply_is_refused() -> None:
    inner: object = np.eye(2)
    for _ in range(25):
        inner = cells(inner)
    with pytest.raises(Damaged, match="nested deeper than 20 levels"):
        variables_of(saved({"x": inner}))
