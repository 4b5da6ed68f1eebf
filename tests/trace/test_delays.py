"""A trace of a diagram whose loop has a delay: what was before a window is in the record."""

from __future__ import annotations

import numpy as np
import pytest
import tracewire as tw
from tracewire.errors import OptionError
from tracewire.residual import Measured
from tracewire.trace import trace

SERVO = """
span: [0, 20]
record: [angle]
parameters:
  c: {value: 0.3, fit: [0, 3]}
  k: {value: 4, unit: 1/s^2, fit: [0.5, 10]}
blocks:
  angle: {type: integrator, of: rate, start: 1, unit: rad}
  rate: {type: integrator, of: acceleration, unit: rad/s}
  target: {type: expression, formula: 1.5*sin(0.7*t) + sin(1.9*t), unit: rad}
  error: {type: sum, of: [target, -angle]}
  late: {type: delay, of: error, time: 0.15, before: -1}
  pull: {type: gain, of: late, k: k}
  damping: {type: viscous, rate: rate, c: c}
  acceleration: {type: sum, of: [pull, damping]}
"""
RUB = "  rub: {type: coulomb, rate: rate, level: 0.6}\n"
T = np.linspace(0, 20, 1001)
SIGMA = 2e-3


def measured(text: str) -> Measured:
    """A record of another k and c, with white noise."""
    model = tw.compile(tw.read_text(text))
    run = tw.simulate(model, times=T, parameters={"c": 0.4, "k": 4.5}, rtol=1e-9)
    noise = SIGMA * np.random.default_rng(1).standard_normal(len(T))
    start = {"angle": None, "rate": None}
    return Measured(
        "run", "train", T, {"angle": run["angle"] + noise}, {"angle": SIGMA}, start=start
    )


def test_a_trace_finds_a_friction_in_a_loop_with_a_delay() -> None:
    hidden = SERVO.replace("[pull, damping]", "[pull, damping, rub]") + RUB
    found = trace(tw.compile(tw.read_text(SERVO)), [measured(hidden)])
    assert [str(effect) for effect in found.effects] == ["coulomb @ acceleration"]
    assert found.effects[0].params["level"] == pytest.approx(0.6, rel=2e-3)
    assert found.values["k"] == pytest.approx(4.5, rel=1e-3)
    assert found.values["c"] == pytest.approx(0.4, rel=1e-2)


def test_a_trace_finds_nothing_where_the_loop_with_its_delay_explains_the_record() -> None:
    found = trace(tw.compile(tw.read_text(SERVO)), [measured(SERVO)])
    assert found.verdict == "null"
    assert not found.effects


def test_a_trace_refuses_a_delay_of_what_the_record_does_not_tell() -> None:
    text = SERVO.replace("of: error, time", "of: sum_of_errors, time")
    text += "  sum_of_errors: {type: integrator, of: error}\n"
    with pytest.raises(OptionError, match="block 'late': each window of a trace begins within the"):
        trace(tw.compile(tw.read_text(text)), [measured(SERVO)])
