"""A delay is fitted as any parameter is, in one run from the start of each series."""

from __future__ import annotations

import numpy as np
import pytest
import tracewire as tw
from tracewire.analyse import lyapunov, periodic_orbit
from tracewire.errors import OptionError
from tracewire.fit import fit
from tracewire.residual import Measured

T = np.linspace(0, 10, 101)
LOOP = """
span: [0, 10]
record: [x]
parameters:
  T: {value: 0.5, unit: s, fit: [0.05, 2]}
  b: {value: -1.0, fit: [-3, 0]}
  before: {value: 0.8, fit: [0, 2]}
blocks:
  x: {type: integrator, of: rate, start: 1}
  late: {type: delay, of: x, time: T, before: before}
  rate: {type: expression, formula: b*late - x/2}
"""
RELAY = """
span: [0, 10]
record: [x]
parameters:
  T: {value: 0.55, unit: s, fit: [0.1, 2]}
blocks:
  x: {type: integrator, of: rate, start: 0.3}
  late: {type: delay, of: x, time: T, before: 0.3}
  rate: {type: expression, formula: -sign(late)}
"""
TRUE = {"T": 0.73, "b": -1.2, "before": 1.0}


def seen(text: str, **values: float) -> Measured:
    run = tw.simulate(tw.compile(tw.read_text(text)), times=T, parameters=values, rtol=1e-10)
    return Measured("run", "train", T, {"x": run["x"]})


METHODS = ["least_squares", "growing_windows", "fminsearch", "multiple_shooting"]


@pytest.mark.parametrize("method", METHODS)
def test_a_fit_finds_the_delay_in_a_loop(method: str) -> None:
    found = fit(tw.compile(tw.read_text(LOOP)), [seen(LOOP, **TRUE)], method=method, rtol=1e-8)
    assert found.values == pytest.approx(TRUE, rel=2e-3 if method == "fminsearch" else 1e-6)


def test_a_fit_finds_the_delay_of_a_relay() -> None:
    found = fit(tw.compile(tw.read_text(RELAY)), [seen(RELAY, T=0.6)], method="least_squares")
    assert found.values["T"] == pytest.approx(0.6, rel=1e-8)


def test_what_begins_at_states_refuses_a_delay() -> None:
    model = tw.compile(tw.read_text(LOOP))
    for analysis in (
        lambda: lyapunov(model, length=10.0),
        lambda: periodic_orbit(model, period=2.0),
    ):
        with pytest.raises(OptionError, match="an analysis begins at states, and the delay needs"):
            analysis()
