"""What the tests of exact solutions ask of a run: all methods, tight, and the log in short."""

from __future__ import annotations

from typing import Any

from solve.models import LIMITS
from tracewire.solve import Run

METHODS = ("auto", "dormand_prince", "rosenbrock")
TIGHT: dict[str, Any] = {"rtol": 1e-10, "limits": LIMITS}


def log(result: Run) -> list[tuple[str, str, str]]:
    """Kind, guard and direction of each event."""
    return [(event.kind, event.guard, event.direction) for event in result.events]


def when(result: Run) -> list[float]:
    """The times of all events."""
    return [event.time for event in result.events]
