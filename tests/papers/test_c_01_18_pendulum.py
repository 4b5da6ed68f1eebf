"""Paper C, pendulums of C01 to C18: exact solutions, invariants, and what the print gets wrong."""

from __future__ import annotations

from math import pi, sin, sqrt

import numpy as np
import pytest
from oracles.c_1_pendulum import averaged, averaged_hamiltonian, ramp_exact
from oracles.c_common import Array
from papers.test_c_01_18 import model_of, run_of
from scipy.special import ellipk, jv
from tracewire.solve import Run, simulate


def drift(energy: Array) -> float:
    return float(np.ptp(energy) / np.max(np.abs(energy)))


# C07


@pytest.mark.parametrize(("preset", "amplitude"), [("C07a", 1.0), ("C07b", 3.0)])
def test_c07_has_the_period_of_the_elliptic_integral(preset: str, amplitude: float) -> None:
    period = 4 * sqrt(1 / 9.81) * ellipk(sin(amplitude / 2) ** 2)
    times = period * np.array([0, 0.25, 0.5, 1, 3])
    run = simulate(model_of("c07_constant_length"), preset=preset, times=times, rtol=1e-11)
    expected = amplitude * np.array([1, 0, -1, 1, 1])
    assert run["phi"] == pytest.approx(expected, abs=1e-7)


@pytest.mark.parametrize("preset", ["C07a", "C07b"])
def test_c07_keeps_its_energy(preset: str) -> None:
    run = run_of("C07a", preset)
    assert drift(run["energy"]) < 1e-7
    assert np.ptp(run["kinetic"]) > 4 and np.ptp(run["potential"]) > 4


# C09


def test_c09_the_arc_is_the_length_times_the_angle() -> None:
    run = run_of("C09", "C09")
    length = 1 + 0.2 * np.cos(run.t)
    assert np.max(np.abs(run["u"] - length * run["phi"])) < 1e-8
    assert np.max(np.abs(run["difference"])) < 1e-8
    assert np.max(np.abs(run["u"] - run["phi"])) > 0.04  # Eq 10 does not hold for phi


def test_c09_a_large_swing_comes_out_of_step_and_turns_back() -> None:
    run = run_of("C09", "C09non")
    size = np.abs(run["phi"])
    assert 2 < np.max(size) < 2.3 < 5 < np.max(np.abs(run["u"]))
    assert np.max(size[run.t > 52]) < np.max(size)


# C12


def test_c12a_the_sway_shrinks_and_is_pumped_up_again() -> None:
    run = run_of("C12a", "C12a")
    size, t = np.abs(run["phi"]), run.t
    least = np.max(size[(t > 7.5) & (t < 9.5)])
    assert least < 0.4 * size[0] and np.max(size[t > 18]) > 2.5 * least


def test_c12b_keeps_its_energy_where_nothing_takes_it() -> None:
    run = run_of("C12b", "C12bc")
    assert drift(run["energy"]) < 1e-7
    assert np.ptp(run["y"]) > 0.05  # the vehicle is shaken meanwhile


def test_c12b_loses_energy_at_every_time_where_its_vehicle_is_damped() -> None:
    run = run_of("C12b", "C12b")
    assert np.all(np.diff(run["energy"]) < 0)
    loss = np.trapezoid((0.2 + 4) * run["y_dot"] ** 2, run.t)
    assert run["energy"][0] - run["energy"][-1] == pytest.approx(loss, rel=1e-3)


def test_c12c_the_feedback_takes_the_sway_away_and_its_absence_does_not() -> None:
    run = run_of("C12c", "C12c")
    energy = run["sway_energy"]
    assert energy[-1] < 0.06 * energy[0]
    off = simulate(model_of("c12_vertical_pivot_damping"), parameters={"K": 0.0}, rtol=1e-9)
    assert drift(off["sway_energy"]) < 1e-7


# C13


def test_c13_small_swings_follow_the_bessel_functions() -> None:
    run = run_of("C13lin", "C13lin")
    phi, rate = ramp_exact(run.t, 0.1, g=9.81, l0=1.0, v=0.1)
    assert np.max(np.abs(run["phi"] - phi)) < 1e-8
    assert np.max(np.abs(run["phi_dot"] - rate)) < 1e-8


def test_c13_eq_19_is_not_a_solution_and_the_slow_law_nearly_is() -> None:
    run = run_of("C13lin", "C13lin")
    assert np.max(np.abs(run["wkb"] - run["phi"])) < 0.03 * 0.1
    assert np.max(np.abs(run["printed"] - run["phi"])) > 1.5 * 0.1


