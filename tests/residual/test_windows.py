"""Windows with free starts: fits of them, against dense least squares and exact solutions."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from oracles.oscillator import DIAGRAM, NOISE, exact, model_of, problem_of, record, trial_of
from scipy.optimize import least_squares
from tracewire.compile import Model, compile
from tracewire.diagram import read_text
from tracewire.residual import Criterion, Measured, Segment
from tracewire.residual.initial_states import fit_initial_states
from tracewire.residual.levenberg_marquardt import fit_windows
from tracewire.residual.windows import (
    Section,
    Windows,
    cut_windows,
    evaluate_windows,
    project_out_initial_states,
    with_memory,
)
from tracewire.solve import simulate

BALL = """\
span: [0, 2]
parameters: {stiff: 1e6}
blocks:
  x: {type: integrator, of: v, start: 0.2}
  v: {type: integrator, of: force}
  weight: {type: constant, value: -9.81}
  ground: {type: expression, formula: "stiff*max(-x, 0)"}
  force: {type: sum, of: [weight, ground]}
"""


def test_windows_tile_a_section_and_begin_at_the_last_sample_before() -> None:
    m = record()
    windows = cut_windows(model_of(), Section(m, 100, 300), 45, ("x", "v"))
    rows = np.concatenate([window.rows for window in windows])
    np.testing.assert_array_equal(rows, np.arange(100, 300))
    assert [window.begin for window in windows] == [m.t[w.rows[0] - 1] for w in windows]
    assert {len(window.rows) for window in windows} == {50}
    assert all(window.free == ("x", "v") for window in windows)


def test_no_window_goes_over_a_gap_that_is_longer_than_a_window() -> None:
    whole = record()
    kept = np.r_[0:110, 300:315, 317:400]  # 5.7 s are lost, and 0.06 s
    m = replace(whole, t=whole.t[kept], values={"x": whole.values["x"][kept]})
    windows = cut_windows(model_of(), Section(m, 0, len(kept)), 40, ("x", "v"))
    np.testing.assert_array_equal(np.concatenate([w.rows for w in windows]), np.arange(len(kept)))
    assert max(w.t[-1] - w.begin for w in windows) < 2 * 40 * 0.03
    (behind,) = (w for w in windows if w.rows[0] == 110)
    assert behind.begin == m.t[110] and behind.free == ("x", "v")
    follow = [later.continues(before) for before, later in pairwise(windows)]
    assert follow == [later is not behind for later in windows[1:]]


def test_a_section_that_is_one_window_goes_over_its_gaps() -> None:
    whole = record()
    kept = np.r_[0:110, 300:400]
    m = replace(whole, t=whole.t[kept], values={"x": whole.values["x"][kept]})
    (window,) = cut_windows(model_of(), Section(m, 0, 210), 210, ("x", "v"))
    assert len(window.rows) == 210
    assert window.time_in_samples == 399


def test_the_first_window_begins_as_the_series_says() -> None:
    m = Measured("drop", "train", *_drop(), start={"x": 1.0, "v": None})
    first, second = cut_windows(model_of(), Section(m, 0, 100), 50, ("x", "v"))
    assert first.begin == m.t[0] and first.free == ("v",) and first.start["x"] == 1.0
    assert second.free == ("x", "v")


def _drop() -> tuple[np.ndarray, dict[str, np.ndarray]]:
    t = np.arange(0, 3, 0.03)
    return t, {"x": exact(t, 25.0, 0.2, (1.0, 0.0))}


def test_the_starts_eliminated_the_fit_is_that_of_all_numbers_at_once() -> None:
    m = record(noise=5e-3, end=5.0)
    problem = problem_of(m, sigma=5e-3)
    trial = trial_of(problem, length=50)
    segments = trial.windows.segments

    def residual(z: np.ndarray) -> np.ndarray:
        parts = []
        for n, segment in enumerate(segments):
            times = (
                np.concatenate(([segment.begin], segment.t))
                if segment.begin < segment.t[0]
                else segment.t
            )
            x = exact(times, z[0], z[1], z[2 + 2 * n : 4 + 2 * n])[-len(segment.t) :]
            parts.append((x - m.values["x"][segment.rows]) / 5e-3)
        return np.concatenate(parts)

    starts = [segment.start[name] for segment in segments for name in ("x", "v")]
    dense = least_squares(residual, [24.0, 0.25, *starts], x_scale="jac", xtol=1e-12, ftol=1e-12)
    assert trial.converged
    assert trial.rss == pytest.approx(2 * dense.cost, rel=1e-3)
    # a fit ends where less than a twentieth of the noise's variance is to gain
    errors = np.sqrt(np.diag(np.linalg.inv(dense.jac.T @ dense.jac)))
    assert abs(trial.values["k"] - dense.x[0]) < 0.25 * errors[0]
    assert abs(trial.values["c"] - dense.x[1]) < 0.25 * errors[1]


def test_what_is_left_without_the_starts_is_the_dense_least_squares() -> None:
    windows = trial_of(problem_of(record()), length=80).windows
    reduced, residual = project_out_initial_states(windows)
    blocks = [near.slopes for near in windows.linearisations]
    starts = np.zeros((len(residual), sum(b.shape[1] - 2 for b in blocks)))
    row = column = 0
    for block in blocks:
        height, width = len(block), block.shape[1] - 2
        starts[row : row + height, column : column + width] = block[:, 2:]
        row, column = row + height, column + width
    moved = np.concatenate([block[:, :2] for block in blocks])
    full = np.column_stack((moved, starts))
    flat = np.concatenate([near.residual.ravel() for near in windows.linearisations])
    expected = np.linalg.lstsq(full / np.linalg.norm(full, axis=0), -flat)[0]
    expected = (expected / np.linalg.norm(full, axis=0))[:2]
    found = np.linalg.lstsq(reduced, -residual)[0]
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-9)


def test_the_answer_of_a_start_takes_away_what_a_start_can_explain() -> None:
    windows = trial_of(problem_of(record()), length=80).windows
    view = windows.linearisations[1].projection
    slopes = windows.linearisations[1].slopes[:, 2:]
    np.testing.assert_allclose([view.start_of(column) for column in slopes.T], np.eye(2), atol=1e-8)
    np.testing.assert_allclose(
        view.project_out(slopes) / np.linalg.norm(slopes, axis=0), 0, atol=1e-9
    )


def test_an_unknown_ends_at_its_bound_where_it_wants_to_pass_it() -> None:
    grows = record(lambda x, v: 0.3 * v, end=4.0)  # its damping is -0.1, which c must not be
    trial = trial_of(problem_of(grows))
    assert trial.values["c"] == pytest.approx(0.0, abs=1e-9)
    text = DIAGRAM.replace("fit: [5, 80]", "fit: [5, 24]")
    trial = trial_of(problem_of(record(), text=text))
    assert trial.values["k"] == pytest.approx(24.0, abs=1e-6)


def test_settling_moves_starts_and_no_unknown() -> None:
    m = record()
    problem = problem_of(m)
    trial = trial_of(problem, length=60)
    criterion = problem.criterion_on(
        trial, cut_windows(problem.declared, Section(m, 90, 270), 90, problem.states)
    )
    begun = evaluate_windows(criterion)
    done = fit_initial_states(begun)
    assert done.values == begun.values
    assert done.rss < begun.rss
    assert done.rss == pytest.approx(180, rel=0.3), "at the noise"


def test_a_start_inside_a_stiff_barrier_is_rescued_by_the_window_before() -> None:
    """A ball that bounces on a stiff spring: a start 1 cm inside it is thrown off the record."""
    model = compile(read_text(BALL), record=["x"])
    t = np.arange(0.0, 2.0, 0.008)
    fall = (2 * 0.2 / 9.81) ** 0.5
    # a contact lasts pi/sqrt(1e6) = 3 ms; the flight between two of them 2*fall
    since = np.mod(t + fall, 2 * fall + np.pi / 1e3) - fall
    x = np.maximum(0.2 - 9.81 / 2 * np.clip(since, -fall, fall) ** 2, 0.0)
    m = Measured("ball", "train", t, {"x": x}, start={"x": None, "v": None})
    before, there = cut_windows(model, Section(m, 1, 161), 80, ("x", "v"))
    inside = Segment(m, there.begin, there.rows, {"x": -0.01, "v": 0.0}, ("x", "v"))

    def fitted(*segments: Segment) -> np.ndarray:
        criterion = Criterion(model, segments, [], {}, 1e-8, {"x": 2e-3}, chained=True)
        return fit_initial_states(evaluate_windows(criterion)).squares

    assert fitted(inside)[0] > 1e6, "by itself it stays astray"
    assert fitted(before, inside)[1] < 80


def test_without_unknowns_a_fit_settles_the_starts() -> None:
    m = record()
    model = model_of(DIAGRAM.replace("value: 22", "value: 25").replace("value: 0.3", "value: 0.2"))
    segments = cut_windows(model, Section(m, 0, len(m.t)), 60, ("x", "v"))
    criterion = Criterion(model, segments, [], {}, 1e-8, {"x": NOISE}, weighting="sum")
    windows, converged = fit_windows(evaluate_windows(criterion))
    assert converged
    assert windows.rss == pytest.approx(len(m.t), rel=0.2)


HEATER = """\
span: [0, 300]
inputs: {power: {}}
blocks:
  T: {type: integrator, of: rate, start: 20}
  heat: {type: gain, of: power, k: 1}
  late: {type: drive_lag, of: heat, tau: 8}
  rate: {type: expression, formula: "0.02*(power + late - (T - 20))"}
