"""What keeps a run from hanging."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tracewire.errors import Problem, SimulationError


@dataclass(frozen=True)
class Limits:
    """Limits of one run: accepted and rejected steps, wall time in s, events in the log, and the
    longest step in s: guards are looked at five times in a step.
    """

    steps: int = 50_000_000
    seconds: float = 600.0
    events: int = 1_000_000
    max_step: float = math.inf


def beyond_budget(steps: float) -> SimulationError:
    """The error of a run that is not begun, as those before it have taken too many steps."""
    what = f"the model takes more than {steps:.0f} steps in all"
    return SimulationError([Problem(what, hint="Fit fewer or shorter segments.")])
