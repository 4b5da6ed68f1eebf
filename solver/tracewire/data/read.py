"""Columns of a file, whatever its format, and the record in SI that they are."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.data.formats import opened
from tracewire.data.record import Record
from tracewire.data.request import Found, Request
from tracewire.errors import DataError, FormulaError, Location, OptionError, Problem
from tracewire.formula import Unit, has_offset, read_unit, same_quantity


@dataclass(frozen=True, eq=False)
class Columns:
    """Series of one file, N rows each, as they stand there: no unit is converted.

    time (N,), strictly increasing; values: name -> (N,); lines (N,), the line of each row in the
    file, from 1 (0 in a file without lines); file: the path as it was given. `units` has the text
    of the unit that the header gives to a series, `time_unit` that of time; `remarks` tell what is
    odd about the file; `since` is the date at which the time is 0, where the file has dates. The
    arrays are read-only.
    """

    time: Vector
    values: dict[str, Vector]
    lines: NDArray[np.int64]
    file: str
    units: Mapping[str, str] = field(default_factory=dict)
    time_unit: str = ""
    remarks: tuple[str, ...] = ()
    since: str = ""


def read_columns(
    path: str | Path,
    columns: Mapping[str, str],
    time: str | None = None,
    delimiter: str | None = None,
    comment: str = "#",
    place: Location = Location(),
    *,
    decimal: str | None = None,
    every: float | None = None,
    where: Mapping[str, str | float] | None = None,
    in_any_order: bool = False,
    sparse: Collection[str] = (),
    missing: Sequence[float] = (),
) -> Columns:
    """Read the named columns of a file.

    columns: name of the series -> the column's header, or its number from 1; in a .mat file the
        name of a vector: `theta`, `data.theta`, `x_F[2]` (the second column of a matrix); in a file
        with groups or sheets `group/theta`.
    time: header or number of the column of time; the first column where None (of a table). Its
        values are numbers, or dates as ISO 8601 writes them, which become s from the earliest on.
    delimiter, decimal: one character, " " for any blanks, and "." or ","; found from the first rows
        where None.
    comment: what a line to be left out starts with; "" for none. A comment right above the first
        row that has as many names as there are columns is the header where there is no other.
    place: where the file is named, for the problems of the file as a whole.
    every: the interval between rows, of a file without a column of time; the first row is at 0.
    where: column -> the text or number that a row must have there; other rows are left out.
    in_any_order: the time need not increase from row to row.
    sparse: series that may lack a value in some rows, NaN then: a blank cell, NaN, NA or null.
    missing: numbers that stand for no value in any column but the time, as the file has them.

    A header is found exactly, or without a unit in brackets: "t" finds "t [s]" and "t (s)". Lines
    before the header that are no part of the table are left out, with a remark. Every other number
    in the columns that are used must be finite, the time must increase from row to row.

    Raises DataError with up to ten problems, each with its line; OptionError on a wrong argument.
    """
    path = Path(path)
    file = str(path)
    place = place if str(place) else Location(file)
    _check_arguments(delimiter, decimal, every, place)
    known, content = opened(path, place)
    if every is None and time is None and not known.is_table:
        what = f"'{file}' has no first column that could be the time"
        raise DataError.one(what, place, hint="Name the column of time, or the interval of rows.")
    names = list(columns.values())
    if every is None:
        names.append("1" if time is None else time)
    conditions = {
        name: wanted if isinstance(wanted, str) else float(wanted)
        for name, wanted in (where or {}).items()
    }
    clock = len(names) - 1 if every is None else None
    request = Request(
        tuple(names),
        clock,
        conditions,
        (delimiter, decimal),
        comment,
        in_any_order,
        frozenset(place for place, name in enumerate(columns) if name in sparse),
        tuple(missing),
    )
    found = known.columns(content, path, request, place)
    return columns_of(found, columns, file, every)


def columns_of(
    found: Found, columns: Mapping[str, str], file: str, every: float | None = None
) -> Columns:
    """What was found as the columns of a file; the time stands behind the others."""
    series = dict(zip(columns, found.series, strict=False))
    return Columns(
        _fixed(np.arange(len(found.lines)) * every if every else found.series[-1]),
        {name: _fixed(values) for name, values in series.items()},
        _fixed_lines(found.lines),
        file,
        dict(zip(columns, found.units, strict=False)),
        "" if every else found.units[-1],
        found.remarks,
        found.since,
    )


def column_unit(path: str | Path, column: str, delimiter: str | None = None) -> str:
    """The unit that the header gives to a column; '' where it gives none or cannot be read."""
    try:
        changed = Path(path).stat()
    except OSError:
        return ""
    return _column_unit(Path(path), column, delimiter, changed.st_mtime_ns, changed.st_size)


@lru_cache(maxsize=64)
def _column_unit(path: Path, column: str, delimiter: str | None, changed: int, size: int) -> str:
    """The same for a file as it was when it was `changed`, in ns, with so many bytes."""
    try:
        found = read_columns(path, {"it": column}, delimiter=delimiter, every=1.0)
    except (DataError, OptionError):
        return ""
    return found.units["it"]


def _check_arguments(
    delimiter: str | None, decimal: str | None, every: float | None, place: Location
) -> None:
    if delimiter is not None and not _is_delimiter(delimiter):
        hint = "Give one character, such as ',' or ';' or a tab; ' ' stands for any blanks."
        raise DataError.one(f"the delimiter {delimiter!r} cannot be used", place, hint=hint)
    if decimal not in (None, ".", ","):
        hint = "It is '.' or ','."
        raise DataError.one(f"the decimal sign {decimal!r} cannot be used", place, hint=hint)
    if every is not None and not (math.isfinite(every) and every > 0):
        hint = "It is the time in s from one row to the next."
        raise DataError.one(
            f"the interval of rows must be above zero, not {every:g}", place, hint=hint
        )


def _is_delimiter(text: str) -> bool:
    return len(text) == 1 and not text.isalnum() and text not in '"\r\n.+-\0'


def _fixed(numbers: NDArray[np.floating]) -> Vector:
    """A read-only copy of the numbers."""
    fixed = np.array(numbers, dtype=np.float64)
    fixed.setflags(write=False)
    return fixed


def _fixed_lines(numbers: NDArray[np.int64]) -> NDArray[np.int64]:
    fixed = np.array(numbers, dtype=np.int64)
    fixed.setflags(write=False)
    return fixed


def read_record(
    path: str | Path,
    columns: Mapping[str, str],
    time: str | None = None,
    *,
    units: Mapping[str, str] | None = None,
    time_unit: str | None = None,
    raw: Collection[str] = (),
    delimiter: str | None = None,
    decimal: str | None = None,
    comment: str = "#",
    every: float | None = None,
    where: Mapping[str, str | float] | None = None,
    in_any_order: bool = False,
    sparse: Collection[str] = (),
    missing: Sequence[float] = (),
    place: Location = Location(),
) -> Record:
    """Read the named columns of a file as a record in SI.

    units, time_unit, raw: see `record_of`. For the other arguments see `read_columns`; `every` is
    in s. Raises DataError and FormulaError as these do.
    """
    read = read_columns(
        path,
        columns,
        time,
        delimiter,
        comment,
        place,
        decimal=decimal,
        every=every,
        where=where,
        in_any_order=in_any_order,
        sparse=sparse,
        missing=missing,
    )
    unit = "s" if every is not None else time_unit
    return record_of(read, units or {}, unit, raw, place)


def record_of(
    read: Columns,
    units: Mapping[str, str],
    time_unit: str | None = None,
    raw: Collection[str] = (),
    place: Location = Location(),
) -> Record:
    """Columns as a record in SI.

    units: the unit of a column, by the name of its series. For the others, a unit that the header
        has in brackets counts, and this is told as a step; brackets that hold no unit are told as
        a remark.
    time_unit: the unit of time; without it that of the header, else s.
    raw: series whose numbers are taken as they are, without a unit: to be calibrated.

    Raises DataError where a header says another unit than `units`, FormulaError where what is given
    is no unit.
    """
    place = place if str(place) else Location(read.file)
    said = _Said(read.file, place)
    clock = said.clock(time_unit, read)
    used = {
        name: said.unit(f"'{name}'", units.get(name), read.units[name])
        for name in read.values
        if name not in raw
    }
    if said.problems:
        raise DataError(said.problems)
    values = {
        name: series * used[name].factor if name in used else series
        for name, series in read.values.items()
    }
    remarks = (*read.remarks, *said.remarks)
    return Record(
        read.time * clock.factor, values, used, clock, tuple(said.steps), remarks, read.file
    )


@dataclass(frozen=True, eq=False)
class Curve:
    """Two columns of a file in SI, of which x ascends; `units` has None where none is said."""

    x: Vector
    y: Vector
    units: tuple[str | None, str | None]


def read_curve(
    path: str | Path,
    x: str,
    y: str,
    units: tuple[str | None, str | None] = (None, None),
    place: Location = Location(),
) -> Curve:
    """The columns x and y of a file, each in its unit of `units`, or else in that of its header.

    Raises DataError as `read_columns` does, and where a header says another unit than `units`.
    """
    read = read_columns(path, {"y": y}, x, place=place)
    said = _Said(read.file, place)
    headers = (read.time_unit, read.units["y"])
    used = [
        said.unit(f"column '{name}'", declared, header)
        for name, declared, header in zip((x, y), units, headers, strict=True)
    ]
    if said.problems:
        raise DataError(said.problems)
    known = [
        unit.text if declared is not None or _unit_or_none(header or "-") is not None else None
        for unit, declared, header in zip(used, units, headers, strict=True)
    ]
    scaled = (read.time * used[0].factor, read.values["y"] * used[1].factor)
    return Curve(*scaled, (known[0], known[1]))


class _Said:
    """What headers say of units, against what is declared."""

    def __init__(self, file: str, place: Location) -> None:
        self.file, self.place = file, place
        self.steps: list[str] = []
        self.remarks: list[str] = []
        self.problems: list[Problem] = []

    def clock(self, declared: str | None, read: Columns) -> Unit:
        """The unit of the time; of dates it is s, from the earliest one on."""
        if not read.since:
            return self.unit("the time", declared, read.time_unit, "s")
        self.steps.append(f"time: t = 0 is {read.since}, the earliest of the file")
        if declared not in (None, "s"):
            what = f"the times of '{read.file}' are dates, and the time is said to be in {declared}"
            self.problems.append(Problem(what, self.place, hint="Leave out its unit."))
        return Unit("s", 1.0)

    def unit(self, what: str, declared: str | None, header: str, default: str = "") -> Unit:
        """The unit of a column: as declared, else as its header says, else the default."""
        by_header = _unit_or_none(header) if header else None
        if by_header is None:
            if header and declared is None:
                remark = f"{what}: the header has '{header}', which is no unit"
                if has_offset(header):
                    remark += ": a temperature is in K; say unit: K where only differences count"
                self.remarks.append(remark)
            text = default if declared is None else declared
        else:
            text = header if declared is None else declared
            if declared is None and by_header.factor != 1.0:
                name = what.strip("'").removeprefix("the ")
                shown = by_header.text or f"plain numbers (1 {header} is {by_header.factor:g})"
                self.steps.append(f"{name}: from {header} to {shown}, as the header says")
        unit = read_unit(text, self.place)
        if by_header is not None and (
            by_header.factor != unit.factor or not same_quantity(header, text)
        ):
            problem = f"{what} is declared in '{text}', and in '{header}' by its header"
            hint = "Correct the one that is wrong; without `unit:` that of the header holds."
            self.problems.append(Problem(f"{problem} in '{self.file}'", self.place, hint=hint))
        elif default and not same_quantity(text, default):
            problem = f"{what} of '{self.file}' is in '{text}', which is no unit of time"
            self.problems.append(Problem(problem, self.place, hint="Name the column of time."))
        return unit


def _unit_or_none(text: str) -> Unit | None:
    try:
        return read_unit(text)
    except FormulaError:
        return None
