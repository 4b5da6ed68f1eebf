"""Invariants: energy is conserved where physics says so, and never made by friction or contact.

Where forces dissipate, their work is a state of its own diagram, so that the balance
energy - work = const can be asked for at every sample, through all events.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from solve.logs import METHODS
from solve.models import BALL, LIMITS, kinds, run
from tracewire.errors import SimulationError
from tracewire.solve import Run

Vector = NDArray[np.float64]
PART = st.integers(0, 20).map(lambda n: n / 20)
LEVEL = st.integers(0, 12).map(lambda n: n / 10)
RATE = st.integers(-30, 30).map(lambda n: n / 10 + 0.013)
MASS = st.integers(1, 9).map(lambda n: n / 3)


def never_rises(values: Vector, slack: float) -> bool:
    """Whether no value is above the least of those before it."""
    return bool((values[1:] <= np.minimum.accumulate(values)[:-1] + slack).all())


@pytest.mark.parametrize("method", METHODS)
def test_an_elastic_ball_bounces_for_ever(method: str) -> None:
    result = run(BALL, parameters={"restitution": 1}, span=(0, 60), method=method, rtol=1e-9)
    fall = math.sqrt(20 / 9.81)
    assert len(result.events) == int((60 - fall) / (2 * fall)) + 1
    assert "rest" not in kinds(result)
    energy = 9.81 * result["x"] + result["v"] ** 2 / 2
    assert energy == pytest.approx(98.1, rel=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_pendulum_that_meets_an_elastic_wall_keeps_its_energy(method: str) -> None:
    text = """
span: [0, 40]
blocks:
  phi: {type: integrator, of: rate, start: 1.2}
  rate: {type: integrator, of: a}
  a: {type: expression, formula: -sin(phi)}
events:
  - {when: phi + 0.4, crosses: down, set: {rate: -rate}}
"""
    result = run(text, method=method, rtol=1e-9, limits=LIMITS)
    assert len(result.events) >= 8
    assert result["phi"].min() > -0.4 - 1e-9
    energy = result["rate"] ** 2 / 2 - np.cos(result["phi"])
    assert energy == pytest.approx(-math.cos(1.2), abs=1e-7)


GAS = """
span: [0, 6]
parameters: {{e: {e}, m: {m}}}
blocks:
  x: {{type: integrator, of: v, start: 0.25}}
  v: {{type: integrator, of: none, start: {rates[0]}}}
  y: {{type: integrator, of: w, start: 0.7}}
  w: {{type: integrator, of: none, start: {rates[1]}}}
  none: {{type: constant, value: 0}}
events:
  - {{when: x, crosses: down, set: {{v: -e*v}}}}
  - {{when: 1 - y, crosses: down, set: {{w: -e*w}}}}
  - when: y - x
    crosses: down
    set: {{v: v - (1 + e)*m/(1 + m)*(v - w), w: w + (1 + e)/(1 + m)*(v - w)}}
"""


def kinetic(result: Run, mass: float) -> Vector:
    return (result["v"] ** 2 + mass * result["w"] ** 2) / 2


@given(rates=st.tuples(RATE, RATE.map(lambda v: v * 1.01)), mass=MASS)
@settings(max_examples=25, deadline=None)
def test_elastic_impacts_conserve_energy_and_order(rates: tuple[float, float], mass: float) -> None:
    """Two balls between two walls, of any masses and rates."""
    result = run(GAS.format(e=1, m=mass, rates=rates), rtol=1e-9)
    before = kinetic(result, mass)[0]
    assert kinetic(result, mass) == pytest.approx(before, rel=1e-11)
    assert (result["x"] > -1e-9).all()
    assert (result["y"] > result["x"] - 1e-9).all()
    assert (result["y"] < 1 + 1e-9).all()
    for event in result.events:  # only the balls' own impacts conserve the momentum
        if event.block == "events[2]":
            momenta = [s["v"] + mass * s["w"] for s in (event.before, event.after)]
            assert momenta[0] == pytest.approx(momenta[1], abs=1e-12)


@given(rates=st.tuples(RATE, RATE.map(lambda v: v * 1.01)), mass=MASS, e=PART)
@settings(max_examples=25, deadline=None)
def test_restitution_never_makes_energy(rates: tuple[float, float], mass: float, e: float) -> None:
    """One ball may press the other against its wall in impacts without end, which may be refused.

    A round of an impact of the balls and one of the inner ball with its wall has real eigenvalues,
    so that it can go on for ever, where 4*e*inner/outer <= (1 - e)**2.
    """
    text = GAS.format(e=e, m=mass, rates=rates)
    told = ""
    try:
        result = run(text, rtol=1e-9)
    except SimulationError as error:
        told = str(error)
    if told:
        assert 4 * e * min(mass, 1 / mass) <= (1 - e) ** 2
        assert "impacts" in told or "two resets write" in told
        return
    energy = kinetic(result, mass)
    assert never_rises(energy, 1e-12 * energy[0])
    for event in result.events:
        before, after = (s["v"] ** 2 + mass * s["w"] ** 2 for s in (event.before, event.after))
        assert after <= before * (1 + 1e-14)


@given(e=st.integers(0, 19).map(lambda n: n / 20), height=st.integers(1, 30))
@settings(max_examples=20, deadline=None)
def test_a_ball_never_rises_above_its_last_height(e: float, height: int) -> None:
    result = run(
        BALL,
        parameters={"restitution": e},
        start={"x": float(height)},
        span=(0, 60),
        rtol=1e-9,
        limits=LIMITS,
    )
    energy = 9.81 * result["x"] + result["v"] ** 2 / 2
    assert never_rises(energy, 1e-9 * energy[0])
    assert result["x"].min() >= -1e-9


RUBBING = """
span: [0, 12]
blocks:
  x: {{type: integrator, of: v, start: {starts[0]}}}
  v: {{type: integrator, of: a}}
  y: {{type: integrator, of: w, start: {starts[1]}}}
  w: {{type: integrator, of: b}}
  slip: {{type: sum, of: [v, -w]}}
  between: {{type: dry_friction, rate: slip, slip: {between[0]}, stick: {between[1]}}}
  ground: {{type: coulomb, rate: w, level: {ground}}}
  air: {{type: quad_drag, rate: v, c: {drag}}}
  oil: {{type: asymmetric_viscous, rate: w, c_l: {drag}, c_r: 0.1}}
  spring: {{type: cubic_stiffness, of: x, k: 0.7}}
  tie: {{type: stiffness, of: y, k: 1.3}}
  a: {{type: sum, of: [spring, between, air]}}
  b: {{type: sum, of: [tie, -between, ground, oil]}}
  work: {{type: integrator, of: power}}
  power: {{type: expression, formula: between*slip + ground*w + air*v + oil*w}}
