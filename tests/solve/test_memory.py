"""Blocks with memory, sampling and limits, against exact solutions."""

from __future__ import annotations

import math

import numpy as np
import pytest
from solve.models import kinds, run
from tracewire.errors import DiagramError

TRIANGLE = """
span: [0, 7]
blocks:
  x: {type: integrator, of: rate, start: 0.5}
  relay: {type: relay, of: x, on_at: 1, off_at: 0}
  rate: {type: expression, formula: 1 - 2*relay}
record: [x, relay]
"""


def test_a_relay_switches_at_its_two_levels() -> None:
    result = run(TRIANGLE, times=[0.25, 0.75, 1.75, 3.0])
    moves = [event for event in result.events if event.kind == "transition"]
    assert [event.time for event in moves] == pytest.approx([0.5, 1.5, 2.5], abs=1e-10)
    assert {event.block for event in moves} == {"relay"}
    assert result["x"] == pytest.approx([0.75, 0.75, 0.25, 0.5], abs=1e-10)
    assert result["relay"].tolist() == [0, 1, 0, 1]


@pytest.mark.parametrize(
    ("start", "operated", "first"), [(0.5, 0, 0), (0.5, 1, 1), (1.5, 0, 1), (-1, 1, 0), (1, 0, 1)]
)
def test_a_relay_starts_as_told_where_its_signal_leaves_both_open(
    start: float, operated: int, first: float
) -> None:
    text = TRIANGLE.replace("start: 0.5", f"start: {start}")
    text = text.replace("off_at: 0", f"off_at: 0, on_value: 1, start: {operated}")
    assert run(text, span=(0, 0.25))["relay"][0] == first


def test_a_relay_whose_levels_are_the_wrong_way_round_is_refused_by_name() -> None:
    with pytest.raises(DiagramError, match=r"'relay': .* must meet off_at <= on_at"):
        run(TRIANGLE.replace("off_at: 0", "off_at: 2"))


BACKLASH = """
span: [0, 12]
blocks:
  u: {type: sine, amplitude: 2, omega: 1}
  w: {type: sine, amplitude: 2, omega: 1, phase: pi/2}
  play: {type: play_operator, of: u, rate: w, width: 1}
record: [play]
"""


def test_backlash_follows_at_either_end_of_its_gap() -> None:
    """Up from asin(1/4) to the peak, held until 2 sin t = 1, down to the trough, held, and up."""
    t = np.array([0.1, 1.0, 2.0, 2.5, 3.0, 4.0, 5.0, 7.0, 8.0])
    result = run(BACKLASH, times=t, rtol=1e-10)
    u = 2 * np.sin(t)
    exact = [0, u[1] - 0.5, 1.5, 1.5, u[4] + 0.5, u[5] + 0.5, -1.5, u[7] - 0.5, 1.5]
    assert result["play"] == pytest.approx(exact, abs=1e-9)
    left = [event.time for event in result.events if event.kind == "transition"]
    turns = [math.asin(0.25), math.pi / 2, 5 * math.pi / 6, 3 * math.pi / 2]
    assert left[:4] == pytest.approx(turns, abs=1e-9)


def test_backlash_without_a_gap_is_its_input() -> None:
    t = np.linspace(0.05, 12, 40)
    result = run(BACKLASH.replace("width: 1", "width: 0"), times=t)
    assert result["play"] == pytest.approx(2 * np.sin(t), abs=1e-12)


LATCH = """
span: [0, 12]
blocks:
  s: {type: sine, amplitude: 1, omega: 1}
  r: {type: sine, amplitude: 1, omega: 1, phase: pi/2}
  latch: {type: latch, set: s, reset: r}
record: [latch]
"""


def test_a_latch_is_set_where_it_is_not_reset() -> None:
    """sin t >= 1/2 from pi/6, but cos t >= 1/2 resets until pi/3, and again from 5 pi/3."""
    times = [0.3, 0.6, 1.04, 1.06, 4.0, 5.2, 5.3, 6.5, 7.4]
    result = run(LATCH, times=times)
    assert result["latch"].tolist() == [0, 0, 0, 1, 1, 1, 0, 0, 1]
    moves = [event.time for event in result.events if event.kind == "transition"]
    assert moves == pytest.approx([math.pi / 3, 5 * math.pi / 3, 7 * math.pi / 3], abs=1e-9)


def test_memories_that_move_each_other_do_so_at_one_instant() -> None:
    text = TRIANGLE.replace(
        "record: [x, relay]",
        "  never: {type: constant, value: 0}\n"
        "  seen: {type: latch, set: relay, reset: never}\n"
        "  more: {type: latch, set: seen, reset: never}\n"
        "record: [x, seen, more]",
    )
    result = run(text, times=[0.25, 0.75, 3.0])
    assert result["more"].tolist() == result["seen"].tolist() == [0, 1, 1]
    first = [event for event in result.events if event.kind == "transition"][:3]
    assert [event.time for event in first] == pytest.approx([0.5] * 3, abs=1e-10)


WAVE = """
span: [0, 3]
blocks:
  wave: {type: sine, amplitude: 1, omega: 2*pi}
  clock: {type: time}
  toggle: {type: toggle, of: wave}
  counter: {type: counter, of: wave, start: 10}
  sampled: {type: sample_and_hold, of: clock, trigger: wave, start: -1}
  one: {type: constant, value: 1}
  saw: {type: reset_integrator, of: one, trigger: wave, start: 5, value: clock}
  tooth: {type: reset_integrator, of: one, trigger: wave, start: 0.25}
record: [toggle, counter, sampled, saw, tooth]
"""


