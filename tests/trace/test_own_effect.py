"""An effect of the user's own, as the page shows it: rubber, which has a memory and a shape."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import tracewire as tw

PAGE = Path(__file__).parents[2] / "docs" / "trace.md"
MASS = """
span: [0, 12]
every: 0.02
record: [x]
parameters:
  k: {value: 30, fit: [0, 100]}
  c: {value: 0.3, fit: [0, 10]}
blocks:
  x: {type: integrator, of: v, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  u: {type: multisine, frequencies: [0.3, 0.5, 0.8, 1.7], amplitudes: 2, phases: [0, 1, 3, 2]}
  spring: {type: gain, of: x, k: -k}
  damper: {type: viscous, rate: v, c: c}
  a: {type: sum, of: [u, spring, damper], unit: m/s^2, place: {q: x, v: v}}
"""
RUBBER = "  rubber: {type: relaxing_spring, rate: v, k: 12, lag: 0.3}\n"


@pytest.mark.slow
def test_rubber_that_the_user_declares_is_found() -> None:
    truth = MASS.replace("damper]", "damper, rubber]").replace("  a: {", f"{RUBBER}  a: {{")
    run = tw.simulate(tw.compile(tw.read_text(truth)))
    x = run["x"] + 1e-3 * np.random.default_rng(4).standard_normal(len(run.t))
    (own,) = re.findall(r"```text\n(  rubber:\n.*?)```", PAGE.read_text(encoding="utf-8"), re.S)
    declared = tw.read_text(f"{MASS}subsystems:\n{own}")
    model = tw.compile(declared)
    found = tw.trace(model, [tw.Measured("run", "train", run.t, {"x": x})])
    assert [str(effect) for effect in found.effects] == ["rubber @ a"]
    assert found.effects[0].params == pytest.approx({"k": 12.0, "lag": 0.3}, rel=0.02)
