"""The columns of a text file: every row is taken, or told with its line and what is wrong."""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import cast

import numpy as np

from tracewire.data.content import text_of
from tracewire.data.dates import Instant, read_date, seconds_since_first
from tracewire.data.limits import FILE
from tracewire.data.request import (
    NO_ROWS,
    NO_VALUE,
    Found,
    Request,
    none_left,
    problems_of,
    raise_first,
    too_few,
    without_missing,
)
from tracewire.data.table import (
    Dialect,
    Layout,
    Row,
    layout_of,
    matches,
    number,
    rows_of,
    sniff,
    split_unit,
    unknown_column,
)
from tracewire.errors import DataError, Location, Problem

DECIMAL_COMMA = "Is it a decimal comma? Write 1.5, and not 1,5."
REPAIR = "Repair or remove this line."
THOUSANDS = "Write large numbers without marks between the thousands, as in 1234.5."
CLOCK_TIME = (
    "A column of time has seconds, or dates as ISO 8601 writes them: 2024-03-12T12:00:01.5+01:00."
)
HINTS = (
    (r"", NO_VALUE),
    (r"[+-]?\d+,\d+(e[+-]?\d+)?", DECIMAL_COMMA),
    (r"[+-]?\d{1,3}([,.' \u00a0\u202f]\d{3})+([.,]\d*)?", THOUSANDS),
    (r"[+-]?\d*\.?\d*[dD][+-]?\d+", "Write exponents with e, as in 1e-3."),
    (
        r"(\d{1,4}[-./]\d{1,2}[-./]\d{1,4})?[ T]?\d{1,2}:\d{2}(:\d{2}([.,]\d*)?)?( ?[AaPp][Mm])?Z?",
        CLOCK_TIME,
    ),
    (r"[\u2212\u2013].*", "Its minus is another character than '-': replace it in the file."),
    (r"\d{1,4}[-./]\d{1,2}[-./]\d{1,4}", CLOCK_TIME),
    (
        r"-+|\*+|#+.*|\?+|[+-]?(OVLD|OVFL|OVERFLOW|OVER|OVL|OL|OFL|UNDER|ERR(OR)?|N/?A|NULL|NONE)",
        f"It marks a value that the instrument did not have. {NO_VALUE}",
    ),
    (
        r"[+-]?[\d.,]+ ?[^\d\s.,_].{0,10}",
        "A cell holds a number alone: write its unit in the header.",
    ),
)
BLANK = re.compile(r"|nan|n/?a|null|none", re.IGNORECASE)
"""A cell of a sensor that gave no value."""
AMBIGUOUS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+")


def columns_of_text(content: bytes, path: Path, request: Request, place: Location) -> Found:
    """The wanted columns of a text file; DataError with up to ten problems, each with its line."""
    lines, odd = text_of(content, path)
    found = columns_of_lines(lines, str(path), request, place)
    return found._replace(remarks=(*odd, *found.remarks))


