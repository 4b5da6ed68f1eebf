"""Brakes, clutches and whole laws of friction: when they slip, stop, stick and break away."""

from __future__ import annotations

import numpy as np
import pytest
from library.values import output
from numpy.typing import NDArray
from solve.logs import METHODS, TIGHT
from solve.models import run
from tracewire.solve import Run

Vector = NDArray[np.float64]
EACH_METHOD = pytest.mark.parametrize("method", METHODS)


def drawn(blocks: str, end: float, method: str, record: str) -> Run:
    """A run of blocks from 0 to `end` in 200 samples."""
    text = f"span: [0, {end}]\nevery: {end}/200\nblocks:\n{blocks}\nrecord: [{record}]\n"
    return run(text, method=method, **TIGHT)


@EACH_METHOD
@pytest.mark.parametrize("sign", [1, -1])
def test_brake_holds_a_drive_until_its_normal_force_is_too_small(method: str, sign: int) -> None:
    """It breaks away at 0.4*N = 3, slips with 0.3*N, and does nothing where N is below zero."""
    blocks = f"""
  wheel: {{type: rotating_mass, torque: net, inertia: 2}}
  drive: {{type: constant, value: {3 * sign}}}
  normal: {{type: ramp, slope: -2, offset: 20}}
  held: {{type: brake, rate: wheel.rate, normal: normal, friction: 0.3, stick: 0.4, radius: 0.5,
         faces: 2}}
  net: {{type: sum, of: [drive, held]}}
"""
    result = drawn(blocks, 12, method, "wheel.rate, held")
    t, away, apart = result.t, 6.25, 10.0
    assert np.all(result["wheel.rate"][t < away] == 0)
    s = np.clip(t, away, apart)
    rate = (-3 * (s - away) + 0.3 * (s**2 - away**2)) / 2 + 1.5 * np.maximum(t - apart, 0)
    assert result["wheel.rate"] == pytest.approx(sign * rate, abs=1e-8)
    force = np.where(t < away, -3, -0.3 * np.maximum(20 - 2 * t, 0))
    settled = np.abs(t - away) > 0.01
    assert result["held"][settled] == pytest.approx(sign * force[settled], abs=1e-8)


@EACH_METHOD
def test_brake_stops_a_wheel_when_its_work_is_done(method: str) -> None:
    blocks = """
  wheel: {type: rotating_mass, torque: held, inertia: 2, start_rate: 10}
  normal: {type: ramp, slope: 50}
  held: {type: brake, rate: wheel.rate, normal: normal, friction: 0.4, radius: 0.1}
"""
    result = drawn(blocks, 6, method, "wheel.rate")
    t = result.t
    stop = np.sqrt(20)  # 2*10 = the integral of 2*t
    assert result["wheel.rate"] == pytest.approx(np.maximum(10 - t**2 / 2, 0), abs=1e-8)
    assert [e.time for e in result.events if e.block == "held"][-1] == pytest.approx(stop, abs=1e-9)


@EACH_METHOD
@pytest.mark.parametrize("sign", [1, -1])
def test_clutch_joins_two_shafts_and_slips_at_its_torque(method: str, sign: int) -> None:
    """It slips with 6 until both have 2.5 at 1.25 s; from 2 s on it passes 3/4 of the drive."""
    blocks = f"""
  one: {{type: rotating_mass, torque: net, inertia: 1, start_rate: {10 * sign}}}
  two: {{type: rotating_mass, torque: -plates, inertia: 3}}
  drive: {{type: ramp, slope: {4 * sign}, at: 2}}
  pressed: {{type: constant, value: 100}}
  plates: {{type: clutch, rate: one.rate, other_rate: two.rate, normal: pressed, friction: 0.3,
           radius: 0.1, faces: 2}}
  net: {{type: sum, of: [drive, plates]}}
"""
    result = drawn(blocks, 6, method, "one.rate, two.rate, plates")
    t, away = result.t, 4.0
    joined = 2.5 + 0.5 * np.clip(t - 2, 0, away - 2) ** 2
    beyond = np.maximum(t - away, 0)
    two = np.where(t < 1.25, 2 * t, joined + 2 * beyond)
    one = np.where(t < 1.25, 10 - 6 * t, joined + 2 * beyond + 2 * beyond**2)
    assert result["one.rate"] == pytest.approx(sign * one, abs=1e-7)
    assert result["two.rate"] == pytest.approx(sign * two, abs=1e-7)
    together = (t > 1.26) & (t < 3.99)
    passed = -3 * np.maximum(t - 2, 0)
    assert result["plates"][together] == pytest.approx(sign * passed[together], abs=1e-8)


