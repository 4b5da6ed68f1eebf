"""Control blocks and filters, run against closed forms and the matrix exponential of scipy."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import signal
from solve.models import made, run
from tracewire.solve import Run, simulate

Vector = NDArray[np.float64]
TIGHT = {"rtol": 1e-10, "atol": 1e-13}


def driven(block: str, source: str = "{type: constant, value: 1}", more: str = "") -> Run:
    """A run of 3 s of a block `y` that reads a source `u`."""
    text = f"span: [0, 3]\nevery: 0.05\nblocks:\n  u: {source}\n  y: {block}\n{more}record: [y, u]"
    return run(text, **TIGHT)


def exact_step(numerator: list[float], denominator: list[float], t: Vector) -> Vector:
    """The step response from rest, by the matrix exponential: the input is constant."""
    return np.asarray(signal.lsim((numerator, denominator), np.ones_like(t), t)[1])


@pytest.mark.parametrize(
    ("numerator", "denominator"),
    [
        ([1.0], [1.0, 2.0]),
        ([3.0, 0.0], [1.0, 2.0]),  # direct feedthrough
        ([1.0, 2.0], [1.0, 0.0]),  # an integrator and a gain
        ([2.0], [1.0, 0.0, 0.0]),  # two integrators
        ([5.0], [2.0, 0.4, 50.0]),
        ([1.0, 0.5, 3.0], [4.0, 1.0, 8.0]),
        ([1.0, 2.0, 3.0], [1.0, 10.0, 35.0, 50.0, 24.0]),
        ([1e-3], [1e-9, 2e-6, 1e-3]),  # poles at 1e3 rad/s
    ],
)
def test_transfer_function_has_the_step_response_of_its_poles_and_zeros(
    numerator: list[float], denominator: list[float]
) -> None:
    result = driven(
        f"{{type: transfer_function, of: u, numerator: {numerator}, denominator: {denominator}}}"
    )
    exact = exact_step(numerator, denominator, result.t)
    assert result["y"] == pytest.approx(exact, rel=1e-7, abs=1e-8)


def test_transfer_function_may_be_fitted_and_its_slopes_are_those_of_the_closed_form() -> None:
    text = """
span: [0, 2]
parameters: {T: {value: 0.5, fit: [0.1, 2]}}
blocks:
  u: {type: constant, value: 1}
  y: {type: transfer_function, of: u, denominator: [T, 1]}
record: [y]
"""
    result = simulate(made(text), sensitivities=["T"], rtol=1e-9, atol=1e-12)
    t = result.t
    assert result["y"] == pytest.approx(1 - np.exp(-t / 0.5), abs=1e-7)
    slope = -np.exp(-t / 0.5) * t / 0.5**2
    assert result.sensitivities["T"]["y"] == pytest.approx(slope, abs=1e-6)


def test_state_space_moves_by_the_exponential_of_its_matrix() -> None:
    matrices = ([[0.0, 1.0], [-4.0, -0.4]], [[0.0, 1.0], [1.0, 0.0]])
    result = run(
        f"""
span: [0, 3]
blocks:
  one: {{type: constant, value: 1}}
  two: {{type: constant, value: -2}}
  u: {{type: mux, of: [one, two]}}
  y: {{type: state_space, of: u, A: {matrices[0]}, B: {matrices[1]}, C: [[1, 0], [1, 1]],
       D: [[0, 0], [0.5, 0]], start: [0.3, -0.1]}}
