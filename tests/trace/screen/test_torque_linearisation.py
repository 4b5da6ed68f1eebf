"""What torques at places do to what is measured, against the same torques in a run of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from oracles.oscillator import problem_of, record, trial_of
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import Criterion, Measured
from tracewire.residual.windows import Section, Windows, cut_windows, evaluate_windows
from tracewire.trace.candidates.places import find_places
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.screen.trajectories import join_windows, nodes_of, simulate_signals

OPTIONS = TraceOptions()

SMOOTH = """\
span: [0, 3]
parameters: {size: 0}
inputs: {hat: {default: 0}}
blocks:
  theta: {type: integrator, of: omega, start: 1}
  omega: {type: integrator, of: torque}
  gravity: {type: expression, formula: "-20*sin(theta) - 0.3*omega"}
  push: {type: expression, formula: size*hat}
  torque: {type: sum, of: [gravity, push]}
"""
STOP = """\
span: [0, 3]
parameters: {size: 0}
inputs: {hat: {default: 0}}
blocks:
  theta: {type: integrator, of: omega, start: 1}
  omega: {type: integrator, of: torque}
  gravity: {type: expression, formula: "-20*theta - 0.3*omega"}
  push: {type: expression, formula: size*hat}
  torque: {type: sum, of: [gravity, push]}
events:
  - {when: theta + 0.4, crosses: down, set: {omega: -0.7*omega}}
"""
STICK = """\
span: [0, 3]
parameters: {size: 0}
inputs: {hat: {default: 0}}
blocks:
  theta: {type: integrator, of: omega, start: 1}
  omega: {type: integrator, of: torque}
  gravity: {type: expression, formula: "-20*theta"}
  friction: {type: coulomb, rate: omega, level: 4}
  push: {type: expression, formula: size*hat}
  torque: {type: sum, of: [gravity, friction, push]}
