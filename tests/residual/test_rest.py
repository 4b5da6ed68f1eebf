"""States that follow inputs alone: where their runs begin inside a record."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import tracewire as tw
from tracewire.compile import Model, compile
from tracewire.diagram import read_text
from tracewire.residual import Criterion, Measured, load_measured
from tracewire.residual.initial_states import fit_initial_states
from tracewire.residual.rest import states_along_inputs, states_at_rest
from tracewire.residual.windows import Section, cut_windows, evaluate_windows, with_memory
from tracewire.solve import Held, parameter_values, simulate

STATES = """
span: [0, 2]
inputs: [u, other]
parameters: {gain: 3}
blocks:
  late: {type: drive_lag, of: u, tau: 0.5}
  total: {type: integrator, of: u}
  unknown: {type: drive_lag, of: other, tau: 0.5}
  behind: {type: drive_lag, of: total, tau: 0.5}
  spring: {type: elastic_load, of: u, m: 0.2, period: 2, damping: 0.1}
  warm: {type: state_space, of: u, A: [[-2]], B: [gain], C: [1], D: 0}
"""
HEATER = """\
span: [0, 300]
inputs: {power: {}}
blocks:
  T: {type: integrator, of: rate, start: 20}
  late: {type: drive_lag, of: power, tau: 40}
  rate: {type: expression, formula: "0.02*(power + late - (T - 20))"}
"""
WINDOWS = """\
measured:
  run:
    file: run.csv
    time: t
    signals: {T: {column: T, sigma: 0.1}}
    inputs: {power: p}
    start: {T: free}
    use: {train: [0, 200], validate: [200, 300]}
"""
T = np.arange(0.0, 300.0, 2.0)
POWER = np.where(T < 2, 0.0, 50.0)


def heated() -> tuple[Model, Measured]:
    """A body that a heater warms, which is late by 40 s."""
    model = compile(read_text(HEATER), record=["T"])
    drive = {"power": (T, POWER)}
    run = simulate(model, times=T, inputs=drive, rtol=1e-9)
    return model, Measured("run", "train", T, {"T": run["T"]}, inputs=drive, start={"T": None})


def test_only_what_follows_inputs_alone_comes_to_rest_with_them() -> None:
    """What a parameter of a fit would move is left out; where a record begins nothing is known."""
    model, values = compile(read_text(STATES)), {"gain": 3.0}
    assert states_at_rest(model, values, {"u": (T, 2 * T)}, 1.5) == {"late.w": 3.0}
    assert states_at_rest(model, values, {"u": (T, 2 * T)}, 0.0) == {}


@pytest.mark.parametrize("held", [False, True])
def test_a_lag_is_where_its_input_has_led_it(held: bool) -> None:
    """As in a run from the begin of the record, also where samples are far apart."""
    text = STATES.replace("tau: 0.5", "tau: 0.7", 1)
    model, t = compile(read_text(text), record=["late.w", "warm.x"]), np.linspace(0, 2, 9)
    u = np.random.default_rng(4).standard_normal(len(t))
    drive = Held(t, u) if held else (t, u)
    zero = (t, 0 * t)
    times = np.array([0.0, 0.3, 1.0, 1.99])
    run = simulate(
        model, times=times, inputs={"u": drive, "other": zero}, start={"late.w": 0.4}, rtol=1e-10
    )
    values = parameter_values(model, {})
    for n, time in enumerate(times):
        found = states_along_inputs(model, values, {"u": drive}, float(time))
        assert set(found) == {"late.w", "warm.x[0]"}
        began = 0.4 * np.exp(-time / 0.7)
        assert found["late.w"] + began == pytest.approx(run["late.w"][n], abs=1e-8)
        assert found["warm.x[0]"] == pytest.approx(run["warm.x[0]"][n], abs=1e-8)


def test_a_lag_begins_inside_a_record_where_its_input_has_led_it() -> None:
    model, m = heated()
    windows = with_memory(model, cut_windows(model, Section(m, 20, 60), 40, ("T",)))
    criterion = Criterion(model, windows, [], {}, sigma={"T": 1.0}, weighting="sum")
    fitted = fit_initial_states(evaluate_windows(criterion))
    assert windows[0].begin == m.t[19], "no run ahead is needed"
    assert float(np.abs(fitted.residuals[0]).max()) < 1e-3
    whole = cut_windows(model, Section(m, 0, 150), 150, ("T",))
    assert with_memory(model, whole)[0].start == whole[0].start, "the record begins as declared"
    assert [one.free for one in with_memory(model, whole, ["late.w"])] == [("T", "late.w")]
    assert [one.free for one in with_memory(model, windows, ["late.w"])] == [("T",)], "it is known"


def test_a_window_of_a_file_begins_at_rest_with_its_input(tmp_path: Path) -> None:
    """It began at 0 there, which no power had been for 200 s."""
    _, m = heated()
    table = np.stack([T, m.values["T"], POWER], 1)
    np.savetxt(tmp_path / "run.csv", table, delimiter=",", header="t,T,p", comments="")
    (tmp_path / "heater.yaml").write_text(HEATER + WINDOWS, encoding="utf-8")
    model = tw.compile(tw.read(tmp_path / "heater.yaml"))
    train, validate = load_measured(model)
    assert train.start == {"T": None}
    assert validate.start == {"T": None, "late.w": pytest.approx(50.0)}
    run = simulate(model, times=validate.t, **{**validate.conditions, "span": validate.span})
    assert run["late.w"][0] == pytest.approx(50.0)


def test_the_first_window_of_a_record_begins_as_the_series_says() -> None:
    """What is declared of a state that is not free was lost."""
    model, m = heated()
    known = Measured("run", "train", T, m.values, inputs=m.inputs, start={"T": None, "late.w": 7.0})
    first = cut_windows(model, Section(known, 0, 150), 50, ("T",))[0]
    assert first.free == ("T",)
    assert first.start["late.w"] == 7.0
