"""The work of a sweep: its points side by side, with progress, and a file to resume."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Executor

import numpy as np
from numpy.typing import NDArray

from tracewire.analyse.partial import Partial
from tracewire.errors import Problem, TracewireError
from tracewire.solve import Halt, Interrupted, crew, each, until_interrupted

Vector = NDArray[np.float64]
Tell = Callable[[float, float], object]
OFTEN = 0.1  # s between two tellings, at least


class Progress:
    """Tells the part of a work that is done, 0 to 1, and the seconds that are left."""

    def __init__(self, tell: Tell | None, total: int, done: int) -> None:
        self.tell, self.total, self.first, self.done = tell, total, done, done
        self.began, self.told = time.monotonic(), -1.0

    def step(self) -> None:
        """One more is done."""
        self.done += 1
        seconds = time.monotonic() - self.began
        if self.tell is None or (seconds - self.told < OFTEN and self.done < self.total):
            return
        self.told = seconds
        left = seconds * (self.total - self.done) / (self.done - self.first)
        self.tell(self.done / self.total, left)


def work_through(
    point: Callable[[int, Halt], Vector],
    partial: Partial,
    workers: int | None = None,
    progress: Tell | None = None,
    executor: Executor | None = None,
) -> None:
    """Make all rows of `partial` that are not done: point(number, halt) gives one of them.

    A point that raises a TracewireError fails for itself. Raises the error of the first point where
    all fail, and Interrupted where the user stops the work; what is done is in the file then.
    """
    missing = [(number,) for number in np.flatnonzero(~partial.done).tolist()]
    tell = Progress(progress, len(partial.done), len(partial.done) - len(missing))
    first: TracewireError | None = None
    with until_interrupted() as halt, crew(point, halt, workers, executor) as made:
        try:
            for (number,), result in each(made, missing):
                if isinstance(result, Interrupted):
                    continue
                if isinstance(result, TracewireError):
                    first = first or result
                    partial.put(number, None, str(result))
                else:
                    partial.put(number, result)
                tell.step()
        finally:
            partial.write()
    if halt.asked:
        raise interrupted(partial)
    if first is not None and len(partial.errors) == len(partial.done):
        raise first


def interrupted(partial: Partial) -> Interrupted:
    """The error of a sweep that the user stopped."""
    what = f"interrupted when {int(partial.done.sum())} of {len(partial.done)} points were done"
    kept = f"They are in '{partial.path}': the same command goes on from there."
    hint = kept if partial.path else "Name a partial file (partial=, --partial) to keep them."
    return Interrupted([Problem(what, hint=hint)])
