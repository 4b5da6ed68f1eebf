"""The rows of `simulate_many`: what they have in common, and the run of one of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, TracewireError
from tracewire.formula import names_of
from tracewire.solve.core.flow import FUNCTIONS
from tracewire.solve.core_library import library
from tracewire.solve.integrator import Integrator, refuse_nan
from tracewire.solve.interrupt import StopFlag
from tracewire.solve.observers import (
    Observer,
    Section,
    check_section,
    criterion_of,
    crossings,
    instants,
)
from tracewire.solve.options import Options, with_row
from tracewire.solve.problem import InitialValueProblem, initial_value_problem
from tracewire.solve.setup import Records

Row = Mapping[str, float]


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
        self.sampled = "samples" in observers
        self.section = next((o for o in observers if isinstance(o, Section)), None)
        if self.section is not None:
            check_section(model, self.section)
        self.criterion = next((o for o in observers if callable(o)), None)
        self.problem = self._any_problem()
        model.routines.compiled_addresses(
            FUNCTIONS
        )  # made during a run one would wait for Python's lock
        self._check_times()
        library()  # not in a thread

    def __reduce__(self) -> tuple[Any, ...]:
        """What pickle keeps: one row that has values stands for all; a run is given its own."""
        return Task, (self.model, [self.one], self.observers, self.options)

    def _any_problem(self) -> InitialValueProblem:
        """The problem of the first row that poses one; the error of the first if none does."""
        first: TracewireError | None = None
        for row in self.rows:
            try:
                given = with_row(self.model, self.options, row)
                problem = initial_value_problem(self.model, **given)
            except TracewireError as error:
                first = first or error
                continue
            self.one = row
            return replace(problem, given=self.options)
        raise first or OptionError([Problem("there are no rows")])

    def _check_times(self) -> None:
        """Refuse samples that do not fit into one array, before the first run."""
        flat = self.model.flat
        every = flat.every if self.options.get("every") is None else None
        formulas = [*flat.span, *([every] if every is not None else [])]
        if not self.sampled or not any(names_of(formula) for formula in formulas):
            return
        first: Vector | None = None
        for number, row in enumerate(self.rows):
            try:
                times = self.problem.with_values(row).times
            except TracewireError:  # the row will say so
                continue
            first = times if first is None else first
            if not np.array_equal(first, times):
                what = f"row {number} has other sample times than the rows before it"
                hint = "Give span= and times=, or observe something else than samples."
                raise OptionError([Problem(what, hint=hint)])

    def run(self, number: int, row: Row, stop_flag: StopFlag) -> Outcome:
        """The run of one row, and what is kept of it. Raises TracewireError."""
        model, section = self.model, self.section
        problem = self.problem.with_values(row)
        begin, end = problem.span
        times = problem.times if self.sampled or self.criterion else np.empty(0)
        marks, since = np.empty(0), begin
        if section is not None:
            marks, since = instants(section, problem.parameters, begin, end)
        every = np.union1d(times, marks)
        records: Records = "both" if len(marks) else "signals"
        integrator = Integrator(replace(problem, times=every), records=records, stop_flag=stop_flag)
        integrator.go_to()
        columns, recorded = len(model.recorded), integrator.progress.samples
        points = np.empty((0, 1 + len(model.states)))
        if section is not None and section.guard:
            points = crossings(model, section, integrator.log.rows, since)
        elif section is not None:
            at = np.searchsorted(every, marks)
            points = np.column_stack((marks, recorded[at, columns:]))
        samples = recorded[np.searchsorted(every, times), :columns]
        refuse_nan(model, samples, times)
        criterion = np.empty(0)
        if self.criterion is not None:
            signals = dict(zip(model.recorded, samples.T.copy(), strict=True))
            run = replace(integrator.run, t=times, signals=signals)
            criterion = criterion_of(self.criterion, run)
        kept = samples if self.sampled else np.empty((0, columns))
        t = times if self.sampled else np.empty(0)
        events = len(integrator.log)
        outcome = Outcome(t, kept, integrator.x, events, points, criterion)
        integrator.give_back()
        return outcome
