"""The work of a sweep: its points side by side in threads, with progress, and a file to resume."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

import numpy as np
from numpy.typing import NDArray

from tracewire.analyse.partial import Partial
from tracewire.errors import OptionError, Problem, TracewireError
from tracewire.solve import Interrupted
from tracewire.solve.interrupt import Halt, until_interrupted
from tracewire.solve.many import cores

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
) -> None:
    """Make all rows of `partial` that are not done: point(number, halt) gives one of them.

    A point that raises a TracewireError fails for itself. Raises the error of the first point where
    all fail, and Interrupted where the user stops the work; what is done is in the file then.
    """
    threads = checked(workers)
    missing = np.flatnonzero(~partial.done).tolist()
    tell = Progress(progress, len(partial.done), len(partial.done) - len(missing))
    waiting: dict[Future[Vector], int] = {}
    first: TracewireError | None = None
    with until_interrupted() as halt, ThreadPoolExecutor(threads) as pool:
        try:
            while (missing or waiting) and not halt.asked:
                while missing and len(waiting) < 2 * threads:
                    number = missing.pop(0)
                    waiting[pool.submit(point, number, halt)] = number
                ended, _ = wait(waiting, return_when=FIRST_COMPLETED)
                for future in ended:
                    number = waiting.pop(future)
                    try:
                        partial.put(number, future.result())
                    except Interrupted:
                        continue
                    except TracewireError as error:
                        first = first or error
                        partial.put(number, None, str(error))
                    tell.step()
        except BaseException:
            halt.asked = True
            raise
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


def checked(workers: int | None) -> int:
    """The number of threads. Raises OptionError."""
    if workers is not None and workers < 1:
        what = f"{workers} workers cannot work"
        raise OptionError([Problem(what, hint="Give a whole number above 0, or None.")])
    return workers or cores()
