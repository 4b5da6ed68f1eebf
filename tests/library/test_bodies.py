"""Bodies and what couples them, against closed formulas and balances of momentum and energy."""

from __future__ import annotations

import numpy as np
import pytest
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
def test_mass_falls_on_a_parabola_and_friction_holds_it_where_it_stops(method: str) -> None:
    blocks = """
  thrown: {type: mass, force: weight, mass: 2, start: 1, start_rate: 3}
  weight: {type: constant, value: -19.62}
  slid: {type: mass, force: rubbing, mass: 2, start_rate: 3}
  rubbing: {type: coulomb, rate: slid.v, level: 4}
"""
    result = drawn(blocks, 3, method, "thrown.x, thrown.v, slid.x, slid.v, rubbing")
    t, stop = result.t, 1.5
    assert result["thrown.x"] == pytest.approx(1 + 3 * t - 9.81 * t**2 / 2, abs=1e-9)
    assert result["thrown.v"] == pytest.approx(3 - 9.81 * t, abs=1e-9)
    moving = np.minimum(t, stop)
    assert result["slid.x"] == pytest.approx(3 * moving - moving**2, abs=1e-9)
    assert np.all(result["slid.v"][t > stop] == 0)
    assert [event.time for event in result.events] == pytest.approx([stop], abs=1e-9)


@EACH_METHOD
def test_rotating_mass_on_a_spring_is_a_cosine(method: str) -> None:
    blocks = """
  wheel: {type: rotating_mass, torque: spring, inertia: 0.5, start: 0.2, start_rate: 0.8}
  spring: {type: stiffness, of: wheel.angle, k: 8}
"""
    result = drawn(blocks, 5, method, "wheel.angle, wheel.rate")
    t = result.t
    assert result["wheel.angle"] == pytest.approx(
        0.2 * np.cos(4 * t) + 0.2 * np.sin(4 * t), abs=1e-7
    )
    assert result["wheel.rate"] == pytest.approx(0.8 * (np.cos(4 * t) - np.sin(4 * t)), abs=1e-7)


@EACH_METHOD
@pytest.mark.parametrize("torque1", [-2.0, 0.3])
@pytest.mark.parametrize("torque2", [-7.0, 0.0])
@pytest.mark.parametrize("ratio", [5.0, -5.0])
def test_gear_accelerates_as_the_equations_of_both_shafts_say(
    torque1: float, torque2: float, ratio: float, method: str
) -> None:
    blocks = f"""
  one: {{type: constant, value: {torque1}}}
  two: {{type: constant, value: {torque2}}}
  g: {{type: gear, torque1: one, torque2: two, ratio: {ratio}, inertia1: 0.1, inertia2: 4,
      start: 0.5, start_rate: 3}}
"""
    result = drawn(blocks, 2, method, "g.angle1, g.rate1, g.angle2, g.rate2")
    # the acceleration of the second shaft and the torque of the teeth on the first
    a, teeth = np.linalg.solve([[0.1 * ratio, 1], [4, -ratio]], [torque1, torque2])
    t = result.t
    assert result["g.rate2"] == pytest.approx(3 + a * t, abs=1e-9)
    assert result["g.angle2"] == pytest.approx(0.5 + 3 * t + a * t**2 / 2, abs=1e-9)
    assert result["g.rate1"] == pytest.approx(3 * ratio + (torque1 - teeth) / 0.1 * t, abs=1e-9)
    assert result["g.angle1"] == pytest.approx(ratio * result["g.angle2"], rel=1e-14)


@EACH_METHOD
def test_gear_is_held_by_friction_on_both_shafts_together(method: str) -> None:
    """Levels of 1 on the first and 2 on the second shaft hold 3*1 + 2 = 5 on the second."""
    blocks = """
  g: {type: gear, torque1: a, torque2: net, ratio: 3, inertia1: 1, inertia2: 1}
  a: {type: coulomb, rate: g.rate1, level: 1}
  b: {type: coulomb, rate: g.rate2, level: 2}
  pull: {type: ramp, slope: 1}
  net: {type: sum, of: [b, pull]}
"""
    result = drawn(blocks, 8, method, "g.rate2")
    exact = np.maximum(result.t - 5, 0) ** 2 / 2 / 10
    assert result["g.rate2"] == pytest.approx(exact, abs=1e-9)


