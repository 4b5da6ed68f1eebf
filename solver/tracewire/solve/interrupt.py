"""Ctrl-C during a run: it is heard at the next pause, so that what was computed is not lost."""

from __future__ import annotations

# what `signal` calls: it makes enumerations of all that it is given and gives back
import _signal  # type: ignore[import-not-found]
import signal
import threading
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tracewire.errors import SimulationError

if TYPE_CHECKING:
    from tracewire.solve.run import Run
    from tracewire.solve.runs import Runs

CTRL_C = int(signal.SIGINT)


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
class StopFlag:
    """Whether the user wants to stop."""

    asked: bool = False


def until_interrupted() -> AbstractContextManager[StopFlag]:
    """Note Ctrl-C instead of raising it; the second one is a KeyboardInterrupt as ever.

    An exception that may come between any two lines could lose events, and inside of a callback it
    would be lost itself. A program that handles the signal in its own way keeps that.
    """
    return _Noted()


class _Noted:
    """What `until_interrupted` gives; a generator would take as long as the rest of it."""

    def __init__(self) -> None:
        self.stop_flag, self.noted = StopFlag(), False

    def __enter__(self) -> StopFlag:
        main = threading.get_ident() == threading.main_thread().ident
        if main and _signal.getsignal(CTRL_C) is _signal.default_int_handler:
            self.noted = True
            _signal.signal(CTRL_C, self._note)
        return self.stop_flag

    def __exit__(self, *_: object) -> None:
        if self.noted:
            _signal.signal(CTRL_C, _signal.default_int_handler)

    def _note(self, number: int, frame: object) -> None:
        if self.stop_flag.asked:
            raise KeyboardInterrupt
        self.stop_flag.asked = True
