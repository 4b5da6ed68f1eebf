"""The same diagram has the same answer in other units, and beside what is no part of it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from solve.models import LIMITS, made
from tracewire.compile import Model
from tracewire.solve import Run, simulate

FORCES = {
    "a barrier": "-50*max(p - S, 0)*W**2",
    "friction": "-0.3*S*W**2*sign(v)",
    "a switch": "(-0.5*S if p >= 0.4*S else 0.25*S)*W**2",
    "a relay": "f",
    "a reset": "0",
    "a wall": "0",
}
BODY = (
    "  v: {type: integrator, of: a, start: 1.1*S*W}\n  p: {type: integrator, of: v, start: 0.9*S}\n"
)
WALL = """
  b: {type: hard_stop, force: a, high: 1.0*S, restitution: 0.7, start: 0.9*S, start_rate: 1.1*S*W}
  p: {type: expression, formula: b.x}
  v: {type: expression, formula: b.v}
"""
RELAY = (
    "  f: {type: relay, of: p, on_at: 0.5*S, off_at: -0.5*S,"
    " on_value: -0.4*S*W**2, off_value: 0.3*S*W**2}\n"
)
RESET = "events:\n  - {when: p - 0.5*S, crosses: up, set: {v: 0.7*v}}\n"


def oscillator(kind: str, more: str = "") -> Model:
    """x'' = -x + a force + 0.5 sin(1.7 t), with x in units of S and t in those of 1/W."""
    blocks = WALL if kind == "a wall" else BODY
    drive = "0.5*S*W**2*sin(1.7*W*t)"
    return made(
        "span: [0, 20/W]\nrecord: [p]\nparameters: {S: 1, W: 1}\nblocks:\n"
        + f"{more}{blocks}{RELAY if kind == 'a relay' else ''}"
        + f"  a: {{type: expression, formula: '-p*W**2 + {FORCES[kind]} + {drive}'}}\n"
        + (RESET if kind == "a reset" else "")
    )


MODELS = {kind: oscillator(kind) for kind in FORCES}


def scaled(model: Model, size: float, rate: float) -> Run:
    """A run in other units."""
    values = {"S": size, "W": rate}
    times = np.linspace(0, 20, 401) / rate
    times[-1] = 20 / rate
    return simulate(model, parameters=values, times=times, rtol=1e-9, limits=LIMITS)


@settings(max_examples=12, deadline=None, derandomize=True)
@given(power=st.floats(-15, 12), tempo=st.sampled_from([1e-6, 1.0, 1e6]))
@pytest.mark.parametrize("kind", FORCES)
def test_other_units_have_the_same_answer(kind: str, power: float, tempo: float) -> None:
    # a known limit: a body that sticks and had a rate of 1e11 and more in its unit may end with a
    # message of too many steps, as no state has a tolerance above rtol/1000
    assume(kind != "friction" or power + np.log10(tempo) <= 10)
    plain, other = scaled(MODELS[kind], 1.0, 1.0), scaled(MODELS[kind], 10**power, tempo)
    assert len(other.events) == len(plain.events)
    assert other["p"] / 10**power == pytest.approx(plain["p"], abs=1e-8)
    assert other.warnings == ()


@pytest.mark.parametrize("large", [1e6, 1e11, 1e15])
@pytest.mark.parametrize("kind", FORCES)
def test_a_large_state_beside_changes_nothing(kind: str, large: float) -> None:
    plain = scaled(MODELS[kind], 1.0, 1.0)
    beside = oscillator(kind, f"  big: {{type: integrator, of: p, start: {large!r}}}\n")
    other = scaled(beside, 1.0, 1.0)
    assert len(other.events) == len(plain.events)
    assert other["p"] == pytest.approx(plain["p"], abs=1e-8)


@pytest.mark.parametrize("size", [1e-15, 1e-9, 1.0, 1e9])
def test_a_start_from_rest_is_as_exact_in_any_unit(size: float) -> None:
    """x'' = -x + sin(t)/2 from rest at zero, where nothing says how large it will be."""
    model = made(
        """
span: [0, 10]
record: [x]
parameters: {S: 1}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  a: {type: expression, formula: "-x + 0.5*S*sin(t)"}
"""
    )
    run = simulate(model, parameters={"S": size}, rtol=1e-8)
    exact = (np.sin(run.t) - run.t * np.cos(run.t)) / 4
    assert run["x"] / size == pytest.approx(exact, abs=1e-6)


@pytest.mark.parametrize("size", [1e-15, 1e-9, 1.0, 1e9])
def test_a_ball_comes_to_rest_in_any_unit(size: float) -> None:
    """After t0 (1 + e)/(1 - e), t0 = sqrt(2 h/g)."""
    model = made(
        """
span: [0, 6]
record: [x]
parameters: {S: 1}
blocks:
  x: {type: integrator, of: v, start: 10*S}
  v: {type: integrator, of: g}
  g: {type: expression, formula: -9.81*S}
events:
  - {when: x, crosses: down, set: {v: -0.5*v}}
"""
    )
    run = simulate(model, parameters={"S": size}, rtol=1e-9, limits=LIMITS)
    assert run.events[-1].kind == "rest"
    assert run.events[-1].time == pytest.approx(3 * np.sqrt(20 / 9.81), abs=1e-6)
