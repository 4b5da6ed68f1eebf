"""A trace of one run of a motor up: its shaft turns on and on, and is nowhere twice."""

from __future__ import annotations

import numpy as np
import pytest
import tracewire as tw
from numpy.typing import NDArray
from oracles.motor import MOTOR
from tracewire.residual import Measured
from tracewire.trace import trace

Vector = NDArray[np.float64]

LATE = """\
  seen: {type: sum, of: [voltage, lag]}
  lag: {type: drive_lag, of: voltage, tau: 0.06}
"""
COUNT = 0.02
T = np.arange(0, 5, 0.01)
STEP = np.where(T >= 0.2, 6.0, 0.0)
STAIRS = np.select([T < 0.2, T < 1.2, T < 2.2, T < 3.2], [0.0, 3.0, 6.0, 9.0], 4.0)
RAMP = 9 - np.abs(3.6 * T - 9)


def record(text: str, voltage: Vector) -> Measured:
    """The counts of an encoder."""
    inputs = {"voltage": (T, voltage)}
    values = {"c": 3.33, "K": 66.7}
    model = tw.compile(tw.read_text(text))
    run = tw.simulate(model, times=T, inputs=inputs, parameters=values, rtol=1e-9)
    counts = COUNT * np.round(run["angle"] / COUNT)
    return Measured(
        "run", "train", T, {"angle": counts}, inputs=inputs, start={"angle": None, "rate": None}
    )


def with_force(block: str) -> str:
    """The motor with one more force."""
    return MOTOR.replace("friction]", "friction, more]") + f"  more: {block}\n"


def test_the_lag_of_a_drive_shows_in_one_step() -> None:
    """It was not tried where a body never comes back, and a dead time stood for it."""
    hidden = MOTOR.replace("of: voltage, k", "of: seen, k") + LATE
    found = trace(tw.compile(tw.read_text(MOTOR)), [record(hidden, STEP)])
    assert found.verdict == "effect"
    assert [str(effect) for effect in found.effects] == ["drive_lag @ drive.voltage"]
    assert found.effects[0].params["tau"] == pytest.approx(0.06, rel=0.05)
    assert found.values["c"] == pytest.approx(3.33, rel=0.01)


def test_nothing_is_missing_in_one_step_of_the_declared_motor() -> None:
    found = trace(tw.compile(tw.read_text(MOTOR)), [record(MOTOR, STEP)])
    assert found.verdict == "null"
    assert not found.effects


@pytest.mark.parametrize("voltage", [STEP, STAIRS], ids=["step", "stairs"])
def test_a_load_that_swings_on_the_motor_shows_in_one_run_up(voltage: Vector) -> None:
    load = "{type: elastic_load, of: acceleration, m: 0.5, period: 0.25, damping: 0.03}"
    found = trace(tw.compile(tw.read_text(MOTOR)), [record(with_force(load), voltage)])
    assert [str(effect) for effect in found.effects] == ["elastic_load @ acceleration"]
    assert found.effects[0].params["m"] == pytest.approx(0.5, rel=0.05)
    assert found.effects[0].params["period"] == pytest.approx(0.25, rel=0.02)


@pytest.mark.parametrize("level", [50, 79])
def test_a_dry_friction_and_a_dead_zone_are_told_as_alike_where_the_shaft_turns_one_way(
    level: float,
) -> None:
    """Far from the data they are unlike, and the dead zone was named alone."""
    rub = f"{{type: coulomb, rate: rate, level: {level}}}"
    found = trace(tw.compile(tw.read_text(MOTOR)), [record(with_force(rub), RAMP)])
    assert [str(effect) for effect in found.effects] == ["coulomb @ acceleration"]
    assert found.effects[0].params["level"] == pytest.approx(level, rel=0.02)
    assert "drive_dead_zone @ drive.voltage" in [str(tie) for tie in found.effects[0].ties]