"""


def balance(result: Run) -> tuple[Vector, Vector]:
    """The energy of the rubbing pair, and the work of its dissipating forces."""
    x, v, y, w = (result[name] for name in "xvyw")
    return v**2 / 2 + w**2 / 2 + 0.7 * x**4 / 4 + 1.3 * y**2 / 2, result["work"]


@given(
    starts=st.tuples(RATE, RATE),
    between=st.tuples(LEVEL, LEVEL).map(lambda pair: (min(pair), max(pair))),
    ground=LEVEL,
    drag=PART,
)
@settings(max_examples=25, deadline=None)
def test_friction_only_takes_energy_and_takes_what_is_missing(
    starts: tuple[float, float], between: tuple[float, float], ground: float, drag: float
) -> None:
    text = RUBBING.format(starts=starts, between=between, ground=ground, drag=drag)
    result = run(text, rtol=1e-9, limits=LIMITS)
    energy, work = balance(result)
    tall = 1 + energy[0]
    assert energy - work == pytest.approx(energy[0], abs=1e-7 * tall)
    assert never_rises(energy, 1e-7 * tall)
    assert never_rises(work, 1e-12 * tall)


@pytest.mark.parametrize("method", METHODS)
def test_a_driven_pair_takes_no_more_than_the_drive_gives(method: str) -> None:
    text = RUBBING.format(starts=(0.3, -0.2), between=(0.2, 0.5), ground=0.1, drag=0.05)
    text = text.replace("of: [spring, between, air]", "of: [spring, between, air, drive]")
    text += """
  drive: {type: square, amplitude: 0.8, frequency: 0.31}
  given: {type: integrator, of: input}
  input: {type: product, of: [drive, v]}
"""
    result = run(text, method=method, rtol=1e-9, limits=LIMITS)
    energy, work = balance(result)
    assert {"stick", "slip"} <= set(kinds(result))
    assert energy - work - result["given"] == pytest.approx(energy[0], abs=1e-7)
    assert never_rises(work, 1e-12)


STOPPED = """
span: [0, 20]
blocks:
  x: {{type: integrator, of: v, start: 0.1}}
  v: {{type: integrator, of: a, start: {rate}}}
  stop:
    {{type: voigt_barrier, of: x, rate: v, high: 0.5, low: -0.8, k: {k}, c_l: {c},
      adhesive: {adhesive}}}
  spring: {{type: stiffness, of: x, k: {soft}}}
  a: {{type: sum, of: [stop, spring]}}
  work: {{type: integrator, of: power}}
  power: {{type: product, of: [a, v]}}
"""


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("k", [1e2, 1e4, 1e6])
def test_a_hard_spring_as_a_stop_keeps_the_energy(k: float, method: str) -> None:
    text = STOPPED.format(rate=1.7, k=k, c=0, adhesive=1, soft=0.9)
    result = run(text, method=method, rtol=1e-9, limits=LIMITS)
    assert len(result.events) > 20
    x, v = result["x"], result["v"]
    deep = np.maximum(x - 0.5, 0) + np.maximum(-0.8 - x, 0)
    energy = v**2 / 2 + 0.9 * x**2 / 2 + k * deep**2 / 2
    assert energy == pytest.approx(energy[0], rel=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_a_double_well_with_a_stop_keeps_the_energy(method: str) -> None:
    """x'' = x - x**3 with a one-sided spring: it passes the saddle in both directions."""
    text = """
