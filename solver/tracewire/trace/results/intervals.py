"""How sure the values of a result are, where what is left may be no noise."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.special import stdtrit

from tracewire.array_types import Matrix, Vector
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.statistics import inverse_information
from tracewire.trace.trials.trial import Trial


def reported_errors(trial: Trial, options: TraceOptions) -> dict[str, float]:
    """The standard error of each fitted value: that of noise with the residual's correlation from
    sample to sample, or that over blocks of time where it is larger."""
    blocks = _over_blocks(trial, options)
    return {name: max(error, blocks[name]) for name, error in trial.standard_errors.items()}


def reported_intervals(trial: Trial, options: TraceOptions) -> dict[str, tuple[float, float]]:
    """The wider of the intervals that both errors give, as far as it lies within the bounds of a
    value: no share is more than all."""
    quantile = float(stdtrit(options.interval_blocks - 1, 0.5 + options.confidence / 2))
    bounds = {u.name: (u.low, u.high) for u in trial.windows.criterion.unknowns}
    blocks, found = _over_blocks(trial, options), {}
    for name, (low, high) in trial.intervals(options.confidence).items():
        value, half = trial.values[name], quantile * blocks[name]
        least, most = bounds.get(name, (-np.inf, np.inf))
        found[name] = max(min(low, value - half), least), min(max(high, value + half), most)
    return found


def _over_blocks(trial: Trial, options: TraceOptions) -> dict[str, float]:
    near, count = trial.windows.linearisations, len(trial.windows.values)
    errors = errors_over_blocks(
        [n.projection.project_out(n.slopes[:, :count]) for n in near],
        [n.projection.project_out(n.residual.ravel()) for n in near],
        options.interval_blocks,
    )
    return dict(zip(trial.windows.values, errors.tolist(), strict=True))


def errors_over_blocks(
    slopes: Sequence[Matrix], residuals: Sequence[Vector], blocks: int
) -> Vector:
    """The standard errors of values (n,) whose residuals (m,), of windows with slopes (m, n), are
    slow, or larger here than there: from the sums J'r over at least so many blocks of time.

    The covariance is A B A with A the inverse of J'J and B the sum of the squares of these sums (K.
    Y. Liang and S. L. Zeger, Biometrika 73, 1986, 13). It supposes no size of the noise.
    """
    inverse, sizes = inverse_information(np.concatenate(slopes))
    scale = np.where(sizes > 0, sizes, 1.0)
    length = sum(len(residual) for residual in residuals) / blocks
    sums = [
        (slope[rows] / scale).T @ residual[rows]
        for slope, residual in zip(slopes, residuals, strict=True)
        for rows in np.array_split(np.arange(len(residual)), math.ceil(len(residual) / length))
    ]
    if len(sums) > 2 * blocks:  # short windows go together
        sums = [np.sum(some, axis=0) for some in np.array_split(np.array(sums), blocks)]
    spread = inverse @ np.array(sums).T
    variance = np.sum(spread**2, axis=1) * len(sums) / max(len(sums) - 1, 1)
    errors = np.divide(variance**0.5, sizes, out=np.full(len(sizes), np.inf), where=sizes > 0)
    return np.asarray(errors)
