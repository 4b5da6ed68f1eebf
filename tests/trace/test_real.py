"""Real measurements of a multi-arm pendulum, where they are at hand."""

from __future__ import annotations

from pathlib import Path

import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.trace import Found, trace

DATA = Path(__file__).parents[3] / "shared/data/multiarm_pendulum"
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not DATA.is_dir(), reason="the measured series are not here"),
]
DIAGRAM = """
title: Multi-arm pendulum, one arm, free swing
span: [0, {end}]
parameters:
  w0_squared: {{value: 64.219, unit: 1/s^2, fit: [50, 80]}}
  c: {{value: 0.0672, unit: 1/s, fit: [0, 1]}}
blocks:
  theta: {{type: integrator, of: omega, unit: rad}}
  omega: {{type: integrator, of: acceleration, unit: rad/s}}
  height: {{type: sin, of: theta}}
  gravity: {{type: gain, of: height, k: -w0_squared}}
  friction: {{type: viscous, rate: omega, c: c}}
  acceleration: {{type: sum, of: [gravity, friction]}}
measured:
  swing:
    file: {file}
    time: t_s
    signals: {{theta: {{column: theta_from_hanging_rad}}}}
    start: {{theta: free, omega: free}}
"""


def traced(name: str, end: float) -> Found:
    text = DIAGRAM.format(file=DATA / f"derived_freeswing_{name}_200Hz.csv", end=end)
    return trace(compile(read_text(text)))


def test_the_large_swing_needs_coulomb_friction_and_quadratic_drag() -> None:
    found = traced("large", 55.0)
    assert found.verdict == "effect"
    assert {effect.name for effect in found.effects} == {"coulomb", "quad_drag"}
    params = {effect.name: effect.params for effect in found.effects}
    assert params["coulomb"]["level"] == pytest.approx(0.164, rel=0.1)
    assert params["quad_drag"]["c"] == pytest.approx(0.00403, rel=0.1)
    assert found.dropped == ("c",), "the declared viscous friction goes to zero"
    assert found.rmse_after < 0.010 < 0.015 < found.rmse_before


def test_the_small_swing_needs_coulomb_friction_only() -> None:
    found = traced("small", 10.0)
    assert [effect.name for effect in found.effects] == ["coulomb"]
    assert found.effects[0].params["level"] == pytest.approx(0.163, rel=0.1)
    assert found.fitted_before == pytest.approx(3.97e-3, rel=0.05)
    assert found.fitted_after < 1.15e-3
    assert found.rmse_after < 1.15e-3
