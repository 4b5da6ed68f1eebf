"""Long windows that have lost track of their data, followed from their begin on.

A long run from a start that is a little wrong is out of step with the data, and a fit of the start
ends in the next minimum. Over a first part it is in step, and the start found there leads on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tracewire.residual.initial_states import fit_initial_states, refine_initial_states
from tracewire.residual.limits import WINDOW
from tracewire.residual.windows import Windows, evaluate_windows, keep_better, with_initial_states


def is_out_of_step(windows: Windows, part: float, far: float = np.inf) -> bool:
    """Whether the error of windows is more than a part of the standard deviation of the measured
    signals, or their mean squared residual is above `far`."""
    return windows.rss > sum(
        _most_in_step(windows, n, part, far) for n in range(len(windows.linearisations))
    )


def follow_growing_parts(windows: Windows, part: float, far: float = np.inf) -> Windows:
    """Windows with their starts fitted anew where they are out of step, as by `is_out_of_step`.

    The start is fitted to the longest first part, of a half, a quarter and so on, that the model
    follows, and then to parts each twice as long as the one before. The same windows where that
    does no better, and where windows go on from the memories of others.
    """
    if windows.criterion.remembers:
        return windows
    found: dict[int, Mapping[str, float]] = {}
    for n in range(len(windows.linearisations)):
        lost = windows.squares[n] > _most_in_step(windows, n, part, far)
        start = _follow(windows, n, part, far) if lost and windows.starts[n] else None
        if start is not None:
            found[n] = start
    there = refine_initial_states(
        with_initial_states(windows, found), list(found), WINDOW.initial_state_steps
    )
    return keep_better(windows, there, list(found))


def _follow(windows: Windows, n: int, part: float, far: float) -> Mapping[str, float] | None:
    """The start of a window after it was fitted to its growing parts but the whole; nothing where
    the model follows no part."""
    segment, whole = windows.criterion.segments[n], windows.criterion
    rows, start = len(segment.rows) // 2, None
    growing = False
    while WINDOW.least_part <= rows < len(segment.rows):
        first = replace(segment, rows=segment.rows[:rows], start={**segment.start, **(start or {})})
        there = fit_initial_states(
            evaluate_windows(whole.on_segments([first]), windows.inlier_limit)
        )
        growing = growing or not is_out_of_step(there, part, far)
        if growing:
            start = there.starts[0]
        rows = 2 * rows if growing else rows // 2
    return start


def _most_in_step(windows: Windows, n: int, part: float, far: float) -> float:
    """The sum of squared residuals up to which a window is in step."""
    return min(part**2 * _signal_power(windows, n), far * max(windows.residuals[n].size, 1))


def _signal_power(windows: Windows, n: int) -> float:
    """The sum of squares, in sigma^2, of what a window's signals deviate from their means."""
    segment = windows.criterion.segments[n]
    sigma = windows.criterion.sigma[segment.measured.name]
    return float(np.sum(np.var(segment.samples(), axis=0) / sigma**2)) * len(segment.rows)
