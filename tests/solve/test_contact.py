"""Contact: impacts, rest, release; against exact solutions and laws of conservation."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from solve.models import kinds, made, run
from tracewire.errors import DiagramError, SimulationError
from tracewire.solve import simulate_many

G = 9.81
FALL = math.sqrt(2 * 10 / G)

BALL = """
span: [0, 20]
parameters: {restitution: 0.5}
blocks:
  ball: {type: bouncing_body, force: weight, mass: 2, restitution: restitution, start: 10}
  weight: {type: constant, value: -19.62}
record: [ball.x, ball.v, ball.held]
"""


def test_a_ball_bounces_and_rests_and_says_that_it_is_held() -> None:
    times = [1.0, 3 * FALL - 1e-3, 3 * FALL + 1e-3, 20.0]
    result = run(BALL, rtol=1e-10, times=times)
    assert set(kinds(result)) == {"impact", "rest"}
    assert {event.block for event in result.events} == {"ball"}
    assert result.events[0].time == pytest.approx(FALL, abs=1e-10)
    assert result.events[-1].time == pytest.approx(3 * FALL, abs=1e-6)
    assert result["ball.held"].tolist() == [0, 0, 1, 1]
    assert result["ball.x"] == pytest.approx([10 - G / 2, 0, 0, 0], abs=1e-5)
    assert result.final == {"ball.x": pytest.approx(0, abs=1e-11), "ball.v": 0.0}


def test_a_ball_that_lies_on_the_floor_stays_there() -> None:
    result = run(BALL.replace("start: 10", "start: 0"), times=[0.0, 5.0, 20.0])
    assert result["ball.x"].tolist() == [0, 0, 0]
    assert result["ball.held"][-1] == 1.0


def test_an_elastic_ball_keeps_its_energy_over_many_impacts() -> None:
    result = run(BALL, parameters={"restitution": 1.0}, rtol=1e-11, atol=1e-13, span=(0, 100))
    assert kinds(result).count("impact") == 1 + int((100 - FALL) // (2 * FALL))
    energy = 0.5 * result["ball.v"] ** 2 + G * result["ball.x"]
    assert energy == pytest.approx(10 * G, rel=1e-8)


@pytest.mark.parametrize("stop", ["high: 0.04, start: 0.05", "high: 1, low: 0.2", "high: -1"])
def test_a_body_that_begins_beyond_its_stop_is_refused(stop: str) -> None:
    with pytest.raises(DiagramError, match=r"'b': the parameters must meet .*(start <= high|low)"):
        run(f"blocks: {{b: {{type: hard_stop, {stop}}}}}")


@pytest.mark.parametrize("x", [-1e-3, -5.0])
def test_a_start_that_a_run_is_given_beyond_a_contact_is_refused(x: float) -> None:
    """It would fall for ever: nothing ever reaches the floor from above."""
    with pytest.raises(SimulationError) as caught:
        run(BALL, start={"ball.x": x})
    assert str(caught.value) == (
        "<text>:5:3: block 'ball': the start at t = 0 s lies beyond the contact of ball.impact, "
        f"where 'ball.x - 0' has crossed zero; ball.x = {x:.6g}, ball.v = 0. "
        "Start on the side where the body can be."
    )


def test_of_many_runs_those_that_begin_beyond_a_contact_fail() -> None:
    rows = [{"start.ball.x": 1.0}, {"start.ball.x": -1.0}]
    many = simulate_many(made(BALL), rows, span=(0, 0.1))
    assert list(many.errors) == [1]


STOPS = """
span: [0, 10]
blocks:
  stop: {type: hard_stop, mass: 0.5, high: 2, low: -1, restitution: e, start_rate: 3}
parameters: {e: 0.5}
record: [stop.x, stop.v, stop.held]
"""


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("restitution", [0.0, 0.25, 1.0])
def test_a_body_that_begins_on_its_stop_and_moves_into_it_strikes_it(
    side: int, restitution: float
) -> None:
    """As if it had begun with the rate that it has after the impact."""
    low, high = sorted((2 * side, -side))
    text = f"""
span: [0, 0.5]
blocks:
  stop: {{type: hard_stop, high: {high}, low: {low}, restitution: {restitution}, start: {2 * side}}}
