"""Derivatives of runs by the parameters of bodies and frictions, through stick, slip and impact."""

from __future__ import annotations

import numpy as np
import pytest
from solve.logs import TIGHT
from solve.models import made
from tracewire.solve import simulate

RUNS = {
    "stribeck_friction": (
        """
  m: {type: mass, force: net, mass: 1, start_rate: 1}
  f: {type: stribeck_friction, rate: m.v, slip: a, stick: 1.5*a, speed: b, exponent: c, c: 0.1}
  d: {type: ramp, slope: 1.5}
  net: {type: sum, of: [f, d]}
  y: {type: gain, of: m.v, k: 1}
""",
        (1.0, 0.4, 1.3),
    ),
    "clutch": (
        """
  m: {type: rotating_mass, torque: net, inertia: 1, start_rate: 5}
  n: {type: rotating_mass, torque: -f, inertia: 2}
  normal: {type: constant, value: c}
  f: {type: clutch, rate: m.rate, other_rate: n.rate, normal: normal, friction: a, radius: b}
  d: {type: ramp, slope: 3}
  net: {type: sum, of: [f, d]}
  y: {type: gain, of: n.rate, k: 1}
""",
        (0.3, 0.1, 100.0),
    ),
    "elastic_gear": (
        """
  m: {type: rotating_mass, torque: net, inertia: 1, start_rate: 1}
  n: {type: rotating_mass, torque: f.torque2, inertia: 2}
  f: {type: elastic_gear, angle1: m.angle, rate1: m.rate, angle2: n.angle, rate2: n.rate, k: 300,
      c: 2, gap: a, ratio: b, efficiency: c}
  d: {type: sine, amplitude: 2, omega: 4}
  net: {type: sum, of: [f.torque1, d]}
  y: {type: gain, of: n.rate, k: 1}
""",
        (0.1, 2.0, 0.9),
    ),
    "rope": (
        """
  m: {type: mass, force: net, mass: 1}
  w: {type: constant, value: 9.81}
  f: {type: rope, of: m.x, rate: m.v, k: a, c: b, length: c}
  net: {type: sum, of: [f, w]}
  y: {type: gain, of: m.x, k: 1}
""",
        (300.0, 2.0, 1.0),
    ),
    "maxwell_slip": (
        """
  m: {type: mass, force: f, mass: 1, start_rate: 2}
  f: {type: maxwell_slip, rate: m.v, k: [a, 2*a], level: [b, c]}
  y: {type: gain, of: m.x, k: 1}
""",
        (3.0, 0.5, 1.5),
    ),
    "lookup_table_2d": (
        """
  u: {type: sine, amplitude: 1, omega: a}
  v: {type: sine, amplitude: 1, omega: 2.2}
  f: {type: lookup_table_2d, of: u, other: v, rows: [-1, 0, 1], columns: [-1, 0.2, 1],
      values: [[1, b, 2], [2, 3, b*c], [0, 0, c]]}
  y: {type: integrator, of: f}
""",
        (1.1, 3.0, 4.0),
    ),
}


@pytest.mark.parametrize("name", RUNS)
def test_sensitivities_are_those_of_neighbouring_runs(name: str) -> None:
    blocks, numbers = RUNS[name]
    values = dict(zip("abc", numbers, strict=True))
    text = f"span: [0, 3]\nevery: 0.1\nparameters: {values}\nblocks:\n{blocks}\nrecord: [y]"
    model = made(text.replace("'", ""))
    result = simulate(model, sensitivities=[*values], **TIGHT)
    for parameter, value in values.items():
        step = 1e-5 * value
        above, below = (
            simulate(model, parameters={parameter: value + sign * step}, **TIGHT)["y"]
            for sign in (1, -1)
        )
        slope = result.sensitivities[parameter]["y"]
        assert np.max(np.abs(slope)) > 1e-4
        assert slope == pytest.approx((above - below) / (2 * step), rel=1e-4, abs=1e-5)
