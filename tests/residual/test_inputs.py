"""Inputs between their samples: smooth ones follow a spline, held ones jump, others are lines."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import chirp, sawtooth, square
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.residual import Measured, load_measured
from tracewire.residual.inputs import fit_spline, line_error, looks_held, spline_if_smooth
from tracewire.solve import Held, simulate, values_at, with_points

Vector = NDArray[np.float64]
T = np.arange(500) / 50.0
RNG = np.random.default_rng(3)


def wave(t: Vector) -> Vector:
    return np.asarray(1.5 * np.sin(9.0 * t + 0.3) + 0.2)


def moments(t: Vector, u: Vector, omega: float) -> complex:
    """The Fourier coefficient of a signal joined by straight lines, over whole waves."""
    fine = np.linspace(1.0, 1.0 + 12 * np.pi / omega, 40_001)
    values = np.interp(fine, t, u) * np.exp(-1j * omega * fine)
    return complex(2 * np.trapezoid(values, fine) / (fine[-1] - fine[0]))


def test_straight_lines_between_the_points_have_the_amplitude_of_the_sine() -> None:
    found = spline_if_smooth(T, wave(T))
    assert found is not None
    assert abs(moments(T, wave(T), 9.0)) == pytest.approx(1.5 * (1 - 0.18**2 / 12), rel=1e-4)
    assert abs(moments(*found, 9.0)) == pytest.approx(1.5, rel=1e-5)
    assert np.angle(moments(*found, 9.0) * 1j) == pytest.approx(0.3, abs=1e-5)


def test_the_points_are_few_where_samples_are_dense() -> None:
    dense = np.arange(5000) / 500.0
    found, coarse = spline_if_smooth(dense, wave(dense)), spline_if_smooth(T[::3], wave(T[::3]))
    assert found is not None and coarse is not None
    assert len(found[0]) == len(dense)
    assert 4 <= (len(coarse[0]) - 1) / (len(T[::3]) - 1) <= 8


SMOOTH: dict[str, Callable[[Vector], Vector]] = {
    "sine": wave,
    "tones": lambda t: np.asarray(np.sin(4 * t) + 0.5 * np.sin(11 * t + 1)),
    "sweep": lambda t: np.asarray(chirp(t, 0.2, 10.0, 3.0)),
    "bump": lambda t: np.exp(-((t - 5) ** 2)),
}


@pytest.mark.parametrize("irregular", [0.0, 0.006])
@pytest.mark.parametrize("name", SMOOTH)
def test_a_smooth_input_is_followed_between_its_samples(name: str, irregular: float) -> None:
    t = np.sort(T + RNG.uniform(-irregular, irregular, len(T)))
    found = spline_if_smooth(t, SMOOTH[name](t))
    assert found is not None and np.all(np.diff(found[0]) > 0)
    fine = np.linspace(t[5], t[-6], 20_000)
    off = np.interp(fine, *found) - SMOOTH[name](fine)
    assert np.max(np.abs(off)) < 4e-3
    # what is left goes up and down within an interval: its integral is much smaller
    summed = np.cumsum(off) * (fine[1] - fine[0])
    assert np.max(np.abs(summed)) < 2e-5


def test_a_declared_spline_goes_through_few_samples() -> None:
    t, u = np.arange(5.0), np.array([1.0, -1.0, 3.0, 0.0, 0.0])
    times, points = fit_spline(t, u)
    assert np.interp(t, times, points) == pytest.approx(u, abs=1e-3 * np.ptp(u))
    between = np.linspace(0, 4, 201)
    exact = CubicSpline(t, u)(between)
    assert np.interp(between, times, points) == pytest.approx(exact, abs=2e-3 * np.ptp(u))


def test_a_sine_with_little_noise_is_smooth() -> None:
    assert spline_if_smooth(T, wave(T) + 1e-4 * RNG.standard_normal(len(T))) is not None


@pytest.mark.parametrize(
    "u",
    [
        square(3 * T),
        sawtooth(3 * T, 0.5),
        np.where(T > 4, 1.0, 0.0),
        np.where(T > 4, wave(T), 0.0),
        0.3 * T,
        np.full(len(T), 2.0),
        RNG.standard_normal(len(T)),
        wave(T) + 0.02 * RNG.standard_normal(len(T)),
        np.round(wave(T), 1),
    ],
    ids=["square", "triangle", "step", "switched", "ramp", "constant", "noise", "noisy", "coarse"],
)
def test_jumps_corners_and_noise_stay_as_they_are(u: Vector) -> None:
    assert spline_if_smooth(T, np.asarray(u)) is None


def test_a_few_samples_stay_as_they_are() -> None:
    assert spline_if_smooth(T[:8], wave(T[:8])) is None


TEXT = """\
span: [0, 9.98]
inputs: {u: {unit: N m}}
blocks:
  theta: {type: integrator, of: omega, unit: rad}
  omega: {type: integrator, of: torque, unit: rad/s}
  spring: {type: gain, of: theta, k: -40}
  torque: {type: sum, of: [u, spring]}
