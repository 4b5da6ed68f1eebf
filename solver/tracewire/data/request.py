"""What is wanted of a file, what was found there, and checks that hold for every format."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from math import nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.data.limits import FILE
from tracewire.errors import DataError, Location, Problem

NO_ROWS = "A series needs at least two rows of numbers."
SORT = "Sort the rows, in a series by clean: [sort]; or split the file, or choose rows by `where`."
ONCE = "Keep one row for each time, in a series by clean: [{sort: {duplicates: first}}]."
NO_VALUE = "Leave out the rows without a value."


class Request(NamedTuple):
    """The wanted columns, which of them is the time, the values that other columns of a row must
    have, the dialect, whether the rows may stand in any order, the places among the wanted columns
    of those that may lack a value in some rows, NaN then, and the numbers that stand for none."""

    wanted: tuple[str, ...]
    clock: int | None
    where: Mapping[str, str | float]
    dialect: tuple[str | None, str | None] = (None, None)
    comment: str = "#"
    in_any_order: bool = False
    sparse: frozenset[int] = frozenset()
    missing: tuple[float, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Every column that is looked for."""
        return (*self.wanted, *self.where)


class Found(NamedTuple):
    """The wanted columns (N,), units and names as the file gives them; lines (N,), 0: a row's
    number is all there is to say where it stands; what is odd about the file; and the date at
    which the time is 0, where the times are dates."""

    series: Sequence[Vector]
    units: Sequence[str]
    names: Sequence[str]
    lines: NDArray[np.int64]
    remarks: tuple[str, ...] = ()
    since: str = ""


def without_missing(found: Found, request: Request) -> Found:
    """What was found with NaN in the place of numbers that stand for no value, but in the time."""
    if not request.missing:
        return found
    series = [
        column
        if place == request.clock
        else np.where(np.isin(column, request.missing), nan, column)
        for place, column in enumerate(found.series)
    ]
    return found._replace(series=series)


def problems_of(found: Found, request: Request, file: str) -> list[Problem]:
    """What is wrong: numbers that are not finite, a time that goes back or stands twice."""
    problems: list[Problem] = []

    def note(row: int, what: str, hint: str, more: str = "") -> None:
        line = int(found.lines[row])
        where = "" if line else f" (row {row + 1})"
        problems.append(Problem(what + where + more, Location(file, line), hint=hint))

    told = set()
    for place, (name, series) in enumerate(zip(found.names, found.series, strict=True)):
        lacks = np.isnan(series) if place in request.sparse else np.zeros(len(series), dtype=bool)
        bad = np.flatnonzero(~np.isfinite(series) & ~lacks)
        if len(series) and lacks.all():
            note(0, f"{name} has no value in any row", "Name another column.")
        elif bad.size and name not in told:
            told.add(name)
            rows = f"{bad.size} rows, first here" if bad.size > 1 else "this row"
            note(int(bad[0]), f"{name} is not finite in {rows}", NO_VALUE)
    if request.clock is not None and not request.in_any_order:
        _check_time(found, request.clock, note)
    return problems


def raise_first(problems: Sequence[Problem], count: int, file: str) -> None:
    """Raise the first ten of the problems by line, and how many of `count` are not told."""
    if problems:
        told = sorted(problems, key=lambda problem: problem.place)[: FILE.most_problems]
        if more := count - len(told):
            told.append(Problem(f"and {more} more such problems", Location(file)))
        raise DataError(told)


def _check_time(found: Found, clock: int, note: Callable[[int, str, str, str], None]) -> None:
    """Note the rows that go back in time, and those whose time stands twice: a problem each."""
    time = found.series[clock]
    rows = np.flatnonzero(np.isfinite(time))
    time = time[rows]

    def where(at: int) -> str:
        line = int(found.lines[rows[at]])
        return f"line {line}" if line else f"row {rows[at] + 1}"

    def others(at: NDArray[np.intp]) -> str:
        if len(at) < 2:
            return ""
        kind = where(at[1]).partition(" ")[0]
        shown = ", ".join(where(i).partition(" ")[2] for i in at[1 : 1 + FILE.most_told])
        more = " and so on" if len(at) > 1 + FILE.most_told else ""
        return f"; the same in {len(at) - 1} more rows: {kind} {shown}{more}"

    back = np.flatnonzero(time[1:] < time[:-1])
    if len(back):
        i = int(back[0])
        what = f"time goes back to {time[i + 1]:.12g}, from {time[i]:.12g} in {where(i)}"
        note(int(rows[i + 1]), what, SORT, others(back + 1))
    twice = np.flatnonzero(time[1:] == time[:-1])
    if len(twice):
        i = int(twice[0])
        what = f"time {time[i]:.12g} stands twice, also in {where(i)}"
        note(int(rows[i + 1]), what, ONCE, others(twice + 1))


def too_few(count: int, file: str) -> DataError:
    """The error of a file with less than two rows."""
    rows = "only one row" if count else "no row"
    return DataError([Problem(f"the file has {rows} of numbers", Location(file), hint=NO_ROWS)])


def none_left(
    where: Mapping[str, str | float], seen: Sequence[Iterable[str]], file: str, place: Location
) -> DataError:
    """The error of a condition that no row fulfils; seen: the values there were, by column."""
    pairs = list(zip(where.items(), map(tuple, seen), strict=True))
    at = max((i for i, (_, values) in enumerate(pairs) if values), default=0)
    (name, wanted), values = pairs[at]
    shown = f"{wanted:g}" if isinstance(wanted, float) else wanted
    others = " and ".join(
        f"'{column}' is {value:g}" if isinstance(value, float) else f"'{column}' is '{value}'"
        for column, value in list(where.items())[:at]
    )
    what = f"no row of '{file}' has '{shown}' in the column '{name}'"
    what += f" where {others}" if others else ""
    return DataError([Problem(what, place, values, "Correct `where`.")])
