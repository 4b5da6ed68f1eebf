from __future__ import annotations

import math

import numpy as np
import pytest
from solve.models import kinds, one, run


def source(block: str, span: str = "[0, 3]") -> str:
    """The diagram of x' = a source."""
    return f"""
span: {span}
record: [u, x]
blocks:
  x: {{type: integrator, of: u}}
  u: {block}
"""


def test_a_square_wave_jumps_at_exact_times() -> None:
    result = run(source("{type: square, amplitude: 2, frequency: 0.8}"))
    times = np.arange(1, 5) * 0.625
    assert [event.time for event in result.events] == times.tolist()
    assert set(kinds(result)) == {"scheduled"}
    assert result["u"][0] == 2.0
    assert result["x"][-1] == pytest.approx(2 * 0.5)


def test_a_square_wave_whose_frequency_is_a_parameter() -> None:
    text = source("{type: square, amplitude: 1, frequency: {value: 1, unit: Hz}}")
    result = run(text, parameters={"u.frequency": 2.0})
    assert [event.time for event in result.events][:3] == [0.25, 0.5, 0.75]


def test_a_phase_moves_the_jumps() -> None:
    result = run(source("{type: square, amplitude: 1, frequency: 0.5, phase: -pi/2}", "[0, 2]"))
    assert result["u"][0] == -1.0
    assert [event.time for event in result.events] == pytest.approx([0.5, 1.5], abs=1e-15)


def test_a_step_is_hit_exactly() -> None:
    result = run(source("{type: step, height: 4, at: 0.7, offset: -1}"))
    [event] = result.events
    assert (event.time, event.kind, event.direction) == (0.7, "scheduled", "up")
    assert result["x"][-1] == pytest.approx(-0.7 + 3 * 2.3, rel=1e-14)


@pytest.mark.parametrize(("at", "first"), [(0.0, 4.0), (3.0, 0.0)])
def test_a_step_at_an_end_of_the_span(at: float, first: float) -> None:
    result = run(source(f"{{type: step, height: 4, at: {at}}}"))
    assert (result["u"][0], result["u"][-1]) == (first, 4.0)
    assert len(result.events) == (at > 0)


def test_a_ramp_bends_at_its_time() -> None:
    result = run(source("{type: ramp, slope: 2, at: 1.1}"), rtol=1e-4)
    assert [event.time for event in result.events] == [1.1]
    assert result["x"][-1] == pytest.approx((3 - 1.1) ** 2, rel=1e-14)


def test_the_points_of_a_table_end_steps_but_are_no_events() -> None:
    result = run(source("{type: table, points: [[0.5, 1], [0.7, 3], [2, -1]]}"), rtol=1e-4)
    assert result.events == ()
    exact = 0.5 + 0.2 * 2 + 1.3 * 1 - 1
    assert result["x"][-1] == pytest.approx(exact, rel=1e-13)


def test_a_measured_input_is_joined_by_straight_lines() -> None:
    text = """
span: [0, 2]
inputs: [u]
blocks: {x: {type: integrator, of: u}}
"""
    result = run(text, inputs={"u": ([0.0, 1.0, 2.0], [0.0, 2.0, 0.0])}, rtol=1e-4)
    assert result["x"][-1] == pytest.approx(2.0, rel=1e-13)


def test_meissner_is_the_product_of_two_rotations() -> None:
    """x'' = -(1 + 0.5 sgn sin 2t) x, with sgn sin(0+) = 1, over whole quarter periods."""
    text = """
span: [0, 20]
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  u: {type: square, amplitude: 0.5, frequency: 1/pi}
  a: {type: expression, formula: -(1 + u)*x}
"""
    result = run(text, rtol=1e-11, atol=1e-13)
    state, t, sign = np.array([1.0, 0.0]), 0.0, 1.0
    while t < 20:
        dt = min(math.pi / 2, 20 - t)
        w = math.sqrt(1 + 0.5 * sign)
        c, s = math.cos(w * dt), math.sin(w * dt)
        state = np.array([[c, s / w], [-w * s, c]]) @ state
        t, sign = t + dt, -sign
    assert [result.final["x"], result.final["v"]] == pytest.approx(state, rel=1e-8, abs=1e-8)
    assert [e.time for e in result.events] == pytest.approx(np.arange(1, 13) * math.pi / 2)


def test_many_scheduled_jumps_are_no_chatter() -> None:
    """60 jumps within 6e-7 of the span: each is known, so the run goes on."""
    result = run(one("1 - 2*mod(floor(2e8*min(t, 3e-7)), 2)"))
    assert kinds(result).count("scheduled") == 61
