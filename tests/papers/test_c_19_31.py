"""Paper C, the smooth systems C19 to C31: the shipped diagrams against independent solutions."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from oracles.c_19_31 import CASES
from tracewire.compile import Model, compile
from tracewire.diagram import read
from tracewire.solve import Run, simulate

REVIEW = Path(__file__).parents[2] / "diagrams/papers/c_review"
FILES = {
    "C19": "c19_vibrating_base",
    "C20": "c20_nonlinear_spring",
    "C21": "c21_slider_spring",
    "C21r": "c21_slider_spring_rigid",
    "C24": "c24_flexural_absorber",
    "C25": "c25_coupled_pendulums",
    "C26": "c26_wave_energy",
    "C27": "c27_wave_energy_flywheel",
    "C28": "c28_triple_arm",
    "C31": "c31_crane",
}


@cache
def model(system: str) -> Model:
    return compile(read(REVIEW / f"{FILES[system]}.yaml"))


@cache
def run(case: str, rtol: float = 1e-9, **options: float) -> Run:
    system = case if case in FILES else case[:3]
    return simulate(model(system), preset=case, parameters=options, rtol=rtol)


@pytest.mark.parametrize("case", CASES)
def test_every_state_is_that_of_the_independent_solution(case: str) -> None:
    ours, known = run(case), CASES[case]
    assert ours.t[-1] == known.end
    assert tuple(ours.final) == known.states
    for name, values in known.solve(ours.t).items():
        off = np.max(np.abs(ours[name] - values))
        assert off < known.tolerance * np.max(np.abs(values)), name


@pytest.mark.parametrize("system", FILES)
def test_without_a_preset_a_diagram_is_its_first_case(system: str) -> None:
    first = next(case for case in CASES if case.startswith(system))
    assert simulate(model(system), rtol=1e-9).final == run(first).final


def drift(case: str, name: str, **parameters: float) -> float:
    """How far a signal goes from its start, in units of its largest value."""
    values = run(case, 1e-9, **parameters)[name]
    return float(np.max(np.abs(values - values[0])) / np.max(np.abs(values)))


def test_the_upright_position_of_a_varying_length_is_not_stable() -> None:
    """C19: near pi it stays near, near 0 it falls over, however close it starts."""
    assert np.max(np.abs(run("C19")["phi"] - np.pi)) < 0.2
    assert run("C19up")["phi"].max() > 2 * np.pi
    assert run("C19up", phi_0=1e-6)["phi"].max() > np.pi


@pytest.mark.parametrize("case", ["C20c", "C21c"])
def test_without_damping_and_force_the_energy_stays(case: str) -> None:
    assert drift(case, "energy") < 1e-7


@pytest.mark.parametrize("case", ["C20", "C21"])
def test_with_damping_and_force_it_does_not(case: str) -> None:
    assert drift(case, "energy") > 0.05


@pytest.mark.parametrize("case", ["C21", "C21r"])
def test_the_force_is_the_rate_of_the_momentum(case: str) -> None:
    """Spring and damper are between slider and bob: they do not change it."""
    ours = run(case)
    assert ours["momentum"] == pytest.approx(3 / 2 * np.sin(2 * ours.t), abs=1e-8)


def test_without_force_the_momentum_stays() -> None:
    assert np.max(np.abs(run("C21c")["momentum"])) < 1e-9


def test_a_stiff_spring_makes_a_rigid_pendulum() -> None:
    """C21 with a stiff, damped spring goes to C21r."""
    rigid = run("C21r")
    off = []
    for k in (1e4, 1e5):
        start = {"l": 1.0 + 9.81 / k}
        ours = simulate(
            model("C21"), parameters={"k": k, "c": 20.0}, start=start, times=rigid.t, rtol=1e-8
        )
        off.append(np.max(np.abs(ours["phi"] - rigid["phi"])))
    assert off[1] < 0.2 * off[0] < 0.02


def test_the_pendulum_takes_the_energy_of_the_mass() -> None:
    """C24: at twice its own frequency the absorber cannot stay hanging, and calms the mass."""
    absorbed, alone = run("C24"), run("C24", m=1e-9, M=5.5)
    late = absorbed.t > 30
    assert np.max(np.abs(absorbed["phi"])) > np.pi
    assert np.max(np.abs(absorbed["y"][late])) < 0.25 * np.max(np.abs(alone["y"][late]))
    # without it the mass comes to F0/(c Om), as its damper alone holds it
    assert np.max(np.abs(alone["y"][late])) == pytest.approx(5 / (3 * 12.528), rel=1e-3)


def test_off_its_resonance_the_pendulum_does_not_move() -> None:
    assert np.max(np.abs(run("C24", Om=10.0)["phi"])) < 0.2


def test_an_absorber_without_force_and_damping_keeps_its_energy() -> None:
    still = {"c": 0.0, "cp": 0.0, "F0": 0.0}
    start = {"phi": 1.5, "y": 0.05}
    free = simulate(model("C24"), parameters=still, start=start, rtol=1e-9)
    assert np.ptp(free["energy"]) < 1e-7 * np.ptp(free["kinetic"])


FIRST = np.sqrt(9.8)
SECOND = np.sqrt(9.8 + 2 * 19.7 * 0.55**2 / 0.5)


@pytest.mark.parametrize(("case", "omega", "side"), [("C25m1", FIRST, 1), ("C25m2", SECOND, -1)])
def test_each_mode_of_two_pendulums_is_one_cosine(case: str, omega: float, side: int) -> None:
    ours = run(case)
    assert ours["phi1"] == pytest.approx(0.1 * np.cos(omega * ours.t), abs=1e-8)
    assert ours["phi2"] == pytest.approx(side * ours["phi1"], abs=1e-8)


def test_the_mixed_motion_has_the_lines_of_both_modes_and_no_other() -> None:
    ours = run("C25mix")
    for omega in (FIRST, SECOND):
        assert lines(ours, np.array([omega]))[0] == pytest.approx(0.05, abs=0.01)
    aside = np.array([1.0, 2.0, 4.2, 7.0, 9.0])
    assert lines(ours, aside).max() < 0.01
    exact = 0.05 * (np.cos(FIRST * ours.t) + np.cos(SECOND * ours.t))
    assert ours["phi1"] == pytest.approx(exact, abs=1e-8)


def lines(ours: Run, omega: np.ndarray) -> np.ndarray:
    """Amplitudes of phi1 at angular frequencies, with a Hann window."""
    window = np.hanning(ours.t.size)
    waves = np.exp(-1j * np.outer(omega, ours.t))
    return 2 * np.abs(waves @ (window * ours["phi1"])) / window.sum()


def test_pendulums_of_unequal_lengths_keep_their_energy() -> None:
    assert drift("C25ne", "energy") < 1e-7
    assert np.max(np.abs(run("C25ne")["phi2"])) > 0.05


def test_twice_the_natural_frequency_swings_the_wave_pendulum_up() -> None:
    """C26: only close to 2 sqrt(g/l); C26r goes over the top."""
    assert np.max(np.abs(run("C26")["phi"])) > 1
    assert np.max(np.abs(run("C26", omega=7.0)["phi"])) < 0.2
    assert np.max(np.abs(run("C26r")["phi"])) > 2 * np.pi


@pytest.mark.parametrize(
    ("case", "still", "omega"),
    [
        ("C26", {"A": 0.0, "c": 0.0, "phi_0": 1e-3}, np.sqrt(9.81 / 0.5)),
        ("C27", {"A": 0.0, "c": 0.0}, np.sqrt(9.81 * 0.5 * 0.5 / 0.35)),
        ("C28", {"r": 0.0, "c": 0.0}, 1.586),
    ],
)
def test_the_natural_frequency_is_that_of_the_paper(
    case: str, still: dict[str, float], omega: float
) -> None:
    """A small free swing: at zero after each half period."""
    ours = simulate(
        model(case), parameters=still, start={"phi": 1e-3}, span=(0, np.pi / omega), rtol=1e-10
    )
    assert ours.final["phi"] == pytest.approx(-1e-3, rel=1e-6)
    assert ours.final["phi_dot"] == pytest.approx(0, abs=1e-6)


def test_the_crank_has_two_harmonics_and_pumps_the_swing() -> None:
    ours = run("C28")
    wave = 3.17 * ours.t
    assert ours["crank"] == pytest.approx(3.17**2 * 0.15 * (np.cos(wave) + np.cos(2 * wave) / 4))
    assert np.max(np.abs(ours["phi"])) > 0.9
    assert np.max(np.abs(run("C28", omega=2.2)["phi"])) < 0.3


def test_the_crane_lets_its_load_down() -> None:
    ours = run("C31")
    assert ours["l"][-1] == pytest.approx(1.5, abs=5e-3)
    assert np.max(np.abs(ours["theta"][ours.t > 10])) > 0.1


def test_a_crane_without_drive_and_damping_keeps_its_energy() -> None:
    free = run("C31", cx=0.0, cl=0.0, ct=0.0, Fx=0.0)
    assert np.ptp(free["energy"]) < 1e-7 * np.ptp(free["kinetic"])
    assert np.ptp(free["kinetic"]) > 0.1
