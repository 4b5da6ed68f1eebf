"""A text file of numbers as rows of cells: delimiter and decimal sign, header, first row."""

from __future__ import annotations

import csv
import difflib
import itertools
import re
from collections import Counter
from collections.abc import Iterator, Sequence, Set
from typing import NamedTuple

from tracewire.data.dates import read_date
from tracewire.data.limits import FILE
from tracewire.errors import FormulaError, Location, Problem, unknown
from tracewire.formula import read_unit

DELIMITERS = ("\t", ";", ",", " ")  # the semicolon first: where it stands, a comma may be decimal
COMMA_NUMBER = re.compile(r"[+-]?(?:\d+,?\d*|,\d+)(?:[eE][+-]?\d+)?")
MARK = re.compile(r"%+|//+|!|\*+")  # of a comment, as other programs write it
NOT_FINITE = re.compile(r"[+-]?(?:nan|inf|infinity)", re.IGNORECASE)
NAME_AND_UNIT = re.compile(
    r'"[^"]*"|(?:[^\s\[(]+|\[[^]]*\]|\([^)]*\))(?:\s*(?:\[[^]]*\]|\([^)]*\)))?'
)


class Dialect(NamedTuple):
    """How numbers are written down: one character between them (" ": any blanks), and . or , in."""

    delimiter: str
    decimal: str = "."


class Row(NamedTuple):
    """The cells of one line, without the blanks around them; line counts from 1."""

    line: int
    cells: tuple[str, ...]
    broken: str = ""  # what is wrong, where the line cannot be cut into cells


class Layout(NamedTuple):
    """Where the numbers begin: names and units of the columns ((): none), the line of the first
    row, the cells of a row, and how many lines before the header are no part of the table."""

    names: tuple[str, ...]
    units: tuple[str, ...]
    first: int
    width: int
    left_out: int = 0


def number(cell: str, decimal: str = ".") -> float | None:
    """The number that a cell holds (NaN and inf too), or None."""
    if decimal == ",":
        if COMMA_NUMBER.fullmatch(cell):
            return float(cell.replace(",", "."))
        return float(cell) if NOT_FINITE.fullmatch(cell) else None
    try:
        return None if "_" in cell else float(cell)  # Python alone reads 1_000
    except ValueError:
        return None


def is_value(cell: str, decimal: str = ".") -> bool:
    """Whether a cell holds a number or a date, and so is no name of a column."""
    return number(cell, decimal) is not None or read_date(cell) is not None


def rows_of(lines: Sequence[str], delimiter: str, comment: str, first: int = 1) -> Iterator[Row]:
    """The rows from line `first` on, without empty lines and those that start with `comment`.

    delimiter: one character; a blank means any run of blanks and tabs.
    """
    for count, line in enumerate(itertools.islice(lines, first - 1, None), first):
        text = line.strip()
        if not text or (comment and text.startswith(comment)):
            continue
        try:
            yield Row(count, _cells(line, delimiter))
        except csv.Error:
            yield Row(count, (), "a quoted cell does not end where it should")


def _cells(line: str, delimiter: str) -> tuple[str, ...]:
    if '"' not in line:
        cells = line.split() if delimiter == " " else line.split(delimiter)
    else:
        one = line.strip().replace("\t", " ") if delimiter == " " else line
        reader = csv.reader([one], delimiter=delimiter, skipinitialspace=True, strict=True)
        cells = next(reader)
    return tuple(map(str.strip, cells))


def sniff(
    lines: Sequence[str], comment: str, delimiter: str | None = None, decimal: str | None = None
) -> Dialect:
    """The dialect under which the first rows look most like a table of numbers."""

    def likeness(dialect: Dialect) -> tuple[int, int, int]:
        sample = itertools.islice(rows_of(lines, dialect.delimiter, comment), FILE.sample_rows)
        shapes: dict[int, list[int]] = {}
        for row in sample:
            count = sum(is_value(cell, dialect.decimal) for cell in row.cells)
            if len(row.cells) > 1:
                shapes.setdefault(len(row.cells), []).append(count)
        return max(
            ((counts.count(width), sum(counts), len(counts)) for width, counts in shapes.items()),
            default=(0, 0, 0),
        )

    choices = itertools.product(
        DELIMITERS if delimiter is None else (delimiter,),
        (".", ",") if decimal is None else (decimal,),
    )
    return max(itertools.starmap(Dialect, choices), key=likeness)  # the first of equal ones


