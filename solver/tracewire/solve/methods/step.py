"""What every method offers to the event loop: a step with an error estimate and a dense output."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


class Field(Protocol):
    """The smooth right-hand side between two events."""

    def rates(self, t: float, x: Vector) -> Vector:
        """dx/dt, shape (n,)."""

    def jacobian(self, t: float, x: Vector) -> tuple[Vector, Vector]:
        """d rates / dx, shape (n, n), and d rates / dt, shape (n,)."""


@dataclass(frozen=True, eq=False)
class Step:
    """A trial step from t to t + h: x at both ends, the rate at the end, error, inner polynomial.

    `inner` holds the coefficients of the method's dense output; `stiffness` estimates h times the
    largest eigenvalue (0 where the method does not say).
    """

    t: float
    h: float
    x: Vector
    x_end: Vector
    rate_end: Vector | None
    error: Vector
    inner: Vector
    stiffness: float = 0.0


class Method(Protocol):
    """A one-step method of order 5 with an error estimate of order 4."""

    def step(self, field: Field, t: float, x: Vector, rate: Vector, h: float) -> Step:
        """A trial step; entries may be NaN where the field is undefined."""

    def inside(self, step: Step, theta: float | Vector) -> Vector:
        """x (n,) at t + theta*h, theta in [0, 1]; (m, n) for theta of shape (m, 1)."""