"""


def heater() -> tuple[Model, Measured]:
    """A body that a heater warms, which is late by 8 s, switched on before the record begins."""
    model = compile(read_text(HEATER), record=["T"])
    t = np.arange(0.0, 300.0, 2.0)
    drive = {"power": (t, np.where((t // 60) % 2 == 0, 50.0, 20.0))}
    run = simulate(model, times=t, inputs=drive, rtol=1e-9)
    return model, Measured("run", "train", t, {"T": run["T"]}, inputs=drive, start={"T": None})


def test_a_run_inside_a_record_begins_ahead_so_that_what_it_remembers_is_right() -> None:
    model, m = heater()
    segments = cut_windows(model, Section(m, 40, 60), 20, ("T",))
    errors = []
    for windows in (segments, with_memory(model, segments)):
        criterion = Criterion(model, windows, [], {}, sigma={"T": 1.0}, weighting="sum")
        fitted = fit_initial_states(evaluate_windows(criterion))
        errors.append(float(np.abs(fitted.residuals[0]).max()))
    assert errors[0] > 1.0, "the lag begins at a power of 0"
    assert errors[1] < 0.2, "30 s before are nearly four time constants"


def test_a_run_begins_ahead_once_and_only_where_a_model_remembers() -> None:
    model, m = heater()
    segments = cut_windows(model, Section(m, 40, 60), 10, ("T",))
    ahead = with_memory(model, segments)
    assert [one.rows.tolist() for one in ahead] == [one.rows.tolist() for one in segments]
    assert ahead[0].begin == m.t[39 - 15], "a tenth of the series before"
    assert ahead[1].begin == segments[1].begin, "it goes on where the first one ends"
    again = with_memory(model, ahead)
    assert [one.begin for one in again] == [one.begin for one in ahead]
    free = cut_windows(model, Section(m, 40, 60), 10, model.states)
    assert with_memory(model, free) == free
    first = cut_windows(model, Section(m, 0, 60), 10, ("T",))
    assert with_memory(model, first)[0].begin == first[0].begin, "the series has no more"


SWUNG = """\
span: [0, 60]
inputs: {push: {}}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: force}
  drag: {type: viscous, rate: v, c: 0.4}
  load: {type: elastic_load, of: force, m: 0.2, period: 2, damping: 0.005}
  force: {type: sum, of: [push, drag, load]}
