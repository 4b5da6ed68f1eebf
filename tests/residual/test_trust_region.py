"""Least squares ends where no step lowers the criterion, also where rounding decides."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from tracewire.residual import solve_least_squares

Vector = NDArray[np.float64]


class Chaotic:
    """A criterion that a rounding of its unknowns changes by half, as a run that is chaotic.

    It falls towards the lower bound, off which scipy begins each time.
    """

    def __init__(self) -> None:
        self.evaluations = 0
        self.least = np.inf

    def bounds(self) -> tuple[Vector, Vector]:
        return np.full(10, 10.0), np.full(10, 10.5)

    def vector(self, z: Vector) -> Vector:
        self.evaluations += 1
        found = np.concatenate([z - 9.0 + 0.3 * np.sin(1e13 * z), np.ones(5)])
        self.least = min(self.least, 0.5 * float(found @ found))
        return np.asarray(found)

    def vector_and_jacobian(self, z: Vector) -> tuple[Vector, NDArray[np.float64]]:
        return self.vector(z), np.eye(15, 10)


@pytest.mark.parametrize("frugal", [True, False])
@pytest.mark.parametrize("begin", [10.0, 10.1, 10.5])
def test_a_chaotic_criterion_ends_the_search_soon(begin: float, frugal: bool) -> None:
    """It went on from one point to the next until all evaluations were spent."""
    problem = Chaotic()
    found = solve_least_squares(problem, np.full(10, begin), steps=100_000, frugal=frugal)
    assert problem.evaluations < 1000
    assert found.converged
    assert found.cost <= 0.5 * float(np.sum(Chaotic().vector(np.full(10, begin)) ** 2))
