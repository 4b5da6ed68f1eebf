"""A trace of a heater with a second heat capacity behind a wall, of which no record tells."""

from __future__ import annotations

import numpy as np
import pytest
import tracewire as tw
from numpy.typing import NDArray
from tracewire.residual import Measured
from tracewire.trace import trace

Vector = NDArray[np.float64]

OVEN = """
span: [0, 1200]
record: [T]
inputs: {power: {}}
parameters:
  gain: {value: 0.01, unit: K/s, fit: [0, 1]}
  loss: {value: 0.003, unit: 1/s, fit: [0, 0.1]}
  room: {value: 21, unit: K}
blocks:
  T: {type: integrator, of: warming, start: 21, unit: K}
  over: {type: expression, formula: T - room, unit: K}
  heat: {type: gain, of: power, k: gain}
  cold: {type: gain, of: over, k: -loss}
  warming: {type: sum, of: [heat, cold], unit: K/s}
"""
WITH_SLAB = (
    OVEN.replace("[heat, cold]", "[heat, cold, wall]")
    + """\
  slab: {type: integrator, of: slab_warming, start: 21, unit: K}
  wall: {type: expression, formula: 0.005*(slab - T)}
  slab_warming: {type: gain, of: wall, k: -0.5}
"""
)
STEP = 0.25  # K, of the thermometer
TIMES = np.arange(0, 1200, 4.0)
HEATED_ONCE = np.where(TIMES >= 40, 1.0, 0.0)
ON_AND_OFF = np.where((TIMES // 130) % 2 == 1, 1.0, 0.0)


@pytest.mark.parametrize("power", [HEATED_ONCE, ON_AND_OFF], ids=["heated once", "on and off"])
def test_a_second_heat_capacity_is_named_with_its_size(power: Vector) -> None:
    """It was told as a drift of the loss. In the last part the wall is much warmer than the slab,
    which is more than a temperature changes in a second: this start was refused."""
    inputs = {"power": (TIMES, power)}
    run = tw.simulate(
        tw.compile(tw.read_text(WITH_SLAB)),
        times=TIMES, inputs=inputs, parameters={"gain": 0.25, "loss": 0.0025}, rtol=1e-9,
    )  # fmt: skip
    noise = np.random.default_rng(3).standard_normal(len(TIMES))
    seen = STEP * np.round((run["T"] + 0.07 * noise) / STEP)
    record = Measured("run", "train", TIMES, {"T": seen}, inputs=inputs, start={"T": None})
    found = trace(tw.compile(tw.read_text(OVEN)), [record])
    assert found.verdict == "effect"
    assert [str(effect) for effect in found.effects] == ["viscous_load @ warming"]
    assert found.effects[0].params["c"] == pytest.approx(0.005, rel=0.05)
    assert found.effects[0].params["lag"] == pytest.approx(1 / (0.5 * 0.005), rel=0.1)
