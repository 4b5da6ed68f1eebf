"""`sweep`: numbers of runs over a grid of parameter values."""

from __future__ import annotations

import hashlib
import math
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracewire.analyse.grid import grid_of
from tracewire.analyse.partial import Partial, fingerprint
from tracewire.analyse.quantities import Conditions, Recorder, Subject, ask, is_of_run, measure
from tracewire.analyse.work import IncompleteRow, work_through
from tracewire.arguments import checked
from tracewire.array_types import Vector
from tracewire.compile import Model, unit_of_quantity
from tracewire.diagram import quantity_problems, row_ends
from tracewire.errors import OptionError, Problem, TracewireError, unknown
from tracewire.formula import Expression, parse_quantity
from tracewire.result import Result
from tracewire.solve import (
    Interrupted,
    Options,
    ProgressCallback,
    StopFlag,
    refuse_unknown_options,
    with_row,
)


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Result):
    """Outputs over a grid: `sweep["max(x)"]` has the shape of the grid, in the order of its axes.

    `grid` holds the values of each axis in SI, `values` the outputs by name, NaN where a run failed
    or has no such number; `errors` says why, by the indices of the point. `units` are the SI units
    of the axes, `users_units` those in which the user has the outputs, with their factors to SI.
    """

    title: str
    grid: Mapping[str, Vector]
    values: Mapping[str, NDArray[np.float64]]
    errors: Mapping[tuple[int, ...], str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    users_units: Mapping[str, tuple[str, float]] = field(default_factory=dict)

    def as_shown(self, name: str) -> NDArray[np.float64]:
        """An output in the unit in which tables and figures show it."""
        return self[name] / self.users_units.get(name, ("", 1.0))[1]

    def unit(self, name: str) -> str:
        """That unit; '' where it is not known."""
        return self.users_units.get(name, ("", 1.0))[0]

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        if not isinstance(name, str):
            what = f"sweep[{name!r}]: a sweep is read by the name of an output"
            first = next(iter(self.values), "max(x)")
            hint = f'Write sweep["{first}"][{name!r}] for that point of the grid.'
            raise OptionError.one(what, exists=tuple(self.values), hint=hint)
        if name not in self.values:
            raise OptionError([unknown("output", name, self.values)])
        return self.values[name]


@checked
def sweep(
    model: Model,
    grid: Mapping[str, ArrayLike],
    outputs: Sequence[str],
    *,
    since: float | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: ProgressCallback | None = None,
    partial: str | Path | None = None,
    **options: Unpack[Options],
) -> Sweep:
    """Simulate a model at each point of a grid, and keep a few numbers of each run.

    `grid` maps parameters, and `start.NAME` of start values, to values in SI. `outputs` are
    quantities of a run, such as max(abs(x)), end(e)/at(e, 0) or count(impact), over the samples
    from the time `since` in s on. `options` are those of `simulate`.
    Points are run in parallel, as in `simulate_many`; with `partial`, a .npz file, an interrupted
    sweep goes on where it was. Raises OptionError; the error of the first point where all of them
    fail.
    """
    refuse_unknown_options(options)
    axes = grid_of(model, grid)
    measures = {name: _quantity(model, name) for name in dict.fromkeys(outputs)}
    if not measures:
        what = "a sweep without outputs keeps nothing"
        raise OptionError([Problem(what, hint="Name one, such as 'max(x)'.")])
    identity = {
        "diagram": fingerprint(model),
        "kind": "sweep",
        "grid": [[name, values.tolist()] for name, values in axes.items()],
        "outputs": list(measures),
        "options": [since, sorted((name, _identity(value)) for name, value in options.items())],
    }
    shape = tuple(len(values) for values in axes.values())
    store = Partial(partial, identity, math.prod(shape), len(measures))

    recorder = Recorder(replace(model, recorded=()))
    ask(list(measures.values()), Subject(recorder, Conditions(options, since)))
    point = _Point(recorder.model, axes, tuple(measures.values()), since, options)
    work_through(point, store, workers, progress, executor)
    values = {name: store.rows[:, n].reshape(shape) for n, name in enumerate(measures)}
    errors = {
        tuple(int(i) for i in np.unravel_index(number, shape)): text
        for number, text in sorted(store.errors.items())
    }
    units = {name: _unit(model, name) for name in axes}
    users = {name: unit_of_quantity(model, quantity) for name, quantity in measures.items()}
    return Sweep(model.flat.title, axes, values, errors, units, users)


def _unit(model: Model, axis: str) -> str:
    """The SI unit of a parameter, or of a start value `start.NAME`."""
    if axis in model.flat.parameters:
        return model.flat.parameters[axis].unit
    return model.flat.units.get(axis.removeprefix("start."), "")


@dataclass(frozen=True)
class _Point:
    """The numbers of a point of a grid, by its number."""

    model: Model
    axes: Mapping[str, Vector]
    measures: tuple[Expression, ...]
    since: float | None
    options: Options

    def __call__(self, number: int, stop_flag: StopFlag) -> Vector | IncompleteRow:
        shape = tuple(len(values) for values in self.axes.values())
        place = np.unravel_index(number, shape)
        here = {n: float(v[i]) for (n, v), i in zip(self.axes.items(), place, strict=True)}
        given = with_row(self.model, self.options, here)
        subject = Subject(Recorder(self.model), Conditions(given, self.since))
        ask(self.measures, subject)
        row, missing = np.full(len(self.measures), np.nan), list[TracewireError]()
        for n, quantity in enumerate(self.measures):
            try:
                row[n] = measure(quantity, subject)
            except Interrupted:
                raise
            except TracewireError as error:
                missing.append(error)
        if missing and len(missing) == len(row):
            raise missing[0]
        return IncompleteRow(row, str(missing[0])) if missing else row


def _quantity(model: Model, output: str) -> Expression:
    """An output as the quantity that it writes. Raises OptionError, FormulaError."""
    quantity = parse_quantity(row_ends(model.diagram, output))
    if wrong := quantity_problems(quantity, model.diagram):
        raise OptionError(wrong)
    if not is_of_run(quantity):
        what = f"'{output}' is no number of a run, and a sweep has runs only"
        hint = "Take end(x), max(x), count(impact) and so on; `tracewire analyse` has the others."
        raise OptionError([Problem(what, hint=hint)])
    return quantity


def _identity(option: object) -> str:
    """What tells one value of an option from another: all numbers of an array, too."""
    with np.printoptions(threshold=sys.maxsize, floatmode="unique"):
        text = repr(option)
    return text if len(text) < 200 else hashlib.sha256(text.encode()).hexdigest()
