"""Paper C, the linear systems of C01 to C18: exact laws, verdicts, growth rates."""

from __future__ import annotations

from math import exp, pi, sqrt

import numpy as np
import pytest
from oracles.c_0_hill import hill_trace, meissner_trace
from oracles.c_common import Array
from papers.test_c_01_18 import model_of, run_of
from scipy.special import mathieu_a, mathieu_b, mathieu_cem, mathieu_sem
from tracewire.solve import simulate


def period_map(
    diagram: str,
    coordinate: str,
    period: float,
    preset: str = "",
    **parameters: float,
) -> Array:
    """The states after a period of two runs of the diagram from unit starts, as columns (2, 2)."""
    states = coordinate, f"{coordinate}_dot"
    ends = []
    for unit in ((1.0, 0.0), (0.0, 1.0)):
        run = simulate(
            model_of(diagram),
            preset=preset,
            parameters=parameters,
            start=dict(zip(states, unit, strict=True)),
            span=(0, period),
            rtol=1e-11,
        )
        ends.append([run.final[state] for state in states])
    return np.array(ends).T


def multipliers(diagram: str, coordinate: str, period: float, *args: str, **kw: float) -> Array:
    """The eigenvalues of the map over a period, the one of largest modulus first."""
    found = np.linalg.eigvals(period_map(diagram, coordinate, period, *args, **kw))
    return found[np.argsort(-np.abs(found))]


def growth(diagram: str, coordinate: str, period: float, *args: str, **kw: float) -> float:
    """The growth rate of the solution that grows most, 1/s."""
    largest = multipliers(diagram, coordinate, period, *args, **kw)[0]
    return float(np.log(abs(largest)) / period)


# C01


@pytest.mark.parametrize("b0", [0.1, 0.3])
def test_c01_shrinks_areas_as_liouville_says(b0: float) -> None:
    area = np.linalg.det(period_map("c01_damped_hill", "x", 2 * pi, b0=b0))
    assert area == pytest.approx(exp(-2 * pi * b0), rel=1e-8)


# C02 and C03: Mathieu's a_n(q) and b_n(q) bound the tongues; scipy has them


def trace_of_mathieu(a: float, beta: float) -> float:
    return float(np.trace(period_map("c02_mathieu", "u", 2 * pi, a=a, beta=beta)))


@pytest.mark.parametrize("beta", [0.1, 0.4])
@pytest.mark.parametrize("n", [1, 2])
def test_c02_the_edges_of_the_tongues_are_those_of_mathieu(n: int, beta: float) -> None:
    for edge in (mathieu_a(n, 2 * beta) / 4, mathieu_b(n, 2 * beta) / 4):
        assert trace_of_mathieu(edge, beta) == pytest.approx(2 * (-1) ** n, abs=1e-7)


@pytest.mark.parametrize(
    ("a", "beta", "stable"),
    [
        (0.198, 0.1, True),
        (0.199, 0.1, False),
        (0.298, 0.1, False),
        (0.299, 0.1, True),
        (0.998, 0.1, True),
        (1.002, 0.1, False),
        (1.005, 0.1, True),
        (0.5, 0.1, True),
        (0.5, 0.8, False),
    ],
)
def test_c02_is_stable_between_the_tongues_only(a: float, beta: float, stable: bool) -> None:
    assert (abs(trace_of_mathieu(a, beta)) < 2) is stable


def test_c02_grows_by_its_multiplier_each_period() -> None:
    largest = multipliers("c02_mathieu", "u", 2 * pi, "C02u")[0]
    times = 2 * pi * np.arange(10, 15)
    run = simulate(model_of("c02_mathieu"), preset="C02u", times=times, rtol=1e-10)
    assert run["u"][1:] / run["u"][:-1] == pytest.approx([largest.real] * 4, rel=1e-3)
    assert np.log(abs(largest)) / (2 * pi) == pytest.approx(0.05, rel=0.01)  # beta/(4 sqrt a)
    stable = run_of("C02s", "C02s")
    assert np.max(np.abs(stable["u"])) < 1.5


def test_c03_has_the_characteristic_exponent_of_hills_method() -> None:
    trace = np.trace(period_map("c03_canonical_mathieu", "y", pi))
    assert trace == pytest.approx(hill_trace(2, [-0.4]), abs=1e-8)


