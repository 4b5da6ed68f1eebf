"""Events whose guard only jumps: they fire at the instant of the jump, whatever makes it."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from solve.logs import METHODS
from solve.models import made, run
from tracewire.errors import SimulationError
from tracewire.solve import Run, simulate

RISING = """
span: [0, 2]
blocks:
  x: {type: integrator, of: one}
  one: {type: constant, value: 1}
  n: {type: integrator, of: zero}
  zero: {type: constant, value: 0}
  SOURCE
events:
  - {when: GUARD, crosses: CROSSES, set: {n: n + 1}}
  MORE
"""


def rising(guard: str, source: str = "", crosses: str = "both", more: str = "") -> str:
    """x' = 1, and an event that counts the jumps of a guard in n."""
    text = RISING.replace("SOURCE", source).replace("GUARD", guard)
    return text.replace("CROSSES", crosses).replace("MORE", more)


def fired(result: Run) -> list[tuple[float, str]]:
    """Time and direction of each reset of the first event."""
    return [
        (round(event.time, 10), event.direction)
        for event in result.events
        if event.kind == "reset" and event.block == "events[0]"
    ]


WAVE = "wave: {type: square, amplitude: 1, frequency: 1}"
ALL = [(0.5, "down"), (1.0, "up"), (1.5, "down"), (2.0, "up")]


@pytest.mark.parametrize("method", METHODS)
def test_a_square_wave_resets_at_its_jumps(method: str) -> None:
    text = rising("wave", WAVE).replace("n: n + 1", "x: 10")
    result = run(text, times=[0.4, 0.6, 0.9, 1.25, 1.75, 2.0], method=method)
    assert fired(result) == ALL
    assert result["x"] == pytest.approx([0.4, 10.1, 10.4, 10.25, 10.25, 10], abs=1e-12)
    assert [e.kind for e in result.events] == ["reset", "scheduled"] * 4


@pytest.mark.parametrize(("crosses", "wanted"), [("up", ALL[1::2]), ("down", ALL[::2])])
def test_a_direction_is_kept(crosses: str, wanted: list[tuple[float, str]]) -> None:
    assert fired(run(rising("wave", WAVE, crosses))) == wanted
    turned = {"up": "down", "down": "up"}
    mirrored = [(time, turned[way]) for time, way in wanted]
    assert fired(run(rising("-wave", WAVE, turned[crosses]))) == mirrored


@pytest.mark.parametrize(
    ("guard", "source", "wanted"),
    [
        ("2*sign(x - 0.7) - 1", "", [(0.7, "up")]),
        ("(1 if x >= 0.25 and x < 1.5 else -1)", "", [(0.25, "up"), (1.5, "down")]),
        ("floor(3*x) - 2", "", [(0.6666666667, "up")]),
        ("u", "u: {type: step, height: 2, at: 0.3, offset: -1}", [(0.3, "up")]),
        ("u", "u: {type: step, height: 2, at: 0.3}", [(0.3, "up")]),
        ("relay", "relay: {type: relay, of: x, on_at: 1.25, off_at: 0}", [(1.25, "up")]),
        ("held - 0.8", "held: {type: zero_order_hold, of: x, period: 0.5}", [(1.0, "up")]),
        ("k", "k: {type: sign, of: u}\n  u: {type: sum, of: [x, -one]}", [(1.0, "up")]),
    ],
)
def test_whatever_makes_it_jump(guard: str, source: str, wanted: list[tuple[float, str]]) -> None:
    result = run(rising(guard, source))
    assert fired(result) == wanted
    assert result.final["n"] == len(wanted)


@pytest.mark.parametrize(
    ("levels", "wanted"),
    [
        ([-1, 0, 1], [(1.0, "up")]),
        ([1, 0, -1], [(1.0, "down")]),
        ([-1, 0, -1, 1], [(1.0, "up"), (2.0, "down"), (3.0, "up")]),
        ([0, 1, 0, 1], [(1.0, "up"), (2.0, "down"), (3.0, "up")]),
        ([0, -1, 0, -1], [(1.0, "down"), (2.0, "up"), (3.0, "down")]),
        ([0, 0, 1], [(2.0, "up")]),
        ([2, 1, 3, -1], [(3.0, "down")]),
    ],
)
def test_a_passage_over_zero_fires_once(levels: list[int], wanted: list[tuple[float, str]]) -> None:
    steps = " + ".join(
        f"{b - a}*(1 if t >= {n} else 0)" for n, (a, b) in enumerate(pairwise(levels), start=1)
    )
    text = rising("u", f'u: {{type: expression, formula: "{levels[0]} + {steps}"}}')
    assert fired(run(text, span=(0, len(levels)))) == wanted


