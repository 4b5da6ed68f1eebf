"""Measured series arrive in SI, cut to their windows, and say in words what they lack."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from residual.series_files import CSV, PLAIN, TOP, message, model_of, one, said, wave
from scipy.io import savemat
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import Measured, load_measured, with_measured_signals


def test_columns_come_in_si(file: Path) -> None:
    text = """\
  run:
    file: run.csv
    time: t
    signals: {theta: {column: angle, unit: deg, sigma: 0.5, offset: {value: 2, fit: [-3, 3]}}}
    inputs: {drive: {column: u, unit: mN m}}
    start: {theta: {value: 180, unit: deg}, omega: free}
"""
    (run,) = load_measured(model_of(file, text))
    assert run.t.tolist() == [0.0, 0.5, 1.0, 1.5]
    assert run.values["theta"] == pytest.approx([0, math.pi / 2, math.pi, -math.pi / 2])
    assert run.sigma == {"theta": pytest.approx(math.radians(0.5))}
    sensor = run.sensor("theta")
    assert (sensor.offset, sensor.gain, sensor.delay) == (pytest.approx(math.radians(2)), 1, 0)
    assert sensor.free == {"offset": pytest.approx((math.radians(-3), math.radians(3)))}
    times, values = run.inputs["drive"]
    assert times.tolist() == run.t.tolist()
    assert values == pytest.approx([1e-3, 2e-3, 3e-3, 4e-3])
    assert run.start == {"theta": pytest.approx(math.pi), "omega": None}
    assert (run.name, run.use, run.file) == ("run", "train", str(file.parent / "run.csv"))


def test_a_plain_series_declares_nothing(file: Path) -> None:
    (run,) = load_measured(model_of(file, PLAIN))
    assert run.sigma == {"theta": None}
    assert (run.sensors, run.inputs, run.start) == ({}, {}, {})


def test_a_window_cuts_signals_and_not_inputs(file: Path) -> None:
    more = "inputs: {drive: u}, from: 0.5, to: 1.0}"
    (run,) = load_measured(model_of(file, PLAIN.rstrip()[:-1] + ", " + more))
    assert run.t.tolist() == [0.5, 1.0]
    assert run.values["theta"] == pytest.approx([math.pi / 2, math.pi])
    assert run.inputs["drive"][0].tolist() == [0.0, 0.5, 1.0, 1.5]


def test_start_values_follow_the_preset_of_the_series(file: Path) -> None:
    more = ", start: {theta: start}, preset: high}\n"
    first, second = load_measured(
        model_of(file, PLAIN.replace("}}}\n", "}}, start: {theta: start}}\n"),
                 PLAIN.replace("run:", "high:").replace("}}}\n", "}}" + more))
    )  # fmt: skip
    assert (first.start["theta"], second.start["theta"]) == (0.5, 0.75)


def test_series_are_chosen_by_use(file: Path) -> None:
    other = PLAIN.replace("run:", "check:").replace("time: t", "time: t, use: validate")
    model = model_of(file, PLAIN, other)
    assert [m.name for m in load_measured(model)] == ["run", "check"]
    assert [m.name for m in load_measured(model, ["validate"])] == ["check"]
    assert message(model, "gate") == (
        f"{file}: the diagram names no measured series for ['gate']. "
        "Add one under `measured:` with file, time and signals."
    )


def test_a_model_records_what_any_series_measures_once() -> None:
    model = compile(read_text(TOP.partition("measured:")[0]), record=["theta"])
    one = Measured("one", "train", np.arange(2.0), {"theta": np.zeros(2)})
    both = replace(one, values={"theta": np.zeros(2), "omega": np.zeros(2)})
    others = [both, replace(both, name="other")]
    assert with_measured_signals(model, others).recorded == ("theta", "omega")
    assert with_measured_signals(model, [one]) is model


def test_no_series_is_told() -> None:
    model = compile(read_text(TOP.partition("measured:")[0]))
    assert "the diagram names no measured series. Add one under `measured:`" in message(model)


def test_a_window_without_samples_is_told_with_what_the_file_covers(file: Path) -> None:
    model = model_of(file, PLAIN.replace("time: t", "time: t, from: 0.6, to: 1.4"))
    assert message(model) == (
        f"{file}:9:3: the series 'run' has 1 samples between 0.6 and 1.4 s; the file covers 0 to "
        "1.5 s. Correct `from` and `to`."
    )


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("0.5,90", "0.5,inf", "run.csv:3: column 'angle' is not finite in this row. Leave out"),
        ("0.5,90", "0.5,ninety", "run.csv:3: column 'angle' is 'ninety', which is not a number."),
        ("1.0,180", "0.25,180", "run.csv:4: time goes back to 0.25, from 0.5 in line 3."),
        ("angle", "angel", "unknown column 'angle' in"),
        ("angle", "angel", "there are: angel, t, u. Did you mean 'angel'?"),
    ],
)
def test_what_the_file_lacks_is_told(file: Path, old: str, new: str, said: str) -> None:
    model = model_of(file, PLAIN)
    (file.parent / "run.csv").write_text(CSV.replace(old, new), encoding="utf-8")
    assert said in message(model)


def test_a_file_that_has_gone_is_told_at_its_place(file: Path) -> None:
    model = model_of(file, PLAIN)
    (file.parent / "run.csv").unlink()
    assert message(model).startswith(f"{file}:9:3: ")
    assert "run.csv" in message(model)


def test_the_problems_of_all_series_are_told_together(file: Path) -> None:
    text = PLAIN.replace("column: angle", "column: angel")
    model = model_of(file, text, text.replace("run:", "other:").replace("angel", "agle"))
    told = message(model).splitlines()
    assert len(told) == 2
    assert "'angel'" in told[0] and "'agle'" in told[1]


# --- what a series may say of its file ----------------------------------------------------------


def test_the_time_of_the_diagram_begins_at_zero(file: Path) -> None:
    wave(file, "t [ms],angle,u", step=10.0)
    run = one(file, "time: {column: t, zero: 500}, from: 1, to: 2, inputs: {drive: u}")
    assert (run.t[0], run.t[-1]) == (pytest.approx(0.5), pytest.approx(1.5))
    assert run.inputs["drive"][0][0] == pytest.approx(-0.5)
    assert run.steps == (
        "time: from ms to s, as the header says",
        "window 1 ... 2 s of the file: 101 of 400 samples",
        "time: t = 0 is 0.5 s of the file",
        "input 'drive' is joined by straight lines",
    )


def test_rows_without_time_begin_at_zero(file: Path) -> None:
    wave(file)
    run = one(file, "time: {every: {value: 20, unit: ms}}")
    assert run.t[:3] == pytest.approx([0, 0.02, 0.04])


def test_windows_make_a_series_for_each_use(file: Path) -> None:
    wave(file)
    text = (
        "  run: {file: run.csv, time: t, signals: {theta: angle}, "
        "use: {train: [0, 2], validate: [2, 3]}}\n"
    )
    model = model_of(file, text)
    first, second = load_measured(model)
    assert [(m.name, m.series, m.use) for m in (first, second)] == [
        ("run (train)", "run", "train"),
        ("run (validate)", "run", "validate"),
    ]
    assert (len(first.t), second.t[0], second.t[-1]) == (200, 2.0, 3.0), "none is in both"
    assert [m.use for m in load_measured(model, ["validate"])] == ["validate"]


def test_a_window_outside_of_the_record_is_told(file: Path) -> None:
    wave(file)
    assert said(file, "time: t, use: {train: [0, 2], gate: [7, 8]}") == (
        f"{file}:9:3: the series 'run' has 0 samples between 7 and 8 s; the file covers 0 to 3.99 "
        "s. Correct the windows of `use`."
    )


def test_samples_of_the_burn_in_do_not_count(file: Path) -> None:
    wave(file)
    assert one(file, "time: t, burn_in: 1, from: 0.5").counts_from == pytest.approx(1.5)
    assert one(file, "time: t").counts_from == -math.inf
    assert "the series 'run' ends within its burn_in of 5 s. Make burn_in shorter." in said(
        file, "time: t, burn_in: 5"
    )


def test_weights_periods_and_sensors_come_in_si(file: Path) -> None:
    wave(file)
    run = one(
        file,
        "time: t, weight: 2",
        "{column: angle, unit: deg, weight: 3, modulo: 360, gain: {value: 1.1, fit: [0.5, 2]}, "
        "delay: {value: 5, unit: ms}}",
    )
    assert (run.weight, run.weights) == (2, {"theta": 3})
    assert run.periods == {"theta": pytest.approx(2 * math.pi)}
    sensor = run.sensor("theta")
    assert (sensor.offset, sensor.gain, sensor.delay) == (0, 1.1, pytest.approx(0.005))
    assert sensor.free == {"gain": (0.5, 2)}


def test_sizes_are_in_the_unit_of_the_header_where_none_is_declared(file: Path) -> None:
    wave(file, "t,angle [deg],u")
    run = one(
        file,
        "time: t",
        "{column: angle, sigma: 0.1, modulo: 360, offset: {value: 2, fit: [-3, 3]}}",
    )
    assert run.values["theta"][0] == pytest.approx(math.radians(30))
    assert run.sigma == {"theta": pytest.approx(math.radians(0.1))}
    assert run.periods == {"theta": pytest.approx(2 * math.pi)}
    assert run.sensor("theta").offset == pytest.approx(math.radians(2))
    assert run.sensor("theta").free["offset"] == pytest.approx((math.radians(-3), math.radians(3)))
    assert run.steps == ("theta: from deg to rad, as the header says",)


@pytest.mark.parametrize("where", ["diagram", "header"])
def test_a_square_and_a_drift_are_in_the_unit_of_the_column(file: Path, where: str) -> None:
    """y_deg^2/100 in degrees is 1.8/pi y^2 in radians."""
    wave(file, "t,angle [deg],u" if where == "header" else "t,angle,u")
    unit = "unit: deg, " if where == "diagram" else ""
    numbers = "quad: {value: 0.01, fit: [-1, 1]}, drift: {value: 2, fit: [-3, 3]}"
    sensor = one(file, "time: t", f"{{column: angle, {unit}{numbers}}}").sensor("theta")
    assert sensor.quad == pytest.approx(1.8 / math.pi)
    assert sensor.drift == pytest.approx(math.radians(2))
    assert sensor.free["quad"] == pytest.approx((-180 / math.pi, 180 / math.pi))
    assert sensor.free["drift"] == pytest.approx((math.radians(-3), math.radians(3)))


def test_a_drift_goes_on_over_the_windows_of_a_record(file: Path) -> None:
    wave(file)
    use = "{gate: [1, 1.5], train: [0.5, 1]}"
    text = f"  run: {{file: run.csv, time: t, use: {use}, signals: {{theta: angle}}}}"
    gate, train = load_measured(model_of(file, text))
    assert gate.t[0] == 1.0
    assert gate.zero == train.zero == 0.5


def test_an_offset_that_reads_parameters_is_in_si(file: Path) -> None:
    wave(file, "t,angle [deg],u")
    assert one(file, "time: t", "{column: angle, offset: start}").sensor("theta").offset == 0.5


def test_cleaning_is_done_in_its_order_and_told(file: Path) -> None:
    wave(file)
    run = one(
        file,
        "time: t, inputs: {drive: u}, clean: [{resample: 0.02}, {lowpass: {signals: [theta, drive],"
        " cutoff: 10}}, {differentiate: {signal: theta, to: omega, noise: 0.01, sigma: 2}}]",
    )
    assert list(run.values) == ["theta", "omega"]
    inner = slice(20, -20)
    rate = -math.radians(30) * 2 * math.pi * np.sin(2 * math.pi * run.t)
    assert run.values["omega"][inner] == pytest.approx(rate[inner], abs=0.03)
    assert run.inputs["drive"][1][inner] == pytest.approx(run.t[inner], abs=1e-3)
    assert run.sigma["omega"] == pytest.approx(math.radians(2))
    assert [step.partition(",")[0] for step in run.steps] == [
        "resampled every 0.02 s (linear): 200 samples",
        "theta: low pass 10 Hz",
        "input drive: low pass 10 Hz",
        "omega: derivative of theta",
        "input 'drive' is joined by straight lines",
    ]


def test_a_calibrated_signal_has_its_unit_behind_the_calibration(file: Path) -> None:
    wave(file, "t,angle [V],u")
    run = one(file, "time: t, clean: [{calibrate: {signal: theta, gain: 2, offset: -60}}]")
    assert run.values["theta"][0] == pytest.approx(0.0, abs=1e-9)
    assert run.values["theta"][50] == pytest.approx(math.radians(-120))
    assert run.steps == ("theta: calibrated, 2*value - 60 in deg",)


def test_a_step_that_cannot_be_done_is_told_at_its_place(file: Path) -> None:
    wave(file)
    told = said(file, "time: t, clean: [{lowpass: {signals: theta, cutoff: 70}}]")
    assert told.startswith(f"{file}:9:")
    assert told.endswith(
        ": 'lowpass' of series 'run': the cutoff 70 Hz is not below 50 Hz, half the sampling rate. "
        "Give a lower frequency."
    )


def test_rows_in_any_order_are_sorted(file: Path) -> None:
    rows = CSV.splitlines()
    mixed = "\n".join([rows[0], rows[3], rows[1], rows[4], rows[2]])
    (file.parent / "run.csv").write_text(mixed, encoding="utf-8")
    assert "run.csv:3: time goes back to 0, from 1 in line 2; the same in 1 more rows: line 5" in (
        message(model_of(file, PLAIN))
    )
    (run,) = load_measured(model_of(file, PLAIN.replace("time: t", "clean: sort, time: t")))
    assert run.t.tolist() == [0.0, 0.5, 1.0, 1.5]
    assert run.values["theta"] == pytest.approx([0, math.pi / 2, math.pi, -math.pi / 2])
    assert "sorted by time: 2 of 4 rows stood behind a later one" in run.steps


def test_rows_of_one_time_are_refused_at_the_step(file: Path) -> None:
    (file.parent / "run.csv").write_text(CSV + "1.0,170,3\n", encoding="utf-8")
    said = message(model_of(file, PLAIN.replace("time: t", "clean: sort, time: t")))
    assert "'sort' of series 'run': 1 of 5 rows repeat a time of another row: t = 1 s" in said
    assert "Say which row of a time counts: sort: {duplicates: first}" in said


@pytest.mark.parametrize(
    ("header", "theta", "text"),
    [
        (
            "t,angle [m],u",
            "angle",
            "'theta' is in rad in the diagram, and its column 'angle' in m.",
        ),
        ("t,angle,u", "{column: angle, unit: s}", "and its column 'angle' in s. Name another colu"),
        (
            "t,angle [rad],u",
            "{column: angle, unit: deg}",
            "'theta' is declared in 'deg', and",
        ),
    ],
)
def test_a_column_of_another_quantity_is_refused(
    file: Path, header: str, theta: str, text: str
) -> None:
    wave(file, header)
    assert text in said(file, "time: t", theta)


def test_an_input_of_another_quantity_is_refused(file: Path) -> None:
    wave(file, "t,angle,u [V]")
    told = said(file, "time: t, inputs: {drive: u}")
    assert "'input drive' is in N m in the diagram, and its column 'u' in V." in told


def test_a_matlab_file_is_a_series(file: Path) -> None:
    t = np.arange(100) * 0.01
    savemat(file.parent / "run.mat", {"x_F": np.column_stack([t, np.sin(t)]), "t": t})
    text = "  run: {file: run.mat, time: t, signals: {theta: {column: 'x_F[2]', unit: deg}}}\n"
    (run,) = load_measured(model_of(file, text))
    assert run.values["theta"] == pytest.approx(np.radians(np.sin(t)))