@EACH_METHOD
@pytest.mark.parametrize("torque", [-2.0, 0.6])
def test_rack_accelerates_as_the_equations_of_pinion_and_rack_say(
    torque: float, method: str
) -> None:
    blocks = f"""
  one: {{type: constant, value: {torque}}}
  two: {{type: constant, value: 5}}
  r: {{type: rack, torque: one, force: two, radius: 0.2, inertia: 0.12, mass: 4, start: 0.5,
      start_rate: 3}}
"""
    result = drawn(blocks, 2, method, "r.x, r.v, r.angle, r.rate")
    # the acceleration of the rack and the force of the teeth on it
    a, _ = np.linalg.solve([[4, -1], [0.12 / 0.2, 0.2]], [5, torque])
    t = result.t
    assert result["r.v"] == pytest.approx(3 + a * t, abs=1e-9)
    assert result["r.x"] == pytest.approx(0.5 + 3 * t + a * t**2 / 2, abs=1e-9)
    assert 0.2 * result["r.rate"] == pytest.approx(result["r.v"], rel=1e-14)
    assert 0.2 * result["r.angle"] == pytest.approx(result["r.x"], rel=1e-14)


@EACH_METHOD
@pytest.mark.parametrize("b", [0.5, -0.5])
def test_lever_swings_as_the_spring_at_one_end_and_the_masses_say(b: float, method: str) -> None:
    """A weight at the first end pulls against a spring at the second one."""
    blocks = f"""
  weight: {{type: constant, value: 3}}
  spring: {{type: stiffness, of: l.x2, k: 200}}
  l: {{type: lever, force1: weight, force2: spring, a: 2, b: {b}, inertia: 0.3, mass1: 0.4,
      mass2: 0.4}}
"""
    result = drawn(blocks, 5, method, "l.x1, l.v1, l.x2, l.v2, l.angle, l.rate")
    rest = 2 * 3 / (200 * 0.25)  # where the law of the lever holds
    omega = np.sqrt(200 * 0.25 / (0.3 + 0.4 * 4 + 0.4 * 0.25))
    exact = rest * (1 - np.cos(omega * result.t))
    rate = rest * omega * np.sin(omega * result.t)
    assert result["l.angle"] == pytest.approx(exact, abs=1e-7)
    assert result["l.x1"] == pytest.approx(2 * exact, abs=1e-7)
    assert result["l.x2"] == pytest.approx(-b * exact, abs=1e-7)
    assert result["l.v1"] == pytest.approx(2 * rate, abs=1e-6)
    assert result["l.v2"] == pytest.approx(-b * rate, abs=1e-6)


@EACH_METHOD
@pytest.mark.parametrize("r2", [0.2, -0.2])
def test_belt_lets_its_pulleys_swing_against_each_other(r2: float, method: str) -> None:
    """The stretch z = r1*angle1 - r2*angle2 swings; what the belt does not feel goes on."""
    blocks = f"""
  one: {{type: rotating_mass, torque: b.torque1, inertia: 0.05, start_rate: 4}}
  two: {{type: rotating_mass, torque: b.torque2, inertia: 0.4}}
  b: {{type: belt, angle1: one.angle, rate1: one.rate, angle2: two.angle, rate2: two.rate,
      r1: 0.1, r2: {r2}, k: 300, c: 2}}
"""
    result = drawn(blocks, 4, method, "one.rate, two.rate, one.angle, two.angle, b.force")
    t = result.t
    # z'' + (c*z' + k*z)*(r1^2/J1 + r2^2/J2) = 0 from z = 0, z' = 0.1*4
    share = 0.1**2 / 0.05 + 0.2**2 / 0.4
    decay = share * 2 / 2
    omega = np.sqrt(share * 300 - decay**2)
    z = 0.4 / omega * np.exp(-decay * t) * np.sin(omega * t)
    assert 0.1 * result["one.angle"] - r2 * result["two.angle"] == pytest.approx(z, abs=1e-7)
    # the belt acts on both by one force: J1*rate1/r1 + J2*rate2/r2 is kept
    kept = 0.05 * result["one.rate"] / 0.1 + 0.4 * result["two.rate"] / r2
    assert kept == pytest.approx(np.full(len(t), 2.0), abs=1e-9)
    slope = 0.1 * result["one.rate"] - r2 * result["two.rate"]
    assert result["b.force"] == pytest.approx(300 * z + 2 * slope, abs=1e-5)