def test_a_start_fires_nothing() -> None:
    assert fired(run(rising("wave", WAVE), span=(0.5, 0.9))) == []
    held = "held: {type: relay, of: x, on_at: 5, off_at: -5, start: 0}"
    assert fired(run(rising("held - 0.5", held))) == []


def test_a_counter_that_an_event_carries_back_counts_on() -> None:
    """n goes 1, 2, 0, 1, 2, 0: its own event resets it at the instant of the tick."""
    text = rising("n - 3", "m: {type: integrator, of: zero}", "up")
    text = text.replace("{n: n + 1}", "{n: 0, m: m + 1}")
    text = text.replace("MORE", "").rstrip() + "\n  - {every: 0.1, offset: 0.1, set: {n: n + 1}}\n"
    result = run(text)
    assert (result.final["n"], result.final["m"]) == (20 % 3, 20 // 3)


def test_blocks_with_events_take_signals_that_jump() -> None:
    text = """
span: [0, 2]
blocks:
  x: {type: integrator, of: one}
  one: {type: constant, value: 1}
  wave: {type: square, amplitude: 1, frequency: 1, phase: -pi/4}
  toggle: {type: toggle, of: wave}
  again: {type: toggle, of: toggle}
  counter: {type: counter, of: wave}
  sampled: {type: sample_and_hold, of: x, trigger: wave}
record: [toggle, again, counter, sampled]
"""
    result = run(text, times=[0.1, 0.2, 1.1, 1.2])
    assert result["toggle"].tolist() == [0, 1, 1, 0]
    assert result["again"].tolist() == [0, 1, 1, 1]
    assert result["counter"].tolist() == [0, 1, 1, 2]
    assert result["sampled"] == pytest.approx([0, 0.125, 0.125, 1.125], abs=1e-12)


def test_two_events_of_one_jump_read_the_same_and_write_together() -> None:
    text = rising("wave", WAVE, "up", "- {when: wave, crosses: up, set: {x: n}}")
    result = run(text, span=(0, 1.6), times=[0.9, 1.0])
    assert result["x"] == pytest.approx([0.9, 0.0], abs=1e-12)
    assert result.final["n"] == 1


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("guard", "crosses", "wanted"),
    [
        ("wave + 0.1*sin(20*t)", "both", ALL),
        ("wave + 0.1*sin(20*t)", "up", ALL[1::2]),
        ("-wave + 0.1*sin(20*x)", "up", [(0.5, "up"), (1.5, "up")]),
        ("x - 0.7 - wave/4", "both", [(0.5, "up")]),
        ("t - 0.7 - wave/4", "both", [(0.5, "up")]),
        ("(x - 0.3)*wave", "both", [(0.3, "up"), *ALL]),
        ("x - 0.7 + wave/4", "both", [(0.45, "up"), (0.5, "down"), (0.95, "up")]),
        ("t - 0.7 + wave/4", "both", [(0.45, "up"), (0.5, "down"), (0.95, "up")]),
    ],
)
def test_guards_that_move_as_well_fire_where_they_pass_zero_and_where_they_jump_over_it(
    guard: str, crosses: str, wanted: list[tuple[float, str]], method: str
) -> None:
    assert fired(run(rising(guard, WAVE, crosses), method=method)) == wanted


def test_a_counter_counts_a_trigger_with_a_ripple() -> None:
    text = """
span: [0, 2.2]
blocks:
  wave: {type: square, amplitude: 1, frequency: 5}
  ripple: {type: sine, amplitude: 0.1, omega: 400}
  noisy: {type: sum, of: [wave, ripple]}
  clean: {type: counter, of: wave}
  count: {type: counter, of: noisy, threshold: 0.5}
  toggle: {type: toggle, of: noisy}
record: [clean, count, toggle]
"""
    result = run(text)
    assert result["clean"][-1] == result["count"][-1] == 11
    assert result["toggle"][-1] == 1


