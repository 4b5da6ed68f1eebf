"""Records of a pendulum with effects that its diagram lacks, and the diagram that names them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from oracles.pendulum import solve

DIAGRAM = """
title: Pendulum
span: [0, {end}]
record: [theta]
parameters:
  w0_squared: {{value: 62, unit: 1/s^2, fit: [30, 120]}}   # a comment that must survive
  c: {{value: 0.05, unit: 1/s, fit: [0, 1]}}
blocks:
  theta: {{type: integrator, of: omega, start: {theta}, unit: rad}}
  omega: {{type: integrator, of: acceleration, unit: rad/s}}
  height: {{type: sin, of: theta}}
  gravity: {{type: gain, of: height, k: -w0_squared}}
  friction: {{type: viscous, rate: omega, c: c}}
  acceleration: {{type: sum, of: [gravity, friction]}}
measured:
  swing:
    file: swing.csv
    time: t
    signals: {{theta: {{column: theta, sigma: {sigma}}}}}
    start: {{theta: free, omega: free}}
"""


def write_pendulum(
    folder: Path,
    end: float = 12.0,
    theta: float = 1.2,
    sigma: float = 1e-3,
    offset: float = 0.0,
    seed: int = 1,
    **effects: float,
) -> Path:
    """Write swing.csv and pendulum.yaml into a folder; the path of the diagram.

    `effects` are those of the oracle (f_c, c_q, ...); c is 0.06 unless given.
    """
    t = np.arange(0.0, end + 1e-9, 0.02)
    given = {"w0_squared": 63.7, "c": 0.06, "f_c": 0.0, "c_q": 0.0} | effects
    swing = solve(t, theta, 0.0, **given)
    noise = np.random.default_rng(seed).normal(0.0, sigma, len(t))
    columns = np.column_stack((t, swing.theta + offset + noise))
    np.savetxt(
        folder / "swing.csv", columns, delimiter=",", header="t,theta", comments="", fmt="%.6f"
    )
    path = folder / "pendulum.yaml"
    path.write_text(DIAGRAM.format(end=end, theta=theta, sigma=sigma))
    return path
