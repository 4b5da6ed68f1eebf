"""The motors that come with tracewire as subsystems, against the equations of a DC motor."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm
from solve.models import LIMITS
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.solve import Run, simulate

TOP = "include: tracewire:motors.yaml\n"
R, L, K, J = 0.299, 0.0823e-3, 30.2e-3, 1.42e-5


def ran(blocks: str, *record: str, end: float = 1.0) -> Run:
    model = compile(read_text(f"{TOP}blocks: {{{blocks}}}"), record=record)
    return simulate(model, span=(0.0, end), limits=LIMITS)


def test_without_friction_the_motor_is_linear() -> None:
    motor = "motor: {type: dc_motor, voltage: u, load: m, slip: 0, stick: 0}"
    given = "u: {type: constant, value: 12, unit: V}, m: {type: constant, value: -0.02, unit: N m}"
    run = ran(f"{motor}, {given}", "motor.current", "motor.rate", "motor.angle", end=0.02)
    system = np.array([[-R / L, -K / L, 12 / L], [K / J, 0.0, -0.02 / J], [0.0, 0.0, 0.0]])
    exact = np.array([(expm(system * t) @ [0.0, 0.0, 1.0])[:2] for t in run.t])
    assert run["motor.current"] == pytest.approx(exact[:, 0], rel=1e-5, abs=1e-4)
    assert run["motor.rate"] == pytest.approx(exact[:, 1], rel=1e-5, abs=1e-4)
    turned = np.linalg.solve(system[:2, :2], exact[-1] - system[:2, 2] * run.t[-1])[1]
    assert run["motor.angle"][-1] == pytest.approx(turned, rel=1e-5)


def test_at_a_steady_rate_the_current_carries_the_friction() -> None:
    motor = "motor: {type: dc_motor, voltage: u}, u: {type: constant, value: 12, unit: V}"
    run = ran(motor, "motor.current", "motor.rate", "motor.torque")
    assert run["motor.torque"][-1] == pytest.approx(4e-3, rel=1e-6)
    assert run["motor.rate"][-1] == pytest.approx((12 - R * 4e-3 / K) / K, rel=1e-6)


def test_a_voltage_below_that_of_the_friction_turns_nothing() -> None:
    u = 0.99 * R * 6e-3 / K
    motor = f"motor: {{type: dc_motor, voltage: u}}, u: {{type: constant, value: {u}, unit: V}}"
    assert np.abs(ran(motor, "motor.angle")["motor.angle"]).max() < 1e-18


def test_the_servo_settles_within_a_tenth_of_a_second_and_its_supply() -> None:
    blocks = "servo: {type: servo, target: u}, u: {type: step, at: 0.1, height: 1.5, unit: rad}"
    run = ran(blocks, "servo.angle", "servo.voltage")
    assert np.abs(run["servo.voltage"]).max() == 24.0
    assert run["servo.angle"].max() < 1.05 * 1.5
    assert run["servo.angle"][run.t > 0.2] == pytest.approx(1.5, rel=0.01)
