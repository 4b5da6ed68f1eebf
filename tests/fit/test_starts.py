"""Fitted starts that no record shows are told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from oracles.oscillator import DIAGRAM
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.fit.remarks import begins_fast
from tracewire.residual import Measured, Sensor

T = np.arange(0.0, 3.0, 0.05)
RUN = Measured("run", "train", T, {"x": np.sin(2.0 * T)}, start={"x": None, "v": None})


@pytest.mark.parametrize("start", [-9.0, 9.0])
def test_a_start_rate_far_above_those_of_the_record_is_told(start: float) -> None:
    (told,) = begins_fast(compile(read_text(DIAGRAM)), [RUN], {"run": {"x": 0.0, "v": start}})
    assert told == (
        f"run: the fit lets v begin at {start:.3g} (SI), and x is never faster than 2 between two "
        "samples: fix it (`start: {v: 0}` where it rests), or look at what sits on its bound"
    )


@pytest.mark.parametrize("starts", [{}, {"run": {}}, {"run": {"x": 100.0, "v": 3.0}}])
def test_other_starts_are_not(starts: dict[str, dict[str, float]]) -> None:
    model = compile(read_text(DIAGRAM))
    assert begins_fast(model, [RUN], starts) == []


def test_a_single_sample_and_a_sensor_with_a_gain_tell_no_start() -> None:
    model, starts = compile(read_text(DIAGRAM)), {"run": {"v": 3.0}}
    alone = replace(RUN, t=T[:1], values={"x": np.zeros(1)})
    assert begins_fast(model, [alone], starts) == []
    small = replace(RUN, values={"x": 1e-3 * RUN.values["x"]}, sensors={"x": Sensor(gain=1e-3)})
    assert begins_fast(model, [small], starts) == []
