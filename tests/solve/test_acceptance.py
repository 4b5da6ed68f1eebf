"""What this room promises: exact solutions of friction, impact and switching, to the digits stated.

`tests/oracles/piecewise.py` holds the closed solutions. Every diagram is wired from blocks that a
user would take; nothing tells the solver what is coming.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import tracewire as tw
from oracles import piecewise
from oracles.double_torsion import solve
from solve.logs import METHODS, TIGHT, log, when
from solve.models import BALL, OSCILLATOR, kinds, run

PENDULUM = Path(__file__).parents[2] / "diagrams/papers/a_torsion/pendulum.yaml"


@pytest.mark.parametrize("method", METHODS)
def test_a_mass_on_a_spring_with_coulomb_friction_rests_for_ever(method: str) -> None:
    exact = piecewise.oscillator(1.05, 0.1)
    result = run(OSCILLATOR, span=(0, 1000), method=method, **TIGHT)
    directions = ["up", "down", "up", "down"]
    assert log(result) == [("crossing", "v", d) for d in directions] + [("stick", "v", "")]
    assert when(result) == pytest.approx([*exact.reversals, exact.rest], abs=1e-8)
    assert exact.rest == 5 * math.pi
    assert result["x"] == pytest.approx(exact.x(result.t), abs=1e-9)
    resting = result.t >= exact.rest
    assert result["x"][resting] == pytest.approx(-0.05, abs=1e-9)
    assert result["v"][resting][1:] == pytest.approx(0.0, abs=1e-12)


STICKING = OSCILLATOR.replace(
    "coulomb, rate: v, level: 0.1", "dry_friction, rate: v, slip: 0.1, stick: 0.3"
)


@pytest.mark.parametrize("method", METHODS)
def test_a_higher_level_of_sticking_holds_it_earlier(method: str) -> None:
    """At 4 pi only one of the two fields points into v = 0, so Filippov's condition fails there."""
    exact = piecewise.oscillator(1.05, 0.1, 0.3)
    result = run(STICKING, span=(0, 1000), method=method, **TIGHT)
    assert log(result) == [("crossing", "v", d) for d in ("up", "down", "up")] + [
        ("stick", "v", "")
    ]
    assert when(result) == pytest.approx([*exact.reversals, exact.rest], abs=1e-8)
    assert exact.rest == 4 * math.pi
    assert result["x"] == pytest.approx(exact.x(result.t), abs=1e-9)
    assert result["x"][result.t >= exact.rest] == pytest.approx(0.25, abs=1e-9)


