"""`simulate`: from a model and its arguments to a run."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, SimulationError, unknown
from tracewire.formula import evaluate, names_of, to_text
from tracewire.options import options_of
from tracewire.solve.core.arrays import Flow
from tracewire.solve.core.codes import SAMPLED
from tracewire.solve.core.methods import NAMES, STEPPED
from tracewire.solve.execute import Execution, Tell
from tracewire.solve.failures import place_of
from tracewire.solve.held import Held
from tracewire.solve.interrupt import Interrupted
from tracewire.solve.limits import Limits
from tracewire.solve.run import EventLog, Run
from tracewire.solve.sensitivities import (
    checked,
    moving_with,
    recorded,
    set_sensitivity,
)
from tracewire.solve.setup import (
    Table,
    Tolerance,
    packed,
    set_up,
    starts,
)
from tracewire.solve.space import give_back, space_for

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
DEFAULT_SAMPLES = 1001
MOST_SAMPLES = 10_000_000
KNOWN_PAST = 0.98  # of a delay: a step to a known time may be a little longer
MOST_KEPT = 100  # of the values that parameters have by themselves


def simulate(
    model: Model,
    *,
    parameters: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None,
    span: tuple[float, float] | None = None,
    times: ArrayLike | None = None,
    method: str = "auto",
    rtol: float = 1e-6,
    atol: float | Mapping[str, float] | None = None,
    step: float | None = None,
    preset: str = "",
    inputs: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
    limits: Limits | Mapping[str, float] | None = None,
    progress: Tell | None = None,
    sensitivities: Sequence[str] = (),
) -> Run:
    """Simulate a model: integrate x' = f(x, t) with frozen modes between located events.

    `parameters` and `start` override the diagram's values by name, in SI; `preset` is applied
    before them. `span` is (from, to) in s, `times` (N,) the ascending sample times in s; without
    them the diagram's span and its `every`, or 1001 samples. `method` is
    `dormand_prince` (explicit, order 5), `dop853` (explicit, order 8), `rosenbrock` (stiff, order
    5), `rk4` (fixed `step` in s, order 4), or `auto`: dormand_prince, dop853 where rtol is
    1e-8 or less, and rosenbrock where a mode combination turns out to be stiff. `atol` is given as
    a number or by state; else it is rtol/1000 of the largest value so far of each state, or of 1,
    whichever is less. `inputs` gives measured inputs as (times, values), joined
    by straight lines; `Held(times, values)` holds each value until the next. `limits` is a record
    or a dictionary such as `{"seconds": 60}`. `progress` is told
    about ten times a second the part of the span that is done, and the seconds that are left.
    `sensitivities` names parameters and start values (`start.theta`) whose forward sensitivities
    are wanted.

    Raises OptionError for arguments that do not fit, SimulationError for a run that cannot be
    finished: it names block, signal and time; of that kind Interrupted, where Ctrl-C stopped it:
    it carries the run up to there.
    """
    values = parameter_values(model, parameters or {}, preset)
    asked = checked(model, sensitivities)
    given = None if times is None else ascending(times)
    begin, end = span_of(model, values, span, given)
    samples = samples_of(model, values, begin, end, given)
    if method != "auto" and method not in NAMES:
        raise OptionError([unknown("method", method, ["auto", *NAMES])])
    within = options_of(Limits, limits, "limits of a run")
    longest = longest_step(model, values, within)
    tolerance = tolerance_of(model, rtol, atol, method, step, end - begin, longest)
    tables = packed(tables_of(model, values, inputs or {}))
    moving = moving_with(model, asked, values, parameters or {}, preset)
    space = space_for(model, values, tables, asked, moving, len(samples))
    arrays, flow, state = space.arrays, space.arrays.flow, space.arrays.progress
    x = start_of(model, flow, start or {})
    set_up(state, x, (begin, end), samples, method, tolerance)
    if asked:
        sensitivity = arrays.sensitivity
        set_sensitivity(model, flow, state, sensitivity, asked, moving, start or {}, values)
    execution = Execution(model, arrays, within, begin, progress, None, asked, space.table)
    try:
        execution.run()
    except Interrupted as error:
        error.run = run_of(execution, values, x, samples[: state.ints[SAMPLED]])
        raise
    refuse_nan(model, state.samples, samples)
    run = run_of(execution, values, x, samples)
    give_back(model, space)
    return run


def run_of(execution: Execution, values: Mapping[str, float], x: Vector, t: Vector) -> Run:
    """The run with these parameter values, start states (n,) and sample times, as far as it is."""
    model, state = execution.model, execution.progress
    names = model.states
    return Run(
        title=model.flat.title,
        t=t,
        signals=dict(zip(model.recorded, state.samples[: len(t)].T.copy(), strict=True)),
        units={name: model.flat.units.get(name, "") for name in model.recorded},
        events=EventLog(lambda: execution.events),
        parameters=values,
        start=dict(zip(names, x.tolist(), strict=True)),
        final=dict(zip(names, state.x.tolist(), strict=True)),
        statistics=execution.statistics,
        warnings=execution.warnings,
        shown=model.flat.shown,
        model=model,
        sensitivities=recorded(model, execution.arrays.sensitivity, execution.asked, len(t)),
    )


def tolerance_of(
    model: Model,
    rtol: float,
    atol: float | Mapping[str, float] | None,
    method: str,
    step: float | None,
    length: float,
    longest: float = math.inf,
) -> Tolerance:
    """The tolerances as the core takes them. Raises OptionError."""
    given = atol if isinstance(atol, Mapping) else {}
    problems = [unknown("state", name, model.states) for name in given if name not in model.states]
    if problems:
        raise OptionError(problems)
    usual = None if atol is None or isinstance(atol, Mapping) else atol
    wanted = [*given.values(), *([] if usual is None else [usual])]
    if not (1e-14 <= rtol < 1 and all(0 < value < math.inf for value in wanted)):
        shown = ", ".join(f"{name}: {value:g}" for name, value in given.items())
        told = f"{{{shown}}}" if given else f"{rtol * 1e-3 if usual is None else usual:g}"
        what = f"rtol = {rtol:g} and atol = {told} cannot be met"
        raise OptionError([Problem(what, hint="Take rtol between 1e-13 and 0.1 and atol above 0.")])
    if (method in STEPPED) != (step is not None):
        known = " or ".join(STEPPED)
        needs = f"the method {method} needs a step"
        what = needs if step is None else f"only the method {known} takes a step"
        raise OptionError([Problem(what, hint=f"Give method='{known}' and step= in s together.")])
    if step is not None and not 0 < step <= length:
        what = f"steps of {step:g} s do not fit into a span of {length:g} s"
        raise OptionError([Problem(what, hint="Give a step above 0 and below the span.")])
    absolute = [given.get(name, usual or 0.0) for name in model.states]
    fixed = math.inf if step is None else step
    return Tolerance(rtol, np.array(absolute, dtype=float), fixed, longest)


def longest_step(model: Model, values: Mapping[str, float], limits: Limits) -> float:
    """The longest step in s: that of the diagram or of the limits, and no longer than a delay, so
    that what is read is known. Raises OptionError.
    """
    given, longest = model.flat.max_step, limits.max_step
    if given is not None:
        longest = min(longest, float(evaluate(given, values)))
    for delay in model.lowered.delays:
        time = float(evaluate(delay.shortest, values))
        if not 0 < time < math.inf:
            what = f"'{delay.text}' is delayed by {time:g} s"
            raise OptionError([Problem(what, hint="Give a delay above 0.")])
        longest = min(longest, KNOWN_PAST * time)
    if not longest > 0:
        what = f"steps of {longest:g} s at most lead nowhere"
        raise OptionError([Problem(what, hint="Give a max_step above 0.")])
    return longest


def parameter_values(
    model: Model, given: Mapping[str, float], preset: str = ""
) -> dict[str, float]:
    """The value of every parameter in SI: the diagram's, changed by a preset and by `given`.

    A parameter that is a formula of others follows them. Raises OptionError for names that do not
    exist and values that are not finite, SimulationError for values that do not meet what the
    diagram requires.
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
    values = {name: float(value) for name, value in given.items()}
    key = "values", preset, tuple(values)
    known = model.kept.get(key)
    if known is None:  # what follows from nothing that is given is the same every time
        following = []
        for name, formula in model.parameter_formulas(preset).items():
            if name in values:
                continue
            values[name] = evaluate(formula, values, flat.parameters[name].place)
            if any(read in given or read in following for read in names_of(formula)):
                following.append(name)
        changing = {*given, *following}
        same = {name: value for name, value in values.items() if name not in changing}
        if len(model.kept) < MOST_KEPT:
            model.kept[key] = same, following
    else:
        same, following = known
        values |= same
        formulas = model.parameter_formulas(preset)
        for name in following:
            values[name] = evaluate(formulas[name], values, flat.parameters[name].place)
    refuse_unmet(model, values)
    return {name: values[name] for name in flat.parameters}


