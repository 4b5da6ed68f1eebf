"""How much the command line draws, tells and waits for."""

from __future__ import annotations

from typing import Final


class CommandLimits:
    """The numbers are judgements: what a person reads, and waits for."""

    soon: Final[float] = 1.0
    """Seconds: what takes no longer needs no progress."""
    tell_every: Final[float] = 10.0
    """Seconds between two lines of progress of a fit that no terminal shows."""
    scheduler: Final[float] = 10
    """Seconds for the scheduler of a cluster to answer."""
    pipe_width: Final[int] = 200
    """Characters of a line that no terminal shows."""
    contradictions: Final[int] = 3
    """Units that contradict each other, of which each is told in a line."""
    most_cases: Final[int] = 12
    """Lines of one panel beyond this are not told apart."""
    finer: Final[int] = 10
    """Times as many samples are drawn as are written."""
    curve: Final[int] = 10_000
    """Steps of a curve in a plane: with the 1000 of a run its turns are polygons."""
    film_samples: Final[int] = 2000
    """Of a run that becomes a film, at least ..."""
    film_finer: Final[int] = 4
    """... and for each of its pictures."""
    new_objects: Final[int] = 20_000
    """Between two looks for unused circles of objects; with Python's 700, a tenth of a start."""


LIMITS = CommandLimits()
