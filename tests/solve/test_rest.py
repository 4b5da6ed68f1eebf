from __future__ import annotations

import math

import pytest
from solve.models import BALL, kinds, made, run
from tracewire.solve import simulate

FALL = math.sqrt(2 * 10 / 9.81)


@pytest.mark.parametrize("restitution", [0.9, 0.5, 0.1, 0.001, 0.0])
def test_a_ball_comes_to_rest_at_its_zeno_time(restitution: float) -> None:
    result = simulate(made(BALL), parameters={"restitution": restitution}, span=(0, 40), rtol=1e-10)
    exact = FALL + 2 * FALL * restitution / (1 - restitution)
    assert set(kinds(result)) == {"reset", "rest"}
    assert [event.kind for event in result.events].count("rest") == 1
    rest = result.events[-1]
    assert (rest.kind, rest.guard, rest.block) == ("rest", "x", "events[0]")
    assert rest.time == pytest.approx(exact, abs=2e-8)
    assert result.final == pytest.approx({"x": 0.0, "v": 0.0}, abs=1e-11)


PULLED = """
span: [0, 20]
parameters: {e: 0.5}
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  pull: {type: ramp, slope: 1, at: 5, offset: 0}
  a: {type: expression, formula: pull - 2}
events:
  - {when: x, crosses: down, set: {v: -e*v}}
"""


@pytest.mark.parametrize("method", ["dormand_prince", "rosenbrock"])
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_contact_opens_where_its_force_changes_sign(restitution: float, method: str) -> None:
    """The pull passes the weight at t = 7; then x = (t - 7)**3/6."""
    result = run(PULLED, parameters={"e": restitution}, method=method, rtol=1e-9)
    assert kinds(result)[-3:] == ["rest", "scheduled", "slip"]
    assert result.events[-1].time == pytest.approx(7.0, abs=1e-8)
    assert result.events[-1].direction == "up"
    assert result.final["x"] == pytest.approx(13**3 / 6, rel=1e-7)


def test_a_contact_is_torn_open_by_a_jump_of_the_force() -> None:
    text = PULLED.replace("type: ramp, slope: 1, at: 5, offset: 0", "type: step, height: 3, at: 6")
    result = run(text, rtol=1e-9)
    assert kinds(result)[-3:] == ["rest", "scheduled", "slip"]
    assert result.final["x"] == pytest.approx(0.5 * 14**2, rel=1e-9)


def test_a_contact_rests_again_after_it_was_opened() -> None:
    text = PULLED.replace(
        "pull: {type: ramp, slope: 1, at: 5, offset: 0}",
        "pull: {type: table, points: [[6, 0], [6.1, 3], [6.2, 0]]}",
    )
    result = run(text, rtol=1e-9)
    assert kinds(result).count("rest") == 2
    assert kinds(result).count("slip") == 1
    assert result.final == pytest.approx({"x": 0.0, "v": 0.0}, abs=1e-9)


def test_a_body_at_rest_on_the_floor_still_slides_along_it() -> None:
    text = """
span: [0, 10]
blocks:
  y: {type: integrator, of: w, start: 1}
  w: {type: integrator, of: g}
  g: {type: constant, value: -10}
  x: {type: integrator, of: v}
  v: {type: integrator, of: friction, start: 4}
  friction: {type: coulomb, rate: v, level: 0.5}
events:
  - {when: y, crosses: down, set: {w: -0.3*w}}
"""
    result = run(text, rtol=1e-9)
    assert kinds(result)[-2:] == ["rest", "stick"]
    assert result.events[-1].time == pytest.approx(8.0, abs=1e-7)
    assert result.final == pytest.approx({"y": 0, "w": 0, "x": 16, "v": 0}, abs=1e-7)


BLOW = """
span: [0, 30]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: g, start: 0.1}
  y: {type: integrator, of: w, start: 3}
  w: {type: integrator, of: g}
  g: {type: constant, value: -10}
events:
  - {when: x, crosses: down, set: {v: -0.2*v}}
  - {when: y - x - 1, crosses: down, set: {v: "v + 0.5*(w - v)", w: "w - 0.5*(w - v)"}}
"""


def test_a_plastic_blow_on_a_body_that_rests_ends_with_both_at_rest() -> None:
    """The upper of two equal bodies falls 2 onto the lower one, which rests.

    Blow and floor multiply their common rate by -0.2 and by 2/5 in turn: what is left is rest.
    """
    result = run(BLOW, rtol=1e-9)
    blow = math.sqrt(0.4)
    after = [(event.kind, event.guard) for event in result.events if event.time > 0.1]
    assert after == [("reset", "x"), ("reset", "y - x - 1"), ("rest", "y - x - 1")]
    times = [event.time for event in result.events if event.time > 0.1]
    assert times == pytest.approx([blow] * 3, abs=1e-9)
    late = result.t > blow
    for name, exact in {"x": 0, "v": 0, "y": 1, "w": 0}.items():
        assert result[name][late] == pytest.approx(exact, abs=1e-11)


def test_an_elastic_blow_is_handed_on_by_the_body_that_rests() -> None:
    """Equal bodies swap their rates; the floor gives back a fifth of it, and that is handed up."""
    elastic = BLOW.replace("0.5*(w - v)", "1*(w - v)")
    result = run(elastic, rtol=1e-9, span=(0, 0.7))
    blow, fall = math.sqrt(0.4), 10 * math.sqrt(0.4)
    after = next(event.after for event in result.events if event.time > 0.1)
    assert after == pytest.approx({"x": 0, "v": 0, "y": 1, "w": 0.2 * fall}, abs=1e-9)
    assert (result["v"][result.t > 0.1] == 0).all()
    since = 0.7 - blow
    assert result.final["y"] == pytest.approx(1 + 0.2 * fall * since - 5 * since**2, abs=1e-9)
    assert result.final["x"] == pytest.approx(0, abs=1e-12)
    end = run(elastic, rtol=1e-9)
    assert end.final == pytest.approx({"x": 0, "v": 0, "y": 1, "w": 0}, abs=1e-9)


def test_counting_crossings_is_no_impact() -> None:
    """A reset that does not turn its guard's rate never rests, though the force points back."""
    text = """
span: [0, 3]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a, start: 1}
  a: {type: gain, of: x, k: -39.47841760435743}
  n: {type: integrator, of: zero}
  zero: {type: constant, value: 0}
events:
  - {when: x - 0.05, crosses: both, set: {n: n + 1}}
"""
    result = run(text, rtol=1e-9)
    assert result.final["n"] == 6
    assert set(kinds(result)) == {"reset"}


ON_THE_FLOOR = BALL.replace("start: 10", "start: 0")


def test_a_start_at_rest_on_a_contact_is_held() -> None:
    result = run(ON_THE_FLOOR)
    assert set(result["x"]) == set(result["v"]) == {0.0}
    assert result.events == ()
    assert result.warnings == ()


def test_a_start_that_leaves_a_contact_is_as_any_other() -> None:
    result = run(ON_THE_FLOOR, span=(0, 0.1), start={"v": 1.0})
    assert result.warnings == ()
    assert result.final["x"] == pytest.approx(0.1 - 9.81 / 2 * 0.01)


def test_a_start_into_the_guard_of_an_event_of_the_diagram_is_warned_of() -> None:
    result = run(ON_THE_FLOOR, span=(0, 1), start={"v": -1.0})
    assert result.final["x"] == pytest.approx(-1 - 9.81 / 2)
    assert result.warnings == (
        "the start at t = 0 s lies on the guard of events[0], which does not fire there",
    )
