"""Effects in runs: memory against an independent integration, sticking, harmonics of a drive."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import load_measured
from tracewire.solve import Run, simulate

Vector = NDArray[np.float64]
TIMES = np.linspace(0, 9, 181)
# the body swings with a growing amplitude, rests for two seconds at zero rate, and swings on
MOVES, RESTS = 4.0, 6.0
PRESCRIBED = """
span: [0, 9]
record: [b, q, v]
blocks:
  s: {{type: expression, formula: "t if t < 4 else (4 if t < 6 else t - 2)"}}
  on: {{type: expression, formula: "1 if t < 4 else (0 if t < 6 else 1)"}}
  q: {{type: expression, formula: "(0.5 + 0.1*s)*sin(3*s)"}}
  v: {{type: expression, formula: "on*((0.5 + 0.1*s)*3*cos(3*s) + 0.1*sin(3*s))"}}
  b: {{type: {block}}}
"""


def run(text: str, **options: object) -> Run:
    return simulate(compile(read_text(text)), rtol=1e-9, atol=1e-12, **options)  # type: ignore[arg-type]


def rate(t: float) -> float:
    if MOVES <= t < RESTS:
        return 0.0
    s = t if t < MOVES else t - (RESTS - MOVES)
    return (0.5 + 0.1 * s) * 3 * math.cos(3 * s) + 0.1 * math.sin(3 * s)


def integrated(slope: Callable[[float, float], float]) -> Vector:
    """z(t) at TIMES of z' = slope(v(t), z), z(0) = 0, with pieces that end where v may jump."""
    found, z = [0.0], 0.0
    for begin, end in ((0.0, MOVES), (MOVES, RESTS), (RESTS, 9.0)):
        inside = TIMES[(begin < TIMES) & (end >= TIMES)]
        clock = (begin, end)
        solution = solve_ivp(
            lambda t, y, clock=clock: [slope(rate(min(max(t, clock[0]), clock[1] - 1e-12)), y[0])],
            clock,
            [z],
            method="LSODA",
            t_eval=inside,
            rtol=1e-9,
            atol=1e-11,
            max_step=0.01,
        )
        found += solution.y[0].tolist()
        z = float(solution.y[0, -1])
    return np.array(found)


def dahl(v: float, z: float, s: float, n: float) -> float:
    """Dahl: dF/dx = sigma |1 - F/F_c sgn(v)|^n sgn(1 - F/F_c sgn(v)), dF/dt = dF/dx v."""
    left = 1 - z * np.sign(v)
    return float(v / s * abs(left) ** n * np.sign(left))


def bouc_wen(v: float, z: float, s: float, n: float, beta: float) -> float:
    """Bouc and Wen: z' = A v - beta |v| |z|^(n-1) z - gamma v |z|^n, over the deflection s."""
    return (v - beta * abs(v) * abs(z) ** (n - 1) * z - (1 - beta) * v * abs(z) ** n) / s


def lugre(v: float, z: float, s: float, peak: float, speed: float) -> float:
    """Canudas de Wit et al.: z' = v - sigma_0 |v| z/g(v), g = F_C + (F_S - F_C) exp(-(v/v_s)^2)."""
    return (v - abs(v) * z / (1 + peak * math.exp(-((v / speed) ** 2)))) / s


MEMORY: dict[str, Callable[[float, float], float]] = {
    "hysteresis, rate: v, level: 1, deflection: 0.1": lambda v, z: dahl(v, z, 0.1, 1),
    "dahl, rate: v, level: 1, deflection: 0.1": lambda v, z: dahl(v, z, 0.1, 1),
    "dahl, rate: v, level: 1, deflection: 0.3, exponent: 2": lambda v, z: dahl(v, z, 0.3, 2),
    "dahl, rate: v, level: 1, deflection: 0.9, exponent: 0.5": lambda v, z: dahl(v, z, 0.9, 0.5),
    "bouc_wen, rate: v, level: 1, deflection: 0.2": lambda v, z: bouc_wen(v, z, 0.2, 2, 0.5),
    "bouc_wen, rate: v, level: 1, deflection: 0.2, exponent: 3.5, beta: 0.8": lambda v, z: bouc_wen(
        v, z, 0.2, 3.5, 0.8
    ),
    "lugre, rate: v, level: 1, deflection: 0.05, peak: 0.5, speed: 0.3": lambda v, z: lugre(
        v, z, 0.05, 0.5, 0.3
    ),
}


@pytest.mark.parametrize("block", MEMORY)
def test_hysteresis_is_that_of_an_independent_integration(block: str) -> None:
    force = run(PRESCRIBED.format(block=block), times=TIMES)["b"]
    assert force == pytest.approx(-integrated(MEMORY[block]), abs=2e-5)


