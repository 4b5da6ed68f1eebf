"""What the columns of a file are called, and the units that its header gives to them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tracewire.data.content import content_of, kind_of, text_of
from tracewire.data.matlab import names_in_matlab
from tracewire.data.table import Row, layout_of, matches, sniff, split_unit
from tracewire.errors import DataError, Place, Problem


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
    """The headings of a text file, or the vectors of a .mat file.

    For the arguments see `read_columns`. Raises DataError: no such file, no header.
    """
    path = Path(path)
    place = Place(str(path))
    content = content_of(path, place)
    if kind_of(content, path, place) == "matlab":
        names = tuple(names_in_matlab(content, path, place))
        return Headings(str(path), names, ("",) * len(names), names, names)
    lines, _ = text_of(content, path)
    dialect = sniff(lines, comment, delimiter, decimal)
    try:
        layout = layout_of(lines, dialect, comment, ())
    except IndexError:  # not one row
        layout = None
    if layout is None or isinstance(layout, Row) or not layout.names:
        what, hint = "the file has no header", "Write the names of the columns above the numbers."
        raise DataError([Problem(what, place, hint=hint)])
    split = [split_unit(name) for name in layout.names]
    names = tuple(name for name, _ in split)
    below = [unit.strip("[]()") for unit in layout.units] or [""] * len(names)
    units = tuple(
        under or unit for (_, unit), under in zip(split, below + [""] * len(names), strict=False)
    )
    columns = tuple(
        name if names.count(name) == 1 else str(n) for n, name in enumerate(names, start=1)
    )
    return Headings(str(path), names, units, columns, layout.names)
