"""Statements that were measured, as a table and as data for programs."""

from __future__ import annotations

import math
from collections.abc import Iterable

from tracewire.analyse import Judged
from tracewire.show.table import Table

HOLDS = {
    "agrees": "yes",
    "the print is wrong": "no, as its erratum says",
    "does not agree": "no",
    "could not be measured": "-",
}
HEADER = ("statement", "measured", "expected", "holds", "source")


def statements_table(rows: Iterable[Judged], title: str = "") -> Table:
    """The statements of a diagram: what was measured, what was expected, whether it holds."""
    cells = tuple(
        (
            row.statement.name,
            measured_text(row),
            expected_text(row),
            HOLDS[row.verdict],
            row.statement.source,
        )
        for row in rows
    )
    return Table(title, HEADER, cells)


def measured_text(row: Judged) -> str:
    """What was measured, in the unit of the statement; "-" where nothing was."""
    if row.value is None:
        return "-"
    if isinstance(row.value, str):
        return row.value
    value = abs(row.value)
    shown = f"{row.value:.7g}" if value >= 1e-3 or value == 0 else f"{row.value:.2e}"
    return _with_unit(shown, row)


def expected_text(row: Judged) -> str:
    """What was expected, in the unit of the statement."""
    return _with_unit(row.expected, row) if row.bounds is not None else row.expected


def _with_unit(text: str, row: Judged) -> str:
    return f"{text} {row.statement.unit}".rstrip()


def statement_data(row: Judged) -> dict[str, object]:
    """A statement for programs: plain types, what is not finite as None."""
    statement, bounds = row.statement, row.bounds
    return {
        "name": statement.name,
        "says": statement.says,
        "source": statement.source,
        "what": statement.what,
        "unit": statement.unit,
        "value": row.value,
        "expected": row.expected,
        "low": bounds.low if bounds is not None and math.isfinite(bounds.low) else None,
        "high": bounds.high if bounds is not None and math.isfinite(bounds.high) else None,
        "verdict": row.verdict,
        "why": row.why,
        "seconds": row.seconds,
    }
