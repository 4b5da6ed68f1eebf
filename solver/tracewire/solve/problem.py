"""`InitialValueProblem`: what a run solves, with every argument checked."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypedDict, Unpack

import numpy as np

from tracewire.arguments import checked
from tracewire.array_types import Vector
from tracewire.compile import OF_THE_PAST, Model
from tracewire.errors import OptionError, Problem, unknown
from tracewire.options import options_of
from tracewire.solve.core.methods import NAMES
from tracewire.solve.history import Past, past_of
from tracewire.solve.limits import Limits
from tracewire.solve.options import Options, refuse_unknown_options, with_row
from tracewire.solve.parameters import parameter_values
from tracewire.solve.sampling import check_times, samples_of, span_of, timing_follows
from tracewire.solve.sensitivities import Moving, check_sensitivities, moving_with
from tracewire.solve.tables import pack_tables, tables_follow, tables_of
from tracewire.solve.tolerance import Tolerance, longest_step, refuse_short_steps, tolerance_of


@dataclass(frozen=True, eq=False)
class InitialValueProblem:
    """x' = f(x, t, p) with x at the begin of a span: the arguments of a run, checked and in SI.

    `parameters` has the value of each parameter, `start` (n,) the states at the begin of `span`,
    which is from and to in s; at `times` (N,) in s the run is sampled, unless it is not `sampled`
    at all, as where an analysis looks at its states only. `sensitivities` are the
    names of parameters and start values by which the signals are differentiated, and `moving` the
    parameters that move with them. `constants` is what the model computes from its parameters
    alone, `tables` its tables and inputs, packed, `past` what is told of delayed signals before the
    start. `given` are the options that it was made of.
    """

    model: Model
    given: Options
    parameters: Mapping[str, float]
    span: tuple[float, float]
    times: Vector
    method: str
    limits: Limits
    tolerance: Tolerance
    sensitivities: tuple[str, ...]
    moving: Moving
    constants: Vector
    tables: Vector
    start: Vector
    past: Past
    sampled: bool = True

    def with_values(
        self, row: Mapping[str, float], span: tuple[float, float] | None = None
    ) -> InitialValueProblem:
        """The problem with the values of a row, `start.NAME` of a state, over those that it has.

        What is the same for all values is not checked again. Raises OptionError, SimulationError.
        """
        given = with_row(self.model, self.given, row)
        if span is not None:
            given["span"] = span
        return self._with(given, span is None)

    def with_parameters(self, parameters: Mapping[str, float]) -> InitialValueProblem:
        """The problem with others in the place of the parameters that were given. Raises as
        `with_values` does."""
        given = Options(**self.given)
        given["parameters"] = parameters
        return self._with(given, True)

    def _with(self, given: Options, same_span: bool) -> InitialValueProblem:
        """The problem with the parameters and start values of these options, and their span."""
        model = self.model
        same_tables = not tables_follow(model, given.get("inputs") or {})
        tables = self.tables if same_tables else None
        if not same_span or timing_follows(model):
            return pose(model, given, self.sensitivities, self.sampled, tables)
        values = parameter_values(model, given.get("parameters") or {}, given.get("preset", ""))
        numbers = _numbers(model, given, values, self.sensitivities, self.past, tables)
        return replace(self, given=given, parameters=values, **numbers)


class _Numbers(TypedDict):
    """What follows from the values of the parameters."""

    moving: Moving
    constants: Vector
    tables: Vector
    start: Vector


def _numbers(
    model: Model,
    given: Options,
    values: Mapping[str, float],
    asked: tuple[str, ...],
    past: Past,
    tables: Vector | None,
) -> _Numbers:
    """What follows from the values of the parameters; `tables` where they are known."""
    if tables is None:
        tables = pack_tables(tables_of(model, values, given.get("inputs") or {}))
    parameters, preset = given.get("parameters") or {}, given.get("preset", "")
    constants = model.routines.constants_from(list(values.values()))
    if model.lowered.delays:
        first = len(model.parameters)
        constants[first : first + OF_THE_PAST] = 0.0, past.address, past.begin
    return _Numbers(
        moving=moving_with(model, asked, values, parameters, preset),
        constants=constants,
        tables=tables,
        start=start_of(model, constants, tables, given.get("start") or {}),
    )


@checked
def initial_value_problem(
    model: Model,
    sensitivities: Sequence[str] = (),
    sampled: bool = True,
    **given: Unpack[Options],
) -> InitialValueProblem:
    """The problem that a model and the options of `simulate` pose.

    Raises OptionError for options that do not fit; SimulationError for values that do not meet what
    the diagram requires.
    """
    refuse_unknown_options(given)
    return pose(model, given, sensitivities, sampled)


def pose(
    model: Model,
    given: Options,
    sensitivities: Sequence[str],
    sampled: bool = True,
    tables: Vector | None = None,
) -> InitialValueProblem:
    """As `initial_value_problem`, of options whose names and kinds are known to be right; `tables`
    are the packed ones, where they are known."""
    values = parameter_values(model, given.get("parameters") or {}, given.get("preset", ""))
    asked = check_sensitivities(model, sensitivities)
    times = given.get("times")
    known = None if times is None else check_times(times)
    begin, end = span_of(model, values, given.get("span"), known)
    every = given.get("every")
    samples = samples_of(model, values, begin, end, known, every) if sampled else np.empty(0)
    method = given.get("method", "auto")
    if method != "auto" and method not in NAMES:
        raise OptionError([unknown("method", method, ["auto", *NAMES])])
    limits = options_of(Limits, given.get("limits"), "limits of a run")
    limits.refuse()
    longest = longest_step(model, values, limits)
    rtol, atol, step = given.get("rtol", 1e-6), given.get("atol"), given.get("step")
    tolerance = tolerance_of(model, rtol, atol, method, step, end - begin, longest)
    shortest = min(longest, step or math.inf)
    refuse_short_steps(model, values, end - begin, shortest, limits.steps)
    past = past_of(model, given.get("past") or {})
    return InitialValueProblem(
        model=model,
        given=given,
        parameters=values,
        span=(begin, end),
        times=samples,
        method=method,
        limits=limits,
        tolerance=tolerance,
        sensitivities=asked,
        past=past,
        sampled=sampled,
        **_numbers(model, given, values, asked, past, tables),
    )


def start_of(model: Model, constants: Vector, tables: Vector, given: Mapping[str, float]) -> Vector:
    """The start states (n,): the diagram's, changed by `given`. Raises OptionError."""
    names = model.states
    problems = [unknown("state", name, names) for name in given if name not in names]
    x = model.routines.starts(constants, tables)
    for n, name in enumerate(names if given else ()):
        if name in given:
            x[n] = given[name]
    bad = [] if np.isfinite(x).all() else np.flatnonzero(~np.isfinite(x)).tolist()
    problems += [
        Problem(
            f"the start of '{names[n]}' is {x[n]}",
            model.flat.states[n].place,
            hint="A start is a finite number: look for a division by zero, or for a root.",
        )
        for n in bad
    ]
    if problems:
        raise OptionError(problems)
    return x