@pytest.mark.parametrize("n", [1, 2, 3])
def test_c03_follows_the_mathieu_functions(n: int) -> None:
    q, t = 0.2, np.linspace(0, 3 * pi, 61)
    even, _ = mathieu_cem(n, q, np.degrees(t))
    odd, slope = mathieu_sem(n, q, np.degrees(t))
    model = model_of("c03_canonical_mathieu")
    for a, function, rate in ((mathieu_a(n, q), even, 0.0), (mathieu_b(n, q), odd, slope[0])):
        start = {"y": function[0], "y_dot": rate}
        run = simulate(model, parameters={"a": float(a)}, start=start, times=t, rtol=1e-10)
        assert run["y"] == pytest.approx(function, abs=1e-6)


# C04


def test_c04_starts_on_its_periodic_state() -> None:
    run = simulate(
        model_of("c04_driven_parametric"), times=[0, pi, 9 * pi], span=(0, 9 * pi), rtol=1e-10
    )
    assert run["x"] == pytest.approx(run.start["x"], abs=1e-8)
    assert run["x_dot"] == pytest.approx(run.start["x_dot"], abs=1e-8)


@pytest.mark.parametrize("h0", [0.0, 0.2, 0.3])
def test_c04_has_the_amplitude_of_the_first_harmonic_with_its_sign_corrected(h0: float) -> None:
    model, T = model_of("c04_driven_parametric"), pi
    rest = {"x": 0.0, "x_dot": 0.0}
    from_rest = simulate(model, parameters={"h0": h0}, start=rest, span=(0, T), rtol=1e-11)
    free = period_map("c04_driven_parametric", "x", T, h0=h0, E0=0.0)
    driven = [from_rest.final["x"], from_rest.final["x_dot"]]
    x, x_dot = np.linalg.solve(np.eye(2) - free, driven)
    t = np.linspace(0, T, 401)
    start = {"x": x, "x_dot": x_dot}
    run = simulate(model, parameters={"h0": h0}, start=start, times=t, rtol=1e-10)
    harmonic = 2 * np.mean((run["x"] * np.cos(2 * t))[:-1])
    assert harmonic == pytest.approx(-2 * 0.5 / (4 * (0.4 - h0)), rel=5e-3)
    assert run["balanced"][0] == pytest.approx(-2 * 0.5 / (4 * (0.4 - h0)))


def test_c04_grows_without_drive_above_a_threshold_close_to_twice_the_damping() -> None:
    def rate(h0: float) -> float:
        return growth("c04_driven_parametric", "x", pi / 2, h0=h0, E0=0.0)

    assert rate(0.4005) < 0 < rate(0.4012)
    assert rate(0.5) == pytest.approx(2 / 4 * (0.5 - 0.4), rel=0.05)  # w0 (h0 - 2 b0)/4


# C05 and C06


@pytest.mark.parametrize(("preset", "c0", "stable"), [("C05s", 1.6, True), ("C05u", 1.2, False)])
def test_c05_is_stable_and_unstable_as_hills_method_says(
    preset: str, c0: float, stable: bool
) -> None:
    trace = np.trace(period_map("c05_hill_two_harmonics", "y", pi, preset))
    assert trace == pytest.approx(hill_trace(c0, [0.5, 0.2]), abs=1e-8)
    assert bool(abs(trace) < 2) is stable


@pytest.mark.parametrize(
    ("preset", "r", "omega", "stable"),
    [("C06u", 0.5, 2.0, False), ("C06s", 0.2, 1.8, True), ("C06neg", 1.5, 6.0, True)],
)
def test_c06_has_the_trace_of_the_closed_form(
    preset: str, r: float, omega: float, stable: bool
) -> None:
    trace = np.trace(period_map("c06_meissner", "y", 2 * pi / omega, preset))
    assert trace == pytest.approx(meissner_trace(r, omega), abs=1e-8)
    assert bool(abs(trace) < 2) is stable


# C08


@pytest.mark.parametrize(
    ("preset", "grows"), [("C08h", True), ("C08hs", False), ("C08i", False), ("C08iu", True)]
)
def test_c08_grows_or_decays_as_it_is_said_to(preset: str, grows: bool) -> None:
    rate = growth("c08_mathieu_pendulum", "phi", 2 * pi, preset)
    assert (rate > 0) is grows
    run = run_of("C08h", preset)
    assert bool(np.max(np.abs(run["phi"][-200:])) > 0.2) is grows


