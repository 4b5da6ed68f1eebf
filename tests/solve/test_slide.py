from __future__ import annotations

import math

import numpy as np
import pytest
from solve.models import OSCILLATOR, kinds, one, run
from tracewire.errors import SimulationError


def test_a_mass_on_a_spring_with_friction_comes_to_rest() -> None:
    """From 1.05 the amplitude falls by 0.2 each half period, to -0.05 within the level 0.1."""
    result = run(OSCILLATOR, rtol=1e-10)
    assert kinds(result) == ["crossing"] * 4 + ["stick"]
    times = [event.time for event in result.events]
    assert times == pytest.approx(np.arange(1, 6) * math.pi, abs=1e-8)
    assert [event.direction for event in result.events] == ["up", "down", "up", "down", ""]
    assert result["x"][-1] == pytest.approx(0.05 * -1, abs=1e-9)
    assert result.final["v"] == pytest.approx(0.0, abs=1e-13)


def test_a_held_mass_breaks_away_at_the_higher_level() -> None:
    text = """
span: [0, 4]
record: [friction, v]
blocks:
  v: {type: integrator, of: a}
  pull: {type: ramp, slope: 1}
  friction: {type: dry_friction, rate: v, slip: 0.5, stick: 2}
  a: {type: sum, of: [pull, friction]}
"""
    result = run(text, times=[1.0, 1.999, 2.001, 4.0], rtol=1e-9)
    [event] = result.events
    assert (event.kind, event.direction) == ("slip", "up")
    assert event.time == pytest.approx(2.0, abs=1e-9)
    assert result["friction"] == pytest.approx([-1, -1.999, -0.5, -0.5], abs=1e-9)
    assert result["v"][-1] == pytest.approx(0.5 * (16 - 4) - 0.5 * 2, abs=1e-8)


def test_a_mass_is_caught_where_only_one_field_points_in() -> None:
    """With force 1 between slip 0.5 and stick 2, a mass that stops stays: the brief's breakaway."""
    text = """
span: [0, 4]
blocks:
  v: {type: integrator, of: a, start: -1}
  friction: {type: dry_friction, rate: v, slip: 0.5, stick: 2}
  one: {type: constant, value: 1}
  a: {type: sum, of: [one, friction]}
"""
    [event] = run(text).events
    assert event.kind == "stick"
    assert event.time == pytest.approx(1 / 1.5, abs=1e-9)


def test_breakaway_without_a_jump_is_left_by_the_second_derivative() -> None:
    """Where slip = stick the exit field has zero guard rate."""
    text = """
span: [0, 4]
blocks:
  v: {type: integrator, of: a}
  pull: {type: ramp, slope: -1}
  friction: {type: coulomb, rate: v, level: 1.5}
  a: {type: sum, of: [pull, friction]}
"""
    result = run(text, rtol=1e-9)
    [event] = result.events
    assert (event.kind, event.direction) == ("slip", "down")
    assert event.time == pytest.approx(1.5, abs=1e-9)
    assert result.final["v"] == pytest.approx(-0.5 * 2.5**2, abs=1e-8)


def test_a_stepped_force_breaks_a_held_mass_loose() -> None:
    text = """
span: [0, 3]
blocks:
  v: {type: integrator, of: a}
  pull: {type: step, height: 2, at: 1}
  friction: {type: coulomb, rate: v, level: 0.5}
  a: {type: sum, of: [pull, friction]}
"""
    result = run(text)
    assert kinds(result) == ["scheduled", "slip"]
    assert result.final["v"] == pytest.approx(1.5 * 2)


def test_a_reset_to_rest_is_held_by_friction() -> None:
    text = """
span: [0, 4]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: friction, start: 1}
  friction: {type: coulomb, rate: v, level: 0.1}
events:
  - {when: x - 1, crosses: up, set: {v: 0}}
"""
    result = run(text)
    assert kinds(result) == ["reset", "stick"]
    assert result.final == pytest.approx({"x": 1.0, "v": 0.0})


@pytest.mark.parametrize("start", [0.0, 0.35])
def test_a_slide_blends_fields_not_modes(start: float) -> None:
    """x' = 0.3 - s, y' = s**2: Filippov gives y' = 1, the mode put into the formula gives 0.09."""
    text = one(
        "0.3 - s",
        start,
        "  s: {type: sign, of: x}\n  y: {type: integrator, of: yd}\n"
        "  yd: {type: expression, formula: s*s}",
    )
    result = run(text, record=("s",))
    assert result.final["y"] == pytest.approx(1.0, abs=1e-12)
    assert result.final["x"] == pytest.approx(0.0, abs=1e-12)
    assert result["s"][-1] == pytest.approx(0.3)
    assert kinds(result) == (["stick"] if start else [])


def test_a_slide_ends_where_a_field_turns_away() -> None:
    """x' = t - s slides on x = 0 until t = 1."""
    result = run(one("2*t - sign(x)", 0.1), rtol=1e-9, span=(0, 2))
    assert kinds(result) == ["stick", "slip"]
    assert result.events[1].time == pytest.approx(0.5, abs=1e-9)
    assert result.final["x"] == pytest.approx(4 - 0.25 - 1.5, abs=1e-8)


