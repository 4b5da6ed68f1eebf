"""Crossings that no state feels: guards bound the step themselves."""

from __future__ import annotations

import math

import numpy as np
import pytest
import tracewire as tw
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from solve.logs import METHODS
from solve.models import LIMITS, made, run
from tracewire.errors import DiagramError, OptionError
from tracewire.solve import simulate

COUNTER = """
span: [0, 30]
record: [n]
parameters: {{w: 1, c: 0.5, ph: 0.3}}
blocks:
  s: {{type: expression, formula: "{formula}"}}
  n: {{type: counter, of: s, threshold: c}}
{more}
"""
OSCILLATOR = """
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  a: {type: gain, of: x, k: -1}
"""
ALONE = made(COUNTER.format(formula="sin(w*t + ph)", more=""))
BESIDE = made(COUNTER.format(formula="sin(w*t + ph)", more=OSCILLATOR))


def rises(w: float, c: float, ph: float, span: float = 30.0) -> int:
    """How often sin(w t + ph) rises over c."""
    first = (math.asin(c) - ph) / w
    turns = range(-2, int(span * w / 6) + 3)
    return sum(0 < first + 2 * math.pi * k / w <= span for k in turns)


@settings(max_examples=40, deadline=None)
@given(
    w=st.floats(0.5, 120),
    c=st.sampled_from([0.0, 0.5, 0.99, 0.9999, 0.999999]),
    ph=st.floats(-1.2, 1.2),
)
@example(w=2 * math.pi * 40, c=0.5, ph=0.3)  # a step of a tenth of the span is 120 whole turns
def test_each_rise_of_a_source_is_counted(w: float, c: float, ph: float) -> None:
    assume(abs(math.sin(ph) - c) > 1e-6 and abs(math.sin(30 * w + ph) - c) > 1e-6)
    values = {"w": w, "c": c, "ph": ph}
    for model in (ALONE, BESIDE):
        counted = simulate(model, parameters=values, rtol=1e-6)["n"][-1]
        assert counted == rises(w, c, ph)


@pytest.mark.parametrize("method", METHODS)
def test_a_cosine_that_begins_at_its_top_is_no_constant(method: str) -> None:
    result = run(
        COUNTER.format(formula="cos(2*pi*40*t)", more=""),
        method=method,
        limits=tw.Limits(steps=100_000),
    )
    assert result["n"][-1] == 1200


@pytest.mark.parametrize(
    ("formula", "count"),
    [
        ("exp(-((t - 17.3)/0.001)**2)", 1),
        ("1/(1 + ((t - 17.3)/0.001)**2)", 1),
        ("tanh((t - 11)/1e-4) - tanh((t - 11.001)/1e-4)", 1),
        ("sin(t*t)", 144),
        ("sin(20*t)*sin(0.3*t)", None),
        ("sin(30*sin(t))", None),
    ],
    ids=["a spike", "a resonance", "a pulse", "a chirp", "a beat", "a turn and back"],
)
def test_what_is_narrow_or_quick_is_found(formula: str, count: int | None) -> None:
    if count is None:
        fine = eval(formula, {"sin": np.sin, "t": np.linspace(0, 30, 3_000_001)}) - 0.5
        count = int(np.sum((fine[:-1] < 0) & (fine[1:] >= 0)))
    result = run(COUNTER.format(formula=formula, more=""), limits=tw.Limits(steps=100_000))
    assert result["n"][-1] == count


def test_a_position_that_turns_a_coded_disc_is_counted() -> None:
    """An encoder of 500 lines on an axis that turns to and fro: 0 to 1 rad and back, 4 times."""
    text = """
span: [0, 12.566370614359172]
record: [up]
blocks:
  q: {type: integrator, of: v, start: 0}
  v: {type: expression, formula: sin(2*t)}
  light: {type: expression, formula: sin(500*q + 0.1)}
  up: {type: counter, of: light, threshold: 0}
"""
    found = run(text, rtol=1e-8, limits=tw.Limits(steps=200_000))["up"][-1]
    rises_ = sum(0.1 < 2 * math.pi * k < 500.1 for k in range(200))
    falls = sum(0.1 < math.pi * (2 * k + 1) < 500.1 for k in range(200))
    assert found == 4 * (rises_ + falls)


def test_a_play_that_a_source_drives_is_at_no_end_unseen() -> None:
    """Against the recursion of the play operator over fine samples."""
    text = """
span: [0, 30]
record: [e]
blocks:
  p: {type: expression, formula: sin(t + 0.1) + 0.3*sin(5.3*t)}
  v: {type: expression, formula: cos(t + 0.1) + 1.59*cos(5.3*t)}
  e: {type: play_operator, of: p, rate: v, width: 0.9, start: 0.0998}
"""
    t = np.linspace(0, 30, 30_001)
    p = np.sin(t + 0.1) + 0.3 * np.sin(5.3 * t)
    expected, y = np.empty(len(t)), 0.0998
    for n, value in enumerate(p):
        y = expected[n] = min(max(y, value - 0.45), value + 0.45)
    found = run(text, times=t, rtol=1e-9, limits=LIMITS)["e"]
    assert found == pytest.approx(expected, abs=1e-5)


def test_the_longest_step_may_be_given() -> None:
    text = (
        "span: [0, 10]\nblocks:\n  x: {type: integrator, of: r}\n  r: {type: constant, value: 1}\n"
    )
    assert run(text).statistics.steps < 40
    assert run("max_step: 0.01\n" + text).statistics.steps >= 1000
    assert run("max_step: {value: 10, unit: ms}\n" + text).statistics.steps >= 1000
    limited = run("max_step: 5\n" + text, limits=tw.Limits(max_step=0.02))
    assert 500 <= limited.statistics.steps < 1000


def test_a_longest_step_of_nothing_is_refused() -> None:
    text = (
        "blocks:\n  x: {type: integrator, of: r}\n  r: {type: constant, value: 1}\nspan: [0, 1]\n"
    )
    with pytest.raises(DiagramError, match="'max_step' must be above zero, not 0 s"):
        run(text + "max_step: 0\n")
    with pytest.raises(OptionError, match="steps of 0 s at most lead nowhere"):
        run(text, limits=tw.Limits(max_step=0.0))


@pytest.mark.parametrize("phase", np.linspace(0.0, 0.4, 9).tolist())
def test_a_dip_before_a_crossing_in_the_same_part_of_a_step_is_found(phase: float) -> None:
    """A wave touches its level just where its slope, another guard, turns."""
    result = run(
        f"""
span: [0, 2]
record: [n]
blocks:
  p: {{type: expression, formula: sin(7*t - {phase})}}
  turns: {{type: sign, of: slope}}
  slope: {{type: expression, formula: cos(7*t - {phase})}}
  n: {{type: counter, of: p, threshold: 0.9995}}
  x: {{type: integrator, of: turns}}
""",
        limits=LIMITS,
    )
    assert result["n"][-1] == sum(math.pi / 2 + phase + 2 * math.pi * k < 14 for k in range(3))