@EACH_METHOD
def test_eddy_brake_slows_a_wheel_as_the_logarithm_and_the_square_say(method: str) -> None:
    blocks = """
  wheel: {type: rotating_mass, torque: eddies, inertia: 2, start_rate: 30}
  eddies: {type: eddy_brake, rate: wheel.rate, peak: 5, speed: 10}
"""
    result = drawn(blocks, 20, method, "wheel.rate")
    rate = result["wheel.rate"]
    passed = (100 * np.log(30 / rate) + (900 - rate**2) / 2) * 2 / (2 * 5 * 10)
    assert passed == pytest.approx(result.t, abs=1e-6)
    assert output("eddy_brake", rate=-10, peak=5, speed=10) == 5


@EACH_METHOD
@pytest.mark.parametrize("sign", [1, -1])
def test_stribeck_friction_stops_a_body_and_breaks_away_at_its_stick_level(
    method: str, sign: int
) -> None:
    """m*v' = -(a + b*exp(-v/s)) is linear in exp(v/s); a ramp of force then breaks it away."""
    blocks = f"""
  body: {{type: mass, force: net, mass: 2, start_rate: {3 * sign}}}
  pull: {{type: ramp, slope: {sign}, at: 4}}
  rubbing: {{type: stribeck_friction, rate: body.v, slip: 2, stick: 3, speed: 0.5, exponent: 1}}
  net: {{type: sum, of: [pull, rubbing]}}
"""
    result = drawn(blocks, 8, method, "body.v, rubbing")
    t, a, b, s = result.t, 2.0, 1.0, 0.5
    grown = (np.exp(3 / s) + b / a) * np.exp(-a * t / (2 * s)) - b / a
    stop = 2 * s / a * np.log((np.exp(3 / s) + b / a) / (1 + b / a))
    assert stop < 4
    v = sign * result["body.v"]
    assert v[t < stop] == pytest.approx(s * np.log(grown[t < stop]), abs=1e-7)
    assert np.all(v[(t > stop) & (t < 7)] == 0)
    assert np.all(v[t > 7.05] > 0)
    held = (t > 4) & (t < 6.99)
    assert result["rubbing"][held] == pytest.approx(sign * (4 - t[held]), abs=1e-9)
    times = [event.time for event in result.events if event.block == "rubbing"]
    assert times[0] == pytest.approx(stop, abs=1e-8)
    assert times[-1] == pytest.approx(7, abs=1e-8)


def test_stribeck_friction_is_its_formula() -> None:
    given = {"slip": 2, "stick": 3, "speed": 0.5, "c": 0.1}
    for exponent in (1, 2, 1.5):
        level = 2 + np.exp(-((0.7 / 0.5) ** exponent)) + 0.07
        for sign in (1, -1):
            force = output("stribeck_friction", rate=0.7 * sign, exponent=exponent, **given)
            assert force == pytest.approx(-sign * level)


@EACH_METHOD
@pytest.mark.parametrize("sign", [1, -1])
def test_friction_table_stops_a_body_along_its_points(method: str, sign: int) -> None:
    blocks = f"""
  body: {{type: mass, force: net, mass: 1, start_rate: {3 * sign}}}
  pull: {{type: ramp, slope: {sign}, at: 2}}
  rubbing: {{type: friction_table, rate: body.v, points: [[0, 3], [1, 2], [2, 2]]}}
  net: {{type: sum, of: [pull, rubbing]}}
"""
    result = drawn(blocks, 6, method, "body.v, rubbing")
    t = result.t
    # at 2 until it has a rate of 1 at 1 s, then v' = -(3 - v)
    stop = 1 + np.log(1.5)
    v = np.where(t < 1, 3 - 2 * t, np.where(t < stop, 3 - 2 * np.exp(t - 1), 0))
    before = t < 5
    assert sign * result["body.v"][before] == pytest.approx(v[before], abs=1e-8)
    assert np.all(result["body.v"][(t > stop) & before] == 0)
    away = [event.time for event in result.events if event.block == "rubbing"]
    assert min(abs(time - 5) for time in away) < 1e-8
    # from there v' = (t - 5) + v
    assert sign * result["body.v"][-1] == pytest.approx(np.exp(1) - 2, abs=1e-7)


