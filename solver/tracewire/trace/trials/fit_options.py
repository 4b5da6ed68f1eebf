"""The options of a fit of a trial, which a refit that is sent to a worker carries."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypedDict


class FitOptions(TypedDict, total=False):
    """How a trial is fitted, where it is not as usual."""

    fixed: Mapping[str, float]
    """Parameters that are not fitted, and their values."""
    steps: int
    """The steps of the fit, at most."""
    budget: float
    """The steps of all runs together, at most."""
    target: float
    """The sum of squares that a fit must promise to reach: one that is too slow ends early."""
    inlier_limit: float
    """The mean squared residual up to which a window is not taken for astray."""
    ftol: float
    """As in `fit_windows`."""
    initial_state_steps: int
    """As in `fit_windows`."""
