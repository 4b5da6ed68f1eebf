"""`sweep`: numbers of runs over a grid of parameter values."""

from __future__ import annotations

import hashlib
import math
import sys
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracewire.analyse.partial import Partial, fingerprint
from tracewire.analyse.work import Tell, work_through
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, unknown
from tracewire.result import Result
from tracewire.solve import Halt, Run, simulate
from tracewire.solve.task import START, Options

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
MOST_POINTS = 1_000_000

MEASURES: dict[str, Callable[[Vector, Vector], float]] = {
    "end": lambda t, v: float(v[-1]),
    "max": lambda t, v: float(v.max()),
    "min": lambda t, v: float(v.min()),
    "range": lambda t, v: float(np.ptp(v)),
    "mean": lambda t, v: float(np.trapezoid(v, t) / (t[-1] - t[0])),
    "rms": lambda t, v: math.sqrt(np.trapezoid(v * v, t) / (t[-1] - t[0])),
}
"""What an output may be of a signal, over the samples from `since` on."""


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Result):
    """Outputs over a grid: `sweep["max(x)"]` has the shape of the grid, in the order of its axes.

    `grid` holds the values of each axis in SI, `values` the outputs by name, NaN where a run
    failed; `errors` says why, by the indices of the point.
    """

    title: str
    grid: Mapping[str, Vector]
    values: Mapping[str, NDArray[np.float64]]
    errors: Mapping[tuple[int, ...], str] = field(default_factory=dict)

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        if name not in self.values:
            raise OptionError([unknown("output", name, self.values)])
        return self.values[name]


def sweep(
    model: Model,
    grid: Mapping[str, ArrayLike],
    outputs: Sequence[str],
    *,
    since: float | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Tell | None = None,
    partial: str | Path | None = None,
    **options: Unpack[Options],
) -> Sweep:
    """Simulate a model at each point of a grid, and keep a few numbers of each run.

    `grid` maps parameters, and `start.NAME` of start values, to values in SI. `outputs` are
    end(s), max(s), min(s), range(s), mean(s), rms(s) of a signal s, over the samples from
    the time `since` in s on, and `events`, the number of them. `options` are those of `simulate`.
    Points are run in parallel, as in `simulate_many`; with `partial`, a .npz file, an interrupted
    sweep goes on where it was. Raises OptionError; the error of the first point where all of them
    fail.
    """
    unknown_options = [
        unknown("option", name, Options.__annotations__)
        for name in options
        if name not in Options.__annotations__
    ]
    if unknown_options:
        raise OptionError(unknown_options)
    axes = grid_of(model, grid)
    measures = [(name, *_measure(model, name)) for name in dict.fromkeys(outputs)]
    signals = dict.fromkeys(signal for _, _, signal in measures if signal)
    seen = replace(model, recorded=tuple(signals))
    if not measures:
        what = "a sweep without outputs keeps nothing"
        raise OptionError([Problem(what, hint="Name one, such as 'max(x)'.")])
    identity = {
        "diagram": fingerprint(model),
        "kind": "sweep",
        "grid": [[name, values.tolist()] for name, values in axes.items()],
        "outputs": [name for name, _, _ in measures],
        "options": [since, sorted((name, _identity(value)) for name, value in options.items())],
    }
    shape = tuple(len(values) for values in axes.values())
    store = Partial(partial, identity, math.prod(shape), len(measures))

    work_through(_Point(seen, axes, measures, since, options), store, workers, progress, executor)
    values = {name: store.rows[:, n].reshape(shape) for n, (name, _, _) in enumerate(measures)}
    errors = {
        tuple(int(i) for i in np.unravel_index(number, shape)): text
        for number, text in sorted(store.errors.items())
    }
    return Sweep(model.flat.title, axes, values, errors)


@dataclass(frozen=True)
class _Point:
    """The numbers of a point of a grid, by its number."""

    model: Model
    axes: Mapping[str, Vector]
    measures: Sequence[tuple[str, str, str]]
    since: float | None
    options: Options

    def __call__(self, number: int, halt: Halt) -> Vector:
        shape = tuple(len(values) for values in self.axes.values())
        place = np.unravel_index(number, shape)
        here = {n: float(v[i]) for (n, v), i in zip(self.axes.items(), place, strict=True)}
        own = {n: v for n, v in here.items() if n in self.model.flat.parameters}
        starts = {n.removeprefix(START): v for n, v in here.items() if n not in own}
        given = dict(self.options)
        given["parameters"] = {**(self.options.get("parameters") or {}), **own}
        given["start"] = {**(self.options.get("start") or {}), **starts}
        run = simulate(self.model, **given)  # type: ignore[arg-type]
        return np.array([_number(run, kind, s, self.since) for _, kind, s in self.measures])


def grid_of(model: Model, grid: Mapping[str, ArrayLike]) -> dict[str, Vector]:
    """The axes of a grid as arrays. Raises OptionError."""
    known = [*model.flat.parameters, *(START + name for name in model.states)]
    problems = [unknown("parameter or start", name, known) for name in grid if name not in known]
    axes = {name: np.array(values, dtype=float).ravel() for name, values in grid.items()}
    for name, values in axes.items():
        if not len(values) or not np.isfinite(values).all():
            what = f"the axis '{name}' has no values, or some that are not finite"
            problems.append(Problem(what, hint="Give an array such as numpy.linspace(0, 1, 11)."))
    if not axes:
        problems.append(Problem("there is no parameter to sweep", hint="Give one at least."))
    if math.prod(len(values) for values in axes.values()) > MOST_POINTS:
        count = math.prod(len(values) for values in axes.values())
        what = f"a grid of {count} points is too large"
        problems.append(Problem(what, hint=f"Give {MOST_POINTS} at most."))
    if problems:
        raise OptionError(problems)
    return axes


def _measure(model: Model, output: str) -> tuple[str, str]:
    """The kind of an output and its signal. Raises OptionError."""
    if output == "events":
        return "events", ""
    kind, _, rest = output.partition("(")
    signal = rest.removesuffix(")").strip()
    if kind.strip() not in MEASURES or not rest.endswith(")"):
        known = ["events", *(f"{name}(SIGNAL)" for name in MEASURES)]
        raise OptionError([unknown("output", output, known)])
    signals = {*model.states, *model.flat.signals, *model.flat.inputs}
    if signal not in signals:
        raise OptionError([unknown("signal", signal, signals)])
    return kind.strip(), signal


def _number(run: Run, kind: str, signal: str, since: float | None) -> float:
    if kind == "events":
        return float(len(run.events))
    chosen = run.t >= (-np.inf if since is None else since)
    if chosen.sum() < 2:
        what = f"there are fewer than two samples from {since} s on"
        raise OptionError([Problem(what, hint="Give an earlier `since`, or a longer span.")])
    return MEASURES[kind](run.t[chosen], run[signal][chosen])


def _identity(option: object) -> str:
    """What tells one value of an option from another: all numbers of an array, too."""
    with np.printoptions(threshold=sys.maxsize, floatmode="unique"):
        text = repr(option)
    return text if len(text) < 200 else hashlib.sha256(text.encode()).hexdigest()
