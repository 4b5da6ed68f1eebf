"""What happens at the very instant of something else, as it does where numbers are round."""

from __future__ import annotations

import pytest
from solve.logs import METHODS
from solve.models import kinds, run

TICKS = """
events:
  - {every: 1, offset: 1, set: {ticks: ticks + 1}}
"""
TICKED = """
  ticks: {type: integrator, of: none}
  none: {type: constant, value: 0}
"""


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rate", [1.0, 0.5, 1 / 3, 1e-3, 1e-6])
def test_a_rise_through_a_level_at_a_tick_of_a_clock_is_counted(rate: float, method: str) -> None:
    """x reaches 1 at 2 s, when a clock ticks. As it came, the rise was lost."""
    found = run(
        f"""
span: [0, 4.5]
blocks:
  one: {{type: constant, value: {rate!r}}}
  x: {{type: integrator, of: one, start: {1 - 2 * rate!r}}}
  c: {{type: counter, of: x, threshold: 1}}
{TICKED}
{TICKS}""",
        method=method,
    )
    assert found.final["c"] == 1
    assert found.final["ticks"] == 4


@pytest.mark.parametrize("method", METHODS)
def test_a_ball_bounces_off_a_floor_at_a_tick_of_a_clock(method: str) -> None:
    """It falls from 1 under 2, meets the floor at 1 s and at 2 s, and rests there at 3 s. As it
    came, it fell through the floor."""
    found = run(
        f"""
span: [0, 4.5]
record: [ball.x]
blocks:
  weight: {{type: constant, value: -2}}
  ball: {{type: bouncing_body, force: weight, start: 1, restitution: 0.5}}
{TICKED}
{TICKS}""",
        method=method,
        times=[0.5, 1.5, 2.25, 4.0],
    )
    assert found["ball.x"] == pytest.approx([0.75, 0.25, 0.0625, 0.0], abs=1e-9)
    assert found.final["ticks"] == 4


@pytest.mark.parametrize("method", METHODS)
def test_an_impact_and_a_tick_read_what_was_before_both(method: str) -> None:
    """The tick at 1 s records the rate at which the ball meets the floor."""
    found = run(
        """
span: [0, 1.5]
blocks:
  weight: {type: constant, value: -2}
  ball: {type: bouncing_body, force: weight, start: 1, restitution: 0.5}
  seen: {type: integrator, of: none}
  none: {type: constant, value: 0}
events:
  - {every: 1, offset: 1, set: {seen: ball.v}}
""",
        method=method,
    )
    assert found.final["seen"] == pytest.approx(-2, abs=1e-9)
    assert found.final["ball.v"] == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("points", "rises"),
    [
        ("[[0, 0], [1, 1], [2, 3]]", 1),
        ("[[0, 0], [0.7, 1], [2, 3]]", 1),
        ("[[0, 0], [0.7, 1], [2, 1], [3, 2]]", 1),
        ("[[0, 0], [1, 2], [2, 0], [3, 2]]", 2),
    ],
)
def test_a_level_at_a_point_of_a_table_is_reached(points: str, rises: int, method: str) -> None:
    found = run(
        f"""
span: [0, 3]
blocks:
  u: {{type: table, points: {points}}}
  c: {{type: counter, of: u, threshold: 1}}
""",
        method=method,
    )
    assert found.final["c"] == rises


@pytest.mark.parametrize("method", METHODS)
def test_friction_takes_hold_at_a_tick_of_a_clock(method: str) -> None:
    """From 1 under a friction of 1 a body comes to rest at 1 s, against a push of 0.25 later on."""
    found = run(
        f"""
span: [0, 2.5]
blocks:
  v: {{type: integrator, of: a, start: 1}}
  friction: {{type: dry_friction, rate: v, slip: 1, stick: 1}}
  push: {{type: expression, formula: "0 if t < 1 else 0.25"}}
  a: {{type: sum, of: [friction, push]}}
{TICKED}
{TICKS}""",
        method=method,
    )
    assert found.final["v"] == pytest.approx(0.0, abs=1e-12)
    assert [event.time for event in found.events if event.kind == "stick"] == [1.0]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("late", [0.0, 1e-13, -1e-13])