@pytest.mark.parametrize("block", MEMORY)
def test_hysteresis_stands_still_where_the_body_does_and_takes_energy_out(block: str) -> None:
    result = run(PRESCRIBED.format(block=block), times=TIMES)
    rests = (TIMES >= MOVES) & (TIMES < RESTS)
    assert np.ptp(result["b"][rests]) == pytest.approx(0, abs=1e-12)
    assert np.ptp(result["b"]) > 1
    assert np.trapezoid(result["b"] * result["v"], TIMES) < -2


def test_the_first_loading_of_hysteresis_is_an_exponential_of_the_way() -> None:
    """Dahl with exponent 1: F = F_c (1 - exp(-x/s)) while the body moves one way."""
    times = np.linspace(0, 0.5, 26)  # the first quarter of the swing
    result = run(
        PRESCRIBED.format(block="hysteresis, rate: v, level: 2, deflection: 0.15"), times=times
    )
    assert result["b"] == pytest.approx(-2 * (1 - np.exp(-result["q"] / 0.15)), abs=1e-7)


def test_bristles_slip_on_the_stribeck_curve_and_damp_while_they_bend() -> None:
    text = """
    span: [0, 8]
    record: [b, c]
    blocks:
      v: {type: constant, value: 0.2}
      b: {type: lugre, rate: v, level: 3, deflection: 0.05, peak: 0.5, speed: 0.25}
      c: {type: lugre, rate: v, level: 3, deflection: 0.05, peak: 0.5, speed: 0.25, damping: 0.1}
    """
    result = run(text, times=[0.0, 8.0])
    slipping = -3 * (1 + 0.5 * math.exp(-((0.2 / 0.25) ** 2)))
    assert result["b"] == pytest.approx([0, slipping], rel=1e-8)
    assert result["c"] == pytest.approx([-3 * 0.1 * 0.2 / 0.05, slipping], rel=1e-8)


def test_play_follows_behind_its_gap() -> None:
    """Against the play operator step by step: p = max(q - gap, min(q + gap, p))."""
    result = run(
        PRESCRIBED.format(block="play, of: q, rate: v, k: 2, gap: 0.2"),
        times=np.linspace(0, 9, 9001),
    )
    position, found = 0.0, []
    for q in result["q"]:
        position = max(q - 0.2, min(q + 0.2, position))
        found.append(position)
    assert result["b"] == pytest.approx(-2 * np.array(found), abs=1e-5)


def test_play_and_its_operator_are_the_same_where_both_start_in_the_middle() -> None:
    text = PRESCRIBED.format(block="play, of: q, rate: v, k: -1, gap: 0.2").replace("[b,", "[p, b,")
    result = run(text + "  p: {type: play_operator, of: q, rate: v, width: 0.4}\n", times=TIMES)
    assert result["b"] == pytest.approx(result["p"], abs=1e-8)


# sticking

BODY = """
span: [0, 30]
every: 0.1
record: [x, v, friction]
blocks:
  x: {{type: integrator, of: v, start: 1.05}}
  v: {{type: integrator, of: a, start: {rate}}}
  spring: {{type: stiffness, of: x, k: 1}}
  friction: {{type: {block}}}
  a: {{type: sum, of: [spring, friction]}}
"""


def body(block: str, rate: float = -1.0) -> str:
    return BODY.format(block=block, rate=rate)


DRY = {
    "coulomb": "coulomb, rate: v, level: 0.1",
    "stribeck": "stribeck, rate: v, level: 0.2, speed: 2",
    "disp_friction": "disp_friction, of: x, rate: v, slope: 1.2",
    "position_friction": "position_friction, of: x, rate: v, level: 0.3, pitch: 3",
    "friction_drift": "friction_drift, rate: v, level: 0.01",
}


@pytest.mark.parametrize("law", DRY)
def test_without_a_width_a_body_comes_to_rest_and_is_held_by_what_that_takes(law: str) -> None:
    result = run(body(DRY[law]))
    assert [event.kind for event in result.events][-1] == "stick"
    stuck = result.t > result.events[-1].time
    assert stuck.sum() > 20
    assert not result["v"][stuck].any()
    assert np.ptp(result["x"][stuck]) < 1e-13, "the rounding of rates inside of steps"
    assert result["friction"][stuck] == pytest.approx(result["x"][stuck], abs=1e-12)


def test_coulomb_without_a_width_is_dry_friction_of_one_level() -> None:
    one = run(body(DRY["coulomb"]))
    other = run(body("dry_friction, rate: v, slip: 0.1"))
    given = run(body(DRY["coulomb"] + ", width: {value: 0}"))
    for result in (other, given):
        assert result["x"] == pytest.approx(one["x"], abs=1e-12)
        assert [e.kind for e in result.events] == [e.kind for e in one.events]


