from __future__ import annotations

import math
from pathlib import Path

import pytest
from diagram.small_library import made, refused
from tracewire.diagram import Series
from tracewire.diagram.edit_sensors import add_sensor

TOP = """
inputs: {drive: {unit: N m, default: 0}}
parameters: {k: 2}
blocks:
  theta: {type: integrator, of: omega}
  omega: {type: integrator, of: drive}
  o: {type: oscillator}
  b: {type: s}
subsystems:
  s: {outputs: {y: x}, blocks: {x: {type: integrator, of: x}, o: {type: oscillator}}}
presets: {printed: {k: 3}}
measured:
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "run.csv").write_text("t,angle\n0,1\n1,2\n")
    return tmp_path / "diagram.yaml"


def test_a_series_becomes_a_noun_in_si(file: Path) -> None:
    text = """\
  run:
    file: run.csv
    use: gate
    time: t
    signals:
      theta: {column: angle, unit: deg, sigma: 0.1, offset: {fit: [-1, 1]}}
      b: other
    inputs: {drive: {column: u, unit: mN m, sigma: 5, hold: previous}}
    start: {theta: free, omega: {value: 180, unit: deg}, o.v: k, b.x: 1, b.o.x: free}
    preset: printed
    from: 2.0
    to: 1e1
"""
    series = made(TOP + text, file).measured["run"]
    assert (series.file, series.use) == (file.parent / "run.csv", "gate")
    assert (series.time.column, series.time.unit, series.time.every) == ("t", None, None)
    assert (series.begin, series.end, series.preset) == (2.0, 10.0, "printed")
    theta, other = series.channels["theta"], series.channels["b.y"]
    degree = math.pi / 180
    assert (theta.column, theta.unit, theta.factor) == ("angle", "rad", pytest.approx(degree))
    assert theta.sigma == pytest.approx(0.1 * degree)
    assert theta.offset is not None
    assert theta.offset.named
    assert theta.offset.factor == theta.factor
    assert theta.offset.fit == pytest.approx((-degree, degree))
    assert (other.column, other.factor, other.sigma) == ("other", 1.0, None)
    drive = series.inputs["drive"]
    assert (drive.factor, drive.sigma) == (pytest.approx(1e-3), pytest.approx(5e-3))
    assert (drive.hold, theta.hold) == ("previous", None)
    assert list(series.start) == ["theta", "omega", "o.v", "b.x", "b.o.x"]
    assert series.start["theta"] is None
    assert series.start["omega"].factor == pytest.approx(degree)


def test_the_plainest_series(file: Path) -> None:
    text = "  run: {file: run.csv, time: 1, signals: {theta: 2}}"
    series = made(TOP + text, file).measured["run"]
    assert (series.use, series.time.column) == ("train", "1")
    assert series.channels["theta"].column == "2"
    assert (series.weight, series.burn_in, series.clean, series.where) == (1.0, 0.0, (), {})


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("file: run.csv, ", "", "series 'run' needs 'file'. Write file: ..."),
        ("time: t, ", "", "series 'run' needs 'time'"),
        (", signals: {theta: angle}", "", "series 'run' needs 'signals'"),
        ("run.csv", "'.'", "is a folder; there are: run.csv. Name a file in it."),
        ("time: t", "time: t, tim: t", "unknown key of a series 'tim'; there are: burn_in, clean"),
        ("time: t", "time: [t]", "'time' must be a text"),
        ("time: t", "time: t, use: training", "unknown use 'training'; there are: gate, train"),
        ("time: t", "time: t, preset: prnted", "unknown preset 'prnted'; there are: printed."),
        ("time: t", "time: t, from: a", "'from' of series 'run' must be a number, not 'a'"),
        ("time: t", "time: t, from: 3, to: 2", "series 'run' ends at 2, not after its begin at 3"),
        ("{theta: angle}", "{}", "series 'run' has no signals"),
        ("{theta: angle}", "[theta]", "'signals' of series 'run' must be a mapping"),
        ("{theta: angle}", "{thet: angle}", "unknown signal 'thet'; there are: b, b.o.force"),
        ("{theta: angle}", "{theta: a, theta.y: b}", "two definitions of the signal 'theta.y'"),
        ("{theta: angle}", "{theta: [a]}", "'theta' of series 'run' must be a mapping"),
        ("{theta: angle}", "{theta: {unit: m}}", "'theta' of series 'run' needs 'column'"),
        ("{theta: angle}", "{theta: {column: a, sgma: 1}}", "unknown key of a measured signal 'sg"),
        ("{theta: angle}", "{theta: {column: a, sigma: 0}}", "'sigma' must be above zero, not 0"),
        ("{theta: angle}", "{theta: {column: a, sigma: k}}", "'sigma' must be a number, not 'k'"),
        ("{theta: angle}", "{theta: {column: a, offset: {fit: 3}}}", "the bounds of a fit are two"),
        ("time: t", "time: t, inputs: {u: v}", "unknown input 'u'; there are: drive."),
        (
            "time: t",
            "time: t, inputs: {drive: {column: u, sgma: 1}}",
            "unknown key of a measured input 'sgma'; there are: column, hold, sigma, unit.",
        ),
        (
            "time: t",
            "time: t, inputs: {drive: {column: u, sigma: 0}}",
            "'sigma' must be above zero, not 0",
        ),
        (
            "time: t",
            "time: t, inputs: {drive: {column: u, hold: next}}",
            "unknown hold 'next'; there are: linear, previous, smooth. previous: each value acts",
        ),
        ("time: t", "time: t, start: {o: 1}", "unknown state 'o'; there are: b.o.v, b.o.x, b.x"),
        ("time: t", "time: t, start: {theta: fre}", "unknown parameter 'fre'"),
        ("{file", "[file", "this is not YAML"),
    ],
)
def test_messages(file: Path, old: str, new: str, message: str) -> None:
    text = "  run: {file: run.csv, time: t, signals: {theta: angle}}"
    assert old in text
    assert message in refused(TOP + text.replace(old, new), file)


def test_measured_is_a_mapping_of_mappings(file: Path) -> None:
    assert "'measured' must be a mapping" in refused(TOP.rstrip() + " [run]", file)
    assert "series 'run' must be a mapping" in refused(TOP + "  run: run.csv", file)


def series_of(text: str, file: Path) -> Series:
    return made(TOP + text, file).measured["run"]


def test_every_key_of_a_series(file: Path) -> None:
    text = """\
  run:
    file: run.csv
    format: {delimiter: tab, decimal: ",", comment: "%"}
    where: {ball: Golf Ball, drop: 1}
    use: {train: [0, 30], validate: [30, {value: 40000, unit: ms}]}
    time: {column: t, unit: ms, zero: 410}
    burn_in: {value: 500, unit: ms}
    weight: 2
    signals:
      theta:
        column: angle
        unit: deg
        weight: 3
        modulo: 360
        gain: {fit: [0.5, 2]}
        delay: {value: 5, unit: ms, fit: [0, 20]}
    inputs: {drive: u}
    clean:
      - trim: {from: 1, to: 39}
      - outliers: {signals: [theta, drive], width: 7, limit: 4}
      - resample: {every: {value: 10, unit: ms}, method: spline}
      - calibrate: {signal: theta, gain: 36.9, offset: -1.79}
      - detrend: theta
      - lowpass: {signals: theta, cutoff: 20}
      - differentiate: {signal: theta, to: omega, noise: 0.1, sigma: 2}
    start: {theta: free}
