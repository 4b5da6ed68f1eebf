"""Ctrl-C during a run: it is heard at the next pause, so that what was computed is not lost."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tracewire.errors import SimulationError

if TYPE_CHECKING:
    from tracewire.solve.run import Run
    from tracewire.solve.runs import Runs


@dataclass(eq=False)
class Interrupted(SimulationError):
    """A run that was stopped by Ctrl-C: it says at what time, and carries what there is.

    `run` is the run up to there, with the samples, events and final states that it has; of
    `simulate_many` it is None, and `runs` holds the rows that were done.
    """

    run: Run | None = None
    runs: Runs | None = None
    exit_code = 130


@dataclass
class Halt:
    """Whether the user wants to stop."""

    asked: bool = False


@contextmanager
def until_interrupted() -> Iterator[Halt]:
    """Note Ctrl-C instead of raising it; the second one is a KeyboardInterrupt as ever.

    An exception that may come between any two lines could lose events, and inside of a callback it
    would be lost itself. A program that handles the signal in its own way keeps that.
    """
    halt = Halt()
    usual = signal.default_int_handler
    main = threading.current_thread() is threading.main_thread()
    if not main or signal.getsignal(signal.SIGINT) is not usual:
        yield halt
        return

    def note(number: int, frame: object) -> None:
        if halt.asked:
            raise KeyboardInterrupt
        halt.asked = True

    signal.signal(signal.SIGINT, note)
    try:
        yield halt
    finally:
        signal.signal(signal.SIGINT, usual)
