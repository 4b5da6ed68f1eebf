"""Least squares on a criterion: scipy's trust region with derivatives by differences."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from tracewire.fit.criterion import Criterion

Vector = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Descent:
    """Where least squares ended: scaled unknowns, residuals and derivatives there, half the sum of
    squares at the start and at the end, and whether it converged."""

    z: Vector
    residual: Vector
    jacobian: Vector
    before: float
    after: float
    converged: bool


def descend(
    criterion: Criterion,
    weights: Callable[[int], float] = lambda count: 1.0,
    steps: int = 30,
    tolerance: float = 1e-6,
    begin: Vector | None = None,
    told: Callable[[float], None] | None = None,
) -> Descent:
    """Minimise the sum of squares of weights(N of the segment) * residual.

    `steps` limits the trial steps, `tolerance` is the relative change of the sum that ends it.
    `told` gets half the sum of squares of each trial.
    """
    cache: dict[bytes, list[Vector]] = {}

    def residuals(z: Vector) -> list[Vector]:
        found = cache.get(z.tobytes())
        if found is None:
            cache.clear()
            found = cache[z.tobytes()] = criterion.residuals(z)
            if told is not None:
                told(0.5 * float(sum(np.sum((r * weights(len(r))) ** 2) for r in found)))
        return found

    def fun(z: Vector) -> Vector:
        return np.concatenate([(r * weights(len(r))).ravel() for r in residuals(z)])

    def jacobian(z: Vector) -> Vector:
        at = residuals(z)
        rows = criterion.derivatives(z, at)
        return np.concatenate([m * weights(len(r)) for m, r in zip(rows, at, strict=True)])

    low, high = criterion.bounds()
    first = criterion.begin() if begin is None else begin
    room = np.where(np.isfinite(high - low), 1e-9 * (high - low), 1e-12)
    first = np.clip(first, low + room, high - room)  # scipy wants to begin inside
    before = 0.5 * float(np.sum(fun(first) ** 2))
    found = least_squares(
        fun,
        first,
        jac=jacobian,
        bounds=(low, high),
        method="trf",
        x_scale=np.maximum(np.abs(first), 0.1),
        ftol=tolerance,
        xtol=1e-9,
        gtol=1e-12,
        max_nfev=steps,
    )
    after, converged = float(found.cost), found.status > 0
    return Descent(found.x, found.fun, np.asarray(found.jac), before, after, converged)
