"""The oracle of paper A against published values, invariants and a second integration method."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from oracles.double_torsion import PARAMETERS, Solution, solve


@cache
def consistent() -> Solution:
    return solve()


def test_angles_at_three_seconds() -> None:
    phi1, _, phi2, _ = consistent().states[:, 300]
    assert phi1 == pytest.approx(-0.0508692474, abs=1e-10)
    assert phi2 == pytest.approx(-0.0241532652, abs=1e-10)


def test_first_contacts_of_the_column() -> None:
    solution = consistent()
    right = solution.intervals("column contact", "+")[0]
    left = solution.intervals("column contact", "-")[0]
    assert right == pytest.approx((0.3900807, 0.4624607), abs=5.1e-8)
    assert left == pytest.approx((0.7882465, 1.2198736), abs=5.1e-8)


def test_column_sticks_on_its_pin() -> None:
    sticks = consistent().intervals("stick")
    assert len(sticks) == 4
    assert sticks[0] == pytest.approx((0.8367814, 0.8370157), abs=5.1e-8)
    assert sticks[1] == pytest.approx((1.5578308, 1.5579691), abs=5.1e-8)


def test_column_does_not_stick_on_a_soft_pin() -> None:
    assert solve({"c1": 1.2}).intervals("stick") == []


def test_start_on_the_barrier_leaves_it_at_once() -> None:
    """Three guards are zero at the start; their first non-zero derivatives decide."""
    solution = solve(times=[0.0, 1e-4])
    phi1, v1, phi2, v2 = solution.states[:, 1]
    p = PARAMETERS
    phi_f = p["A"] * math.sin(p["phase"]) + p["phi1_s"]
    f_s = p["kappa1_r"] * phi_f + p["kappa2_r"] * phi_f**3
    a = (f_s - p["T_b"]) / p["B1"]
    assert solution.events == ()
    assert v1 == pytest.approx(a * 1e-4, rel=1e-2)
    assert v2 == pytest.approx(-a * 1e-4, rel=1e-1)
    assert phi1 > -p["phi1_s"]
    assert phi2 < 0.0


def test_second_method_agrees() -> None:
    """Radau and LSODA share no code; they meet on angles, event sequence and event times."""
    times = np.arange(131) / 100.0
    first = solve(times=times)
    second = solve(times=times, stiff_method="Radau", rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(first.states[[0, 2]], second.states[[0, 2]], atol=1e-8)
    assert [e[1:] for e in first.events] == [e[1:] for e in second.events]
    np.testing.assert_allclose(
        [e.time for e in first.events], [e.time for e in second.events], atol=1e-7
    )


def test_rate_that_crosses_zero_twice_within_a_step() -> None:
    """v2 rises from zero by 3e-5 rad/s only before it falls through zero again."""
    grazing = {
        "alpha": 0.17098419471113752,
        "beta": 2.645701886536071,
        "T_s2_l": 0.01777201043603391,
        "T_02_l": 0.5769062530394234,
        "T_s2_r": 0.0633437020201297,
        "T_02_r": 0.424881403898075,
        "k2": 0.7054432794043297,
        "c2_l": 0.01435290216447099,
        "c2_r": 0.01589880812019704,
    }
    times = np.arange(101) / 100.0
    coarse = solve(grazing, times)
    fine = solve(grazing, times, max_step=5e-4)
    assert [e[1:] for e in coarse.events] == [e[1:] for e in fine.events]
    np.testing.assert_allclose(coarse.states[[0, 2]], fine.states[[0, 2]], atol=1e-9)


def test_as_printed_doubles_the_friction_and_takes_one_spring() -> None:
    times = np.arange(51) / 50.0
    printed = solve(times=times, as_printed=True)
    spelled = solve({"kappa2_l": PARAMETERS["kappa2_r"]}, times, nT=2.0)
    np.testing.assert_array_equal(printed.states, spelled.states)
    assert np.abs(printed.states[0] - solve(times=times).states[0]).max() > 1e-2


NO_SPRING = ("kappa1_l", "kappa1_r", "kappa2_l", "kappa2_r")
NO_FRICTION = ("T_v1_l", "T_v1_r", "T_b")
FREE = dict.fromkeys((*NO_SPRING, *NO_FRICTION, "k1", "c1"), 0.0)
FREE_START = (0.0, 0.3, 0.0, 0.5)


def _momentum(solution: Solution) -> np.ndarray:
    p = PARAMETERS
    momentum: np.ndarray = (p["B1"] + p["B2"]) * solution.states[1] + p["B2"] * solution.states[3]
    return momentum


def test_momentum_is_constant_without_torque_on_the_column() -> None:
    solution = solve(FREE, np.arange(101) / 100.0, start=FREE_START)
    momentum = _momentum(solution)
    assert np.ptp(solution.states[3]) > 0.1
    np.testing.assert_allclose(momentum, momentum[0], rtol=1e-9)


def test_momentum_is_lost_with_the_printed_factor() -> None:
    momentum = _momentum(solve(FREE, np.arange(101) / 100.0, nT=2.0, start=FREE_START))
    assert abs(momentum[-1] / momentum[0] - 1.0) > 1e-2


def test_undamped_column_and_spring_keep_their_energy() -> None:
    """No drive, no friction, no contact: B1 v1^2/2 + kappa1 phi1^2/2 + kappa2 phi1^4/4."""
    calm = dict.fromkeys(("A", *NO_FRICTION, "T_s2_l", "T_s2_r"), 0.0) | {"phi2_s": 10.0}
    solution = solve(calm, np.arange(201) / 100.0, start=(0.2, 0.0, 0.0, 0.0))
    phi1, v1 = solution.states[:2]
    p = PARAMETERS
    left = phi1 >= 0.0
    kappa1 = np.where(left, p["kappa1_l"], p["kappa1_r"])
    kappa2 = np.where(left, p["kappa2_l"], p["kappa2_r"])
    energy = p["B1"] * v1**2 / 2 + kappa1 * phi1**2 / 2 + kappa2 * phi1**4 / 4
    assert any(e.kind == "phi1 zero" for e in solution.events)
    np.testing.assert_allclose(energy, energy[0], rtol=1e-9)


def test_contact_opens_and_closes_on_the_barrier() -> None:
    solution = consistent()
    p = PARAMETERS
    ends = [e for e in solution.events if e.kind.startswith("column contact")]
    times = np.array([0.0, *(e.time for e in ends)])
    at_events = solve(times=times).states[0, 1:]
    signs = np.array([1.0 if e.detail == "+" else -1.0 for e in ends])
    np.testing.assert_allclose(signs * at_events, p["phi1_s"], atol=1e-9)


def test_unknown_parameter_is_refused() -> None:
    with pytest.raises(KeyError, match="kappa3"):
        solve({"kappa3": 1.0})
