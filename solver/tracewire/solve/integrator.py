"""`Integrator`: a run on the compiled core, which is paused now and then to look at the clock."""

from __future__ import annotations

import math
import time

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, SimulationError
from tracewire.solve.core.arrays import Arrays, Progress
from tracewire.solve.core.codes import (
    ABSOLUTE,
    BEYOND,
    BUDGET,
    END,
    FINISHED,
    HISTORY_FULL,
    LENGTH,
    LOG_FULL,
    NOT_UNIQUE,
    PAUSED,
    REJECTED,
    SAMPLED,
    STEPS,
    STIFF_STEPS,
    WARNINGS,
    T,
)
from tracewire.solve.core.flow import EVALUATIONS, FUNCTIONS
from tracewire.solve.core_library import library
from tracewire.solve.event_log import Log
from tracewire.solve.failures import (
    failure,
    hint_of_loop,
    place_of,
    starts_beyond,
    too_long,
    too_many_events,
)
from tracewire.solve.history import grow
from tracewire.solve.interrupt import Interrupted, StopFlag, until_interrupted
from tracewire.solve.limits import PAUSE
from tracewire.solve.once_per_model import once_per_model
from tracewire.solve.problem import InitialValueProblem
from tracewire.solve.progress import ProgressCallback
from tracewire.solve.run import EventLog, Run, Statistics
from tracewire.solve.sampling import short_of_end
from tracewire.solve.sensitivities import recorded, undefined
from tracewire.solve.setup import Records
from tracewire.solve.tables import unknown_parts
from tracewire.solve.workspace import Workspace, acquire, give_back