def columns_of_lines(lines: Sequence[str], file: str, request: Request, place: Location) -> Found:
    """The wanted columns of the lines of a table; raises as `columns_of_text` does."""
    given = request.dialect
    dialect = sniff(lines, request.comment, *given) if None in given else Dialect(*map(str, given))
    if next(rows_of(lines, dialect.delimiter, request.comment), None) is None:
        raise DataError.one(f"'{file}' holds nothing but comments", place, hint=NO_ROWS)
    layout = layout_of(lines, dialect, request.comment, request.names)
    if isinstance(layout, Row):
        raise DataError.one(layout.broken, Location(file, layout.line), hint=REPAIR)
    found = _find_all(request.names, layout, place, file)
    filters = found[len(request.wanted) :]

    reading = _Reading(file, dialect, layout, sorted(set(found[: len(request.wanted)])))
    reading.conditions = dict(zip(filters, request.where.values(), strict=True))
    reading.guess = request.dialect[1] is None
    reading.clock = None if request.clock is None else found[request.clock]
    whole = {column for n, column in enumerate(found) if n not in request.sparse}
    reading.sparse = {found[n] for n in request.sparse} - whole
    reading.take(rows_of(lines, dialect.delimiter, request.comment, layout.first))
    columns = found[: len(request.wanted)]
    since = reading.from_dates()
    read = Found(
        [np.array(reading.series[column]) for column in columns],
        [_unit_of(layout, column) for column in columns],
        [reading.name(column) for column in columns],
        np.array(reading.lines, dtype=np.int64),
        since=since,
    )
    read = without_missing(read, request)
    reading.finish(problems_of(read, request, file))
    if request.where and not reading.lines:
        raise none_left(request.where, reading.seen, file, place)
    if len(reading.lines) < 2:
        raise too_few(len(reading.lines), file)
    remarks = []
    if layout.left_out:
        some = "one line" if layout.left_out == 1 else f"{layout.left_out} lines"
        remarks.append(f"{some} before the table left out, as no part of it")
    if dialect.decimal == "," and reading.commas:
        remarks.append("the numbers are read with a decimal comma")
    return read._replace(remarks=tuple(remarks))


def _unit_of(layout: Layout, column: int) -> str:
    if column < len(layout.units) and (text := layout.units[column].strip("[]()")):
        return text
    return split_unit(layout.names[column])[1] if layout.names else ""


def _find_all(wanted: Sequence[str], layout: Layout, place: Location, file: str) -> list[int]:
    """The column (from 0) of each wanted header or number."""
    answers = [_find(want, layout, place, file) for want in wanted]
    problems = [answer for answer in answers if isinstance(answer, Problem)]
    if problems:
        raise DataError(list(dict.fromkeys(problems))[: FILE.most_problems])
    return [answer for answer in answers if isinstance(answer, int)]


def _find(want: str, layout: Layout, place: Location, file: str) -> int | Problem:
    names, width = layout.names, layout.width
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
    return unknown_column(want, names, place, file)


