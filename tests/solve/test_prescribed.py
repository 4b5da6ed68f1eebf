"""Friction whose level passes through zero, and friction on a rate that nothing changes."""

from __future__ import annotations

import numpy as np
import pytest
from solve.logs import METHODS, TIGHT, when
from solve.models import made, run
from tracewire.solve import simulate

PUSHED = """
span: [0, 2]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  friction: {type: friction_drift, rate: v, level: 1}
  now: {type: time}
  push: {type: expression, formula: "PUSH"}
  a: {type: sum, of: [push, friction]}
record: [v, a, friction]
"""


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    "push", ["0*now", "0.5*now", "-now", "sin(now)/2", "now**2/2", "-now**3/4"]
)
def test_a_friction_that_grows_from_zero_holds_a_body_at_rest(push: str, method: str) -> None:
    result = run(PUSHED.replace("PUSH", push), method=method, **TIGHT)
    assert result.events == ()
    assert not np.any(result["v"])
    assert result["a"] == pytest.approx(np.zeros(len(result.t)), abs=1e-12)
    needed = made(PUSHED.replace("PUSH", push), ("push",))
    pushes = simulate(needed, **TIGHT)["push"]
    assert result["friction"] == pytest.approx(-pushes, abs=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_a_body_slips_where_the_push_outgrows_the_friction(method: str) -> None:
    """2 t^2 = t at 0.5."""
    result = run(PUSHED.replace("PUSH", "2*now**2"), method=method, **TIGHT)
    t = np.maximum(result.t, 0.5)
    assert when(result) == pytest.approx([0.5], abs=1e-9)
    assert result["v"] == pytest.approx(2 * (t**3 - 0.125) / 3 - (t**2 - 0.25) / 2, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_push_that_grows_faster_than_the_friction_moves_the_body_at_once(method: str) -> None:
    result = run(PUSHED.replace("PUSH", "-1.5*now"), method=method, **TIGHT)
    assert result.events == ()
    assert result["v"] == pytest.approx(-(result.t**2) / 4, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_two_bodies_whose_frictions_all_begin_at_zero_stay(method: str) -> None:
    """The push t/2 on the upper one is held by t between them, and by 2t on the ground."""
    text = """
span: [0, 2]
blocks:
  v: {type: integrator, of: a}
  w: {type: integrator, of: b}
  slip: {type: sum, of: [v, -w]}
  between: {type: friction_drift, rate: slip, level: 1}
  ground: {type: friction_drift, rate: w, level: 2}
  push: {type: ramp, slope: 0.5}
  a: {type: sum, of: [push, between]}
  b: {type: sum, of: [ground, -between]}
record: [v, w, between, ground]
"""
    result = run(text, method=method, **TIGHT)
    nothing = np.zeros(len(result.t))
    assert result["v"] == pytest.approx(nothing, abs=1e-12)
    assert result["w"] == pytest.approx(nothing, abs=1e-12)
    assert result["between"] == pytest.approx(-result.t / 2, abs=1e-9)
    assert result["ground"] == pytest.approx(-result.t / 2, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("rate", "slope"), [("-t*sign(x)", 0.0), ("0.5*t - t*sign(x)", 0.0), ("1.5*t - t*sign(x)", 0.5)]
)
def test_a_slide_may_begin_where_its_sides_agree(rate: str, slope: float, method: str) -> None:
    text = f"""
span: [0, 2]
blocks:
  x: {{type: integrator, of: a}}
  a: {{type: expression, formula: "{rate}"}}
record: [x]
"""
    result = run(text, method=method, **TIGHT)
    assert result["x"] == pytest.approx(slope * result.t**2 / 2, abs=1e-9)


def test_sensitivities_begin_where_the_level_is_zero() -> None:
    text = PUSHED.replace("PUSH", "k*now**2").replace("blocks:", "parameters: {k: 2}\nblocks:", 1)
    model = made(text)
    result = simulate(model, sensitivities=["k"], **TIGHT)
    low, high = (simulate(model, parameters={"k": 2 + h}, **TIGHT) for h in (-1e-5, 1e-5))
    exact = (high["v"] - low["v"]) / 2e-5
    assert result.sensitivities["k"]["v"] == pytest.approx(exact, abs=1e-6)


HELD_RATE = """
span: [0, 3]
blocks:
  v: {type: integrator, of: zero, start: START}
  zero: {type: constant, value: 0}
  friction: {type: BLOCK}
  z: {type: integrator, of: friction}
events:
  - {every: 1, offset: 1, set: {v: 0}}
"""


def held_rate(start: int, block: str) -> str:
    return HELD_RATE.replace("START", str(start)).replace("BLOCK", block)


def test_a_rate_that_is_exactly_zero_and_that_nothing_moves_is_told() -> None:
    told = "'v' of friction rests at exactly zero from t = {} s on, and nothing decides on which"
    for start, since in ((-1, 1), (0, 0)):
        (warning,) = run(held_rate(start, "dry_friction, rate: v, slip: 1, stick: 1")).warnings
        assert warning.startswith(told.format(since))


@pytest.mark.parametrize("start", [-1, 0, 1])
def test_a_sign_of_a_rate_that_rests_at_zero_is_no_force(start: int) -> None:
    result = run(held_rate(start, "coulomb, rate: v, level: 1"))
    assert result.warnings == ()
    assert result.final["z"] == pytest.approx(-start, abs=1e-12)


def test_nothing_is_told_where_the_side_makes_no_difference() -> None:
    assert run(held_rate(-1, "quad_drag, rate: v, c: 1")).warnings == ()


BY_TABLE = """
span: [0, 6]
inputs: {measured: {default: 0}}
record: [friction]
blocks:
  table: {type: signal_builder, times: [0, 1, 2, 3, 4, 5, 6], values: [0, 1, 0, 0, -1, 0, 0]}
  press: {type: constant, value: 2}
  friction: {type: BLOCK}
"""
DRY = [
    "coulomb, level: 2",
    "dry_friction, slip: 2, stick: 3",
    "stribeck_friction, slip: 2, stick: 3, speed: 1e-6",
    "brake, normal: press, friction: 1, stick: 1.5",
]


@pytest.mark.parametrize("rate", ["table", "measured"])
@pytest.mark.parametrize("block", DRY)
def test_friction_is_no_force_while_a_prescribed_rate_is_zero(block: str, rate: str) -> None:
    model = made(BY_TABLE.replace("BLOCK", f"{block}, rate: {rate}"))
    inputs = {"measured": (np.arange(7.0), [0, 1, 0, 0, -1, 0, 0])}
    result = simulate(model, times=[0.5, 1.5, 2.5, 3.5, 4.5, 5.5], inputs=inputs)
    assert result["friction"] == pytest.approx([-2, -2, 0, 2, 2, 0], abs=1e-9)
