"""Series from files beside a diagram: their columns by name or by template, and the way back."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import Diagram, difference, read, with_series_of
from tracewire.diagram import write as write_diagram
from tracewire.diagram.edit_sensors import add_sensor
from tracewire.diagram.edit_values import set_values
from tracewire.errors import DataError, OptionError
from tracewire.residual import Measured, load_measured, series_from_files
from tracewire.residual.endings import endings

BARE = """\
title: Driven pendulum   # of the lab
span: [0, 6]
inputs: {u: {unit: N m}}
parameters: {k: {value: 4, fit: [0, 9]}}
blocks:
  theta: {type: integrator, of: omega, unit: rad}
  omega: {type: integrator, of: torque, unit: rad/s}
  pull: {type: gain, of: theta, k: -k}
  wave: {type: sine, amplitude: 1, omega: 6}
  torque: {type: sum, of: [pull, u]}
"""
SERIES = """\
measured:   # in degrees
  first:
    file: first.csv   # the long one
    use: {train: [0, 1e-3]}
    time: {column: clock, unit: ms}
    signals: {theta: {column: angle, unit: deg, offset: {value: 2, fit: [-5, 5]}}}
    inputs: {u: drive}
    start: {theta: 0.3, omega: free}
  second: {file: second.csv, time: t, from: 0.5, signals: {omega: rate}, inputs: {u: u}}
