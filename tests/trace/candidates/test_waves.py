"""Waves along a coordinate: the scan finds the teeth of a rotor that turns many times."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from oracles.oscillator import problem_of, trial_of
from scipy.integrate import solve_ivp
from tracewire.residual import Measured
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.candidates import find_candidates
from tracewire.trace.candidates.places import find_places
from tracewire.trace.candidates.signal_scales import signal_scales_of
from tracewire.trace.candidates.waves import part_up_to
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.screening import ScreenRow, screen_candidates
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.thresholds import CandidateOptions

OPTIONS = TraceOptions()

ROTOR = """\
span: [0, 8]
inputs: {u: {default: 0}}
parameters:
  c: {value: 0.3, fit: [0, 5]}
  b: {value: 9, fit: [0, 50]}
blocks:
  x: {type: integrator, of: w, start: 0, unit: UNIT}
  w: {type: integrator, of: torque}
  bearing: {type: viscous, rate: w, c: c}
  push: {type: gain, of: u, k: b}
  torque: {type: sum, of: [bearing, push]}
"""
T = np.arange(0.0, 8.0, 0.01)


def drive(t: float | np.ndarray) -> np.ndarray:
    return np.asarray(0.5 * np.sin(1.3 * t) + 0.35 * np.sin(3.1 * t + 1) + 0.12)


def turned(teeth: float, amplitude: float, rubbing: float = 0.0) -> Measured:
    """x'' = -0.5 x' + 10 u + amplitude*sin(teeth*x + 0.7), and a friction of as many waves."""

    def rates(t: float, state: np.ndarray) -> list[float]:
        x, w = state.tolist()
        wave = amplitude * np.sin(teeth * x + 0.7)
        wave -= rubbing * np.cos((teeth * x + 0.4) / 2) ** 2 * np.tanh(w / 1e-2)
        return [w, -0.5 * w + 10 * float(drive(t)) + wave]

    run = solve_ivp(rates, (0, 8), [0, 0], t_eval=T, rtol=1e-8, atol=1e-9, max_step=0.02)
    x = run.y[0] + 5e-4 * np.random.default_rng(0).standard_normal(len(T))
    inputs = {"u": (T, drive(T))}
    return Measured("run", "train", T, {"x": x}, start={"x": None, "w": None}, inputs=inputs)


def best_row(
    record: Measured, effect: str, unit: str = "rad", options: TraceOptions = OPTIONS
) -> ScreenRow:
    problem = problem_of(record, text=ROTOR.replace("UNIT", unit), sigma=5e-4)
    trial = trial_of(problem, length=40)
    places = find_places(problem.declared)
    linearisation = TorqueLinearisation(trial.diagram, trial.windows, places, 1e-6, options)
    known: list[Candidate] = find_candidates(
        problem.declared,
        places,
        signal_scales_of(linearisation.trajectories, OPTIONS.candidate),
        OPTIONS.candidate,
    )
    screen = screen_candidates(linearisation, trial, [c for c in known if c.effect == effect])
    return screen.best()[0]


@pytest.mark.parametrize(("teeth", "amplitude"), [(1, 1.0), (12, 2.0), (36, 1.0)])
def test_the_teeth_of_a_rotor_that_turns_are_counted(teeth: int, amplitude: float) -> None:
    pitch = best_row(turned(teeth, amplitude), "cogging").shapes["pitch"]
    assert pitch == pytest.approx(2 * np.pi / teeth, rel=1e-9)


def test_a_pitch_that_is_no_part_of_a_turn_is_found_nearly() -> None:
    record = turned(2 * np.pi / 0.37, 1.0)
    assert np.ptp(record.values["x"]) > 30 * 0.37
    assert best_row(record, "cogging", unit="m").shapes["pitch"] == pytest.approx(0.37, rel=0.02)


def test_a_way_of_one_wave_has_one_length() -> None:
    options = replace(OPTIONS, candidate=replace(OPTIONS.candidate, most_waves=1))
    row = best_row(turned(1, 1.0), "cogging", unit="m", options=options)
    assert row.shapes["pitch"] > 0


def test_friction_that_comes_back_with_the_way_is_scanned_too() -> None:
    row = best_row(turned(5, 0.0, rubbing=1.5), "position_friction")
    assert row.shapes["pitch"] == pytest.approx(2 * np.pi / 5, rel=0.02)


def test_in_a_long_record_a_part_of_the_windows_tells_the_length() -> None:
    """A tenth of these residuals shows as many teeth as all of them."""
    few = TraceOptions(candidate=CandidateOptions(scanned=len(T) // 10))
    row = best_row(turned(12, 2.0), "cogging", options=few)
    assert row.shapes["pitch"] == pytest.approx(2 * np.pi / 12, rel=1e-9)


def test_a_coefficient_at_its_bound_takes_less_of_the_squared_error() -> None:
    """Of r + c x with the best c at 4, where 1 is the most: |r|^2 - |r + x|^2 over that of 4."""
    x = np.array([1.0, -2.0, 3.0])
    r = -4 * x + np.array([2.0, 1.0, 0.0])  # the rest is at right angles to x
    part = (r @ r - (r + x) @ (r + x)) / (r @ r - (r + 4 * x) @ (r + 4 * x))
    assert part_up_to(1.0, np.array([4.0, -4.0])) == pytest.approx([part, part])
    assert part_up_to(1.0, np.array([0.0, 0.7, -1.0])) == pytest.approx([1.0, 1.0, 1.0])
    assert part_up_to(np.inf, np.array([0.0, 1e9])) == pytest.approx([1.0, 1.0])
