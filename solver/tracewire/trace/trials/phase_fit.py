"""Phases: where in a wave a series begins that no fit has seen."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tracewire.residual import Criterion, evaluate_windows, fit_windows
from tracewire.trace.thresholds import TrialOptions

TURN = np.linspace(-np.pi, np.pi, 72, endpoint=False)


def fit_phase(criterion_at: Callable[[float], Criterion], options: TrialOptions) -> float:
    """The phase in rad that fits windows best, the one unknown of the criterion that begins at it.

    A wave that is small moves the residual by a*cos(phase) + b*sin(phase). Two runs, at 0 and at a
    quarter of a turn, with their derivatives, tell the residual without the wave, a and b; where
    that sum is smallest, the start states free, the fit begins.
    """
    sine, cosine = (evaluate_windows(criterion_at(phase)) for phase in (0.0, 0.5 * np.pi))
    squares = np.zeros(len(TURN))
    for n, (near, there) in enumerate(zip(sine.linearisations, cosine.linearisations, strict=True)):
        off = sine.linearisations[n].projection.project_out
        b, a = near.slopes[:, 0], -there.slopes[:, 0]
        without = 0.5 * (near.residual.ravel() - a + there.residual.ravel() - b)
        waves = np.outer(off(a), np.cos(TURN)) + np.outer(off(b), np.sin(TURN))
        squares += np.sum((off(without)[:, None] + waves) ** 2, axis=0)
    first = evaluate_windows(criterion_at(float(TURN[np.argmin(squares)])))
    windows, _ = fit_windows(first, options.phase_steps)
    return float(next(iter(windows.values.values())))