# C17

FORCED = {"A": 1.0, "omega": 1.95, "s": 0.0}


def start_of_average(run: Run) -> list[float]:
    """a and delta of phi = phi_0 at rest: phi' + i (omega/2) phi is imaginary."""
    return [1.95 / 2 * run["phi"][0], pi / 2]


def test_c17_the_corrected_hamiltonian_is_constant_along_the_averaged_flow() -> None:
    run = run_of("C17", "C17")
    flow = averaged(run.t, start_of_average(run), eps=0.1, **FORCED)
    kept = averaged_hamiltonian(*flow, eps=0.1, mu_of_J0=10, **FORCED)
    printed = averaged_hamiltonian(*flow, eps=0.1, mu_of_J0=1, **FORCED)
    assert np.ptp(kept) < 1e-9
    assert np.ptp(printed) > 4
    assert run["H"][0] == pytest.approx(kept[0], abs=1e-9)
    assert run["H_printed"][0] == pytest.approx(printed[0], abs=1e-9)


def test_c17_the_series_of_the_diagram_are_the_bessel_functions() -> None:
    run = run_of("C17", "C17")
    p = 1.95 / 2 * run["phi"]
    delta = np.arctan2(p, run["phi_dot"]) - 1.95 * run.t / 2
    for name, mu_of_J0 in (("H", 10), ("H_printed", 1)):
        expected = averaged_hamiltonian(run["a"], delta, eps=0.1, mu_of_J0=mu_of_J0, **FORCED)
        assert run[name] == pytest.approx(expected, abs=1e-5)
    assert abs(jv(0, 2 * np.max(run["a"]) / 1.95) - 1) > 0.3  # far from the first terms


@pytest.mark.parametrize("eps", [0.1, 0.05, 0.025])
def test_c17_the_pendulum_follows_its_average_the_closer_the_smaller_eps(eps: float) -> None:
    parameters = {"eps": eps, "t_end": 10 / eps}
    run = simulate(model_of("c17_averaged_pendulum"), parameters=parameters, rtol=1e-9)
    flow = averaged(run.t, start_of_average(run), eps=eps, **FORCED)
    assert np.max(np.abs(run["a"] - flow[0])) < eps
    assert np.ptp(run["H"]) < 0.08 * eps * np.ptp(run["H_printed"])


# C18


@pytest.mark.parametrize(
    ("preset", "squares", "stands"),
    [("C18s", 9.0, True), ("C18u", 2.25, False), ("C18m", 8.64, True)],
)
def test_c18_stands_where_the_sum_of_the_squares_is_above_twice_g_l(
    preset: str, squares: float, stands: bool
) -> None:
    run = run_of("C18s", preset)
    value = run.parameters
    total = sum((value[f"A{n}"] * value[f"w{n}"]) ** 2 for n in (1, 2, 3))
    assert total == pytest.approx(squares, rel=1e-3)
    assert (total > 2 * value["g"] * value["l"]) is stands
    assert bool(np.max(np.abs(run["phi"])) < pi / 2) is stands


def test_c18_three_sines_with_damping_bring_it_towards_the_top() -> None:
    run = run_of("C18s", "C18m")
    size = np.abs(run["phi"])
    assert np.max(size[run.t > 4]) < 0.6 * np.max(size[run.t < 1])


def test_c18_oscillates_about_the_top_with_the_frequency_of_the_average() -> None:
    """The effective potential A^2 w^2/(4 l^2) sin^2 phi + (g/l) cos phi, small swings."""
    start = {"phi": 0.01, "phi_dot": -0.02 * 150 / 0.25 * 0.01}  # the slow rate is zero
    run = simulate(model_of("c18_inverted_multisine"), start=start, rtol=1e-9)
    kernel = np.ones(9) / 9  # about a period of the pivot, 0.042 s
    slow = np.convolve(run["phi"], kernel, "valid")
    t = run.t[4:-4]
    down = np.nonzero((slow[:-1] > 0) & (slow[1:] <= 0))[0]
    crossings = t[down] + (t[1] - t[0]) * slow[down] / (slow[down] - slow[down + 1])
    frequency = 2 * pi / np.mean(np.diff(crossings))
    assert frequency == pytest.approx(sqrt(9 / (2 * 0.25**2) - 9.81 / 0.25), rel=0.05)
