"""Paper A against the independent solution of tests/oracles."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from oracles.double_torsion import solve
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.solve import simulate

PENDULUM = Path(__file__).parents[2] / "diagrams/papers/a_torsion/pendulum.yaml"
TIMES = np.linspace(0.0, 1.6, 81)


def test_the_double_torsion_pendulum_is_that_of_the_oracle() -> None:
    """Three guards are zero at the start; the column sticks on its stiff pin twice."""
    run = simulate(compile(read(PENDULUM)), times=TIMES, rtol=1e-8)
    oracle = solve(times=TIMES)
    assert run.warnings == ()
    assert run["phi1"] == pytest.approx(oracle.states[0], abs=1e-8)
    assert run["phi2"] == pytest.approx(oracle.states[2], abs=1e-8)
    sticks = [event.time for event in run.events if event.kind == "stick"]
    slips = [event.time for event in run.events if event.kind == "slip"]
    held = [pair for pair in oracle.intervals("stick") if pair[0] < 1.6]
    assert np.column_stack((sticks, slips)) == pytest.approx(np.array(held), abs=1e-7)