@pytest.mark.parametrize("law", DRY)
def test_with_a_width_a_body_creeps(law: str) -> None:
    result = run(body(f"{DRY[law]}, width: 0.02"))
    assert "stick" not in [event.kind for event in result.events]
    assert result["v"][-40:].all()


def test_a_body_slips_alike_with_and_without_a_small_width() -> None:
    sharp, smooth = (
        run(body(f"{DRY['coulomb']}, width: {width}"), times=[1.0, 2.0, 3.0])["x"]
        for width in (0, 1e-4)
    )
    assert smooth == pytest.approx(sharp, abs=1e-4)


@pytest.mark.parametrize("law", DRY)
def test_the_width_has_a_derivative(law: str) -> None:
    text = body(f"{DRY[law]}, width: {{value: 0.3}}")
    times = np.linspace(0, 10, 21)
    name = "friction.width"
    exact = run(text, times=times, sensitivities=[name]).sensitivities[name]["x"]
    above, below = (run(text, times=times, parameters={name: w})["x"] for w in (0.3003, 0.2997))
    assert exact == pytest.approx((above - below) / 6e-4, abs=2e-5)
    assert np.abs(exact).max() > 1e-3
    at_zero = run(text, parameters={name: 0.0}, sensitivities=[name]).sensitivities[name]["x"]
    assert np.isfinite(at_zero).all()


# drives

DRIVE = """
span: [0, 40]
record: [b]
blocks:
  u: {{type: sine, amplitude: 1.7, omega: 2}}
  b: {{type: {block}}}
"""


def harmonics(block: str) -> NDArray[np.complex128]:
    """The complex amplitudes of the multiples 0, 1, 2, ... of the drive's frequency, late."""
    times = 40 - 4 * math.pi + np.arange(256) * 4 * math.pi / 256
    spectrum = np.fft.rfft(run(DRIVE.format(block=block), times=times)["b"]) / 128
    shift = np.exp(-1j * 2 * times[0] * np.arange(6))
    return np.asarray(spectrum[:24:4] * shift)


@pytest.mark.parametrize("phase", [0.0, 0.7])
@pytest.mark.parametrize(("block", "order"), [("drive_2nd_harm", 2), ("drive_3rd_harm", 3)])
def test_a_harmonic_is_a_share_of_its_drive(block: str, order: int, phase: float) -> None:
    found = harmonics(
        f"{block}, share: 0.2, size: 1.7, period: {math.pi}, start: 0.4, phase: {phase}"
    )
    expected = np.zeros(6, complex)
    expected[order] = 0.34 * np.exp(1j * (order * 0.4 + phase - math.pi / 2))
    assert found == pytest.approx(expected, abs=1e-9)


def test_a_lag_of_the_drive_is_the_filtered_drive_less_the_drive() -> None:
    found = harmonics("drive_lag, of: u, tau: 0.4")
    transfer = 1 / (1 + 0.4j * 2) - 1
    assert found[1] == pytest.approx(1.7 * transfer * np.exp(-1j * math.pi / 2), abs=1e-6)
    assert harmonics("drive_lag, of: u, tau: 0") == pytest.approx(np.zeros(6), abs=1e-15)


def test_what_is_missing_of_a_drive_is_in_proportion_to_it() -> None:
    assert harmonics("drive_gain, of: u, gain: -0.1")[1] == pytest.approx(0.17j, abs=1e-9)


def test_inertia_that_is_left_out_slows_an_oscillator_down() -> None:
    """(1 + m) x'' = -k x: the loop of the acceleration is solved."""
    text = body("inertia, of: a, m: 0.44", rate=0.0)
    result = run(text)
    assert result["x"] == pytest.approx(1.05 * np.cos(result.t / 1.2), abs=1e-6)


def test_a_drive_with_a_dead_time_is_the_drive_as_it_was() -> None:
    tau, omega = 0.08, 5.0
    text = f"""
        span: [0, 4]
        every: 0.01
        record: [seen]
        blocks:
          u: {{type: sine, amplitude: 1, omega: {omega}}}
          late: {{type: drive_delay, of: u, tau: {tau}}}
          seen: {{type: sum, of: [u, late]}}
        """
    found = run(text)
    exact = np.sin(omega * (found.t - tau))
    np.testing.assert_allclose(found.signals["seen"], exact, atol=1e-12)
    none = run(text.replace(f"tau: {tau}", "tau: 0"))
    np.testing.assert_allclose(none.signals["seen"], np.sin(omega * none.t), atol=1e-12)


