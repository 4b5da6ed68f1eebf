"""The machines that come with tracewire as subsystems, against closed formulas.

The tuned damper, the rotor and the tank are tested where the gallery uses them (test_gallery.py).
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm
from solve.models import LIMITS
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.solve import Run, simulate

R, L, K, M, STIFF, DAMP = 2.0, 0.5e-3, 20.0, 0.5, 8e3, 20.0


def ran(blocks: str, *record: str, end: float) -> Run:
    text = f"include: tracewire:machines.yaml\nblocks: {{{blocks}}}\n"
    model = compile(read_text(text), record=record)
    return simulate(model, span=(0.0, end), rtol=1e-9, limits=LIMITS)


def test_the_shaker_follows_its_equations() -> None:
    blocks = "s: {type: shaker, voltage: u, load: f}, u: {type: constant, value: 5, unit: V}"
    load = ", f: {type: constant, value: -3, unit: N}"
    signals = ("s.current", "s.x", "s.v", "s.acceleration")
    run = ran(f"{blocks}{load}", *signals, end=0.05)
    system = np.array(
        [
            [-R / L, 0.0, -K / L, 5 / L],
            [0.0, 0.0, 1.0, 0.0],
            [K / M, -STIFF / M, -DAMP / M, -3 / M],
            [0.0, 0.0, 0.0, 0.0],
        ]
    )
    exact = np.array([expm(system * t) @ [0.0, 0.0, 0.0, 1.0] for t in run.t])
    for number, name in enumerate(signals[:3]):
        assert run[name] == pytest.approx(exact[:, number], rel=1e-6, abs=1e-8)
    assert run["s.acceleration"] == pytest.approx((exact @ system.T)[:, 2], rel=1e-6, abs=1e-6)


def test_an_empty_tank_stays_empty() -> None:
    run = ran("tank: {type: tank, start: 0.01}", "tank.level", end=200.0)
    fall = np.maximum(np.sqrt(0.01) - 0.62 * 4e-4 * np.sqrt(2 * 9.81) / (2 * 0.5) * run.t, 0.0)
    assert run["tank.level"] == pytest.approx(fall**2, abs=1e-7)


def test_a_tuned_damper_keeps_the_momentum_of_both_masses() -> None:
    blocks = (
        "body: {type: mass, force: damper.force, mass: 3, start_rate: 2},"
        "damper: {type: tuned_damper, position: body.x, rate: body.v, frequency: 3}"
    )
    run = ran(blocks, "body.v", "damper.v", end=5.0)
    assert 3 * run["body.v"] + run["damper.v"] == pytest.approx(6.0, rel=1e-8)
    assert run["damper.v"][-1] == pytest.approx(1.5, abs=0.05)
