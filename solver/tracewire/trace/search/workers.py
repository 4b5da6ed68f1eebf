"""Who carries out the refits of a search: this process, or an executor."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import Any

from tracewire.blas import one_blas_thread
from tracewire.errors import DiagramError, FitError, OptionError, TracewireError
from tracewire.residual import Segment
from tracewire.solve import StopFlag, WorkerEnded, carry_out
from tracewire.trace.trials.fit_options import FitOptions
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import TraceProblem, Trial

REFUSED = (FitError, DiagramError, OptionError)
"""How a refit may end without a trial: it does not run, or the effects cannot be wired."""


@dataclass(frozen=True, eq=False)
class RefitTask:
    """One refit: what `TraceProblem.fit` takes, and what is told of it."""

    effects: tuple[PlacedEffect, ...]
    segments: tuple[Segment, ...]
    length: int
    values: Mapping[str, float]
    options: FitOptions
    words: str = ""


@dataclass
class Workers:
    """An executor of `concurrent.futures` as long as it works; else, and without one, this process.

    The trials are the same to the last bit, whoever fits them. Where a worker has ended that the
    executor does not replace, this process does what was left, and `note` is told.
    """

    executor: Executor | None = None

    def run(
        self,
        problem: TraceProblem,
        refits: Sequence[RefitTask],
        tell: Callable[[str], None],
        note: Callable[[str], None],
    ) -> list[Trial | TracewireError]:
        """The trial of each refit, or why there is none, in the order of the refits. Raises errors
        other than REFUSED, and KeyboardInterrupt."""
        found: dict[int, Trial | TracewireError] = {}
        if self.executor is not None and len(refits) > 1:
            try:
                self._send(self.executor, problem, refits, found, tell)
            except WorkerEnded as error:
                self.executor = None
                note(f"{error.problems[0].what}: what was left was done without the executor")
        for number, refit in enumerate(refits):
            if number not in found:
                _tell(refit, len(found) + 1, len(refits), tell)
                try:
                    found[number] = _fit(problem, number, refit, StopFlag())
                except REFUSED as error:
                    found[number] = error
        return [found[number] for number in range(len(refits))]

    def _send(
        self,
        executor: Executor,
        problem: TraceProblem,
        refits: Sequence[RefitTask],
        found: dict[int, Trial | TracewireError],
        tell: Callable[[str], None],
    ) -> None:
        """Let the executor do all refits. Raises KeyboardInterrupt after Ctrl-C."""

        def take(task: tuple[Any, ...], result: Trial | TracewireError) -> None:
            if isinstance(result, TracewireError) and not isinstance(result, REFUSED):
                raise result
            found[task[0]] = result
            _tell(task[1], len(found), len(refits), tell)

        if carry_out(partial(_fit, problem), list(enumerate(refits)), take, executor=executor):
            raise KeyboardInterrupt


@one_blas_thread()
def _fit(problem: TraceProblem, number: int, refit: RefitTask, stop_flag: StopFlag) -> Trial:
    """The trial of a refit: the job of the workers, who get the problem once."""
    return problem.fit(refit.effects, refit.segments, refit.length, refit.values, **refit.options)


def _tell(refit: RefitTask, number: int, count: int, tell: Callable[[str], None]) -> None:
    if refit.words:
        tell(f"{refit.words} ({number} of {count})")
