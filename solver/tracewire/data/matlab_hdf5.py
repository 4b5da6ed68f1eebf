"""The variables of a MATLAB file of version 7.3, which is an HDF5 file.

Arrays are stored in the order of MATLAB, so that their shape is turned round here; a struct is a
group; cells and struct arrays are references into the group `#refs#`.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from tracewire.data.hdf5 import Opened
from tracewire.data.limits import FILE
from tracewire.data.matfile import Cells, Other, Structs, Value
from tracewire.errors import Location

MARK = b"MATLAB 7.3"
CLASS = "MATLAB_class"
NUMERIC = {
    "double",
    "single",
    "logical",
    *(f"{u}int{n}" for u in ("", "u") for n in (8, 16, 32, 64)),
}
OTHERS = {"char": "a text", "function_handle": "a function"}


def is_matlab_hdf5(content: bytes) -> bool:
    """Whether a file is one of MATLAB's version 7.3."""
    return content.startswith(MARK)


def variables_of_hdf5(content: bytes, path: Path, place: Location) -> Mapping[str, Value]:
    """Every variable by name. Raises DataError."""
    opened = Opened(content, path, place, "a MATLAB file of version 7.3", "matlab")
    found: Mapping[str, Value] = opened.attempt(lambda: _variables(opened))
    return found


def _variables(opened: Opened) -> dict[str, Value]:
    file = opened.file

    def value_of(item: Any, depth: int) -> Value:
        if depth > FILE.most_depth:
            return Other("nested too deeply")
        if hasattr(item, "keys"):
            fields = {name: field(item, name, depth + 1) for name in item}
            # the fields of a struct array are references too, and only those have no class
            if fields and all(CLASS not in item[name].attrs and isinstance(v, Cells)
                              for name, v in fields.items()):  # fmt: skip
                entries = zip(*fields.values(), strict=False)
                return Structs(dict(zip(fields, entry, strict=True)) for entry in entries)
            return Structs((fields,))
        kind = item.attrs.get(CLASS, b"double")
        kind = kind.decode("ascii", "replace") if isinstance(kind, bytes) else str(kind)
        if item.external is not None or item.is_virtual:
            return Other("stored in another file")
        if "MATLAB_empty" in item.attrs:
            return np.zeros((0, 0))
        if item.dtype.kind == "O":  # references
            return Cells(
                value_of(file[reference], depth + 1)
                for reference in item[()].T.ravel(order="F")
                if reference
            )
        if kind not in NUMERIC:
            return Other(OTHERS.get(kind, "an object of a class"))
        values = opened.values(item).T
        if values.dtype.names:
            real, imaginary = (values[name] for name in values.dtype.names)
            return np.asarray(real + 1j * imaginary)
        return values

    def field(group: Any, name: str, depth: int) -> Value:
        if type(group.get(name, getlink=True)).__name__ != "HardLink":
            return Other("stored in another file")
        return value_of(group[name], depth)

    return {name: field(file, name, 0) for name in file if not name.startswith("#")}
