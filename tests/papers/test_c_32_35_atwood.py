"""Paper C: the swinging Atwood machine (C32) and the one with pulleys (C33)."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from oracles import c_32_35 as oracle
from tracewire.compile import Model, compile
from tracewire.diagram import read
from tracewire.solve import Run, simulate

FOLDER = Path(__file__).parents[2] / "diagrams/papers/c_review"
STATES = ("l", "l_dot", "phi", "phi_dot")
# the mass ratios of Figs 28 to 39
RATIOS = dict(zip(range(28, 40), (2, 3, 5, 6, 16, 19, 21, 24, 1.7, 2.4, 1.2, 1.6), strict=True))
# the closed orbits near the labels of Figs 36 to 39, with the digits that the literature prints
LITERATURE = {36: (1.7, "1.665"), 37: (2.4, "2.394"), 38: (1.2, "1.1727"), 39: (1.6, "1.555")}


RTOL = 1e-9


@pytest.fixture(scope="module")
def machine() -> Model:
    return compile(read(FOLDER / "c32_swinging_atwood_machine.yaml"))


@pytest.fixture(scope="module")
def pulleys() -> Model:
    return compile(read(FOLDER / "c33_pulleys.yaml"))


@pytest.fixture(scope="module")
def runs(machine: Model) -> dict[int, Run]:
    return {figure: simulate(machine, preset=f"C32_{figure}", rtol=RTOL) for figure in RATIOS}


def agree(run: Run, states: np.ndarray, part: float = 1e-6) -> None:
    """Each state within `part` of its largest value."""
    for name, exact in zip(STATES, states, strict=True):
        assert np.max(np.abs(run[name] - exact)) < part * np.max(np.abs(exact)), name


def drift(signal: np.ndarray) -> float:
    return float(np.max(np.abs(signal - signal[0])))


@pytest.mark.parametrize("figure", RATIOS)
def test_every_figure_is_that_of_the_independent_solution(
    runs: dict[int, Run], figure: int
) -> None:
    run = runs[figure]
    assert run.parameters["mu"] == RATIOS[figure]
    assert run.t[-1] == 20.0
    agree(run, oracle.atwood(RATIOS[figure], run.t))


def test_the_first_figure_is_what_runs_without_options(machine: Model) -> None:
    assert simulate(machine).parameters["mu"] == RATIOS[28]


@pytest.mark.parametrize("figure", RATIOS)
def test_energy_is_kept(runs: dict[int, Run], figure: int) -> None:
    energy = runs[figure]["energy"]
    assert drift(energy) < 1e-7 * energy[0]


def test_the_second_integral_is_kept_at_the_integrable_ratio_only(runs: dict[int, Run]) -> None:
    integral = {figure: runs[figure]["second_integral"] for figure in (28, 29)}
    assert drift(integral[29]) < 1e-7 * integral[29][0]
    assert drift(integral[28]) > 0.1 * integral[28][0]


def test_no_orbit_of_the_figures_comes_to_the_pulley(runs: dict[int, Run]) -> None:
    for run in runs.values():
        assert run.events == ()
        assert np.min(run["l"]) > 0.04


def test_the_position_is_that_of_the_polar_figures(runs: dict[int, Run]) -> None:
    run = runs[30]
    assert np.hypot(run["x"], run["y"]) == pytest.approx(run["l"], rel=1e-14)
    assert (run["x"][0], run["y"][0]) == pytest.approx((1.0, 0.0), abs=1e-15)
    angle = np.arctan2(run["x"], -run["y"])
    assert np.cos(angle) == pytest.approx(np.cos(run["phi"]), abs=1e-12)
    assert np.sin(angle) == pytest.approx(np.sin(run["phi"]), abs=1e-12)


def test_a_longer_rope_makes_the_same_orbit_larger_and_slower(machine: Model) -> None:
    large = simulate(machine, preset="C32_scale", rtol=RTOL)
    assert large.t[-1] == 7.9
    small = simulate(machine, preset="C32_30", times=large.t / math.sqrt(2.5), rtol=RTOL)
    assert np.max(np.abs(large["l"] / 2.5 - small["l"])) < 1e-6
    assert np.max(np.abs(large["phi"] - small["phi"])) < 1e-6 * np.max(np.abs(small["phi"]))
    agree(large, oracle.atwood(5, large.t, l_0=2.5))


@pytest.mark.parametrize("figure", LITERATURE)
def test_closed_orbits_near_the_printed_ratios(machine: Model, figure: int) -> None:
    label, printed = LITERATURE[figure]
    found = oracle.brake_orbit(label)
    assert round(found.mu, len(printed) - 2) == float(printed)

    def rest(preset: str) -> float:
        """How fast the machine moves when it should rest, in parts of its highest speed."""
        times = np.linspace(0.0, found.time, 201)
        run = simulate(machine, preset=preset, times=times, rtol=1e-10)
        return float(math.sqrt(run["kinetic"][-1] / np.max(run["kinetic"])))

    closed = simulate(machine, preset=f"C32_{figure}_closed", rtol=1e-10, span=(0, 0.1))
    assert closed.parameters["mu"] == pytest.approx(found.mu, abs=1e-8)
    assert rest(f"C32_{figure}_closed") < 1e-6
    assert rest(f"C32_{figure}") > 1e-3


def test_the_smile_passes_the_bottom_across_the_rope() -> None:
    """A symmetric orbit: found in another way, by l' = 0 at phi = 0."""
    assert oracle.smile(1.6, 1.7) == pytest.approx(oracle.brake_orbit(1.7).mu, abs=1e-9)


