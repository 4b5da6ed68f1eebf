"""A trace that finds what is missing inside a subsystem, of its own text or an included file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.diagram.edit_values import set_values
from tracewire.fit import fit
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


def recorded(folder: Path, whole: str) -> None:
    """Write the record of an arm that has a friction."""
    file = folder / "arm.yaml"
    file.write_text(whole, encoding="utf-8")
    t = np.arange(0.0, 8.0, 0.02)
    u = 0.5 * np.sin(2.2 * t) + 0.4 * np.sin(0.9 * t + 1)
    run = simulate(compile(read(file)), times=t, inputs={"u": (t, u)})
    x = run["arm.theta"] + 1e-3 * np.random.default_rng(1).standard_normal(len(t))
    rows = (f"{a},{b},{c}" for a, b, c in zip(t, x, u, strict=True))
    (folder / "run.csv").write_text("\n".join(["t,x,u", *rows]), encoding="utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("included", [False, True], ids=["own", "included"])
def test_a_friction_inside_a_subsystem_is_named_and_written(tmp_path: Path, included: bool) -> None:
    drag = "\n      drag: {type: coulomb, rate: omega, level: 0.06}\nblocks:\n  arm:"
    whole = ARM.replace("of: [spring, u]", FRICTION).replace("\nblocks:\n  arm:", drag)
    recorded(tmp_path, whole)
    text = ARM + MEASURED
    if included:
        begin, end = text.index("subsystems:"), text.index("blocks:\n  arm")
        part = text[begin:end]
        (tmp_path / "part.yaml").write_text(part, encoding="utf-8")
        text = "include: part.yaml\n" + text[:begin] + text[end:]
    file = tmp_path / "arm.yaml"
    file.write_text(text, encoding="utf-8")
    diagram = read(file)
    found = trace(compile(diagram))
    assert found.verdict == "effect"
    (effect,) = found.effects
    assert (effect.name, effect.place, effect.block) == ("coulomb", "arm.torque", "arm.coulomb")
    assert abs(effect.params["level"] - 0.06) < 1e-3
    new = found.apply(diagram)
    assert "      coulomb: {type: coulomb, rate: omega, level: {value: 0.0" in new.text
    if included:
        assert (tmp_path / "part.yaml").read_text(encoding="utf-8") == part
        assert "arm: {type: own_arm, u: u}" in new.text
        assert "    extends: arm\n    blocks:\n      torque: {of: [spring, u, coulomb]}" in new.text
        again = fit(compile(new), method="least_squares")
        assert abs(again.values["arm.coulomb.level"] - 0.06) < 1e-3
        fitted = set_values(new, again.values).text
        assert "\n    parameters: {k: {value: " in fitted  # that of the file stays
    else:
        assert "torque: {type: sum, of: [spring, u, coulomb], unit: N m}" in new.text
