"""What the columns of a file are called, and the units that its header gives to them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tracewire.data.formats import Form, opened
from tracewire.data.table import matches
from tracewire.errors import Location


@dataclass(frozen=True)
class Headings:
    """The columns of a file: their `names` without units, `units` ('' where none is given).

    `columns` are the texts by which a diagram names them: the name, or the number from 1 where
    several columns have that name.
    """

    file: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    columns: tuple[str, ...]
    whole: tuple[str, ...]

    def __iter__(self) -> Iterator[tuple[str, str, str]]:
        return iter(zip(self.names, self.units, self.columns, strict=True))

    def has(self, column: str) -> bool:
        """Whether the file has a column of this name or number."""
        number = int(column) if column.isascii() and column.isdigit() else 0
        return bool(matches(column, self.whole)) or 1 <= number <= len(self.names)


def read_headings(
    path: str | Path, delimiter: str | None = None, decimal: str | None = None, comment: str = "#"
) -> Headings:
    """The headings of a file of any format.

    For the arguments see `read_columns`. Raises DataError: no such file, no header.
    """
    path = Path(path)
    place = Location(str(path))
    known, content = opened(path, place)
    heads = known.heads(content, path, Form(delimiter, decimal, comment), place)
    names, units, columns, whole = zip(*heads, strict=True) if heads else ((), (), (), ())
    return Headings(str(path), names, units, columns, whole)
