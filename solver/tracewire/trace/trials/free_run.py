"""One run over a section of a series, whose start is fitted on the first part of it alone."""

from __future__ import annotations

from dataclasses import replace

from tracewire.array_types import Vector
from tracewire.residual import Segment, evaluate_windows
from tracewire.trace.trials.trial import TraceProblem, Trial


def free_run(problem: TraceProblem, trial: Trial, whole: Segment, shortest: int) -> Vector:
    """The residuals in sigma of one run over a section, shape (N, signals).

    A free start is fitted on the first part of the section alone.
    """
    if whole.free:
        first = first_part(whole, shortest, problem.options.split.first_part)
        (fitted,) = problem.windows_on(trial, [first]).segments
        whole = replace(fitted, rows=whole.rows)
    return evaluate_windows(problem.criterion_on(trial, [whole])).residuals[0]


def first_part(whole: Segment, shortest: int, part: float) -> Segment:
    """The first part of a segment, at least two shortest windows of it."""
    count = max(int(part * len(whole.rows)), min(2 * shortest, len(whole.rows)))
    return replace(whole, rows=whole.rows[:count])
