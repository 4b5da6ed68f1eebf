from __future__ import annotations

import numpy as np
import pytest
from solve.models import one, run


@pytest.mark.parametrize("rate", [1.0, -1.0])
def test_a_guard_that_is_zero_at_the_start_follows_its_rate(rate: float) -> None:
    result = run(one(f"{rate}", 0.0, "  s: {type: sign, of: x}"), record=("s",))
    assert result.events == ()
    assert set(result["s"]) == {rate}
    assert result.warnings == ()


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("order", [2, 3, 4])
def test_the_first_derivative_that_is_not_zero_decides(order: int, sign: int) -> None:
    text = one(f"{sign}*t**{order - 1}", 0.0, "  s: {type: sign, of: x}")
    result = run(text, record=("s",))
    assert result.events == ()
    assert set(result["s"]) == {sign}


def test_three_guards_are_decided_together() -> None:
    """A mass that rests on a spring's end with friction at the start, as the column of paper A."""
    text = """
span: [0, 0.1]
record: [contact, x, s]
parameters: {f: 2}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  y: {type: integrator, of: w}
  w: {type: integrator, of: b}
  friction: {type: coulomb, rate: v, level: 0.5}
  contact: {type: expression, formula: -100*x if x <= 0 else 0}
  s: {type: sign, of: y}
  a: {type: sum, of: [drive, friction, contact]}
  drive: {type: expression, formula: f + 0*t}
  b: {type: gain, of: a, k: -1}
"""
    up = run(text)
    assert up.events == ()
    assert up.warnings == ()
    assert up["x"][-1] == pytest.approx(0.5 * 1.5 * 0.01)
    assert set(up["s"]) == {-1.0}
    held = run(text, parameters={"f": 0.4})
    assert held.final == pytest.approx({"x": 0, "v": 0, "y": 0, "w": 0}, abs=1e-12)
    down = run(text, parameters={"f": -2.0}, span=(0, 0.01))
    assert down["contact"][-1] == pytest.approx(100 * 0.5 * 1.5 * 1e-4, rel=1e-2)
    assert set(down["s"]) == {1.0}


def test_a_start_with_two_ways_on_is_said_to_be_so() -> None:
    result = run(one("sign(x)"))
    assert abs(result.final["x"]) == pytest.approx(1.0)
    [warning] = result.warnings
    assert "start at t = 0 s is not unique" in warning


@pytest.mark.parametrize(
    ("formula", "value"), [("1 if x >= 0 else 0", 1), ("0 if x < 0 else 1", 1)]
)
def test_an_equilibrium_on_the_surface_is_what_the_comparison_says(
    formula: str, value: float
) -> None:
    text = one("0", 0.0, f"  y: {{type: expression, formula: {formula}}}")
    result = run(text, record=("y",))
    assert set(result["y"]) == {value}
    assert result.events == ()


def test_a_rise_that_turns_within_the_first_step_is_seen() -> None:
    """x = 1e-4 t - t**2 is positive for 0.1 ms only; the first step is far longer."""
    text = one("1e-4 - 2*t", 0.0, "  s: {type: sign, of: x}")
    result = run(text)
    [event] = result.events
    assert event.direction == "down"
    assert event.time == pytest.approx(1e-4, abs=1e-11)


def test_a_surface_may_be_left_when_the_drive_begins() -> None:
    text = """
span: [0, 3]
record: [s]
blocks:
  x: {type: integrator, of: u}
  u: {type: table, points: [[0, 0], [1, 0], [2, -1]]}
  s: {type: sign, of: x}
"""
    result = run(text, times=[0.5, 1.5])
    assert result["s"].tolist() == [0.0, -1.0]
    [event] = result.events
    assert (event.time, event.kind, event.direction) == (1.0, "crossing", "down")


@pytest.mark.parametrize("wall", [-0.01142398623003368, 1e-3, 3.0])
@pytest.mark.parametrize("ulps", [-2, -1, 0, 1, 2, 3])
@pytest.mark.parametrize("inside", ["sqrt({w} - x)", "({w} - x)**1.5"])
@pytest.mark.parametrize("form", ["{f} if x <= {w} else 0", "{f} if {w} >= x else 0"])
def test_a_start_on_the_edge_of_a_domain_but_for_rounding(
    form: str, inside: str, ulps: int, wall: float
) -> None:
    """The mode is that to come; its formula is defined below the wall alone."""
    start = wall
    for _ in range(abs(ulps)):
        start = float(np.nextafter(start, np.inf if ulps > 0 else -np.inf))
    formula = form.format(f=inside.format(w=repr(wall)), w=repr(wall))
    text = one("-1", start, f"  y: {{type: expression, formula: {formula}}}")
    text += "  z: {type: integrator, of: y}\n"
    result = run(text, span=(0.0, 0.01), record=("x", "z"))
    assert result["x"][-1] == pytest.approx(wall - 0.01, abs=1e-12)
    exact = 2 / 3 * 0.01**1.5 if "sqrt" in inside else 0.4 * 0.01**2.5
    assert result["z"][-1] == pytest.approx(exact, rel=1e-4)
