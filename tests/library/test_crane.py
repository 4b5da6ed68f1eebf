"""The crane that comes with tracewire as a subsystem, against what is known of it exactly."""

from __future__ import annotations

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.solve import Run, simulate

INSIDE = ("crane.x", "crane.v", "crane.phi", "crane.swing")
TROLLEY, MASS, LENGTH, GRAVITY = 500.0, 1000.0, 6.0, 9.81


def ran(given: str, end: float, *record: str, blocks: str = "") -> Run:
    text = f"include: tracewire:crane.yaml\nblocks: {{crane: {{type: crane{given}}}{blocks}}}\n"
    model = compile(read_text(text), record=(*INSIDE, *record))
    return simulate(model, span=(0.0, end), rtol=1e-10)


def test_energy_and_momentum_stay_where_nothing_drives() -> None:
    run = ran(", start: 1.2", 20.0)
    x, v, phi, swing = (run[name] for name in INSIDE)
    across, up = v + LENGTH * swing * np.cos(phi), LENGTH * swing * np.sin(phi)
    energy = TROLLEY * v**2 / 2 + MASS * (across**2 + up**2) / 2
    energy -= MASS * GRAVITY * LENGTH * np.cos(phi)
    assert np.ptp(energy) < 1e-8 * MASS * GRAVITY * LENGTH
    assert np.abs(TROLLEY * v + MASS * across).max() < 1e-8 * np.abs(TROLLEY * v).max()
    assert np.ptp(TROLLEY * x + MASS * (x + LENGTH * np.sin(phi))) < 1e-8 * MASS * LENGTH


def test_a_small_swing_has_the_frequency_of_two_bodies() -> None:
    run = ran(", start: 1e-4", 10.0)
    w = np.sqrt(GRAVITY / LENGTH * (1 + MASS / TROLLEY))
    assert run["crane.phi"] == pytest.approx(1e-4 * np.cos(w * run.t), abs=1e-10)


def test_a_constant_force_ends_at_the_rate_of_its_drag() -> None:
    drive = ", f: {type: constant, value: 400, unit: N}"
    run = ran(", force: f, drag: 800", 200.0, "crane.rate", "crane.load", blocks=drive)
    assert run["crane.rate"][-1] == pytest.approx(0.5, abs=1e-6)
    assert run["crane.load"][-1] == pytest.approx(run["crane.x"][-1], abs=1e-5)
