"""How well the data determine what was fitted."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tracewire.fit.criterion import Criterion

Vector = NDArray[np.float64]
WEAK = 1e-7
"""Directions that weigh less than this part of the strongest are within the differences' error."""


def standard_errors(criterion: Criterion, z: Vector) -> Vector:
    """Standard errors of the scaled unknowns z (n,), in SI; NaN where the data determine none.

    The minimum of the criterion moves by P w e when the data move by e: w = 1/sqrt(N of the
    segment), P the pseudo-inverse of w J, J = d residual / d z by central differences. The noise e
    is taken as independent, with the mean square per degree of freedom of each signal and segment;
    where residuals are correlated the errors are too small. For one series and one signal this is
    the textbook's s^2 (J'J)^-1.
    """
    residuals = criterion.residuals(z)
    matrices = criterion.derivatives(z, residuals, central=True)
    weights = [1 / np.sqrt(len(r)) for r in residuals]
    jacobian = np.concatenate([w * m for w, m in zip(weights, matrices, strict=True)])
    samples = sum(r.size for r in residuals)
    levels = [
        np.broadcast_to(w * np.sqrt(np.mean(r**2, axis=0)), r.shape).ravel()
        for w, r in zip(weights, residuals, strict=True)
    ]
    spread = np.concatenate(levels) * np.sqrt(samples / max(samples - len(z), 1))
    left, singular, directions = np.linalg.svd(jacobian, full_matrices=False)
    weak = singular <= WEAK * singular.max(initial=0.0)
    inverse = np.divide(1.0, singular, out=np.zeros_like(singular), where=~weak)
    response = (directions.T * inverse) @ (left.T * spread)
    errors = np.sqrt(np.sum(response**2, axis=1)) * criterion.scales
    errors[(np.abs(directions[weak]) > 0.1).any(axis=0)] = np.nan
    return np.asarray(errors)
