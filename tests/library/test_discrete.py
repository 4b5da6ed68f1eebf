"""Discrete blocks against the recurrences that they are, sample by sample."""

from __future__ import annotations

import re

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import signal
from solve.models import made, run
from tracewire.errors import SimulationError
from tracewire.solve import Run, simulate

Vector = NDArray[np.float64]
T = 0.1


def sampled(blocks: str, every: float = T, end: float = 2.0, record: str = "y") -> Run:
    """A run of blocks that may read u(t) = sin(3t) + t and the sample time T."""
    return run(f"""
span: [0, {end}]
every: {every}
parameters: {{T: {T}}}
blocks:
  u: {{type: expression, formula: sin(3*t) + t}}
{blocks}
record: [{record}]
""")


def u_at(t: Vector) -> Vector:
    return np.asarray(np.sin(3 * t) + t)


def samples(count: int = 21) -> Vector:
    return u_at(T * np.arange(count))


def test_unit_delay_is_the_sample_before_and_holds_it() -> None:
    result = sampled("  y: {type: unit_delay, of: u, period: T, start: -7}", every=T / 4)
    k = np.floor(result.t / T + 1e-9).astype(int)
    exact = np.where(k > 0, u_at(T * (k - 1)), -7)
    assert result["y"] == pytest.approx(exact, abs=1e-12)


def test_unit_delays_in_a_row_add_up() -> None:
    chain = "".join(
        f"  d{n}: {{type: unit_delay, of: {f'd{n - 1}' if n else 'u'}, period: T}}\n"
        for n in range(4)
    )
    result = sampled(chain, record="d3")
    assert result["d3"] == pytest.approx(np.r_[np.zeros(4), samples()[:-4]], abs=1e-12)


def test_a_unit_delay_of_a_vector_is_one_of_each_element() -> None:
    blocks = "  v: {type: mux, of: [u, -u]}\n  y: {type: unit_delay, of: v, period: T}"
    result = sampled(blocks)
    exact = np.r_[0, samples()[:-1]]
    assert result["y[0]"] == pytest.approx(exact, abs=1e-12)
    assert result["y[1]"] == pytest.approx(-exact, abs=1e-12)


def test_ticks_do_not_drift() -> None:
    """After 100 000 periods of 0.1 ms the tick is where it belongs, to the last bits."""
    result = run("""
span: [9.99, 10]
every: 0.001
blocks:
  now: {type: time}
  y: {type: unit_delay, of: now, period: 1e-4}
record: [y]
""")
    assert result["y"][1:] == pytest.approx(result.t[1:] - 1e-4, abs=4e-15)


@pytest.mark.parametrize("weight", [0.0, 0.5, 1.0])
def test_discrete_integrator_is_euler_or_the_trapezoidal_rule(weight: float) -> None:
    result = sampled(
        f"  y: {{type: discrete_integrator, of: u, period: T, gain: 2, start: 3, weight: {weight}}}"
    )
    u, x, exact = samples(), 3.0, []
    for value in u:
        exact.append(x + 2 * T * weight * value)
        x += 2 * T * value
    assert result["y"] == pytest.approx(np.array(exact), abs=1e-12)


@pytest.mark.parametrize(
    ("numerator", "denominator"),
    [
        ([1.0], [1.0, -0.9]),
        ([1.0, 0.5], [1.0, -0.9]),
        ([0.2, 0.1, 0.3], [2.0, -1.0, 0.5]),
        ([1.0], [1.0, 0.0, 0.0, 0.0]),
        ([3.0, 1.0], [1.0, -1.2, 0.7, -0.1]),
    ],
)
def test_discrete_transfer_function_is_the_filter_of_scipy(
    numerator: list[float], denominator: list[float]
) -> None:
    result = sampled(
        "  y: {type: discrete_transfer_function, of: u, period: T,"
        f" numerator: {numerator}, denominator: {denominator}}}"
    )
    padded = [0.0] * (len(denominator) - len(numerator)) + numerator
    exact = signal.lfilter(padded, denominator, samples())
    assert result["y"] == pytest.approx(exact, rel=1e-12, abs=1e-12)


def test_discrete_state_space_is_that_of_scipy() -> None:
    blocks = """
  v: {type: mux, of: [u, -u]}
  y: {type: discrete_state_space, of: v, A: [[0, 1], [-0.5, 1]], B: [[1, 0], [0, 2]],
      C: [[1, 0], [1, 1]], D: [[0, 0], [0, 0.5]], period: T, start: [1, -1]}"""
    result = sampled(blocks)
    system = ([[0, 1], [-0.5, 1]], [[1, 0], [0, 2]], [[1, 0], [1, 1]], [[0, 0], [0, 0.5]], T)
    u = samples()
    _, exact, _ = signal.dlsim(system, np.stack([u, -u], axis=1), x0=[1, -1])
    for row in (0, 1):
        assert result[f"y[{row}]"] == pytest.approx(exact[:, row], rel=1e-12, abs=1e-12)


