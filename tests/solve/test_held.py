"""Guards and resets that read what a slide holds: friction that sticks has the force it takes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from solve.logs import METHODS, TIGHT, log, when
from solve.models import made, run
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.solve import simulate

# friction holds the force t until it breaks away at t = 2; then it is 1
PULLED = """
span: [0, 3]
parameters: {pull: 1}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  friction: {type: dry_friction, rate: v, slip: 1, stick: 2}
  a: {type: expression, formula: pull*t + friction}
  holding: {type: expression, formula: -friction}
"""
COUNTED = "  z: {type: integrator, of: s}\n"
KEPT = "  w: {type: integrator, of: none}\n  none: {type: constant, value: 0}\n"


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("block", "total"),
    [
        ('{type: expression, formula: "1 if holding >= 0.7 else 0"}', 2.3),
        ('{type: expression, formula: "1 if holding > 1.5 else 0"}', 0.5),
        ('{type: expression, formula: "1 if holding >= 1.5*t - 0.25 else 0"}', 0.5),
        ('{type: expression, formula: "1 if t - 2 + 0.5*holding > 0 else 0"}', 5 / 3),
        ("{type: saturation, of: holding, low: 0, high: 0.5}", 1.375),
        ("{type: abs, of: friction}", 3.0),
        ('{type: expression, formula: "max(holding, 1)"}', 3.5),
        ('{type: expression, formula: "floor(2*holding)"}', 0.5 * (0 + 1 + 2 + 3) + 2),
        ("{type: relay, of: holding, on_at: 0.7, off_at: -1, on_value: 1, off_value: 0}", 2.3),
        ("{type: relay, of: holding, on_at: 1.2, off_at: 1.1, on_value: 1, off_value: 0}", 0.8),
    ],
)
def test_what_reads_a_held_friction_has_its_force(block: str, total: float, method: str) -> None:
    result = run(f"{PULLED}  s: {block}\n{COUNTED}", method=method, **TIGHT)
    assert result.final["z"] == pytest.approx(total, abs=1e-9)
    assert result.final["x"] == pytest.approx(2 / 3, abs=1e-9)  # nothing of it acts on the body


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("event", "instant"),
    [
        ("holding - 0.5, crosses: up", 0.5),
        ("friction + 1.75, crosses: down", 1.75),
        ("holding - 0.25 - 0.5*y, crosses: up", 0.5),  # beside a state that moves
        ("holding - y**2, crosses: down", 1.0),
        ("holding - 1.5, crosses: down", 2.0),  # where it breaks away it jumps from 2 to 1
    ],
)
def test_an_event_that_reads_a_held_friction_is_at_its_instant(
    event: str, instant: float, method: str
) -> None:
    text = f"""{PULLED}{KEPT}
  y: {{type: integrator, of: one}}
  one: {{type: constant, value: 1}}
events:
  - {{when: {event}, set: {{w: w + 1 + y}}}}
"""
    result = run(text, method=method, **TIGHT)
    assert [e.time for e in result.events if e.kind == "reset"] == pytest.approx(
        [instant], abs=1e-9
    )
    assert result.final["w"] == pytest.approx(1 + instant, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_counter_counts_the_rises_of_a_held_force(method: str) -> None:
    """sin(3*t) rises over 0.5 at (pi/6 + 2*pi*k)/3; the friction never lets go."""
    text = """
span: [0, 20]
blocks:
  v: {type: integrator, of: a}
  friction: {type: coulomb, rate: v, level: 1.5}
  a: {type: expression, formula: sin(3*t) + friction}
  c: {type: counter, of: holding, threshold: 0.5}
  holding: {type: expression, formula: -friction}
"""
    result = run(text, method=method, **TIGHT)
    rises = [(math.pi / 6 + 2 * math.pi * k) / 3 for k in range(10)]
    assert [e.time for e in result.events if e.kind == "reset"] == pytest.approx(rises, abs=1e-9)
    assert result.final["c"] == 10


@pytest.mark.parametrize("method", METHODS)
def test_a_block_on_a_belt_tells_the_force_that_carries_it(method: str) -> None:
    """It goes with the belt, x = t, until the spring pulls with 2*x = 3."""
    text = f"""
span: [0, 1.4]
blocks:
  x: {{type: integrator, of: v}}
  v: {{type: integrator, of: a, start: 1}}
  against: {{type: expression, formula: v - 1}}
  friction: {{type: dry_friction, rate: against, slip: 1, stick: 3}}
  a: {{type: expression, formula: friction - 2*x}}
{KEPT}
events:
  - {{when: friction - x - 0.8, crosses: up, set: {{w: w + friction}}}}
"""
    result = run(text, method=method, **TIGHT)
    assert log(result) == [("reset", "friction - x - 0.8", "up")]
    assert when(result) == pytest.approx([0.8], abs=1e-9)
    assert result.final["w"] == pytest.approx(1.6, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_held_frictions_of_two_bodies_are_told_apart(method: str) -> None:
    """The pull t on the upper body goes through the lower one; half of it holds a third body."""
    text = f"""