@EACH_METHOD
@pytest.mark.parametrize("sign", [1, -1])
def test_rolling_resistance_lets_a_car_coast_as_a_tangent_and_holds_it(
    method: str, sign: int
) -> None:
    blocks = f"""
  car: {{type: mass, force: rolling, mass: 2, start_rate: {20 * sign}}}
  load: {{type: constant, value: 20}}
  rolling: {{type: rolling_resistance, rate: car.v, load: load, c0: 0.1, c2: 1e-3}}
"""
    result = drawn(blocks, 20, method, "car.v")
    t = result.t
    angle = np.arctan(20 * np.sqrt(1e-2)) - 10 * np.sqrt(1e-4) * t
    v = 10 * np.tan(np.maximum(angle, 0))
    assert result["car.v"] == pytest.approx(sign * v, abs=1e-7)
    assert np.all(result["car.v"][angle < 0] == 0)


def test_rolling_resistance_of_a_wheel_in_the_air_is_none() -> None:
    assert output("rolling_resistance", rate=3, load=-5, c0=0.1, c1=0.2) == 0
    assert output("rolling_resistance", rate=3, load=5, c0=0.1, c1=0.2) == pytest.approx(-3.5)


@EACH_METHOD
def test_maxwell_slip_follows_the_rule_of_masing(method: str) -> None:
    """Each branch after the first is the first one, twice as large; a closed loop is forgotten."""
    k, level = np.array([4.0, 2.0, 1.0]), np.array([1.0, 1.5, 2.0])
    blocks = """
  x: {type: integrator, of: v}
  v: {type: signal_builder, times: [0, 1.5, 1.5, 4, 4, 8], values: [1, 1, -1, -1, 1, 1]}
  force: {type: maxwell_slip, rate: v, k: [4, 2, 1], level: [1, 1.5, 2]}
"""
    result = drawn(blocks, 8, method, "x, force")

    def first(x: Vector) -> Vector:
        return np.minimum(np.outer(x, k), level).sum(axis=1)

    t, x = result.t, result["x"]
    top, bottom = 1.5, -1.0
    down = first(np.array([top])) - 2 * first(np.maximum(top - x, 0) / 2)
    low = first(np.array([top])) - 2 * first(np.array([(top - bottom) / 2]))
    up = np.where(x < top, low + 2 * first(np.maximum(x - bottom, 0) / 2), first(np.maximum(x, 0)))
    exact = np.where(t <= 1.5, first(np.maximum(x, 0)), np.where(t <= 4, down, up))
    assert -result["force"] == pytest.approx(exact, abs=1e-8)
    assert -result["force"][-1] == pytest.approx(level.sum(), abs=1e-9)


@EACH_METHOD
@pytest.mark.parametrize("sign", [1, -1])
def test_maxwell_element_comes_to_its_level_and_sticks_where_the_rate_turns(
    method: str, sign: int
) -> None:
    """At rates of 1, 2 and -2 its levels are 2*(1 + 0.5*exp(-v^2)); it slips with c = 8."""
    blocks = f"""
  v: {{type: signal_builder, times: [2, 2, 4, 4], values: [{sign}, {2 * sign}, {2 * sign},
      {-2 * sign}]}}
  force: {{type: maxwell_element, rate: v, k: 3, level: 2, peak: 0.5, speed: 1, c: 8}}
"""
    result = drawn(blocks, 8, method, "force")
    slow, fast = 2 + np.exp(-1), 2 + np.exp(-4)
    t = result.t
    first = np.minimum(3 * t, slow)
    second = fast + (slow - fast) * np.exp(-8 / fast * (t - 2))
    at_turn = fast + (slow - fast) * np.exp(-8 / fast * 2)
    third = np.maximum(at_turn - 6 * (t - 4), -fast)
    exact = np.where(t < 2, first, np.where(t < 4, second, third))
    assert -sign * result["force"] == pytest.approx(exact, abs=1e-8)


@EACH_METHOD
def test_maxwell_slip_takes_the_energy_of_a_body_that_it_brings_to_rest(method: str) -> None:
    """What it had is in the springs, m*v^2/2 + f^2/(2 k), or went into the way that slipped."""
    blocks = """
  body: {type: mass, force: held, mass: 2, start_rate: 3}
  held: {type: maxwell_slip, rate: body.v, k: [40, 10], level: [2, 3]}
  power: {type: product, of: [held, body.v]}
  work: {type: integrator, of: power}
"""
    result = drawn(blocks, 12, method, "body.v, held.f, work")
    kinetic = result["body.v"] ** 2
    assert kinetic - 9 == pytest.approx(result["work"], abs=1e-7)
    stored = result["held.f[0]"] ** 2 / 80 + result["held.f[1]"] ** 2 / 20
    energy = kinetic + stored
    assert np.all(np.diff(energy) < 1e-9)
    # it ends in a swing in which no element slips any more
    assert energy[-1] == pytest.approx(energy[-20], abs=1e-8)
