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
