"""What a case returns, and how it looks on the screen."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from rich.console import Console
from rich.table import Table

WIDTH = 112


@dataclass(frozen=True)
class Promise:
    """A measured number beside what was promised of it; `most` of a cost, or else `least`."""

    what: str
    measured: float
    bound: float
    unit: str = "x"
    most: bool = False

    @property
    def holds(self) -> bool:
        """Whether it is kept in this run."""
        return self.measured <= self.bound if self.most else self.measured >= self.bound


@dataclass(frozen=True)
class Result:
    """The rows of a case, its promises and remarks."""

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    promises: Sequence[Promise] = field(default_factory=tuple)
    remarks: Sequence[str] = field(default_factory=tuple)


def seconds(value: float) -> str:
    """A time to three digits, in a readable unit."""
    if not math.isfinite(value):
        return "-"
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if value >= size:
            return f"{value / size:.3g} {unit}"
    return f"{value * 1e9:.3g} ns"


def ratio(value: float) -> str:
    """A ratio to three digits."""
    if not math.isfinite(value):
        return "-"
    return f"{value:.0f}x" if value >= 1000 else f"{value:.3g}x"


def show(result: Result, console: Console) -> None:
    """Print a case."""
    table = Table(title=result.title, title_justify="left", title_style="bold")
    for number, column in enumerate(result.columns):
        text = number == 0 or column == ""  # a column without a name has remarks
        table.add_column(column, justify="left" if text else "right", no_wrap=not text)
    for row in result.rows:
        table.add_row(*row)
    console.print(table)
    for remark in result.remarks:
        console.print(f"  {remark}", style="dim")
    console.print()


def show_promises(results: Sequence[Result], console: Console) -> None:
    """Print what was promised beside what was measured."""
    table = Table(title="Promises", title_justify="left", title_style="bold")
    for number, column in enumerate(("against", "measured", "promised", "")):
        table.add_column(column, justify="right" if number in (1, 2) else "left")
    for promise in (promise for result in results for promise in result.promises):
        if promise.unit == "s":
            measured, bound = seconds(promise.measured), seconds(promise.bound)
        elif promise.unit == "x":
            measured, bound = ratio(promise.measured), ratio(promise.bound)
        else:
            measured, bound = (f"{x:.3g} {promise.unit}" for x in (promise.measured, promise.bound))
        bound = ("at most " if promise.most else "at least ") + bound
        table.add_row(promise.what, measured, bound, "kept" if promise.holds else "NOT kept")
    if table.row_count:
        console.print(table)


def console() -> Console:
    """The screen, or a file of a fixed width."""
    screen = Console()
    return screen if screen.is_terminal else Console(width=WIDTH)
