"""Slides whose grip falls through zero: the time at which they let go, and that of coupled ones."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.solve import simulate

BRAKE = """
span: [0, 6]
parameters: {A: 10, w: 2, p: 0, B: 0, F: 0.5}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  normal: {type: expression, formula: A*cos(w*t + p) + B}
  brake: {type: brake, rate: v, normal: normal, friction: 0.4}
  a: {type: expression, formula: brake + F}
"""
COUPLED = """
span: [0, 6]
parameters: {A: 10, w: 2, p: 0, B: 4, F: 0.5, C: 5, u: 1.3, q: 1}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  y: {type: integrator, of: z}
  z: {type: integrator, of: e}
  first: {type: expression, formula: A*cos(w*t + p) + B}
  second: {type: expression, formula: C*cos(u*t + q) + B}
  slip: {type: expression, formula: z - v}
  ground: {type: brake, rate: v, normal: first, friction: 0.4, stick: 0.5}
  between: {type: brake, rate: slip, normal: second, friction: 0.3}
  a: {type: expression, formula: ground - between + F - 3*(x - y)}
  e: {type: expression, formula: between - F*sin(3*t) + 3*(x - y)}
"""
RELAY = """
span: [0, {end}]
blocks:
  x: {{type: integrator, of: rate}}
  relay: {{type: sign, of: x}}
  rate: {{type: expression, formula: 0.5 - cos(t)*relay}}
"""


@settings(max_examples=60, deadline=None)
@given(st.floats(1, 20), st.floats(0.5, 5), st.floats(-1, 1), st.floats(-5, 10), st.floats(0.05, 1))
def test_a_brake_lets_go_where_it_cannot_hold_the_pull(
    A: float, w: float, p: float, B: float, F: float
) -> None:
    """0.4*(A cos(w t + p) + B) = F, where the run is longer than many turns of the cosine."""

    def margin(t: float) -> float:
        return 0.4 * max(A * math.cos(w * t + p) + B, 0.0) - F

    times = np.linspace(0, 6, 3001)
    later = [n for n, t in enumerate(times) if margin(t) < 0]
    assume(margin(0.0) > 1e-3 and later)
    expected = brentq(margin, times[later[0] - 1], times[later[0]], xtol=1e-13)
    run = simulate(compile(read_text(BRAKE)), parameters={"A": A, "w": w, "p": p, "B": B, "F": F})
    first = next(event.time for event in run.events if event.kind == "slip")
    assert first == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("method", ["dormand_prince", "dop853", "rosenbrock"])
@pytest.mark.parametrize("end", [1.0, 3.0, 6.0, 8.0, 30.0])
def test_when_a_brake_lets_go_is_no_matter_of_the_span(method: str, end: float) -> None:
    run = simulate(compile(read_text(BRAKE)), span=(0.0, end), method=method)
    first = next(event.time for event in run.events if event.kind == "slip")
    assert first == pytest.approx(math.acos(0.125) / 2, abs=1e-9)


@pytest.mark.parametrize(("A", "w", "G"), [(16.1734, 2.7778, 3.0), (14.6145, 2.3654, 1.0)])
def test_a_brake_that_begins_to_hold_at_nothing_lets_go_as_any(
    A: float, w: float, G: float
) -> None:
    """Where the run begins, the normal force and the pull are both zero."""
    text = BRAKE.replace("cos(", "sin(").replace("brake + F", "brake + F*sin(3*t)")
    run = simulate(compile(read_text(text)), parameters={"A": A, "w": w, "F": G}, rtol=1e-9)
    first = next(event.time for event in run.events if event.kind == "slip")
    exact = brentq(lambda t: 0.4 * A * math.sin(w * t) - abs(G * math.sin(3 * t)), 1, math.pi / w)
    assert first == pytest.approx(exact, abs=1e-9)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_two_brakes_of_coupled_bodies_let_go_as_with_short_steps(seed: int) -> None:
    rng = np.random.default_rng(seed)
    low = {"A": 1, "w": 0.5, "p": -3, "B": -5, "F": 0.05, "C": 1, "u": 0.5, "q": -3}
    high = {"A": 20, "w": 5, "p": 3, "B": 10, "F": 3, "C": 20, "u": 5, "q": 3}
    values = {name: rng.uniform(low[name], high[name]) for name in low}
    whole, short = (
        simulate(compile(read_text(text)), parameters=values, rtol=1e-9)
        for text in (COUPLED, f"max_step: 0.003\n{COUPLED}")
    )
    kinds = [[event.kind for event in run.events] for run in (whole, short)]
    assert kinds[0] == kinds[1]
    for state in "xyvz":
        assert whole[state][-1] == pytest.approx(short[state][-1], abs=1e-6)


@pytest.mark.parametrize("end", [2.0, 4.5, 9.0])
def test_a_relay_whose_gain_turns_lets_go_where_it_no_longer_holds(end: float) -> None:
    """x' = 0.5 - cos(t) sign(x) stays at 0 while cos(t) > 0.5."""
    run = simulate(compile(read_text(RELAY.format(end=end))), rtol=1e-9)
    assert np.all(run["x"][run.t < math.pi / 3 - 1e-9] == 0)
    after = run.t > math.pi / 3
    t = run.t[after]
    exact = 0.5 * (t - math.pi / 3) - (np.sin(t) - math.sin(math.pi / 3))
    away = t < 4.4  # back at 0 later
    assert run["x"][after][away] == pytest.approx(exact[away], abs=1e-7)
