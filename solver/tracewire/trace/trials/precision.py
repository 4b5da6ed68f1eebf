"""Whether the solver is precise enough for what a trial leaves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracewire.residual import evaluate_windows
from tracewire.trace.trials.trial import TraceProblem, Trial


def is_loose(problem: TraceProblem, trial: Trial) -> bool:
    """Whether the solver's error counts beside the residual of a trial.

    Its windows are run once more, from the same starts, with a tenth of the tolerance. It counts
    where the residual of half of them moves by more than 0.3 of its size (root mean square, in
    sigma; at least 0.3 sigma). A window that does not run so precisely does not count.
    """
    criterion = tighter(problem).criterion_on(trial, trial.windows.segments)
    there = evaluate_windows(criterion).linearisations
    pairs = [
        (a, b) for a, b in zip(trial.windows.linearisations, there, strict=True) if a.ran and b.ran
    ]
    if not pairs:
        return False
    moved = np.median([np.sqrt(np.mean((a.residual - b.residual) ** 2)) for a, b in pairs])
    return not moved < problem.options.check.solver_error * max(trial.reduced_chi2**0.5, 1.0)


def tighter(problem: TraceProblem) -> TraceProblem:
    """The problem with a tenth of the tolerance, or what the options say."""
    return replace(problem, rtol=problem.options.check.tighter * problem.rtol)
