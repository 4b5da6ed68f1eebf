"""What random diagrams once broke at one instant, between two samples, or where a body lies."""

from __future__ import annotations

import numpy as np
import pytest
from solve.logs import METHODS, TIGHT
from solve.models import run


@pytest.mark.parametrize("method", METHODS)
def test_a_guard_that_jumps_with_the_reset_it_fired_fires_once(method: str) -> None:
    """The reset turns the rate of its guard, which looks like an impact. But a sign follows the
    reset and carries the guard far over its level. The next reset of the instant fired it again."""
    found = run(
        """
        span: [0, 2]
        blocks:
          u: {type: integrator, of: x, start: -1}
          x: {type: integrator, of: none, start: 1}
          c: {type: integrator, of: none}
          n: {type: integrator, of: none}
          none: {type: constant, value: 0}
          e: {type: sign, of: back}
          back: {type: gain, of: x, k: -1}
          g: {type: expression, formula: u + 1 + e}
        events:
          - {when: g, crosses: up, set: {x: -x, c: c + 1}}
          - {when: back, crosses: up, set: {u: u + 0.1, n: n + 1}}
        """,
        method=method,
    )
    assert found.final == pytest.approx({"u": -0.9, "x": -1, "c": 1, "n": 1}, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_guard_that_stands_where_it_arrived_has_fired_already(method: str) -> None:
    """The counter turns the rate of x, and then a reset at the same instant carries x on, from the
    level of the counter to above it. It counted twice."""
    found = run(
        """
        span: [0, 1.5]
        blocks:
          x: {type: integrator, of: a, start: -1}
          a: {type: gain, of: e, k: -1}
          c: {type: counter, of: x, threshold: 0}
          i: {type: expression, formula: c - 0.5}
          e: {type: sign, of: i}
          g: {type: expression, formula: c + 0.5*x - 0.5}
        events:
          - {when: g, crosses: up, set: {x: 0.7}}
        """,
        method=method,
    )
    assert found.final == pytest.approx({"x": 0.2, "c": 1}, abs=1e-9)


@pytest.mark.parametrize("ripple", ["", " + 0.3*x", " - 0.3*x", " + 0.01*t"])
@pytest.mark.parametrize("method", METHODS)
def test_guards_that_one_relay_carries_over_zero_fire_together(ripple: str, method: str) -> None:
    """All that is due at one instant reads the states before: the event reads a count of 0, whether
    its guard stands still beside the relay or moves."""
    text = f"""
span: [0, 2]
blocks:
  one: {{type: constant, value: -1}}
  nil: {{type: constant, value: 0}}
  x: {{type: integrator, of: one, start: 1}}
  z: {{type: integrator, of: nil, start: 1}}
  relay: {{type: sign, of: x}}
  pulse: {{type: expression, formula: 10 - 50*relay}}
  count: {{type: counter, of: pulse, threshold: 0}}
  guard: {{type: expression, formula: "-relay{ripple}"}}
events:
  - {{when: guard, crosses: up, set: {{z: -0.1*z + 5*count}}}}
"""
    result = run(text, method=method, **TIGHT)
    assert result.final["count"] == 1
    assert result.final["z"] == pytest.approx(-0.1, abs=1e-12)


BALL = """
span: [0, 3]
blocks:
  gravity: {{type: constant, value: -10}}
  v: {{type: integrator, of: gravity}}
  y: {{type: integrator, of: v}}
  bat: {{type: square, amplitude: 1, frequency: 0.5, phase: pi}}
events:
  - {{when: y, crosses: down, set: {{v: -0.5*v}}}}
  - {{when: "{when}", crosses: up, set: {{v: {v}}}}}
"""


@pytest.mark.parametrize("when", ["bat", "bat + 0.01*t", "bat + 0.01*sin(t)"])
@pytest.mark.parametrize("method", METHODS)
def test_a_body_at_rest_on_a_stop_flies_when_an_event_throws_it(when: str, method: str) -> None:
    """It lies still until t = 1, and is thrown with 5 m/s: 1.25 m high."""
    result = run(BALL.format(when=when, v=5), method=method, **TIGHT)
    assert np.max(np.abs(result["y"][result.t < 1])) == 0
    assert np.max(result["y"]) == pytest.approx(1.25, abs=1e-4)
    landing = [event.time for event in result.events if event.block == "events[0]"]
    assert landing[1] == pytest.approx(2.0, abs=1e-6)


@pytest.mark.parametrize("when", ["bat", "bat + 0.01*t", "bat + 0.01*sin(t)"])
@pytest.mark.parametrize("method", METHODS)
def test_a_body_at_rest_on_a_stop_rebounds_when_an_event_drives_it_in(
    when: str, method: str
) -> None:
    """Driven into the stop with 5 m/s it leaves with 2.5 m/s: 0.3125 m high."""
    result = run(BALL.format(when=when, v=-5), method=method, **TIGHT)
    assert np.min(result["y"]) > -1e-9
    assert np.max(result["y"]) == pytest.approx(0.3125, abs=1e-4)


@pytest.mark.parametrize("k", [1e2, 1e6, 1e10])
@pytest.mark.parametrize("method", METHODS)
def test_a_guard_that_dips_before_the_first_sample_of_a_step_crosses_twice(
    k: float, method: str
) -> None:
    """A body falls onto a spring of constant force k: it is thrown back within 2/k seconds."""
    text = f"""
span: [0, 3.5]
blocks:
  a: {{type: expression, formula: "-1 if x > 0 else {k}"}}
  v: {{type: integrator, of: a}}
  x: {{type: integrator, of: v, start: 0.5}}
"""
    result = run(text, method=method, **TIGHT)
    assert len(result.events) == 4
    since = 0.5 - 4 / k  # the last time that it left the spring, with a rate of 1
    assert result.final["x"] == pytest.approx(since - since**2 / 2, abs=1e-4)


def test_a_long_step_is_right_inside_too() -> None:
    """The states at the ends of the steps were right to 1e-8, those between them to 5e-7."""
    a, omega, phase = 2.3802578, 4.5886459, 1.5177235
    text = f"""
span: [0, 6]
blocks:
  x: {{type: integrator, of: f, start: 0.5}}
  f: {{type: expression, formula: "sin({omega}*t + {phase}) - {a}*x"}}
"""
    t = np.linspace(0, 6, 601)
    result = run(text, method="dop853", rtol=1e-8, times=t)
    angle = omega * t + phase
    driven = (a * np.sin(angle) - omega * np.cos(angle)) / (a**2 + omega**2)
    exact = driven + (0.5 - driven[0]) * np.exp(-a * t)
    assert np.max(np.abs(result["x"] - exact)) < 2e-7


@pytest.mark.parametrize("rate", [2e-311, 5e-324])
@pytest.mark.parametrize("method", METHODS)
def test_a_rate_at_the_end_of_the_numbers_is_one(rate: float, method: str) -> None:
    """Its tolerance was zero, and the state no number."""
    text = f"""
span: [0, 1]
blocks:
  r: {{type: constant, value: {rate}}}
  x: {{type: integrator, of: r}}
"""
    assert 0 <= run(text, method=method).final["x"] <= 2 * rate


@pytest.mark.parametrize("method", METHODS)
def test_a_body_that_is_struck_as_it_leaves_a_wall_meets_the_wall_again(method: str) -> None:
    """A first impact turns it, a blow at the same instant sends it back: without a second impact
    it would go through the wall."""
    found = run(
        """
        span: [0, 2]
        blocks:
          x: {type: integrator, of: v, start: 1}
          v: {type: integrator, of: none, start: -1}
          impacts: {type: integrator, of: none}
          blows: {type: integrator, of: none}
          none: {type: constant, value: 0}
          struck: {type: expression, formula: impacts - 0.5}
        events:
          - {when: x, crosses: down, set: {v: -0.5*v, impacts: impacts + 1}}
          - {when: struck, crosses: up, set: {v: -v, blows: blows + 1}}
        """,
        method=method,
    )
    assert found.final == pytest.approx({"x": 0.25, "v": 0.25, "impacts": 2, "blows": 1}, abs=1e-9)


@pytest.mark.parametrize("start", [0.9, -0.9])
@pytest.mark.parametrize("method", METHODS)
def test_the_floor_of_a_rate_that_friction_holds_is_that_of_zero(start: float, method: str) -> None:
    """Its guard is zero but for rounding. It stayed at -1 until another event."""
    found = run(
        f"""
        span: [0, 4]
        record: [whole, v]
        blocks:
          x: {{type: integrator, of: v}}
          v: {{type: integrator, of: a, start: {start}}}
          friction: {{type: coulomb, rate: v, level: 1}}
          a: {{type: expression, formula: friction + 0.5*sin(3*t)}}
          whole: {{type: expression, formula: floor(2*sin(v))}}
          other: {{type: sign, of: later}}
          later: {{type: expression, formula: t - 2.5}}
          y: {{type: integrator, of: other}}
        """,
        method=method,
    )
    held = next(event.time for event in found.events if event.kind == "stick")
    assert not np.any(found["v"][found.t > held])
    assert not np.any(found["whole"][found.t > held])


@pytest.mark.parametrize("method", METHODS)
def test_the_floor_of_what_nothing_holds_does_not_follow_a_friction(method: str) -> None:
    """0.57*100 is below 57 by rounding, and stays so where an unrelated body sticks."""
    found = run(
        """
        span: [0, 4]
        record: [whole]
        blocks:
          v: {type: integrator, of: friction, start: 1}
          friction: {type: coulomb, rate: v, level: 1}
          z: {type: integrator, of: none, start: 0.57}
          none: {type: constant, value: 0}
          whole: {type: expression, formula: floor(z*100)}
        """,
        method=method,
    )
    assert [event.kind for event in found.events] == ["stick"]
    assert set(found["whole"]) == {56.0}