span: [0, 60]
blocks:
  x: {type: integrator, of: v, start: -1.45}
  v: {type: integrator, of: a}
  well: {type: expression, formula: x - x**3}
  wall: {type: dead_zone, of: x, low: -100, high: 0.9}
  push: {type: stiffness, of: wall, k: 5e3}
  a: {type: sum, of: [well, push]}
"""
    result = run(text, method=method, rtol=1e-10, limits=LIMITS)
    x, v = result["x"], result["v"]
    assert x.max() > 0.9
    energy = v**2 / 2 - x**2 / 2 + x**4 / 4 + 5e3 * np.maximum(x - 0.9, 0) ** 2 / 2
    assert energy == pytest.approx(energy[0], abs=1e-6)


@given(
    rate=RATE.filter(lambda v: abs(v) > 0.1),
    k=st.sampled_from([10.0, 300.0, 1e4]),
    c=st.sampled_from([0.0, 0.5, 5.0, 200.0]),
    adhesive=st.sampled_from([0, 1]),
)
@settings(max_examples=25, deadline=None)
def test_a_damped_stop_never_throws_harder_than_it_was_hit(
    rate: float, k: float, c: float, adhesive: int
) -> None:
    text = STOPPED.format(rate=rate, k=k, c=c, adhesive=adhesive, soft=0)
    result = run(text, rtol=1e-9, limits=LIMITS)
    half = result["v"] ** 2 / 2
    assert half - result["work"] == pytest.approx(half[0], abs=1e-6 * (1 + half[0]))
    free = (result["x"] < 0.5) & (result["x"] > -0.8)
    assert never_rises(half[free], 1e-6 * half[0])


BETWEEN = """
span: [0, 30]
record: [body.x, body.v, body.held]
blocks:
  body:
    {{type: hard_stop, mass: 2, high: 0.6, low: -0.5, restitution: {e}, start_rate: {rate},
      force: force}}
  spring: {{type: stiffness, of: body.x, k: 5}}
  rub: {{type: dry_friction, rate: body.v, slip: {slip}, stick: {stick}}}
  force: {{type: sum, of: [spring, rub]}}
"""


@pytest.mark.parametrize("method", METHODS)
def test_a_body_between_elastic_stops_keeps_its_energy(method: str) -> None:
    text = BETWEEN.format(e=1, rate=3, slip=0, stick=0)
    result = run(text, method=method, rtol=1e-9, limits=LIMITS)
    energy = result["body.v"] ** 2 + 2.5 * result["body.x"] ** 2
    assert kinds(result).count("impact") > 50
    assert energy == pytest.approx(9.0, rel=1e-7)


@given(e=PART, rate=RATE, slip=LEVEL, more=LEVEL)
@settings(max_examples=25, deadline=None)
def test_a_body_between_stops_only_loses_energy(
    e: float, rate: float, slip: float, more: float
) -> None:
    """Also while it rests on a stop against a spring that pulls it away, or is held by friction."""
    text = BETWEEN.format(e=e, rate=rate, slip=slip, stick=slip + more)
    result = run(text, rtol=1e-9, limits=LIMITS)
    energy = result["body.v"] ** 2 + 2.5 * result["body.x"] ** 2
    assert never_rises(energy, 1e-7 * (1 + energy[0]))
    assert result["body.x"].max() <= 0.6 + 1e-9
    assert result["body.x"].min() >= -0.5 - 1e-9


@given(e=PART, rates=st.tuples(RATE, RATE), masses=st.tuples(MASS, MASS), preload=st.integers(0, 2))
@settings(max_examples=25, deadline=None)
def test_two_bodies_that_collide_keep_their_momentum(
    e: float, rates: tuple[float, float], masses: tuple[float, float], preload: int
) -> None:
    """They pull each other by a spring, meet again and again, and may stay together."""
    text = f"""
span: [0, 10]
record: [pair.x1, pair.v1, pair.x2, pair.v2]
blocks:
  pair:
    type: collision
    mass1: {masses[0]}
    mass2: {masses[1]}
    restitution: {e}
    start2: 1
    start_rate1: {rates[0]}
    start_rate2: {rates[1]}
    force1: pull
    force2: back
  apart: {{type: sum, of: [pair.x2, -pair.x1]}}
  pull: {{type: expression, formula: 2*apart + {preload}}}
  back: {{type: gain, of: pull, k: -1}}
"""
    result = run(text, rtol=1e-9, limits=LIMITS)
    x1, v1, x2, v2 = (result[f"pair.{name}"] for name in ("x1", "v1", "x2", "v2"))
    momentum = masses[0] * v1 + masses[1] * v2
    assert momentum == pytest.approx(momentum[0], abs=1e-8 * (1 + np.abs(momentum[0])))
    energy = masses[0] * v1**2 / 2 + masses[1] * v2**2 / 2 + (x2 - x1) ** 2
    energy += preload * (x2 - x1)
    assert never_rises(energy, 1e-7 * (1 + energy[0]))
    if e == 1:
        assert energy == pytest.approx(energy[0], rel=1e-6)
    assert (x2 - x1).min() >= -1e-8