def refuse_unmet(model: Model, values: Mapping[str, float]) -> None:
    """Raises SimulationError: the values of the parameters do not meet a condition of `require`."""
    problems = []
    for known in model.flat.require:
        if not evaluate(known.formula, values, known.place):
            read = [name for name in names_of(known.formula) if name in values]
            shown = ", ".join(f"{name} = {values[name]:.6g}" for name in read)
            what = f"the parameters do not meet '{to_text(known.formula)}': {shown}"
            problems.append(Problem(what, known.place, (), known.hint))
    if problems:
        raise SimulationError(problems)


def ascending(times: ArrayLike) -> Vector:
    """Sample times (N,) as they are used. Raises OptionError where they do not ascend."""
    samples = np.array(times, dtype=float).ravel()
    increasing = bool((samples[1:] > samples[:-1]).all())  # not so where one is NaN
    if not len(samples) or not (increasing and -math.inf < samples[0] and samples[-1] < math.inf):
        what = "the sample times do not ascend"
        raise OptionError([Problem(what, hint="Sort them, without repetition or NaN.")])
    return samples


def span_of(
    model: Model,
    values: Mapping[str, float],
    span: tuple[float, float] | None,
    times: Vector | None,
) -> tuple[float, float]:
    """Begin and end in s: the span that is given, or the diagram's. Raises OptionError."""
    begin, end = span or (evaluate(formula, values) for formula in model.flat.span)
    if span is None and times is not None:
        begin, end = min(begin, times[0]), times[-1]
    begin, end = float(begin), float(end)
    if not (math.isfinite(begin) and math.isfinite(end) and begin < end):
        what = f"the span from {begin:g} to {end:g} s is empty"
        raise OptionError([Problem(what, hint="Give a begin before the end.")])
    return begin, end