span: [0, 1.9]
blocks:
  v: {{type: integrator, of: a}}
  u: {{type: integrator, of: b}}
  against: {{type: expression, formula: v - u}}
  between: {{type: dry_friction, rate: against, slip: 2, stick: 2}}
  ground: {{type: dry_friction, rate: u, slip: 3, stick: 3}}
  a: {{type: expression, formula: t + between}}
  b: {{type: expression, formula: 0.5*t - between + ground}}
{KEPT}
events:
  - {{when: -between - 0.9, crosses: up, set: {{w: w + 1}}}}
  - {{when: -ground - 2.1, crosses: up, set: {{w: w + 10}}}}
"""
    result = run(text, method=method, **TIGHT)
    assert when(result) == pytest.approx([0.9, 1.4], abs=1e-9)
    assert result.final["w"] == 11


@pytest.mark.parametrize("method", METHODS)
def test_a_clock_samples_the_force_of_a_friction_that_holds(method: str) -> None:
    text = f"""{PULLED}{KEPT}
  still: {{type: integrator, of: none, start: 1}}
events:
  - {{every: 0.7, offset: 0.7, set: {{w: 10*w + holding, still: a}}}}
"""
    result = run(text, ("w", "still"), method=method, times=[1.0, 1.5, 2.5], **TIGHT)
    assert result["w"] == pytest.approx([0.7, 8.4, 85.0], abs=1e-9)  # it slips with 1 at t = 2.1
    assert result["still"] == pytest.approx([0.0, 0.0, 1.1], abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_narrow_pulse_breaks_a_held_body_loose(method: str) -> None:
    """Nothing moves before it, so that no error of a state asks for short steps."""
    text = """
span: [0, 30]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  friction: {type: coulomb, rate: v, level: 1}
  a: {type: expression, formula: "2*exp(-((t - 17.3)/0.01)**2) + friction"}
"""
    result = run(text, method=method, **TIGHT)
    loose = 17.3 - 0.01 * math.sqrt(math.log(2))
    assert [event.kind for event in result.events] == ["slip", "stick"]
    assert result.events[0].time == pytest.approx(loose, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_narrow_pulse_lifts_a_ball_that_lies(method: str) -> None:
    text = """
span: [0, 30]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  a: {type: expression, formula: "2000*exp(-((t - 17.3)/0.01)**2) - 10"}
events:
  - {when: x, crosses: down, set: {v: -0.5*v}}
"""
    result = run(text, method=method, **TIGHT)
    assert "slip" in [event.kind for event in result.events]
    assert np.max(result["x"]) > 0.1


TURNING = """
span: [0, 3]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  y: {type: integrator, of: speed, start: 1.5707963267948966}
  speed: {type: constant, value: 60}
"""


@pytest.mark.parametrize("method", METHODS)
def test_a_force_that_turns_with_a_state_breaks_a_held_body_loose_at_each_turn(method: str) -> None:
    """The state is a line, so that its error allows steps of many turns."""
    text = f"""{TURNING}
  friction: {{type: coulomb, rate: v, level: 1.9}}
  a: {{type: expression, formula: "2*cos(y) + friction"}}
"""
    result = run(text, method=method, **TIGHT)
    loose = (np.arange(1, 58) * math.pi - math.acos(0.95) - math.pi / 2) / 60
    found = [event.time for event in result.events if event.kind == "slip"]
    assert found == pytest.approx(loose.tolist(), abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_force_that_turns_with_a_state_lifts_a_ball_that_lies_at_each_turn(method: str) -> None:
    text = f"""{TURNING}
  a: {{type: expression, formula: "10.1*cos(y) - 10"}}
events:
  - {{when: x, crosses: down, set: {{v: 0}}}}
"""
    result = run(text, method=method, **TIGHT)
    loose = (np.arange(1, 29) * 2 * math.pi - math.acos(10 / 10.1) - math.pi / 2) / 60
    found = [event.time for event in result.events if event.kind == "slip"]
    assert found == pytest.approx(loose.tolist(), abs=1e-9)


def test_the_instant_at_a_held_force_moves_with_its_parameters() -> None:
    """At 0.5/pull z begins to rise: dz/dpull = 0.5/pull**2; the written force is 0.5 always."""
    text = f"""{PULLED}{KEPT}
  s: {{type: expression, formula: "1 if holding >= 0.5 else 0"}}
{COUNTED}
events:
  - {{when: holding - 0.5, crosses: up, set: {{w: holding + t}}}}
"""
    model = compile(read_text(text), record=("z", "w"))
    result = simulate(model, times=[0.2, 1.0], sensitivities=["pull"], **TIGHT)
    assert result.sensitivities is not None
    moved = result.sensitivities["pull"]
    assert moved["z"] == pytest.approx([0.0, 0.5], abs=1e-8)
    assert moved["w"] == pytest.approx([0.0, -0.5], abs=1e-8)


def test_the_python_back_end_reads_the_same() -> None:
    text = f'{PULLED}  s: {{type: expression, formula: "1 if holding > 0.7 else 0"}}\n{COUNTED}'
    slow = simulate(compile(read_text(text), backend="python"))
    quick = simulate(made(text))
    assert slow.final == quick.final
    assert when(slow) == when(quick)
