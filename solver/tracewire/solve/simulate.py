"""`simulate`: from a model and its arguments to a run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, SimulationError, unknown
from tracewire.formula import evaluate, names_of
from tracewire.solve.flow import Flow
from tracewire.solve.integrate import METHODS, Integration
from tracewire.solve.limits import Limits, place_of
from tracewire.solve.record import Recorder
from tracewire.solve.run import Run, Statistics

Vector = NDArray[np.float64]
DEFAULT_SAMPLES = 1001
MOST_SAMPLES = 10_000_000


def simulate(
    model: Model,
    *,
    parameters: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None,
    span: tuple[float, float] | None = None,
    times: ArrayLike | None = None,
    method: str = "auto",
    rtol: float = 1e-6,
    atol: float | None = None,
    preset: str = "",
    inputs: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
    limits: Limits | None = None,
) -> Run:
    """Simulate a model: integrate x' = f(x, t) with frozen modes between located events.

    `parameters` and `start` override the diagram's values by name, in SI; `preset` is applied
    before them. `span` is (from, to) in s, `times` (N,) the ascending sample times in s; without
    them the diagram's span and its `every`, or 1001 samples. `method` is `auto`,
    `dormand_prince` or `rosenbrock`. `atol` is rtol/1000 unless given. `inputs` gives measured
    inputs as (times, values), joined by straight lines.

    Raises OptionError for arguments that do not fit, SimulationError for a run that cannot be
    finished: it names block, signal and time.
    """
    values = parameter_values(model, parameters or {}, preset)
    given = None if times is None else _ascending(times)
    begin, end = _span(model, values, span, given)
    samples = _samples(model, values, begin, end, given)
    if method != "auto" and method not in METHODS:
        raise OptionError([unknown("method", method, ["auto", *METHODS])])
    absolute = rtol * 1e-3 if atol is None else atol
    if not (1e-14 <= rtol < 1 and 0 < absolute < math.inf):
        what = f"rtol = {rtol:g} and atol = {absolute:g} cannot be met"
        raise OptionError([Problem(what, hint="Take rtol between 1e-13 and 0.1 and atol above 0.")])
    vector = np.array([values[name] for name in model.parameters])
    flow = Flow(model, vector, _tables(model, values, inputs or {}))
    states = _start(model, flow, start or {})
    recorder = Recorder(flow, samples)
    integration = Integration(
        flow, (begin, end), recorder, method, (rtol, absolute), limits or Limits()
    )
    final = integration.run(states.copy())
    guardian = integration.guardian
    signals = {name: recorder.signals[:, n].copy() for n, name in enumerate(model.recorded)}
    _refuse_nan(model, signals, samples)
    names = model.states
    return Run(
        title=model.flat.title,
        t=samples,
        signals=signals,
        units={name: model.flat.units.get(name, "") for name in model.recorded},
        events=tuple(sorted(recorder.events, key=lambda event: event.time)),
        parameters=values,
        start=dict(zip(names, states.tolist(), strict=True)),
        final=dict(zip(names, final.tolist(), strict=True)),
        statistics=Statistics(
            steps=guardian.steps - guardian.rejected,
            rejected=guardian.rejected,
            evaluations=flow.evaluations,
            stiff_steps=guardian.stiff_steps,
            seconds=guardian.seconds,
        ),
        warnings=tuple(integration.warnings),
    )


def parameter_values(
    model: Model, given: Mapping[str, float], preset: str = ""
) -> dict[str, float]:
    """The value of every parameter in SI: the diagram's, changed by a preset and by `given`.

    A parameter that is a formula of others follows them. Raises OptionError for names that do not
    exist and values that are not finite.
    """
    flat = model.flat
    if preset and preset not in flat.presets:
        raise OptionError([unknown("preset", preset, flat.presets)])
    problems = [unknown("parameter", n, flat.parameters) for n in given if n not in flat.parameters]
    problems += [
        Problem(f"the parameter '{name}' is given as {value}, which is not a finite number")
        for name, value in given.items()
        if not math.isfinite(value)
    ]
    if problems:
        raise OptionError(problems)
    formulas = {name: parameter.formula for name, parameter in flat.parameters.items()}
    if preset:
        formulas |= flat.presets[preset]
    values = {name: float(value) for name, value in given.items()}
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from(formulas)
    for name, formula in formulas.items():
        graph.add_edges_from((read, name) for read in names_of(formula) if read in formulas)
    for name in nx.topological_sort(graph):
        if name not in values:
            values[name] = evaluate(formulas[name], values, flat.parameters[name].place)
    return {name: values[name] for name in flat.parameters}


def _ascending(times: ArrayLike) -> Vector:
    samples = np.array(times, dtype=float).ravel()
    increasing = bool(np.all(np.diff(samples) > 0)) and bool(np.isfinite(samples).all())
    if not len(samples) or not increasing:
        what = "the sample times do not ascend"
        raise OptionError([Problem(what, hint="Sort them, without repetition or NaN.")])
    return samples


def _span(
    model: Model,
    values: Mapping[str, float],
    span: tuple[float, float] | None,
    times: Vector | None,
) -> tuple[float, float]:
    begin, end = span or (evaluate(formula, values) for formula in model.flat.span)
    if span is None and times is not None:
        begin, end = min(begin, times[0]), times[-1]
    begin, end = float(begin), float(end)
    if not (math.isfinite(begin) and math.isfinite(end) and begin < end):
        what = f"the span from {begin:g} to {end:g} s is empty"
        raise OptionError([Problem(what, hint="Give a begin before the end.")])
    return begin, end


def _samples(
    model: Model, values: Mapping[str, float], begin: float, end: float, times: Vector | None
) -> Vector:
    if times is not None:
        if times[0] < begin or times[-1] > end:
            what = (
                f"the sample times from {times[0]:g} to {times[-1]:g} s are not within the span "
                f"from {begin:g} to {end:g} s"
            )
            raise OptionError([Problem(what, hint="Give a longer span, or other times.")])
        return times
    if model.flat.every is None:
        return np.linspace(begin, end, DEFAULT_SAMPLES)
    every = evaluate(model.flat.every, values)
    if not every > 0 or (end - begin) / every > MOST_SAMPLES:
        what = f"an output every {every:g} s from {begin:g} to {end:g} s cannot be kept"
        raise OptionError([Problem(what, hint="Give a larger `every`.")])
    if every > (end - begin) * (1 + 1e-12):  # a run of one sample would say nothing of its end
        what = f"an output every {every:g} s has one sample only from {begin:g} to {end:g} s"
        raise OptionError([Problem(what, hint="Give a smaller `every`, or a longer span.")])
    count = math.floor((end - begin) / every * (1 + 1e-12))
    return np.asarray(np.minimum(begin + every * np.arange(count + 1), end))


def _tables(
    model: Model,
    values: Mapping[str, float],
    inputs: Mapping[str, tuple[ArrayLike, ArrayLike]],
) -> list[Any]:
    flat = model.flat
    problems = [unknown("input", name, flat.inputs) for name in inputs if name not in flat.inputs]
    tables = []
    for name in model.lowered.tables:
        if name in flat.tables:
            tables.append(_table(name, flat.tables[name].x, flat.tables[name].y))
        elif name in inputs:
            tables.append(_table(name, *inputs[name]))
        else:
            default = flat.inputs[name]
            if default is None:
                hint = (
                    "Give it as `inputs=`, run a measured series that has it (`--series`), "
                    f"or write a default: inputs: {{{name}: {{default: 0}}}}."
                )
                problems.append(Problem(f"the input '{name}' has no source", hint=hint))
            else:
                tables.append(_table(name, [0.0], [evaluate(default, values)]))
    if problems:
        raise OptionError(problems)
    return tables


def _table(name: str, x: ArrayLike, y: ArrayLike) -> tuple[list[float], list[float], list[float]]:
    xs, ys = np.asarray(x, dtype=float).ravel(), np.asarray(y, dtype=float).ravel()
    good = len(xs) == len(ys) and len(xs) > 0 and bool(np.all(np.diff(xs) > 0))
    if not (good and np.isfinite(xs).all() and np.isfinite(ys).all()):
        hint = "Give as many values as times, times that ascend, and no NaN."
        raise OptionError([Problem(f"the table of the input '{name}' is not usable", hint=hint)])
    slopes = np.diff(ys) / np.diff(xs)
    return xs.tolist(), ys.tolist(), slopes.tolist()


def _start(model: Model, flow: Flow, given: Mapping[str, float]) -> Vector:
    names = model.states
    problems = [unknown("state", name, names) for name in given if name not in names]
    values = list(flow.call("starts", 0.0, np.zeros(len(names))))
    for n, name in enumerate(names):
        values[n] = float(given.get(name, values[n]))
        if not math.isfinite(values[n]):
            problems.append(Problem(f"the start of '{name}' is {values[n]}"))
    if problems:
        raise OptionError(problems)
    return np.array(values)


def _refuse_nan(model: Model, signals: Mapping[str, Vector], t: Vector) -> None:
    """A recorded signal may be undefined where no state depends on it."""
    for name, values in signals.items():
        bad = np.flatnonzero(~np.isfinite(values))
        if len(bad):
            when, value = t[bad[0]], values[bad[0]]
            what = f"the recorded signal '{name}' is not finite ({value}) at t = {when:.9g} s"
            hint = "Look for a division by zero or the root of a negative number in it."
            raise SimulationError([Problem(what, place_of(model, name), (), hint)])