measured:
  run: {file: run.csv, time: t, signals: {theta: theta}, inputs: {u: u}}
"""


@pytest.mark.parametrize("smooth", [True, False])
def test_a_series_has_its_smooth_input_as_a_spline_and_tells(tmp_path: Path, smooth: bool) -> None:
    u = wave(T) if smooth else np.asarray(square(3 * T))
    rows = np.stack([T, np.sin(T), u], axis=1)
    np.savetxt(tmp_path / "run.csv", rows, delimiter=",", header="t,theta,u", comments="")
    (tmp_path / "run.yaml").write_text(TEXT, encoding="utf-8")
    model = compile(read(tmp_path / "run.yaml"))
    (run,) = load_measured(model)
    how = "smooth: a cubic spline, in 999 points" if smooth else "joined by straight lines"
    assert [step for step in run.steps if step.startswith("input")] == [f"input 'u' is {how}"]
    if not smooth:
        assert np.array_equal(run.inputs["u"][1], u)
        return
    # forced oscillator: theta'' + 40 theta = u, from rest
    p, w = 40.0, 9.0
    a = 1.5 / (p - w**2)
    exact = a * np.sin(w * T + 0.3) + 0.2 / p
    exact -= (a * np.sin(0.3) + 0.2 / p) * np.cos(p**0.5 * T)
    exact -= a * w * np.cos(0.3) / p**0.5 * np.sin(p**0.5 * T)
    there = simulate(model, times=T, inputs=run.inputs, rtol=1e-9)["theta"]
    plain = simulate(model, times=T, inputs={"u": (T, u)}, rtol=1e-9)["theta"]
    assert np.max(np.abs(there - exact)) < 0.02 * np.max(np.abs(plain - exact))


DOUBLE = """\
span: [0, 2]
inputs: {u: {unit: N}}
parameters: {m: {value: 2, unit: kg}}
blocks:
  x: {type: integrator, of: v, unit: m}
  v: {type: integrator, of: force, unit: m/s}
  force: {type: gain, of: u, k: 1/m}
measured:
  run: {file: run.csv, time: t, signals: {x: x}, inputs: {u: {column: u, hold: previous}}}
