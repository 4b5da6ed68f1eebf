"""What a new experiment may set."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import Measured
from tracewire.residual.windows import Section, cut_windows
from tracewire.trace.experiment.drives import Drive, drive_of
from tracewire.trace.experiment.rig import Design, Rig, rig_of
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.trial import TraceProblem

OPTIONS = TraceOptions()

DRIVEN = """\
span: [0, 2]
inputs: {u: {}, rope: {unit: m}, rope_rate: {unit: m/s}}
parameters: {A: 0.5, pitch: {value: 6, unit: rad/s}, k: {value: 40, fit: [1, 90]}}
blocks:
  q: {type: integrator, of: v, start: 0.4, unit: rad}
  v: {type: integrator, of: torque, unit: rad/s}
  push: {type: sine, amplitude: A, omega: pitch}
  spring: {type: expression, formula: -k*rope*q - rope_rate*v}
  torque: {type: sum, of: [u, push, spring]}
"""
TANK = """\
span: [0, 2]
inputs: {pump: {}}
parameters: {k: {value: 1, fit: [0.1, 9]}}
blocks:
  h: {type: integrator, of: net}
  out: {type: gain, of: h, k: -k}
  net: {type: sum, of: [pump, out]}
"""
SWING = """\
span: [0, 2]
parameters: {k: {value: 30, fit: [1, 90]}}
blocks:
  q: {type: integrator, of: v, start: 0.4, unit: rad}
  v: {type: integrator, of: torque, unit: rad/s}
  torque: {type: gain, of: q, k: -k}
