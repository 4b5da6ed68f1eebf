"""Lyapunov exponents that are known: linear, mapped, with impacts, and Lorenz."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from analyse.models import DRY, IMPACTS, LORENZ, MEISSNER, OSCILLATOR, SAW, made
from tracewire.analyse import floquet, lyapunov
from tracewire.errors import AnalysisError, OptionError, SimulationError

NODE = """
span: [0, 10]
blocks:
  x: {type: integrator, of: a, start: 1}
  y: {type: integrator, of: b, start: 1}
  a: {type: expression, formula: -0.5*x + 3*y}
  b: {type: expression, formula: -2*y}
"""


def test_a_linear_node_has_its_eigenvalues() -> None:
    found = lyapunov(made(NODE), 100, interval=1.0, transient=20, rtol=1e-9)
    assert found.exponents == pytest.approx([-0.5, -2.0], abs=1e-5)
    assert found.divergence == pytest.approx(-2.5)
    assert found.total == pytest.approx(-2.5, abs=1e-6)
    assert (found.positive, found.dimension) == (0, 0.0)
    assert found.running[-1] == pytest.approx(found.exponents)
    assert found.running.shape == (100, 2)


def test_a_spiral_shares_its_damping() -> None:
    found = lyapunov(made(OSCILLATOR), 400, parameters={"c": 0.2})
    assert np.abs(found.exponents + 0.1).max() < 4 * found.errors.max()
    assert found.total == pytest.approx(-0.2, abs=1e-5)


def test_the_exponents_of_lorenz() -> None:
    found = lyapunov(made(LORENZ), 300, transient=20, seed=1)
    known = np.array([0.9056, 0.0, -14.5723])
    assert (np.abs(found.exponents - known) < 4 * found.errors + 0.01).all()
    assert (found.errors < 0.05).all()
    assert found.total == pytest.approx(-(10 + 1 + 8 / 3), rel=1e-4)  # the sum rule
    assert found.divergence == pytest.approx(-(10 + 1 + 8 / 3), rel=1e-9)
    assert found.positive == 1
    assert found.dimension == pytest.approx(2.062, abs=0.01)


def test_a_saw_doubles_deviations_once_a_second() -> None:
    """y -> 2y mod 1 whenever x, which grows by 1 each second, begins anew: ln 2, and 0 along it."""
    found = lyapunov(made(SAW), 200, interval=0.7)
    assert found.exponents == pytest.approx([math.log(2), 0], abs=0.02)
    assert found.divergence is None  # the field is not smooth
    three = lyapunov(made(SAW), 200, interval=0.7, parameters={"slope": 3})
    assert three.exponents == pytest.approx([math.log(3), 0], abs=0.02)


def test_a_ball_loses_its_restitution_at_each_impact() -> None:
    """Deviations in both directions shrink by r each half swing, pi/2 s, by the saltation alone."""
    found = lyapunov(made(IMPACTS), 120, interval=0.9, parameters={"restitution": 0.9}, rtol=1e-9)
    rate = math.log(0.9) / (math.pi / 2)
    assert found.total == pytest.approx(2 * rate, abs=2e-3)
    assert (np.abs(found.exponents - rate) < 5 * found.errors + 2e-3).all()


def test_a_switched_field_has_the_exponents_of_its_multipliers() -> None:
    exponents = floquet(made(MEISSNER), "2*pi/omega").exponents.real
    found = lyapunov(made(MEISSNER), 100 * math.pi, interval=math.pi, transient=10 * math.pi)
    assert found.exponents == pytest.approx(exponents, abs=1e-3)
    assert found.divergence == pytest.approx(0.0, abs=1e-12)


def test_a_body_that_sticks_loses_a_direction() -> None:
    found = lyapunov(made(DRY), 10, interval=0.1)
    assert found.exponents[0] == pytest.approx(0.0, abs=1e-9)
    assert found.exponents[1] == -math.inf
    assert np.isnan(found.errors[1])
    assert found.divergence is None


def test_the_first_exponents_alone() -> None:
    found = lyapunov(made(LORENZ), 100, transient=10, count=1)
    assert found.exponents.shape == found.errors.shape == (1,)
    assert found.running.shape[1] == 1
    assert found.divergence is None


def test_the_same_seed_gives_the_same_numbers_and_progress_ends_with_all() -> None:
    told: list[float] = []
    first = lyapunov(made(LORENZ), 50, seed=3, progress=lambda part, _: told.append(part))
    second = lyapunov(made(LORENZ), 50, seed=3)
    assert np.array_equal(first.running, second.running)
    assert told[-1] == pytest.approx(1.0, abs=0.03)


@pytest.mark.parametrize(
    ("length", "options", "said"),
    [
        (10, {"interval": 1.0}, "10 s with intervals of 1 s are too few to average"),
        (-1, {}, "are too few to average. Give 40 intervals"),
        (10, {"interval": 0.0}, "are too few to average"),
        (10, {"count": 4}, "4 exponents of a model with 3 states"),
        (10, {"count": 0}, "0 exponents of a model"),
        (10, {"transient": -1}, "a transient of -1 s has no use"),
        (10, {"method": "rk4"}, "unknown method 'rk4'"),
    ],
)
def test_what_does_not_fit_is_refused(length: float, options: Any, said: str) -> None:
    with pytest.raises(OptionError, match=said):
        lyapunov(made(LORENZ), length, **options)


def test_deviations_without_bound_are_told() -> None:
    steep = made("span: [0, 1]\nblocks:\n  x: {type: integrator, of: r}\n"
                 "  r: {type: expression, formula: 400*x}\n")  # fmt: skip
    with pytest.raises((AnalysisError, SimulationError), match=r"without bound|not finite"):
        lyapunov(steep, 100, interval=2.0)