"""


def write(file: Path, header: str = "t,theta,u", scale: float = 1.0) -> Path:
    rows = [f"{0.1 * n:.1f},{scale * n / 10},{n % 3}" for n in range(21)]
    file.write_text("\n".join([header, *rows, ""]), encoding="utf-8")
    return file


def diagram_of(folder: Path, text: str = BARE) -> Diagram:
    (folder / "d.yaml").write_text(text, encoding="utf-8")
    return read(folder / "d.yaml")


def attached(folder: Path, text: str = BARE, **files: list[Path]) -> tuple[Measured, ...]:
    diagram, _ = series_from_files(diagram_of(folder, text), files)
    return load_measured(compile(diagram))


def refused(folder: Path, text: str = BARE, **files: list[Path]) -> str:
    with pytest.raises(DataError) as caught:
        series_from_files(diagram_of(folder, text), files)
    return str(caught.value)


def test_columns_are_found_by_their_names(tmp_path: Path) -> None:
    a, b = write(tmp_path / "run a.csv"), write(tmp_path / "b.csv", "time,omega,u,theta")
    b.write_text("omega,time,u\n1,0,3\n2,1,4\n", encoding="utf-8")
    one, two = attached(tmp_path, train=[a], validate=[b])
    assert (one.name, one.use, two.name, two.use) == ("run a", "train", "b", "validate")
    assert one.values["theta"][10] == pytest.approx(1.0)
    assert one.inputs["u"][1][:4] == pytest.approx([0, 1, 2, 0])
    assert two.t.tolist() == [0, 1]
    assert {name: v.tolist() for name, v in two.values.items()} == {"omega": [1, 2]}
    assert one.start == two.start == {"theta": None, "omega": None}


@pytest.mark.parametrize(
    ("header", "factor"),
    [
        ("t,theta [deg],u", math.pi / 180),
        ("t_s,theta_deg,u", math.pi / 180),
        ("Time (s),theta_mrad,u_mNm", 1e-3),
        ("seconds,theta_rad,u_N_m", 1.0),
    ],
)
def test_units_of_headers_and_names(tmp_path: Path, header: str, factor: float) -> None:
    header = header.replace("u_N_m", "u")
    diagram, remarks = series_from_files(
        diagram_of(tmp_path), {"train": [write(tmp_path / "a.csv", header)]}
    )
    (run,) = load_measured(compile(diagram))
    assert run.values["theta"][10] == pytest.approx(factor)
    assert run.inputs["u"][1][1] == pytest.approx(1e-3 if "mNm" in header else 1.0)
    told = "taken in" in " ".join(remarks)
    assert told == any(f"_{unit}" in header for unit in ("deg", "mrad", "rad"))


def test_endings_of_names() -> None:
    assert dict(endings("x_1_mm_s")) == {"x_1_mm": "s", "x_1": "mm/s"}
    assert dict(endings("omega_rad_per_s"))["omega"] == "rad/s"
    assert dict(endings("a_m_s2"))["a"] == "m/s^2"
    assert dict(endings("omega_dps")) == {"omega": "deg/s"}
    assert not list(endings("theta_ref"))


def test_an_ending_of_another_quantity_is_part_of_the_name(tmp_path: Path) -> None:
    assert "no column is named as a signal" in refused(
        tmp_path, train=[write(tmp_path / "a.csv", "t,theta_N,u")]
    )


def test_what_is_not_used_is_told(tmp_path: Path) -> None:
    file = write(tmp_path / "a.csv", "t,theta,u")
    file.write_text("t,theta,temp,u,wave\n0,1,2,3,4\n1,1,2,3,5\n", encoding="utf-8")
    _, remarks = series_from_files(diagram_of(tmp_path), {"train": [file]})
    assert remarks == ("a.csv: not used: the columns temp, wave",)  # a source responds to nothing


def test_an_input_with_a_default_needs_no_column(tmp_path: Path) -> None:
    text = BARE.replace("{unit: N m}", "{unit: N m, default: 0}")
    file = write(tmp_path / "a.csv", "t,theta,x")
    _, remarks = series_from_files(diagram_of(tmp_path, text), {"train": [file]})
    assert "a.csv: no column is the input 'u': its default counts" in remarks


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ("t,theta,x", "no column is the input 'u' of the diagram, which has no default; there are"),
        ("x,theta,u", "no column is the time; there are: x, theta, u. Call it 't' or 'time'"),
        ("t,angle,u", "no column is named as a signal of the diagram; there are: t, angle, u. The"),
        ("0,1,2", "the file has no header. Write the names of the columns above the numbers."),
    ],
)
def test_messages_of_columns(tmp_path: Path, header: str, message: str) -> None:
    file = write(tmp_path / "a.csv", header)
    text = refused(tmp_path, train=[file])
    assert message in text
    assert str(file) in text


def test_messages_of_files(tmp_path: Path) -> None:
    a = write(tmp_path / "a.csv")
    assert "files are given, and none of them to train on" in refused(tmp_path, validate=[a])
    assert "the file is given for train and validate. Data that a fit has seen" in refused(
        tmp_path, train=[a], validate=[tmp_path / "." / "a.csv"]
    )
    assert "the file is given for train twice" in refused(tmp_path, train=[a, a])
    assert "unknown file 'c.csv' in " in refused(tmp_path, train=[a, tmp_path / "c.csv"])
    with pytest.raises(OptionError, match="unknown use 'test'; there are: gate, train, validate"):
        series_from_files(diagram_of(tmp_path), {"test": [a]})


def template(folder: Path) -> Diagram:
    write(folder / "first.csv", "clock,angle,drive")
    write(folder / "second.csv", "t,rate,u")
    return diagram_of(folder, BARE + SERIES)


def test_the_first_series_of_the_diagram_tells_the_columns(tmp_path: Path) -> None:
    other = write(tmp_path / "other.csv", "clock,angle,drive")
    diagram, remarks = series_from_files(template(tmp_path), {"train": [other]})
    (run,) = load_measured(compile(diagram))
    assert (run.name, run.use, len(run.t)) == ("other", "train", 21)
    assert run.t[-1] == pytest.approx(0.002)
    assert run.values["theta"][10] == pytest.approx(math.pi / 180)
    assert run.sensor("theta").offset == pytest.approx(math.radians(2))
    assert run.sensor("theta").free["offset"] == pytest.approx((-math.radians(5), math.radians(5)))
    assert run.start == {"theta": None, "omega": None}
    assert remarks == ("other.csv: the start is free",)


def test_the_series_that_has_the_columns_of_a_file_tells_them(tmp_path: Path) -> None:
    other = write(tmp_path / "other.csv", "t,rate,u")
    diagram, _ = series_from_files(template(tmp_path), {"train": [other]})
    (run,) = load_measured(compile(diagram))
    assert list(run.values) == ["omega"]
    assert run.t[0] == 0.0  # not the `from` of another file


def test_the_series_of_the_same_file_counts_whole(tmp_path: Path) -> None:
    known = template(tmp_path)
    files = {"train": [tmp_path / "second.csv"], "validate": [tmp_path / "first.csv"]}
    diagram, _ = series_from_files(known, files)
    second, first = load_measured(compile(diagram))
    assert list(second.values) == ["omega"]
    assert (second.t[0], len(second.t)) == (0.5, 16)  # `from` is of this file
    assert (first.use, len(first.t), first.start["theta"]) == ("validate", 21, None)


def test_columns_of_the_template_must_be_there(tmp_path: Path) -> None:
    other = write(tmp_path / "other.csv", "clock,angel,drive")
    with pytest.raises(DataError) as caught:
        series_from_files(template(tmp_path), {"train": [other]})
    assert "other.csv: unknown column 'angle'; there are: angel, clock, drive." in str(caught.value)
    assert "The series 'first' of the diagram tells the columns" in str(caught.value)


def test_files_of_one_name_and_odd_names(tmp_path: Path) -> None:
    (tmp_path / "x y").mkdir()
    files = [write(tmp_path / "run.csv"), write(tmp_path / "x y" / "run.csv")]
    runs = attached(tmp_path, train=files)
    assert [run.name for run in runs] == ["run", "run (2)"]
    odd = write(tmp_path / "2024: a #1.csv", 't [s],"theta [deg]",u')
    (run,) = attached(tmp_path, train=[odd])
    assert run.name == "2024: a #1"


def test_an_edit_goes_back_into_a_diagram_without_series(tmp_path: Path) -> None:
    own = diagram_of(tmp_path)
    diagram, _ = series_from_files(own, {"train": [write(tmp_path / "a.csv")]})
    back = with_series_of(set_values(diagram, {"k": 5.0}), own)
    assert back.text == BARE.replace("value: 4", "value: 5")
    assert with_series_of(diagram, own).text == BARE
    bare = diagram_of(tmp_path, BARE.rstrip())
    diagram, _ = series_from_files(bare, {"train": [tmp_path / "a.csv"]})
    assert with_series_of(diagram, bare).text == BARE.rstrip()


def test_a_sensor_needs_the_series_in_the_diagram(tmp_path: Path) -> None:
    own = diagram_of(tmp_path)
    diagram, _ = series_from_files(own, {"train": [write(tmp_path / "a.csv")]})
    back = with_series_of(add_sensor(diagram, "theta", "gain", 1.1, (0.5, 2)), own)
    added = back.text.removeprefix(BARE)
    assert added.startswith("measured:\n  a: {file: a.csv, use: train, time: t, ")
    assert "theta: {column: theta, gain: {value: 1.1, fit: [0.5, 2]}}" in added
    other = tmp_path / "elsewhere" / "d.yaml"
    other.parent.mkdir()
    moved = with_series_of(add_sensor(diagram, "theta", "gain", 1.1, (0.5, 2)), own, other)
    write_diagram(moved, other)
    assert read(other).measured["a"].file.samefile(tmp_path / "a.csv")


def test_an_edit_goes_back_into_a_diagram_with_series(tmp_path: Path) -> None:
    own = template(tmp_path)
    other = write(tmp_path / "other.csv", "clock,angle,drive")
    diagram, _ = series_from_files(own, {"train": [other]})
    assert with_series_of(diagram, own).text == own.text
    edited = set_values(diagram, {"k": 5.0})
    edited = add_sensor(edited, "theta", "drift", math.radians(0.5), (-1, 1))
    back = with_series_of(edited, own)
    changed = [line for line in difference(own, back).splitlines()[2:] if line[0] in "+-"]
    assert len(changed) == 4
    assert changed[1] == "+parameters: {k: {value: 5, fit: [0, 9]}}"
    assert "drift: {value: 0.5, fit: [" in changed[3]
    assert "offset: {value: 2, fit: [-5, 5]}" in changed[3]


def test_lists_in_braces_and_crlf_stay(tmp_path: Path) -> None:
    write(tmp_path / "first.csv")
    section = "measured: {first: {file: first.csv, time: t, signals: {theta: theta}}}\n"
    text = (BARE + section).replace("\n", "\r\n")
    (tmp_path / "d.yaml").write_bytes(text.encode())
    own = read(tmp_path / "d.yaml")
    assert own.text == text
    with pytest.raises(DataError, match="no column is the input 'u'"):
        series_from_files(own, {"train": [tmp_path / "first.csv"]})
    text = text.replace("theta: theta}", "theta: theta}, inputs: {u: u}")
    (tmp_path / "d.yaml").write_bytes(text.encode())
    own = read(tmp_path / "d.yaml")
    diagram, _ = series_from_files(own, {"train": [tmp_path / "first.csv"]})
    assert with_series_of(diagram, own).text == text


def test_values_stay_what_they_are(tmp_path: Path) -> None:
    diagram, _ = series_from_files(
        diagram_of(tmp_path), {"train": [write(tmp_path / "a.csv", scale=2.0)]}
    )
    (run,) = load_measured(compile(diagram))
    assert np.array_equal(run.values["theta"], [2.0 * n / 10 for n in range(21)])
