"""Columns of what stores whole vectors by name: tables of a data base, HDF5, TDMS, MDF, frames."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.data.dates import read_dates, seconds_since_first
from tracewire.data.limits import FILE
from tracewire.data.request import (
    Found,
    Request,
    none_left,
    problems_of,
    raise_first,
    too_few,
    without_missing,
)
from tracewire.data.table import matches, split_unit, unknown_column
from tracewire.errors import DataError, Location, Problem


@dataclass(frozen=True)
class Column:
    """A vector of a file: the `head` that names it, with a unit in brackets or not, its unit where
    that stands elsewhere, what reads it, and whether its values are dates in UTC."""

    head: str
    read: Callable[[], NDArray[Any]]
    unit: str = ""
    in_utc: bool = False

    @property
    def its_unit(self) -> str:
        """The unit beside it, else that of its head."""
        return self.unit or split_unit(self.head)[1]


@dataclass(frozen=True)
class Group:
    """Columns that stand together in a file; the name is '' where there is one group only."""

    name: str
    columns: tuple[Column, ...]

    @property
    def heads(self) -> tuple[str, ...]:
        """What its columns are called."""
        return tuple(column.head for column in self.columns)

    def address(self, head: str) -> str:
        """The name of a column in the whole file."""
        return f"{self.name}/{head}" if self.name else head


def columns_of_groups(
    groups: Sequence[Group], request: Request, file: str, place: Location, *, numbered: bool = False
) -> Found:
    """The wanted columns of groups.

    A column is named by its group and its head, `run 3/theta [deg]`, or without the unit, or by
    its head alone where one group has it, or one group has all of these columns; where columns are
    `numbered`, also by its number from 1. Raises DataError.
    """
    chosen = [c for _, c in choose(groups, request.names, file, place, numbered=numbered)]
    return found_of(
        [column.read() for column in chosen],
        [column.its_unit for column in chosen],
        request,
        file,
        place,
        in_utc=request.clock is not None and chosen[request.clock].in_utc,
    )


def found_of(
    arrays: Sequence[NDArray[Any]],
    units: Sequence[str],
    request: Request,
    file: str,
    place: Location,
    *,
    in_utc: bool = False,
) -> Found:
    """The rows of vectors of any type that are asked for, as numbers. Raises DataError.

    in_utc: dates of the time that say nothing of a zone are in UTC.
    """
    problems: list[Problem] = []
    lengths = {name: len(a) for name, a in zip(request.names, arrays, strict=True)}
    if len(set(lengths.values())) > 1:
        what = f"the columns of '{file}' have different lengths"
        exists = tuple(f"{name} ({count})" for name, count in lengths.items())
        raise DataError.one(what, place, exists, "Name columns of one record.")
    count = len(request.wanted)
    kept = np.ones(len(arrays[0]), dtype=bool)
    if request.where:
        kept = _rows(arrays[count:], request.where, file, place)
    if kept.sum() < 2:
        raise too_few(int(kept.sum()), file)
    series: list[Vector] = []
    since = ""
    for n, name in enumerate(request.wanted):
        part = arrays[n][kept]
        dates = _dates(part, in_utc) if n == request.clock else None
        if dates is not None:
            numbers, since = seconds_since_first(*dates)
        else:
            made = _numbers(part)
            if isinstance(made, str):
                problems.append(Problem(f"'{name}' of '{file}' {made}", place))
                continue
            numbers = made
        series.append(numbers)
    if problems:
        raise DataError(list(dict.fromkeys(problems))[: FILE.most_problems])
    names = [f"'{name}'" for name in request.wanted]
    lines = np.zeros(int(kept.sum()), dtype=np.int64)
    found = Found(series, list(units[:count]), names, lines, since=since)
    found = without_missing(found, request)
    problems = problems_of(found, request, file)
    raise_first(problems, len(problems), file)
    return found


def addresses(groups: Iterable[Group]) -> list[str]:
    """The names of all columns."""
    return [group.address(head) for group in groups for head in group.heads]


def choose(
    groups: Sequence[Group],
    names: Sequence[str],
    file: str,
    place: Location,
    *,
    numbered: bool = False,
) -> list[tuple[int, Column]]:
    """The column of each name, with the number of its group. Raises DataError."""
    found = [list(_candidates(groups, name, numbered)) for name in names]
    # where several groups have a column of that name: the one group that has all of them
    groups_of = [{group for group, _ in some} for some in found if some]
    shared = set.intersection(*groups_of) if groups_of else set()
    known = addresses(groups)
    problems = [
        unknown_column(name, known, place, file)
        for name, some in zip(names, found, strict=True)
        if not some
    ]
    if problems:  # with another name in its place, what is ambiguous may be clear
        raise DataError(list(dict.fromkeys(problems))[: FILE.most_problems])
    chosen: list[tuple[int, Column]] = []
    for name, some in zip(names, found, strict=True):
        if len(some) > 1 and len(shared) == 1:
            some = [pair for pair in some if pair[0] in shared]
        if len(some) == 1:
            chosen.append(some[0])
        else:
            what = f"'{name}' is the name of {len(some)} columns of '{file}'"
            full = tuple(groups[n].address(column.head) for n, column in some)
            hint = "Give the number." if len(set(full)) == 1 else "Write one of these."
            problems.append(Problem(what, place, full, hint))
    if problems:
        raise DataError(list(dict.fromkeys(problems))[: FILE.most_problems])
    return chosen


def _candidates(groups: Sequence[Group], name: str, numbered: bool) -> Iterator[tuple[int, Column]]:
    """The columns of this name, each with the number of its group: full names before short ones."""
    full = [
        (n, group.columns[i])
        for n, group in enumerate(groups)
        for i in matches(
            name.removeprefix("/"), [group.address(h).removeprefix("/") for h in group.heads]
        )
    ]
    short = [
        (n, group.columns[i]) for n, group in enumerate(groups) for i in matches(name, group.heads)
    ]
    yield from full or short
    number = int(name) if name.isascii() and name.isdigit() and len(name) < 9 else 0
    if not full and not short and numbered and len(groups) == 1:
        yield from ((0, column) for column in groups[0].columns[number - 1 : number] if number)


def _rows(
    arrays: Sequence[NDArray[Any]], where: Mapping[str, str | float], file: str, place: Location
) -> NDArray[np.bool_]:
    """Which rows have the values that `where` asks for."""
    rows = np.ones(len(arrays[0]), dtype=bool)
    seen: list[list[str]] = []
    for array, wanted in zip(arrays, where.values(), strict=True):
        numbers = _numbers(array)
        if isinstance(numbers, str):
            texts = np.array([str(value) for value in array], dtype=object)
            seen.append([str(text) for text in dict.fromkeys(texts[rows][: FILE.most_texts])])
            rows &= texts == str(wanted)
        else:
            seen.append([f"{value:g}" for value in np.unique(numbers[rows])[: FILE.most_texts]])
            rows &= numbers == (wanted if isinstance(wanted, float) else np.nan)
    if not rows.any():
        raise none_left(where, seen, file, place)
    return rows


def _numbers(array: NDArray[Any]) -> Vector | str:
    """The values as numbers, NaN where one is missing; else what the column is, in words."""
    kind = array.dtype.kind
    if array.ndim != 1:
        return f"is an array of {' x '.join(map(str, array.shape))}, and not one column"
    if isinstance(array, np.ma.MaskedArray):
        return np.ma.filled(array.astype(np.float64), np.nan)
    if kind in "biuf":
        return np.ascontiguousarray(array, dtype=np.float64)
    if kind == "m":
        return np.asarray(array / np.timedelta64(1, "ns") * 1e-9, dtype=np.float64)
    if kind == "M":
        return "is a date, and only the time may be dates"
    if kind == "c":
        return "is complex"
    if kind == "O":
        try:
            return np.array([np.nan if v is None else v for v in array], dtype=np.float64)
        except (TypeError, ValueError):
            pass
    return "is text, and not numbers"


def _dates(array: NDArray[Any], in_utc: bool) -> tuple[NDArray[np.int64], bool] | None:
    """Nanoseconds since 1970 where all values are dates, and whether they have a zone."""
    if array.ndim == 1 and array.dtype.kind == "M" and not np.isnat(array).any():
        return array.astype("datetime64[ns]").astype(np.int64), in_utc
    if array.ndim == 1 and array.dtype.kind in "OUT":
        return read_dates([str(value) for value in array])
    return None