@pytest.mark.parametrize("text", [OSCILLATOR, STICKING])
@pytest.mark.parametrize("start", [0.05, -0.05, 0.0])
def test_started_at_rest_within_the_level_it_never_moves(text: str, start: float) -> None:
    result = run(text, start={"x": start}, span=(0, 1000), **TIGHT)
    assert result.events == ()
    assert result.warnings == ()
    assert result["x"] == pytest.approx(start, abs=1e-12)
    assert result["v"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("start", [0.0, 0.35, -0.65])
def test_filippov_blends_the_fields_and_not_the_modes(start: float, method: str) -> None:
    """x' = 0.3 - s, y' = s**2 with s = sign(x): y' = 1 on either side and on the slide."""
    text = f"""
span: [0, 2]
record: [s]
blocks:
  x: {{type: integrator, of: xd, start: {start}}}
  y: {{type: integrator, of: yd}}
  s: {{type: sign, of: x}}
  xd: {{type: expression, formula: 0.3 - s}}
  yd: {{type: product, of: [s, s]}}
"""
    result = run(text, ("x", "y", "s"), method=method, **TIGHT)
    arrival = start / 0.7 if start > 0 else -start / 1.3
    assert kinds(result) == (["stick"] if start else [])
    assert when(result) == pytest.approx([arrival] if start else [], abs=1e-12)
    assert result["y"] == pytest.approx(result.t, abs=1e-12)
    sliding = result.t > arrival
    assert result["x"][sliding] == pytest.approx(0.0, abs=1e-12)
    assert result["s"][sliding] == pytest.approx(0.3, abs=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_the_sign_of_the_state_itself_slides(method: str) -> None:
    text = """
span: [0, 2]
blocks:
  x: {type: integrator, of: back, start: 0.5}
  s: {type: sign, of: x}
  back: {type: gain, of: s, k: -1}
"""
    result = run(text, method=method, **TIGHT)
    assert log(result) == [("stick", "x", "")]
    assert when(result) == pytest.approx([0.5], abs=1e-12)
    assert result["x"] == pytest.approx(np.maximum(0.5 - result.t, 0), abs=1e-12)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("restitution", "falls"), [(0.8, 9), (0.5, 3)])
def test_a_ball_rests_at_the_end_of_its_bounces(
    restitution: float, falls: int, method: str
) -> None:
    exact = piecewise.Ball(10, restitution)
    assert exact.rest == pytest.approx(falls * math.sqrt(2 * 10 / 9.81), rel=1e-14)
    result = run(
        BALL, parameters={"restitution": restitution}, span=(0, 100), method=method, **TIGHT
    )
    rest = result.events[-1]
    assert (rest.kind, rest.guard) == ("rest", "x")
    assert rest.time == pytest.approx(exact.rest, abs=1e-6)
    assert "rest" not in kinds(result)[:-1]
    assert when(result)[:-1] == pytest.approx(exact.impacts(len(result.events) - 1), abs=1e-8)
    assert result["x"] == pytest.approx(exact.x(result.t), abs=1e-7)
    assert not result["x"][result.t > rest.time].any()
    assert (result.final["x"], result.final["v"]) == (0.0, 0.0)


MEISSNER = """
span: [0, 20]
blocks:
  x: {{type: integrator, of: v, start: 1}}
  v: {{type: integrator, of: a}}
{source}
  stiffness: {{type: expression, formula: 1 + u}}
  force: {{type: product, of: [stiffness, x]}}
  a: {{type: gain, of: force, k: -1}}
"""
SQUARE = "  u: {{type: square, amplitude: 0.5, frequency: {omega}/(2*pi)}}"
WIRED = """
  now: {{type: time}}
  angle: {{type: gain, of: now, k: {omega}}}
  wave: {{type: sin, of: angle}}
  side: {{type: sign, of: wave}}
  u: {{type: gain, of: side, k: 0.5}}"""


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("omega", [2.0, 2.7, 0.9])
@pytest.mark.parametrize(("source", "accuracy"), [(SQUARE, 1e-12), (WIRED, 1e-10)])
def test_meissner_switches_at_whole_half_periods(
    source: str, accuracy: float, omega: float, method: str
) -> None:
    """Scheduled for the square source, located for sign(sin(omega t)); sgn sin(0+) = +1."""
    text = MEISSNER.format(source=source.format(omega=omega))
    result = run(text, ("x", "v", "u"), method=method, **TIGHT)
    count = int(20 * omega / math.pi)
    assert when(result) == pytest.approx(np.arange(1, count + 1) * math.pi / omega, abs=accuracy)
    assert set(kinds(result)) == {"scheduled" if source is SQUARE else "crossing"}
    assert result["u"][0] == 0.5
    states = piecewise.meissner(result.t, omega, 0.5)
    tall = np.abs(states).max()
    assert result["x"] == pytest.approx(states[:, 0], abs=3e-8 * tall)
    assert result["v"] == pytest.approx(states[:, 1], abs=3e-8 * tall)


def test_a_rising_force_breaks_a_mass_away_above_its_sliding_level() -> None:
    text = """
span: [0, 4]
record: [x, v, friction]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  pull: {type: ramp, slope: -0.8, at: 0.5}
  friction: {type: dry_friction, rate: v, slip: 0.5, stick: 1.3}
  a: {type: sum, of: [pull, friction]}
"""
    result = run(text, **TIGHT)
    leaves = 0.5 + 1.3 / 0.8
    assert log(result)[1:] == [("slip", "v", "down")]
    assert when(result) == pytest.approx([0.5, leaves], abs=1e-9)
    since = np.maximum(result.t - leaves, 0)
    assert result["v"] == pytest.approx(-0.4 * since**2 - 0.8 * since, abs=1e-9)
    assert result["x"] == pytest.approx(-0.4 * since**3 / 3 - 0.4 * since**2, abs=1e-9)
    held = (result.t < leaves) & (result.t > 0.5)
    assert result["friction"][held] == pytest.approx(0.8 * (result.t[held] - 0.5), abs=1e-12)
    assert result["friction"][result.t > leaves] == pytest.approx(0.5, abs=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_stick_slip_of_a_mass_that_is_drawn_by_a_spring(method: str) -> None:
    exact = piecewise.stick_slip(0.3, 0.5, 0.9, 12)
    text = """
span: [0, 60]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  end: {type: ramp, slope: 0.3}
  stretch: {type: sum, of: [end, -x]}
  spring: {type: gain, of: stretch, k: 1}
  friction: {type: dry_friction, rate: v, slip: 0.5, stick: 0.9}
  a: {type: sum, of: [spring, friction]}
"""
    result = run(text, method=method, **TIGHT)
    times = [time for pair in exact for time in pair if time < 60]
    assert kinds(result) == ["slip", "stick"] * (len(times) // 2) + ["slip"] * (len(times) % 2)
    assert when(result) == pytest.approx(times, abs=1e-8)


@pytest.mark.parametrize("method", METHODS)
def test_a_slide_is_left_tangentially(method: str) -> None:
    """x' = y - s, y' = 1 + s/2: on the slide s = y, so y = 2.4 exp(t/2) - 2, until y = 1."""
    text = """
span: [0, 3]
blocks:
  x: {type: integrator, of: xd}
  y: {type: integrator, of: yd, start: 0.4}
  s: {type: sign, of: x}
  xd: {type: sum, of: [y, -s]}
  yd: {type: expression, formula: 1 + 0.5*s}
"""
    result = run(text, method=method, **TIGHT)
    leaves = 2 * math.log(3 / 2.4)
    assert log(result) == [("slip", "x", "up")]
    assert when(result) == pytest.approx([leaves], abs=1e-8)
    before = result.t < leaves
    since = result.t[~before] - leaves
    assert result["x"][before] == pytest.approx(0.0, abs=1e-12)
    assert result["y"][before] == pytest.approx(2.4 * np.exp(result.t[before] / 2) - 2, abs=1e-9)
    assert result["x"][~before] == pytest.approx(0.75 * since**2, abs=1e-8)
    assert result["y"][~before] == pytest.approx(1 + 1.5 * since, abs=1e-8)


@pytest.mark.parametrize(("values", "span"), [({}, 4.0), ({"c1": 1.2}, 2.0)])
def test_paper_a_with_its_exact_friction_is_that_of_the_oracle(
    values: dict[str, float], span: float
) -> None:
    times = np.linspace(0.0, span, round(span * 100) + 1)
    oracle = solve(values, times, rtol=1e-12, atol=1e-16)
    result = tw.simulate(tw.compile(tw.read(PENDULUM)), parameters=values, times=times, rtol=1e-10)
    assert result["phi1"] == pytest.approx(oracle.states[0], abs=1e-8)
    assert result["phi2"] == pytest.approx(oracle.states[2], abs=1e-8)
    held = [pair for pair in oracle.intervals("stick") if pair[0] < span]
    sticks = [event.time for event in result.events if event.kind == "stick"]
    slips = [event.time for event in result.events if event.kind == "slip"]
    assert [*sticks, *slips] == pytest.approx([*map(min, held), *map(max, held)], abs=1e-7)
    assert len(held) == (4 if not values else 0)
