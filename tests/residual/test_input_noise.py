"""What the noise of measured inputs does to signals: exact on integrators, and by trial."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from residual.models import made
from tracewire.compile import Model
from tracewire.fit import diagnose, fit
from tracewire.residual import Criterion, Measured, Sensor
from tracewire.residual.input_noise import InputCovariance, likely_input_noise, response_in_windows
from tracewire.residual.input_response import InputResponse, input_response, states_in_windows
from tracewire.residual.limits import INPUT
from tracewire.residual.segment import Segment
from tracewire.residual.unknowns import free_unknowns
from tracewire.solve import Driving, Held, simulate

Vector = NDArray[np.float64]
STEP, SIGMA = 0.1, 0.3
T = STEP * np.arange(41)
MASS = """\
span: [0, 4]
inputs: [u]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  a: {type: gain, of: u, k: 0.5}
  y: {type: sum, of: [v, a]}
"""
ONE = "span: [0, 4]\ninputs: [u]\nblocks: {x: {type: integrator, of: u}}\n"
CART = """\
span: [0, 20]
inputs: {F: {unit: N}}
parameters: {c: {value: 5, unit: N s/m, fit: [0, 50]}, level: {value: 0.8, unit: N, fit: [0, 10]}}
blocks:
  x: {type: integrator, of: v, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  viscous: {type: viscous, rate: v, c: c}
  coulomb: {type: coulomb, rate: v, level: level}
  force: {type: sum, of: [F, viscous, coulomb], unit: N}
  a: {type: gain, of: force, k: 1/1.2}
"""
TRUE = {"c": 4.0, "level": 1.2}
RNG = np.random.default_rng(9)
CART_T = 0.01 * np.arange(1001)
SENSOR_NOISE, FORCE_NOISE = 2e-5, 0.02


def series(signals: Sequence[str], driving: Driving, sigma: float = SIGMA) -> Measured:
    zeros = {name: np.zeros(len(T)) for name in signals}
    return Measured("run", "train", T, zeros, inputs={"u": driving}, input_sigma={"u": sigma})


def window_noise(response: InputResponse, sigma: Mapping[str, float], length: int) -> float:
    """What white noise of inputs makes of x in windows of so many samples with free starts."""
    count = len(response.transition)
    rows = [np.arange(first, min(first + length, count)) for first in range(0, count, length)]
    return response.noise(sigma, rows, response.states)["x"].size


def deviations(model: Model, measured: Measured) -> Vector:
    """The standard deviation of each signal at each sample, from a fixed start (N, m)."""
    states = np.zeros((len(T), len(model.states)))
    response = input_response(model, measured, states, {})
    made_of = response.impulses(measured.input_sigma, np.arange(len(T)))
    return np.asarray(np.sqrt(np.sum(made_of**2, axis=2)))


def test_a_held_input_with_noise_makes_a_random_walk() -> None:
    model = made(MASS, ("x", "v", "y"))
    found = deviations(model, series(("x", "v", "y"), Held(T, np.zeros(len(T)))))
    k = np.arange(len(T))
    push = 0.5 * SIGMA * STEP
    assert found[:, 1] == pytest.approx(push * np.sqrt(k), abs=1e-12)
    # each push moves x by dt/2 in its own interval, and by dt in every later one
    x = [push * STEP * np.sqrt(np.sum((np.arange(n) + 0.5) ** 2)) for n in k]
    assert found[:, 0] == pytest.approx(np.array(x), abs=1e-12)
    # y reads the input at its own sample, too, which v has not seen yet
    assert found[:, 2] == pytest.approx(np.hypot(found[:, 1], 0.5 * SIGMA), rel=1e-9)


def test_straight_lines_share_the_noise_of_a_sample_between_its_intervals() -> None:
    model = made(ONE)
    found = deviations(model, series(("x",), (T, np.sin(T))))[:, 0]
    k = np.arange(1, len(T))
    assert found[1:] == pytest.approx(SIGMA * STEP * np.sqrt(k - 0.5), rel=1e-6)


def test_a_fitted_start_takes_a_part_of_the_noise() -> None:
    model = made(ONE)
    measured = series(("x",), Held(T, np.zeros(len(T))))
    response = input_response(model, measured, np.zeros((len(T), 1)), {})
    rows = [np.arange(len(T))]
    fixed = response.noise(measured.input_sigma, rows, ())["x"]
    free = response.noise(measured.input_sigma, rows, ("x",))["x"]
    count = len(T)
    walk = SIGMA * STEP
    # of a random walk from 0: the mean of its squares, and of those about its mean
    assert fixed.size == pytest.approx(walk * ((count - 1) / 2) ** 0.5, rel=0.15)
    assert free.size == pytest.approx(walk * ((count**2 - 1) / (6 * count)) ** 0.5, rel=0.15)
    assert fixed.size < fixed.high < 4 * fixed.size


def test_the_gain_of_a_sensor_and_the_unit_of_an_input_scale_the_noise() -> None:
    model = made(ONE)
    measured = series(("x",), (T, np.sin(T)))
    response = response_in_windows(model, measured, {}, 10)
    plain = window_noise(response, {"u": SIGMA}, 10)
    louder = replace(measured, sensors={"x": Sensor(gain=-3.0)})
    there = response_in_windows(model, louder, {}, 10)
    assert window_noise(there, {"u": SIGMA}, 10) == pytest.approx(3 * plain)
    assert window_noise(response, {"u": 1.0}, 10) == pytest.approx(plain / SIGMA)


def cart(seed: int, sigma: float | None = FORCE_NOISE) -> Measured:
    """A series of the cart with Coulomb friction whose measured force has noise."""
    rng = np.random.default_rng(seed)
    tones = zip((3.0, 2.0, 1.5), (0.31, 0.83, 1.7), rng.uniform(0, 6, 3), strict=True)
    force = sum((a * np.sin(2 * np.pi * f * CART_T + p) for a, f, p in tones), np.zeros(1))
    model = made(CART, ("x",))
    run = simulate(model, parameters=TRUE, times=CART_T, inputs={"F": (CART_T, force)}, rtol=1e-9)
    return Measured(
        "run",
        "train",
        CART_T,
        {"x": run["x"] + SENSOR_NOISE * rng.standard_normal(len(CART_T))},
        {"x": SENSOR_NOISE},
        inputs={"F": (CART_T, force + FORCE_NOISE * rng.standard_normal(len(CART_T)))},
        input_sigma={} if sigma is None else {"F": sigma},
        start={"x": None, "v": None},
    )


def test_the_noise_of_a_force_with_friction_is_that_of_many_trials() -> None:
    model, measured = made(CART, ("x", "v")), cart(1)
    start = {"x": 0.0, "v": 0.1}
    t, force = measured.inputs["F"]
    rows = np.arange(60)

    def run(known: Vector) -> Vector:
        found = simulate(
            model, parameters=TRUE, start=start, times=t[rows], inputs={"F": (t, known)}, rtol=1e-9
        )
        return np.stack([found["x"], found["v"]], axis=1)

    base = run(force)
    states = np.concatenate((base, np.zeros((len(t) - len(rows), 2))))
    rng = np.random.default_rng(2)
    tried = [run(force + FORCE_NOISE * rng.standard_normal(len(t))) - base for _ in range(200)]
    spread = np.sqrt(np.mean(np.square(tried), axis=0))
    both = replace(measured, values={"x": measured.values["x"], "v": measured.values["x"]})
    response = input_response(model, both, states, TRUE)
    found = np.sqrt(np.sum(response.impulses(both.input_sigma, rows) ** 2, axis=2))
    near = np.abs(found - spread)[5:] <= 0.2 * spread[5:]
    assert np.mean(near) > 0.95  # all but where it just sticks


def test_states_in_windows_follow_the_data() -> None:
    model, measured = made(CART, ("x",)), cart(3)
    states = states_in_windows(model, measured, TRUE, 50)
    assert np.max(np.abs(states[:, 0] - measured.values["x"])) < 2e-3


@pytest.mark.parametrize("length", [20, 80, 300])
def test_residuals_whitened_by_the_noise_of_inputs_are_white(length: int) -> None:
    model, squares = made(CART, ("x",)), []
    for seed in range(4):
        measured = cart(seed)
        segments = [
            Segment(measured, float(CART_T[a]), np.arange(a, a + length),
                    dict(zip(model.states, state.tolist(), strict=True)), ())
            for a, state in _true_states(model, seed, length)
        ]  # fmt: skip
        whitening = InputCovariance({"x": SENSOR_NOISE}, model, [measured], 50).whitening
        sigma = {"x": SENSOR_NOISE}
        plain = Criterion(model, segments, [], TRUE, 1e-9, sigma, weighting="sum")
        white = Criterion(
            model, segments, [], TRUE, 1e-9, sigma, weighting="sum", whitening=whitening
        )
        residual = np.concatenate(white.residuals(np.zeros(0)))
        squares.append(np.mean(residual**2))
        lag = np.mean(residual[1:] * residual[:-1])
        assert abs(lag) < 4 / len(residual) ** 0.5
        if length > 20:
            assert np.mean(np.concatenate(plain.residuals(np.zeros(0))) ** 2) > 3
    assert np.mean(squares) == pytest.approx(1.0, abs=0.1)


def _true_states(model: Model, seed: int, length: int) -> list[tuple[int, Vector]]:
    measured = cart(seed)
    rng = np.random.default_rng(seed)
    tones = zip((3.0, 2.0, 1.5), (0.31, 0.83, 1.7), rng.uniform(0, 6, 3), strict=True)
    force = sum((a * np.sin(2 * np.pi * f * CART_T + p) for a, f, p in tones), np.zeros(1))
    found = simulate(
        made(CART, ("x", "v")),
        parameters=TRUE,
        times=measured.t,
        inputs={"F": (CART_T, force)},
        rtol=1e-9,
    )
    states = np.stack([found[name] for name in model.states], axis=1)
    return [(a, states[a]) for a in range(0, len(CART_T) - length, length)]


def test_derivatives_are_whitened_as_residuals_are() -> None:
    model, measured = made(CART, ("x",)), cart(5)
    segment = Segment(measured, 0.0, np.arange(1, 60), {"x": 0.0, "v": 0.2}, ("x", "v"))
    whitening = InputCovariance({"x": SENSOR_NOISE}, model, [measured], 50).whitening
    unknowns = free_unknowns(model, None, TRUE)
    criterion = Criterion(
        model, [segment], unknowns, {}, 1e-10, {"x": SENSOR_NOISE}, whitening=whitening
    )
    z = criterion.initial_unknowns()
    _, (slopes,) = criterion.residuals_and_jacobians(z)
    for column in range(len(z)):
        step = 1e-5 * np.eye(len(z))[column]
        (after,), (before,) = criterion.residuals(z + step), criterion.residuals(z - step)
        expected = (after - before).ravel() / 2e-5
        size = float(np.max(np.abs(expected)))
        assert slopes[:, column] == pytest.approx(expected, abs=2e-3 * size)


def test_a_window_of_another_series_or_without_noise_of_inputs_stays_as_it_is() -> None:
    model, measured = made(CART, ("x",)), cart(1, None)
    covariance = InputCovariance({"x": SENSOR_NOISE}, model, [measured], 50)
    assert covariance.whitening(Segment(measured, 0.0, np.arange(50))) is None


def test_a_window_of_which_the_middle_is_left_out_is_whitened_by_its_own_rows() -> None:
    """As where a block of time is left out of a run: it begins and ends where the whole does."""
    model, measured = made(CART, ("x",)), cart(1)
    covariance = InputCovariance({"x": SENSOR_NOISE}, model, [measured], 50)
    rows = np.arange(1, 60)
    whole = covariance.whitening(Segment(measured, 0.0, rows))
    kept = np.flatnonzero((rows < 20) | (rows > 40))
    part = covariance.whitening(Segment(measured, 0.0, rows[kept]))
    assert whole is not None and part is not None
    expected = np.linalg.inv(whole.T @ whole)[np.ix_(kept, kept)]
    assert np.linalg.inv(part.T @ part) == pytest.approx(expected, rel=1e-9)


def test_a_long_window_is_whitened_by_the_size_of_its_residuals_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    model, measured = made(CART, ("x",)), cart(1)
    segment = Segment(measured, 0.0, np.arange(1, 400))
    sizes = []
    for largest in (1500, 300):
        monkeypatch.setattr(INPUT, "largest", largest)
        covariance = InputCovariance({"x": SENSOR_NOISE}, model, [measured], 50)
        white = covariance.whitening(segment)
        assert white is not None
        sizes.append(1 / white if white.ndim == 1 else np.linalg.norm(np.linalg.inv(white), axis=1))
    full, alone = sizes
    assert full.shape == alone.shape == (399,)
    assert np.ptp(alone) == 0
    assert alone[0] == pytest.approx(full.mean(), rel=0.5)  # one size, of a noise that grows


def test_a_longer_window_has_more_of_the_noise() -> None:
    model, measured = made(CART, ("x",)), cart(1)
    response = response_in_windows(model, measured, TRUE, 50)
    sizes = [window_noise(response, measured.input_sigma, n) for n in (10, 50, 250)]
    assert sizes[0] * 5 < sizes[1] and sizes[1] * 3 < sizes[2]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_fit_of_the_true_diagram_is_at_the_noise_of_the_input(seed: int) -> None:
    measured = cart(seed)
    found = fit(made(CART, ("x",)), [measured], method="least_squares")
    (one,) = diagnose(found)
    assert one.driven is not None and one.driven.size > 5 * SENSOR_NOISE
    assert one.words.startswith("at the noise of the measured input 'F', which explains it. ")
    assert "Something is missing" not in one.words and "depends on" not in one.words
    # the same record, and nothing said of the force
    unsaid = replace(found, measured=(replace(measured, input_sigma={}),))
    assert "Something is missing" in diagnose(unsaid)[0].words


def test_a_fit_that_lacks_friction_is_not_explained_by_the_noise_of_the_input() -> None:
    model = made(CART, ("x",))
    found = fit(
        model, [cart(1)], method="least_squares", fixed=["level"], parameters={"level": 0.0}
    )
    (one,) = diagnose(found)
    assert "the declared noise of sensor and inputs" in one.words
    assert "Something is missing" in one.words


def test_the_likely_noise_of_an_input_is_its_own_and_leaves_nothing() -> None:
    model, sigma, length, found = made(CART, ("x",)), {"x": SENSOR_NOISE}, 100, []
    for seed in range(10, 14):
        measured = cart(seed, None)
        segments = [
            Segment(
                measured, float(CART_T[a]), np.arange(a + 1, a + length),
                dict(zip(model.states, state.tolist(), strict=True)), ("x", "v"),
            )
            for a, state in _true_states(model, seed, length)
        ]  # fmt: skip
        criterion = Criterion(model, segments, [], TRUE, 1e-9, sigma, weighting="sum")
        near = criterion.linearise({}, {n: s.start for n, s in enumerate(segments)})
        windows = [(s, near[n].residual, near[n].slopes) for n, s in enumerate(segments)]
        response = response_in_windows(model, measured, TRUE, 50)
        found.append(likely_input_noise(response, "F", sigma, windows))
    assert np.mean([one.sigma for one in found]) == pytest.approx(FORCE_NOISE, rel=0.12)
    assert np.mean([one.after for one in found]) == pytest.approx(1.0, abs=0.08)
    assert min(one.before for one in found) > 5
    assert min(one.evenness for one in found) > 0.6
    # a residual that no input makes: 30 times the noise, from sample to sample
    white = [(s, 30 * RNG.standard_normal(r.shape), slopes) for s, r, slopes in windows]
    assert likely_input_noise(response, "F", sigma, white).after > 5
    # what a slow force makes has the size of some noise, and is not white
    slow = []
    for segment, residual, slopes in windows:
        rows = np.arange(int(segment.rows[0]) - 1, int(segment.rows[-1]) + 1)
        answers = response.impulses({"F": 0.05}, rows)[1:] / SENSOR_NOISE
        pull = answers @ np.sin(0.05 * np.arange(answers.shape[-1]) + RNG.uniform(0, 6))
        slow.append((segment, pull + RNG.standard_normal(residual.shape), slopes))
    one = likely_input_noise(response, "F", sigma, slow)
    assert one.after < 2
    assert one.evenness < 0.3


def test_a_model_without_states_has_the_noise_of_its_input_as_it_is() -> None:
    model = made("span: [0, 4]\ninputs: [u]\nblocks: {y: {type: gain, of: u, k: 3}}\n", ["y"])
    measured = series(["y"], (T, np.sin(T)), 0.2)
    covariance = InputCovariance({"y": SIGMA}, model, [measured], 10)
    white = covariance.whitening(Segment(measured, 0.0, np.arange(10)))
    expected = 1 / np.sqrt(1 + (3 * 0.2 / SIGMA) ** 2)
    np.testing.assert_allclose(white, expected * np.eye(10), atol=1e-9)
