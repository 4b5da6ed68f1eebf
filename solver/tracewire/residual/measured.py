"""From the series that a diagram names to arrays: measured signals, inputs, start values."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model, compile, find_name_clashes
from tracewire.data import STEPS, Record, read_record
from tracewire.diagram import Channel, Cleaning, Hold, Series, Use
from tracewire.errors import DataError, Location, OptionError, Problem, TracewireError, unknown
from tracewire.formula import evaluate
from tracewire.library import SENSOR_TERMS
from tracewire.residual.arrays import ArrayCheck, fields_of_frame
from tracewire.residual.inputs import between_samples
from tracewire.residual.limits import WINDOW
from tracewire.residual.local_quartics import quartic_points
from tracewire.residual.remarks import check_quantities, factor_of_column, remarks_of
from tracewire.residual.rest import states_at_rest
from tracewire.residual.sensor import PLAIN, Sensor, read_sensor
from tracewire.solve import Driving, Options, parameter_values

Vector = NDArray[np.float64]
SAMPLE_BY_SAMPLE = ("sort", "trim", "calibrate")
"""The steps of `clean` that look at one sample at a time."""


@dataclass(frozen=True, eq=False)
class Measured:
    """One measured series in SI: times `t` (N,) in s, and `values` (N,) of each measured signal.

    `sigma` is the standard deviation of the noise by signal (None: not known), `sensors` what
    channels with an offset, gain, delay, quad or drift have of these, `periods` the period of
    signals that are compared modulo it (2 pi for an angle); their samples go on from turn to turn.
    `weight` counts the whole series in the criterion, `weights` single signals. A drift counts from
    `drift_from` (s), the first sample unless given. Samples before `counts_from` (s) do not count.
    `inputs` maps a named input to its times and values, a smooth one (`residual.inputs`) to points
    of a spline, and `input_sigma` to the standard deviation of its noise, white from sample to
    sample. `past` maps a delayed signal to what it was, for runs that begin within the series
    (`with_past`). `start` holds start values of this series by state, None where free; without any,
    a run begins at the start of the diagram's span. `parameters` are those of the diagram that have
    a value of their own in this series, `free` the bounds of those that a fit may change. `series`
    is its name in the diagram, which is not `name` where it has several windows. `steps` tells what
    was done to the data since they were read, `remarks` what is odd about them.

    Arrays may be lists, or columns of a frame. Raises DataError: a length that differs from that of
    `t`, a value that is not finite, a time that does not increase, an unknown signal.
    """

    name: str
    use: str
    t: Vector
    values: Mapping[str, Vector]
    sigma: Mapping[str, float | None] = field(default_factory=dict)
    sensors: Mapping[str, Sensor] = field(default_factory=dict)
    periods: Mapping[str, float] = field(default_factory=dict)
    weight: float = 1.0
    weights: Mapping[str, float] = field(default_factory=dict)
    counts_from: float = -math.inf
    inputs: Mapping[str, Driving] = field(default_factory=dict)
    start: Mapping[str, float | None] = field(default_factory=dict)
    parameters: Mapping[str, float] = field(default_factory=dict)
    free: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    preset: str = ""
    file: str = ""
    series: str = ""
    steps: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()
    drift_from: float | None = None
    input_sigma: Mapping[str, float] = field(default_factory=dict)
    past: Mapping[str, Driving] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check = ArrayCheck(self.name)
        t = check.time(self.t)
        values = check.values(self.values, t)
        given = {"t": t, "values": values, "inputs": check.inputs(self.inputs)}
        for of in ("sigma", "sensors", "periods", "weights"):
            check.names(of, "signal", getattr(self, of), self.values)
        check.names("input_sigma", "input", self.input_sigma, self.inputs)
        check.finish()
        given["values"] = {
            name: np.unwrap(column, period=self.periods[name]) if name in self.periods else column
            for name, column in values.items()
        }
        for name, value in given.items():
            object.__setattr__(self, name, value)

    @cached_property
    def interval(self) -> float:
        """The time in s from one sample to the next, the median; 0 of a single sample."""
        return float(np.median(np.diff(self.t))) if len(self.t) > 1 else 0.0

    @classmethod
    def from_frame(
        cls,
        frame: Any,
        signals: Iterable[str] | Mapping[str, str],
        *,
        inputs: Iterable[str] | Mapping[str, str] = (),
        time: str | None = None,
        units: Mapping[str, str] | None = None,
        sigma: Mapping[str, float] | None = None,
        hold: Mapping[str, Hold] | None = None,
        start: Mapping[str, float | None] | None = None,
        use: Use = "train",
        name: str = "frame",
    ) -> Measured:
        """A series from a frame of pandas, polars or pyarrow, or a mapping of names to arrays.

        `signals` and `inputs` name columns that are called as in the diagram, or map the name in
        the diagram to the column: `{"theta": "angle"}` finds `angle` and `angle [deg]`. `time` is
        the column of time, of numbers or of dates; the first column, or the index, unless given.
        `units` are those of columns whose name does not say it, by signal; values become SI.
        `sigma` is the standard deviation of the noise of a signal or an input, in the unit of its
        column; `hold` how an input acts between its samples: previous, linear or smooth. `start`
        has start values of states in SI, None where free.

        Raises DataError: a column that does not exist, a value that is missing, rows that are not
        in the order of time, a unit of another quantity.
        """
        fields = fields_of_frame(
            frame, signals, inputs, time, units or {}, sigma or {}, hold or {}, use, name
        )
        return cls(start=start or {}, **fields)

    @property
    def zero(self) -> float:
        """The time t0 in s from which the drift of a sensor counts."""
        return float(self.t[0]) if self.drift_from is None else self.drift_from

    @property
    def known_start(self) -> dict[str, float]:
        """The start values of states in SI that are not free."""
        return {name: value for name, value in self.start.items() if value is not None}

    @property
    def span(self) -> tuple[float, float] | None:
        """Begin and end in s of a run under its conditions: a series with start values begins at
        its first sample, one without (None) at the diagram's start."""
        return (float(self.t[0]), float(self.t[-1])) if self.start else None

    @property
    def conditions(self) -> Options:
        """What `simulate` is given for a run under the conditions of the series."""
        return Options(
            parameters=dict(self.parameters),
            preset=self.preset,
            start=self.known_start,
            span=self.span,
            inputs=dict(self.inputs),
        )

    @cached_property
    def spreads(self) -> Mapping[str, float]:
        """The standard deviation of each measured signal."""
        return {name: float(np.std(values)) for name, values in self.values.items()}

    @cached_property
    def rate_spreads(self) -> Mapping[str, float]:
        """The standard deviation of the rate of each measured signal."""
        return {name: float(np.std(np.gradient(v, self.t))) for name, v in self.values.items()}

    @cached_property
    def fastest(self) -> float:
        """The largest standard deviation of a measured signal's rate."""
        return max(self.rate_spreads.values())

    @cached_property
    def quartic_points(self) -> Mapping[str, int]:
        """Through how many samples a local quartic follows each measured signal."""
        return {name: quartic_points(self.t, values) for name, values in self.values.items()}

    def sensor(self, signal: str) -> Sensor:
        """The sensor of a signal; it shows the signal itself where nothing is said of it."""
        return self.sensors.get(signal, PLAIN)


