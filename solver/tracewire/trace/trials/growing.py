"""Fits of long runs that follow the data from the begin on, further each time.

A long run of a model whose values are a little wrong is out of step with the data, and a fit of it
ends in the next minimum. Over the first part it is in step, and the fit there leads on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from tracewire.errors import FitError
from tracewire.residual import Segment
from tracewire.trace.trials.trial import TraceProblem, Trial, with_fitted_starts


def follow_further(
    problem: TraceProblem, short: Trial, trial: Trial, segments: Sequence[Segment]
) -> Trial:
    """A trial that has lost track of long windows, fitted to their first parts, each twice as long
    as the one before, from the values of a fit to `short` windows; the trial itself where that is
    no better."""
    rows, longest = 2 * short.length, max(len(segment.rows) for segment in segments)
    now = short
    fixed = dict(trial.windows.criterion.parameters)
    try:
        while True:
            parts = [replace(segment, rows=segment.rows[:rows]) for segment in segments]
            parts = with_fitted_starts(parts, now)
            now = problem.fit(now.effects, parts, min(rows, longest), now.values, fixed=fixed)
            if rows >= longest:
                break
            rows *= 2
    except FitError:
        return trial
    return replace(now, length=trial.length) if now.rss < trial.rss else trial
