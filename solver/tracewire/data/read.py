"""Measured series from a text file with columns of numbers (CSV)."""

from __future__ import annotations

import itertools
import re
from array import array
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from tracewire.data.table import (
    Row,
    commented_header,
    header_of,
    matches,
    number,
    read_lines,
    rows_of,
    sniff,
)
from tracewire.errors import DataError, Place, Problem, unknown

MOST_PROBLEMS = 10
DECIMAL_COMMA = "Is it a decimal comma? Write 1.5, and not 1,5."
NO_ROWS = "A series needs at least two rows of numbers."
REPAIR = "Repair or remove this line."
HINTS = (
    ("", "Leave out the rows without a value."),
    (r"[+-]?\d+,\d+(e[+-]?\d+)?", DECIMAL_COMMA),
    (r"[+-]?\d*\.?\d*[dD][+-]?\d+", "Write exponents with e, as in 1e-3."),
)
Number = TypeVar("Number", np.float64, np.int64)


@dataclass(frozen=True, eq=False)
class Columns:
    """Series of one file, N rows each, as they stand there: no unit is converted.

    time (N,), strictly increasing; values: name -> (N,); lines (N,), the line of each row in the
    file, from 1; file: the path as it was given. The arrays are read-only.
    """

    time: NDArray[np.float64]
    values: dict[str, NDArray[np.float64]]
    lines: NDArray[np.int64]
    file: str


def read_columns(
    path: str | Path,
    columns: Mapping[str, str],
    time: str | None = None,
    delimiter: str | None = None,
    comment: str = "#",
    place: Place = Place(),
) -> Columns:
    """Read the named columns of a text file.

    columns: name of the series -> the column's header, or its number from 1.
    time: header or number of the column of time; the first column where None.
    delimiter: one character, " " for any blanks; found from the first rows where None.
    comment: what a line to be left out starts with; "" for none. A comment right above the first
        row that has as many names as there are columns is the header where there is no other.
    place: where the file is named, for the problems of the file as a whole.

    A header is found exactly, or without a unit in brackets: "t" finds "t [s]" and "t (s)". Every
    number in the columns that are used must be finite, the time must increase from row to row.

    Raises DataError with up to ten problems, each with its line.
    """
    path = Path(path)
    file = str(path)
    place = place if str(place) else Place(file)
    lines = read_lines(path, place)
    if delimiter is not None and not _is_delimiter(delimiter):
        hint = "Give one character, such as ',' or ';' or a tab; ' ' stands for any blanks."
        raise DataError.one(f"the delimiter {delimiter!r} cannot be used", place, hint=hint)
    cut = sniff(lines, comment) if delimiter is None else delimiter

    rows = rows_of(lines, cut, comment)
    first = next(rows, None)
    if first is None:
        raise DataError.one(f"'{file}' holds nothing but comments", place, hint=NO_ROWS)
    if first.broken:
        raise DataError.one(first.broken, Place(file, first.line), hint=REPAIR)
    wanted = [*columns.values(), *([] if time is None else [time])]
    names = header_of(first, wanted)
    if not names:
        rows = itertools.chain([first], rows)
        names = commented_header(lines, cut, comment, first)
    found = _find_all(wanted, names, len(first.cells), place, file)
    clock = 0 if time is None else found.pop()

    reading = _Reading(file, cut, len(first.cells), names, sorted({clock, *found}))
    reading.take(rows)
    reading.check(clock)
    reading.finish()
    series = {column: _fixed(kept, np.float64) for column, kept in reading.series.items()}
    values = {name: series[column] for name, column in zip(columns, found, strict=True)}
    return Columns(series[clock], values, _fixed(reading.lines, np.int64), file)


def _is_delimiter(text: str) -> bool:
    return len(text) == 1 and not text.isalnum() and text not in '"\r\n.+-\0'


def _find_all(
    wanted: Sequence[str], names: Sequence[str], width: int, place: Place, file: str
) -> list[int]:
    """The column (from 0) of each wanted header or number."""
    found, problems = [], []
    for want in wanted:
        answer = _find(want, names, width, place, file)
        if isinstance(answer, Problem):
            problems.append(answer)
        else:
            found.append(answer)
    if problems:
        raise DataError(list(dict.fromkeys(problems))[:MOST_PROBLEMS])
    return found


