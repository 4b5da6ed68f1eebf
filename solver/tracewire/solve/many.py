"""`simulate_many`: runs of one model for rows of parameters, side by side.

Each row is what `simulate` gives for it alone, bit for bit, whoever runs it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from tracewire.arguments import checked
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, SimulationError, TracewireError, unknown
from tracewire.solve.interrupt import Interrupted
from tracewire.solve.observers import Observer, Section
from tracewire.solve.options import START, Options, refuse_unknown_options
from tracewire.solve.parallel import carry_out
from tracewire.solve.progress import PartProgress, ProgressCallback
from tracewire.solve.runs import Runs
from tracewire.solve.task import Outcome, Row, Task


@checked
def simulate_many(
    model: Model,
    rows: Sequence[Row] | Mapping[str, ArrayLike],
    *,
    observe: Observer | Sequence[Observer] = "samples",
    workers: int | None = None,
    executor: Executor | None = None,
    progress: ProgressCallback | None = None,
    **options: Unpack[Options],
) -> Runs:
    """Simulate a model for many rows of parameters, in parallel.

    A row maps names of parameters, and `start.NAME` of start values, to values in SI; or `rows` is
    a mapping from such names to arrays of equal lengths. `observe` says what is kept of each run:
    "samples", a `Section`, a function of a Run that gives a number or an array, or several of
    these. `workers` is the number of threads, the number of cores unless given; a criterion may be
    called in any of them. With an `executor` of `concurrent.futures` its workers run the rows, with
    the same results to the last bit; a criterion is a function of a module then.
    `progress` is told the part of the rows that is done, and the seconds that are left. All else is
    as in `simulate`.

    A row that fails does not end the others. Raises OptionError for arguments that do not fit, the
    error of the first row where all of them fail, and Interrupted with the rows that are done.
    """
    refuse_unknown_options(options)
    table = _rows(model, rows)
    observers = _observers(observe)
    outcomes: dict[int, Outcome] = {}
    errors: dict[int, TracewireError] = {}
    task = Task(model, table, observers, options)
    ended: SimulationError | None = None
    stopped = True

    def take(arguments: tuple[Any, ...], outcome: Outcome | TracewireError) -> None:
        if isinstance(outcome, Outcome):
            outcomes[arguments[0]] = outcome
        else:
            errors[arguments[0]] = outcome

    try:
        shown = PartProgress(progress, len(table), 0)
        tasks = list(enumerate(table))
        stopped = carry_out(
            task.run, tasks, take, workers=workers, executor=executor, progress=shown
        )
    except SimulationError as error:
        ended = error
    if stopped:
        for number in range(len(table)):
            if number not in outcomes:
                errors.setdefault(number, Interrupted([Problem("interrupted before it began")]))
    elif not outcomes:
        raise errors[0]
    runs = _gathered(model, table, outcomes, errors)
    if stopped:
        what = f"interrupted when {len(outcomes)} of {len(table)} runs were done"
        problems = [Problem(what, hint="They are in `.runs` of this error.")]
        raise Interrupted([*(ended.problems if ended else ()), *problems], runs=runs)
    return runs


def _rows(model: Model, rows: Sequence[Row] | Mapping[str, ArrayLike]) -> list[Row]:
    """The rows one by one. Raises OptionError for names that are unknown, lengths that differ."""
    if isinstance(rows, Mapping):
        columns = {name: np.asarray(values, dtype=float) for name, values in rows.items()}
        lengths = {name: values.shape for name, values in columns.items()}
        if len(set(lengths.values())) > 1 or any(len(shape) != 1 for shape in lengths.values()):
            shown = ", ".join(f"{name} {shape}" for name, shape in lengths.items())
            what = f"the columns of the rows do not have one length: {shown}"
            raise OptionError([Problem(what, hint="Give arrays of one dimension.")])
        turned = zip(*(values.tolist() for values in columns.values()), strict=True)
        table: list[Row] = [dict(zip(columns, values, strict=True)) for values in turned]
    else:
        table = list(rows)
    if not table:
        raise OptionError([Problem("there are no rows to simulate", hint="Give one at least.")])
    known = [*model.flat.parameters, *(START + name for name in model.states)]
    names = dict.fromkeys(name for row in table for name in row)
    problems = [unknown("parameter or start", n, known) for n in names if n not in set(known)]
    if problems:
        raise OptionError(problems)
    return table


def _observers(observe: Observer | Sequence[Observer]) -> list[Observer]:
    one = isinstance(observe, str | Section) or callable(observe)
    several = [observe] if one else list(observe)  # type: ignore[arg-type]
    for kind in several:
        if isinstance(kind, str) and kind != "samples":
            raise OptionError([unknown("observer", kind, ["samples"])])
    for what, number in (
        ("section", sum(isinstance(kind, Section) for kind in several)),
        ("criterion", sum(callable(kind) for kind in several)),
    ):
        if number > 1:
            text = f"{number} observers are a {what}"
            raise OptionError([Problem(text, hint=f"Give one {what}.")])
    return several  # type: ignore[return-value]


def _gathered(
    model: Model,
    rows: Sequence[Row],
    outcomes: Mapping[int, Outcome],
    errors: dict[int, TracewireError],
) -> Runs:
    """All rows in arrays."""
    count, columns, n = len(rows), len(model.recorded), len(model.states)
    first = outcomes[min(outcomes)] if outcomes else None
    t = first.t if first else np.empty(0)
    shape = first.criterion.shape if first else (0,)
    samples = np.full((count, len(t), columns), np.nan)
    final, events = np.full((count, n), np.nan), np.full(count, np.nan)
    points = [np.empty((0, 1 + n))] * count
    criterion = np.full((count, *shape), np.nan)
    for number, outcome in outcomes.items():
        if outcome.criterion.shape != shape:
            what = f"the criterion has the shape {outcome.criterion.shape} here, before {shape}"
            errors[number] = SimulationError([Problem(what)])
            continue
        samples[number], final[number] = outcome.samples, outcome.final
        events[number], points[number] = outcome.events, outcome.points
        criterion[number] = outcome.criterion
    names = dict.fromkeys(name for row in rows for name in row)
    return Runs(
        t=t,
        signals=model.recorded,
        states=model.states,
        parameters={name: np.array([r.get(name, np.nan) for r in rows], float) for name in names},
        samples=samples,
        final=final,
        event_counts=events,
        points=tuple(points),
        criterion=criterion,
        errors={number: str(errors[number]) for number in sorted(errors)},
    )