def layout_of(
    lines: Sequence[str], dialect: Dialect, comment: str, wanted: Sequence[str]
) -> Layout | Row:
    """Header and first row of a table; the row that is broken where one is in the way.

    The header is the row that names most of the `wanted` columns; else the last row before the
    numbers that has as many cells, none of them a number. So a first row of data with a faulty cell
    is not taken for names. A row of units may follow it.
    """
    head = list(itertools.islice(rows_of(lines, dialect.delimiter, comment), FILE.sample_rows))
    numeric = [[is_value(cell, dialect.decimal) for cell in row.cells] for row in head]
    full = [
        any(found) and all(found[i] or not cell for i, cell in enumerate(row.cells))
        for row, found in zip(head, numeric, strict=True)
    ]
    # a number alone in a line above the table is no row of it: the usual width counts
    shapes = Counter(len(row.cells) for row, whole in zip(head, full, strict=True) if whole)
    usual = shapes.most_common(1)[0][0] if shapes else 0
    rows = (i for i, row in enumerate(head) if full[i] and len(row.cells) == usual)
    start = next(rows, len(head))
    width = len(head[start].cells) if start < len(head) else len(head[0].cells)
    widths = {width, len(_without_blank_end(head[start].cells))} if start < len(head) else {width}
    above = head[:start] if start < len(head) else head[:1]
    cells = [_header_cells(row.cells, dialect.delimiter, width) for row in above]
    at = _header_row(cells, numeric, widths, wanted)
    units: tuple[str, ...] = ()
    if at is None and (broken := next((row for row in above if row.broken), None)):
        return broken
    if at is None:
        odd = (
            i
            for i, row in enumerate(above)
            if full[i] or (any(numeric[i]) and len(row.cells) == width)
        )
        first = next(odd, min(start, len(head) - 1))
        names = commented_header(lines, dialect.delimiter, comment, head[first], width)
    else:
        names, first = cells[at], at + 1
        while len(names) > width and not names[-1]:
            names = names[:-1]
        if first < start < len(head) and _are_units(cells[first], widths | {len(names)}):
            units, first = cells[first], first + 1
    line = head[first].line if first < len(head) else len(lines) + 1
    return Layout(names, units, line, len(names) or width, first if at is None else at)


def _header_row(
    cells: Sequence[tuple[str, ...]],
    numeric: Sequence[Sequence[bool]],
    widths: Set[int],
    wanted: Sequence[str],
) -> int | None:
    """The index of the header among the rows above the numbers, or None."""

    def named(i: int) -> tuple[int, bool]:
        names = [cell for cell in cells[i] if cell and number(cell) is None]
        return sum(bool(matches(want, names)) for want in wanted), len(cells[i]) in widths

    best = max(range(len(cells)), key=named, default=None)
    if best is not None and named(best)[0]:
        return best
    fitting = [i for i, row in enumerate(cells) if len(row) in widths and not any(numeric[i])]
    if not fitting:
        return None
    *others, last = fitting
    return last - 1 if last - 1 in others and _are_units(cells[last], widths) else last


def _without_blank_end(cells: tuple[str, ...]) -> tuple[str, ...]:
    """The cells but for empty ones at the end."""
    while cells and not cells[-1]:
        cells = cells[:-1]
    return cells


def _are_units(cells: Sequence[str], widths: Set[int]) -> bool:
    """Whether a row below the names holds units: each cell one, in brackets or not, or nothing."""
    if len(cells) not in widths or not any(cells):
        return False
    return all(not cell or _is_unit(cell.strip("[]()")) for cell in cells)


def _is_unit(text: str) -> bool:
    try:
        read_unit(text)
    except FormulaError:
        return False
    return True


def _header_cells(cells: tuple[str, ...], delimiter: str, width: int) -> tuple[str, ...]:
    """The names of a row; between blanks `Time [s]` is one where that makes as many as columns."""
    if cells and (mark := MARK.match(cells[0])):
        rest = cells[0][mark.end() :].strip()
        cells = (rest, *cells[1:]) if rest else cells[1:]
    if delimiter != " " or len(cells) == width:
        return cells
    merged = tuple(part.strip('"') for part in NAME_AND_UNIT.findall(" ".join(cells)))
    return merged if len(merged) == width else cells


def commented_header(
    lines: Sequence[str], delimiter: str, comment: str, first: Row, width: int
) -> tuple[str, ...]:
    """The names in the comment right above the first row, where there are as many as cells."""
    above = next((line.strip() for line in reversed(lines[: first.line - 1]) if line.strip()), "")
    if not comment or not above.startswith(comment):
        return ()
    row = next(rows_of([above.removeprefix(comment)], delimiter, ""), None)
    if row is None or row.broken:
        return ()
    names = _header_cells(row.cells, delimiter, width)
    return names if len(names) == width else ()


def matches(name: str, header: Sequence[str]) -> list[int]:
    """The columns (from 0) of this name: exactly, or else without a unit in brackets."""
    exact = [i for i, cell in enumerate(header) if cell == name]
    return exact or [i for i, cell in enumerate(header) if split_unit(cell)[0] == name]


def unknown_column(want: str, names: Sequence[str], place: Location, file: str) -> Problem:
    """The problem of a column that is not there; the names are `theta [deg]`, `run 1/theta`."""
    problem = unknown("column", want, names, place)
    hint = problem.hint
    if not hint:  # the name itself may be near, without its unit and the group that it is in
        bare = {split_unit(name)[0].rpartition("/")[2]: split_unit(name)[0] for name in names}
        near = difflib.get_close_matches(want.rpartition("/")[2], bare, n=1)
        hint = f"Did you mean '{bare[near[0]]}'?" if near else ""
    return Problem(f"{problem.what} in '{file}'", place, problem.exists, hint)


def split_unit(name: str) -> tuple[str, str]:
    """Name and unit: of `theta [rad]` and `theta (rad)` 'theta' and 'rad'; else the name and ''."""
    for opening, closing in ("[]", "()"):
        if name.endswith(closing) and opening in name:
            at = name.rindex(opening)
            if bare := name[:at].strip():
                return bare, name[at + 1 : -1].strip()
    return name, ""
