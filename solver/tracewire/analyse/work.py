"""The work of a sweep: its points side by side, with progress, and a file to resume."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np

from tracewire.analyse.partial import Partial
from tracewire.array_types import Vector
from tracewire.errors import Problem, TracewireError
from tracewire.solve import Interrupted, PartProgress, ProgressCallback, carry_out


@dataclass(frozen=True)
class IncompleteRow:
    """A row of which some numbers could not be had, NaN there, and why the first one could not."""

    row: Vector
    error: str


def work_through(
    point: Callable[..., Vector | IncompleteRow],
    partial: Partial,
    workers: int | None,
    progress: ProgressCallback | None,
    executor: Executor | None,
    *,
    tasks: Sequence[tuple[Any, ...]] | None = None,
    follow: Callable[[Any], tuple[Any, ...] | None] = lambda task: None,
) -> None:
    """Make the rows of `partial` that are not done: point(number, ..., stop_flag) gives one.

    A task is the arguments of `point` before the stop flag; without `tasks` each row is one.
    `follow` gives the task that goes on from one that has ended, or None. A point that raises a
    TracewireError fails for itself. Raises the error of the first point where all fail, and
    Interrupted where the user stops the work; what is done is in the file then.
    """
    missing = [(number,) for number in np.flatnonzero(~partial.done).tolist()]
    first: list[TracewireError] = []

    def take(
        task: tuple[Any, ...], result: Vector | IncompleteRow | TracewireError
    ) -> tuple[Any, ...] | None:
        if isinstance(result, Interrupted):
            return None
        if isinstance(result, TracewireError):
            first.append(result)
            partial.put(task[0], None, str(result))
        elif isinstance(result, IncompleteRow):
            partial.put(task[0], result.row, result.error)
        else:
            partial.put(task[0], result)
        return follow(task)

    tasks = missing if tasks is None else tasks
    shown = PartProgress(progress, len(partial.done), len(partial.done) - len(missing))
    try:
        stopped = carry_out(point, tasks, take, workers=workers, executor=executor, progress=shown)
    finally:
        partial.write()
    if stopped:
        raise _interrupted(partial)
    if first and len(partial.errors) == len(partial.done):
        raise first[0]


def _interrupted(partial: Partial) -> Interrupted:
    """The error of a sweep that the user stopped."""
    what = f"interrupted when {int(partial.done.sum())} of {len(partial.done)} points were done"
    kept = f"They are in '{partial.path}': the same command goes on from there."
    hint = kept if partial.path else "Name a partial file (partial=, --partial) to keep them."
    return Interrupted([Problem(what, hint=hint)])
