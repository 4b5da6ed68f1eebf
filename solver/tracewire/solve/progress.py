"""How far long work is: the part that is done, and the time that is left."""

from __future__ import annotations

import time
from collections.abc import Callable

from tracewire.solve.limits import PAUSE

ProgressCallback = Callable[[float, float], object]
"""Is told how far the work is: the part that is done, 0 to 1, and the seconds that are left."""


class PartProgress:
    """Tells the part of a work of `total` like parts that is done; some were `done` before."""

    def __init__(self, tell: ProgressCallback | None, total: int, done: int) -> None:
        self.tell, self.total, self.first, self.done = tell, total, done, done
        self.began, self.told = time.monotonic(), -1.0

    def step(self) -> None:
        """One more is done."""
        self.done += 1
        seconds = time.monotonic() - self.began
        if self.tell is None or (seconds - self.told < PAUSE.told_every and self.done < self.total):
            return
        self.told = seconds
        left = seconds * (self.total - self.done) / (self.done - self.first)
        self.tell(self.done / self.total, left)