def measured_series(model: Model, name: str) -> Measured:
    """The measured series of a model's diagram with this name, the first window of several.

    Raises OptionError: no such series; DataError: a file that cannot be used.
    """
    if name not in model.diagram.measured:
        raise OptionError([unknown("measured series", name, model.diagram.measured)])
    return load_measured(model, driving=True, series=[name])[0]


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
    first = series.clean[: int(_is_sorted(series))]
    read = _cleaned(series, _read(series), first)
    record = _cleaned(series, read, series.clean[len(first) :])
    check_quantities(model, series, record)
    _check_size(series, record)
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
    rows = _window(series, record, ends)
    zero = series.time.zero * record.time_unit.factor
    if len(rows) < len(record.t):
        some = f"{len(rows)} of {len(record.t)} samples"
        used_up = f"window {record.t[rows[0]]:g} ... {record.t[rows[-1]]:g} s of the file: {some}"
        record = replace(record, steps=(*record.steps, used_up))
    steps = record.shift(zero).steps
    t = record.t - zero
    inputs, told = _inputs(series, record, t)
    counts_from = t[rows[0]] + series.burn_in if series.burn_in else -math.inf
    if t[rows[-1]] < counts_from:
        what = f"the series '{series.name}' ends within its burn_in of {series.burn_in:g} s"
        raise DataError([Problem(what, series.place, (), "Make burn_in shorter.")])
    factors = {name: factor_of_column(record, name, channel) for name, channel in channels.items()}
    used = record.t[rows]
    few = np.sum((read.t >= used[0]) & (read.t <= used[-1])) < 3
    seen = read if few else read.trim(used[0], used[-1])
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
        remarks=remarks_of(model, series, replace(seen, remarks=read.remarks), values, zero),
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


