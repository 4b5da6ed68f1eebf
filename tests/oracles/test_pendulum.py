"""The pendulum oracle against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from oracles.pendulum import solve
from scipy.special import ellipk


def test_period_of_the_free_pendulum() -> None:
    """T = 4 K(sin^2(theta0/2))/w0: each turn comes half a period after the last."""
    w0 = 8.0
    swing = solve([0.0, 5.0], 1.4, w0_squared=w0**2)
    half = 2.0 * ellipk(math.sin(0.7) ** 2) / w0
    turns = [e.time for e in swing.events]
    assert len(turns) == int(5.0 / half)
    np.testing.assert_allclose(turns, half * np.arange(1, len(turns) + 1), rtol=1e-10)


def test_energy_of_the_free_pendulum() -> None:
    swing = solve(np.linspace(0.0, 10.0, 201), 2.5, w0_squared=64.0)
    energy = swing.omega**2 / 2 - 64.0 * np.cos(swing.theta)
    np.testing.assert_allclose(energy, energy[0], rtol=1e-9)


def test_small_angle_viscous_decay() -> None:
    """theta = theta0 e^(-ct/2) (cos wd t + (c/2 wd) sin wd t); cubic terms are below theta0^3."""
    t = np.linspace(0.0, 4.0, 81)
    swing = solve(t, 1e-5, w0_squared=64.0, c=0.8)
    wd = math.sqrt(64.0 - 0.16)
    exact = 1e-5 * np.exp(-0.4 * t) * (np.cos(wd * t) + 0.4 / wd * np.sin(wd * t))
    np.testing.assert_allclose(swing.theta, exact, atol=2e-12)


def test_dry_friction_loses_two_widths_a_half_swing_and_stops() -> None:
    """Small angles: |theta| falls by 2 f_c/w0^2 a half swing until it is below f_c/w0^2."""
    width = 1e-5 / 8.5 * 1.0
    f_c = 64.0 * width
    turns = np.arange(0.0, 10.0) * math.pi / 8.0
    swing = solve(turns, 1e-5, w0_squared=64.0, f_c=f_c)
    expected = [(-1.0) ** n * (1e-5 - 2.0 * n * width) for n in range(5)]
    np.testing.assert_allclose(swing.theta[:5], expected, atol=2e-12)
    assert [e.kind for e in swing.events] == ["turn"] * 3 + ["stick begin"]
    np.testing.assert_array_equal(swing.theta[5:], swing.theta[5])
    np.testing.assert_array_equal(swing.omega[5:], 0.0)


def test_large_swing_loses_the_work_of_dry_friction() -> None:
    """Between two turns w0^2 (cos theta2 - cos theta1) = f_c |theta1 - theta2|."""
    free = solve([0.0, 3.0], 1.3, w0_squared=64.0, f_c=0.4)
    turns = [0.0, *(e.time for e in free.events)]
    theta = solve(turns, 1.3, w0_squared=64.0, f_c=0.4).theta
    np.testing.assert_allclose(
        64.0 * np.diff(np.cos(theta)), 0.4 * np.abs(np.diff(theta)), rtol=1e-8
    )


def test_quadratic_drag_between_turns() -> None:
    """With E = omega^2/2: dE/dtheta = -w0^2 sin theta + 2 c_q E while omega < 0, linear in E."""
    c_q, w = 0.3, 64.0
    first = solve([0.0, 1.0], 1.0, w0_squared=w, c_q=c_q).events[0].time
    end = solve([0.0, first], 1.0, w0_squared=w, c_q=c_q).theta[-1]

    def primitive(theta: float) -> float:
        k = 2.0 * c_q
        factor = math.exp(-k * theta) / (1.0 + k * k)
        return w * factor * (k * math.sin(theta) + math.cos(theta))

    assert primitive(end) == pytest.approx(primitive(1.0), rel=1e-9)


def test_drive_breaks_the_stick() -> None:
    """At rest at 0 it is held until (A/J) sin(2 pi f t) reaches f_c."""
    swing = solve([0.0, 1.0], 0.0, w0_squared=64.0, f_c=1.0, A=0.04, J=0.02, f=0.25)
    released = math.asin(0.5) / (2.0 * math.pi * 0.25)
    assert swing.events[0] == (0.0, "stick begin")
    assert swing.events[1].kind == "stick end"
    assert swing.events[1].time == pytest.approx(released, abs=1e-12)
    assert swing.theta[-1] > 0.0


def test_drive_below_the_friction_moves_nothing() -> None:
    swing = solve(np.linspace(0, 9, 10), 0.0, w0_squared=64.0, f_c=1.0, A=0.9, f=1.0)
    np.testing.assert_array_equal(swing.theta, 0.0)
    assert [e.kind for e in swing.events] == ["stick begin"]


def test_linear_drive_far_from_resonance() -> None:
    """Small drive on a damped pendulum settles on amplitude a/sqrt((w0^2-w^2)^2+(c w)^2)."""
    w = 2.0 * math.pi * 0.5
    t = np.linspace(0.0, 12.0, 601)
    swing = solve(t, 0.0, w0_squared=64.0, c=4.0, A=1e-4, J=1.0, f=0.5)
    amplitude = 1e-4 / math.hypot(64.0 - w**2, 4.0 * w)
    lag = math.atan2(4.0 * w, 64.0 - w**2)
    late = t > 10.0
    np.testing.assert_allclose(
        swing.theta[late], amplitude * np.sin(w * t[late] - lag), atol=1e-4 * amplitude
    )