def test_the_mass_stops_at_the_pulley_and_leaves_it_again(machine: Model) -> None:
    run = simulate(machine, preset="C32_stop", rtol=1e-9)
    exact = oracle.atwood_stopped(2.0, [1.0, 0.0, 0.3, 0.0], run.t, 0.2)
    agree(run, exact.states)
    kinds = {"free": ["reset"], "held": ["reset", "rest"]}
    expected = [
        (change.time, kind)
        for change in exact.changes
        for kind in (["slip"] if change.before == "held" else kinds[change.after])
    ]
    assert [event.kind for event in run.events] == [kind for _, kind in expected]
    assert [event.time for event in run.events] == pytest.approx(
        [time for time, _ in expected], abs=1e-8
    )
    assert {kind for _, kind in expected} == {"reset", "rest", "slip"}
    held = (run.t > 0.79) & (run.t < 1.15)
    assert run["l"][held] == pytest.approx(0.2, abs=1e-12)


CASES = {
    "C33a": ((0.15, 0.1, 0.025, 2e-6), (1.0, 0.0, 1.0, 0.0), 5.0),
    "C33b": ((0.3, 0.1, 0.025, 2e-6), (1.0, 0.0, 1.0, 0.0), 5.0),
    "C33lim": ((0.3, 0.1, 1e-9, 0.0), (1.0, 0.0, math.pi / 2, 0.0), 2.0),
}


@pytest.mark.parametrize("case", CASES)
def test_every_case_with_pulleys_is_that_of_the_independent_solution(
    pulleys: Model, case: str
) -> None:
    values, start, end = CASES[case]
    run = simulate(pulleys, preset=case, rtol=1e-9)
    assert run.t[-1] == end
    assert run.events == ()
    agree(run, oracle.pulleys(*values, start, run.t))


@pytest.mark.parametrize("case", CASES)
def test_the_corrected_hamiltonian_is_kept_and_the_printed_is_not(
    pulleys: Model, case: str
) -> None:
    run = simulate(pulleys, preset=case, rtol=1e-9)
    assert drift(run["H"]) < 1e-7 * run["H"][0]
    assert drift(run["H_printed"]) > 0.1 * run["H"][0]


def test_the_hamiltonian_is_kinetic_and_potential_energy(pulleys: Model) -> None:
    """By the rate of the recorded position, the rope's speed, and the turn of two pulleys."""
    run = simulate(pulleys, preset="C33a", rtol=1e-10, times=np.arange(5001) / 1000)
    M, m, R, Ip = CASES["C33a"][0]
    speed = np.gradient(run["x"], run.t, edge_order=2) ** 2
    speed += np.gradient(run["y"], run.t, edge_order=2) ** 2
    rope = run["l_dot"] - R * run["phi_dot"]
    kinetic = m * speed / 2 + M * rope**2 / 2 + Ip * (rope / R) ** 2
    height = m * run["y"] + M * (run["l"] - R * run["phi"])
    assert kinetic + 9.81 * height == pytest.approx(run["H"], abs=1e-3)


def test_without_radius_it_is_the_machine_without_pulleys(machine: Model, pulleys: Model) -> None:
    run = simulate(pulleys, preset="C33lim", rtol=1e-9)
    agree(run, oracle.atwood(3.0, run.t))


def test_the_corrected_inertia_is_that_of_its_fall(pulleys: Model) -> None:
    """Eq 70: the counterweight, let go at phi = 0, falls by h in Dt."""
    run = simulate(pulleys, preset="C33Ip", rtol=1e-9)
    assert run.parameters["Ip"] == pytest.approx(oracle.pulley_inertia(0.3, 0.1, 0.025, 1.0, 0.65))
    assert run["l"][0] - run["l"][-1] == pytest.approx(1.0, abs=1e-9)
    assert run.t[-1] == 0.65