record: [y]
""",
        **TIGHT,
    )
    system = (*map(np.array, matrices), np.array([[1, 0], [1, 1]]), np.array([[0, 0], [0.5, 0]]))
    u = np.tile([1.0, -2.0], (len(result.t), 1))
    _, exact, _ = signal.lsim(system, u, result.t, X0=[0.3, -0.1])
    for row in (0, 1):
        assert result[f"y[{row}]"] == pytest.approx(exact[:, row], rel=1e-7, abs=1e-8)


def test_state_space_of_one_row_is_a_number() -> None:
    block = "{type: state_space, of: u, A: [[-2]], B: [[3]], C: [4], start: [1]}"
    result = driven(block)
    exact = 4 * (1.5 - 0.5 * np.exp(-2 * result.t))
    assert result["y"] == pytest.approx(exact, abs=1e-8)


FILTERS = {
    "first_order": ("k: 3, lag: 0.5", [3.0], [0.5, 1.0]),
    "lead_lag": ("k: 3, lead: 0.2, lag: 0.5", [0.6, 3.0], [0.5, 1.0]),
    "derivative": ("k: 3, lag: 0.5", [3.0, 0.0], [0.5, 1.0]),
    "second_order": ("k: 3, frequency: F, damping: 0.2", [12.0], [1.0, 0.8, 4.0]),
    "low_pass": ("frequency: F", [4.0], [1.0, 8**0.5, 4.0]),
    "high_pass": ("frequency: F", [1.0, 0.0, 0.0], [1.0, 8**0.5, 4.0]),
    "band_pass": ("frequency: F, damping: 0.1", [0.4, 0.0], [1.0, 0.4, 4.0]),
    "notch": ("frequency: F, damping: 0.1", [1.0, 0.0, 4.0], [1.0, 0.4, 4.0]),
}
"""Settings, numerator and denominator; F is 2 rad/s."""


@pytest.mark.parametrize("name", FILTERS)
def test_first_order_second_order_and_other_filters_are_their_transfer_functions(name: str) -> None:
    settings, numerator, denominator = FILTERS[name]
    settings = settings.replace("F", repr(1 / np.pi))
    result = driven(f"{{type: {name}, of: u, {settings}}}")
    exact = exact_step(numerator, denominator, result.t)
    assert result["y"] == pytest.approx(exact, rel=1e-7, abs=1e-8)


@pytest.mark.parametrize(
    ("numerator", "denominator", "u"),
    [
        ([2.0], [0.5, 1.0], 1.5),
        ([5.0], [2.0, 0.4, 50.0], 30.0),
        ([1.0, 0.5, 4.0], [4.0, 1.0, 8.0], 6.0),  # direct feedthrough, and zeros
        ([1.0, 2.0], [1.0, 3.0, 0.0], 0.0),  # it integrates, and rests at any output
        ([1e-3], [1e-9, 2e-6, 1e-3], 3.0),
    ],
)
def test_transfer_function_may_begin_settled(
    numerator: list[float], denominator: list[float], u: float
) -> None:
    block = f"{{type: transfer_function, of: u, numerator: {numerator}, denominator: {denominator}"
    result = driven(f"{block}, start: 3}}", f"{{type: constant, value: {u}}}")
    assert result["y"] == pytest.approx(np.full_like(result.t, 3.0), rel=1e-9)


def test_transfer_function_let_go_at_its_start_swings() -> None:
    """2 x'' + 0.4 x' + 50 x = 0 from x = 3 at rest: an under-damped swing."""
    block = "{type: transfer_function, of: u, denominator: [2, 0.4, 50], start: 3}"
    result = driven(block, "{type: constant, value: 0}")
    decay, omega = 0.1, np.sqrt(25 - 0.01)
    t = result.t
    exact = 3 * np.exp(-decay * t) * (np.cos(omega * t) + decay / omega * np.sin(omega * t))
    assert result["y"] == pytest.approx(exact, abs=1e-7)


@pytest.mark.parametrize("name", FILTERS)
def test_filters_may_begin_settled_to_an_input(name: str) -> None:
    settings, numerator, denominator = FILTERS[name]
    settings = settings.replace("F", repr(1 / np.pi))
    result = driven(f"{{type: {name}, of: u, {settings}, start: 1}}")
    level = numerator[-1] / denominator[-1] if len(numerator) == len(denominator) else None
    level = level if name not in ("first_order", "second_order", "low_pass") else numerator[-1]
    settled = {"band_pass": 0.0, "low_pass": 1.0, "second_order": 3.0}.get(name, level)
    assert result["y"] == pytest.approx(np.full_like(result.t, settled), abs=1e-12)


