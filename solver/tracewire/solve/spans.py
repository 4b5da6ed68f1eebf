"""`simulate_spans`: one model with one set of parameters, over many spans from starts of their own.

What the windows of a measured series need: many short runs, which differ in where they begin. They
are prepared once, and the core goes from one to the next on its own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, SimulationError, unknown
from tracewire.solve.core.arrays import Arrays, Spans
from tracewire.solve.core.codes import BUDGET, FINISHED, HISTORY_FULL, LOG_FULL, PAUSED
from tracewire.solve.core.spans import INSIDE, LEFT, SPAN
from tracewire.solve.core_library import library
from tracewire.solve.failures import failure
from tracewire.solve.history import refuse_delays
from tracewire.solve.integrator import Integrator, refuse_nan
from tracewire.solve.interrupt import Halt, Interrupted
from tracewire.solve.limits import PAUSE, Limits, beyond_budget
from tracewire.solve.options import START
from tracewire.solve.problem import InitialValueProblem, initial_value_problem
from tracewire.solve.run import Sensitivities
from tracewire.solve.sensitivities import recorded
from tracewire.solve.workspace import least_peak

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Span:
    """A run from `begin` to `end` in s, sampled at `times` (N,) within; `start` overrides start
    values of the diagram. With `follows`, states that are not in `start` begin where the span
    before has ended, as do their derivatives by parameters."""

    begin: float
    end: float
    times: Vector
    start: Mapping[str, float]
    follows: bool = False


@dataclass(frozen=True, eq=False)
class SpanRuns:
    """Runs over spans: `runs["name"]` (M,) in SI, the samples of one span behind those of the one
    before; those of span n are `rows[n]` to `rows[n + 1]`.

    `sensitivities` as those of a run; `final` (spans, states) and their derivatives `final_slopes`
    (spans, states, sensitivities), `steps` (spans,) accepted steps, and by number `errors` of spans
    whose run failed, whose samples mean nothing, and `warnings`.
    """

    signals: Mapping[str, Vector]
    sensitivities: Sensitivities
    rows: NDArray[np.int64]
    final: Matrix
    final_slopes: Matrix
    steps: NDArray[np.int64]
    errors: Mapping[int, SimulationError]
    warnings: Mapping[int, tuple[str, ...]]

    def __getitem__(self, name: str) -> Vector:
        return self.signals[name]


def simulate_spans(
    model: Model,
    spans: Sequence[Span],
    *,
    parameters: Mapping[str, float] | None = None,
    rtol: float = 1e-6,
    atol: Mapping[str, float] | None = None,
    preset: str = "",
    inputs: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
    past: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
    limits: Limits | None = None,
    budget: float = np.inf,
    sensitivities: Sequence[str] = (),
    halt: Halt | None = None,
) -> SpanRuns:
    """Simulate a model over many spans: each run is what `simulate` makes of it, alone.

    Only that what is found stiff in one span is taken for stiff at once in those behind it.

    Arguments are those of `simulate`; `limits` hold for each run, `budget` for the steps of all: a
    run that begins beyond it fails. `halt` says whether the user wants to stop. A run that fails
    does not end the others. Raises OptionError for arguments that do not fit, and Interrupted.
    """
    if any(span.follows for span in spans) and not past:
        refuse_delays(model, "a span that follows another")
    always = set(spans[0].start).intersection(*(span.start for span in spans))
    problem = initial_value_problem(
        model,
        sensitivities,
        sampled=False,
        span=(0.0, 1.0),
        start={name: spans[0].start[name] for name in always},
        parameters=parameters,
        rtol=rtol,
        atol=atol,
        preset=preset,
        inputs=inputs,
        past=past,
        limits=limits,
    )
    integrator = Integrator(problem, halt=halt or Halt())
    space = integrator.workspace
    integrator.progress.ints[BUDGET] = min(problem.limits.steps, PAUSE.steps)
    space.keep()
    many = space.for_spans(len(spans), sum(len(span.times) for span in spans))
    _set_to(many, problem, space.arrays, spans)
    own_places = space.table.copy()
    errors, warnings = _executed(integrator, many, budget, halt or Halt())
    space.table[:] = own_places  # the core has set those of samples to what is in `many`
    errors |= _undefined(model, many, errors)
    slopes = many.final_s.reshape(*many.final.shape, many.floor.shape[1])
    runs = SpanRuns(
        signals=dict(zip(model.recorded, many.samples.T.copy(), strict=True)),
        sensitivities=recorded(model, many.answers, problem.sensitivities),
        rows=many.rows.copy(),
        final=many.final.copy(),
        final_slopes=slopes.copy(),
        steps=many.steps.copy(),
        errors=errors,
        warnings=warnings,
    )
    integrator.give_back()
    return runs


def _set_to(many: Spans, problem: InitialValueProblem, base: Arrays, spans: Sequence[Span]) -> None:
    """Let the arrays for spans be those of these: what a run of each begins with, and that nothing
    has come of it yet. Raises OptionError for starts that do not fit."""
    states, asked = problem.model.states, problem.sensitivities
    count, (n, q) = len(spans), many.floor.shape
    given = np.zeros((count, n), dtype=bool)
    many.x[:] = problem.start
    for number, span in enumerate(spans):
        for name, value in span.start.items():
            if name not in states:
                raise OptionError([unknown("state", name, states)])
            state = states.index(name)
            many.x[number, state] = value
            given[number, state] = True
    if not np.isfinite(many.x).all():
        number, state = np.argwhere(~np.isfinite(many.x))[0].tolist()
        what = f"the start of '{states[state]}' is {many.x[number, state]}"
        raise OptionError([Problem(what)])
    many.at[:] = 0, 0, 0, problem.limits.events, 0
    many.ends[:] = [(span.begin, span.end) for span in spans]
    many.rows[:] = [*accumulate((len(span.times) for span in spans), initial=0)]
    np.concatenate([span.times for span in spans], out=many.times)
    many.follows[:] = [n > 0 and span.follows for n, span in enumerate(spans)]
    follows = many.follows.astype(bool)
    if any(span.follows for span in spans[1:]):
        many.kept[:] = ~given[follows].any(axis=0)  # states that go on from span to span
        given |= follows[:, None] & many.kept.astype(bool)
    if q:
        is_start = np.array([name.startswith(START) for name in asked])
        many.lasting[:] = ~is_start
        set_here = given[:, :, None] & ~is_start  # what is set follows no parameter
        many.s[:] = np.where(set_here, 0.0, base.sensitivity.s).reshape(count, n * q)
        many.floor[:] = least_peak(base, problem)
    for array, nothing in (
        (many.samples, np.nan),
        (many.answers, 0.0),
        (many.final, np.nan),
        (many.final_s, 0.0),
        (many.steps, 0),
    ):
        array.fill(nothing)


def _executed(
    integrator: Integrator, many: Spans, budget: float, halt: Halt
) -> tuple[dict[int, SimulationError], dict[int, tuple[str, ...]]]:
    """Let the core go over the spans; errors and warnings of some by number."""
    errors: dict[int, SimulationError] = {}
    warnings: dict[int, tuple[str, ...]] = {}
    code, at = library(), many.at
    addresses = integrator.workspace.address, integrator.workspace.address_of_spans
    limits = integrator.problem.limits
    while at[SPAN] < len(many.ends):
        if halt.asked:
            raise Interrupted([Problem("interrupted")])
        taken = int(many.steps.sum()) + limits.steps * len(errors)
        if taken > budget:
            beyond = beyond_budget(budget)
            errors |= dict.fromkeys(range(int(at[SPAN]), len(many.ends)), beyond)
            break
        at[LEFT] = min(PAUSE.steps, budget - taken + 1)
        status = code.advance_spans(*addresses)
        code.check()
        if not at[INSIDE]:
            continue
        number = int(at[SPAN])
        integrator.begin = float(many.ends[number, 0])
        integrator.forget()
        try:
            if status not in (FINISHED, LOG_FULL, PAUSED, HISTORY_FULL):
                raise failure(integrator.model, integrator.arrays, status)
            if not integrator.advance(halt, status):
                raise integrator.interrupted()
            code.keep_end(*addresses)
            if integrator.warnings:
                warnings[number] = integrator.warnings
        except Interrupted:
            raise
        except SimulationError as error:
            errors[number] = error
        at[SPAN], at[INSIDE] = number + 1, 0
    return errors, warnings


def _undefined(
    model: Model, many: Spans, errors: Mapping[int, SimulationError]
) -> dict[int, SimulationError]:
    """The errors of spans where a recorded signal is not defined."""
    if np.isfinite(many.samples).all():
        return {}
    found = {}
    for number in range(len(many.ends)):
        rows = slice(int(many.rows[number]), int(many.rows[number + 1]))
        try:
            if number not in errors:
                refuse_nan(model, many.samples[rows], many.times[rows])
        except SimulationError as error:
            found[number] = error
    return found
