"""The rows of `simulate_many`: what they have in common, and the run of one of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, TracewireError, unknown
from tracewire.formula import names_of
from tracewire.options import options_of
from tracewire.solve.core.arrays import Plan
from tracewire.solve.core.flow import FREE, FUNCTIONS
from tracewire.solve.core.methods import NAMES
from tracewire.solve.core_library import library
from tracewire.solve.execute import Execution
from tracewire.solve.interrupt import Halt
from tracewire.solve.limits import Limits
from tracewire.solve.observers import (
    Observer,
    Section,
    check_section,
    criterion_of,
    crossings,
    instants,
)
from tracewire.solve.sensitivities import UNMOVED, new_sensitivity
from tracewire.solve.setup import kept_plan, new_arrays, new_flow, new_progress, packed, prepare
from tracewire.solve.simulate import (
    ascending,
    longest_step,
    parameter_values,
    refuse_nan,
    run_of,
    samples_of,
    span_of,
    start_of,
    tables_of,
    tolerance_of,
)

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
Row = Mapping[str, float]
START = "start."


class Options(TypedDict, total=False):
    """The options of `simulate`, which hold for all rows; a row overrides them."""

    parameters: Mapping[str, float] | None
    start: Mapping[str, float] | None
    span: tuple[float, float] | None
    times: ArrayLike | None
    method: str
    rtol: float
    atol: float | Mapping[str, float] | None
    step: float | None
    preset: str
    inputs: Mapping[str, tuple[ArrayLike, ArrayLike]] | None
    limits: Limits | Mapping[str, float] | None


@dataclass(frozen=True)
class Outcome:
    """What is kept of one row."""

    t: Vector
    samples: Matrix
    final: Vector
    events: int
    points: Matrix
    criterion: NDArray[np.float64]


class Task:
    """What all rows have in common, made once."""

    def __init__(
        self, model: Model, rows: Sequence[Row], observers: Sequence[Observer], options: Options
    ) -> None:
        self.model, self.rows, self.options = model, rows, options
        self.observers = tuple(observers)
        self.parameters = dict(options.get("parameters") or {})
        self.start = dict(options.get("start") or {})
        self.preset = options.get("preset", "")
        self.limits = options_of(Limits, options.get("limits"), "limits of a run")
        self.method = options.get("method", "auto")
        if self.method != "auto" and self.method not in NAMES:
            raise OptionError([unknown("method", self.method, ["auto", *NAMES])])
        given = options.get("times")
        self.times = None if given is None else ascending(given)
        self.sampled = "samples" in observers
        self.section = next((o for o in observers if isinstance(o, Section)), None)
        if self.section is not None:
            check_section(model, self.section)
        self.criterion = next((o for o in observers if callable(o)), None)
        self.plan = self._plan()
        values = self._any_values()
        tables = tables_of(model, values, self.inputs)
        vector = np.array([*values.values(), 0.0])
        defaults = [f for n, f in model.flat.inputs.items() if n not in self.inputs and f]
        self.tables_vary = any(names_of(formula) for formula in defaults)
        model.compiled_addresses(FUNCTIONS)  # made during a run one would wait for Python's lock
        self.flow = new_flow(model, vector, packed(tables))
        self.check_times()
        library()  # not in a thread

    def __reduce__(self) -> tuple[Any, ...]:
        """What pickle keeps: one row that has values stands for all; a run is given its own."""
        return Task, (self.model, [self.one], self.observers, self.options)

    @property
    def inputs(self) -> Mapping[str, tuple[ArrayLike, ArrayLike]]:
        """The measured inputs."""
        return self.options.get("inputs") or {}

    def _plan(self) -> Plan:
        """The plan, in which the states follow the recorded signals where a section asks for it."""
        plan = kept_plan(self.model)
        if self.section is None or self.section.period is None:
            return plan
        return plan._replace(direct=np.append(plan.direct, np.arange(len(self.model.states))))

    def parameters_and_start(self, row: Row) -> tuple[dict[str, float], dict[str, float]]:
        """What a row gives, over what is common."""
        parameters, start = dict(self.parameters), dict(self.start)
        for name, value in row.items():
            if name in self.model.flat.parameters:
                parameters[name] = float(value)
            else:
                start[name.removeprefix(START)] = float(value)
        return parameters, start

    def _any_values(self) -> dict[str, float]:
        """Parameter values of the first row that has some; the error of the first if none has."""
        problem: TracewireError | None = None
        for row in self.rows:
            try:
                values = parameter_values(
                    self.model, self.parameters_and_start(row)[0], self.preset
                )
                self.one = row
                return values
            except TracewireError as error:
                problem = problem or error
        raise problem or OptionError([Problem("there are no rows")])

    def grid(self, values: Mapping[str, float]) -> tuple[float, float, Vector]:
        """Begin, end and sample times of a row."""
        begin, end = span_of(self.model, values, self.options.get("span"), self.times)
        return begin, end, samples_of(self.model, values, begin, end, self.times)

    def check_times(self) -> None:
        """Refuse samples that do not fit into one array, before the first run."""
        flat = self.model.flat
        formulas = [*flat.span, *([flat.every] if flat.every is not None else [])]
        if not self.sampled or not any(names_of(formula) for formula in formulas):
            return
        first: Vector | None = None
        for number, row in enumerate(self.rows):
            try:
                given, _ = self.parameters_and_start(row)
                _, _, times = self.grid(parameter_values(self.model, given, self.preset))
            except TracewireError:  # the row will say so
                continue
            first = times if first is None else first
            if not np.array_equal(first, times):
                what = f"row {number} has other sample times than the rows before it"
                hint = "Give span= and times=, or observe something else than samples."
                raise OptionError([Problem(what, hint=hint)])

    def run(self, number: int, row: Row, halt: Halt) -> Outcome:
        """The run of one row, and what is kept of it. Raises TracewireError."""
        model, options, base = self.model, self.options, self.flow
        given, start = self.parameters_and_start(row)
        values = parameter_values(model, given, self.preset)
        begin, end, times = self.grid(values)
        if not (self.sampled or self.criterion):
            times = np.empty(0)
        section, since = self.section, begin
        marks = np.empty(0)
        if section is not None:
            marks, since = instants(section, values, begin, end)
        absolute, step = options.get("atol"), options.get("step")
        rtol = options.get("rtol", 1e-6)
        longest = longest_step(model, values, self.limits)
        length = end - begin
        tolerance = tolerance_of(model, rtol, absolute, self.method, step, length, longest)
        vector = np.array([*values.values(), 0.0])
        if self.tables_vary:
            flow = new_flow(model, vector, packed(tables_of(model, values, self.inputs)))
        else:
            flow = base._replace(
                address=base.address.copy(),
                m=base.m.copy(),
                c=np.zeros(len(base.c)),
                bound=np.full(len(base.bound), FREE, dtype=np.int64),
                push=np.zeros(base.push.shape),
                counts=np.zeros(len(base.counts), dtype=np.int64),
            )
            prepare(model, flow, vector)
        x = start_of(model, flow, start)
        every = np.union1d(times, marks)
        state = new_progress(model, x, (begin, end), every, self.method, tolerance)
        columns, width = len(model.recorded), len(self.plan.direct)
        if width > columns:
            state = state._replace(samples=np.full((len(every), width), np.nan))
        nothing = new_sensitivity(model, flow, state, (), UNMOVED, {}, {})
        arrays = new_arrays(model, flow, self.plan, state, nothing)
        execution = Execution(model, arrays, self.limits, begin, halt=halt)
        execution.run()
        points = np.empty((0, 1 + len(x)))
        if section is not None and section.guard:
            points = crossings(model, section, execution.log, since)
        elif section is not None:
            at = np.searchsorted(every, marks)
            points = np.column_stack((marks, state.samples[at, columns:]))
        samples = state.samples[np.searchsorted(every, times), :columns]
        refuse_nan(model, samples, times)
        criterion = np.empty(0)
        if self.criterion is not None:
            shown = arrays._replace(progress=state._replace(times=times, samples=samples))
            run = run_of(replace(execution, arrays=shown), values, x, times)
            criterion = criterion_of(self.criterion, run)
        kept = samples if self.sampled else np.empty((0, columns))
        t = times if self.sampled else np.empty(0)
        return Outcome(t, kept, state.x.copy(), execution.logged, points, criterion)
