"""Least squares on a criterion: scipy's trust region with forward sensitivities."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.residual.criterion import half_square
from tracewire.residual.limits import DESCENT


class LeastSquaresProblem(Protocol):
    """What least squares needs to know of a criterion, or of a search on one."""

    def bounds(self) -> tuple[Vector, Vector]: ...
    def vector(self, z: Vector) -> Vector: ...
    def vector_and_jacobian(self, z: Vector) -> tuple[Vector, Matrix]: ...


@dataclass(frozen=True, eq=False)
class LeastSquaresResult:
    """Where least squares ended: scaled unknowns, half the sum of squares there, whether it
    converged, and why it ended."""

    z: Vector
    cost: float
    converged: bool
    message: str


def solve_least_squares(
    criterion: LeastSquaresProblem,
    begin: Vector,
    *,
    steps: int = 30,
    tolerance: float = 1e-6,
    frugal: bool = True,
    callback: Callable[[Vector, float], None] | None = None,
) -> LeastSquaresResult:
    """Minimise half the sum of squares of the criterion's vector from `begin`, within the bounds.

    `steps` limits the trial steps, `tolerance` is the relative change of the sum that ends it. The
    first point costs one run with sensitivities, each trial a plain run, and each step one more
    with sensitivities. A `frugal` search spares those after a step that gained a tenth of the
    criterion: there the derivatives are corrected by what the step has shown (C. G. Broyden, Math.
    Comp. 19, 1965, 577); and it ends where it creeps along, and the noise would hide what it gains.
    `callback` gets each point from which a step is made, and its value.
    """
    from scipy.optimize import least_squares

    low, high = criterion.bounds()
    room = np.where(np.isfinite(high - low), 1e-9 * (high - low), 1e-12)
    z = np.clip(begin, low + room, high - room)  # scipy wants to begin inside
    jacobian = _Jacobian(criterion, z, frugal, callback)
    message, left = "", steps
    while len(z) and not message:
        # derivatives that were corrected may end it early: only true ones tell the end
        jacobian.refresh(z)
        jacobian.trials = 1
        least, was_frugal = jacobian.least, jacobian.frugal
        try:
            found = least_squares(
                jacobian.vector,
                z,
                jac=jacobian.step_jacobian,
                bounds=(low, high),
                method="trf",
                x_scale=np.maximum(np.abs(z), 0.1),
                ftol=tolerance,
                xtol=min(tolerance, 1e-9),
                gtol=1e-15,
                max_nfev=max(left, 1),
            )
        except _Stalled:
            z, message = jacobian.best, "converged: many steps have gained next to nothing"
            break
        except _Refreshed:  # a trust region that corrected derivatives have narrowed is of no use
            # of no use at all where the way to here was lost again: scipy begins off the bounds,
            # which a chaotic criterion feels more than such a step
            jacobian.frugal = frugal and not np.array_equal(jacobian.best, z)
            z, ended = jacobian.best, False
        else:
            z, ended = np.asarray(found.x), found.status > 0
        left -= jacobian.trials
        if ended and jacobian.is_true(z):
            message = "converged"
        elif not jacobian.least < least:
            if not was_frugal:
                message = "converged: no step lowers the criterion"
            jacobian.frugal = False  # only with true derivatives may one still be found
        elif left <= 0:
            message = f"stopped at the limit of {steps} steps"
    if half_square(jacobian.vector(z)) > jacobian.least:  # what is chaotic is lost by a rounding
        z = jacobian.best
    return LeastSquaresResult(
        z, half_square(jacobian.vector(z)), not message.startswith("stopped"), message
    )


class _Stalled(Exception):
    """Many steps have gained next to nothing."""


class _Refreshed(Exception):
    """There are true derivatives after corrected ones."""


class _Jacobian:
    """Vector and derivatives at the last points, each run once."""

    def __init__(
        self,
        criterion: LeastSquaresProblem,
        z: Vector,
        frugal: bool,
        callback: Callable[[Vector, float], None] | None,
    ) -> None:
        self.criterion, self.frugal, self.callback = criterion, frugal, callback
        self.at = (
            z.copy(),
            *criterion.vector_and_jacobian(z),
        )  # a point, its vector and the derivatives
        self.last = self.at[:2]
        self.is_fresh = True
        self.trials = 0
        self.values: list[float] = []
        self.best = np.empty(0)

    @property
    def least(self) -> float:
        """The least value at a point from which a step was made."""
        return self.values[-1] if self.values else np.inf

    def vector(self, z: Vector) -> Vector:
        """The criterion's vector."""
        if np.array_equal(self.at[0], z):
            return self.at[1]
        if not np.array_equal(self.last[0], z):
            self.last = z.copy(), self.criterion.vector(z)
            self.trials += 1
        return self.last[1]

    def refresh(self, z: Vector) -> None:
        """Have the true derivatives at a point."""
        if not self.is_true(z):
            self.at, self.is_fresh = (z.copy(), *self.criterion.vector_and_jacobian(z)), True

    def is_true(self, z: Vector) -> bool:
        """Whether the derivatives are the true ones at a point."""
        return self.is_fresh and np.array_equal(self.at[0], z)

    def step_jacobian(self, z: Vector) -> Matrix:
        """The derivatives from which the next step is made. Raises _Settled."""
        renewed = False
        if not np.array_equal(self.at[0], z):
            residual = self.vector(z)
            if self.frugal and half_square(residual) < DESCENT.fast * half_square(self.at[1]):
                self.at, self.is_fresh = _broyden_update(self.at, z, residual), False
            else:
                renewed = not self.is_fresh
                self.refresh(z)
        value = half_square(self.at[1])
        if value < self.least:
            self.values.append(value)
            self.best = z.copy()
            if self.callback is not None:
                self.callback(z, value)
        if self.frugal and len(self.values) > DESCENT.slow:
            gains = -np.diff(self.values[-1 - DESCENT.slow :]) * len(self.at[1])
            if gains.sum() < DESCENT.slow_gain * value and gains[-1] > DESCENT.steady * gains[0]:
                raise _Stalled
        if renewed:
            raise _Refreshed
        return self.at[2]


def _broyden_update(
    at: tuple[Vector, Vector, Matrix], z: Vector, residual: Vector
) -> tuple[Vector, Vector, Matrix]:
    """The derivatives with what the step to z has shown of them.

    The step is measured by how far each unknown alone moves the vector, so that the sizes in which
    unknowns are counted do not matter.
    """
    before, known, jacobian = at
    step = z - before
    surprise = residual - known - jacobian @ step
    weighed = np.sum(jacobian**2, axis=0) * step
    size = float(weighed @ step)
    if size > 0:
        jacobian = jacobian + np.outer(surprise, weighed) / size
    return z.copy(), residual, jacobian
