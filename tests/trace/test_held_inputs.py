"""An input that is held and read as lines is late by half of the time between samples."""

from __future__ import annotations

import numpy as np
import pytest
import tracewire as tw
from tracewire.residual import Measured
from tracewire.show.trace_summary import paragraph_of
from tracewire.show.trace_text import answer_lines
from tracewire.solve import Held
from tracewire.trace import Found, trace
from tracewire.trace.data_thresholds import CheckOptions
from tracewire.trace.results.held_inputs import describe_held_input

MOTOR = """
span: [0, 40]
inputs: [u]
parameters:
  gain: {value: 2, fit: [0.1, 20]}
  drag: {value: 1, fit: [0, 20]}
blocks:
  angle: {type: integrator, of: speed, unit: rad}
  speed: {type: integrator, of: acceleration, unit: rad/s}
  drive: {type: gain, of: u, k: gain}
  friction: {type: viscous, rate: speed, c: drag}
  acceleration: {type: sum, of: [drive, friction]}
"""
STEP, SIGMA = 0.1, 1e-3
T = STEP * np.arange(401)
U = np.repeat(np.random.default_rng(3).choice([-1.0, -0.5, 0.5, 1.0], 41), 10)[:401]


def traced(held: bool) -> Found:
    """The trace of a motor under a held voltage, whose record says so or not."""
    model = tw.compile(tw.read_text(MOTOR))
    run = tw.simulate(model, times=T, inputs={"u": Held(T, U)}, parameters={"drag": 1.3})
    noise = SIGMA * np.random.default_rng(4).standard_normal(len(T))
    inputs = {"u": Held(T, U) if held else (T, U)}
    start = {"angle": None, "speed": None}
    values = {"angle": run["angle"] + noise}
    record = Measured("run", "train", T, values, {"angle": SIGMA}, inputs=inputs, start=start)
    return trace(model, [record])


def test_a_trace_says_that_a_held_input_would_look_like_the_delay_it_found() -> None:
    found = traced(held=False)
    (effect,) = found.effects
    assert effect.coefficient in ("tau", "delay")
    assert effect.params[effect.coefficient] == pytest.approx(STEP / 2, rel=0.02)
    assert "half of the time between samples" in effect.doubt
    assert "say hold: previous" in effect.doubt
    assert f"    {effect.doubt}" in answer_lines(found)
    assert effect.doubt in paragraph_of(found)


def test_a_record_that_says_so_has_no_delay() -> None:
    found = traced(held=True)
    assert found.verdict == "null"


@pytest.mark.parametrize(
    ("place", "delay", "said"),
    [
        ("drive.u", 0.05, True),
        ("sensor.angle", 0.0453, True),
        ("drive.u", 0.1, False),
        ("drive.u", 0.043, False),
        ("drive.other", 0.05, False),
    ],
)
def test_half_a_sample_of_a_held_input_is_told(place: str, delay: float, said: bool) -> None:
    values = {"angle": np.zeros(401)}
    record = Measured("run", "train", T, values, {"angle": SIGMA}, inputs={"u": (T, U)})
    told = describe_held_input(place, delay, [record], CheckOptions())
    assert bool(told) == said


@pytest.mark.parametrize("points", [Held(T, U), (T, np.sin(T))])
def test_an_input_that_says_so_or_moves_all_the_time_imitates_no_delay(points: tw.Held) -> None:
    record = Measured("run", "train", T, {"angle": T}, {"angle": SIGMA}, inputs={"u": points})
    assert describe_held_input("drive.u", STEP / 2, [record], CheckOptions()) == ""
