"""A run on the compiled core: it is paused now and then to look at the clock and empty the log."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.errors import Problem, SimulationError
from tracewire.solve.core.arrays import Arrays, Progress, table_of
from tracewire.solve.core.codes import (
    BUDGET,
    END,
    EVENTS,
    FINISHED,
    HISTORY_FULL,
    LENGTH,
    LOG_FULL,
    LOG_HEAD,
    LOGGED,
    NOT_UNIQUE,
    PAUSED,
    REJECTED,
    STEPS,
    STIFF_STEPS,
    WARNINGS,
    T,
)
from tracewire.solve.core.flow import EVALUATIONS, FUNCTIONS
from tracewire.solve.core_library import library
from tracewire.solve.failures import failure, too_long, too_many_events
from tracewire.solve.history import grow
from tracewire.solve.interrupt import Halt, Interrupted, until_interrupted
from tracewire.solve.limits import Limits
from tracewire.solve.run import Event, EventDirection, EventKind, Statistics
from tracewire.solve.sensitivities import undefined

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
Ints = NDArray[np.int64]
Tell = Callable[[float, float], object]
"""Is told how far the work is: the part that is done, 0 to 1, and the seconds that are left."""
PAUSE = 0.1  # s between two pauses, about
FIRST_WORK = 20_000  # signals times steps before the first pause
GROWTH = 8
UNASKED = [EVENTS.index("crossing"), EVENTS.index("scheduled")]  # a reset is logged as such


def first_budget(model: Model) -> int:
    """The steps before the first pause, when nothing is known of how long a step takes."""
    return max(1, FIRST_WORK // (1 + len(model.flat.signals)))


def next_budget(budget: int, steps: int, seconds: float) -> int:
    """The steps before the next pause, after `steps` took `seconds`."""
    fitting = PAUSE * max(steps, 1) / max(seconds, 1e-9)
    return max(1, int(min(fitting, GROWTH * budget)))


@dataclass
class Execution:
    """One run of a model: what the core works on, and the events that it has logged so far."""

    model: Model
    arrays: Arrays
    limits: Limits
    start: float
    tell: Tell | None = None
    halt: Halt | None = None
    asked: tuple[str, ...] = ()
    table: Ints | None = None
    rows: list[Matrix] = field(default_factory=list)
    logged: int = 0
    seconds: float = 0.0

    @property
    def progress(self) -> Progress:
        """How far the run is."""
        return self.arrays.progress

    @property
    def core(self) -> Ints:
        """The table of the arrays for the core."""
        return table_of(self.arrays) if self.table is None else self.table

    def run(self) -> None:
        """Integrate to the end.

        Raises SimulationError where that cannot be, Interrupted where the user does not want it;
        a `halt` that is given is the business of the caller, else Ctrl-C is heard here.
        """
        library()  # before the clock of the run begins
        if self.halt is not None:
            if not self.go_on(self.halt):
                raise self.interrupted()
            return
        with until_interrupted() as halt:
            try:
                self.go_on(halt)
            except SimulationError:
                if not halt.asked:
                    raise
        if halt.asked:  # whatever became of the run: the user wants to stop
            raise self.interrupted()

    def interrupted(self) -> Interrupted:
        """The error of a run that the user stopped."""
        now = self.progress.now
        way = f"on the way from {self.start:g} to {now[END]:g} s"
        what = f"interrupted at t = {now[T]:.9g} s, {way}"
        return Interrupted([Problem(what, hint="What there is of the run is in `.run`.")])

    def go_on(self, halt: Halt, status: int | None = None) -> bool:
        """Integrate until the end, or until the user wants to stop; whether it is the end.

        `status` is what the core has said already of a run that has begun.
        """
        began = time.perf_counter()
        ints, now = self.progress.ints, self.progress.now
        table = self.core
        code, core = library(), table.__array_interface__["data"][0]
        budget, last = first_budget(self.model), -PAUSE
        while not halt.asked:
            before, done = self.seconds, int(ints[STEPS])
            ints[BUDGET] = min(budget, self.limits.steps - done)
            status = code.advance(core) if status is None else status
            code.check()
            self.seconds = time.perf_counter() - began
            self.empty_log()
            self.check_events()
            if status == FINISHED:
                return True
            if status == HISTORY_FULL:
                grow(self.arrays, table)
            elif status not in (LOG_FULL, PAUSED):
                raise failure(self.model, self.arrays, status)
            self.check_limits()
            # what was compiled meanwhile is called without a detour
            self.arrays.flow.address[:] = self.model.addresses(FUNCTIONS)
            budget = next_budget(budget, int(ints[STEPS]) - done, self.seconds - before)
            status = None
            if self.tell is not None and self.seconds - last >= PAUSE:
                last, part = self.seconds, float((now[T] - self.start) / now[LENGTH])
                self.tell(part, self.seconds * (1 - part) / part if part > 0 else np.inf)
        return False

    def check_limits(self) -> None:
        """Stop a run that takes more steps or more time than it may."""
        limits = self.limits
        if self.progress.ints[STEPS] >= limits.steps:
            what, hint = f"more than {limits.steps} steps", "Loosen rtol."
            raise too_long(self.model, self.arrays, what, hint)
        if self.seconds > limits.seconds:
            what = f"more than {limits.seconds:g} s of wall time"
            hint = "Shorten the span, loosen rtol or raise the limit."
            raise too_long(self.model, self.arrays, what, hint)

    def check_events(self) -> None:
        """Stop a run with more events than it may have, at the first of them that is too many."""
        if self.logged > self.limits.events:
            raise too_many_events(self.model, np.concatenate(self.rows), self.limits.events)

    def empty_log(self) -> None:
        """Take the events that the core has logged."""
        logged = int(self.progress.ints[LOGGED])
        if logged:
            rows = self.progress.log[:logged].copy()
            if self.asked:
                rows = np.hstack([rows, self.arrays.sensitivity.times[:logged]])
            rows = _shown(self.model, rows)
            self.rows.append(rows)
            self.progress.ints[LOGGED] = 0
            self.logged += len(rows)

    @property
    def log(self) -> Matrix:
        """The log as the core writes it, in the order of time: (events, LOG_HEAD + 2n + q)."""
        width = self.progress.log.shape[1] + len(self.asked)
        rows = np.concatenate(self.rows) if self.rows else np.empty((0, width))
        return rows[np.argsort(rows[:, 0], kind="stable")]

    @property
    def events(self) -> tuple[Event, ...]:
        """The log, in the order of time."""
        rows = self.log
        events = (_event(self.model, row, self.asked) for row in rows)
        return tuple(_owned(self.model, events, rows))

    @property
    def statistics(self) -> Statistics:
        """What the run has cost so far."""
        ints = self.progress.ints
        return Statistics(
            steps=int(ints[STEPS] - ints[REJECTED]),
            rejected=int(ints[REJECTED]),
            evaluations=int(self.arrays.flow.counts[EVALUATIONS]),
            stiff_steps=int(ints[STIFF_STEPS]),
            seconds=self.seconds,
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the user should know although the run has ended well."""
        t = self.start
        said = []
        if self.progress.ints[WARNINGS] & NOT_UNIQUE:
            said.append(f"the start at t = {t:g} s is not unique: two modes fit it")
        for reset in np.flatnonzero(self.progress.overlooked).tolist():
            name = self.model.lowered.resets[reset].name
            said.append(
                f"the start at t = {t:g} s lies on the guard of {name}, which does not fire there"
            )
        for i, since in enumerate(self.progress.undetermined.tolist()):
            if since < np.inf:
                mode = self.model.modes[i]
                said.append(
                    f"'{mode.text}' of {mode.signal or 'an event'} rests at exactly zero from "
                    f"t = {since:.9g} s on, and nothing decides on which side: the last one goes on"
                )
        if self.asked:
            said.extend(undefined(self.model, self.arrays.sensitivity))
        return tuple(said)


