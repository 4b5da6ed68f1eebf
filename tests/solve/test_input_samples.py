"""What happens at the samples of an input: nothing but what the diagram says."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from solve.logs import METHODS, TIGHT, when
from solve.models import kinds, made, run
from tracewire.solve import Held, Run, simulate

Vector = NDArray[np.float64]

DRIVEN = """
span: [0, 4]
inputs: [u]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  friction: {type: coulomb, rate: v, level: {value: 0.3}}
  spring: {type: stiffness, of: x, k: {value: 2}}
  relay: {type: expression, formula: 0.1*sign(u - 0.5) + 0.2*sign(x - 0.05)}
  a: {type: sum, of: [u, spring, friction, relay]}
record: [x, v, relay]
"""
SENSITIVITIES = ("friction.level", "spring.k", "start.x")
model = made(DRIVEN)


def driven(times: Vector, values: Vector, method: str = "dormand_prince") -> Run:
    """The body under friction, driven by an input with these samples."""
    inputs = {"u": (times, values)}
    return simulate(model, inputs=inputs, method=method, sensitivities=SENSITIVITIES, **TIGHT)


@settings(max_examples=25, deadline=None)
@given(values=st.lists(st.sampled_from([-1.5, -0.4, 0.0, 0.5, 0.8, 1.5]), min_size=5, max_size=5))
@example(values=[0.0, 0.0, -1.5, -1.5, -1.5])  # its push just reaches the friction, for 1 s
@example(values=[0.0, 0.0, 1.5, 0.5, 0.5])
def test_samples_on_a_line_between_others_change_nothing(values: list[float]) -> None:
    """1 s between samples, and 1/64 s with the same lines, where values and levels are exact."""
    few = np.arange(5.0)
    many = np.arange(257.0) / 64
    one = driven(few, np.array(values))
    other = driven(many, np.interp(many, few, values))
    assert kinds(other) == kinds(one)
    assert when(other) == pytest.approx(when(one), abs=1e-7)
    for name in one.signals:
        assert other[name] == pytest.approx(one[name], abs=1e-7)


@pytest.mark.parametrize("method", METHODS)
def test_sensitivities_do_not_see_the_samples_of_a_line(method: str) -> None:
    few, many = np.array([0.0, 4.0]), np.arange(401.0) / 100
    one = driven(few, np.array([-1.0, 2.0]), method)
    other = driven(many, np.interp(many, few, [-1.0, 2.0]), method)
    assert len(one.events) > 2
    for name in SENSITIVITIES:
        for signal in ("x", "v"):
            exact = one.sensitivities[name][signal]
            assert other.sensitivities[name][signal] == pytest.approx(exact, abs=1e-5)


@pytest.mark.parametrize("method", METHODS)
def test_an_input_that_is_zero_at_a_sample_switches_there_once(method: str) -> None:
    """u = 1 - t: x' = sign(u) is at its top where u is zero."""
    text = """
span: [0, 2]
inputs: [u]
blocks:
  x: {type: integrator, of: rate}
  rate: {type: expression, formula: sign(u)}
"""
    t = np.arange(0.0, 2.25, 0.25)
    result = run(text, inputs={"u": (t, 1.0 - t)}, method=method)
    assert when(result) == [1.0]
    assert result["x"].max() == pytest.approx(1.0, abs=1e-12)
    assert result["x"][-1] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_a_state_that_reaches_a_level_at_a_sample_switches_there_once(method: str) -> None:
    """x = t is 1 where the input has a sample: from there on y falls as it rose."""
    text = """
span: [0, 2]
inputs: [u]
blocks:
  x: {type: integrator, of: u}
  y: {type: integrator, of: rate}
  rate: {type: expression, formula: sign(1 - x)}
"""
    t = np.arange(0.0, 2.25, 0.25)
    result = run(text, inputs={"u": (t, np.ones(len(t)))}, method=method)
    assert when(result) == pytest.approx([1.0], abs=1e-12)
    assert result["y"][-1] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_a_held_input_carries_a_switch_over_its_level(method: str) -> None:
    """u jumps over 0.5 at 1 s and back at 2 s: x' = sign(u - 0.5) is 1 for one of three seconds."""
    text = """
span: [0, 3]
inputs: [u]
blocks:
  x: {type: integrator, of: rate}
  rate: {type: expression, formula: sign(u - 0.5)}
"""
    t, u = [0.0, 0.5, 1.0, 1.5, 2.0, 2.5], [0.0, 0.2, 0.9, 0.7, 0.1, 0.3]
    result = run(text, inputs={"u": Held(t, u)}, method=method)
    assert result["x"][-1] == pytest.approx(-1.0, abs=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_a_body_that_is_held_slips_where_the_lines_of_an_input_say(method: str) -> None:
    """A push of t/2 in lines of 0.01 s, against a friction of 0.3: it slips at 0.6 s."""
    text = """
span: [0, 1]
inputs: [u]
blocks:
  v: {type: integrator, of: a}
  friction: {type: coulomb, rate: v, level: {value: 0.3}}
  a: {type: sum, of: [u, friction]}
"""
    t = np.arange(101.0) / 100
    result = run(text, inputs={"u": (t, t / 2)}, method=method)
    assert when(result) == pytest.approx([0.6], abs=1e-9)
    assert result["v"][-1] == pytest.approx(0.25 * (1 - 0.36) - 0.3 * 0.4, abs=1e-6)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_push_that_just_reaches_friction_moves_nothing(sign: float, method: str) -> None:
    """It equals the friction from the start on; from 1.5 s on it grows, and the body slips."""
    text = """
span: [0, 2]
inputs: [u]
blocks:
  v: {type: integrator, of: a}
  friction: {type: coulomb, rate: v, level: {value: 0.375}}
  a: {type: sum, of: [u, friction]}
"""
    t = np.arange(0.0, 2.25, 0.25)
    push = sign * (0.375 + np.maximum(t - 1.5, 0.0))
    slips = run(text, inputs={"u": (t, push)}, method=method)
    assert kinds(slips) == ["slip"]
    assert when(slips) == pytest.approx([1.5], abs=1e-9)
    assert slips["v"][-1] == pytest.approx(sign * 0.125, abs=1e-9)
    rests = run(text, inputs={"u": (t, sign * np.minimum(0.375, 2.0 - t))}, method=method)
    assert not rests.events
    assert np.all(rests["v"] == 0.0)


SAMPLED = """
span: [0, 1]
inputs: [u]
parameters: {T: 0.01}
blocks:
  direct: {type: gain, of: u, k: 1}
  taken: {type: zero_order_hold, of: direct, period: T}
  late: {type: unit_delay, of: u, period: T}
  x: {type: integrator, of: u}
record: [direct, taken, late, x]
"""
sampled = made(SAMPLED)


@pytest.mark.parametrize("method", METHODS)
@settings(max_examples=15, deadline=None)
@given(T=st.floats(1e-3, 10.0), first=st.integers(-3, 3))
@example(T=0.01, first=1)
@example(T=0.02, first=1)
def test_a_clock_that_ticks_with_the_samples_of_a_held_input_takes_them(
    method: str, T: float, first: int
) -> None:
    """A controller that is recorded at its own ticks has acted on the values of the same rows; a
    sample of the run at such a time has the value of its row, too."""
    rows = np.arange(12.0)
    values = first + rows**2
    found = simulate(
        sampled,
        times=T * rows,
        inputs={"u": Held(T * rows, values)},
        parameters={"T": T},
        method=method,
    )
    assert found["direct"].tolist() == values.tolist()
    assert found["taken"] == pytest.approx(values, abs=1e-9)
    assert found["late"][2:] == pytest.approx(values[1:-1], abs=1e-9)
    moved = T * np.cumsum(np.r_[0.0, values[:-1]])
    assert found["x"] == pytest.approx(moved, rel=1e-9, abs=1e-9 * T)
