from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import OdeSolution, solve_ivp
from tracewire.solve.methods import DormandPrince, Method, Rosenbrock, Step

Vector = NDArray[np.float64]
BEGIN = np.array([1.0, 0.5])
METHODS = [DormandPrince(), Rosenbrock()]


class Twisted:
    """x' = x*y*cos(t), y' = 1/x - y + 2*sin(t): nonlinear, and it reads the time."""

    def rates(self, t: float, x: Vector) -> Vector:
        return np.array([x[0] * x[1] * math.cos(t), 1 / x[0] - x[1] + 2 * math.sin(t)])

    def jacobian(self, t: float, x: Vector) -> tuple[Vector, Vector]:
        c = math.cos(t)
        matrix = np.array([[x[1] * c, x[0] * c], [-1 / x[0] ** 2, -1.0]])
        return matrix, np.array([-x[0] * x[1] * math.sin(t), 2 * c])


@cache
def solution() -> OdeSolution:
    """An independent solution of it, to rounding."""
    found = solve_ivp(
        Twisted().rates, (0, 2), BEGIN, "DOP853", dense_output=True, rtol=3e-14, atol=1e-15
    )
    return found.sol


def exact(t: float) -> Vector:
    return np.asarray(solution()(t))


class Decay:
    """x' = -a*(x - cos(t)) - sin(t), with the smooth solution cos(t)."""

    def __init__(self, a: float) -> None:
        self.a = a

    def rates(self, t: float, x: Vector) -> Vector:
        return -self.a * (x - math.cos(t)) - math.sin(t)

    def jacobian(self, t: float, x: Vector) -> tuple[Vector, Vector]:
        return np.array([[-self.a]]), np.array([-self.a * math.sin(t) - math.cos(t)])


def taken(method: Method, count: int) -> list[Step]:
    field, x, steps = Twisted(), exact(0.0), []
    h = 2.0 / count
    for k in range(count):
        step = method.step(field, k * h, x, field.rates(k * h, x), h)
        steps.append(step)
        x = step.x_end
    return steps


def order(errors: list[float]) -> float:
    return math.log2(errors[0] / errors[1])


@pytest.mark.parametrize("method", METHODS)
def test_the_order_of_a_step_is_five(method: Method) -> None:
    errors = [float(abs(taken(method, n)[-1].x_end - exact(2.0)).max()) for n in (20, 40)]
    assert 4.6 < order(errors) < 6.5


@pytest.mark.parametrize("method", METHODS)
def test_the_dense_output_is_of_order_four(method: Method) -> None:
    errors = []
    for count in (10, 20):
        worst = 0.0
        for step in taken(method, count):
            for theta in (0.2, 0.5, 0.8):
                off = method.inside(step, theta) - exact(step.t + theta * step.h)
                worst = max(worst, float(abs(off).max()))
        errors.append(worst)
    assert order(errors) > 3.7


@pytest.mark.parametrize("method", METHODS)
def test_the_dense_output_meets_both_ends(method: Method) -> None:
    step = taken(method, 8)[3]
    assert method.inside(step, 0.0) == pytest.approx(step.x, rel=1e-14)
    assert method.inside(step, 1.0) == pytest.approx(step.x_end, rel=1e-14)


@pytest.mark.parametrize("method", METHODS)
def test_many_points_inside_a_step_at_once(method: Method) -> None:
    step = taken(method, 4)[1]
    thetas = np.array([0.1, 0.4, 0.9])
    rows = method.inside(step, thetas[:, np.newaxis])
    assert rows == pytest.approx(np.array([method.inside(step, float(th)) for th in thetas]))


@pytest.mark.parametrize("method", METHODS)
def test_the_error_estimate_is_of_order_four(method: Method) -> None:
    errors = []
    for h in (0.2, 0.1):
        x = exact(0.5)
        step = method.step(Twisted(), 0.5, x, Twisted().rates(0.5, x), h)
        errors.append(float(abs(step.error).max()))
    assert 4.0 < order(errors) < 6.5


def test_the_stiff_method_swallows_a_fast_decay() -> None:
    field = Decay(1e8)
    x = np.array([1.5])
    step = Rosenbrock().step(field, 0.0, x, field.rates(0.0, x), 0.1)
    assert step.x_end[0] == pytest.approx(math.cos(0.1), abs=1e-4)


def test_the_explicit_method_feels_stiffness() -> None:
    field = Decay(1000.0)
    x = np.array([1.0])
    step = DormandPrince().step(field, 0.0, x, field.rates(0.0, x), 3.3e-3)
    assert step.stiffness == pytest.approx(3.3, rel=0.05)


@pytest.mark.parametrize("method", METHODS)
def test_an_undefined_rate_gives_a_step_that_is_not_finite(method: Method) -> None:
    class Undefined(Decay):
        def rates(self, t: float, x: Vector) -> Vector:
            return np.full(1, math.nan)

    step = method.step(Undefined(1.0), 0.0, np.ones(1), np.full(1, math.nan), 0.1)
    assert not np.isfinite(step.error).any()
