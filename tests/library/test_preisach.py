"""Preisach's model that comes with tracewire as a subsystem, against a sum of relays."""

from __future__ import annotations

import numpy as np
import pytest
from solve.models import LIMITS
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.solve import Run, simulate


def ran(signal: str, given: str = "") -> Run:
    text = f"""
include: tracewire:hysteresis.yaml
span: [0, 30]
record: [u, core.y]
blocks:
  u: {{type: expression, formula: "{signal}"}}
  core: {{type: preisach, of: u{given}}}
"""
    return simulate(compile(read_text(text)), limits=LIMITS)


@pytest.mark.parametrize("levels", [1, 3, 8])
def test_preisach_is_the_mean_of_its_relays(levels: int) -> None:
    relays = levels * (levels + 1) // 2
    run = ran("1.2*exp(-t/20)*cos(t) + 0.3*sin(2.7*t)", f", relays: {relays}")
    at = np.linspace(-1, 1, levels + 1)
    dense = np.linspace(0, 30, 300_001)
    u = 1.2 * np.exp(-dense / 20) * np.cos(dense) + 0.3 * np.sin(2.7 * dense)
    total = np.zeros(len(dense))
    for up in range(1, levels + 1):
        for down in range(up):
            told = np.where(u >= at[up], 1, np.where(u <= at[down], -1, 0))
            told[0] = told[0] or -1
            last = np.maximum.accumulate(np.where(told != 0, np.arange(len(told)), 0))
            total += told[last]
    exact = np.interp(run.t, dense, total / relays)
    assert np.median(np.abs(run["core.y"] - exact)) < 1e-12
    assert np.mean(np.abs(run["core.y"] - exact) > 1e-9) < 0.01  # a sample beside a jump


def test_preisach_forgets_what_a_larger_swing_wipes_out() -> None:
    """After 0.9 and -0.9 the way to 0.3 is one, whatever was before."""
    after = "{} if t < 10 else (0.9*sin(pi*(t - 10)/2.5) if t < 15 else 0.02*(t - 15))"
    one, other = (ran(after.format(before)) for before in ("0.5*sin(t)", "0.8*sin(3*t)"))
    late = one.t > 14.5
    assert one["core.y"][late] == pytest.approx(other["core.y"][late], abs=1e-12)
    assert np.ptp(one["core.y"][late]) > 0.1


def test_preisach_is_saturated_beyond_its_limits() -> None:
    run = ran("6*cos(0.4*t)", ", low: -2, high: 4")
    assert run["core.y"][run["u"] > 4.01] == pytest.approx(1.0)
    assert run["core.y"][run["u"] < -2.01] == pytest.approx(-1.0)
