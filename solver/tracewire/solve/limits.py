"""What keeps a run from hanging, and the thresholds of what is around the core of the solver."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from tracewire.errors import OptionError, Problem, SimulationError


@dataclass(frozen=True)
class Limits:
    """Limits of one run: accepted and rejected steps, wall time in s, events in the log, and the
    longest step in s: guards are looked at five times in a step.
    """

    steps: int = 50_000_000
    seconds: float = 600.0
    events: int = 1_000_000
    max_step: float = math.inf

    def refuse(self) -> None:
        """Raises OptionError: a number of steps or a time that is not above zero."""
        problems = [
            Problem(f"the limit '{name}' of a run must be above zero, not {value:g}")
            for name, value in (("steps", self.steps), ("seconds", self.seconds))
            if not value > 0
        ]
        if problems:
            raise OptionError(problems)


class SampleLimits:
    """Of the instants that a run records."""

    most: Final[int] = 10_000_000
    """Samples of a run, or instants of a stroboscopic section."""
    short: Final[float] = 1e-6
    """Of an interval: what the last sample may lack to be at the end of a run."""
    close: Final[float] = 1e-12
    """Of a period: what an instant may lack to be within the span."""


SAMPLE = SampleLimits()


class StepLimits:
    """Of steps, and of the differences that are taken where no derivative is at hand."""

    known_past: Final[float] = 0.98
    """The longest step in units of a delay: one to a known time may be a little longer."""
    passage: Final[float] = 10.0
    """The span of a passage in lengths to which instants are resolved and of which a step is a
    tenth at most."""
    difference: Final[float] = 1e-3
    """Of a parameter that others follow; what is left of the error is of order 6."""


STEP = StepLimits()


class PauseLimits:
    """Of the work between two pauses, in which Ctrl-C is heard and progress is told."""

    seconds: Final[float] = 0.1
    """Between two pauses of a run, about."""
    first_work: Final[int] = 200_000
    """Signals times steps before the first one."""
    growth: Final[int] = 8
    """How many times more steps are taken before the next one, at most."""
    steps: Final[int] = 50_000
    """Of all spans that run together, between two pauses."""
    told_every: Final[float] = 0.1
    """Seconds between two tellings of what many runs have done, at least."""


PAUSE = PauseLimits()


class ParallelLimits:
    """Of runs in several processes or on several computers."""

    chunk: Final[float] = 0.5
    """Seconds of work that an executor is given at a time."""
    ahead: Final[int] = 2
    """Tasks that wait, for each worker."""
    jobs: Final[int] = 8
    """That a process keeps."""
    patience: Final[float] = 2.0
    """Seconds until a worker is looked for that was killed while it wrote what it had done."""


PARALLEL = ParallelLimits()


class MemoryLimits:
    """Of arrays that a run works in, and of what is kept for the next one. In numbers of 8 bytes
    where nothing else is said."""

    log: Final[int] = 1_000_000
    """Of the log of the core, before it is emptied."""
    stiff: Final[int] = 64
    """Mode combinations of a run that are remembered as stiff."""
    first_moves: Final[int] = 512
    """Rows for moves of a past at first; they double."""
    first_points: Final[int] = 512
    """The same of its points."""
    steps: Final[int] = 32
    """Steps of the states that sensitivities follow at once."""
    past: Final[int] = 250_000_000
    """Of the past of what is delayed: 2 GB."""
    workspaces: Final[int] = 16
    """Kinds of workspaces that a model keeps."""
    models: Final[int] = 24
    """Models that keep workspaces; of more, those that began first give theirs up."""
    workspace: Final[int] = 500_000
    """Of the samples and tables of one; larger ones are not kept."""
    given: Final[int] = 100
    """Kinds of given values for which a model keeps the values of all others."""
    sensitivities: Final[int] = 200
    """Kinds of what is asked for, of which a model keeps what moves."""
    times: Final[int] = 64
    """Spans whose default times are kept."""
    core_files: Final[int] = 4
    """Of other texts of the core: checkouts and branches take turns."""
    code_wait: Final[float] = 600.0
    """Seconds for another process that makes the same code: then both do."""
    code_soon: Final[float] = 1.0
    """Seconds after which that wait is told."""


MEMORY = MemoryLimits()


def beyond_budget(steps: float) -> SimulationError:
    """The error of a run that is not begun, as those before it have taken too many steps."""
    what = f"the model takes more than {steps:.0f} steps in all"
    return SimulationError([Problem(what, hint="Fit fewer or shorter segments.")])
