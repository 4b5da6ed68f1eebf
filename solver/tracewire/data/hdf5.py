"""The columns of an HDF5 file: data sets of numbers in its groups; h5py reads them."""

from __future__ import annotations

import io
from collections import defaultdict
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.data.limits import FILE
from tracewire.data.quiet import Attempts
from tracewire.data.vectors import Column, Group
from tracewire.errors import DataError, Location
from tracewire.extras import import_extra

UNITS = ("units", "unit", "Units", "Unit")


class Opened:
    """An HDF5 file that h5py has open, and what reads from it with its errors told.

    Raises DataError: damaged, or h5py is not installed.
    """

    def __init__(self, content: bytes, path: Path, place: Location, kind: str, extra: str) -> None:
        h5py = import_extra(
            "h5py",
            extra,
            f"to read '{path}', {kind}",
            error=DataError,
            place=place,
            otherwise="Or save it as CSV.",
        )
        self.attempt = Attempts("h5py", kind, path, place)
        self.file = self.attempt(lambda: h5py.File(io.BytesIO(content), "r"))

    def values(self, data: Any) -> NDArray[Any]:
        """All values of a data set; texts as str."""
        return np.asarray(self.attempt(partial(_values, data)))


def groups_of_hdf5(content: bytes, path: Path, place: Location) -> list[Group]:
    """Each group with its data sets: a vector is a column, of a matrix `x[2]` is the second one.

    The fields of a compound data set are columns of a group of that name. A unit is that of an
    attribute `units` or `unit`. What lies in other files is never opened.
    """
    opened = Opened(content, path, place, "an HDF5 file", "hdf5")
    found: list[Group] = opened.attempt(lambda: _groups(opened))
    return found


def _groups(opened: Opened) -> list[Group]:
    found: defaultdict[str, list[Column]] = defaultdict(list)
    for name, data in data_sets(opened.file):
        group, _, head = name.rpartition("/")
        if data.dtype.names:
            found[name] += [
                Column(field, partial(_field, opened, data, field)) for field in data.dtype.names
            ]
        elif data.ndim == 1:
            found[group].append(Column(head, partial(opened.values, data), _unit(data)))
        elif data.ndim == 2 and min(data.shape) <= FILE.most_columns:
            found[group] += [
                Column(f"{head}[{n + 1}]", partial(_column, opened, data, n), _unit(data))
                for n in range(min(data.shape))
            ]
    return [Group(name, tuple(columns)) for name, columns in found.items()]


def data_sets(group: Any, name: str = "", depth: int = 0) -> Iterator[tuple[str, Any]]:
    """The data sets of a group and those below it, by their paths; links elsewhere are passed by.

    A link to another file, and data that are stored in other files, could name any file.
    """
    for key in group if depth <= FILE.most_depth else ():
        if type(group.get(key, getlink=True)).__name__ != "HardLink":
            continue
        item, path = group[key], f"{name}/{key}" if name else key
        if hasattr(item, "keys"):
            yield from data_sets(item, path, depth + 1)
        elif hasattr(item, "dtype") and item.external is None and not item.is_virtual:
            yield path, item


def _values(data: Any) -> NDArray[Any]:
    if data.nbytes > FILE.most_unpacked:
        raise ValueError(f"'{data.name}' holds more than {FILE.most_unpacked / 1e9:g} GB")
    values = np.asarray(data[()])
    if values.dtype.kind in "OS":  # texts of any length are bytes
        texts = [v.decode("utf-8", "replace") if isinstance(v, bytes) else v for v in values.flat]
        values = np.array(texts, dtype=object).reshape(values.shape)
    return values


def _field(opened: Opened, data: Any, field: str) -> NDArray[Any]:
    return np.asarray(opened.values(data)[field])


def _column(opened: Opened, data: Any, n: int) -> NDArray[Any]:
    """A column of a matrix, which may lie on its side."""
    matrix = opened.values(data)
    upright = matrix if matrix.shape[0] >= matrix.shape[1] else matrix.T
    return np.asarray(upright[:, n])


def _unit(data: Any) -> str:
    """The unit that an attribute gives."""
    for name in UNITS:
        value = data.attrs.get(name)
        if isinstance(value, bytes | str):
            return value.decode("utf-8", "replace") if isinstance(value, bytes) else value
    return ""