def _find(want: str, names: Sequence[str], width: int, place: Place, file: str) -> int | Problem:
    columns = matches(want, names)
    if len(columns) == 1:
        return columns[0]
    if columns:
        numbers = [str(column + 1) for column in columns]
        what = f"'{want}' is the name of {len(columns)} columns of '{file}'"
        return Problem(what, place, tuple(f"column {n}" for n in numbers), "Give the number.")
    if re.fullmatch("[0-9]{1,9}", want):
        if 1 <= int(want) <= width:
            return int(want) - 1
        return Problem(f"there is no column {want} in '{file}', only {width}", place)
    if not names:
        what = f"'{file}' has no header, so there is no column '{want}'"
        return Problem(what, place, hint=f"Give a number from 1 to {width}.")
    problem = unknown("column", want, names, place)
    return Problem(f"{problem.what} in '{file}'", place, problem.exists, problem.hint)


class _Reading:
    """The rows as they are read, and what is wrong with them."""

    def __init__(
        self, file: str, delimiter: str, width: int, names: Sequence[str], used: Sequence[int]
    ) -> None:
        self.file, self.delimiter, self.width, self.names = file, delimiter, width, names
        self.lines = array("q")
        self.series = {column: array("d") for column in used}
        self.problems: list[Problem] = []
        self.count, self.room = 0, MOST_PROBLEMS

    def take(self, rows: Iterable[Row]) -> None:
        """Keep the rows that are whole; note what is wrong with the others."""
        for row in rows:
            if row.broken:
                self._note(row.line, row.broken, REPAIR)
            elif len(row.cells) != self.width:
                self._note_width(row)
            else:
                numbers = [number(row.cells[column]) for column in self.series]
                if None in numbers:
                    self._note_cells(row, numbers)
                    continue
                self.lines.append(row.line)
                for kept, value in zip(self.series.values(), numbers, strict=True):
                    kept.append(cast(float, value))

    def check(self, clock: int) -> None:
        """Note series that are not finite, and a time that does not increase."""
        self.room = MOST_PROBLEMS  # for these beside those of the rows: the first of all are told
        lines = np.array(self.lines)
        for column, kept in self.series.items():
            bad = lines[~np.isfinite(np.array(kept))]
            if bad.size:
                rows = f"{bad.size} rows, first here" if bad.size > 1 else "this row"
                what = f"{self._name(column)} is not finite in {rows}"
                self._note(int(bad[0]), what, "Leave out the rows without a value.")
        time = np.array(self.series[clock])
        lines, time = lines[np.isfinite(time)], time[np.isfinite(time)]
        for i in np.nonzero(time[1:] <= time[:-1])[0]:
            before, now, line = float(time[i]), float(time[i + 1]), int(lines[i])
            if now == before:
                what = f"time {now} stands twice, also in line {line}"
                self._note(int(lines[i + 1]), what, "Keep one row for each time.")
            else:
                what = f"time goes back to {now}, from {before} in line {line}"
                self._note(int(lines[i + 1]), what, "Sort the rows, or split the series here.")

    def finish(self) -> None:
        """Raise what was noted, in the order of the lines."""
        if not self.problems and len(self.lines) < 2:
            rows = "only one row" if len(self.lines) else "no row"
            self._note(0, f"the file has {rows} of numbers", NO_ROWS)
        if self.problems:
            told = sorted(self.problems, key=lambda problem: problem.place)[:MOST_PROBLEMS]
            if more := self.count - len(told):
                told.append(Problem(f"and {more} more such problems", Place(self.file)))
            raise DataError(told)

    def _note(self, line: int, what: str, hint: str) -> None:
        self.count += 1
        if self.room:
            self.room -= 1
            self.problems.append(Problem(what, Place(self.file, line), hint=hint))

    def _note_width(self, row: Row) -> None:
        count = len(row.cells)
        what = f"{count} cell{'s' if count > 1 else ''}, and {self.width} in the first row"
        commas = self.delimiter == "," and count == 2 * self.width
        self._note(row.line, what, DECIMAL_COMMA if commas else REPAIR)

    def _note_cells(self, row: Row, numbers: Sequence[float | None]) -> None:
        for column, value in zip(self.series, numbers, strict=True):
            if value is None:
                cell = row.cells[column]
                shown = cell if len(cell) <= 40 else f"{cell[:37]}..."
                hint = next((hint for pattern, hint in HINTS if re.fullmatch(pattern, cell)), "")
                what = f"{self._name(column)} is {shown!r}, which is not a number"
                self._note(row.line, what, hint)

    def _name(self, column: int) -> str:
        return f"column '{self.names[column]}'" if self.names else f"column {column + 1}"


def _fixed(numbers: array[float] | array[int], kind: type[Number]) -> NDArray[Number]:
    """A read-only array of the numbers."""
    fixed = np.array(numbers, dtype=kind)
    fixed.setflags(write=False)
    return fixed
