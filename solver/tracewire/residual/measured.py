"""From the series that a diagram names to arrays: measured signals, inputs, start values."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from tracewire.arguments import checked
from tracewire.array_types import Vector
from tracewire.compile import Model, compile, find_name_clashes
from tracewire.diagram import Hold, Use
from tracewire.errors import DataError, OptionError, Problem
from tracewire.formula import same_quantity
from tracewire.residual.arrays import NO_SIGMA, ArrayCheck, fields_of_frame
from tracewire.residual.local_quartics import quartic_points
from tracewire.residual.sensor import PLAIN, Sensor
from tracewire.solve import Driving, Options


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
    was done to the data since they were read, `remarks` what is odd about them. `units` are those
    of columns of a frame, for what knows the units of the model.

    Arrays may be lists, or columns of a frame. Raises DataError: a length that differs from that of
    `t`, a value that is not finite, a time that does not increase, an unknown signal, a sigma or a
    weight that is not above zero.
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
    units: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check = ArrayCheck(self.name)
        dictionaries = ("values", "sigma", "sensors", "periods", "weights", "inputs", "start")
        check.mappings({of: getattr(self, of) for of in (*dictionaries, "parameters", "units")})
        t = check.time(self.t)
        values = check.values(self.values, t)
        given = {"t": t, "values": values, "inputs": check.inputs(self.inputs)}
        for of in ("sigma", "sensors", "periods", "weights"):
            check.names(of, "signal", getattr(self, of), self.values)
        check.names("input_sigma", "input", self.input_sigma, self.inputs)
        for signal, sigma in {**self.sigma, **self.input_sigma}.items():
            if sigma is not None:
                check.above_zero(f"sigma of '{signal}'", sigma, NO_SIGMA)
        check.above_zero("weight", self.weight, "Leave a series out that shall not count.")
        for signal, weight in self.weights.items():
            check.above_zero(f"weight of '{signal}'", weight)
        check.starts(self.start)
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
    @checked
    def from_frame(
        cls,
        frame: Any,
        signals: str | Iterable[str] | Mapping[str, str],
        *,
        inputs: str | Iterable[str] | Mapping[str, str] = (),
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
        in the order of time. A fit or a trace refuses a unit of another quantity.
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


def with_measured_signals(model: Model, series: Sequence[Measured]) -> Model:
    """The model with every signal of the series among the recorded ones.

    Raises DataError: two series of one name, by which all else tells series apart, a column in a
    unit of another quantity than its signal; OptionError: a
    signal that the model does not have, or with a sensor of which a number has the name of a
    parameter.
    """
    if twice := [name for name, count in Counter(m.name for m in series).items() if count > 1]:
        hint = "Give each series a `name` of its own."
        raise DataError(
            [Problem(f"several series are called '{name}'", hint=hint) for name in twice]
        )
    if problems := [problem for m in series for problem in _unit_problems(model, m)]:
        raise DataError(problems)
    signals = dict.fromkeys(signal for m in series for signal in m.values)
    if problems := find_name_clashes(model.flat, signals):
        raise OptionError(problems)
    if signals.keys() <= set(model.recorded):
        return model
    return compile(model.diagram, record=[*model.recorded, *signals])


def _unit_problems(model: Model, series: Measured) -> list[Problem]:
    """The columns of a frame that are in units of other quantities than the model's."""
    found = []
    for name, unit in series.units.items():
        own = model.flat.units.get(name, "")
        if own and not same_quantity(unit, own):
            what = (
                f"'{name}' is in {own} in the diagram, and in {unit} in the series '{series.name}'"
            )
            hint = 'Correct the unit: units={"x": "mm"} for a column whose name says none.'
            found.append(Problem(what, hint=hint))
    return found
