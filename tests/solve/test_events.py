from __future__ import annotations

import math

import numpy as np
import pytest
from solve.models import BALL, kinds, one, run
from tracewire.errors import SimulationError

FALL = math.sqrt(2 * 10 / 9.81)


def bounces(restitution: float, count: int) -> list[float]:
    """The exact times of a ball's impacts."""
    times, flight = [FALL], 2 * FALL
    for _ in range(count - 1):
        flight *= restitution
        times.append(times[-1] + flight)
    return times


def test_a_ball_bounces_at_the_exact_times() -> None:
    result = run(BALL, rtol=1e-9)
    assert set(kinds(result)) == {"reset"}
    times = [event.time for event in result.events]
    assert times == pytest.approx(bounces(0.8, len(times)), abs=1e-9)
    first = result.events[0]
    assert (first.guard, first.direction, first.block) == ("x", "down", "events[0]")
    assert first.after["v"] == pytest.approx(-0.8 * first.before["v"], rel=1e-15)
    assert first.before["v"] == pytest.approx(-9.81 * FALL)
    assert first.after["x"] == first.before["x"]


def test_a_crossing_is_located_to_rounding() -> None:
    result = run(one("1 if x < 0.123456789 else 3"), rtol=1e-4)
    [event] = result.events
    assert (event.kind, event.direction) == ("crossing", "up")
    assert event.time == pytest.approx(0.123456789, abs=1e-12)
    assert result["x"][-1] == pytest.approx(0.123456789 + 3 * (1 - 0.123456789), rel=1e-12)


def test_two_crossings_inside_one_step_are_found() -> None:
    """A parabola in t that lies below zero for 2 ms: the steps are far longer than that."""
    text = one(
        "2*(t - 0.6)",
        0.36 - 1e-6,
        "  y: {type: integrator, of: below}\n"
        "  below: {type: expression, formula: 1 if x < 0 else 0}",
    )
    result = run(text, rtol=1e-3)
    assert [event.direction for event in result.events] == ["down", "up"]
    assert [event.time for event in result.events] == pytest.approx([0.599, 0.601], abs=1e-9)
    assert result.final["y"] == pytest.approx(0.002, abs=1e-9)


def test_a_dip_before_another_crossing_is_found() -> None:
    more = """
  a: {type: expression, formula: abs(x)}
  b: {type: expression, formula: sign(t*t - 0.605**2)}
"""
    result = run(one("2*(t - 0.6)", 0.36 - 1e-6, more), rtol=1e-3)
    times = [event.time for event in result.events]
    assert times == pytest.approx([0.599, 0.601, 0.605], abs=1e-9)


def test_a_touch_without_a_crossing_is_no_event() -> None:
    result = run(one("2*(t - 0.6)", 0.36 + 1e-7, "  a: {type: expression, formula: abs(x)}"))
    assert result.events == ()


SWAP = """
span: [0, 2]
blocks:
  x: {type: integrator, of: one}
  one: {type: constant, value: 1}
  y: {type: integrator, of: zero, start: 3}
  z: {type: integrator, of: zero, start: 5}
  zero: {type: constant, value: 0}
events:
  - {when: x - 1, crosses: up, set: {y: z, z: y + 10*x}}
"""


def test_resets_read_what_was_before() -> None:
    result = run(SWAP)
    assert (result.final["y"], result.final["z"]) == pytest.approx((5.0, 13.0))


def test_two_resets_of_one_state_name_both() -> None:
    text = SWAP + "  - {when: t - x + x - 1, set: {y: 7}}\n"
    with pytest.raises(
        SimulationError,
        match=r"two resets write 'y' at t = 1 s.*events\[0\].*"
        r"gives 5.*events\[1\] gives 7.*Merge",
    ):
        run(text)


def test_two_resets_of_different_states_fire_together() -> None:
    text = SWAP + "  - {when: 2 - 2*x, crosses: down, set: {x: 0}}\n"
    text = text.replace("z: y + 10*x", "z: x")
    result = run(text, span=(0, 1.5))
    assert kinds(result) == ["reset"] * 2
    assert result.final == pytest.approx({"x": 0.5, "y": 5.0, "z": 1.0}, abs=1e-9)


def test_a_reset_to_what_is_not_finite_is_refused() -> None:
    with pytest.raises(SimulationError, match=r"events\[0\] sets 'z' to nan.*Correct its formula"):
        run(SWAP.replace("z: y + 10*x", "z: sqrt(-y)"))


@pytest.mark.parametrize(("crosses", "count"), [("up", 1), ("down", 1), ("both", 2)])
def test_a_reset_listens_to_its_direction(crosses: str, count: int) -> None:
    text = one(
        "cos(2*pi*t)",
        0.001,
        "  n: {type: integrator, of: zero}\n  zero: {type: constant, value: 0}",
    )
    events = f"events:\n  - {{when: x - 0.1, crosses: {crosses}, set: {{n: n + 1}}}}"
    result = run(text + events)
    assert result.final["n"] == count
    assert kinds(result).count("reset") == count