"""
AT = np.array([0.0, 0.3, 0.4, 1.1, 1.5, 2.0])
U = np.array([1.0, -2.0, 0.5, 0.0, 3.0, 7.0])


def held_exactly(t: Vector, mass: float = 2.0) -> tuple[Vector, Vector]:
    """x and v of a mass from rest under the held drive."""
    x, v = np.zeros(len(t)), np.zeros(len(t))
    for k in range(len(AT) - 1):
        late = np.clip(t - AT[k], 0, None)
        during = np.clip(late, None, AT[k + 1] - AT[k])
        v += U[k] / mass * during
        x += U[k] / mass * (during**2 / 2 + during * (late - during))
    return x, v


def held_series(folder: Path, text: str = DOUBLE) -> Measured:
    rows = np.stack([AT, AT, U], axis=1)
    np.savetxt(folder / "run.csv", rows, delimiter=",", header="t,x,u", comments="")
    (folder / "run.yaml").write_text(text, encoding="utf-8")
    (run,) = load_measured(compile(read(folder / "run.yaml")))
    return run


def test_a_held_input_jumps_at_its_samples(tmp_path: Path) -> None:
    run = held_series(tmp_path)
    assert "input 'u' is held from sample to sample, as declared" in run.steps
    model = compile(read(tmp_path / "run.yaml"))
    t = np.linspace(0, 2, 57)
    found = simulate(model, times=t, inputs=run.inputs, sensitivities=["m"])
    x, v = held_exactly(t)
    assert found["x"] == pytest.approx(x, abs=1e-13)
    assert found["v"] == pytest.approx(v, abs=1e-13)
    # x goes with 1/m
    assert found.sensitivities["m"]["x"] == pytest.approx(-x / 2, abs=1e-12)
    lines = simulate(model, times=t, inputs={"u": (AT, U)})
    assert np.max(np.abs(lines["x"] - x)) > 0.1


def test_a_declared_hold_wins_over_what_the_record_looks_like(tmp_path: Path) -> None:
    rows = np.stack([T, np.sin(T), wave(T)], axis=1)
    np.savetxt(tmp_path / "run.csv", rows, delimiter=",", header="t,theta,u", comments="")
    for hold, how in {
        "linear": "joined by straight lines, as declared",
        "smooth": "smooth, as declared: a cubic spline, in 999 points",
        "previous": "held from sample to sample, as declared",
    }.items():
        text = TEXT.replace("{u: u}", f"{{u: {{column: u, hold: {hold}}}}}")
        (tmp_path / "run.yaml").write_text(text, encoding="utf-8")
        (run,) = load_measured(compile(read(tmp_path / "run.yaml")))
        assert f"input 'u' is {how}" in run.steps
        assert isinstance(run.inputs["u"], Held) == (hold == "previous")


def test_any_input_is_a_spline_where_that_is_declared(tmp_path: Path) -> None:
    run = held_series(tmp_path, DOUBLE.replace("previous", "smooth"))
    spline, fine = CubicSpline(AT, U), np.linspace(0, 2, 2000)
    off = np.interp(fine, *run.inputs["u"]) - spline(fine)
    lines = np.interp(fine, AT, U) - spline(fine)
    assert np.std(off) < 0.05 * np.std(lines)


@pytest.mark.parametrize("hold", ["", ", hold: linear"])
def test_an_input_that_looks_held_gets_a_remark_unless_declared(tmp_path: Path, hold: str) -> None:
    rows = np.stack([T, np.sin(T), np.asarray(square(3 * T))], axis=1)
    np.savetxt(tmp_path / "run.csv", rows, delimiter=",", header="t,theta,u", comments="")
    text = TEXT.replace("{u: u}", f"{{u: {{column: u{hold}}}}}")
    (tmp_path / "run.yaml").write_text(text, encoding="utf-8")
    (run,) = load_measured(compile(read(tmp_path / "run.yaml")))
    told = [remark for remark in run.remarks if "looks held" in remark]
    assert len(told) == (0 if hold else 1)
    assert hold or "say hold: previous" in told[0]


def test_coarse_readings_and_rest_do_not_look_held() -> None:
    assert looks_held(np.repeat(RNG.standard_normal(50), 10))
    assert not looks_held(np.round(wave(T), 2))
    assert not looks_held(np.where(T > 4, wave(T), 0.0))
    assert not looks_held(np.full(100, 3.0))
    winch = np.clip(np.abs(np.arange(200) % 100 - 50.0) - 30, 0, 4)  # it moves quickly, and rests
    assert not looks_held(winch)
    assert looks_held(np.round(winch / 4))


def test_a_held_input_at_other_times_and_points() -> None:
    held = Held(AT, U)
    t = np.array([-1.0, 0.0, 0.29, 0.3, 1.4, 2.0, 5.0])
    assert values_at(held, t).tolist() == [1.0, 1.0, 1.0, -2.0, 0.0, 7.0, 7.0]
    assert values_at((AT, U), t)[2] == pytest.approx(1 - 0.29 * 10)
    assert isinstance(with_points(held, AT + 1, U), Held)
    assert not isinstance(with_points((AT, U), AT + 1, U), Held)


@pytest.mark.parametrize("hold", ["", ", hold: smooth"])
def test_few_samples_a_period_get_a_remark_unless_declared(tmp_path: Path, hold: str) -> None:
    """Three samples a period: a spline through every second sample knows nothing of it."""
    rows = np.stack([T, np.sin(T), np.sin(2 * np.pi * T / (3 * 0.02))], axis=1)
    np.savetxt(tmp_path / "run.csv", rows, delimiter=",", header="t,theta,u", comments="")
    text = TEXT.replace("{u: u}", f"{{u: {{column: u{hold}}}}}")
    (tmp_path / "run.yaml").write_text(text, encoding="utf-8")
    (run,) = load_measured(compile(read(tmp_path / "run.yaml")))
    told = [remark for remark in run.remarks if "few samples a period" in remark]
    assert len(told) == (0 if hold else 1)
    assert hold or "lose 37 % of its amplitude; say hold: smooth" in told[0]


def test_lines_lose_what_a_sine_says_and_nothing_of_a_slow_or_a_rough_one() -> None:
    dt = T[1]
    for omega in (5.0, 20.0, 60.0):
        lost = line_error(T, np.sin(omega * T))
        assert lost == pytest.approx((omega * dt) ** 2 / 12, rel=0.02)
    noisy = np.sin(5.0 * T) + 0.03 * RNG.standard_normal(len(T))
    assert line_error(T, noisy) < 2e-3
    assert line_error(T**1.5, wave(T)) == 0.0
