"""Runs of loops through kinks and jumps, beside their explicit solutions."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from solve.logs import METHODS, TIGHT
from solve.models import run
from tracewire.errors import SimulationError

Vector = NDArray[np.float64]


@pytest.mark.parametrize("method", METHODS)
def test_a_saturated_feedback_is_the_saturation_of_a_quarter(method: str) -> None:
    """y = sat(7*sin(t) - 3*y) is 7/4*sin(t) within +-1."""
    text = """
span: [0, 7]
record: [x, y]
blocks:
  e: {type: expression, formula: 7*sin(t) - 3*y}
  y: {type: saturation, of: e, low: -1, high: 1}
  x: {type: integrator, of: y}
"""
    result = run(text, method=method, **TIGHT)
    assert result["y"] == pytest.approx(np.clip(7 / 4 * np.sin(result.t), -1, 1), abs=1e-12)
    kink = math.asin(4 / 7)
    exact = [kink, math.pi - kink, math.pi + kink, 2 * math.pi - kink, 2 * math.pi + kink]
    assert [event.time for event in result.events] == pytest.approx(exact, abs=1e-10)
    up = 7 / 4 * (1 - math.cos(kink)) * 2 + math.pi - 2 * kink  # a half wave
    half = int(np.argmin(np.abs(result.t - math.pi)))
    rest = 7 / 4 * (math.cos(result.t[half]) + 1)
    assert result["x"][half] == pytest.approx(up - rest, abs=1e-9)


def kinked(u: Vector) -> Vector:
    """The y of y = u - 0.5*abs(y) - 0.3*max(y, z), z = 0.2*y + 1, piece by piece."""
    low, middle, high = (u - 0.3) / 0.56, (u - 0.3) / 1.56, u / 1.8
    return np.where(u < 0.3, low, np.where(u < 2.25, middle, high))


@pytest.mark.parametrize("method", METHODS)
def test_a_loop_through_two_kinks_follows_its_pieces(method: str) -> None:
    text = """
span: [0, 6]
record: [y, z]
blocks:
  u: {type: integrator, of: rate, start: -1}
  rate: {type: expression, formula: 4*cos(t)}
  y: {type: expression, formula: "u - 0.5*abs(y) - 0.3*max(y, z)"}
  z: {type: expression, formula: "0.2*y + 1"}
  work: {type: integrator, of: y}
"""
    result = run(text, method=method, **TIGHT)
    u = -1 + 4 * np.sin(result.t)
    assert result["y"] == pytest.approx(kinked(u), abs=1e-8)
    assert result["z"] == pytest.approx(0.2 * kinked(u) + 1, abs=1e-8)
    first, second = math.asin(1.3 / 4), math.asin(3.25 / 4)
    exact = [first, second, math.pi - second, math.pi - first]
    assert [event.time for event in result.events] == pytest.approx(exact, abs=1e-9)


def test_a_state_in_a_saturated_loop_approaches_as_each_piece_says() -> None:
    """x' = y, y = sat(-x - 3*y): at -1 down to x = 4, then x = 4*exp(-(t - 2)/4)."""
    text = """
span: [0, 10]
record: [x, y]
blocks:
  x: {type: integrator, of: y, start: 6}
  e: {type: expression, formula: -x - 3*y}
  y: {type: saturation, of: e, low: -1, high: 1}
"""
    result = run(text, **TIGHT)
    exact = np.where(result.t < 2, 6 - result.t, 4 * np.exp(-(result.t - 2) / 4))
    assert result["x"] == pytest.approx(exact, abs=1e-9)
    assert [event.time for event in result.events] == pytest.approx([2], abs=1e-10)


def test_a_loop_through_a_jump_that_pulls_apart_keeps_its_side() -> None:
    """y = x + 2*sign(y) has two solutions within +-2: the one that is there goes on to x = 2."""
    text = """
span: [0, 8]
record: [x, y]
blocks:
  x: {type: integrator, of: one, start: -3}
  one: {type: constant, value: 1}
  y: {type: expression, formula: x + 2*sign(y)}
"""
    result = run(text, **TIGHT)
    exact = np.where(result.t < 5, result.t - 5, result.t - 1)
    away = np.abs(result.t - 5) > 1e-9
    assert result["y"][away] == pytest.approx(exact[away], abs=1e-12)
    assert [event.time for event in result.events] == pytest.approx([5], abs=1e-12)


def test_a_loop_that_loses_its_solution_on_the_way_is_refused_there() -> None:
    """y = x - 2*sign(y) has none within +-2, which x enters at t = 1."""
    text = """
span: [0, 4]
blocks:
  x: {type: integrator, of: one, start: -3}
  one: {type: constant, value: 1}
  y: {type: expression, formula: x - 2*sign(y)}
  z: {type: integrator, of: y}
"""
    said = r"block 'y': no consistent mode at t = 1 s: 'y' in y changes with its own mode.*jumps"
    with pytest.raises(SimulationError, match=said):
        run(text)


def test_a_loop_that_loses_its_solution_at_a_known_time_is_refused_too() -> None:
    """The guard y is a line in t, but its own mode moves it: it is no known time."""
    text = """
span: [0, 4]
blocks:
  y: {type: expression, formula: t - 3 - 2*sign(y)}
  z: {type: integrator, of: y}
"""
    with pytest.raises(SimulationError, match=r"block 'y': no consistent mode at t = 1 s"):
        run(text)
    with pytest.raises(SimulationError, match=r"block 'y': no consistent mode at t = 0 s"):
        run(text.replace("t - 3", "t - 0.5"))


def test_a_loop_without_a_solution_at_the_start_is_refused() -> None:
    text = """
blocks:
  x: {type: integrator, of: y, start: 0.5}
  y: {type: expression, formula: x - 2*sign(y)}
"""
    with pytest.raises(SimulationError, match=r"block 'y': no consistent mode at t = 0 s"):
        run(text)


@pytest.mark.parametrize(
    ("formula", "said"),
    [
        (
            "k*y + x",
            r"block 'y': .*not finite .*algebraic loop y -> y, .*gain round it is 1",
        ),
        ("y**2 + 1", r"recorded signal 'y' is not finite .*algebraic loop y -> y.*`guess:`"),
    ],
)
def test_a_loop_that_has_no_solution_says_so(formula: str, said: str) -> None:
    """The gain of the first one is a parameter, so that only a run can tell that it is 1."""
    rate = "y" if "k" in formula else "x"
    text = f"""
span: [0, 1]
record: [y]
parameters: {{k: 1}}
blocks:
  x: {{type: integrator, of: {rate}, start: 1}}
  y: {{type: expression, formula: {formula}}}
"""
    with pytest.raises(SimulationError, match=said):
        run(text)