def test_c08_thresholds_of_pumping_and_of_standing_upright() -> None:
    def hanging(delta: float) -> float:
        return growth("c08_mathieu_pendulum", "phi", 2 * pi, delta=delta)

    def upright(alpha: float) -> float:
        return growth("c08_mathieu_pendulum", "phi", 2 * pi, "C08i", alpha=alpha, b=0.0)

    assert hanging(0.0198) < 0 < hanging(0.0202)  # delta = b
    edge = -float(mathieu_a(0, 0.4)) / 4  # about delta^2/2
    assert edge == pytest.approx(0.02, rel=0.05)
    assert upright(edge - 1e-5) < 1e-6 < upright(edge + 1e-5)


# C10, C11, C14, C15


def test_c10_grows_a_little_more_slowly_than_c09() -> None:
    hill = growth("c09_variable_length_hill", "u", 2 * pi)
    truncated = growth("c10_mathieu_truncation", "u", 2 * pi)
    assert 0.95 * hill < truncated < 0.99 * hill


def test_c09_its_two_lines_have_the_same_multipliers() -> None:
    arc = multipliers("c09_variable_length_hill", "u", 2 * pi)
    angle = multipliers("c09_variable_length_hill", "phi", 2 * pi)
    assert arc == pytest.approx(angle, rel=1e-8)


@pytest.mark.parametrize(("preset", "h", "b"), [("C11u", 0.1, 0.05), ("C11s", 0.02, 0.1)])
def test_c11_grows_close_to_the_formula_of_first_order(preset: str, h: float, b: float) -> None:
    w0 = sqrt(9.81)
    rate = growth("c11_laboratory_oscillator", "phi", pi / w0, preset)
    assert rate == pytest.approx(3 * h * w0 / 4 - b, rel=6e-3)
    assert (rate > 0) is (preset == "C11u")


def test_c14_grows_though_its_perturbation_has_no_mean() -> None:
    assert growth("c14_hill_zero_mean", "x", pi / 2) == pytest.approx(0.2 * 2 / 4, rel=2e-3)


def test_c15_is_unstable_and_grows_from_burst_to_burst() -> None:
    largest, other = multipliers("c15_unstable_hill", "x", 2 * pi / 5)
    assert largest.real == pytest.approx(-1.57336, abs=1e-5) and largest.imag == 0
    assert largest * other == pytest.approx(1, rel=1e-7)
    times = 2 * pi / 5 * np.arange(5, 8)
    run = simulate(model_of("c15_unstable_hill"), times=times, rtol=1e-10)
    size = np.hypot(20 * run["x"], run["x_dot"])
    assert size[1:] / size[:-1] == pytest.approx([-largest.real] * 2, rel=0.05)


# C16


@pytest.mark.parametrize(
    ("preset", "beta", "frequency", "part"),
    [("C16a", 10, 1.98746, 0.05), ("C16b", 50, 3.16070, 0.006), ("C16b_fig9", 50, 1.99750, 0.4)],
)
def test_c16_decays_at_gamma_and_is_as_slow_as_eq_23_says_but_for_fig_9(
    preset: str, beta: float, frequency: float, part: float
) -> None:
    found = multipliers("c16_fast_excitation", "x", 2 * pi / beta, preset)
    rates = np.log(np.abs(found)) * beta / (2 * pi)
    assert rates == pytest.approx([-0.1, -0.1], abs=1e-8)
    slow = np.abs(np.angle(found[0])) * beta / (2 * pi)
    run = run_of("C16a", preset)
    assert run.parameters["omega"] == pytest.approx(frequency, abs=1e-5)
    assert 0.8 * part < abs(1 - frequency / slow) < part


def test_c16_the_curve_of_eq_23_lies_on_the_solution_but_for_fig_9() -> None:
    def apart(preset: str) -> float:
        run = run_of("C16b", preset)
        return float(np.std(run["analytic"] - run["x"]) / np.std(run["x"]))

    assert apart("C16b") < 0.12
    assert apart("C16b_fig9") > 1.4


# C18


def test_c18lin_stands_exactly_between_the_edges_of_mathieu() -> None:
    """A cosine of twice the time has -4/w^2 for a and 2A for q."""

    def trace(A: float) -> float:
        return float(np.trace(period_map("c18_inverted_linear", "phi", pi / 10, A=A, w=20.0)))

    assert abs(trace(0.1)) < 2
    assert trace(0.0707) > 2 > trace(0.0709)
    assert trace(0.458) > -2 > trace(0.459)
    for A in (0.08, 0.2, 0.4):
        w = 2 / sqrt(-float(mathieu_a(0, 2 * A)))
        edge = period_map("c18_inverted_linear", "phi", 2 * pi / w, A=A, w=w)
        assert np.trace(edge) == pytest.approx(2, abs=1e-7)