"""
T = np.arange(0.0, 3.0, 0.02)
SIGMA = 1e-3


def opened_at(text: str, size: float, hat: np.ndarray, starts: list[dict[str, float]]) -> Windows:
    """Three windows of a diagram that is pushed by size*hat, at given starts."""
    model = compile(read_text(text), record=["theta"])
    m = Measured(
        "run", "train", T, {"theta": np.zeros(len(T))},
        inputs={"hat": (T, hat)}, start={"theta": None, "omega": None},
    )  # fmt: skip
    windows = cut_windows(model, Section(m, 0, len(T)), 50, ("theta", "omega"))
    windows = [
        replace(segment, start=start) for segment, start in zip(windows, starts, strict=True)
    ]
    return evaluate_windows(
        Criterion(model, windows, [], {"size": size}, 1e-9, {"theta": SIGMA}, weighting="sum")
    )


def response(linearisation: TorqueLinearisation, torques: list[np.ndarray]) -> np.ndarray:
    """What torques at `torque` do to all residuals, in sigma."""
    pieces = linearisation.window_pieces
    return np.concatenate([linearisation.window_response(w, {"torque": torques}) for w in pieces])


STARTS: list[dict[str, float]] = [
    {"theta": 1.0, "omega": 0.0},
    {"theta": 0.7, "omega": -2.0},
    {"theta": 0.5, "omega": 1.0},
]
PUSHES: Mapping[str, np.ndarray] = {
    "constant": np.ones(len(T)),
    "wave": np.sin(7 * T + 0.3),
    "late": np.where(T > 1.6, T - 1.6, 0.0),
}


@pytest.mark.parametrize(("text", "step"), [(SMOOTH, 1e-4), (STOP, 1e-4), (STICK, 1e-4)])
def test_the_answer_is_the_derivative_by_the_coefficient_of_the_same_torque(
    text: str, step: float
) -> None:
    windows = opened_at(text, 0.0, np.zeros(len(T)), STARTS)
    places = [p for p in find_places(windows.criterion.model) if p.name == "torque"]
    linearisation = TorqueLinearisation(
        windows.criterion.model.diagram, windows, places, 1e-8, OPTIONS
    )
    torques = [np.stack(list(PUSHES.values()), axis=1)]
    found = response(linearisation, torques)
    assert found.shape == (linearisation.size, len(PUSHES)) == (len(T), len(PUSHES))
    for column, push in zip(found.T, PUSHES.values(), strict=True):
        up, down = (
            np.concatenate(
                [near.residual.ravel() for near in opened_at(text, d, push, STARTS).linearisations]
            )
            for d in (step, -step)
        )
        expected = (up - down) / (2 * step)
        assert np.max(np.abs(expected)) > 1.0, "sigma per unit: the test sees something"
        np.testing.assert_allclose(column, expected, atol=2e-3 * np.max(np.abs(expected)))


def test_while_it_sticks_no_torque_moves_it() -> None:
    at_rest: list[dict[str, float]] = [{"theta": 0.1, "omega": 0.0}] * 3
    windows = opened_at(STICK, 0.0, np.zeros(len(T)), at_rest)
    places = [p for p in find_places(windows.criterion.model) if p.name == "torque"]
    linearisation = TorqueLinearisation(
        windows.criterion.model.diagram, windows, places, 1e-8, OPTIONS
    )
    answer = response(linearisation, [np.ones((len(T), 1))])
    np.testing.assert_allclose(answer, 0.0, atol=1e-9)


def test_the_trajectories_are_the_fitted_run_at_every_sample() -> None:
    trial = trial_of(problem_of(record(), record(name="again", seed=1)))
    places = find_places(trial.model)
    linearisation = TorqueLinearisation(trial.diagram, trial.windows, places, 1e-8, OPTIONS)
    assert len(linearisation.trajectories) == 2
    first = linearisation.trajectories[0]
    m = trial.windows.criterion.segments[0].measured
    np.testing.assert_array_equal(first.t, m.t)
    inside = [s.rows for s in trial.windows.criterion.segments if s.measured is m]
    residual = np.concatenate(
        [r for r, s in zip(trial.windows.residuals, trial.windows.segments, strict=True)
         if s.measured is m]
    )  # fmt: skip
    shown = first.signals["x"] - m.values["x"]
    # where a window begins, the trajectory is that of the window, not of the one before it
    same = ~np.isin(m.t[np.concatenate(inside)], [s.begin for s in trial.windows.segments[1:]])
    found = shown[np.concatenate(inside)] / 1e-3
    np.testing.assert_allclose(found[same], residual[same, 0], atol=1e-2)


def test_a_sensor_is_told_by_what_it_shows() -> None:
    problem = problem_of(record(end=4.0))
    trial = trial_of(problem)
    linearisation = TorqueLinearisation(
        trial.diagram, trial.windows, find_places(trial.model), 1e-8, OPTIONS
    )
    run = linearisation.trajectories[0]
    rows = np.concatenate([s.rows for s in trial.windows.criterion.segments])
    expected = {
        "sensor_offset": np.ones(len(rows)),
        "sensor_gain": run.signals["x"][rows],
        "sensor_quad": run.signals["x"][rows] ** 2,
        "sensor_drift": run.t[rows] - run.t[0],
    }
    for effect, column in expected.items():
        np.testing.assert_allclose(
            linearisation.sensor_response(effect, "x"), column / 1e-3, err_msg=effect
        )
    delay = linearisation.sensor_response("sensor_delay", "x") * 1e-3
    np.testing.assert_allclose(delay[1:-1], -run.signals["v"][rows][1:-1], atol=0.1)


def test_the_nodes_of_a_window_are_its_samples_and_where_it_begins() -> None:
    m = record()
    first, second = cut_windows(problem_of(m).declared, Section(m, 0, 100), 50, ("x", "v"))
    times, samples, counts = nodes_of(second)
    assert times[0] == second.begin and not counts[0] and counts[1:].all()
    np.testing.assert_array_equal(times, m.t[samples])
    assert nodes_of(first)[2].all()


def test_where_windows_meet_the_end_of_one_is_the_signal() -> None:
    problem = problem_of(record())
    trial = trial_of(problem, length=50)
    windows = trial.windows
    second = {**windows.starts[1], "v": 1e3}
    kicked = replace(windows, starts=(windows.starts[0], second, *windows.starts[2:]))
    runs = simulate_signals(trial.model, kicked, 1e-6)
    assert max(np.abs(run["v"]).max() for run in runs) == pytest.approx(1e3)
    (whole,) = join_windows(kicked, runs)
    meets = nodes_of(kicked.segments[1])[1][0]
    assert whole.signals["v"][meets] == runs[0]["v"][-1]
    first, last = (nodes_of(kicked.segments[n])[1] for n in (0, 2))
    np.testing.assert_array_equal(whole.signals["v"][first], runs[0]["v"])
    np.testing.assert_array_equal(whole.signals["v"][last[1:]], runs[2]["v"][1:])