@EACH_METHOD
def test_spring_damper_between_two_bodies_keeps_their_momentum(method: str) -> None:
    blocks = """
  a: {type: mass, force: spring, mass: 1, start: 1, start_rate: 2}
  b: {type: mass, force: -spring, mass: 3}
  spring: {type: spring_damper, of: a.x, rate: a.v, other: b.x, other_rate: b.v, k: 12, c: 0.6,
           length: 0.7}
"""
    result = drawn(blocks, 6, method, "a.x, a.v, b.x, b.v")
    t = result.t
    assert result["a.v"] + 3 * result["b.v"] == pytest.approx(np.full(len(t), 2.0), abs=1e-9)
    # the distance less 0.7 swings with the reduced mass 3/4: z'' + 0.8 z' + 16 z = 0
    omega = np.sqrt(16 - 0.16)
    swing = 0.3 * np.cos(omega * t) + (2 + 0.4 * 0.3) / omega * np.sin(omega * t)
    assert result["a.x"] - result["b.x"] == pytest.approx(0.7 + np.exp(-0.4 * t) * swing, abs=1e-7)


@EACH_METHOD
def test_rope_catches_a_fall_and_only_pulls(method: str) -> None:
    """A body of 2 kg falls by 5 m, is caught by a rope of 200 N/m, and comes back to the top."""
    blocks = """
  m: {type: mass, force: net, mass: 2}
  weight: {type: constant, value: 20}
  net: {type: sum, of: [weight, pull]}
  pull: {type: rope, of: m.x, rate: m.v, k: 200, length: 5}
"""
    # x = 5 + 0.1 + swing of omega 10 with the rate 10 at the begin
    taut = 1.0
    half = (np.pi - np.arctan(10 / 1)) * 2 / 10  # until the rope is slack again
    result = drawn(blocks, 2 * taut + half, method, "m.x, m.v, pull")
    t, s = result.t, result.t - taut
    swing = 5.1 - 0.1 * np.cos(10 * s) + 1.0 * np.sin(10 * s)
    back = t - 2 * taut - half
    exact = np.where(s < 0, 5 * t**2, np.where(s < half, swing, 5 * back**2))
    assert result["m.x"] == pytest.approx(exact, abs=1e-6)
    assert np.all(result["pull"] <= 0)
    assert result["m.x"][-1] == pytest.approx(0, abs=1e-6)
    lowest = 5.1 + np.sqrt(1.01)  # k d^2/2 = m g (5 + d)
    assert 100 * (lowest - 5) ** 2 == pytest.approx(20 * lowest)
    assert np.max(result["m.x"]) == pytest.approx(lowest, abs=1e-3)


@EACH_METHOD
def test_rope_with_damping_never_pushes(method: str) -> None:
    blocks = """
  m: {type: mass, force: pull, mass: 1, start: 1.2}
  pull: {type: rope, of: m.x, rate: m.v, k: 100, c: 12, length: 1}
"""
    result = drawn(blocks, 2, method, "m.x, m.v, pull")
    assert np.all(result["pull"] <= 0)
    # z = x - 1 = 0.2*exp(-6 t)*(cos(8 t) + 0.75*sin(8 t)); it pulls until k*z + c*z' = 0
    end = np.arctan2(4, 3) / 8
    speed = -0.2 * 100 / 8 * np.exp(-6 * end) * np.sin(8 * end)
    assert result["m.v"][-1] == pytest.approx(speed, abs=1e-7)