"""
    found = run(text, start={"stop.v": side * 3.0})
    back = -side * 3.0 * restitution
    assert (found.events[0].kind, found.events[0].time) == ("impact", 0.0)
    assert found.warnings == ()
    assert found["stop.v"] == pytest.approx(np.full(len(found.t), back))
    assert found["stop.x"] == pytest.approx(2 * side + back * found.t)


def test_what_a_start_into_a_stop_does_has_its_derivatives() -> None:
    start = {"stop.x": 2.0, "stop.v": 3.0}
    names = ["e", "start.stop.v"]
    found = run(STOPS, start=start, span=(0, 0.5), parameters={"e": 0.25}, sensitivities=names)
    assert found.sensitivities["e"]["stop.x"] == pytest.approx(-3.0 * found.t)
    assert found.sensitivities["start.stop.v"]["stop.x"] == pytest.approx(-0.25 * found.t)


def test_two_bodies_that_begin_in_touch_and_approach_strike_each_other() -> None:
    """Two equal elastic bodies exchange their rates."""
    text = """
span: [0, 1]
blocks:
  pair: {type: collision, restitution: 1, start_rate1: 3, start_rate2: 1}
"""
    found = run(text)
    assert [event.kind for event in found.events] == ["impact"]
    assert (found.final["pair.v1"], found.final["pair.v2"]) == pytest.approx((1.0, 3.0))


def test_a_free_body_goes_to_and_fro_between_two_stops() -> None:
    """It moves at 3, then -1.5 from t = 2/3, then 0.75 from 2/3 + 2, and so on."""
    result = run(STOPS, times=[0.5, 1.0, 3.0, 10.0], rtol=1e-10)
    assert [event.time for event in result.events] == pytest.approx([2 / 3, 8 / 3, 20 / 3])
    assert [event.direction for event in result.events] == ["up"] * 3
    assert result["stop.x"] == pytest.approx([1.5, 1.5, -1 + 0.75 / 3, 2 - 0.375 * 10 / 3])
    assert result["stop.v"] == pytest.approx([3.0, -1.5, 0.75, -0.375])


PUSHED = """
span: [0, 12]
blocks:
  stop: {type: hard_stop, force: push, mass: 0.5, high: 2, restitution: 0}
  push: {type: sine, amplitude: 3, omega: 1, offset: 0.5}
record: [stop.x, stop.v, stop.held]
"""


def test_a_body_is_held_by_a_stop_until_the_force_turns_round() -> None:
    """x'' = 6 sin t + 1 from rest: x = 6 (t - sin t) + t**2/2 reaches 2 and stays there.

    The stop lets go where the force 3 sin t + 0.5 crosses zero, at pi + asin(1/6).
    """
    result = run(PUSHED, rtol=1e-10, times=[0.5, 2.0, 3.0, 3.5, 4.0])
    left = math.pi + math.asin(1 / 6)
    assert kinds(result)[:3] == ["impact", "rest", "slip"]
    hit = result.events[0]
    assert 6 * (hit.time - math.sin(hit.time)) + hit.time**2 / 2 == pytest.approx(2, abs=1e-9)
    assert result.events[1].time == pytest.approx(hit.time, abs=1e-9)
    assert result.events[2].time == pytest.approx(left, abs=1e-8)
    assert result["stop.held"].tolist() == [0, 1, 1, 0, 0]
    assert result["stop.x"][1:3].tolist() == pytest.approx([2, 2], abs=1e-11)
    t = 4.0
    v = -6 * (math.cos(t) - math.cos(left)) + (t - left)
    x = 2 - 6 * (math.sin(t) - math.sin(left)) + 6 * math.cos(left) * (t - left)
    x += (t - left) ** 2 / 2
    assert result["stop.v"][-1] == pytest.approx(v, rel=1e-7)
    assert result["stop.x"][-1] == pytest.approx(x, rel=1e-7)


def test_what_else_jumps_with_an_impact_reads_what_was_before() -> None:
    text = """
span: [0, 3]
blocks:
  stop: {type: hard_stop, high: 2, low: -1, restitution: 0.5, start_rate: 3}
  other: {type: integrator, of: zero}
  zero: {type: constant, value: 0}
events:
  - {when: stop.impact, set: {other: other + stop.v}}
