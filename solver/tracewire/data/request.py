"""What is wanted of a file, what was found there, and checks that hold for every format."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tracewire.errors import DataError, Place, Problem

Vector = NDArray[np.float64]
MOST_PROBLEMS = 10
NO_ROWS = "A series needs at least two rows of numbers."
SORT = "Sort the rows, split the file here, or choose rows with `where`."
NO_VALUE = "Leave out the rows without a value."


class Request(NamedTuple):
    """The wanted columns, which of them is the time, the values that other columns of a row must
    have, and the dialect."""

    wanted: tuple[str, ...]
    clock: int | None
    where: Mapping[str, str | float]
    dialect: tuple[str | None, str | None] = (None, None)
    comment: str = "#"

    @property
    def names(self) -> tuple[str, ...]:
        """Every column that is looked for."""
        return (*self.wanted, *self.where)


class Found(NamedTuple):
    """The wanted columns (N,), units and names as the file gives them; lines (N,), 0: a row's
    number is all there is to say where it stands; and what is odd about the file."""

    series: Sequence[Vector]
    units: Sequence[str]
    names: Sequence[str]
    lines: NDArray[np.int64]
    remarks: tuple[str, ...] = ()


def problems_of(found: Found, clock: int | None, file: str) -> list[Problem]:
    """What is wrong: numbers that are not finite, a time (column `clock`) that goes back."""
    problems: list[Problem] = []

    def note(row: int, what: str, hint: str) -> None:
        line = int(found.lines[row])
        where = "" if line else f" (row {row + 1})"
        problems.append(Problem(what + where, Place(file, line), hint=hint))

    told = set()
    for name, series in zip(found.names, found.series, strict=True):
        bad = np.flatnonzero(~np.isfinite(series))
        if bad.size and name not in told:
            told.add(name)
            rows = f"{bad.size} rows, first here" if bad.size > 1 else "this row"
            note(int(bad[0]), f"{name} is not finite in {rows}", NO_VALUE)
    if clock is not None:
        _check_time(found, clock, note)
    return problems


def raise_first(problems: Sequence[Problem], count: int, file: str) -> None:
    """Raise the first ten of the problems by line, and how many of `count` are not told."""
    if problems:
        told = sorted(problems, key=lambda problem: problem.place)[:MOST_PROBLEMS]
        if more := count - len(told):
            told.append(Problem(f"and {more} more such problems", Place(file)))
        raise DataError(told)


def _check_time(found: Found, clock: int, note: Callable[[int, str, str], None]) -> None:
    time = found.series[clock]
    rows = np.flatnonzero(np.isfinite(time))
    time = time[rows]
    for i in np.flatnonzero(time[1:] <= time[:-1]):
        before, now, line = float(time[i]), float(time[i + 1]), int(found.lines[rows[i]])
        where = f"line {line}" if line else f"row {rows[i] + 1}"
        if now == before:
            what = f"time {now} stands twice, also in {where}"
            note(int(rows[i + 1]), what, "Keep one row for each time.")
        else:
            what = f"time goes back to {now}, from {before} in {where}"
            note(int(rows[i + 1]), what, SORT)


def too_few(count: int, file: str) -> DataError:
    """The error of a file with less than two rows."""
    rows = "only one row" if count else "no row"
    return DataError([Problem(f"the file has {rows} of numbers", Place(file), hint=NO_ROWS)])


def none_left(
    where: Mapping[str, str | float], seen: Sequence[Iterable[str]], file: str, place: Place
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