"""


def test_what_a_run_hardly_forgets_is_free_where_a_window_follows_no_other() -> None:
    model = compile(read_text(SWUNG), record=["x"])
    t = np.arange(0.0, 60.0, 0.05)
    drive = {"push": (t, np.where((t // 3.1) % 2 == 0, 1.0, -1.0))}
    run = simulate(model, times=t, inputs=drive, rtol=1e-9)
    start = {"x": None, "v": None}
    m = Measured("run", "train", t, {"x": run["x"]}, inputs=drive, start=start)
    segments = cut_windows(model, Section(m, 700, 900), 100, ("x", "v"))
    lasting = ("load.x", "load.xdot")
    with_states = with_memory(model, segments, lasting)
    assert [one.free for one in with_states] == [("x", "v", *lasting), ("x", "v")]
    assert with_states[0].begin == segments[0].begin
    errors = []
    for windows in (with_memory(model, segments), with_states):
        criterion = Criterion(
            model, windows, [], {}, sigma={"x": 1e-3}, weighting="sum", chained=True
        )
        fitted = fit_initial_states(evaluate_windows(criterion))
        errors.append(float(np.abs(fitted.residuals[0]).max()))
    assert errors[0] > 1.0, "the load swings on from before the run began"
    assert errors[1] < 0.05


SOFT = """\
span: [0, 30]
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: force}
  u: {type: sine, amplitude: 0.6, omega: 1.7}
  spring: {type: stiffness, of: x, k: 9}
  soft: {type: hysteresis, rate: v, level: 1.5, deflection: 0.8}
  force: {type: sum, of: [u, spring, soft]}
