"""The formats that are read, each by its first bytes: what it is called, and what reads it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from tracewire.data.content import content_of, is_workbook, refuse_other_kinds, text_of
from tracewire.data.hdf5 import groups_of_hdf5
from tracewire.data.matlab import columns_of_matlab, names_in_matlab
from tracewire.data.mdf import groups_of_mdf
from tracewire.data.parquet import groups_of_parquet
from tracewire.data.request import Found, Request
from tracewire.data.table import Row, layout_of, sniff, split_unit
from tracewire.data.tdms import groups_of_tdms
from tracewire.data.text import columns_of_text
from tracewire.data.vectors import Group, columns_of_groups
from tracewire.data.workbook import columns_of_workbook, groups_of_sheets, sheets_of
from tracewire.errors import DataError, Location, Problem


class Head(NamedTuple):
    """A column of a file: its name, its unit ('' where none is given), the text by which a diagram
    names it, and all that its header says."""

    name: str
    unit: str
    column: str
    whole: str


class Form(NamedTuple):
    """How a text is written down: delimiter and decimal sign, None where they are to be found."""

    delimiter: str | None = None
    decimal: str | None = None
    comment: str = "#"


@dataclass(frozen=True)
class FileFormat:
    """A format: its first bytes, the reader of wanted columns, and that of what its columns are
    called; `is_table`: its first column may be the time, and columns have numbers."""

    marks: tuple[bytes, ...]
    columns: Callable[[bytes, Path, Request, Location], Found]
    heads: Callable[[bytes, Path, Form, Location], Sequence[Head]]
    is_table: bool = False


def format_of(content: bytes, path: Path, place: Location) -> FileFormat:
    """The format of a file; DataError with its name where it is of a kind that is not read."""
    for known in FORMATS:
        if any(content.startswith(mark) for mark in known.marks):
            return known
    if is_workbook(content):
        return WORKBOOK
    refuse_other_kinds(content, path, place)
    return MATLAB if path.suffix.lower() == ".mat" and b"\0" in content else TEXT


def opened(path: Path, place: Location) -> tuple[FileFormat, bytes]:
    """The format of a file and its bytes. Raises DataError."""
    content = content_of(path, place)
    return format_of(content, path, place), content


def _of_groups(
    open_file: Callable[[bytes, Path, Location], list[Group]],
    *marks: bytes,
    is_table: bool = False,
) -> FileFormat:
    """A format whose files are groups of vectors."""

    def columns(content: bytes, path: Path, request: Request, place: Location) -> Found:
        groups = open_file(content, path, place)
        return columns_of_groups(groups, request, str(path), place, numbered=is_table)

    def heads(content: bytes, path: Path, form: Form, place: Location) -> list[Head]:
        return _heads_of_groups(open_file(content, path, place))

    return FileFormat(marks, columns, heads, is_table)


def _heads_of_groups(groups: Sequence[Group]) -> list[Head]:
    return [
        Head(split_unit(c.head)[0], c.its_unit, group.address(c.head), c.head)
        for group in groups
        for c in group.columns
    ]


def _heads_of_text(content: bytes, path: Path, form: Form, place: Location) -> list[Head]:
    lines, _ = text_of(content, path)
    dialect = sniff(lines, form.comment, form.delimiter, form.decimal)
    try:
        layout = layout_of(lines, dialect, form.comment, ())
    except IndexError:  # not one row
        layout = None
    if layout is None or isinstance(layout, Row) or not layout.names:
        what, hint = "the file has no header", "Write the names of the columns above the numbers."
        raise DataError([Problem(what, place, hint=hint)])
    names, units = zip(*map(split_unit, layout.names), strict=True)
    below = [unit.strip("[]()") for unit in layout.units] or [""] * len(names)
    below += [""] * (len(names) - len(below))
    return [
        Head(name, under or unit, name if names.count(name) == 1 else str(n), whole)
        for n, (name, unit, under, whole) in enumerate(
            zip(names, units, below, layout.names, strict=False), start=1
        )
    ]


def _heads_of_workbook(content: bytes, path: Path, form: Form, place: Location) -> list[Head]:
    sheets = sheets_of(content, path, place)
    if len(sheets) == 1:
        (lines,) = sheets.values()
        text = "\n".join(lines).encode()
        return _heads_of_text(text, path, Form("\t", ".", form.comment), place)
    return _heads_of_groups(groups_of_sheets(sheets, form.comment))


def _heads_of_matlab(content: bytes, path: Path, form: Form, place: Location) -> list[Head]:
    return [Head(name, "", name, name) for name in names_in_matlab(content, path, place)]


TEXT = FileFormat((), columns_of_text, _heads_of_text, is_table=True)
WORKBOOK = FileFormat((), columns_of_workbook, _heads_of_workbook, is_table=True)
MATLAB = FileFormat((b"MATLAB 5.0 MAT-file", b"MATLAB 7.3"), columns_of_matlab, _heads_of_matlab)
FORMATS = (
    MATLAB,
    _of_groups(groups_of_hdf5, b"\x89HDF"),
    _of_groups(groups_of_parquet, b"PAR1", is_table=True),
    _of_groups(groups_of_tdms, b"TDSm"),
    _of_groups(groups_of_mdf, b"MDF     "),
)
"""Those that their first bytes tell."""
