"""The columns of an Excel workbook (.xlsx): each sheet is a table of text; openpyxl reads them."""

from __future__ import annotations

import datetime
import io
import re
import zipfile
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from tracewire.data.limits import FILE
from tracewire.data.quiet import Attempts
from tracewire.data.request import Found, Request
from tracewire.data.table import Dialect, Row, layout_of
from tracewire.data.text import columns_of_lines
from tracewire.data.vectors import Column, Group, choose
from tracewire.errors import DataError, Location
from tracewire.extras import import_extra

TABS = Dialect("\t", ".")
ERROR = re.compile(r"#[A-Z0-9/]+[!?]?")  # what a formula shows that has no value


def columns_of_workbook(content: bytes, path: Path, request: Request, place: Location) -> Found:
    """The wanted columns of a sheet: of the only one, or of the one that has all of them, or that
    names such as `Sheet2/theta` say. Lines are the rows of the sheet. Raises DataError."""
    sheets = sheets_of(content, path, place)
    if len(sheets) == 1:
        ((name, lines),) = sheets.items()
        file, heads = str(path), [want.removeprefix(f"{name}/") for want in request.names]
    else:
        groups = groups_of_sheets(sheets, request.comment)
        chosen = choose(groups, request.names, str(path), place)
        if len({group for group, _ in chosen}) > 1:
            what = f"the columns of '{path}' are in several sheets"
            exists = tuple(f"{groups[group].name}/{column.head}" for group, column in chosen)
            raise DataError.one(what, place, exists, "Put them into one sheet.")
        group = groups[chosen[0][0]]
        file, lines = f"{path} ({group.name})", sheets[group.name]
        heads = [
            column.head
            if group.heads.count(column.head) == 1
            else str(group.columns.index(column) + 1)
            for _, column in chosen
        ]
    count = len(request.wanted)
    inside = request._replace(
        wanted=tuple(heads[:count]),
        where=dict(zip(heads[count:], request.where.values(), strict=True)),
        dialect=(TABS.delimiter, TABS.decimal),
    )
    return columns_of_lines(lines, file, inside, place)


def groups_of_sheets(sheets: dict[str, list[str]], comment: str) -> list[Group]:
    """The sheets with the names of their columns; one without a header has no columns."""
    found = []
    for name, lines in sheets.items():
        try:
            layout = layout_of(lines, TABS, comment, ())
        except IndexError:  # it has comments only
            found.append(Group(name, ()))
            continue
        names = () if isinstance(layout, Row) else layout.names
        columns = tuple(Column(head, lambda: np.zeros(0)) for head in names)
        found.append(Group(name, columns))
    return found


def sheets_of(content: bytes, path: Path, place: Location) -> dict[str, list[str]]:
    """The sheets that have rows, by name, as lines of text with tabs. Raises DataError."""
    openpyxl = import_extra(
        "openpyxl",
        "xlsx",
        f"to read '{path}', an Excel workbook",
        error=DataError,
        place=place,
        otherwise="Or save the sheet as CSV.",
    )
    attempt = Attempts("openpyxl", "an Excel workbook", path, place)
    sheets: dict[str, list[str]] = attempt(partial(_lines_of_sheets, content, openpyxl))
    filled = {name: lines for name, lines in sheets.items() if any(map(str.strip, lines))}
    if not filled:
        raise DataError.one(f"'{path}' has no sheet with rows", place, hint="Fill in numbers.")
    return filled


def _lines_of_sheets(content: bytes, openpyxl: Any) -> dict[str, list[str]]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        if sum(entry.file_size for entry in archive.infolist()) > FILE.most_unpacked:
            raise ValueError(f"it holds more than {FILE.most_unpacked / 1e9:g} GB")
    book = openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True)
    sheets = {
        sheet.title: _lines(list(sheet.iter_rows(values_only=True))) for sheet in book.worksheets
    }
    book.close()
    return sheets


def _lines(rows: Sequence[Sequence[Any]]) -> list[str]:
    cells = [[_text(value) for value in row] for row in rows]
    width = max((n + 1 for row in cells for n, text in enumerate(row) if text), default=0)
    return ["\t".join(row[:width]) for row in cells]


def _text(value: object) -> str:
    """A cell as text: dates as ISO 8601, a duration in s."""
    match value:
        case None:
            return ""
        case bool():
            return str(int(value))
        case datetime.datetime() | datetime.date() | datetime.time():
            return value.isoformat()
        case datetime.timedelta():
            return repr(value.total_seconds())
        case str():
            text = " ".join(value.split())
            quoted = '"' in text or ERROR.fullmatch(text)
            return '"' + text.replace('"', '""') + '"' if quoted else text
    return repr(value)