"""


def test_a_window_alone_remembers_what_the_windows_before_it_have_left() -> None:
    """As where the other ones are left out of a fit: it goes on as in the chain of all."""
    model = compile(read_text(SOFT), record=["x", "v"])
    t = np.arange(0.0, 30.0, 0.02)
    run = simulate(model, times=t, rtol=1e-10)
    m = Measured("run", "train", t, {"x": run["x"], "v": run["v"]}, start={"x": None, "v": None})
    segments = cut_windows(model, Section(m, 0, len(t)), 12, ("x", "v"))

    def run_all(segments: list[Segment]) -> Windows:
        segments = with_memory(model, segments)
        criterion = Criterion(
            model, segments, [], {}, sigma={"x": 1.0, "v": 1.0}, weighting="sum", chained=True
        )
        return fit_initial_states(evaluate_windows(criterion))

    chain = run_all(segments)
    alone = chain.segments[60:61]
    assert with_memory(model, alone)[0].begin == segments[60].begin
    assert max(chain.squares) < 1e-8
    assert run_all(alone).rss < 1e-8
    (ahead,) = with_memory(model, segments[60:61])
    assert ahead.begin == pytest.approx(segments[60].begin - 0.48), "twice its length"
    assert run_all([ahead]).rss > 1e-4, "it has not forgotten that the hysteresis begins at 0"


STOPPED = """\
span: [0, 6]
inputs: {push: {}}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: rate}
  rate: {type: gain, of: force, k: 740}
  stop: {type: voigt_barrier, of: x, rate: v, high: 0.2, low: -0.2, k: 300, c_l: 120}
  force: {type: sum, of: [push, stop]}
"""


def test_a_start_inside_a_stop_is_tried_beside_what_the_data_tell() -> None:
    """A body that lies on a damped stop leaves it when its depth, far below the noise, says so."""
    model = compile(read_text(STOPPED), record=["x", "v"])
    t = np.arange(0.0, 6.0, 0.01)
    drive = {"push": (t, 0.05 * np.cos(4 * t))}
    run = simulate(model, times=t, inputs=drive, rtol=1e-9)
    noise = 1e-3 * np.random.default_rng(6).standard_normal(len(t))
    values = {"x": run["x"] + noise, "v": run["v"] + 10 * noise[::-1]}
    m = Measured("run", "train", t, values, inputs=drive, start={"x": 0, "v": 0})
    segments = cut_windows(model, Section(m, 0, len(t)), 20, ("x", "v"))
    sigma = {"x": 1e-3, "v": 1e-2}
    criterion = Criterion(model, segments, [], {}, sigma=sigma, weighting="sum", chained=True)
    windows = fit_initial_states(evaluate_windows(criterion))
    sizes = [near.residual.size for near in windows.linearisations]
    assert max(windows.squares / sizes) < 3
