"""Outlier windows: few that are far from all others, and that would lead a declared fit astray.

Where a body hits a barrier a sample earlier than the model does, the residual is a thousand times
that of a missing effect: such windows rule the fit, and it ends where no window is right.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tracewire.errors import FitError
from tracewire.residual import Segment
from tracewire.trace.trials.trial import TraceProblem, Trial, with_starts_of


def fit_without_outliers(
    problem: TraceProblem, trial: Trial, segments: Sequence[Segment], steps: int
) -> Trial:
    """A declared fit that ended far from the noise, without the windows that led it astray.

    It is fitted in rounds of some `steps`, as long as such windows hold most of the sum of squares.
    All windows are used again where they are near the noise from there, and where the others are
    at it: then what is missing shows in the outliers alone.
    """
    options = problem.options.check
    kept, best = list(range(len(segments))), trial
    left = options.strays_left_converged if trial.converged else options.strays_left
    least = left * len(segments)
    try:
        for _ in range(options.stray_rounds):
            means, squares = best.window_mean_squares, best.windows.squares
            is_stray = means > options.stray * np.median(means)
            near = np.flatnonzero(~is_stray).tolist()
            strays_rule = squares[is_stray].sum() > options.stray_share * squares.sum()
            if not strays_rule or len(near) < least:
                break
            kept = [kept[n] for n in near]
            starts = [best.windows.segments[n] for n in near]
            best = problem.fit((), starts, trial.length, best.values, steps=steps)
        if best is trial:
            return trial
        there = with_starts_of(segments, best, kept)
        whole = problem.fit((), there, trial.length, best.values, steps=steps)
    except FitError:
        return trial
    at_noise = best.reduced_chi2 < problem.options.trial.gate_noise
    return whole if at_noise or whole.reduced_chi2 < options.led_astray else best