def first_budget(model: Model) -> int:
    """The steps before the first pause, when nothing is known of how long a step takes."""
    return max(1, PAUSE.first_work // (1 + len(model.flat.signals)))


def next_budget(budget: int, steps: int, seconds: float) -> int:
    """The steps before the next pause, after `steps` took `seconds`."""
    fitting = PAUSE.seconds * max(steps, 1) / max(seconds, 1e-9)
    return max(1, int(min(fitting, PAUSE.growth * budget)))


@once_per_model
def _units_of(model: Model) -> dict[str, str]:
    """The units of the recorded signals."""
    return {name: model.flat.units.get(name, "") for name in model.recorded}


class Integrator:
    """The solution of a problem as it is computed: it goes to a stop, and on from there.

    At a stop, `t` and `x` are the time in s and the states, and `run` is the run up to there.
    Modes, slides, contacts and memories go on over a stop.

    `records` says what is kept at the sample times. `progress` is told about ten times a second how
    far it is; `stop_flag` says whether the user wants to stop, and Ctrl-C does where none is given.
    """

    def __init__(
        self,
        problem: InitialValueProblem,
        *,
        records: Records = "signals",
        progress: ProgressCallback | None = None,
        stop_flag: StopFlag | None = None,
    ) -> None:
        self.problem, self.model = problem, problem.model
        self.tell, self.stop_flag = progress, stop_flag
        self.workspace: Workspace = acquire(problem, records)
        self.arrays: Arrays = self.workspace.arrays
        self.log = Log(problem.model, problem.sensitivities)
        self.begin, self.seconds = problem.span[0], 0.0

    @property
    def progress(self) -> Progress:
        """How far the run is, in the arrays of the core."""
        return self.arrays.progress

    @property
    def t(self) -> float:
        """The time in s up to which the run is there."""
        return float(self.arrays.progress.now[T])

    @property
    def x(self) -> Vector:
        """The states (n,) there: the right limit."""
        return self.arrays.progress.x.copy()

    def go_to(self, end: float | None = None) -> None:
        """Go on to the time `end` in s, that of the span unless given; what happens there has
        happened then.

        Raises OptionError for an end that is behind; SimulationError where it cannot go on;
        Interrupted where the user does not want it: a `stop_flag` that is given is the business of
        the caller, else Ctrl-C is heard here.
        """
        end = self.problem.span[1] if end is None else end
        if not self.t <= end < math.inf:
            what = f"a run that is at t = {self.t:.9g} s cannot go to {end:.9g} s"
            raise OptionError([Problem(what, hint="Give a later time.")])
        progress = self.arrays.progress
        progress.now[END] = end
        library()  # before the clock of the run begins
        if self.stop_flag is not None:
            if not self.advance(self.stop_flag):
                raise self.interrupted()
        else:
            with until_interrupted() as stop_flag:
                try:
                    self.advance(stop_flag)
                except SimulationError:
                    if not stop_flag.asked:
                        raise
            if stop_flag.asked:  # whatever became of the run: the user wants to stop
                raise self.interrupted()
        if (progress.overlooked == BEYOND).any():
            raise starts_beyond(self.model, progress, self.problem.start, self.begin)
        if end < self.problem.span[1]:  # the core takes the stop for the end of all samples
            progress.ints[SAMPLED] = np.searchsorted(progress.times, end, side="right")

    def interrupted(self) -> Interrupted:
        """The error of a run that the user stopped."""
        now = self.arrays.progress.now
        way = f"on the way from {self.begin:g} to {now[END]:g} s"
        what = f"interrupted at t = {now[T]:.9g} s, {way}"
        return Interrupted([Problem(what, hint="What there is of the run is in `.run`.")])

    def advance(self, stop_flag: StopFlag, status: int | None = None) -> bool:
        """Integrate until the end, or until the user wants to stop; whether it is the end.

        `status` is what the core has said already of a run that has begun.
        """
        began = time.perf_counter() - self.seconds
        ints, now, limits = self.arrays.progress.ints, self.arrays.progress.now, self.problem.limits
        code, core = library(), self.workspace.address
        budget, last = first_budget(self.model), -PAUSE.seconds
        while not stop_flag.asked:
            before, done = self.seconds, int(ints[STEPS])
            ints[BUDGET] = min(budget, limits.steps - done)
            status = code.advance(core) if status is None else status
            code.check()
            self.seconds = time.perf_counter() - began
            self.log.take(self.arrays)
            self._check_events()
            if status == FINISHED:
                return True
            if status == HISTORY_FULL:
                grow(self.arrays, self.workspace.table)
            elif status not in (LOG_FULL, PAUSED):
                raise failure(self.model, self.arrays, status)
            self._check_limits()
            # what was compiled meanwhile is called without a detour
            self.arrays.flow.address[:] = self.model.routines.addresses(FUNCTIONS)
            budget = next_budget(budget, int(ints[STEPS]) - done, self.seconds - before)
            status = None
            if self.tell is not None and self.seconds - last >= PAUSE.seconds:
                last, part = self.seconds, float((now[T] - self.begin) / now[LENGTH])
                self.tell(part, self.seconds * (1 - part) / part if part > 0 else np.inf)
        return False

    def _check_limits(self) -> None:
        """Stop a run that takes more steps or more time than it may."""
        limits = self.problem.limits
        if self.arrays.progress.ints[STEPS] >= limits.steps:
            what, hint = f"more than {limits.steps} steps", "Loosen rtol."
            raise too_long(self.model, self.arrays, what, hint)
        if self.seconds > limits.seconds:
            what = f"more than {limits.seconds:g} s of wall time"
            hint = "Shorten the span, loosen rtol or raise the limit."
            raise too_long(self.model, self.arrays, what, hint)

    def _check_events(self) -> None:
        """Stop a run with more events than it may have, at the first of them that is too many."""
        most = self.problem.limits.events
        if self.log.most > most and len(self.log) > most:
            raise too_many_events(self.model, np.concatenate(self.log.parts), most)

    def forget(self) -> None:
        """Count time and events from here on."""
        self.seconds = 0.0
        self.log.clear()

    @property
    def statistics(self) -> Statistics:
        """What the run has cost so far."""
        ints = self.arrays.progress.ints.tolist()
        return Statistics(
            steps=ints[STEPS] - ints[REJECTED],
            rejected=ints[REJECTED],
            evaluations=int(self.arrays.flow.counts[EVALUATIONS]),
            stiff_steps=ints[STIFF_STEPS],
            seconds=self.seconds,
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the user should know although the run has gone well."""
        t, progress = self.begin, self.arrays.progress
        said = []
        if progress.ints[WARNINGS] & NOT_UNIQUE:
            said.append(f"the start at t = {t:g} s is not unique: two modes fit it")
        for reset, overlooked in enumerate(progress.overlooked.tolist()):
            if not overlooked:
                continue
            name = self.model.lowered.resets[reset].name
            where = "beyond the contact" if overlooked == BEYOND else "on the guard"
            said.append(
                f"the start at t = {t:g} s lies {where} of {name}, which does not fire there"
            )
        for i, since in enumerate(progress.undetermined.tolist()):
            if since < np.inf:
                mode = self.model.modes[i]
                said.append(
                    f"'{mode.text}' of {mode.signal or 'an event'} rests at exactly zero from "
                    f"t = {since:.9g} s on, and nothing decides on which side: the last one goes on"
                )
        if self.problem.sensitivities:
            said.extend(undefined(self.model, self.arrays.sensitivity))
        return tuple(said)

    @property
    def run(self) -> Run:
        """The run as far as it is."""
        problem, model, progress = self.problem, self.model, self.arrays.progress
        names, count = model.states, int(progress.ints[SAMPLED])
        samples = progress.samples[:count, : len(model.recorded)]  # states may stand behind them
        answers, log = self.arrays.sensitivity.samples[:count], self.log.copy()
        inputs = problem.given.get("inputs") or {}
        spaced = problem.times if problem.given.get("times") is None else problem.times[:0]
        return Run(
            title=model.flat.title,
            t=problem.times[:count],
            signals=dict(zip(model.recorded, samples.T.copy(), strict=True)),
            units=_units_of(model),
            events=EventLog(lambda: log.events),
            parameters=problem.parameters,
            start=dict(zip(names, problem.start.tolist(), strict=True)),
            final=dict(zip(names, progress.x.tolist(), strict=True)),
            statistics=self.statistics,
            warnings=(
                *self.warnings,
                *short_of_end(spaced, problem.span[1]),
                *unknown_parts(inputs, *problem.span),
            ),
            shown=model.flat.shown,
            model=model,
            sensitivities=recorded(model, answers, problem.sensitivities),
            resolved=dict(zip(names, self._resolved.tolist(), strict=True)),
        )

    @property
    def _resolved(self) -> Vector:
        """The part (n,) of the largest value of each state that is as much above its absolute
        tolerance as the usual one is below the relative tolerance; 1 at most."""
        progress = self.arrays.progress
        least = progress.atol / ABSOLUTE
        part = np.ones(len(least))
        np.divide(least, progress.largest, out=part, where=progress.largest > least)
        return part

    def give_back(self) -> None:
        """Let the next run of the model have the arrays; this one is over."""
        give_back(self.model, self.workspace)


def refuse_nan(model: Model, samples: Matrix, t: Vector) -> None:
    """A recorded signal may be undefined where no state depends on it."""
    if np.isfinite(samples).all():
        return
    for n, name in enumerate(model.recorded):
        bad = np.flatnonzero(~np.isfinite(samples[:, n]))
        if len(bad):
            when, value = t[bad[0]], samples[bad[0], n]
            what = f"the recorded signal '{name}' is not finite ({value}) at t = {when:.9g} s"
            hint = hint_of_loop(model, name)
            hint = hint or "Look for a division by zero or the root of a negative number in it."
            raise SimulationError([Problem(what, place_of(model, name), (), hint)])
