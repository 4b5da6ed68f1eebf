"""An event fires once, whatever else its reset moves."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from solve.logs import METHODS
from solve.models import LIMITS, made
from tracewire.solve import Run, simulate

LEAVES_A_ZONE = made(
    """
span: [0, 3]
parameters: {a: -1.5, b: 1.0, k: 1.6, c: 0.1, w: 1.0, set0: -2.0}
record: [v1, v2]
blocks:
  e2: {type: dead_zone, of: v1, low: -1.447, high: 0.35}
  v1: {type: integrator, of: dv1, start: a}
  dv1: {type: expression, formula: '-c*v1'}
  v2: {type: integrator, of: dv2, start: set0}
  dv2: {type: expression, formula: 'b - k*e2 + 0.5*w*sin(w*t)'}
events:
  - {when: v2 - 0.1, crosses: up, set: {v1: 0.5*v1}}
"""
)


def resets(run: Run) -> list[float]:
    """The times of the resets."""
    return [event.time for event in run.events if event.kind == "reset"]


@pytest.mark.parametrize("method", METHODS)
def test_a_reset_that_moves_another_guard_fires_once(method: str) -> None:
    """With the modes before the reset, the slope of v2 behind it is negative: it seemed to turn."""
    values = {"a": -1.688, "b": 0.7914, "k": 1.8033, "c": 0.0317, "w": 0.298, "set0": -0.494}
    run = simulate(LEAVES_A_ZONE, parameters=values, method=method, rtol=1e-8, limits=LIMITS)
    assert len(resets(run)) == 1
    assert not any(event.kind in ("impact", "rest") for event in run.events)


@settings(max_examples=60, deadline=None)
@given(
    a=st.floats(-2.8, -1.6),
    b=st.floats(0.7, 2.0),
    k=st.floats(0.5, 2.0),
    c=st.floats(0.0, 0.05),
    set0=st.floats(-2.0, -0.2),
)
def test_a_rise_through_a_level_is_one_event(
    a: float, b: float, k: float, c: float, set0: float
) -> None:
    values = {"a": a, "b": b, "k": k, "c": c, "w": 0.0, "set0": set0}
    run = simulate(LEAVES_A_ZONE, parameters=values, rtol=1e-7, limits=LIMITS)
    assert len(resets(run)) == (1 if run["v2"][-1] > 0.1 else 0)


@pytest.mark.parametrize("method", METHODS)
def test_a_rate_that_turns_in_the_field_behind_the_reset_has_turned(method: str) -> None:
    """x rises to 1, where the reset reverses the motor behind a relay of the same signal: x falls
    from there, and its guard is below its level, as it was; the event has fired once."""
    run = simulate(
        made(
            """
span: [0, 2]
record: [x]
blocks:
  u: {type: integrator, of: zero, start: 1}
  zero: {type: constant, value: 0}
  rate: {type: expression, formula: "1 if u > 0 else -0.5"}
  x: {type: integrator, of: rate}
events:
  - {when: x - 1, crosses: up, set: {u: -u}}
"""
        ),
        method=method,
        limits=LIMITS,
    )
    assert resets(run) == pytest.approx([1.0], abs=1e-12)
    assert run["x"][-1] == pytest.approx(0.5, abs=1e-9)