def test_a_reset_on_the_time_is_exact() -> None:
    text = one("1") + "events:\n  - {when: t - 0.3, crosses: up, set: {x: 5}}"
    result = run(text)
    assert [(event.time, event.kind) for event in result.events] == [(0.3, "reset")]
    assert result.final["x"] == pytest.approx(5.7)


def test_crossings_at_the_same_time_are_all_logged() -> None:
    more = "  y: {type: expression, formula: sign(x - 0.5) + sign(2*x - 1) + abs(0.5 - x)}"
    result = run(one("1", 0.0, more))
    assert [event.time for event in result.events] == pytest.approx([0.5, 0.5], abs=1e-12)
    assert {event.guard for event in result.events} == {"0.5 - x", "2*x - 1"}


def test_a_crossing_at_a_scheduled_time() -> None:
    text = """
span: [0, 3]
record: [y]
blocks:
  x: {type: integrator, of: one}
  one: {type: constant, value: 1}
  u: {type: step, height: 1, at: 1}
  y: {type: integrator, of: rate}
  rate: {type: expression, formula: u + (1 if x >= 1 else 0)}
"""
    result = run(text)
    assert sorted(kinds(result)) == ["crossing", "scheduled"]
    assert result["y"][-1] == pytest.approx(4.0)


def test_a_mode_that_a_reset_jumps_over_changes_with_it() -> None:
    text = one("1", 0.0, "  s: {type: sign, of: x}") + (
        "events:\n  - {when: x - 0.5, crosses: up, set: {x: -2}}"
    )
    result = run(text, record=("s",))
    assert [(event.kind, event.guard) for event in result.events] == [
        ("reset", "x - 0.5"),
        ("crossing", "x"),
    ]
    assert (result["s"][0], result["s"][-1]) == (1.0, -1.0)


def test_a_sample_at_an_event_is_the_right_limit() -> None:
    times = [0.0, 0.25, 0.5, 0.75, 1.0]
    text = one("1", 0.0, "  u: {type: step, height: 2, at: 0.5, offset: 1}")
    result = run(text, record=("u",), times=times)
    assert result["u"].tolist() == [1, 1, 3, 3, 3]
    reset = one("1") + "events:\n  - {when: t - 0.5, set: {x: 10}}"
    assert run(reset, times=times)["x"] == pytest.approx([0, 0.25, 10, 10.25, 10.5])
    end = one("1") + "events:\n  - {when: t - 1, set: {x: 10}}"
    assert run(end, times=times)["x"][-1] == 10.0


def test_floor_jumps_at_every_whole_number() -> None:
    """x' = k + 1 while x is between k/4 and (k + 1)/4: the times are a harmonic sum."""
    result = run(one("floor(4*x) + 1"), record=("rate",))
    times = np.cumsum([1 / (4 * k) for k in range(1, 31)])
    assert [event.time for event in result.events] == pytest.approx(times, abs=1e-9)
    assert result["rate"][-1] == 31.0


def test_a_table_of_a_state_bends_at_its_points_without_a_word() -> None:
    text = """
span: [0, 2]
record: [y]
blocks:
  x: {type: integrator, of: one, start: -0.5}
  one: {type: constant, value: 1}
  y: {type: table, of: x, points: [[0, 1], [0.5, 3], [1, 2]]}
  z: {type: integrator, of: y}
"""
    result = run(text, span=(0, 2), times=[0.25, 0.75, 1.25, 1.9], rtol=1e-8)
    assert result["y"] == pytest.approx([1, 2, 2.5, 2], abs=1e-12)
    assert result.events == ()
    assert result.final["z"] == pytest.approx(0.5 + 1 + 1.25 + 1, abs=1e-12)


def test_a_formula_may_be_undefined_beyond_its_guard() -> None:
    """x' = -1 - sqrt(x) reaches zero at 2 - 2 ln 2; there the root ends."""
    result = run(one("-1 - (sqrt(x) if x >= 0 else 0)", 1.0), rtol=1e-9)
    [event] = result.events
    assert event.time == pytest.approx(2 - 2 * math.log(2), abs=1e-8)
    assert result.final["x"] == pytest.approx(event.time - 1, abs=1e-8)


@pytest.mark.parametrize(("crosses", "count"), [("up", 3), ("down", 3), ("both", 6)])
def test_the_log_has_the_direction_that_an_event_waits_for(crosses: str, count: int) -> None:
    """sin(2*pi*t + 1) passes through 0.2 three times each way."""
    text = f"""
span: [0, 3]
blocks:
  s: {{type: sine, amplitude: 1, omega: 2*pi, phase: 1}}
  n: {{type: integrator, of: none}}
  none: {{type: constant, value: 0}}
events:
  - {{when: s - 0.2, crosses: {crosses}, set: {{n: n + 1}}}}
"""
    result = run(text)
    assert [event.kind for event in result.events] == ["reset"] * count
    assert {event.direction for event in result.events} <= {"up", "down"}
    assert result.final["n"] == count
