"""The guard against effects that a solver makes: residuals must not move with its tolerance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracewire.errors import FitError, Problem
from tracewire.trace.trial import Bench, Trial
from tracewire.trace.windows import opened

TIGHTER = 0.1
MOVES = 0.3
"""What the residual of a window may move, in sigma, as a root mean square."""


def refuse_loose(bench: Bench, trial: Trial) -> None:
    """Refuse to discover where the solver's error counts beside the noise.

    The windows of a trial are run once more, from the same starts, with a tenth of the tolerance.
    Raises FitError where the residual of half of them moves by more than 0.3 sigma (root mean
    square). A window that does not run so precisely within its limits does not count.
    """
    tighter = replace(bench, rtol=TIGHTER * bench.rtol)
    there = opened(tighter.criterion(trial, trial.windows.segments)).near
    pairs = [(a, b) for a, b in zip(trial.windows.near, there, strict=True) if a.ran and b.ran]
    if not pairs:
        return
    moved = np.median([np.sqrt(np.mean((a.residual - b.residual) ** 2)) for a, b in pairs])
    if not moved < MOVES:
        what = f"with a tenth of rtol = {bench.rtol:g} the residual moves by {moved:.2g} sigma"
        hint = (
            f"A trace would explain errors of the solver: use --rtol {tighter.rtol:.0e}, or look"
            " for what makes the diagram that sensitive (a chaotic motion, a stiff contact)."
        )
        raise FitError([Problem(what, hint=hint)])