"""
    series = series_of(text, file)
    assert (series.format.delimiter, series.format.decimal, series.format.comment) == (
        "\t",
        ",",
        "%",
    )
    assert series.where == {"ball": "Golf Ball", "drop": 1.0}
    assert (series.use, series.windows) == ("train", {"train": (0, 30), "validate": (30, 40)})
    assert (series.time.column, series.time.unit, series.time.zero) == ("t", "ms", 410)
    assert (series.burn_in, series.weight) == (0.5, 2)
    theta, degree = series.channels["theta"], math.pi / 180
    assert (theta.weight, theta.declared, theta.modulo) == (3, "deg", pytest.approx(2 * math.pi))
    assert theta.gain is not None and theta.gain.fit == (0.5, 2)
    assert theta.delay is not None and theta.delay.fit == pytest.approx((0, 0.02))
    assert theta.delay.factor == pytest.approx(1e-3)
    made_of = series.channels["omega"]
    assert (made_of.column, made_of.sigma) == ("", pytest.approx(2 * degree))
    assert [(step.step, step.options) for step in series.clean] == [
        ("trim", {"from": 1, "to": 39}),
        ("outliers", {"signals": ("theta", "input drive"), "width": 7, "limit": 4}),
        ("resample", {"every": pytest.approx(0.01), "method": "spline"}),
        ("calibrate", {"signal": "theta", "gain": 36.9, "offset": -1.79}),
        ("detrend", {"signals": ("theta",)}),
        ("lowpass", {"signals": ("theta",), "cutoff": 20}),
        ("differentiate", {"signal": "theta", "to": "omega", "noise": 0.1}),
    ]


@pytest.mark.parametrize(
    ("clean", "options"),
    [
        ("sort", {}),
        ("[sort]", {}),
        ("[{sort: mean}]", {"duplicates": "mean"}),
        ("[{sort: {duplicates: last}}]", {"duplicates": "last"}),
    ],
)
def test_rows_may_be_sorted(clean: str, options: dict[str, str], file: Path) -> None:
    text = f"  run: {{file: run.csv, time: t, signals: {{theta: angle}}, clean: {clean}}}"
    (step,) = series_of(text, file).clean
    assert (step.step, step.options) == ("sort", options)


def test_a_file_without_a_column_of_time(file: Path) -> None:
    text = "  run: {file: run.csv, time: {every: {value: 10, unit: ms}}, signals: {theta: angle}}"
    assert series_of(text, file).time.every == pytest.approx(0.01)
    assert series_of(text.replace("{value: 10, unit: ms}", "2"), file).time.every == 2


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("time: {}", "'time' needs 'column'. Write column: ..."),
        ("time: {column: t, every: 1}", "the time has 'every' or 'column', and not both. Take one"),
        ("time: {column: t, zeros: 1}", "unknown key of a time 'zeros'; there are: column, every"),
        ("time: {column: t, unit: mm}", "'mm' is not a unit like 's'."),
        ("time: {column: t, zero: a}", "'zero' must be a number, not 'a'"),
        ("time: {every: 0}", "'every' must be above zero, not 0. It is the time from one row to"),
        ("time: {every: {value: 1, unit: V}}", "'V' is not a unit like 's'."),
        ("time: {every: {unit: ms}}", "'every' needs 'value'"),
        ("time: t, weight: 0", "'weight' of series 'run' must be above zero, not 0"),
        ("time: t, burn_in: -1", "'burn_in' of series 'run' must not be negative, and is -1"),
        ("time: t, where: drop", "'where' of series 'run' must be a mapping. Write it like {ball:"),
        ("time: t, where: {drop: [1]}", "'drop' of 'where' must be a text or a number"),
        ("time: t, format: ;", "'format' of series 'run' must be a mapping"),
        ("time: t, format: {decimal: x}", "'decimal' is '.' or ','. Put it into quotes."),
        (
            "time: t, format: {delimiter: xy}",
            "'delimiter' is one character. Write ';', ',', tab or",
        ),
        ("time: t, format: {sep: x}", "unknown key of a format 'sep'; there are: comment, decimal"),
        ("time: t, use: {training: [0, 1]}", "unknown use 'training'; there are: gate, train, val"),
        ("time: t, use: {train: 3}", "a window is a pair of times. Write it like use: {train: [0,"),
        (
            "time: t, use: {train: [[0, 1], [3, 4]], validate: [1, 3]}",
            "a series has one window for 'train', a pair of times. Name the file in a series more",
        ),
        ("time: t, use: {train: [3, 2]}", "the window ends at 2, not after its begin at 3"),
        (
            "time: t, use: {train: [0, 3], validate: [2, 4]}",
            "the windows 'train' and 'validate' overlap. No sample may be used for both.",
        ),
        (
            "time: t, from: 1, use: {train: [0, 3]}",
            "series 'run' has windows under 'use', and 'from' beside them. Give the times in the",
        ),
        (
            "time: t, use: {train: [0, 3], gate: [3, 4]}, start: {theta: 1}",
            "the start value of 'theta' holds at one time, and there are several windows. "
            "Write start: {theta: free}.",
        ),
    ],
)
def test_messages_on_keys(file: Path, more: str, message: str) -> None:
    text = f"  run: {{file: run.csv, {more}, signals: {{theta: angle}}}}"
    assert message in refused(TOP + text, file)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("weight: 0", "'weight' must be above zero, not 0. It counts the signal more or less than"),
        ("modulo: -360", "'modulo' must be above zero, not -360. It is the period in the unit of"),
        ("gain: 0", "a gain of 0 shows nothing of the signal. It is the number that the signal"),
        ("gain: {value: 1, unit: deg, fat: 2}", "unknown key of a value 'fat'"),
        ("gain: {value: 1, unit: m}", "'m' is not a unit like '1'."),
        (
            "gain: {fit: [2, 3]}",
            "the gain begins at 1, outside of its bounds 2 to 3. Give a 'value'",
        ),
        ("delay: {value: 1, unit: m}", "'m' is not a unit like 's'."),
        ("delay: {fit: [1, 2]}", "the delay begins at 0, outside of its bounds 1 to 2."),
        ("offset: {fit: [1, 2]}", "the offset begins at 0, outside of its bounds 1 to 2."),
        ("offset: {value: 5, fit: [1, 2]}", "the value 5 is outside of its bounds 1 to 2"),
    ],
)
def test_messages_on_channels(file: Path, given: str, message: str) -> None:
    text = f"  run: {{file: run.csv, time: t, signals: {{theta: {{column: a, {given}}}}}}}"
    assert message in refused(TOP + text, file)


@pytest.mark.parametrize(
    ("clean", "message"),
    [
        ("{detrend: theta}", "'clean' must be a list of steps. Write it like [{resample:"),
        ("[detrend]", "a step of 'clean' has one name. Write a list like [{resample:"),
        ("[{detrend: theta, trim: 2}]", "a step of 'clean' has one name"),
        ("[{detrend: theta}, sort]", "'sort' comes before all other steps. Write it as the first"),
        ("[{sort: {duplicates: any}}]", "unknown word for 'duplicates' of 'sort' 'any'; there are"),
        ("[{detrnd: theta}]", "unknown step of 'clean' 'detrnd'; there are: calibrate, detrend,"),
        ("[{detrend: thet}]", "unknown measured signal 'thet'; there are: drive, theta. Did you"),
        ("[{detrend: omega}]", "unknown measured signal 'omega'; there are: drive, theta."),
        ("[{detrend: {signals: theta, ordr: 1}}]", "unknown option of 'detrend' 'ordr'; there are"),
        (
            "[{detrend: {signals: theta, order: 1.5}}]",
            "'order' of 'detrend' must be a whole number",
        ),
        ("[{detrend: {order: 1}}]", "'detrend' needs 'signals'. Write signals: ..."),
        ("[{lowpass: theta}]", "'lowpass' needs 'cutoff'. Write cutoff: ..."),
        ("[{lowpass: {signals: theta, cutoff: fast}}]", "'cutoff' of 'lowpass' must be a number"),
        ("[{resample: {every: {value: 1, unit: m}}}]", "'m' is not a unit like 's'."),
        ("[{resample: {every: 1, method: cubic}}]", "unknown word for 'method' of 'resample' 'cub"),
        (
            "[{differentiate: {signal: theta, to: o}}]",
            "unknown signal 'o'; there are: b, b.o.force",
        ),
        (
            "[{differentiate: {signal: theta, to: theta}}]",
            "'theta' is measured already. Take it out",
        ),
        (
            "[{differentiate: {signal: theta, to: omega, noise: 0}}]",
            "'noise' of 'differentiate' mus",
        ),
        (
            "[{calibrate: {signal: theta}}, {calibrate: {signal: theta}}]",
            "'theta' is calibrated twi",
        ),
    ],
)
def test_messages_on_cleaning(file: Path, clean: str, message: str) -> None:
    text = (
        "  run: {file: run.csv, time: t, signals: {theta: angle}, inputs: {drive: u}, "
        f"clean: {clean}}}"
    )
    assert message in refused(TOP + text, file)


def test_a_signal_that_a_step_made_can_be_used_by_the_next(file: Path) -> None:
    text = (
        "  run: {file: run.csv, time: t, signals: {theta: angle}, clean: "
        "[{differentiate: {signal: theta, to: omega}}, {detrend: omega}]}"
    )
    series = series_of(text, file)
    assert list(series.channels) == ["theta", "omega"]
    assert series.clean[1].options == {"signals": ("omega",)}


def test_an_offset_is_written_in_the_unit_of_the_header(file: Path) -> None:
    (file.parent / "run.csv").write_text("t,angle [deg]\n0,1\n1,2\n")
    text = TOP + "  run: {file: run.csv, time: t, signals: {theta: angle}}\n"
    edited = add_sensor(made(text, file), "theta", "offset", math.radians(2.0))
    assert "signals: {theta: {column: angle, offset: {value: 2}}}" in edited.text
