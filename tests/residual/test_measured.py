"""Measured series arrive in SI, cut to their windows, and say in words what they lack."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat
from tracewire.compile import Model, compile
from tracewire.diagram import read, read_text
from tracewire.errors import DataError
from tracewire.residual import Measured, load_measured, with_measured_signals

TOP = """\
span: [0, 6]
inputs: {drive: {unit: N m, default: 0}}
parameters: {start: 0.5}
blocks:
  theta: {type: integrator, of: omega, unit: rad}
  omega: {type: integrator, of: drive, unit: rad/s}
presets: {high: {start: 0.75}}
measured:
"""
CSV = "t,angle,u\n0.0,0,1\n0.5,90,2\n1.0,180,3\n1.5,-90,4\n"
FREE = "time: t, start: {theta: free, omega: free}"
PLAIN = "  run: {file: run.csv, time: t, signals: {theta: {column: angle, unit: deg}}}\n"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "run.csv").write_text(CSV, encoding="utf-8")
    return tmp_path / "diagram.yaml"


def model_of(file: Path, *series: str) -> Model:
    file.write_text(TOP + "".join(series), encoding="utf-8")
    return compile(read(file))


def message(model: Model, *uses: str) -> str:
    with pytest.raises(DataError) as caught:
        load_measured(model, uses)
    return str(caught.value)


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


def written(file: Path, content: str) -> None:
    (file.parent / "run.csv").write_text(content, encoding="utf-8")


def wave(file: Path, header: str = "t,angle,u", count: int = 400, step: float = 0.01) -> np.ndarray:
    """A file with a swing of 30 degrees at 1 Hz, in degrees, and a ramp."""
    t = np.arange(count) * step
    rows = (f"{x:.6g},{30 * math.cos(2 * math.pi * x):.6f},{x:.6g}" for x in t)
    written(file, "\n".join([header, *rows]))
    return t


def one(file: Path, more: str = "", theta: str = "{column: angle, unit: deg}") -> Measured:
    comma = ", " if more else ""
    text = f"  run: {{file: run.csv, signals: {{theta: {theta}}}{comma}{more}}}\n"
    (loaded,) = load_measured(model_of(file, text))
    return loaded


def said(file: Path, more: str, theta: str = "{column: angle, unit: deg}") -> str:
    comma = ", " if more else ""
    text = f"  run: {{file: run.csv, signals: {{theta: {theta}}}{comma}{more}}}\n"
    return message(model_of(file, text))


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


# --- remarks ------------------------------------------------------------------------------------


def test_a_record_in_order_has_no_remarks(file: Path) -> None:
    wave(file)
    assert one(file, FREE).remarks == ()


def test_a_record_that_begins_elsewhere_and_names_no_start_is_remarked(file: Path) -> None:
    """A trace looked for what makes up for a start, and named an offset and a constant force."""
    wave(file)
    (remark,) = one(file, "time: t").remarks
    assert remark.startswith("theta begins at 0.5236, and the run is at 0 there (SI): where that")
    shifted = "{column: angle, unit: deg, offset: {value: 30, fit: [0, 60]}}"
    assert one(file, "time: t", shifted).remarks == ()


def noisy(file: Path, header: str) -> None:
    """A file with a swing in degrees whose sensor has a noise of 0.2 degrees."""
    t = np.arange(1000) * 0.01
    angle = 30 * np.cos(2 * np.pi * t) + np.random.default_rng(3).normal(0, 0.2, len(t))
    written(file, "\n".join([header, *(f"{x:.6g},{y:.6f}" for x, y in zip(t, angle, strict=True))]))


def test_a_noise_far_below_the_scatter_of_the_samples_is_remarked(file: Path) -> None:
    """The header alone says that the column is in degrees: the 0.0035 rad were meant in rad."""
    noisy(file, "t,angle [deg]")
    (remark,) = one(file, FREE, "{column: angle, sigma: 0.0035}").remarks
    start, _, rest = remark.partition("rad, and its samples scatter by ")
    assert start == "theta is declared with a noise of sigma = 6.11e-05 "
    assert float(rest.split()[0]) == pytest.approx(np.radians(0.2), rel=0.2)
    assert remark.endswith(
        "sigma is in the unit of the column; correct it, or leave it out to have it estimated"
    )
    assert one(file, FREE, "{column: angle, sigma: 0.1}").remarks == ()


def test_a_noise_above_the_whole_signal_is_remarked(file: Path) -> None:
    noisy(file, "t,angle [deg]")
    (remark,) = one(file, FREE, "{column: angle, sigma: 60}").remarks
    assert "and the whole signal varies by 0.37 rad (rms): sigma is in the unit" in remark
    assert one(file, FREE, "{column: angle, sigma: 10}").remarks == ()


def test_degrees_that_were_taken_for_radians_are_remarked(file: Path) -> None:
    wave(file)
    assert one(file, "time: t", "angle").remarks == (
        "theta goes from -30 to 30 rad: is the column in degrees? Then say unit: deg",
    )
    assert one(file, "time: t", "{column: angle, gain: 160}").remarks == (), "a column of counts"


def test_milliseconds_that_were_taken_for_seconds_are_remarked(file: Path) -> None:
    wave(file, step=10.1)
    (remark,) = one(file, "time: t").remarks
    assert remark == (
        "the record is 4029.9 s long, and the diagram's span 6 s: is the time in ms? "
        "Then say time: {column: ..., unit: ms}"
    )


def test_a_record_beside_a_diagram_that_says_no_span_is_remarked(file: Path) -> None:
    t = wave(file, step=4.1)
    file.write_text((TOP + PLAIN).replace("span: [0, 6]\n", ""), encoding="utf-8")
    (run,) = load_measured(compile(read(file)))
    assert run.remarks == (
        "the diagram says no span, so that a run takes 0 to 1 s, and the record is from 0 to "
        f"{t[-1]:g} s: write span: [0, {t[-1]:g}]",
    )


def test_a_first_sample_far_from_the_begin_is_remarked(file: Path) -> None:
    written(file, "t,angle\n" + "".join(f"{1700000000 + i / 8},{math.sin(i)}\n" for i in range(99)))
    (remark,) = one(file, "time: t").remarks
    assert remark.startswith("the first sample is at t = 1.7e+09 s, far from the begin of the diag")
    assert one(file, "time: {column: t, zero: 1700000000}").remarks == ()


def test_an_angle_from_another_line_is_remarked(file: Path) -> None:
    t = wave(file)
    rows = (f"{x:.6g},{math.pi + 0.1 * math.cos(6 * x):.6f}" for x in t)
    written(file, "\n".join(["t,angle", *rows]))
    (remark,) = one(file, "time: t", "angle").remarks
    assert remark.startswith(
        "theta begins at 3.242 rad, about pi from the diagram's start at 0 rad"
    )


def test_remarks_are_on_the_window_that_is_used(file: Path) -> None:
    t = np.concatenate([np.arange(200), np.arange(300, 500)]) * 0.01
    written(file, "\n".join(["t,angle", *(f"{x:.6g},{math.cos(6 * x):.6f}" for x in t)]))
    assert one(file, FREE).remarks == (
        "a gap in the time, where the step is 0.01 s: 1.01 s after t = 1.99 s",
    )
    assert one(file, f"{FREE}, to: 1.9").remarks == ()


def test_an_input_that_rests_under_a_sign_is_remarked(file: Path) -> None:
    rows = "".join(f"{i / 100:g},0,{max(i - 20, 0) / 100:g}\n" for i in range(100))
    written(file, "t,angle,u\n" + rows)
    text = TOP.replace("of: drive", "of: rub").replace(
        "presets:", "  rub: {type: expression, formula: -sign(drive)}\npresets:"
    )
    series = PLAIN.replace("}}}", "}}, inputs: {drive: u}}")
    file.write_text(text + series, encoding="utf-8")
    (run,) = load_measured(compile(read(file)))
    (remark,) = [remark for remark in run.remarks if "input" in remark]
    assert remark.startswith("the input drive is exactly zero from 0 to 0.2 s: there 'rub' keeps")