def test_pid_without_limits_is_its_transfer_function() -> None:
    result = driven("{type: pid, of: u, kp: 2, ki: 3, kd: 0.5, n: 20}")
    exact = 2 + 3 * result.t + 0.5 * 20 * np.exp(-20 * result.t)
    assert result["y"] == pytest.approx(exact, rel=1e-8)


def test_pid_at_its_limit_has_an_integral_that_stays_near() -> None:
    """e = 1 for 2 s, then -1; with kp = ki = kb = 1 there is I' = e + (1.5 - (e + I)) at 1.5."""
    source = "{type: step, height: -2, at: 2, offset: 1}"
    held = driven("{type: pid, of: u, kp: 1, ki: 1, high: 1.5}", source)
    before, after = held.t < 2, held.t > 2
    # to t = 0.5 the integral is t; then I' = 1 + (1.5 - 1 - I), which begins at 0.5
    late = before & (held.t > 0.5)
    assert held["y"][late] == pytest.approx(np.full(late.sum(), 1.5))
    integral = 1.5 - np.exp(-1.5)
    assert held["y"][after] == pytest.approx(-1 + integral - (held.t[after] - 2), abs=1e-8)
    free = driven("{type: pid, of: u, kp: 1, ki: 1, high: 1.5, kb: 0}", source)
    assert free["y"][after] == pytest.approx(-1 + 2 - (free.t[after] - 2), abs=1e-8)


def test_an_integral_controller_leaves_its_limit_at_once() -> None:
    """e = 1 for 2 s, then -1: at the limit I' = e + n*(1 - I), so that I is 1 + 1/n at t = 2."""
    source = "{type: step, height: -2, at: 2, offset: 1}"
    result = driven("{type: pid, of: u, kp: 0, ki: 1, n: 100, low: 0, high: 1}", source)
    left = 2 + np.log(2) / 100  # there is (1 + 1/n) - 2/n*(1 - exp(-n*(t - 2))) = 1
    exact = np.where(result.t < left, np.minimum(result.t, 1), 1 - (result.t - left))
    assert result["y"] == pytest.approx(exact, abs=1e-8)


def test_pade_delay_is_its_transfer_function_and_delays_what_is_slow() -> None:
    block = "{type: pade_delay, of: u, delay: 0.5}"
    result = driven(block)
    p = 0.5
    exact = exact_step([-(p**3), 12 * p**2, -60 * p, 120], [p**3, 12 * p**2, 60 * p, 120], result.t)
    assert result["y"] == pytest.approx(exact, rel=1e-7, abs=1e-7)
    slow = driven(block, "{type: sine, amplitude: 1, omega: 2}")
    late = slow.t > 1.5
    exact = np.sin(2 * (slow.t[late] - 0.5))
    assert slow["y"][late] == pytest.approx(exact, abs=2e-3)
    settled = driven("{type: pade_delay, of: u, delay: 0.5, start: 1}")
    assert settled["y"] == pytest.approx(np.ones_like(settled.t), abs=1e-12)


def test_delay_and_variable_delay_give_what_was() -> None:
    for block in (
        "{type: delay, of: u, time: 0.5, before: 4}",
        "{type: variable_delay, of: u, time: half, shortest: 0.2, longest: 1, before: 4}\n"
        "  half: {type: constant, value: 0.5}",
    ):
        result = driven(block, "{type: sine, amplitude: 1, omega: 2}")
        exact = np.where(result.t < 0.5, 4, np.sin(2 * (result.t - 0.5)))
        assert result["y"] == pytest.approx(exact, abs=1e-7)
    moving = "{type: expression, formula: 0.4 + 0.3*sin(t)}"
    result = driven(
        "{type: variable_delay, of: u, time: lag, shortest: 0.3, longest: 0.6, past: u}"
        f"\n  lag: {moving}",
        "{type: expression, formula: cos(2*t)}",
    )
    lag = np.clip(0.4 + 0.3 * np.sin(result.t), 0.3, 0.6)
    assert result["y"] == pytest.approx(np.cos(2 * (result.t - lag)), abs=1e-7)