def test_a_reset_that_carries_another_guard_over_zero_sets_it_off() -> None:
    """At 1 n becomes 2 and carries the guard of the second event up; this one carries n back."""
    more = "- {when: n - 1 + x/100, crosses: up, set: {n: n - 10}}"
    result = run(rising("x - 1", more=more, crosses="up").replace("n: n + 1", "n: n + 2"))
    times = [(event.time, event.block) for event in result.events if event.kind == "reset"]
    assert times == [(pytest.approx(1.0), "events[0]"), (pytest.approx(1.0), "events[1]")]
    assert result.final["n"] == -8


def test_a_mode_of_a_line_in_time_follows_the_jumps_of_the_line() -> None:
    """t - 0.7 + wave/2 is above zero on [0.2, 0.5] and from 1 on."""
    source = f"""{WAVE}
  above: {{type: expression, formula: "1 if t - 0.7 + wave/2 >= 0 else 0"}}
  z: {{type: integrator, of: above}}"""
    assert run(rising("x - 9", source)).final["z"] == pytest.approx(1.3, abs=1e-12)


def test_two_jumps_that_write_one_state_differently_are_an_error() -> None:
    text = rising("wave", WAVE, "up", "- {when: wave, crosses: up, set: {n: n + 2}}")
    with pytest.raises(SimulationError) as caught:
        run(text)
    assert str(caught.value) == (
        "<text>:6:3: block 'n': two resets write 'n' at t = 1 s: events[0] gives 1, "
        "events[1] gives 2. Merge the two events."
    )
    assert run(text.replace("n + 2", "1 + n")).final["n"] == 2


def test_a_jump_that_carries_a_body_over_its_stop_is_an_error() -> None:
    source = "stop: {type: hard_stop, force: zero, high: 1, low: -1}"
    text = rising("x - 1", source, "up").replace("n: n + 1", "stop.x: 3")
    with pytest.raises(SimulationError, match=r"a jump carries 'stop.x - 1' from -1 to 2, over"):
        run(text)


def test_a_guard_of_parameters_alone_never_fires() -> None:
    text = rising("k").replace("blocks:", "parameters: {k: 1}\nblocks:")
    assert run(text).events == ()


def test_events_that_set_each_other_off_without_end_are_an_error() -> None:
    text = rising("n", more="- {every: 0.5, offset: 0.5, set: {n: -1}}")
    text = text.replace("n: n + 1", "n: -n").replace("of: zero}", "of: zero, start: 1}", 1)
    with pytest.raises(SimulationError) as caught:
        run(text)
    assert str(caught.value) == (
        "<text>:10:5: the event 'events[0]' fires again and again at t = 0.5 s. "
        "Let what they set not carry their guards back over zero, or give one 'crosses: up'."
    )

    text = text.replace("when: n,", "when: n + x/100,")
    with pytest.raises(SimulationError, match=r"the event 'events.0.' fires again and again"):
        run(text)


DRIVEN = """
span: [0, 2]
parameters: {f: 1.1, r: 0.7, top: 0.3}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a, start: 1}
  a: {type: gain, of: x, k: -3}
  wave: {type: square, amplitude: 1, frequency: f}
  relay: {type: relay, of: x, on_at: top, off_at: -0.2}
events:
  - {when: wave, crosses: up, set: {v: -r*v + x}}
  - {when: relay - 0.5, set: {x: 1.1*x + r, v: 0.9*v}}
"""


@pytest.mark.parametrize("guard", ["wave", "wave + 0.1*x"])
def test_sensitivities_go_through_them(guard: str) -> None:
    model, names = (
        made(DRIVEN.replace("when: wave", f"when: {guard}")),
        {"f": 1.1, "r": 0.7, "top": 0.3},
    )
    options: dict[str, Any] = {"times": [0.2, 0.7, 1.0, 1.3, 1.9], "rtol": 1e-11}
    result = simulate(model, sensitivities=list(names), **options)
    for name, value in names.items():
        low, high = (
            simulate(model, parameters={name: value + h}, **options) for h in (-1e-6, 1e-6)
        )
        for state in ("x", "v"):
            exact = (high[state] - low[state]) / 2e-6
            assert np.abs(result.sensitivities[name][state] - exact).max() < 1e-6
    resets = [event for event in result.events if event.kind == "reset"]
    assert [event.sensitivity["f"] for event in resets[1:]] == pytest.approx(
        [-1 / 1.1**2, -2 / 1.1**2]
    )
