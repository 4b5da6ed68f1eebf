"""`simulate_spans`: one model with one set of parameters, over many spans from starts of their own.

What the windows of a measured series need: many short runs, which differ in where they begin. They
are prepared once, and the core goes from one to the next on its own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import NamedTuple, Unpack

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, SimulationError, unknown
from tracewire.solve.core.arrays import Arrays, Spans
from tracewire.solve.core.codes import BUDGET, FINISHED, HISTORY_FULL, LOG_FULL, PAUSED
from tracewire.solve.core.spans import INSIDE, LEFT, SPAN
from tracewire.solve.core_library import library
from tracewire.solve.failures import failure
from tracewire.solve.history import refuse_delays
from tracewire.solve.integrator import Integrator, refuse_nan
from tracewire.solve.interrupt import Interrupted, StopFlag
from tracewire.solve.limits import PAUSE, beyond_budget
from tracewire.solve.options import AnySpan, Options
from tracewire.solve.problem import InitialValueProblem, initial_value_problem
from tracewire.solve.run import Sensitivities
from tracewire.solve.sensitivities import recorded
from tracewire.solve.workspace import least_peak


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
    budget: float = np.inf,
    sensitivities: Sequence[str] = (),
    **given: Unpack[AnySpan],
) -> SpanRuns:
    """Simulate a model over many spans: each run is what `simulate` makes of it, alone.

    Only that what is found stiff in one span is taken for stiff at once in those behind it.

    `given` are options of `simulate`: parameters, rtol, atol, preset, inputs, past, limits, which
    hold for each run; `budget` holds for the steps of all: a run that begins beyond it fails.
    A run that fails does not end the others. Raises OptionError for arguments that do not fit, and
    Interrupted.
    """
    return span_problem(model, spans, sensitivities, **given).run(budget, StopFlag())


class Layout(NamedTuple):
    """What of spans is the same for all starts: begin and end of each (W, 2); where its samples
    begin in `times` (M,), (W + 1,); whether it goes on from the one before (W,); the states whose
    start is given (W, n), and those (n,) that go on."""

    ends: Matrix
    rows: NDArray[np.int64]
    times: Vector
    follows: NDArray[np.int64]
    given: NDArray[np.bool_]
    kept: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class SpanProblem:
    """Runs of one model over many spans: checked and laid out once, for any values.

    `problem` has all that they have in common, and `starts` the start values of each by name.
    """

    problem: InitialValueProblem
    layout: Layout
    starts: Sequence[Mapping[str, float]]

    @property
    def size(self) -> int:
        """The numbers in its tables and times."""
        return self.problem.tables.size + self.layout.times.size

    def with_values(
        self, parameters: Mapping[str, float], starts: Sequence[Mapping[str, float]]
    ) -> SpanProblem:
        """The same with other values of parameters, and of the states that `starts` had. Raises
        OptionError, SimulationError."""
        return SpanProblem(self.problem.with_parameters(parameters), self.layout, starts)

    def run(self, budget: float, stop_flag: StopFlag) -> SpanRuns:
        """The runs; see `simulate_spans`. Raises OptionError, Interrupted."""
        problem, layout = self.problem, self.layout
        integrator = Integrator(problem, stop_flag=stop_flag)
        space = integrator.workspace
        integrator.progress.ints[BUDGET] = min(problem.limits.steps, PAUSE.steps)
        space.keep()
        many = space.for_spans(len(layout.ends), len(layout.times))
        if space.layout is not layout:
            _set_layout(many, layout, problem)
            space.layout = layout
        self._set_to(many, space.arrays)
        own_places = space.table.copy()
        errors, warnings = _executed(integrator, many, budget, stop_flag)
        space.table[:] = own_places  # the core has set those of samples to what is in `many`
        model = problem.model
        errors |= _undefined(model, many, errors)
        slopes = many.final_s.reshape(*many.final.shape, many.floor.shape[1])
        runs = SpanRuns(
            signals=dict(zip(model.recorded, many.samples.T.copy(), strict=True)),
            sensitivities=recorded(model, many.answers, problem.sensitivities),
            rows=layout.rows,
            final=many.final.copy(),
            final_slopes=slopes.copy(),
            steps=many.steps.copy(),
            errors=errors,
            warnings=warnings,
        )
        integrator.give_back()
        return runs

    def _set_to(self, many: Spans, base: Arrays) -> None:
        """Let a run of each span begin with these values, and nothing have come of it yet. Raises
        OptionError for starts that do not fit."""
        problem, given = self.problem, self.layout.given
        states, asked = problem.model.states, problem.sensitivities
        many.x[:] = problem.start
        for number, start in enumerate(self.starts):
            for name, value in start.items():
                if not math.isfinite(value):
                    raise OptionError([Problem(f"the start of '{name}' is {value}")])
                many.x[number, states.index(name)] = value
        many.at[:] = 0, 0, 0, problem.limits.events, 0
        if asked:
            count, (n, q) = len(given), many.floor.shape
            set_here = given[:, :, None] & many.lasting.astype(bool)  # it follows no parameter
            many.s[:] = np.where(set_here, 0.0, base.sensitivity.s).reshape(count, n * q)
            many.floor[:] = least_peak(base, problem)
            many.answers.fill(0.0)
            many.final_s.fill(0.0)
        many.samples.fill(np.nan)
        many.final.fill(np.nan)
        many.steps.fill(0)


def span_problem(
    model: Model,
    spans: Sequence[Span],
    sensitivities: Sequence[str] = (),
    **given: Unpack[AnySpan],
) -> SpanProblem:
    """The problem of many spans with these options of `simulate`; see `simulate_spans`. Raises
    OptionError, SimulationError."""
    if any(span.follows for span in spans) and not given.get("past"):
        refuse_delays(model, "a span that follows another")
    always = set(spans[0].start).intersection(*(span.start for span in spans))
    options = Options(**given)  # type: ignore[typeddict-item]  # of those of any span
    options["span"] = 0.0, 1.0
    options["start"] = {name: spans[0].start[name] for name in always}
    problem = initial_value_problem(model, sensitivities, sampled=False, **options)
    strange = [name for span in spans for name in span.start if name not in model.states]
    if strange:
        raise OptionError([unknown("state", strange[0], model.states)])
    starts = [span.start for span in spans]
    set_here = np.array([[name in start for name in model.states] for start in starts], dtype=bool)
    follows = np.array([n > 0 and span.follows for n, span in enumerate(spans)], dtype=bool)
    kept = np.zeros(len(model.states), dtype=bool)
    if follows.any():
        kept = ~set_here[follows].any(axis=0)
        set_here |= follows[:, None] & kept
    layout = Layout(
        ends=np.array([(span.begin, span.end) for span in spans]),
        rows=np.array([*accumulate((len(span.times) for span in spans), initial=0)]),
        times=np.concatenate([span.times for span in spans]),
        follows=follows.astype(np.int64),
        given=set_here,
        kept=kept,
    )
    return SpanProblem(problem, layout, starts)


def _set_layout(many: Spans, layout: Layout, problem: InitialValueProblem) -> None:
    """Let the arrays of spans have the layout of these."""
    many.ends[:], many.rows[:], many.times[:] = layout.ends, layout.rows, layout.times
    many.follows[:], many.kept[:] = layout.follows, layout.kept
    many.lasting[:] = [name in problem.model.flat.parameters for name in problem.sensitivities]


def _executed(
    integrator: Integrator, many: Spans, budget: float, stop_flag: StopFlag
) -> tuple[dict[int, SimulationError], dict[int, tuple[str, ...]]]:
    """Let the core go over the spans; errors and warnings of some by number."""
    errors: dict[int, SimulationError] = {}
    warnings: dict[int, tuple[str, ...]] = {}
    code, at = library(), many.at
    addresses = integrator.workspace.address, integrator.workspace.address_of_spans
    limits = integrator.problem.limits
    while at[SPAN] < len(many.ends):
        if stop_flag.asked:
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
            if not integrator.advance(stop_flag, status):
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
