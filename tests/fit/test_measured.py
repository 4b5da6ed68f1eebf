"""Measured series arrive in SI, cut to their windows, and say in words what they lack."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import Model, compile
from tracewire.diagram import read, read_text
from tracewire.errors import DataError
from tracewire.fit import load_measured
from tracewire.fit.measured import measured_signals

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
    assert run.offset == {"theta": pytest.approx(math.radians(2))}
    assert run.free_offsets == {"theta": pytest.approx((math.radians(-3), math.radians(3)))}
    times, values = run.inputs["drive"]
    assert times.tolist() == run.t.tolist()
    assert values == pytest.approx([1e-3, 2e-3, 3e-3, 4e-3])
    assert run.start == {"theta": pytest.approx(math.pi), "omega": None}
    assert (run.name, run.use, run.file) == ("run", "train", str(file.parent / "run.csv"))


def test_a_plain_series_declares_nothing(file: Path) -> None:
    (run,) = load_measured(model_of(file, PLAIN))
    assert run.sigma == {"theta": None}
    assert (run.offset, run.free_offsets, run.inputs, run.start) == ({}, {}, {}, {})


def test_a_window_cuts_signals_and_not_inputs(file: Path) -> None:
    more = "inputs: {drive: u}, from: 0.5, to: 1.0}"
    (run,) = load_measured(model_of(file, PLAIN.rstrip()[:-1] + ", " + more))
    assert run.t.tolist() == [0.5, 1.0]
    assert run.values["theta"] == pytest.approx([math.pi / 2, math.pi])
    assert run.inputs["drive"][0].tolist() == [0.0, 0.5, 1.0, 1.5]


def test_part_gives_rows_of_every_signal(file: Path) -> None:
    (run,) = load_measured(model_of(file, PLAIN))
    assert run.part(slice(1, 3))["theta"] == pytest.approx([math.pi / 2, math.pi])
    assert run.part(np.array([3]))["theta"] == pytest.approx([-math.pi / 2])


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


def test_signals_of_all_series_are_named_once(file: Path) -> None:
    other = PLAIN.replace("run:", "both:").replace("signals: {", "signals: {omega: u, ")
    assert measured_signals(model_of(file, PLAIN, other).diagram) == ("theta", "omega")


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
        ("0.5,90", "0.5,nan", "run.csv:3: column 'angle' is not finite in this row. Leave out"),
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
