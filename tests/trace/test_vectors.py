"""A trace that finds what is missing at one element of a sum of vectors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.solve import simulate
from tracewire.trace import trace

CARTS = """\
inputs: {u: {unit: N, default: 0}}
parameters: {k: {value: 20, unit: N/m, fit: [5, 50]}}
blocks:
  x: {type: integrator, of: v, start: [0.3, 0], unit: m}
  v: {type: integrator, of: a, unit: m/s}
  apart: {type: matrix_gain, of: x, matrix: [[-2, 1], [1, -2]], unit: m}
  spring: {type: gain, of: apart, k: k, unit: N}
  push: {type: gain, of: u, k: [1, 0], unit: N}
  force: {type: sum, of: [spring, push], unit: N}
  a: {type: gain, of: force, k: {value: 2, unit: 1/kg}, unit: m/s^2}
"""
MEASURED = """\
measured:
  run:
    file: run.csv
    time: t
    signals: {"x[0]": {column: x, sigma: 1e-3}, "x[1]": {column: y, sigma: 1e-3}}
    inputs: {u: u}
"""
RUBBING = """\
  rubbing: {type: coulomb, rate: "v[1]", level: 0.4}
  alone: {type: gain, of: rubbing, k: [0, 1]}
"""


@pytest.mark.slow
def test_a_friction_at_one_element_is_named_and_written_there(tmp_path: Path) -> None:
    file = tmp_path / "carts.yaml"
    file.write_text(CARTS.replace("[spring, push]", "[spring, push, alone]") + RUBBING, "utf-8")
    t = np.arange(0.0, 10.0, 0.02)
    u = 1.5 * np.sin(4.2 * t) + 1.1 * np.sin(2.3 * t + 1)
    run = simulate(compile(read(file)), times=t, inputs={"u": (t, u)})
    noise = 1e-3 * np.random.default_rng(2).standard_normal((2, len(t)))
    columns = (t, run["x[0]"] + noise[0], run["x[1]"] + noise[1], u)
    rows = (",".join(map(str, row)) for row in zip(*columns, strict=True))
    (tmp_path / "run.csv").write_text("\n".join(["t,x,y,u", *rows]), "utf-8")
    file.write_text(CARTS + MEASURED, "utf-8")
    diagram = read(file)
    found = trace(compile(diagram))
    assert found.verdict == "effect"
    (effect,) = found.effects
    assert (effect.name, effect.place, effect.block) == ("coulomb", "force[1]", "coulomb_force_1")
    assert abs(effect.params["level"] - 0.4) < 1e-2
    new = found.apply(diagram)
    assert "force: {type: sum, of: [spring, push, coulomb_force_1_alone], unit: N}" in new.text
