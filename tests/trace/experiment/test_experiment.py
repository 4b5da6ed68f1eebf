"""The experiment that tells two effects apart, or that none does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.errors import OptionError
from tracewire.residual import Measured
from tracewire.residual.windows import Section, cut_windows
from tracewire.trace.candidates.candidates import find_candidates
from tracewire.trace.candidates.places import find_places
from tracewire.trace.candidates.signal_scales import Trajectory, signal_scales_of
from tracewire.trace.experiment.experiment import design_experiment
from tracewire.trace.experiment.rig import main_frequency
from tracewire.trace.found import Experiment
from tracewire.trace.options import TraceOptions
from tracewire.trace.thresholds import ExperimentOptions
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import TraceProblem

OPTIONS = TraceOptions()

OSCILLATOR = """\
span: [0, 6]
inputs: {u: {unit: rad/s^2}}
parameters: {k: {value: 36, fit: [5, 90]}, c: {value: 0.5, fit: [0, 5]}}
blocks:
  q: {type: integrator, of: v, unit: rad}
  v: {type: integrator, of: torque, unit: rad/s}
  spring: {type: gain, of: q, k: -k}
  damper: {type: gain, of: v, k: -c}
  torque: {type: sum, of: [u, spring, damper]}
measured:
  run: {file: run.csv, time: t, signals: {q: q}}
"""
NOISE = 1e-3
T = np.arange(0.0, 6.0, 0.01)


def drive(t: np.ndarray) -> np.ndarray:
    return np.asarray(4 * np.sin(5.6 * t))


def between(
    folder: Path,
    one: str,
    values: dict[str, float],
    other: str,
    options: TraceOptions = OPTIONS,
) -> Experiment:
    """The experiment for two effects, fitted to an oscillator with a cubic damping (or a bias)."""

    def rates(t: float, x: np.ndarray) -> list[float]:
        spring = -36 * x[0] - 0.5 * x[1]
        more = -0.2 * x[1] ** 3 if one == "cubic_damping" else 0.36
        return [x[1], float(drive(np.array(t))) + spring + more]

    run = solve_ivp(rates, (0, 6), [0.25, 0.0], t_eval=T, rtol=1e-8, atol=1e-9).y
    noisy = run[0] + NOISE * np.random.default_rng(1).standard_normal(len(T))
    start = {"q": None, "v": None}
    series = Measured("run", "train", T, {"q": noisy}, inputs={"u": (T, drive(T))}, start=start)
    np.savetxt(folder / "run.csv", [[0, 0], [1, 0]], delimiter=",", header="t,q", comments="")
    path = folder / "oscillator.yaml"
    path.write_text(OSCILLATOR)
    model = compile(read(path), record=("q",))
    problem = TraceProblem(model, (series,), {"q": NOISE}, 1e-6, options=options)
    places = find_places(model)
    signals = {"q": run[0], "v": run[1], "u": drive(T), "torque": np.gradient(run[1], T)}
    levels = signal_scales_of([Trajectory(T, signals)], OPTIONS.candidate)
    known = {c.effect: c for c in find_candidates(model, places, levels, OPTIONS.candidate)}
    windows = cut_windows(model, Section(series, 0, len(T)), 150, ("q", "v"))
    trials = []
    for name in (one, other):
        begun = values if name == one else {known[name].parameter: known[name].scale / 10}
        trials.append(problem.fit((PlacedEffect(known[name], begun),), windows, 150, {}))
    return design_experiment(problem, trials[0], trials[1], str(known[one]), str(known[other]))


def test_a_drag_that_was_seen_at_one_amplitude_shows_its_power_at_others(tmp_path: Path) -> None:
    found = between(tmp_path, "cubic_damping", {"c": 0.2}, "quad_drag")
    assert found.separation > 1
    beginning = "To decide between cubic_damping @ torque and quad_drag @ torque: "
    assert found.words.startswith(beginning)
    rows = [row["separation"] for row in found.map]
    assert found.separation == max(rows)
    assert min(rows) < 0.3 * max(rows), "many experiments would not have told"
    at_best = [row for row in found.map if row["separation"] == found.separation]
    assert {k: v for k, v in at_best[0].items() if k != "separation"} == found.settings


def test_what_is_searched_stays_in_the_range_of_the_records(tmp_path: Path) -> None:
    """The drive was a sine of 4 rad/s^2, the swing began at 0.25 rad."""
    found = between(tmp_path, "cubic_damping", {"c": 0.2}, "quad_drag")
    released = [row["start.q"] for row in found.map if "start.q" in row]
    driven = [row["u amplitude"] for row in found.map if "u amplitude" in row]
    assert 0.2 < max(map(abs, released)) < 0.6 and 3.9 < max(driven) <= 4.0
    little = replace(OPTIONS, experiment=ExperimentOptions(reach=0.5))
    less = between(tmp_path, "cubic_damping", {"c": 0.2}, "quad_drag", little)
    assert 0 < len(less.map) < len(found.map)
    nothing = replace(OPTIONS, experiment=ExperimentOptions(reach=1e-3))
    with pytest.raises(OptionError, match="within the range of these records no experiment tells"):
        between(tmp_path, "cubic_damping", {"c": 0.2}, "quad_drag", nothing)


def test_no_motion_tells_an_offset_from_a_torque_on_a_linear_spring(tmp_path: Path) -> None:
    found = between(tmp_path, "bias", {"level": 0.36}, "sensor_offset")
    assert found.separation < 0.1
    beginning = "Within the range of these records no experiment tells bias @ torque from "
    assert found.words.startswith(beginning)
    assert "Turn the sensor" in found.words


def test_a_memory_goes_on_from_one_window_of_an_experiment_to_the_next(tmp_path: Path) -> None:
    """An effect is not told from itself, wherever its memory is."""
    found = between(tmp_path, "hysteresis", {"level": 0.36}, "hysteresis")
    assert found.separation < 1e-3


@pytest.mark.parametrize("frequency", [0.5, 2.0])
def test_the_main_frequency(frequency: float) -> None:
    t = np.arange(0.0, 10.0, 0.01)
    series = Measured("run", "train", t, {"q": 5 + np.sin(2 * np.pi * frequency * t)})
    assert main_frequency(series) == pytest.approx(frequency, rel=0.05)
