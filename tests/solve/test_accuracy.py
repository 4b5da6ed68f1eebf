from __future__ import annotations

import math

import pytest
from solve.models import LIMITS, OSCILLATOR, made, run
from tracewire.solve import simulate

VAN_DER_POL = """
span: [0, 3]
parameters: {mu: 5}
blocks:
  x: {type: integrator, of: v, start: 2}
  v: {type: integrator, of: a}
  a: {type: expression, formula: mu*(1 - x*x)*v - x}
"""

CONTACT = """
span: [0, 4]
record: [x, v]
parameters: {c: 120, k: 300}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  drive: {type: sine, amplitude: 0.6, omega: 3.9}
  wall: {type: voigt_barrier, of: x, rate: v, high: 0.2, k: k, c_l: c}
  pull: {type: expression, formula: 0.02*(drive - x)}
  friction: {type: coulomb, rate: v, level: 4e-5}
  force: {type: sum, of: [wall, pull, friction]}
  a: {type: gain, of: force, k: 1/0.00135}
"""


@pytest.mark.parametrize("method", ["dormand_prince", "rosenbrock"])
def test_the_error_follows_the_tolerance(method: str) -> None:
    text = OSCILLATOR.replace("level: 0.1", "level: 0")
    errors = []
    for rtol in (1e-5, 1e-7, 1e-9):
        result = run(text, rtol=rtol, method=method, span=(0, 100))
        errors.append(abs(result.final["x"] - 1.05 * math.cos(100)))
    assert errors[1] < errors[0] / 20
    assert errors[2] < errors[1] / 20
    assert errors[2] < 1e-7


def test_both_methods_agree() -> None:
    model = made(VAN_DER_POL)
    ends = [
        simulate(model, rtol=1e-10, method=method).final["x"]
        for method in ("dormand_prince", "rosenbrock")
    ]
    assert ends[0] == pytest.approx(ends[1], abs=1e-7)


def test_auto_finds_a_stiff_mode() -> None:
    model = made(VAN_DER_POL)
    options = {"parameters": {"mu": 2000.0}, "span": (0.0, 200.0), "limits": LIMITS}
    result = simulate(model, **options)
    assert result.statistics.stiff_steps > 10
    assert result.statistics.steps < 2000
    exact = simulate(model, rtol=1e-9, method="rosenbrock", **options)
    assert result.final["x"] == pytest.approx(exact.final["x"], rel=1e-5)


def test_a_stiff_contact_as_in_paper_a() -> None:
    """In contact the wall's damper pulls the state at c/B1 = 9e4 1/s."""
    model = made(CONTACT)
    result = simulate(model, rtol=1e-7, limits=LIMITS)
    assert result.statistics.stiff_steps > 0
    assert result.statistics.steps < 4000
    other = simulate(model, rtol=1e-9, method="rosenbrock", limits=LIMITS)
    assert result["x"] == pytest.approx(other["x"], abs=1e-6)
    assert [e.guard for e in result.events] == [e.guard for e in other.events]
    times = [e.time for e in result.events], [e.time for e in other.events]
    assert times[0] == pytest.approx(times[1], abs=1e-5)
    assert {e.kind for e in result.events} <= {"crossing", "stick", "slip"}