def _shown(model: Model, rows: Matrix) -> Matrix:
    """The rows of a log without what is made for events: an event whose guard jumps is a reset, and
    one that waits for the other direction is none."""
    silent = np.isin(rows[:, 2], list(model.only_triggers))
    if np.any(silent):
        rows = rows[~(silent & np.isin(rows[:, 1], UNASKED))]
    rows = _once(model, rows)
    jumps = np.array([mode.jumps for mode in model.modes])
    if not np.any(jumps != ""):
        return rows
    of = jumps[rows[:, 2].astype(np.int64)]
    fires = ((of == "up") | (of == "down")) & (rows[:, 3] > 0)
    rows[fires, 1] = EVENTS.index("reset")
    rows[of == "down", 3] = -1
    kept: Matrix = rows[(of == "") | fires]
    return kept


def _once(model: Model, rows: Matrix) -> Matrix:
    """The rows of a log without comparisons of a signal whose crossing another row shows."""
    signals = np.array(model.compared_signals)
    if not len(signals):
        return rows
    of = rows[:, 2].astype(np.int64)
    compares = np.array([mode.compares for mode in model.modes])[of]
    order = np.lexsort((np.arange(len(rows)), compares, signals[of], rows[:, 0]))
    again = np.zeros(len(rows), dtype=bool)
    times, signals = rows[order, 0], signals[of[order]]
    again[order[1:]] = (times[1:] == times[:-1]) & (signals[1:] == signals[:-1])
    kept: Matrix = rows[~(again & compares & np.isin(rows[:, 1], UNASKED))]
    return kept


def _event(model: Model, row: Vector, asked: tuple[str, ...]) -> Event:
    time_, kind, mode, direction = float(row[0]), int(row[1]), int(row[2]), int(row[3])
    where, n = model.modes[mode], len(model.states)
    ways: dict[int, EventDirection] = {1: "up", -1: "down", 0: ""}
    sides = row[LOG_HEAD : LOG_HEAD + 2 * n].tolist()
    moved = row[LOG_HEAD + 2 * n :].tolist()
    return Event(
        time=time_,
        kind=cast(EventKind, EVENTS[kind]),
        block=where.signal,
        guard=where.text,
        direction=ways[direction],
        before=dict(zip(model.states, sides[:n], strict=True)),
        after=dict(zip(model.states, sides[n:], strict=True)),
        sensitivity=dict(zip(asked, moved, strict=True)),
    )


def _owned(model: Model, events: Iterable[Event], rows: Matrix) -> Iterator[Event]:
    """The events; of several with one guard each names its own block, in the order of the model."""
    shared, seen = model.shared_triggers, Counter[tuple[float, int]]()
    for event, row in zip(events, rows, strict=True):
        mode = int(row[2])
        if mode in shared and event.kind in ("reset", "impact"):
            fits = [r for r in shared[mode] if r.direction in ("both", event.direction)]
            yield replace(event, block=fits[seen[event.time, mode] % len(fits)].owner)
            seen[event.time, mode] += 1
        else:
            yield event
