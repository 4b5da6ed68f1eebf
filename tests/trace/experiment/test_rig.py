"""What a new experiment may set."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import Measured
from tracewire.residual.windows import Section, cut_windows
from tracewire.trace.experiment.rig import Design, Rig, rig_of
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.trial import TraceProblem

OPTIONS = TraceOptions()

DRIVEN = """\
span: [0, 2]
inputs: {u: {}}
parameters: {A: 0.5, pitch: {value: 6, unit: rad/s}, k: {value: 40, fit: [1, 90]}}
blocks:
  q: {type: integrator, of: v, start: 0.4, unit: rad}
  v: {type: integrator, of: torque, unit: rad/s}
  push: {type: sine, amplitude: A, omega: pitch}
  spring: {type: gain, of: q, k: -k}
  torque: {type: sum, of: [u, push, spring]}
"""
T = np.arange(0.0, 2.0, 0.01)


@pytest.fixture(scope="module")
def rig() -> Rig:
    q = 0.4 * np.cos(6.3 * T)
    u = 2 + 3 * np.sin(9 * T)
    start = {"q": None, "v": None}
    series = Measured("run", "train", T, {"q": q}, inputs={"u": (T, u)}, start=start)
    model = compile(read_text(DRIVEN), record=("q",))
    problem = TraceProblem(model, (series,), {"q": 1e-3}, 1e-6)
    windows = cut_windows(model, Section(series, 0, len(T)), 50, ("q", "v"))
    return rig_of(problem, problem.fit((), windows, 50, {}))


def test_inputs_and_sine_blocks_are_drives_with_what_was_measured(rig: Rig) -> None:
    assert set(rig.drives) == {"u", "push"}
    assert rig.drives["push"] == 0.5
    assert rig.drives["u"] == pytest.approx(3.0, rel=0.2)


def test_a_driven_experiment_leaves_the_other_drives_off(rig: Rig) -> None:
    setting = Design(0.0, "push", 0.25, 2.0)
    assert rig.parameters(setting) == {"A": 0.25, "pitch": pytest.approx(4 * math.pi)}
    assert not rig.inputs(setting)["u"][1].any()
    setting = Design(0.0, "u", 1.5, 2.0)
    assert rig.parameters(setting) == {"A": 0.0}
    assert rig.inputs(setting)["u"][1] == pytest.approx(1.5 * np.sin(4 * np.pi * rig.t))
    assert rig.as_parameters(setting) == {"u amplitude": 1.5, "u frequency": 2.0}


def test_a_release_is_from_rest_without_a_drive(rig: Rig) -> None:
    setting = Design(release=1.7)
    assert rig.parameters(setting) == {"A": 0.0}
    assert not rig.inputs(setting)["u"][1].any()
    start = rig.start(setting)
    assert start["v"] == 0.0
    assert start["q"] == pytest.approx(rig.rest["q"] + 1.7 * rig.width["q"])
    assert list(rig.as_parameters(setting)) == ["start.q"]


def test_nothing_beyond_three_times_what_was_measured(rig: Rig) -> None:
    assert all(rig.is_allowed(setting) for setting in rig.designs())
    assert not rig.is_allowed(Design(release=3.1))
    assert not rig.is_allowed(Design(release=0.1))
    assert not rig.is_allowed(Design(0.0, "push", 2.0, 1.0))
    nearby = list(Design(0.0, "push", 1.0, 1.0).near(OPTIONS.experiment))
    assert len({(s.amplitude, s.frequency) for s in nearby}) == 4
