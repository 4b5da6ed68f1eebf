"""What random diagrams with plays and stops once broke, shrunk to what matters."""

from __future__ import annotations

import numpy as np
import pytest
from solve.logs import METHODS, TIGHT
from solve.models import run


@pytest.mark.parametrize("method", METHODS)
def test_a_play_turns_round_while_a_friction_holds_elsewhere(method: str) -> None:
    """At 2 the rate is zero, and only the second derivative says that the play lets go: on a slide
    it was not known, and the play went round in a circle."""
    text = """
span: [0, 3]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a, start: 1}
  w: {type: integrator, of: b, start: 1}
  slip: {type: sum, of: [v, -w]}
  friction: {type: dry_friction, rate: slip, slip: 1, stick: 1}
  a: {type: expression, formula: friction - 1}
  b: {type: expression, formula: -friction}
  play: {type: play_operator, of: x, rate: v, width: 0.2}
record: [x, play]
"""
    result = run(text, method=method, times=[0.05, 1.0, 2.5, 3.0], **TIGHT)
    assert result["x"] == pytest.approx([0.049375, 0.75, 0.9375, 0.75], abs=1e-9)
    assert result["play"] == pytest.approx([0.0, 0.65, 0.9, 0.85], abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rtol", [1e-8, 1e-10])
def test_friction_does_not_hold_a_body_that_a_stop_holds(method: str, rtol: float) -> None:
    """As it came: both were to hold it, and what rounding left of 0/0 was taken for a force."""
    text = """
span: [0, 2.484852041652523]
blocks:
  a: {type: expression, formula: "-0.5982413443174957*s.x - 0.6654722181769388*s.v
      + 0.0002666434304536563*z - 7.531716005260034e-06 + 2.0975850606525415e-11*e"}
  z: {type: integrator, of: b, start: -0.007825786548181873}
  b: {type: expression, formula: -0.4671103069895821*z}
  s: {type: hard_stop, force: a, high: 2.379659036159396e-06, low: -3.620526817749215e-06,
      restitution: 0.05, start: -9.37828091998475e-07, start_rate: 7.1643965125737806e-06}
  e: {type: dry_friction, rate: s.v, slip: 136292.89704198792, stick: 214055.9509887871}
"""
    result = run(text, method=method, rtol=rtol)
    assert result.final["s.x"] == pytest.approx(-3.620526817749215e-06, rel=1e-9)
    assert result.final["s.v"] == 0.0


@pytest.mark.parametrize("gear", ["3", "gear"])
@pytest.mark.parametrize("stick", [0.4, 0.55])
def test_a_play_behind_a_gear_stays_where_friction_holds_the_body(gear: str, stick: float) -> None:
    """The rate that the play reads is another guard than that of the friction, zero with it.

    The play is at rest while the body is, and follows it over its turning points.
    """
    found = run(
        f"""
        span: [0, 10]
        record: [x, v, e]
        parameters: {{gear: 3}}
        blocks:
          x: {{type: integrator, of: v, start: 0.5}}
          v: {{type: integrator, of: a, start: -1.74}}
          a: {{type: expression, formula: -5*x - 0.4*v + f}}
          f: {{type: dry_friction, rate: v, slip: 0.4, stick: {stick}}}
          i: {{type: expression, formula: {gear}*x}}
          r: {{type: expression, formula: {gear}*v}}
          e: {{type: play_operator, of: i, rate: r, width: 0.156, start: 1.5}}
        """,
        rtol=1e-9,
    )
    driven = 1.5
    for x in found["x"]:  # the operator itself, from sample to sample: x turns between few of them
        driven = float(np.clip(driven, 3 * x - 0.078, 3 * x + 0.078))
    assert found["v"][-1] == pytest.approx(0.0, abs=1e-12)
    assert found["e"][-1] == pytest.approx(driven, abs=1e-4)


@pytest.mark.parametrize("method", METHODS)
def test_a_play_in_far_units_follows_a_body_until_friction_holds_it(method: str) -> None:
    """Where v comes to rest, its rounding is 1e-5 m/s, and the gear shows 1e-16 of that as a rate
    below zero."""
    for rtol in np.logspace(-6, -10, 17):
        found = run(
            """
            span: [0, 0.0006]
            blocks:
              x: {type: integrator, of: v, start: -2.0558692122843503e+06}
              v: {type: integrator, of: a, start: -9.024394666597225e+11}
              a: {type: expression, formula: "-194047412.463*x - 364.085254*v + 11162436028339*f"}
              i: {type: gain, of: x, k: 6.344361073914672e-12}
              r: {type: gain, of: v, k: 6.344361073914672e-12}
              e: {type: play_operator, of: i, rate: r, width: 0.000134639242, start: -1.304317e-05}
              f: {type: dry_friction, rate: v, slip: 409.9286, stick: 531.98428688}
            """,
            method=method,
            rtol=rtol,
        )
        assert found.final["v"] == 0.0
        assert found.final["x"] == pytest.approx(-2708314.1, rel=1e-4)


@pytest.mark.parametrize("method", METHODS)
def test_a_body_that_friction_holds_on_a_stop_does_not_sink_into_it(method: str) -> None:
    """It falls onto the stop and rests. A pull relieves the stop until friction alone can hold the
    body, and declines again: when friction lets go, the stop carries the body."""
    found = run(
        """
        span: [0, 6]
        blocks:
          s: {type: hard_stop, force: total, low: 0, high: 5, restitution: 0.3, start: 0.2}
          weight: {type: constant, value: -2}
          pull: {type: integrator, of: way}
          way: {type: gain, of: other, k: 2}
          friction: {type: dry_friction, rate: s.v, slip: 1}
          other: {type: sign, of: wave}
          wave: {type: sine, amplitude: 1, omega: 5}
          total: {type: sum, of: [weight, pull, friction]}
        """,
        method=method,
    )
    assert found.final["s.x"] == pytest.approx(0.0, abs=1e-12)
    assert min(found["s.x"]) > -1e-12


@pytest.mark.parametrize("method", METHODS)
def test_a_play_stays_while_a_stop_holds_the_body_that_drives_it(method: str) -> None:
    """The force on the resting body goes on to change. Its rate, which the stop holds, does not."""
    found = run(
        """
        span: [0, 3]
        blocks:
          s: {type: hard_stop, force: pull, low: -1, high: 1, restitution: 0, start_rate: -2}
          pull: {type: expression, formula: -3 - 10*v}
          v: {type: integrator, of: w, start: 0.1}
          w: {type: gain, of: x, k: -4}
          x: {type: integrator, of: v}
          driving: {type: gain, of: s.x, k: 5}
          rate: {type: gain, of: s.v, k: 5}
          play: {type: play_operator, of: driving, rate: rate, width: 2}
        """,
        ("play",),
        method=method,
    )
    assert found["play"][-1] == pytest.approx(-4)  # the driving part is at -5, half a gap beyond
