"""A trace that finds what is missing inside a subsystem."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.solve import simulate
from tracewire.trace import trace

ARM = """\
inputs: {u: {unit: N m, default: 0}}
subsystems:
  arm:
    inputs: [u]
    outputs: [theta]
    parameters: {k: {value: 2, unit: N m/rad, fit: [0.5, 5]}}
    blocks:
      theta: {type: integrator, of: omega, start: 0.5, unit: rad}
      omega: {type: integrator, of: alpha, unit: rad/s}
      alpha: {type: gain, of: torque, k: 10}
      spring: {type: gain, of: theta, k: -k}
      torque: {type: sum, of: [spring, u], unit: N m}
blocks:
  arm: {type: arm, u: u}
"""
MEASURED = """\
measured:
  run: {file: run.csv, time: t, signals: {arm.theta: {column: x, sigma: 1e-3}}, inputs: {u: u}}
"""
FRICTION = "of: [spring, u, drag]"


@pytest.mark.slow
def test_a_friction_inside_a_subsystem_is_named_and_written_there(tmp_path: Path) -> None:
    file = tmp_path / "arm.yaml"
    drag = "\n      drag: {type: coulomb, rate: omega, level: 0.06}\nblocks:\n  arm:"
    whole = ARM.replace("of: [spring, u]", FRICTION).replace("\nblocks:\n  arm:", drag)
    file.write_text(whole, encoding="utf-8")
    t = np.arange(0.0, 8.0, 0.02)
    u = 0.5 * np.sin(2.2 * t) + 0.4 * np.sin(0.9 * t + 1)
    run = simulate(compile(read(file)), times=t, inputs={"u": (t, u)})
    x = run["arm.theta"] + 1e-3 * np.random.default_rng(1).standard_normal(len(t))
    rows = (f"{a},{b},{c}" for a, b, c in zip(t, x, u, strict=True))
    (tmp_path / "run.csv").write_text("\n".join(["t,x,u", *rows]), encoding="utf-8")
    file.write_text(ARM + MEASURED, encoding="utf-8")
    diagram = read(file)
    found = trace(compile(diagram))
    assert found.verdict == "effect"
    (effect,) = found.effects
    assert (effect.name, effect.place, effect.block) == ("coulomb", "arm.torque", "arm.coulomb")
    assert abs(effect.params["level"] - 0.06) < 1e-3
    new = found.apply(diagram)
    assert "      coulomb: {type: coulomb, rate: omega, level: {value: 0.0" in new.text
    assert "torque: {type: sum, of: [spring, u, coulomb], unit: N m}" in new.text
