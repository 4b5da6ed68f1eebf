"""Paper A: the shipped diagram against the four published values and the independent solution."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from oracles.double_torsion import solve
from tracewire.compile import Model, compile
from tracewire.diagram import read
from tracewire.solve import Run, simulate

PENDULUM = Path(__file__).parents[2] / "diagrams/papers/a_torsion/pendulum.yaml"
ANGLES = 1e-6
TIMES = 1e-6
CASES = {
    "consistent": ("consistent", {}, {}),
    "as_printed": ("as_printed", {}, {"nT": 2.0, "as_printed": True}),
    "c1 = 1.2": ("", {"c1": 1.2}, {}),
}
# what the independent solution calls an event, and the guard that it is in the diagram
GUARDS = {
    "column contact": ("phi1 - pin.limit", "phi1 - -pin.limit"),
    "disk contact": ("phi2 - springs.limit", "phi2 - -springs.limit"),
}


@pytest.fixture(scope="module")
def model() -> Model:
    return compile(read(PENDULUM))


@pytest.fixture(scope="module")
def consistent(model: Model) -> Run:
    return simulate(model, rtol=1e-9)


def contacts(run: Run, side: str) -> list[float]:
    sign = {"+": "phi1 - pin.limit", "-": "phi1 - -pin.limit"}[side]
    return [event.time for event in run.events if event.guard == sign]


def test_the_angles_at_three_seconds_are_the_published_ones(consistent: Run) -> None:
    at = int(np.searchsorted(consistent.t, 3.0 - 1e-9))
    assert consistent.t[at] == pytest.approx(3.0)
    assert consistent["phi1"][at] == pytest.approx(-0.0508692474, abs=ANGLES)
    assert consistent["phi2"][at] == pytest.approx(-0.0241532652, abs=ANGLES)


def test_the_first_contacts_of_the_column_are_the_published_ones(consistent: Run) -> None:
    assert contacts(consistent, "+")[:2] == pytest.approx([0.3900807, 0.4624607], abs=TIMES)
    assert contacts(consistent, "-")[:2] == pytest.approx([0.7882465, 1.2198736], abs=TIMES)


def test_the_column_sticks_on_its_pin_when_it_is_said_to(consistent: Run) -> None:
    held = [event.time for event in consistent.events if event.kind in ("stick", "slip")]
    assert held[:4] == pytest.approx([0.8367814, 0.8370157, 1.5578308, 1.5579691], abs=TIMES)
    assert len(held) == 8


@pytest.mark.parametrize("case", CASES)
def test_every_sample_and_event_is_that_of_the_independent_solution(
    model: Model, case: str
) -> None:
    preset, parameters, other = CASES[case]
    run = simulate(model, preset=preset, parameters=parameters, rtol=1e-9)
    oracle = solve(parameters, times=run.t, **other)
    assert np.max(np.abs(run["phi1"] - oracle.states[0])) < ANGLES
    assert np.max(np.abs(run["phi2"] - oracle.states[2])) < ANGLES
    for kind, guards in GUARDS.items():
        theirs = [event.time for event in oracle.events if event.kind.startswith(kind)]
        ours = [event.time for event in run.events if event.guard in guards]
        assert ours == pytest.approx(theirs, abs=TIMES), kind
    sticks = [event.time for event in oracle.events if event.kind.startswith("stick")]
    ours = [event.time for event in run.events if event.kind in ("stick", "slip")]
    assert ours == pytest.approx(sticks, abs=TIMES)


def test_the_tolerance_of_a_user_who_asks_for_nothing_is_met(model: Model) -> None:
    run = simulate(model)
    oracle = solve(times=run.t)
    assert np.max(np.abs(run["phi1"] - oracle.states[0])) < 1e-5
    assert np.max(np.abs(run["phi2"] - oracle.states[2])) < 1e-5


def test_without_drive_and_friction_of_the_column_momentum_is_kept(model: Model) -> None:
    """Erratum (i): with f_s = M_L = R1 = 0, (B1 + B2) v1 + B2 v2 is constant for nT = 1 only."""
    off = dict.fromkeys(("kappa1_l", "kappa1_r", "kappa2_l", "kappa2_r"), 0.0)
    off |= {"T_v1_l": 0.0, "T_v1_r": 0.0, "mu": 0.0, "k1": 0.0, "c1": 0.0}
    start = {"phi1_dot": 1.0, "phi2_dot": -2.0}
    ours = compile(read(PENDULUM), record=["phi1_dot", "phi2_dot"])
    B1, B2 = 0.00135, 0.0003

    def drift(preset: str) -> float:
        run = simulate(ours, preset=preset, parameters=off, start=start, span=(0, 0.5), rtol=1e-10)
        momentum = (B1 + B2) * run["phi1_dot"] + B2 * run["phi2_dot"]
        return float(np.max(np.abs(momentum - momentum[0])) / np.max(np.abs(momentum)))

    assert drift("consistent") < 1e-9
    assert drift("as_printed") > 1e-3
