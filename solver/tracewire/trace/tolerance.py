"""The guard against effects that a solver makes: residuals must not move with its tolerance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracewire.errors import FitError, Problem
from tracewire.trace.trial import Bench, Trial
from tracewire.trace.windows import opened

TIGHTER = 0.1
MOVES = 0.3
"""What the residual may move, in sigma, as a root mean square."""


def refuse_loose(bench: Bench, trial: Trial) -> None:
    """Refuse to discover where the solver's error counts beside the noise.

    The windows of a trial are run once more, from the same starts, with a tenth of the tolerance.
    Raises FitError where the residual moves by more than 0.3 sigma (root mean square).
    """
    tighter = replace(bench, rtol=TIGHTER * bench.rtol)
    there = opened(tighter.criterion(trial, trial.windows.segments)).residuals
    pairs = zip(trial.windows.residuals, there, strict=True)
    moved = float(np.sqrt(np.mean(np.concatenate([(a - b).ravel() for a, b in pairs]) ** 2)))
    if not moved < MOVES:
        what = f"with a tenth of rtol = {bench.rtol:g} the residual moves by {moved:.2g} sigma"
        hint = (
            f"A trace would explain errors of the solver: use --rtol {tighter.rtol:.0e}, or look"
            " for what makes the diagram that sensitive (a chaotic motion, a stiff contact)."
        )
        raise FitError([Problem(what, hint=hint)])