"""
    result = run(text, rtol=1e-10)
    assert result.final["other"] == pytest.approx(3.0 - 1.5)
    assert result.final["stop.v"] == pytest.approx(0.75)


def test_a_diagram_may_change_one_of_several_states_of_a_block() -> None:
    text = STOPS + "events:\n  - {when: t - 0.5, crosses: up, set: {stop.x: 0, stop.v: -stop.v}}\n"
    result = run(text, span=(0, 0.75))
    assert result.final == pytest.approx({"stop.x": -0.75, "stop.v": -3.0})


PAIR = """
span: [0, 3]
parameters: {m: 2, e: 0.5, v: 1}
blocks:
  pair:
    type: collision
    mass1: m
    mass2: 3
    distance: 0.5
    restitution: e
    start2: 1.5
    start_rate1: v
record: [pair.x1, pair.v1, pair.x2, pair.v2]
"""


@settings(max_examples=15, deadline=None)
@given(m=st.floats(0.1, 20), e=st.floats(0.0, 1.0), v=st.floats(0.5, 5.0))
def test_a_collision_keeps_momentum_and_separates_by_the_restitution(
    m: float, e: float, v: float
) -> None:
    result = run(PAIR, parameters={"m": m, "e": e, "v": v})
    first = result.events[0]
    assert first.kind == "impact"
    assert first.time == pytest.approx(1 / v, abs=1e-9)
    v1, v2 = first.after["pair.v1"], first.after["pair.v2"]
    assert m * v1 + 3 * v2 == pytest.approx(m * v, rel=1e-12)
    assert v2 - v1 == pytest.approx(e * v, rel=1e-12, abs=1e-12)
    assert m * v1**2 + 3 * v2**2 <= m * v**2 * (1 + 1e-12)


PRESSED = """
span: [0, 10]
blocks:
  pair:
    type: collision
    force1: push
    force2: pull
    mass1: 2
    mass2: 3
    restitution: 0.3
    start2: 1
  push: {type: constant, value: 4}
  pull: {type: step, height: 7, at: 5}
record: [pair.x1, pair.x2, pair.held]
"""


def test_bodies_that_stay_together_move_as_one_until_one_is_pulled_away() -> None:
    """Pushed at 4/5 together; from t = 5 the second alone is faster, at 7/3 against 4/2."""
    result = run(PRESSED, rtol=1e-10, times=[4.0, 5.0, 10.0], record=("pair.v1", "pair.v2"))
    assert result["pair.held"].tolist() == [1, 0, 0]
    assert result["pair.x2"][0] == pytest.approx(result["pair.x1"][0], abs=1e-10)
    # the contact is inside: the momentum is that of the push alone
    momentum = 2 * result["pair.v1"] + 3 * result["pair.v2"]
    assert momentum == pytest.approx([16, 20, 20 + 11 * 5], rel=1e-8)
    assert result["pair.v1"][2] - result["pair.v1"][1] == pytest.approx(2 * 5, rel=1e-8)
    apart = result["pair.x2"][2] - result["pair.x1"][2]
    assert apart == pytest.approx(0.5 * (7 / 3 - 2) * 25, rel=1e-6)


def test_a_clutch_holds_one_way_slips_above_its_capacity_and_runs_free_forwards() -> None:
    """Torque 2 sin t on inertia 1: held while it is against the clutch, but for what exceeds 1.5.

    It runs free from 0 to 2 pi, where its rate is zero again, and then again.
    """
    text = """
span: [0, 12]
blocks:
  theta: {type: integrator, of: omega}
  omega: {type: integrator, of: alpha}
  torque: {type: sine, amplitude: -2, omega: 1}
  clutch: {type: one_way_clutch, rate: omega, capacity: capacity}
  alpha: {type: sum, of: [torque, clutch]}
parameters: {capacity: 5}
record: [omega, clutch]
"""
    times = np.array([1.0, 2.0, 3.0, 4.0, 6.0])
    result = run(text, times=times, rtol=1e-10)
    # the torque -2 sin t is against the clutch until pi; from there omega = 2 (1 + cos t)
    free = np.where(times < math.pi, 0.0, 2 + 2 * np.cos(times))
    assert result["omega"] == pytest.approx(free, abs=1e-8)
    assert result["clutch"] == pytest.approx(np.where(times < math.pi, 2 * np.sin(times), 0.0))
    slips = run(text, times=[1.0, 1.5], rtol=1e-10, parameters={"capacity": 1.0})
    begin = math.asin(0.5)
    back = 2 * (math.cos(1.5) - math.cos(begin)) + (1.5 - begin)
    assert slips["omega"][1] == pytest.approx(back, abs=1e-8)
    assert slips["clutch"].tolist() == pytest.approx([1.0, 1.0])
