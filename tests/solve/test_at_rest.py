"""A comparison of what rests at zero: it says there what it says of zero."""

from __future__ import annotations

import pytest
from solve.logs import METHODS
from solve.models import run

AT_ZERO = {">": 0.0, ">=": 1.0, "<": 0.0, "<=": 1.0}
REVERSED = {">": "<", ">=": "<=", "<": ">", "<=": ">="}

HELD = """
span: [0, 3]
blocks:
  x: {{type: integrator, of: v}}
  v: {{type: integrator, of: a, start: {start}}}
  friction: {{type: dry_friction, rate: v, slip: 1, stick: 1}}
  a: {{type: sum, of: [friction]}}
  y: {{type: expression, formula: "1 if {comparison} else 0"}}
  time: {{type: integrator, of: y}}
record: [y]
"""


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("start", [1, -1])
@pytest.mark.parametrize("signal", ["{v} {relation} 0", "2*v {relation} 0", "0 {reversed} 3*v"])
@pytest.mark.parametrize("relation", AT_ZERO)
def test_a_body_that_friction_holds_has_a_rate_of_zero(
    relation: str, signal: str, start: int, method: str
) -> None:
    """It slides for 1 s and is held for 2 s. As it came, the rate of a body that had moved forwards
    was below zero while it was held, and the comparison of the rate itself was a fraction."""
    comparison = signal.format(v="v", relation=relation, reversed=REVERSED[relation])
    found = run(HELD.format(start=start, comparison=comparison), method=method)
    slides = float((start > 0) == (relation in (">", ">=")))
    assert found["y"][0] == slides
    assert found["y"][-1] == AT_ZERO[relation]
    assert found.final["time"] == pytest.approx(slides + 2 * AT_ZERO[relation], abs=1e-9)


@pytest.mark.parametrize("start", [-2, 1])
@pytest.mark.parametrize("relation", AT_ZERO)
def test_a_state_that_a_clock_sets_to_zero_is_zero(relation: str, start: int) -> None:
    """It rises by 1 in the first second, and a clock sets it to zero at 2 s, where it stays."""
    found = run(
        f"""
        span: [0, 3]
        blocks:
          u: {{type: expression, formula: "1 if t < 1 else 0"}}
          x: {{type: integrator, of: u, start: {start}}}
          y: {{type: expression, formula: "1 if x {relation} 0 else 0"}}
          time: {{type: integrator, of: y}}
        events:
          - {{every: 2, offset: 2, set: {{x: 0}}}}
        record: [y]
        """
    )
    before = 2.0 * float((start > 0) == (relation in (">", ">=")))
    assert found["y"][-1] == AT_ZERO[relation]
    assert found.final["time"] == pytest.approx(before + AT_ZERO[relation], abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("of", ["t", "x"])
@pytest.mark.parametrize("relation", AT_ZERO)
def test_a_rectified_signal_is_zero_between_its_waves(relation: str, of: str, method: str) -> None:
    """max(0, 1 - t) and min(0, t - 1), of the time and of a state that grows like it."""
    found = run(
        f"""
        span: [0, 3]
        blocks:
          one: {{type: constant, value: 1}}
          x: {{type: integrator, of: one}}
          falls: {{type: expression, formula: "max(0, 1 - {of})"}}
          rises: {{type: expression, formula: "min(0, {of} - 1)"}}
          y: {{type: expression, formula: "1 if falls {relation} 0 else 0"}}
          z: {{type: expression, formula: "1 if rises {relation} 0 else 0"}}
          y_time: {{type: integrator, of: y}}
          z_time: {{type: integrator, of: z}}
        record: [y, z]
        """,
        method=method,
    )
    upwards, at_zero = float(relation in (">", ">=")), AT_ZERO[relation]
    assert (found["y"][-1], found["z"][-1]) == (at_zero, at_zero)
    assert found.final["y_time"] == pytest.approx(upwards + 2 * at_zero, abs=1e-9)
    assert found.final["z_time"] == pytest.approx(1 - upwards + 2 * at_zero, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_comparisons_that_are_a_law_slide_and_others_of_the_same_guard_with_them(
    method: str,
) -> None:
    """A heater without hysteresis, by hand: it is on for the part of the time in which its 5 K/s
    balance the loss of 2 K/s, and a meter that compares the same is on for that part, too."""
    found = run(
        """
        span: [0, 3]
        blocks:
          kelvin: {type: integrator, of: rate, start: 20}
          heats: {type: expression, formula: "5 if kelvin < 23 else 0"}
          rate: {type: expression, formula: heats - 2}
          meter: {type: expression, formula: "1 if kelvin < 23 else 0"}
          on: {type: integrator, of: meter}
        record: [meter]
        """,
        method=method,
    )
    assert found["meter"][-1] == pytest.approx(0.4, abs=1e-12)
    assert found.final == pytest.approx({"kelvin": 23, "on": 1 + 2 * 0.4}, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_the_sign_of_zero_is_zero(method: str) -> None:
    """A body that friction holds after 1 s, a rectified signal, and what has never moved."""
    found = run(
        """
        span: [0, 3]
        blocks:
          v: {type: integrator, of: friction, start: 1}
          friction: {type: dry_friction, rate: v, slip: 1, stick: 1}
          way: {type: sign, of: v}
          off: {type: expression, formula: "sign(max(0, 1 - t))"}
          x: {type: integrator, of: u}
          u: {type: integrator, of: a}
          s: {type: sign, of: x}
          a: {type: gain, of: s, k: -1}
          way_sum: {type: integrator, of: way}
          off_sum: {type: integrator, of: off}
        record: [way, off, s]
        """,
        method=method,
    )
    assert [found[name][-1] for name in ("way", "off", "s")] == [0.0, 0.0, 0.0]
    values = {"v": 0, "x": 0, "u": 0, "way_sum": 1, "off_sum": 1}
    assert found.final == pytest.approx(values, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_comparison_leaves_zero_with_its_signal(method: str) -> None:
    """A body that friction holds is pushed off at 2 s, and a counter counts that it moves."""
    found = run(
        """
        span: [0, 4]
        blocks:
          v: {type: integrator, of: a, start: 1}
          friction: {type: dry_friction, rate: v, slip: 1, stick: 1}
          push: {type: expression, formula: "0 if t < 2 else 3"}
          a: {type: sum, of: [friction, push]}
          moves: {type: expression, formula: "1 if v > 0 else 0"}
          time: {type: integrator, of: moves}
          starts: {type: counter, of: moves, threshold: 0.5}
        """,
        method=method,
    )
    assert found.final == pytest.approx({"v": 4, "time": 3, "starts": 1}, abs=1e-8)
