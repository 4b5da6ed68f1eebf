"""The guard against effects that a solver makes: residuals must not move with its tolerance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracewire.residual import opened
from tracewire.trace.trials.trial import Bench, Trial

TIGHTER = 0.1
MOVES = 0.3
"""What the residual of a window may move, as a part of the larger of the noise and what is left, as
a root mean square: a tenth of its squares."""


def tightened(bench: Bench) -> Bench:
    """The bench with a tenth of the tolerance."""
    return replace(bench, rtol=TIGHTER * bench.rtol)


def is_loose(bench: Bench, trial: Trial) -> bool:
    """Whether the solver's error counts beside the residual of a trial.

    Its windows are run once more, from the same starts, with a tenth of the tolerance. It counts
    where the residual of half of them moves by more than 0.3 of its size (root mean square, in
    sigma; at least 0.3 sigma). A window that does not run so precisely does not count.
    """
    tighter = tightened(bench)
    there = opened(tighter.criterion(trial, trial.windows.segments)).near
    pairs = [(a, b) for a, b in zip(trial.windows.near, there, strict=True) if a.ran and b.ran]
    if not pairs:
        return False
    moved = np.median([np.sqrt(np.mean((a.residual - b.residual) ** 2)) for a, b in pairs])
    return not moved < MOVES * max(trial.s2**0.5, 1.0)
