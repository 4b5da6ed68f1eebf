"""A table to show: as text, as HTML, or row by row."""

from __future__ import annotations

import html
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Table:
    """A table to show: title, header, rows of text; `numeric` are the columns of numbers."""

    title: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numeric: frozenset[int] = field(default_factory=frozenset)

    def __str__(self) -> str:
        """The table as lines of text, its columns aligned, those of numbers to the right."""
        lines = [self.header, *self.rows]
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        texts = [
            "  ".join(
                cell.rjust(width) if n in self.numeric else cell.ljust(width)
                for n, (cell, width) in enumerate(zip(line, widths, strict=True))
            ).rstrip()
            for line in lines
        ]
        rule = "-" * (sum(widths) + 2 * (len(widths) - 1))
        return "\n".join([*([self.title] if self.title else []), texts[0], rule, *texts[1:]])

    def html(self) -> str:
        """The table as HTML."""
        kinds = [' class="number"' if n in self.numeric else "" for n in range(len(self.header))]
        head = "".join(
            f"<th{kind}>{html.escape(cell)}</th>"
            for kind, cell in zip(kinds, self.header, strict=True)
        )
        rows = []
        for row in self.rows:
            cells = (
                f"<td{kind}>{html.escape(cell)}</td>" for kind, cell in zip(kinds, row, strict=True)
            )
            rows.append("<tr>" + "".join(cells) + "</tr>")
        caption = f"<caption>{html.escape(self.title)}</caption>" if self.title else ""
        return f"<table>{caption}<tr>{head}</tr>{''.join(rows)}</table>"

    def without_empty(self) -> Table:
        """The table without the columns that hold nothing."""
        kept = [n for n in range(len(self.header)) if any(row[n] for row in self.rows)]
        numeric = frozenset(at for at, n in enumerate(kept) if n in self.numeric)
        rows = tuple(tuple(row[n] for n in kept) for row in self.rows)
        return Table(self.title, tuple(self.header[n] for n in kept), rows, numeric)

    def _repr_html_(self) -> str:
        """The table as a notebook shows it."""
        return self.html()


def shown(value: float) -> str:
    """A number for a table."""
    return f"{value:.6g}"