def _read(series: Series) -> Record:
    """The columns of a series in SI; those to be calibrated as they stand in the file."""
    channels = _columns(series)
    clock, form = series.time, series.format
    return read_record(
        series.file,
        {name: channel.column for name, channel in channels.items()},
        clock.column or None,
        units={n: c.declared for n, c in channels.items() if c.declared is not None},
        time_unit=clock.unit,
        raw=[str(s.options.get("signal")) for s in series.clean if s.step == "calibrate"],
        delimiter=form.delimiter,
        decimal=form.decimal,
        comment=form.comment,
        every=clock.every,
        where=series.where,
        in_any_order=_is_sorted(series),
        place=series.place,
    )


def _is_sorted(series: Series) -> bool:
    """Whether the rows are put in the order of time, which is the first step where it is one."""
    return any(step.step == "sort" for step in series.clean)


def _columns(series: Series) -> dict[str, Channel]:
    """The channels that are columns of the file, by their names in the record."""
    inputs = {f"input {name}": channel for name, channel in series.inputs.items()}
    return {n: c for n, c in {**series.channels, **inputs}.items() if c.column}


def _cleaned(series: Series, record: Record, steps: Sequence[Cleaning]) -> Record:
    """The record after some steps of `clean`."""
    channels = _columns(series)
    for step in steps:
        options: dict[str, object] = dict(step.options)
        if step.step not in SAMPLE_BY_SAMPLE:
            record = _on_turns(series, record)
        try:
            if step.step == "calibrate":
                signal = str(options["signal"])
                gain, offset = (
                    cast(float, options.get(name, default))
                    for name, default in (("gain", 1.0), ("offset", 0.0))
                )
                unit = channels[signal].declared or ""
                record = record.calibrate(signal, gain, offset, unit)
                continue
            for name, option in STEPS[step.step].items():
                if option.kind == "size" and name in options:
                    factor = record.unit(str(options["signal"])).factor
                    options[name] = cast(float, options[name]) * factor
            record = record.clean(step.step, options)
        except OptionError as error:
            where = f"'{step.step}' of series '{series.name}'"
            problems = [
                replace(p, what=f"{where}: {p.what}", place=step.place) for p in error.problems
            ]
            raise DataError(problems) from None
    return record


def _on_turns(series: Series, record: Record) -> Record:
    """The record whose signals with a period go on from turn to turn: a step that looks at several
    samples would make something between the last one of a turn and the first one of the next."""
    columns = dict(record.columns)
    for name, channel in series.channels.items():
        if channel.modulo is not None and name in columns:
            period = channel.modulo * factor_of_column(record, name, channel)
            columns[name] = np.unwrap(columns[name], period=period)
    return replace(record, columns=columns)


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


def with_measured_signals(model: Model, series: Sequence[Measured]) -> Model:
    """The model with every signal of the series among the recorded ones.

    Raises DataError: two series of one name, by which all else tells series apart; OptionError: a
    signal that the model does not have, or with a sensor of which a number has the name of a
    parameter.
    """
    if twice := [name for name, count in Counter(m.name for m in series).items() if count > 1]:
        hint = "Give each series a `name` of its own."
        raise DataError(
            [Problem(f"several series are called '{name}'", hint=hint) for name in twice]
        )
    signals = dict.fromkeys(signal for m in series for signal in m.values)
    if problems := find_name_clashes(model.flat, signals):
        raise OptionError(problems)
    if signals.keys() <= set(model.recorded):
        return model
    return compile(model.diagram, record=[*model.recorded, *signals])
