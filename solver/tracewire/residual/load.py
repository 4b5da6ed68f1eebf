"""The measured series that a diagram names, read from their files and cut into windows."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tracewire.arguments import checked
from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.data import Record, input_remarks
from tracewire.diagram import Series
from tracewire.errors import DataError, Location, OptionError, Problem, TracewireError, unknown
from tracewire.formula import evaluate
from tracewire.library import SENSOR_TERMS
from tracewire.residual.clean import cleaned, is_sorted, read_series
from tracewire.residual.inputs import between_samples
from tracewire.residual.limits import WINDOW
from tracewire.residual.measured import Measured
from tracewire.residual.remarks import check_quantities, factor_of_column, remarks_of
from tracewire.residual.rest import states_at_rest
from tracewire.residual.sensor import read_sensor
from tracewire.solve import Driving, parameter_values


def measured_series(model: Model, name: str) -> Measured:
    """The measured series of a model's diagram with this name, the first window of several.

    Raises OptionError: no such series; DataError: a file that cannot be used.
    """
    if name not in model.diagram.measured:
        raise OptionError([unknown("measured series", name, model.diagram.measured)])
    return load_measured(model, driving=True, series=[name])[0]


@checked
def load_measured(
    model: Model,
    uses: Iterable[str] = (),
    *,
    driving: bool = False,
    parameters: Mapping[str, float] | None = None,
    series: Iterable[str] = (),
) -> tuple[Measured, ...]:
    """The measured series of a model's diagram, read from their files.

    All are read, or those of some uses, or those whose names are in `series`.

    `parameters` are values in SI in place of those of the diagram, for starts and sensors that are
    formulas of them.
    A series with several windows gives one for each, as `swing (train)`. What `clean` says is done
    in its order; then the windows cut the record, in the file's own time, and that time is put to
    the diagram's. A series of inputs alone has nothing to compare: it is read if `driving`.

    Raises DataError: no series, a file or column that is missing or cannot be used, a column of
    another quantity than its signal, a step that cannot be done, a window without samples.
    """
    wanted, names = set(uses), set(series)
    chosen = [
        one
        for name, one in model.diagram.measured.items()
        if (not wanted or wanted & {one.use, *one.windows})
        and (not names or name in names)
        and (one.channels or driving)
    ]
    if not chosen:
        what = "the diagram names no measured series" + (f" for {sorted(wanted)}" if wanted else "")
        hint = "Add one under `measured:` with file, time and signals."
        raise DataError([Problem(what, Location(str(model.diagram.file)), (), hint)])
    problems: list[Problem] = []
    loaded: list[Measured] = []
    for one in chosen:
        try:
            loaded += _load(model, one, wanted, parameters or {})
        except TracewireError as error:
            problems += error.problems
    if problems:
        raise DataError(problems)
    return tuple(loaded)


def _load(
    model: Model, series: Series, uses: Collection[str], parameters: Mapping[str, float]
) -> list[Measured]:
    first = series.clean[: int(is_sorted(series))]
    read = cleaned(series, read_series(series), first)
    record = cleaned(series, read, series.clean[len(first) :])
    check_quantities(model, series, record)
    read = _known(series, read)
    _check_size(series, _known(series, record))
    if not series.windows:
        ends = (_or(series.begin, -math.inf), _or(series.end, math.inf))
        return [_measured(model, series, read, record, series.use, ends, parameters)]
    return [
        _measured(model, series, read, record, use, ends, parameters)
        for use, ends in series.windows.items()
        if not uses or use in uses
    ]


def _measured(
    model: Model,
    series: Series,
    read: Record,
    record: Record,
    use: str,
    ends: tuple[float, float],
    parameters: Mapping[str, float],
) -> Measured:
    """The part of a record in a window, in the time of the diagram."""
    channels = series.channels
    own = series_parameters(model, series)
    values = parameter_values(model, {**parameters, **own}, series.preset)
    zero = series.time.zero * record.time_unit.factor
    whole = record  # an input is known also where no signal has a value
    inputs, told = _inputs(series, whole, whole.t - zero)
    record = _known(series, record)
    rows = _window(series, record, ends)
    if len(rows) < len(record.t):
        some = f"{len(rows)} of {len(record.t)} samples"
        used_up = f"window {record.t[rows[0]]:g} ... {record.t[rows[-1]]:g} s of the file: {some}"
        record = replace(record, steps=(*record.steps, used_up))
    steps = record.shift(zero).steps
    t = record.t - zero
    counts_from = t[rows[0]] + series.burn_in if series.burn_in else -math.inf
    if t[rows[-1]] < counts_from:
        what = f"the series '{series.name}' ends within its burn_in of {series.burn_in:g} s"
        raise DataError([Problem(what, series.place, (), "Make burn_in shorter.")])
    factors = {name: factor_of_column(record, name, channel) for name, channel in channels.items()}
    used = record.t[rows]
    few = np.sum((read.t >= used[0]) & (read.t <= used[-1])) < 3
    seen = read if few else read.trim(used[0], used[-1])
    inside = (whole.t >= used[0]) & (whole.t <= used[-1])
    gaps = [
        remark
        for name in series.inputs
        for remark in input_remarks(name, whole.t[inside], whole.columns[f"input {name}"][inside])
    ]
    start = {
        name: None if value is None else evaluate(value.formula, values) * value.factor
        for name, value in series.start.items()
    }
    if start:  # else a run begins at the diagram's own start
        start = {**states_at_rest(model, values, inputs, float(t[rows[0]])), **start}
    return Measured(
        name=f"{series.name} ({use})" if series.windows else series.name,
        series=series.name,
        use=use,
        t=t[rows],
        values={name: record.columns[name][rows] for name in channels},
        sigma={
            name: None if channel.sigma is None else channel.sigma * factors[name]
            for name, channel in channels.items()
        },
        sensors={
            name: read_sensor(channel, values, factors[name])
            for name, channel in channels.items()
            if any(getattr(channel, kind) is not None for kind in SENSOR_TERMS)
        },
        periods={
            name: channel.modulo * factors[name]
            for name, channel in channels.items()
            if channel.modulo is not None
        },
        weight=series.weight,
        weights={name: c.weight for name, c in channels.items() if c.weight != 1.0},
        counts_from=counts_from,
        inputs=inputs,
        input_sigma={
            name: channel.sigma * factor_of_column(record, f"input {name}", channel)
            for name, channel in series.inputs.items()
            if channel.sigma is not None
        },
        start=start,
        drift_from=float(t[_window(series, record, _whole(series))[0]]),
        parameters=own,
        free={name: v.fit for name, v in series.parameters.items() if v.fit is not None},
        preset=series.preset,
        file=str(series.file),
        steps=(*steps, *told),
        remarks=(
            *remarks_of(model, series, replace(seen, remarks=read.remarks), values, zero),
            *gaps,
        ),
    )


def _inputs(series: Series, record: Record, t: Vector) -> tuple[dict[str, Driving], list[str]]:
    """The inputs of a record by name, and how each acts between its samples."""
    found: dict[str, Driving] = {}
    told = []
    for name, channel in series.inputs.items():
        values = record.columns[f"input {name}"]
        found[name], words = between_samples(name, t, values, channel.hold)
        told.append(words)
    return found, told


def series_parameters(model: Model, series: Series) -> dict[str, float]:
    """The values in SI that a series gives to parameters of the diagram."""
    known = parameter_values(model, {}, series.preset)
    return {
        name: evaluate(value.formula, known) * value.factor
        for name, value in series.parameters.items()
    }


def _known(series: Series, record: Record) -> Record:
    """The rows of a record in which each signal of the series has a value. Raises DataError."""
    try:
        return record.known(name for name in series.channels if name in record.columns)
    except OptionError as error:
        raise DataError([replace(p, place=series.place) for p in error.problems]) from None


def _check_size(series: Series, record: Record) -> None:
    problems = []
    longest = float(np.abs(record.t).max())
    if longest > WINDOW.largest:
        what = f"the time of the series '{series.name}' reaches {longest:.3g} s, too large to fit"
        problems.append(Problem(what, series.place, (), "Correct its column, or its unit."))
    for name, channel in series.channels.items():
        largest = float(np.abs(record.columns[name]).max())
        if largest > WINDOW.largest:
            what = f"'{name}' of the series '{series.name}' reaches {largest:.3g}, too large to fit"
            hint = f"Correct the column '{channel.column}', or its unit."
            problems.append(Problem(what, series.place, (), hint))
    if problems:
        raise DataError(problems)


def _window(series: Series, record: Record, ends: tuple[float, float]) -> NDArray[np.intp]:
    """The rows in a window; a sample at the common end of two windows belongs to the later."""
    low, high = ends
    inside = (record.t >= low) & (record.t <= high)
    if any(begin == high for begin, _ in series.windows.values()):
        inside &= record.t < high
    rows = np.flatnonzero(inside)
    if len(rows) < 2:
        what = (
            f"the series '{series.name}' has {len(rows)} samples between {low:g} and {high:g} s; "
            f"the file covers {record.t[0]:g} to {record.t[-1]:g} s"
        )
        hint = "Correct the windows of `use`." if series.windows else "Correct `from` and `to`."
        raise DataError([Problem(what, series.place, (), hint)])
    return rows


def _whole(series: Series) -> tuple[float, float]:
    """From the begin of the first window, or of the series, on: a drift goes on over windows."""
    begin = min((low for low, _ in series.windows.values()), default=_or(series.begin, -math.inf))
    return begin, math.inf


def _or(value: float | None, default: float) -> float:
    return default if value is None else value
