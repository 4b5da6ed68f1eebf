"""A trace of one step of a motor: its shaft turns on and on, and is nowhere twice."""

from __future__ import annotations

import numpy as np
import pytest
import tracewire as tw
from tracewire.residual import Measured
from tracewire.trace import trace

MOTOR = """
span: [0, 2.5]
record: [angle]
inputs: {voltage: {unit: V}}
parameters:
  c: {value: 2, unit: 1/s, fit: [0, 100]}
  K: {value: 50, unit: rad/(s^2 V), fit: [0, 1000]}
blocks:
  angle: {type: integrator, of: rate, unit: rad}
  rate: {type: integrator, of: acceleration, unit: rad/s}
  motor: {type: gain, of: voltage, k: K}
  friction: {type: viscous, rate: rate, c: c}
  acceleration: {type: sum, of: [motor, friction], unit: rad/s^2}
"""
LATE = """
  seen: {type: sum, of: [voltage, lag]}
  lag: {type: drive_lag, of: voltage, tau: 0.06}
"""
COUNT = 0.05
T = np.arange(0, 2.5, 0.01)


def one_step(text: str) -> Measured:
    """The counts of an encoder, 0.2 s at rest, then with 6 V."""
    inputs = {"voltage": (T, np.where(T >= 0.2, 6.0, 0.0))}
    values = {"c": 3.33, "K": 66.7}
    model = tw.compile(tw.read_text(text))
    run = tw.simulate(model, times=T, inputs=inputs, parameters=values, rtol=1e-9)
    counts = COUNT * np.round(run["angle"] / COUNT)
    return Measured(
        "step", "train", T, {"angle": counts}, inputs=inputs, start={"angle": None, "rate": None}
    )


def test_the_lag_of_a_drive_shows_in_one_step() -> None:
    """It was not tried where a body never comes back, and a dead time stood for it."""
    hidden = MOTOR.replace("of: voltage, k", "of: seen, k") + LATE
    found = trace(tw.compile(tw.read_text(MOTOR)), [one_step(hidden)])
    assert found.verdict == "effect"
    assert [str(effect) for effect in found.effects] == ["drive_lag @ drive.voltage"]
    assert found.effects[0].params["tau"] == pytest.approx(0.06, rel=0.05)
    assert found.values["c"] == pytest.approx(3.33, rel=0.01)


def test_nothing_is_missing_in_one_step_of_the_declared_motor() -> None:
    found = trace(tw.compile(tw.read_text(MOTOR)), [one_step(MOTOR)])
    assert found.verdict == "null"
    assert not found.effects
