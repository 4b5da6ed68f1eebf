"""The corners of events: touched, coinciding, landed upon, zero at the start; all exact."""

from __future__ import annotations

import math

import numpy as np
import pytest
from solve.logs import METHODS, TIGHT, log, when
from solve.models import LIMITS, kinds, run


def test_a_slide_is_left_with_three_derivatives_zero() -> None:
    """x' = 1 + (t - 1)**3 - s: the fraction passes its limit with a flat tangent."""
    text = """
span: [0, 3]
blocks:
  x: {type: integrator, of: xd}
  s: {type: sign, of: x}
  xd: {type: expression, formula: 1 + (t - 1)**3 - s}
"""
    result = run(text, **TIGHT)
    assert log(result) == [("slip", "x", "up")]
    assert when(result) == pytest.approx([1.0], abs=1e-4)
    assert result["x"] == pytest.approx(np.maximum(result.t - 1, 0) ** 4 / 4, abs=1e-9)


def test_a_slide_that_only_touches_its_limit_goes_on() -> None:
    """x' = 1 - (t - 1)**2 - s is held at x = 0 from 0 to 2, also where both its terms are equal."""
    text = """
span: [0, 2]
blocks:
  x: {type: integrator, of: xd}
  s: {type: sign, of: x}
  xd: {type: expression, formula: 1 - (t - 1)**2 - s}
"""
    result = run(text, **TIGHT)
    assert result["x"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("depth", [1e-5, 1e-7, 1e-9])
def test_two_crossings_in_one_step_are_both_found(depth: float, method: str) -> None:
    """x = (t - 0.6)**2 - depth, of which any method takes long steps."""
    text = f"""
span: [0, 1]
blocks:
  x: {{type: integrator, of: v, start: {0.36 - depth!r}}}
  v: {{type: integrator, of: two, start: -1.2}}
  two: {{type: constant, value: 2}}
  below: {{type: switch, control: x, above: none, below: one}}
  one: {{type: constant, value: 1}}
  none: {{type: constant, value: 0}}
  time_below: {{type: integrator, of: below}}
"""
    result = run(text, rtol=1e-4, method=method, limits=LIMITS)
    half = math.sqrt(depth)
    assert [event.direction for event in result.events] == ["down", "up"]
    assert when(result) == pytest.approx([0.6 - half, 0.6 + half], abs=1e-12 / half)
    assert result.final["time_below"] == pytest.approx(2 * half, abs=1e-11 / half)


EXCHANGE = """
span: [0, 2]
blocks:
  x: {type: integrator, of: one}
  one: {type: constant, value: 1}
  y: {type: integrator, of: none, start: 3}
  z: {type: integrator, of: none, start: 5}
  w: {type: integrator, of: none, start: 7}
  none: {type: constant, value: 0}
events:
  - {when: x - 1, crosses: up, set: {y: z, z: w}}
  - {when: 1 - x, crosses: down, set: {w: y + 10*x, x: x - 3*z}}
"""


def test_simultaneous_resets_all_read_what_was_before() -> None:
    result = run(EXCHANGE, rtol=1e-9)
    assert kinds(result) == ["reset", "reset"]
    assert when(result) == pytest.approx([1.0, 1.0], abs=1e-12)
    exact = {"x": 1 - 15 + 1, "y": 5.0, "z": 7.0, "w": 13.0}
    assert result.final == pytest.approx(exact, abs=1e-9)
    for event in result.events:
        assert event.before == pytest.approx({"x": 1.0, "y": 3.0, "z": 5.0, "w": 7.0}, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_guard_that_is_only_touched_changes_nothing(method: str) -> None:
    """Grazing: x = (t - 0.5)**2 touches zero in rounding only, and so does the reset on it."""
    text = """
span: [0, 1]
blocks:
  x: {type: integrator, of: v, start: 0.25}
  v: {type: integrator, of: two, start: -1}
  two: {type: constant, value: 2}
  bend: {type: abs, of: x}
  y: {type: integrator, of: bend}
events:
  - {when: x, crosses: down, set: {v: -0.5*v}}
"""
    result = run(text, method=method, **TIGHT)
    assert result.final == pytest.approx({"x": 0.25, "v": 1.0, "y": 2 * 0.5**3 / 3}, abs=1e-7)


@pytest.mark.parametrize(("rate", "side"), [(1.0, 1.0), (-1.0, -1.0)])
def test_a_reset_may_land_on_another_guard(rate: float, side: float) -> None:
    """After it x = 2 exactly, a zero of another guard: its rate decides whether it is passed."""
    text = f"""
span: [0, 1.5]
record: [s]
blocks:
  x: {{type: integrator, of: xd}}
  turned: {{type: integrator, of: none, start: 1}}
  count: {{type: integrator, of: none}}
  none: {{type: constant, value: 0}}
  xd: {{type: expression, formula: turned}}
  ahead: {{type: expression, formula: x - 2}}
  s: {{type: sign, of: ahead}}
events:
  - {{when: x - 1, crosses: up, set: {{x: 2, turned: {rate}}}}}
  - {{when: x - 2, crosses: both, set: {{count: count + 1}}}}
"""
    result = run(text, ("s",), **TIGHT)
    assert set(result["s"][result.t > 1]) == {side}
    assert result.final == pytest.approx(
        {"x": 2 + 0.5 * rate, "turned": rate, "count": int(rate > 0)}, abs=1e-9
    )


def test_a_reset_may_land_where_friction_holds() -> None:
    text = """
span: [0, 3]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a, start: 1}
  pull: {type: constant, value: 0.3}
  friction: {type: dry_friction, rate: v, slip: 0.1, stick: 0.4}
  a: {type: sum, of: [pull, friction]}
events:
  - {when: x - 1, crosses: up, set: {v: 0}}
"""
    result = run(text, **TIGHT)
    assert kinds(result) == ["reset", "stick"]
    assert when(result) == pytest.approx([(math.sqrt(1.4) - 1) / 0.2] * 2, abs=1e-9)
    assert result.final == pytest.approx({"x": 1.0, "v": 0.0}, abs=1e-10)


@pytest.mark.parametrize("phase", [0.0, 0.3])
def test_a_known_time_that_coincides_with_a_crossing_and_a_reset(phase: float) -> None:
    """At t = 1 the square wave turns, x reaches its guard and a reset is due, all at once."""
    text = f"""
span: [0, 2]
record: [u, s]
blocks:
  x: {{type: integrator, of: u, start: {phase}}}
  u: {{type: square, amplitude: 1, frequency: 0.5}}
  ahead: {{type: expression, formula: x - {1 + phase}}}
  s: {{type: sign, of: ahead}}
  y: {{type: integrator, of: s}}
  n: {{type: integrator, of: none}}
  none: {{type: constant, value: 0}}
events:
  - {{when: t - 1, crosses: up, set: {{n: n + x}}}}
"""
    result = run(text, ("x", "u", "s"), times=[0.0, 0.5, 1.0, 1.5, 2.0], **TIGHT)
    assert set(np.round(when(result), 9)) == {1.0, 2.0}
    assert result["u"].tolist() == [1, 1, -1, -1, 1]
    assert result["s"][[0, 1, 3, 4]].tolist() == [-1, -1, -1, -1]
    assert result.final["y"] == pytest.approx(-2.0, abs=1e-9)
    assert result.final["x"] == pytest.approx(phase, abs=1e-9)
    assert result.final["n"] == pytest.approx(1 + phase, abs=1e-9)


@pytest.mark.parametrize(
    ("rate", "values"), [(1.0, [2, 2, 3, 3]), (-1.0, [1, 1, 0, 0]), (0.0, [2, 2, 2, 2])]
)
def test_a_floor_that_is_a_whole_number_at_the_start(rate: float, values: list[float]) -> None:
    text = f"""
span: [0, 0.5]
record: [y]
blocks:
  x: {{type: integrator, of: rate, start: 0.5}}
  rate: {{type: constant, value: {rate}}}
  four: {{type: gain, of: x, k: 4}}
  y: {{type: floor, of: four}}
  z: {{type: integrator, of: y}}
"""
    times = [0.0, 0.2, 0.3, 0.49]
    result = run(text, times=times, **TIGHT)
    assert result["y"].tolist() == values
    assert when(result) == pytest.approx([0.25] if rate else [], abs=1e-12)
    exact = 0.25 * values[0] + (0.49 - 0.25) * values[-1]
    assert result.final["z"] == pytest.approx(exact, abs=1e-12)


@pytest.mark.parametrize("begin", [0.0, 0.5, 1.0, -1.0])
def test_a_clock_whose_tick_is_the_start_of_the_span(begin: float) -> None:
    text = """
record: [u, k]
blocks:
  u: {type: square, amplitude: 1, frequency: 1}
  k: {type: expression, formula: floor(4*t)}
  x: {type: integrator, of: u}
"""
    result = run(text, span=(begin, begin + 1), **TIGHT)
    first = 1.0 if begin == math.floor(begin) else -1.0
    assert result["u"][0] == first
    assert result["k"][0] == 4 * begin
    expected = sorted({*(begin + np.arange(1, 5) / 4)})
    assert sorted(set(when(result))) == pytest.approx(expected, abs=1e-12)
    assert result.final["x"] == pytest.approx(0.0, abs=1e-12)
