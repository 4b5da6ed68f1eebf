"""From the series that a diagram names to arrays: measured signals, inputs, start values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.data import Columns, read_columns
from tracewire.diagram import Diagram, Series
from tracewire.errors import DataError, Place, Problem, TracewireError
from tracewire.formula import evaluate
from tracewire.solve import parameter_values

Vector = NDArray[np.float64]
LARGEST = 1e100  # its square, and sums of such squares, are numbers still


@dataclass(frozen=True, eq=False)
class Measured:
    """One measured series in SI: times `t` (N,) in s, and `values` (N,) of each measured signal.

    `sigma` is the standard deviation of the noise by signal (None: not known), `offset` the
    declared offset of the sensor, `free_offsets` the bounds of those that a fit may change.
    `inputs` maps a named input to its times and values. `start` holds start values of this series
    by state, None where free; without any, a run begins at the start of the diagram's span.
    """

    name: str
    use: str
    t: Vector
    values: Mapping[str, Vector]
    sigma: Mapping[str, float | None] = field(default_factory=dict)
    offset: Mapping[str, float] = field(default_factory=dict)
    free_offsets: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    inputs: Mapping[str, tuple[Vector, Vector]] = field(default_factory=dict)
    start: Mapping[str, float | None] = field(default_factory=dict)
    preset: str = ""
    file: str = ""

    def part(self, rows: slice | NDArray[np.intp]) -> dict[str, Vector]:
        """The measured values of some rows, by signal."""
        return {name: values[rows] for name, values in self.values.items()}


def measured_signals(diagram: Diagram) -> tuple[str, ...]:
    """Every signal that a series of the diagram measures, once."""
    names = (name for series in diagram.measured.values() for name in series.channels)
    return tuple(dict.fromkeys(names))


def load_measured(model: Model, uses: Iterable[str] = ()) -> tuple[Measured, ...]:
    """The measured series of a model's diagram, read from their files; all, or those of some uses.

    Raises DataError: no series, a file or column that is missing or cannot be used, a window
    without samples.
    """
    wanted = set(uses)
    chosen = [s for s in model.diagram.measured.values() if not wanted or s.use in wanted]
    if not chosen:
        what = "the diagram names no measured series" + (f" for {sorted(wanted)}" if wanted else "")
        hint = "Add one under `measured:` with file, time and signals."
        raise DataError([Problem(what, Place(str(model.diagram.file)), (), hint)])
    problems: list[Problem] = []
    loaded = []
    for series in chosen:
        try:
            loaded.append(_load(model, series))
        except TracewireError as error:
            problems += error.problems
    if problems:
        raise DataError(problems)
    return tuple(loaded)


def _load(model: Model, series: Series) -> Measured:
    channels = {f"signal {name}": channel for name, channel in series.channels.items()}
    channels |= {f"input {name}": channel for name, channel in series.inputs.items()}
    columns = {name: channel.column for name, channel in channels.items()}
    read = read_columns(Path(series.file), columns, series.time, place=series.place)
    values = parameter_values(model, {}, series.preset)
    rows = _window(series, read)
    signals = {
        name: read.values[f"signal {name}"][rows] * channel.factor
        for name, channel in series.channels.items()
    }
    _check_size(series, signals)
    return Measured(
        name=series.name,
        use=series.use,
        t=read.time[rows],
        values=signals,
        sigma={name: channel.sigma for name, channel in series.channels.items()},
        offset={
            name: evaluate(channel.offset.formula, values) * channel.offset.factor
            for name, channel in series.channels.items()
            if channel.offset is not None
        },
        free_offsets={
            name: channel.offset.fit
            for name, channel in series.channels.items()
            if channel.offset is not None and channel.offset.fit is not None
        },
        inputs={
            name: (read.time, read.values[f"input {name}"] * channel.factor)
            for name, channel in series.inputs.items()
        },
        start={
            name: None if value is None else evaluate(value.formula, values) * value.factor
            for name, value in series.start.items()
        },
        preset=series.preset,
        file=str(series.file),
    )


def _check_size(series: Series, signals: Mapping[str, Vector]) -> None:
    problems = []
    for name, values in signals.items():
        largest = float(np.abs(values).max())
        if largest > LARGEST:
            what = f"'{name}' of the series '{series.name}' reaches {largest:.3g}, too large to fit"
            hint = f"Correct the column '{series.channels[name].column}', or its unit."
            problems.append(Problem(what, series.place, (), hint))
    if problems:
        raise DataError(problems)


def _window(series: Series, read: Columns) -> NDArray[np.intp]:
    low = -np.inf if series.begin is None else series.begin
    high = np.inf if series.end is None else series.end
    rows = np.flatnonzero((read.time >= low) & (read.time <= high))
    if len(rows) < 2:
        what = (
            f"the series '{series.name}' has {len(rows)} samples between {low:g} and {high:g} s; "
            f"the file covers {read.time[0]:g} to {read.time[-1]:g} s"
        )
        raise DataError([Problem(what, series.place, (), "Correct `from` and `to`.")])
    return rows