def pid(e: Vector, low: float, high: float) -> Vector:
    """The recurrence of the sampled controller with kp 2, ki 3, kd 0.1, n 20, kb 3/2."""
    kp, ki, kd, n, kb = 2.0, 3.0, 0.1, 20.0, 1.5
    integral = slope = before = 0.0
    found = []
    for value in e:
        slope = (slope + kd * n * (value - before)) / (1 + n * T)
        raw = kp * value + integral + slope
        found.append(min(max(raw, low), high))
        integral += T * (ki * value + kb * (found[-1] - raw))
        before = value
    return np.array(found)


@pytest.mark.parametrize(("low", "high"), [(-1e30, 1e30), (-1.0, 2.5)])
def test_discrete_pid_is_its_recurrence(low: float, high: float) -> None:
    result = sampled(
        "  y: {type: discrete_pid, of: u, kp: 2, ki: 3, kd: 0.1, n: 20, period: T,"
        f" low: {low}, high: {high}}}"
    )
    assert result["y"] == pytest.approx(pid(samples(), low, high), rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("period", ["T", "{value: 100, unit: ms}"])
def test_a_loop_of_sampled_blocks_and_a_flowing_plant_is_the_sampled_loop(period: str) -> None:
    """x' = y with y = kp*(r - x) held: x[k+1] = x[k] + T*y[k]; r passes a held filter first."""
    result = sampled(f"""
  r: {{type: zero_order_hold, of: u, period: {period}}}
  f: {{type: discrete_transfer_function, of: r, numerator: [0.5], denominator: [1, -0.5],
      period: {period}}}
  e: {{type: sum, of: [f, -x]}}
  y: {{type: discrete_pid, of: e, kp: 2, period: {period}}}
  x: {{type: integrator, of: y}}""")
    f = signal.lfilter([0.0, 0.5], [1.0, -0.5], samples())
    x, exact = 0.0, []
    for value in f:
        exact.append(2 * (value - x))
        x += T * exact[-1]
    assert result["y"] == pytest.approx(np.array(exact), rel=1e-9, abs=1e-9)


def test_a_slower_clock_samples_what_a_faster_one_holds() -> None:
    result = sampled("""
  fast: {type: zero_order_hold, of: u, period: 0.03}
  y: {type: discrete_integrator, of: fast, period: T, weight: 1}""")
    held = u_at(0.03 * np.floor(T * np.arange(21) / 0.03 + 1e-9))
    # where both tick, the sample is what was held just before
    both = np.arange(21) % 3 == 0
    held[both] = u_at(T * np.arange(21)[both] - 0.03)
    held[0] = 0.0
    assert result["y"] == pytest.approx(T * np.cumsum(held), abs=1e-9)


def test_clocks_of_one_value_cannot_be_taken_apart_in_a_run() -> None:
    model = made("""
span: [0, 1]
blocks:
  u: {type: time}
  a: {type: unit_delay, of: u, period: {value: 100, unit: ms}}
  b: {type: unit_delay, of: a, period: {value: 0.1, unit: s}}
record: [b]
""")
    simulate(model)
    told = "<text>:6:40: block 'b': the parameters do not meet 'b.period <= 0.1"
    with pytest.raises(SimulationError, match=re.escape(told)) as caught:
        simulate(model, parameters={"b.period": 0.2})
    assert "one parameter of the diagram" in str(caught.value)


def test_a_run_keeps_no_state_that_only_serves_a_clock() -> None:
    result = run("""
span: [0, 1]
blocks:
  u: {type: time}
  y: {type: unit_delay, of: u, period: 0.1}
""")
    assert [*result.signals] == ["y.y"]


def test_quantizer_rounds_to_the_nearest_level() -> None:
    result = sampled("  y: {type: quantizer, of: u, interval: 0.25}", every=0.037)
    exact = 0.25 * np.floor(u_at(result.t) / 0.25 + 0.5)
    assert result["y"] == pytest.approx(exact, abs=1e-12)
    levels = [event.time for event in result.events]
    assert u_at(np.array(levels)) / 0.25 % 1 == pytest.approx(np.full(len(levels), 0.5), abs=1e-6)