@EACH_METHOD
def test_elastic_gear_passes_its_gap_freely_and_then_strikes(method: str) -> None:
    """Without damping the teeth part as bodies after an elastic impact, after half a swing."""
    blocks = """
  one: {type: rotating_mass, torque: teeth.torque1, inertia: 0.5, start_rate: 4}
  two: {type: rotating_mass, torque: teeth.torque2, inertia: 6}
  teeth: {type: elastic_gear, angle1: one.angle, rate1: one.rate, angle2: two.angle,
          rate2: two.rate, gap: 0.2, k: 3000, ratio: 2}
"""
    record = "one.rate, two.rate, teeth.torque1, teeth.torque2"
    result = drawn(blocks, 0.2, method, record)
    t = result.t
    # seen at the second shaft the first has an inertia of 2 and a rate of 2
    meets, omega = 0.05, np.sqrt(3000 * (1 / 2 + 1 / 6))
    parts = meets + np.pi / omega
    swing = np.cos(omega * np.clip(t - meets, 0, parts - meets))
    assert result["two.rate"] == pytest.approx(0.5 * (1 - swing), abs=1e-7)
    assert result["one.rate"] == pytest.approx(2 * (0.5 + 1.5 * swing), abs=1e-7)
    assert result["teeth.torque2"] == pytest.approx(-2 * result["teeth.torque1"], rel=1e-14)
    assert np.all(result["teeth.torque2"] >= 0)


def test_elastic_gear_is_the_same_in_both_directions() -> None:
    text = """
  drive: {type: sine, amplitude: SIGN, omega: 3}
  one: {type: rotating_mass, torque: net, inertia: 0.5}
  net: {type: sum, of: [drive, teeth.torque1]}
  two: {type: rotating_mass, torque: teeth.torque2, inertia: 1}
  teeth: {type: elastic_gear, angle1: one.angle, rate1: one.rate, angle2: two.angle,
          rate2: two.rate, gap: 0.1, k: 300, c: 1}
"""
    there, back = (
        drawn(text.replace("SIGN", sign), 5, "auto", "two.angle") for sign in ("1", "-1")
    )
    assert there["two.angle"] == pytest.approx(-back["two.angle"], abs=1e-7)


@EACH_METHOD
@pytest.mark.parametrize("ratio", [2, -2])
def test_elastic_gear_loses_its_part_of_the_power_in_both_directions(
    method: str, ratio: int
) -> None:
    """On teeth whose other end is held each half swing has 0.9 of the height of the one before.

    A quarter that leaves the middle has the stiffness k/0.9, one that comes back k*0.9.
    """
    blocks = f"""
  wheel: {{type: rotating_mass, torque: teeth.torque1, inertia: 0.5, start: 0.4}}
  zero: {{type: constant, value: 0}}
  teeth: {{type: elastic_gear, angle1: wheel.angle, rate1: wheel.rate, angle2: zero, rate2: zero,
          k: 200, ratio: {ratio}, efficiency: 0.9}}
"""
    slow, fast = np.sqrt(100 * 0.9), np.sqrt(100 / 0.9)
    back, away = np.pi / 2 / slow, np.pi / 2 / fast
    result = drawn(blocks, 4 * (back + away), method, "wheel.angle, teeth.torque1, teeth.torque2")
    half, s = np.divmod(result.t, back + away)
    shape = np.where(s < back, np.cos(slow * s), -0.9 * np.sin(fast * (s - back)))
    exact = 0.4 * (-0.9) ** half * shape
    inside = half < 4
    assert result["wheel.angle"][inside] == pytest.approx(exact[inside], abs=1e-7)


@EACH_METHOD
def test_elastic_gear_with_a_loss_holds_a_load_between_its_two_efficiencies(method: str) -> None:
    """A twist of 0.1 presses with 20, or 10 at the first shaft: it rests from 8 to 12.5."""
    blocks = """
  wheel: {type: rotating_mass, torque: net, inertia: 0.5, start: 0.2}
  zero: {type: constant, value: 0}
  drive: {type: DRIVE, slope: SLOPE, offset: 10}
  teeth: {type: elastic_gear, angle1: wheel.angle, rate1: wheel.rate, angle2: zero, rate2: zero,
          k: 200, ratio: 2, efficiency: 0.8}
  net: {type: sum, of: [drive, teeth.torque1]}
""".replace("DRIVE", "ramp")
    for slope, end in ((1, 2.5), (-1, 2)):
        result = drawn(blocks.replace("SLOPE", str(slope)), 4, method, "wheel.rate, net")
        t = result.t
        assert np.all(result["wheel.rate"][t < end] == 0)
        assert np.all(result["wheel.rate"][(t > end) & (t < end + 0.1)] * slope > 0)