def samples_of(
    model: Model, values: Mapping[str, float], begin: float, end: float, times: Vector | None
) -> Vector:
    """The sample times (N,) within a span. Raises OptionError where there is no use in them."""
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


def sample_times(model: Model, values: Mapping[str, float], span: tuple[float, float]) -> Vector:
    """The sample times (N,) in s that a run over a span has by itself. Raises OptionError."""
    begin, end = span_of(model, values, span, None)
    return samples_of(model, values, begin, end, None)


def tables_of(
    model: Model,
    values: Mapping[str, float],
    inputs: Mapping[str, tuple[ArrayLike, ArrayLike]],
) -> list[Table]:
    """The tables of the model: the diagram's and the inputs. Raises OptionError."""
    flat = model.flat
    problems = [unknown("input", name, flat.inputs) for name in inputs if name not in flat.inputs]
    tables = []
    times: dict[int, Vector] = {}  # many inputs have the same: they are looked at once
    for name in model.lowered.tables:
        if name in flat.tables:
            key = "table", name
            if key not in model.kept:
                model.kept[key] = _table(name, flat.tables[name].x, flat.tables[name].y, {})
            tables.append(model.kept[key])
        elif name in inputs:
            table = _table(name, *inputs[name], times)
            tables.append(Held(*table) if isinstance(inputs[name], Held) else table)
        else:
            default = flat.inputs[name]
            if default is None:
                hint = (
                    "Name a measured series that has it (`--series` of `run` and `sweep`), "
                    f"write a default, inputs: {{{name}: {{default: 0}}}}, "
                    "or in Python give it as `inputs=`."
                )
                problems.append(Problem(f"the input '{name}' has no source", hint=hint))
            else:
                tables.append(_table(name, [0.0], [evaluate(default, values)], {}))
    if problems:
        raise OptionError(problems)
    return tables


def _table(name: str, x: ArrayLike, y: ArrayLike, known: dict[int, Vector]) -> Table:
    """A table whose x ascend and whose y are finite; `known` has the x that do, by identity."""
    xs, ys = known.get(id(x)), np.asarray(y, dtype=float).ravel()
    if xs is None:
        xs = np.asarray(x, dtype=float).ravel()
        if len(xs) and np.isfinite(xs).all() and (xs[1:] > xs[:-1]).all():
            known[id(x)] = xs
    if not (id(x) in known and len(xs) == len(ys) and np.isfinite(ys).all()):
        hint = "Give as many values as times, times that ascend, and no NaN."
        raise OptionError([Problem(f"the table of the input '{name}' is not usable", hint=hint)])
    return xs, ys


def start_of(model: Model, flow: Flow, given: Mapping[str, float]) -> Vector:
    """The start states (n,): the diagram's, changed by `given`. Raises OptionError."""
    names = model.states
    problems = [unknown("state", name, names) for name in given if name not in names]
    values = starts(model, flow).tolist()
    for n, name in enumerate(names):
        values[n] = float(given.get(name, values[n]))
        if not math.isfinite(values[n]):
            problems.append(Problem(f"the start of '{name}' is {values[n]}"))
    if problems:
        raise OptionError(problems)
    return np.array(values, dtype=float)


def refuse_nan(model: Model, samples: Matrix, t: Vector) -> None:
    """A recorded signal may be undefined where no state depends on it."""
    if np.isfinite(samples).all():
        return
    for n, name in enumerate(model.recorded):
        bad = np.flatnonzero(~np.isfinite(samples[:, n]))
        if len(bad):
            when, value = t[bad[0]], samples[bad[0], n]
            what = f"the recorded signal '{name}' is not finite ({value}) at t = {when:.9g} s"
            hint = "Look for a division by zero or the root of a negative number in it."
            raise SimulationError([Problem(what, place_of(model, name), (), hint)])
