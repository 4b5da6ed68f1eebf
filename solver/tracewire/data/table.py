"""A text file of numbers as rows of cells: bytes to text, delimiter, header."""

from __future__ import annotations

import collections
import csv
import itertools
import os
import stat
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from tracewire.errors import DataError, Place, Problem, unknown

MOST_BYTES = 200_000_000
SAMPLE = 50
DELIMITERS = ("\t", ";", ",", " ")  # the semicolon first: where it stands, a comma may be decimal


class Row(NamedTuple):
    """The cells of one line, without the blanks around them; line counts from 1."""

    line: int
    cells: tuple[str, ...]
    broken: str = ""  # what is wrong, where the line cannot be cut into cells


def number(cell: str) -> float | None:
    """The number that a cell holds (NaN and inf too), or None."""
    try:
        return None if "_" in cell else float(cell)  # Python alone reads 1_000
    except ValueError:
        return None


def read_lines(path: Path, place: Place) -> list[str]:
    """The lines of a UTF-8 file, or DataError where there is no such file or text."""
    content = _content(path, place)
    hint = "Save it as text, in UTF-8."
    if not content.strip(b"\xef\xbb\xbf \t\r\n"):
        raise _refused(place, path, "is empty", "Its rows must hold numbers.")
    if (zero := content.find(b"\0")) >= 0:
        spot = Place(str(path), content.count(b"\n", 0, zero) + 1)
        raise DataError.one("the file is not text: it holds a zero byte", spot, hint=hint)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        spot = Place(str(path), content.count(b"\n", 0, error.start) + 1)
        byte = f"0x{content[error.start]:02x}"
        raise DataError.one(f"the byte {byte} is not UTF-8 text", spot, hint=hint) from error
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def _content(path: Path, place: Place) -> bytes:
    try:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            raise _refused(place, path, "is a folder", "Name a file in it.", _names(path))
        if not stat.S_ISREG(status.st_mode):
            raise _refused(place, path, "is not a regular file", "Copy its content into a file.")
        if status.st_size > MOST_BYTES:
            size, limit = (f"{count / 1e6:.0f} MB" for count in (status.st_size, MOST_BYTES))
            what = f"is too large: {size}, and the limit is {limit}"
            raise _refused(place, path, what, "Split it, or keep every n-th row.")
        return path.read_bytes()
    except (FileNotFoundError, NotADirectoryError) as error:
        raise DataError([_missing(path, place)]) from error
    except (OSError, ValueError) as error:  # ValueError: a path that no file can have
        what = f"cannot be read: {getattr(error, 'strerror', None) or error}"
        raise _refused(place, path, what, "Check its name and permissions.") from error


def rows_of(lines: Sequence[str], delimiter: str, comment: str) -> Iterator[Row]:
    """The rows in the lines, without empty lines and without those that start with `comment`.

    delimiter: one character; a blank means any run of blanks and tabs.
    """
    for count, line in enumerate(lines, 1):
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


def sniff(lines: Sequence[str], comment: str) -> str:
    """The delimiter under which the first rows look most like a table of numbers."""

    def likeness(delimiter: str) -> tuple[int, int]:
        rows = [row.cells for row in itertools.islice(rows_of(lines, delimiter, comment), SAMPLE)]
        widths = collections.Counter(len(cells) for cells in rows if len(cells) > 1)
        if not widths:
            return 0, 0
        width, alike = widths.most_common(1)[0]
        numbers = [cells for cells in rows if len(cells) == width and _are_numbers(cells)]
        return len(numbers), alike

    return max(DELIMITERS, key=likeness)  # the first of equal ones


def header_of(first: Row, wanted: Sequence[str]) -> tuple[str, ...]:
    """The names in the first row, or none where it is a row of data.

    It is a header where no cell is a number, or where it names a wanted column although some are
    ("t, 1, 2"). So a first row of data with a faulty cell is not taken for names.
    """
    names = [cell for cell in first.cells if cell and number(cell) is None]
    if len(names) == len([cell for cell in first.cells if cell]):
        return first.cells
    return first.cells if any(matches(want, names) for want in wanted) else ()


def commented_header(
    lines: Sequence[str], delimiter: str, comment: str, first: Row
) -> tuple[str, ...]:
    """The names in the comment right above the first row, where there are as many as cells."""
    above = next((line.strip() for line in reversed(lines[: first.line - 1]) if line.strip()), "")
    if not comment or not above.startswith(comment):
        return ()
    row = next(rows_of([above.removeprefix(comment)], delimiter, ""), first)
    return row.cells if row is not first and len(row.cells) == len(first.cells) else ()


def matches(name: str, header: Sequence[str]) -> list[int]:
    """The columns (from 0) of this name: exactly, or else without a unit in brackets."""
    exact = [i for i, cell in enumerate(header) if cell == name]
    return exact or [i for i, cell in enumerate(header) if without_unit(cell) == name]


def without_unit(name: str) -> str:
    """`theta [rad]` and `theta (rad)` are `theta`; every other name stays as it is."""
    for opening, closing in ("[]", "()"):
        if name.endswith(closing) and opening in name:
            return name[: name.rindex(opening)].strip() or name
    return name


def _are_numbers(cells: Sequence[str]) -> bool:
    return all(number(cell) is not None for cell in cells)


def _names(folder: Path) -> list[str]:
    try:
        return sorted(entry.name for entry in os.scandir(folder) if entry.is_file())
    except OSError:
        return []


def _missing(path: Path, place: Place) -> Problem:
    folder = path.parent
    if not folder.is_dir():
        return Problem(
            f"there is no file '{path}', and no folder '{folder}'", place, hint="Check the path."
        )
    names = _names(folder)
    alike = [name for name in names if Path(name).suffix == path.suffix]
    problem = unknown("file", path.name, alike or names, place)
    return Problem(f"{problem.what} in '{folder}'", place, problem.exists, problem.hint)


def _refused(
    place: Place, path: Path, what: str, hint: str, exists: Sequence[str] = ()
) -> DataError:
    named = f"'{path}'" if place.file != str(path) else "the file"
    return DataError([Problem(f"{named} {what}", place, tuple(exists), hint)])
