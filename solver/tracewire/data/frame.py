"""The columns of a table in memory: a frame of pandas, polars or pyarrow, or arrays by name.

None of these packages is imported: a frame is known by what it can do.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.data.read import Columns, columns_of
from tracewire.data.request import Request
from tracewire.data.vectors import Column, Group, columns_of_groups
from tracewire.errors import DataError, Location


def read_frame(
    frame: Any,
    columns: Mapping[str, str],
    time: str | None = None,
    name: str = "frame",
    sparse: Collection[str] = (),
) -> Columns:
    """The named columns of a frame, as `read_columns` has those of a file.

    frame: a DataFrame of pandas or polars, a Table of pyarrow, a structured array of numpy, or a
        mapping of names to arrays.
    time: the column of time; the first one where None. The index of a pandas frame is the first
        where it has a name, dates, or numbers with a fraction.
    name: what messages call the frame.
    sparse: series that may lack a value in some rows, NaN then.

    A unit is that of a name such as `theta [deg]`, or `frame.attrs["units"]["theta"]` of pandas.
    Raises DataError as `read_columns` does, with rows counted from 1.
    """
    place = Location(name)
    group = Group("", tuple(_columns(frame, place)))
    names = (*columns.values(), "1" if time is None else time)
    lacking = frozenset(place for place, key in enumerate(columns) if key in sparse)
    request = Request(names, len(names) - 1, {}, sparse=lacking)
    found = columns_of_groups([group], request, name, place, numbered=True)
    return columns_of(found, columns, name)


def _columns(frame: Any, place: Location) -> Iterator[Column]:
    """Every column of a frame."""
    if isinstance(frame, Mapping):
        for key, values in frame.items():
            yield Column(str(key), partial(_values, values))
    elif isinstance(frame, np.ndarray) and frame.dtype.names:
        for key in frame.dtype.names:
            yield Column(key, partial(_values, frame[key]))
    elif hasattr(frame, "iloc") and hasattr(frame, "columns"):
        yield from _columns_of_pandas(frame)
    elif hasattr(frame, "column_names"):
        for n, key in enumerate(frame.column_names):
            column = frame.column(n)
            in_utc = bool(getattr(column.type, "tz", None))
            yield Column(str(key), partial(_values, column), in_utc=in_utc)
    elif hasattr(frame, "get_column") and hasattr(frame, "columns"):
        for key in frame.columns:
            column = frame.get_column(key)
            in_utc = bool(getattr(column.dtype, "time_zone", None))
            yield Column(str(key), partial(_values, column), in_utc=in_utc)
    else:
        kind = f"{type(frame).__module__.partition('.')[0]}.{type(frame).__name__}"
        hint = "Give a frame of pandas or polars, or a mapping of names to arrays."
        if hasattr(frame, "collect"):
            hint = "Collect it first: frame.collect()."
        raise DataError.one(f"a {kind} is no table with named columns", place, hint=hint)


def _columns_of_pandas(frame: Any) -> Iterator[Column]:
    units = frame.attrs.get("units", {})
    index = frame.index
    if index.nlevels == 1 and (index.name is not None or index.dtype.kind in "fmM"):
        head = "t" if index.name is None else str(index.name)
        yield _column_of_pandas(head, index.to_series(), units)
    for n, key in enumerate(frame.columns):
        yield _column_of_pandas(str(key), frame.iloc[:, n], units)


def _column_of_pandas(head: str, series: Any, units: Mapping[str, str]) -> Column:
    unit, kind = str(units.get(head, "")), series.dtype.kind
    if getattr(series.dtype, "tz", None) is not None:
        plain = series.dt.tz_convert("UTC").dt.tz_localize(None)
        return Column(head, partial(_values, plain), unit, in_utc=True)
    if kind in "biuf" and not isinstance(series.dtype, np.dtype):  # may hold pandas.NA
        return Column(head, partial(series.to_numpy, dtype=float, na_value=np.nan), unit)
    return Column(head, partial(_values, series), unit)


def _values(column: Any) -> NDArray[Any]:
    """The values of a column as an array."""
    to_numpy = getattr(column, "to_numpy", None)
    return np.asarray(column if to_numpy is None else to_numpy())