class _Reading:
    """The rows as they are read, and what is wrong with them."""

    def __init__(self, file: str, dialect: Dialect, layout: Layout, used: Sequence[int]) -> None:
        self.file, self.dialect, self.layout = file, dialect, layout
        self.width, self.names = layout.width, layout.names
        self.lines = array("q")
        self.series: dict[int, array[float]] = {column: array("d") for column in used}
        self.clock: int | None = None
        self.sparse: set[int] = set()
        self.dates: list[Instant] = []
        self.conditions: Mapping[int, str | float] = {}
        self.seen: list[dict[str, None]] = []
        self.guess, self.commas, self.ambiguous = True, 0, ""
        self.problems: list[Problem] = []
        self.count = 0

    def take(self, rows: Iterable[Row]) -> None:
        """Keep the rows that are whole; note what is wrong with the others."""
        decimal = self.dialect.decimal
        self.seen = [{} for _ in self.conditions]
        for row in rows:
            cells = row.cells
            if len(cells) > self.width and not any(cells[self.width :]):
                cells = cells[: self.width]  # delimiters behind the last cell
            if row.broken:
                self._note(row.line, row.broken, REPAIR)
            elif len(cells) != self.width:
                self._note_width(row)
            elif self._is_chosen(cells):
                numbers = [self._number(column, cells[column]) for column in self.series]
                date = self._date(cells, numbers) if None in numbers else None
                if None in numbers:
                    self._note_cells(row, numbers)
                    continue
                if date is not None:
                    self.dates.append(date)
                if decimal == ",":
                    self._look_at_commas(row, cells)
                self.lines.append(row.line)
                for kept, value in zip(self.series.values(), numbers, strict=True):
                    kept.append(cast(float, value))

    def from_dates(self) -> str:
        """Put seconds in the place of dates; the date at which they are 0, or ''."""
        if not self.dates:
            return ""
        assert self.clock is not None
        zones = {date.has_zone for date in self.dates}
        if len(self.dates) < len(self.lines):
            what = f"{self.name(self.clock)} has dates in some rows, and numbers in others"
            self._note(self.lines[0], what, "Write all times alike.")
        elif len(zones) > 1:
            what = f"{self.name(self.clock)} has dates with a zone, and others without"
            self._note(self.lines[0], what, "Write all times alike.")
        else:
            instants = np.array([date.nanoseconds for date in self.dates], dtype=np.int64)
            seconds, since = seconds_since_first(instants, zones.pop())
            self.series[self.clock] = array("d", seconds)
            return since
        self.series[self.clock] = array("d", range(len(self.lines)))  # one problem is enough
        return ""

    def finish(self, problems: Sequence[Problem]) -> None:
        """Raise what was noted and `problems`, in the order of the lines."""
        if self.ambiguous and not self.commas and not self.problems:
            cell, _, line = self.ambiguous.rpartition(":")
            what = f"'{cell}' and others like it may have a decimal comma, or one for thousands"
            hint = "Say format: {decimal: ','}, or write the numbers as in 1234.5."
            self._note(int(line), what, hint)
        raise_first([*self.problems, *problems], self.count + len(problems), self.file)

    def name(self, column: int) -> str:
        return f"column '{self.names[column]}'" if self.names else f"column {column + 1}"

    def _number(self, column: int, cell: str) -> float | None:
        """The number in a cell; NaN where it is blank, and may be."""
        found = number(cell, self.dialect.decimal)
        is_blank = found is None and column in self.sparse and BLANK.fullmatch(cell)
        return float("nan") if is_blank else found

    def _date(self, cells: Sequence[str], numbers: list[float | None]) -> Instant | None:
        """The date in the column of time, for which 0 is put into its place among the numbers."""
        at = None if self.clock is None else list(self.series).index(self.clock)
        if at is None or self.clock is None or numbers[at] is not None:
            return None
        date = read_date(cells[self.clock])
        if date is not None:
            numbers[at] = 0.0
        return date

    def _is_chosen(self, cells: Sequence[str]) -> bool:
        for seen, (column, wanted) in zip(self.seen, self.conditions.items(), strict=True):
            cell = cells[column]
            seen.setdefault(cell)
            same = cell == str(wanted)
            if not same and isinstance(wanted, float):
                same = number(cell, self.dialect.decimal) == wanted
            if not same:
                return False
        return True

    def _look_at_commas(self, row: Row, cells: Sequence[str]) -> None:
        for column in self.series:
            if "," in cells[column]:
                if self.guess and AMBIGUOUS.fullmatch(cells[column]):
                    self.ambiguous = self.ambiguous or f"{cells[column]}:{row.line}"
                else:
                    self.commas += 1

    def _note(self, line: int, what: str, hint: str) -> None:
        self.count += 1
        if len(self.problems) < FILE.most_problems:
            self.problems.append(Problem(what, Location(self.file, line), hint=hint))

    def _note_width(self, row: Row) -> None:
        count = len(row.cells)
        what = f"{count} cell{'s' if count > 1 else ''}, and {self.width} in the first row"
        commas = self.dialect.delimiter == "," and count == 2 * self.width
        self._note(row.line, what, DECIMAL_COMMA if commas else REPAIR)

    def _note_cells(self, row: Row, numbers: Sequence[float | None]) -> None:
        if self.names and row.cells[: self.width] == self.names:
            hint = "Where a second record begins, split the file; else remove this line."
            self._note(row.line, "the header stands here once more", hint)
            return
        for column, value in zip(self.series, numbers, strict=True):
            if value is None:
                cell = row.cells[column]
                shown = cell if len(cell) <= 40 else f"{cell[:37]}..."
                what = f"{self.name(column)} is {shown!r}, which is not a number"
                self._note(row.line, what, self._hint(cell))

    def _hint(self, cell: str) -> str:
        if self.dialect.decimal == "," and number(cell) is not None:
            return "Other numbers of this file have a decimal comma: write all alike."
        found = (hint for pattern, hint in HINTS if re.fullmatch(pattern, cell, re.IGNORECASE))
        return next(found, "")
