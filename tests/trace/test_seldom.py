"""A trace of what acts seldom: a friction that shows only where a shaft turns round."""

from __future__ import annotations

import numpy as np
import tracewire as tw
from oracles.motor import MOTOR
from tracewire.residual import Measured
from tracewire.trace import trace

HIDDEN = (
    MOTOR.replace("friction]", "friction, rub]")
    + """\
  rub: {type: stribeck, rate: rate, level: 45.7, width: 0.05, speed: 3.89}
"""
)
COUNT = 0.02  # rad, of the encoder


def test_a_stribeck_friction_is_named_where_the_shaft_turns_round_four_times() -> None:
    """The first fit of it had not converged, and parts without a turn are at the noise without
    it: it was refused, and nothing was named."""
    t = np.arange(0, 5, 0.01)
    drive = {"voltage": (t, 6 * np.sin(np.pi * t))}
    values = {"c": 3.33, "K": 66.7}
    run = tw.simulate(
        tw.compile(tw.read_text(HIDDEN)), times=t, inputs=drive, parameters=values, rtol=1e-9
    )
    counts = COUNT * np.round(run["angle"] / COUNT)
    start = {"angle": None, "rate": None}
    record = Measured("run", "train", t, {"angle": counts}, inputs=drive, start=start)
    found = trace(tw.compile(tw.read_text(MOTOR)), [record])
    assert found.verdict == "effect"
    assert [str(effect) for effect in found.effects] == ["stribeck @ acceleration"]
    (effect,) = found.effects
    low, high = effect.intervals["speed"]
    assert 3 < low < high < 6