def test_edges_of_a_wave_are_counted_toggled_sampled_and_reset() -> None:
    """The wave rises over 1/2 at k + 1/12; the trigger is no edge where the run starts above."""
    first = 1 / 12
    result = run(WAVE, times=[0.05, 0.5, 1.5, 2.5], rtol=1e-10)
    assert result["toggle"].tolist() == [0, 1, 0, 1]
    assert result["counter"].tolist() == [10, 11, 12, 13]
    assert result["sampled"] == pytest.approx([-1, first, 1 + first, 2 + first], abs=1e-10)
    assert result["saw"] == pytest.approx([5.05, 0.5, 1.5, 2.5], abs=1e-9)
    tooth = [0.3, *[0.25 + 0.5 - first] * 3]
    assert result["tooth"] == pytest.approx(tooth, abs=1e-9)
    assert run(WAVE, span=(0.2, 0.4))["counter"].tolist()[-1] == 10


CLOCKED = """
span: [0, 2]
parameters: {T: 0.3, shift: 0}
blocks:
  now: {type: time}
  hold: {type: zero_order_hold, of: now, period: T, offset: shift, start: -7}
  later: {type: zero_order_hold, of: hold, period: T, offset: shift, start: -8}
record: [hold, later]
"""


def test_a_zero_order_hold_samples_at_even_times_and_at_the_start() -> None:
    result = run(CLOCKED, times=[0.0, 0.2, 0.3, 0.5, 0.6, 1.99])
    assert result["hold"] == pytest.approx([0, 0, 0.3, 0.3, 0.6, 1.8], abs=1e-12)
    # both sample at the same time what was before
    assert result["later"] == pytest.approx([-7, -7, 0, 0, 0.3, 1.5], abs=1e-12)


def test_a_shifted_hold_gives_its_start_until_the_first_sample() -> None:
    shifted = {"shift": 0.1, "T": 0.5}
    result = run(CLOCKED, times=[0.0, 0.09, 0.1, 0.59, 0.6], parameters=shifted)
    assert result["hold"] == pytest.approx([-7, -7, 0.1, 0.1, 0.6], abs=1e-12)
    early = run(CLOCKED, times=[-0.5, -0.3, 0.2], span=(-0.5, 0.2), parameters=shifted)
    assert early["hold"] == pytest.approx([-7, -7, 0.1], abs=1e-12)


def test_a_sampled_controller_gives_the_exact_difference_equation() -> None:
    text = """
span: [0, 3]
blocks:
  x: {type: integrator, of: u, start: 1}
  seen: {type: zero_order_hold, of: x, period: 0.25}
  u: {type: gain, of: seen, k: -3}
"""
    result = run(text, times=[0.25 * k for k in range(13)])
    assert result["x"] == pytest.approx([0.25**k for k in range(13)], abs=1e-12)


def test_a_diagram_may_have_a_clock_of_its_own() -> None:
    text = """
span: [0, 1]
blocks:
  n: {type: integrator, of: zero}
  zero: {type: constant, value: 0}
events:
  - {every: {value: 200, unit: ms}, offset: 0.1, set: {n: n + 1}}
"""
    result = run(text, times=[0.05, 0.1, 0.29, 0.31, 1.0])
    assert result["n"].tolist() == [0, 1, 1, 2, 5]


LIMITED = """
span: [0, 9]
blocks:
  rate: {type: sine, amplitude: 1, omega: 1, phase: pi/2}
  y: {type: limited_integrator, of: rate, low: -0.5, high: 0.5}
record: [y]
"""


def test_a_limited_integrator_stops_and_leaves_its_limits_with_its_signal() -> None:
    t = np.array([0.4, 1.0, 1.5, 2.0, 3.0, 3.2, 4.7, 5.0, 7.0, 8.0])
    result = run(LIMITED, times=t, rtol=1e-10)
    s = np.sin(t)
    exact = [s[0], 0.5, 0.5, s[3] - 0.5, s[4] - 0.5, -0.5, -0.5, s[7] + 0.5, 0.5, s[9] - 0.5]
    assert result["y"] == pytest.approx(exact, abs=1e-9)


def test_a_rate_limiter_is_exact_where_its_signal_is_slow_enough() -> None:
    """After the step at t = 1 it rises at 2, meets the sine again, and follows it."""
    text = """
span: [0, 6]
blocks:
  slow: {type: sine, amplitude: 0.5, omega: 1}
  step: {type: step, height: 3, at: 1}
  u: {type: sum, of: [slow, step]}
  y: {type: rate_limiter, of: u, rising: 2, falling: 1}
record: [y]
"""
    t = np.array([0.5, 0.999, 1.5, 2.0, 4.0, 6.0])
    result = run(text, times=t, rtol=1e-10)
    u = 0.5 * np.sin(t) + 3 * (t >= 1)
    rising = 0.5 * math.sin(1) + 2 * (t - 1)
    assert result["y"] == pytest.approx(np.where((t > 1) & (rising < u), rising, u), abs=1e-8)
    assert "stick" in kinds(result)