"""
T = np.arange(0.0, 2.0, 0.01)
ROPE = 1 + 0.2 * np.sin(2 * T)


def problem(text: str, q: np.ndarray, signal: str, **inputs: np.ndarray) -> TraceProblem:
    model = compile(read_text(text), record=(signal,))
    driving = {name: (T, u) for name, u in inputs.items()}
    start = dict.fromkeys(model.states)
    series = Measured("run", "train", T, {signal: q}, inputs=driving, start=start)
    return TraceProblem(model, (series,), {signal: 1e-3}, 1e-6)


def rig_on(bench: TraceProblem, returns: bool = True) -> Rig:
    (series,) = bench.measured
    windows = cut_windows(bench.declared, Section(series, 0, len(T)), 50, bench.states)
    states = compile(bench.declared.diagram, record=bench.states, backend="quick")
    return rig_of(bench, bench.fit((), windows, 50, {}), states, returns)


@pytest.fixture(scope="module")
def rig() -> Rig:
    q = 0.4 * np.cos(6.3 * T) + 0.1
    inputs = {"u": 2 + 3 * np.sin(9 * T), "rope": ROPE, "rope_rate": 0.4 * np.cos(2 * T)}
    return rig_on(problem(DRIVEN, q, "q", **inputs))


@pytest.fixture(scope="module")
def tank() -> Rig:
    return rig_on(problem(TANK, 0.2 + 0.1 * T, "h", pump=np.where(T < 1, 0.0, 3.0)))


def test_inputs_and_sine_blocks_are_drives_with_what_was_measured(rig: Rig) -> None:
    assert set(rig.drives) == {"u", "push", "rope", "rope_rate"}
    assert rig.drives["push"] == Drive(0.0, 0.5, 0.0)
    assert rig.rates == {"rope": "rope_rate"}


def test_a_sine_stays_between_the_least_and_the_largest_value() -> None:
    options = OPTIONS.experiment
    assert drive_of([np.array([-2.0, 3.0])], options) == Drive(0.0, 2.0, 0.0)
    one_sided = drive_of([np.array([0.0, 1.0, 8.0])], options)
    assert one_sided == Drive(3.0, 3.0, 0.0), "a heater is never negative"
    hardly = drive_of([np.array([-0.1, 4.0, 8.1])], options)
    assert hardly == Drive(4.0, pytest.approx(4.1), 0.0)
    never_off = drive_of([np.array([2.0, 4.0])], options)
    assert never_off == Drive(3.0, 1.0, 3.0)


def test_a_driven_experiment_leaves_the_other_drives_alone(rig: Rig) -> None:
    """A rope keeps its length: it is never zero."""
    length = float(np.mean(ROPE))
    setting = Design(0.0, "push", 0.25, 2.0)
    assert rig.parameters(setting) == {"A": 0.25, "pitch": pytest.approx(4 * math.pi)}
    assert not rig.inputs(setting)["u"][1].any()
    assert rig.inputs(setting)["rope"][1] == pytest.approx(length)
    assert not rig.inputs(setting)["rope_rate"][1].any()
    setting = Design(0.0, "u", 1.5, 2.0)
    assert rig.parameters(setting) == {"A": 0.0}
    centre = rig.drives["u"].centre
    assert rig.inputs(setting)["u"][1] == pytest.approx(centre + 1.5 * np.sin(4 * np.pi * rig.t))
    assert rig.as_parameters(setting) == {
        "u mean": pytest.approx(centre, rel=1e-3),
        "u amplitude": 1.5,
        "u frequency": 2.0,
        "rope held": pytest.approx(length, rel=1e-3),
    }


def test_a_drive_and_its_rate_move_together(rig: Rig) -> None:
    slow = Design(0.0, "rope", 0.1, 0.3)
    assert rig.is_allowed(slow)
    inputs = rig.inputs(slow)
    np.testing.assert_allclose(
        np.gradient(inputs["rope"][1], rig.t)[1:-1], inputs["rope_rate"][1][1:-1], atol=2e-3
    )
    assert not rig.is_allowed(Design(0.0, "rope", 0.1, 3.0)), "faster than it ever moved"
    assert not rig.is_allowed(Design(0.0, "rope_rate", 0.2, 0.3)), "it does not move alone"
    assert "rope held" not in rig.as_parameters(slow)


def test_a_release_is_from_rest_without_a_drive_in_the_range_of_the_records(rig: Rig) -> None:
    setting = Design(release=1.0)
    assert rig.parameters(setting) == {"A": 0.0}
    assert not rig.inputs(setting)["u"][1].any()
    start = rig.start(setting)
    assert start["v"] == 0.0
    assert min(abs(start["q"] - 0.5), abs(start["q"] + 0.3)) < 0.01, "the ends of the motion"
    assert list(rig.as_parameters(setting)) == ["start.q", "rope held"]
    assert rig.is_allowed(Design(release=1.05))
    assert not rig.is_allowed(Design(release=1.2))
    assert not rig.is_allowed(Design(release=0.05))


def test_a_body_is_released_to_the_side_where_it_was() -> None:
    q = -0.4 * np.exp(-5 * T)
    rig = rig_on(problem(DRIVEN, q, "q", u=0 * T, rope=ROPE, rope_rate=0 * T))
    assert -0.45 < rig.start(Design(release=1.0))["q"] < -0.3


def test_how_far_a_coordinate_went_that_is_not_measured_is_known_from_the_fit() -> None:
    """Of a swing of 0.4 rad only the rate is measured, in one window."""
    t = np.arange(0.0, 2.0, 0.01)
    series = Measured("run", "train", t, {"v": -2.4 * np.sin(6 * t)}, start={"q": None, "v": None})
    model = compile(read_text(SWING), record=("v",))
    bench = TraceProblem(model, (series,), {"v": 1e-3}, 1e-6)
    windows = cut_windows(model, Section(series, 0, len(t)), len(t), bench.states)
    states = compile(model.diagram, record=bench.states, backend="quick")
    rig = rig_of(bench, bench.fit((), windows, len(t), {}), states)
    assert abs(rig.rest["q"]) < 0.1
    assert abs(rig.width["q"]) == pytest.approx(0.4, abs=0.1)


def test_nothing_beyond_what_was_measured(rig: Rig) -> None:
    assert all(rig.is_allowed(setting) for setting in rig.designs())
    assert not rig.is_allowed(Design(0.0, "push", 0.6, 1.0))
    nearby = list(Design(0.0, "push", 0.4, 1.0).near(OPTIONS.experiment))
    assert len({(s.amplitude, s.frequency) for s in nearby}) == 4


def test_a_body_that_never_comes_back_is_not_released() -> None:
    bench = problem(DRIVEN, 3 * T, "q", u=np.sin(T), rope=ROPE, rope_rate=0 * T)
    assert any(not setting.drive for setting in rig_on(bench).designs())
    assert all(setting.drive for setting in rig_on(bench, returns=False).designs())


def test_a_level_is_not_released_and_begins_as_its_record_does(tank: Rig) -> None:
    assert tank.designs() and all(setting.drive == "pump" for setting in tank.designs())
    assert tank.begins == "run"
    assert tank.start(tank.designs()[0])["h"] == pytest.approx(0.2, abs=0.05)
    assert all(tank.inputs(setting)["pump"][1].min() >= 0 for setting in tank.designs())


def test_a_motion_of_twice_the_range_is_too_much(tank: Rig) -> None:
    """From 0.2 to 0.4 in the record: from 0.1 to 0.5 is what it is known to bear, about."""
    assert tank.stays(np.array([[0.11], [0.49]]))
    assert not tank.stays(np.array([[0.3], [0.52]]))
    assert not tank.stays(np.array([[0.3], [0.08]]))
    assert not tank.stays(np.array([[0.3], [np.nan]]))
