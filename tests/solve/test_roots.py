"""Square roots that begin at zero: flow through an orifice, in both directions and in one."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from solve.logs import METHODS
from solve.models import run

ORIFICES = (
    "sign(h)*sqrt(abs(h))",
    "sign(h)*abs(h)**0.5",
    "(sqrt(h) if h >= 0 else -sqrt(-h))",
)
DRIVES: dict[str, Callable[[float], float]] = {
    "- 0.05": lambda t: -0.05,
    "+ 0.1*sin(t)": lambda t: 0.1 * math.sin(t),
    "+ 0.3*sin(2*t) - 0.1": lambda t: 0.3 * math.sin(2 * t) - 0.1,
}
TANK = """
span: [0, 20]
blocks:
  h: {{type: integrator, of: rate, start: 1}}
  rate: {{type: expression, formula: "{rate}"}}
"""


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("orifice", ORIFICES)
@pytest.mark.parametrize("method", METHODS)
def test_a_tank_that_drains_through_zero_goes_on(method: str, orifice: str, drive: str) -> None:
    found = run(TANK.format(rate=f"-0.2*{orifice} {drive}"), method=method, rtol=1e-9)
    exact = solve_ivp(
        lambda t, h: -0.2 * np.sign(h) * np.sqrt(np.abs(h)) + DRIVES[drive](t),
        (0, 20),
        [1.0],
        max_step=1e-2,
        rtol=1e-10,
        atol=1e-12,
    )
    assert found.final["h"] == pytest.approx(exact.y[0, -1], abs=2e-7)


@pytest.mark.parametrize("drain", [0.0, 0.05])
@pytest.mark.parametrize("method", METHODS)
def test_a_tank_that_is_empty_has_no_flow(method: str, drain: float) -> None:
    """h' = -0.2 sqrt(max(h, 0)) - b: with u = sqrt(h), dt = -2 u du/(0.2 u + b)."""
    formula = f"-0.2*sqrt(max(h, 0)) - {drain}"
    found = run(TANK.format(rate=formula), method=method, rtol=1e-9)
    empty = 10.0
    if drain:
        empty = 10 * (1 - drain / 0.2 * np.log(1 + 0.2 / drain))
    assert found.final["h"] == pytest.approx(-drain * (20 - empty), abs=1e-7)


@pytest.mark.parametrize("begin", [0.0, -0.1, 3.0, 100.0])
@pytest.mark.parametrize("method", METHODS)
def test_two_bodies_strike_far_from_zero_too(method: str, begin: float) -> None:
    """Their distance is known to the rounding of where they are, and the force of the contact is
    not defined beyond it."""
    found = run(
        f"""
span: [0, 40]
blocks:
  x: {{type: integrator, of: v, start: {begin}}}
  v: {{type: integrator, of: pull}}
  y: {{type: integrator, of: w, start: {begin + 1.0}}}
  w: {{type: integrator, of: -pull, start: 0.05}}
  apart: {{type: sum, of: [y, -x]}}
  pull: {{type: expression, formula: "apart - (40*(0.2 - apart)**1.5 if apart <= 0.2 else 0)"}}
""",
        method=method,
        rtol=1e-9,
    )
    x, y, v, w = (found.final[name] for name in ("x", "y", "v", "w"))
    deep = max(0.2 - (y - x), 0.0)
    energy = (v**2 + w**2 + (y - x) ** 2) / 2 + 40 / 2.5 * deep**2.5
    assert energy == pytest.approx(0.50125, rel=1e-5)
    assert v + w == pytest.approx(0.05, abs=1e-9)
    assert len(found.events) > 20