def test_an_elastic_load_is_a_second_mass() -> None:
    m, period, damping = 0.3, 0.25, 0.1
    w = 2 * math.pi / period
    both = f"""
        span: [0, 3]
        every: 0.01
        record: [q]
        blocks:
          q: {{type: integrator, of: v, start: 0.5}}
          v: {{type: integrator, of: a}}
          spring: {{type: stiffness, of: q, k: 20}}
          a: {{type: sum, of: [spring, load]}}
          load: {{type: elastic_load, of: a, m: {m}, period: {period}, damping: {damping}}}
        """
    found = run(both)

    def rates(_: float, x: Vector) -> list[float]:
        q, v, there, rate = x.tolist()
        pull = m * (w**2 * (there - q) + 2 * damping * w * (rate - v))
        return [v, -20 * q + pull, rate, -pull / m]

    exact = solve_ivp(
        rates, (0, 3), [0.5, 0, 0.5, 0], t_eval=found.t, rtol=1e-10, atol=1e-12, max_step=0.01
    )
    np.testing.assert_allclose(found.signals["q"], exact.y[0], atol=1e-7)


def test_a_viscous_load_is_a_second_mass_behind_a_damper() -> None:
    c, lag, drag = 0.8, 0.5, 0.3
    found = run(
        f"""
        span: [0, 3]
        every: 0.01
        record: [v]
        blocks:
          v: {{type: integrator, of: a, start: 2}}
          drag: {{type: viscous, rate: v, c: {drag}}}
          a: {{type: sum, of: [drag, load]}}
          load: {{type: viscous_load, of: a, c: {c}, lag: {lag}}}
        """
    )
    both = np.array([[-drag - c, c], [1 / lag, -1 / lag]])  # rates of the body and of the mass
    exact = [(expm(both * t) @ [2, 2])[0] for t in found.t]
    np.testing.assert_allclose(found.signals["v"], exact, atol=1e-8)


def test_a_relaxing_spring_comes_to_the_force_of_its_damper_and_lets_go() -> None:
    k, lag, rate = 5.0, 0.4, 0.3
    found = run(
        f"""
        span: [0, 3]
        every: 0.01
        record: [pull]
        blocks:
          rate: {{type: step, offset: {rate}, height: -{rate}, at: 1}}
          pull: {{type: relaxing_spring, rate: rate, k: {k}, lag: {lag}}}
        """
    )
    moving = k * lag * rate * (1 - np.exp(-found.t / lag))
    last = k * lag * rate * (1 - math.exp(-1 / lag))
    exact = np.where(found.t <= 1, moving, last * np.exp(-(found.t - 1) / lag))
    np.testing.assert_allclose(found.signals["pull"], -exact, atol=1e-8)


def test_play_and_stop_of_a_coordinate_alone_are_those_of_its_way() -> None:
    gap = 0.2
    text = f"""
        span: [0, 9]
        every: 0.005
        record: [of, play, stop]
        blocks:
          of: {{type: expression, formula: "(0.5 + 0.1*t)*sin(3*t)"}}
          play: {{type: play_q, of: of, k: 2, gap: {gap}, lag: 1e-4}}
          stop: {{type: stop_q, of: of, level: 3, gap: {gap}, lag: 1e-4}}
        """
    found = run(text)
    at, ends = 0.0, []
    for x in found.signals["of"].tolist():
        at = min(max(at, x - gap), x + gap)
        ends.append(at)
    ends = np.array(ends)
    np.testing.assert_allclose(found.signals["play"], -2 * ends, atol=2e-3)
    stopped = -3 * (found.signals["of"] - ends) / gap
    np.testing.assert_allclose(found.signals["stop"], stopped, atol=2e-2)
    assert np.max(np.abs(found.signals["stop"])) == pytest.approx(3.0, abs=1e-2)


LATER = """
span: [0, 1]
record: [hum]
blocks:
  hum: {{type: harmonic, amplitude: 1, period: 2, phase: {{value: 0.3}}}}
measured:
  later:
    {{file: later.csv, time: {{column: t, zero: {zero}}}, signals: {{hum: {{column: y}}}}{more}}}
"""


@pytest.mark.parametrize(
    ("zero", "more", "same"),
    [
        (0, "", True),  # the time of one clock
        (1.5, "", False),  # a run that begins at 0 while the source goes on ...
        (1.5, ", parameters: {hum.phase: 0.3 + 1.5*pi}", True),  # ... has a phase of its own
    ],
)
def test_the_phase_of_a_harmonic_is_that_at_the_zero_of_a_series(
    tmp_path: Path, zero: float, more: str, same: bool
) -> None:
    clock = np.linspace(1.5, 3.5, 41)
    rows = "".join(f"{t},{np.sin(np.pi * t + 0.3)}\n" for t in clock)
    (tmp_path / "later.csv").write_text(f"t,y\n{rows}", encoding="utf-8")
    text = LATER.format(zero=zero, more=more)
    model = compile(read_text(text, tmp_path / "later.yaml"))
    (series,) = load_measured(model)
    found = simulate(model, **{**series.conditions, "times": series.t})["hum"]
    assert (found == pytest.approx(np.sin(np.pi * clock + 0.3), abs=1e-9)) == same