@pytest.mark.parametrize("method", ["dormand_prince", "rosenbrock"])
def test_a_disk_on_a_column_slides_on_two_surfaces(method: str) -> None:
    text = """
span: [0, 10]
record: [f12, v1, v2]
blocks:
  v1: {type: integrator, of: f12, start: 1}
  v2: {type: integrator, of: a2, start: -1}
  slip: {type: sum, of: [v1, -v2]}
  f12: {type: coulomb, rate: slip, level: 0.3}
  ground: {type: coulomb, rate: v2, level: 0.2}
  a2: {type: sum, of: [-f12, ground]}
"""
    result = run(text, method=method, rtol=1e-9)
    assert [(event.kind, round(event.time, 9)) for event in result.events] == [
        ("crossing", 2.0),
        ("stick", 3.0),
        ("stick", 4.0),
    ]
    middle = int(np.searchsorted(result.t, 3.5))
    assert result["f12"][middle] == pytest.approx(-0.1)
    assert result.final == pytest.approx({"v1": 0.0, "v2": 0.0}, abs=1e-9)


def test_a_long_chain_of_blocks_at_rest_breaks_loose_one_by_one() -> None:
    """More surfaces than combinations can be tried: the complementarity problem is pivoted."""
    n = 9
    lines = ["span: [0, 3]", "blocks:", "  pull: {type: ramp, slope: 0.4}"]
    for i in range(n):
        forces = [f"f{i}", f"s{i}" if i else "pull"] + ([f"-s{i + 1}"] if i < n - 1 else [])
        lines += [
            f"  x{i}: {{type: integrator, of: v{i}}}",
            f"  v{i}: {{type: integrator, of: a{i}}}",
            f"  f{i}: {{type: coulomb, rate: v{i}, level: 0.1}}",
            f"  a{i}: {{type: sum, of: [{', '.join(forces)}]}}",
        ]
        if i:
            lines.append(f"  s{i}: {{type: expression, formula: 10*(x{i - 1} - x{i})}}")
    result = run("\n".join(lines))
    slips = [event.guard for event in result.events]
    assert slips[:5] == ["v0", "v1", "v2", "v3", "v4"]
    assert set(kinds(result)) == {"slip"}
    assert result.events[0].time == pytest.approx(0.25, abs=1e-9)


def test_a_long_chain_at_rest_stays_under_a_small_force() -> None:
    lines = ["span: [0, 3]", "blocks:"]
    for i in range(12):
        lines += [
            f"  v{i}: {{type: integrator, of: a{i}}}",
            f"  a{i}: {{type: expression, formula: 0.{i:02d} - 0.5*sign(v{i})}}",
        ]
    result = run("\n".join(lines))
    assert result.events == ()
    assert max(map(abs, result.final.values())) == 0.0


def test_a_product_of_two_sliding_modes_is_refused() -> None:
    text = """
blocks:
  x: {type: integrator, of: xd}
  y: {type: integrator, of: yd}
  z: {type: integrator, of: zd}
  xd: {type: expression, formula: -sign(x)}
  yd: {type: expression, formula: -sign(y)}
  zd: {type: expression, formula: sign(x)*sign(y)}
"""
    with pytest.raises(SimulationError, match=r"no unique slide.*'x' in xd, 'y' in yd"):
        run(text)


def test_a_guard_that_reads_its_own_jump_is_refused() -> None:
    text = """
span: [0, 3]
blocks:
  x: {type: integrator, of: one, start: -1}
  one: {type: constant, value: 1}
  y: {type: expression, formula: x - 2*s}
  s: {type: expression, formula: 1 if x - 2*h >= 0 else 0}
  h: {type: expression, formula: 1 if x >= 0 else 0}
  z: {type: integrator, of: y}
"""
    result = run(text)  # no loop: each guard reads another's mode
    assert [event.guard for event in result.events] == ["x", "x - 2*h"]


CORNER = """
blocks:
  x: {type: integrator, of: xd}
  y: {type: integrator, of: yd}
  xd: {type: expression, formula: -sign(x) - sign(x + y)}
  yd: {type: expression, formula: -sign(y) - sign(x + y)}
"""
FOUR = CORNER.replace("-sign(x) -", "-0.1*sign(x) + 0.3*sign(x - y) -")


@pytest.mark.parametrize("text", [CORNER, FOUR])
def test_a_corner_of_many_surfaces_that_cannot_be_left_is_rest(text: str) -> None:
    """Three or four surfaces meet in the origin; the field of no sector leads away from it."""
    result = run(text)
    assert np.abs([result["x"], result["y"]]).max() < 1e-15
    assert result.events == ()
    assert result.warnings == ()


@pytest.mark.parametrize(
    ("x", "y", "end"),
    [
        (0.3, -0.2, 0.625),  # (-0.8, 0) onto x + y = 0, along it with (-0.4, 0.4)
        (-0.3, 0.2, 0.625),
        (0.4, 0.2, 0.5),  # (-0.8, -2) onto y = 0, along it with (-0.8, 0)
        (-0.8, 0.2, 1.25),  # (0.8, 0) onto x + y = 0, along it with (0.4, -0.4)
    ],
)
def test_a_corner_of_four_surfaces_is_reached_when_the_sectors_say_so(
    x: float, y: float, end: float
) -> None:
    result = run(FOUR, start={"x": x, "y": y}, span=(0, 2), rtol=1e-9)
    assert result.events[-1].time == pytest.approx(end, abs=1e-9)
    late = result.t > end
    assert np.abs(np.array([result["x"], result["y"]])[:, late]).max() < 1e-12
    early = result.t < end - 1e-9
    assert np.abs(np.array([result["x"], result["y"]])[:, early]).max(axis=0).min() > 0