def test_friction_that_reaches_its_limit_for_a_moment_at_a_tick_slips(
    late: float, method: str
) -> None:
    """The push is (1 + 1e-5) - (t - 1 - w)^2 with w^2 = 1e-5: beyond the limit from 1 s on, for
    6.3 ms. What sliding friction, of 0.9, leaves then moves the body for longer."""
    found = run(
        f"""
span: [0, 1.4]
blocks:
  x: {{type: integrator, of: v}}
  v: {{type: integrator, of: a}}
  friction: {{type: dry_friction, rate: v, slip: 0.9, stick: 1}}
  push: {{type: expression, formula: "1.00001 - (t - 1 - sqrt(1e-5))**2"}}
  a: {{type: sum, of: [friction, push]}}
{TICKED}
{TICKS.replace("offset: 1", f"offset: {1 + late!r}")}""",
        method=method,
    )
    left = 0.4 - 1e-5**0.5
    v = 0.10001 * 0.4 - (left**3 + 1e-5**1.5) / 3
    assert found.final["v"] == pytest.approx(v, rel=1e-6)
    assert [event.kind for event in found.events if event.block == "friction"] == ["slip"]


@pytest.mark.parametrize("method", METHODS)
def test_friction_that_reaches_its_limit_at_a_tick_and_stays_there_holds(method: str) -> None:
    found = run(
        f"""
span: [0, 2.5]
blocks:
  v: {{type: integrator, of: a}}
  friction: {{type: dry_friction, rate: v, slip: 0.9, stick: 1}}
  push: {{type: expression, formula: "t if t < 1 else 1"}}
  a: {{type: sum, of: [friction, push]}}
{TICKED}
{TICKS}""",
        method=method,
    )
    assert found.final["v"] == 0.0
    assert [event.kind for event in found.events if event.block == "friction"] == []


def test_what_fades_crosses_nothing() -> None:
    """exp(-t) falls below all rounding of its start, and never reaches zero."""
    found = run(
        f"""
span: [0, 200]
blocks:
  x: {{type: integrator, of: rate, start: 1}}
  rate: {{type: gain, of: x, k: -1}}
  c: {{type: integrator, of: none}}
{TICKED}
{TICKS}  - {{when: x, crosses: down, set: {{c: c + 1}}}}
"""
    )
    assert found.final["c"] == 0


def test_events_of_one_guard_have_each_their_name_in_the_log() -> None:
    found = run(
        f"""
span: [0, 1.5]
blocks:
  one: {{type: constant, value: 1}}
  x: {{type: integrator, of: one}}
  c: {{type: counter, of: x, threshold: 1}}
{TICKED}
events:
  - {{when: x - 1, crosses: both, set: {{ticks: ticks + 1}}}}
"""
    )
    assert [event.block for event in found.events] == ["c", "events[0]"]


@pytest.mark.parametrize("method", METHODS)
def test_an_impact_a_tick_and_a_step_at_one_instant(method: str) -> None:
    """At 1 s the tick records a step as it is behind it, and the rate with which the ball meets the
    floor as it was before it; a sign of the step and a counter of it are behind it, too."""
    found = run(
        """
span: [0, 1.5]
blocks:
  weight: {type: constant, value: -2}
  ball: {type: bouncing_body, force: weight, start: 1, restitution: 0.5}
  jump: {type: step, at: 1, height: 5, offset: -1}
  limited: {type: saturation, of: jump, low: -1, high: 1}
  rises: {type: counter, of: jump, threshold: 0}
  seen: {type: integrator, of: none}
  taken: {type: integrator, of: none}
  kept: {type: integrator, of: none}
  counted: {type: integrator, of: none, start: 7}
  none: {type: constant, value: 0}
events:
  - {every: 1, offset: 1, set: {seen: ball.v, taken: jump, kept: limited, counted: rises}}
""",
        method=method,
    )
    final = found.final
    assert [final["taken"], final["kept"], final["counted"]] == pytest.approx([4, 1, 1], abs=1e-12)
    assert final["seen"] == pytest.approx(-2, abs=1e-9)
    assert final["ball.v"] == pytest.approx(0, abs=1e-9)
    assert kinds(found).count("impact") == 1
