"""What keeps a run from hanging."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """Limits of one run: accepted and rejected steps, wall time in s, events in the log."""

    steps: int = 50_000_000
    seconds: float = 600.0
    events: int = 1_000_000
