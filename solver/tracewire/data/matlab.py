"""The columns of a MATLAB file (.mat, of any version): vectors, matrices, structs, cells."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from tracewire.array_types import Vector
from tracewire.data.limits import FILE
from tracewire.data.matfile import Cells, Damaged, Other, Structs, Value, variables_of
from tracewire.data.matlab_hdf5 import is_matlab_hdf5, variables_of_hdf5
from tracewire.data.request import Found, Request
from tracewire.data.vectors import found_of
from tracewire.errors import DataError, Location, Problem, unknown

STEP = re.compile(r"\.([^\W\d]\w*)|\[(\d{1,9})\]")
ADDRESS = re.compile(r"[^\W\d]\w*(?:\.[^\W\d]\w*|\[\d{1,9}\])*")


def columns_of_matlab(content: bytes, path: Path, request: Request, place: Location) -> Found:
    """The wanted columns of a .mat file.

    A column is a vector, `x`; a column of a matrix, `x_F[2]`, from 1 (its rows where it has more
    columns than rows); a field of a struct, `data.theta`; an entry of a cell array, `runs[3]`, and
    what these hold. Nothing in the file is run, and objects of classes are not built.

    Raises DataError: not a .mat file, no such column, not numbers, different lengths.
    """
    file = str(path)
    variables = _variables(content, path, place)
    columns = [_column(name, variables, file, place) for name in request.names]
    problems = [column for column in columns if isinstance(column, Problem)]
    if problems:
        raise DataError(list(dict.fromkeys(problems)))
    vectors = [column for column in columns if not isinstance(column, Problem)]
    return found_of(vectors, [""] * len(vectors), request, file, place)


def names_in_matlab(content: bytes, path: Path, place: Location) -> list[str]:
    """The vectors of a .mat file by their names, the longest first. Raises DataError."""
    return _addresses(_variables(content, path, place))


def _variables(content: bytes, path: Path, place: Location) -> Mapping[str, Value]:
    """Every variable of the file by name."""
    try:
        if is_matlab_hdf5(content):
            return variables_of_hdf5(content, path, place)
        return _of_version_4(content) if 0 in content[:4] else variables_of(content)
    except Damaged as error:
        what = f"'{path}' cannot be read as a MATLAB file: {error}"
        raise DataError.one(what, place, hint="Save it again, or as CSV.") from None


def _of_version_4(content: bytes) -> Mapping[str, Value]:
    """The variables of an old file, which begins with a number and not with a text."""
    from scipy import io as scipy_io  # a tenth of a second: only these files pay for it

    matlab: Any = scipy_io  # its stubs do not know files in memory
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            loaded = matlab.loadmat(io.BytesIO(content))
    except Exception as error:  # scipy raises nearly every kind on a damaged file
        raise Damaged(str(error) or type(error).__name__) from None
    return {name: value for name, value in loaded.items() if not name.startswith("__")}


def _column(
    name: str, variables: Mapping[str, Value], file: str, place: Location
) -> Vector | Problem:
    """The vector at an address, or what is wrong with it."""
    value = _at(name, variables)
    if value is None:
        problem = unknown("column", name, _addresses(variables), place)
        return Problem(f"{problem.what} in '{file}'", place, problem.exists, problem.hint)
    if not isinstance(value, np.ndarray) or value.dtype.kind not in "biuf":
        kind = value if isinstance(value, Other) else "complex"
        kind = "not an array of numbers" if isinstance(value, Cells | Structs) else kind
        kind = "a text" if isinstance(value, np.ndarray) and value.dtype.kind == "U" else kind
        return Problem(f"'{name}' of '{file}' is {kind}", place, tuple(_addresses(variables)))
    squeezed = np.squeeze(value)
    if squeezed.ndim == 0:
        exists = tuple(_addresses(variables))
        return Problem(f"'{name}' of '{file}' is a single number", place, exists)
    if squeezed.ndim > 1:
        count = min(squeezed.shape)
        what = f"'{name}' of '{file}' is an array of {' x '.join(map(str, squeezed.shape))}"
        hint = f"Name one of its {count} columns, '{name}[1]' to '{name}[{count}]'."
        return Problem(what, place, hint=hint if squeezed.ndim == 2 else "Save it as a matrix.")
    return np.ascontiguousarray(squeezed, dtype=np.float64)


def _at(name: str, variables: Mapping[str, Value]) -> Value | None:
    """What is at an address; None where there is nothing."""
    if not ADDRESS.fullmatch(name):
        return None
    root = re.split(r"[.\[]", name, maxsplit=1)[0]
    value = variables.get(root)
    for field, index in STEP.findall(name[len(root) :]):
        value = _field(value, field) if field else _entry(value, int(index))
    return value


def _field(value: Value | None, name: str) -> Value | None:
    return value[0].get(name) if isinstance(value, Structs) and len(value) == 1 else None


def _entry(value: Value | None, index: int) -> Value | None:
    """Entry of a cell or struct array (down its columns), or column of a matrix; from 1."""
    if isinstance(value, Structs | Cells):
        if not 1 <= index <= len(value):
            return None
        return Structs((value[index - 1],)) if isinstance(value, Structs) else value[index - 1]
    if not isinstance(value, np.ndarray):
        return None
    squeezed = np.squeeze(value)
    if squeezed.ndim != 2 or not 1 <= index <= min(squeezed.shape):
        return None
    upright = squeezed if squeezed.shape[0] >= squeezed.shape[1] else squeezed.T
    return np.asarray(upright[:, index - 1])


def _addresses(variables: Mapping[str, Value]) -> list[str]:
    """The vectors that there are, by their addresses; the longest first."""

    def walk(name: str, value: Value | None, depth: int) -> Iterator[tuple[str, int]]:
        if depth > FILE.listed_depth:
            return
        if isinstance(value, Structs) and len(value) == 1:
            for field, inner in value[0].items():
                yield from walk(f"{name}.{field}", inner, depth + 1)
        elif isinstance(value, Structs | Cells):
            for i in range(1, min(len(value), FILE.most_columns) + 1):
                yield from walk(f"{name}[{i}]", _entry(value, i), depth + 1)
        elif isinstance(value, np.ndarray) and value.dtype.kind in "biuf":
            shape = np.squeeze(value).shape
            if len(shape) == 1:
                yield name, shape[0]
            elif len(shape) == 2 and min(shape) <= FILE.most_columns:
                for i in range(1, min(shape) + 1):
                    yield f"{name}[{i}]", max(shape)

    found = [pair for name, value in variables.items() for pair in walk(name, value, 0)]
    return [name for name, _ in sorted(found, key=lambda pair: -pair[1])][: FILE.most_columns]
