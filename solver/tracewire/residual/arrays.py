"""Measured series that are given as arrays or as a frame: checked, with the names in messages."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from numbers import Real
from typing import Any, get_args

import numpy as np

from tracewire.array_types import Vector
from tracewire.data import read_frame, record_of, signal_remarks, time_remarks
from tracewire.diagram import Hold, Use
from tracewire.errors import DataError, FormulaError, Location, OptionError, Problem, unknown
from tracewire.residual.inputs import between_samples
from tracewire.solve import Driving, with_points

NO_VALUE = "Leave out the rows without a value."
NO_SIGMA = "Leave it out, and the noise is estimated."
SORT = "Sort the rows by t, and keep one for each time."


class ArrayCheck:
    """Arrays of a series as vectors of numbers, and what is wrong with them."""

    def __init__(self, series: str) -> None:
        self.series = series
        self.problems: list[Problem] = []

    def time(self, given: Any) -> Vector:
        """Times (N,) in s that increase."""
        return self._increasing(self._vector("t", given), "t")

    def values(self, given: Mapping[str, Any], t: Vector) -> dict[str, Vector]:
        """Values (N,) by signal, as many as there are times."""
        return {name: self._beside(f"'{name}'", values, t) for name, values in given.items()}

    def inputs(self, given: Mapping[str, Driving]) -> dict[str, Driving]:
        """Times (K,) and values (K,) by input."""
        found = {}
        for name, driving in given.items():
            times = self._vector(f"the time of the input '{name}'", driving[0])
            values = self._beside(f"the input '{name}'", driving[1], times, "its time")
            found[name] = with_points(driving, times, values)
        return found

    def names(self, of: str, kind: str, given: Iterable[str], known: Iterable[str]) -> None:
        """Note the names of an argument that are none of the series."""
        wrong = (unknown(kind, name, known) for name in given if name not in known)
        self.problems += [Problem(f"{self._of(of)}: {p.what}", p.place, p.exists, p.hint)
                          for p in wrong]  # fmt: skip

    def mappings(self, given: Mapping[str, Any]) -> None:
        """Raise DataError where an argument is no dictionary."""
        for of, value in given.items():
            if not isinstance(value, Mapping):
                hint = f'Write {of}={{"x": ...}}, with the names of the diagram.'
                what = f"{self._of(of)} is no dictionary"
                self.problems.append(Problem(what, hint=hint))
        self.finish()

    def above_zero(self, of: str, given: Any, hint: str = "") -> None:
        """Note a number that is not finite and above zero."""
        plain = isinstance(given, Real) and not isinstance(given, bool)
        if not plain or not (math.isfinite(given) and given > 0):
            what = f"{self._of(of)} must be a number above zero, not {given!r}"
            self.problems.append(Problem(what, hint=hint))

    def starts(self, given: Mapping[str, Any]) -> None:
        """Note start values that are neither finite numbers nor None."""
        for name, value in given.items():
            plain = isinstance(value, Real) and math.isfinite(value)
            if value is not None and not plain:
                what = f"{self._of(f'the start of {name!r}')} must be a number, not {value!r}"
                self.problems.append(Problem(what, hint="None is a free start value."))

    def finish(self) -> None:
        """Raise DataError with all that was noted."""
        if self.problems:
            raise DataError(self.problems)

    def _of(self, what: str) -> str:
        return f"{what} of the series '{self.series}'"

    def _vector(self, what: str, given: Any) -> Vector:
        """An argument as numbers (N,), all finite."""
        try:
            array = np.asarray(given)
            if array.dtype.kind not in "biufO":
                raise TypeError(array.dtype.name)
            array = np.asarray(array, dtype=np.float64)
        except (TypeError, ValueError):
            hint = "Dates and texts are read by Measured.from_frame."
            self.problems.append(Problem(f"{self._of(what)} is not an array of numbers", hint=hint))
            return np.zeros(0)
        if array.ndim != 1:
            shape = " x ".join(map(str, array.shape)) or "a single number"
            some = f"{self._of(what)} is not one column of numbers: {shape}"
            self.problems.append(Problem(some, hint="Give an array (N,)."))
            return np.zeros(0)
        bad = np.flatnonzero(~np.isfinite(array))
        if len(bad):
            count = "a value" if len(bad) == 1 else f"{len(bad)} values"
            some = f"{self._of(what)} has {count} not finite, first at index {bad[0]}"
            self.problems.append(Problem(some, hint=NO_VALUE))
        return array

    def _increasing(self, t: Vector, what: str) -> Vector:
        back = np.flatnonzero(~(np.diff(t) > 0) & np.isfinite(t[1:]) & np.isfinite(t[:-1]))
        if len(back):
            i = int(back[0]) + 1
            more = f", and at {len(back) - 1} more" if len(back) > 1 else ""
            some = f"{self._of(what)} does not increase at index {i}{more}: "
            self.problems.append(Problem(f"{some}{t[i]:.9g} after {t[i - 1]:.9g}", hint=SORT))
        return t

    def _beside(self, what: str, given: Any, t: Vector, other: str = "t") -> Vector:
        values = self._vector(what, given)
        if len(values) != len(t) and len(values) and len(t):
            some = f"{self._of(what)} has {len(values)} values, and {other} has {len(t)}"
            self.problems.append(Problem(some, hint="Give one value for each time."))
        return values


def fields_of_frame(
    frame: Any,
    signals: str | Iterable[str] | Mapping[str, str],
    inputs: str | Iterable[str] | Mapping[str, str],
    time: str | None,
    units: Mapping[str, str],
    sigma: Mapping[str, float],
    hold: Mapping[str, Hold],
    use: Use,
    name: str,
) -> dict[str, Any]:
    """What a frame says of a series, as arguments of `Measured`. Raises DataError, FormulaError."""
    measured, driving = _by_name(signals), _by_name(inputs)
    check = ArrayCheck(name)
    known = [*measured, *driving]
    both = [n for n in measured if n in driving]
    check.problems += [Problem(f"'{n}' is a signal and an input, too") for n in both]
    if not known:
        hint = 'Name columns of the frame: signals=["theta"].'
        check.problems.append(Problem(f"the series '{name}' has no signals", hint=hint))
    if use not in get_args(Use):
        check.problems.append(unknown("use", use, get_args(Use)))
    for of, kind, given, names in (
        ("sigma", "signal or input", sigma, known),
        ("units", "signal or input", units, known),
        ("hold", "input", hold, driving),
    ):
        check.names(of, kind, given, names)
    check.finish()
    read = read_frame(frame, {**measured, **driving}, time, name, measured)
    try:
        whole = record_of(read, units, place=Location(name))
        record = whole.known(measured)
    except (FormulaError, OptionError) as error:
        raise DataError(error.problems) from None
    steps, driven = list(record.steps), {}
    for one in driving:  # also in rows without a value of a signal
        driven[one], told = between_samples(one, whole.t, whole.columns[one], hold.get(one))
        steps.append(told)
    remarks = [*record.remarks, *time_remarks(record.t)]
    for column, values in record.columns.items():
        exact = column in driving
        remarks += signal_remarks(column, record.t, values, record.unit(column).text, exact=exact)
    for one, value in sigma.items():
        check.above_zero(f"sigma of '{one}'", value, NO_SIGMA)
    check.finish()
    noise = {n: value * record.unit(n).factor for n, value in sigma.items()}
    known_units = {n: record.unit(n) for n in known if record.unit(n).text}
    return {
        "name": name,
        "use": use,
        "t": record.t,
        "values": {n: record.columns[n] for n in measured},
        "inputs": driven,
        "sigma": {n: value for n, value in noise.items() if n in measured},
        "input_sigma": {n: value for n, value in noise.items() if n in driving},
        "units": {n: unit.written or unit.text for n, unit in known_units.items()},
        "steps": tuple(steps),
        "remarks": tuple(remarks),
    }


def _by_name(columns: str | Iterable[str] | Mapping[str, str]) -> dict[str, str]:
    """Columns by the names that they stand for."""
    if isinstance(columns, Mapping):
        return dict(columns)
    names = [columns] if isinstance(columns, str) else columns
    return {column: column for column in names}
