"""`analyse` and `sweep`: each kind on a small diagram, its files, and what it says when wrong."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

KINDS = (
    *("portrait", "polar", "section", "bifurcation", "lyapunov", "floquet", "orbit", "chart"),
    *("growth", "spectrum", "scalogram", "steady", "linearise", "invariants"),
)
FORCED = """\
title: Forced oscillator
span: [0, 40]
every: 0.05
record: [x, energy]
parameters:
  m: {value: 1, unit: kg}
  k: {value: 4, unit: N/m}
  c: {value: 0.4, unit: N s/m}
  f: {value: 0.5, unit: N}
  angle: {value: 60, unit: deg}
  omega: {value: 1.5, unit: rad/s}
blocks:
  x: {type: integrator, of: v, start: 1, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  wave: {type: square, amplitude: f, frequency: omega/(2*pi)}
  a: {type: expression, formula: (wave - k*x - c*v)/m}
  energy: {type: expression, formula: (k*x*x + m*v*v)/2, unit: J}
presets:
  free: {f: 0, c: 0}
"""
MATHIEU = """\
title: Mathieu
span: [0, 40]
record: [y]
parameters: {a: 2, q: 0.2}
blocks:
  y: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: r}
  r: {type: expression, formula: "-(a - 2*q*cos(2*t))*y"}
"""
LORENZ = """\
title: Lorenz
span: [0, 20]
blocks:
  x: {type: integrator, of: dx, start: 1}
  y: {type: integrator, of: dy, start: 1}
  z: {type: integrator, of: dz, start: 20}
  dx: {type: expression, formula: 10*(y - x)}
  dy: {type: expression, formula: x*(28 - z) - y}
  dz: {type: expression, formula: x*y - 8/3*z}
"""


@pytest.fixture
def forced(tmp_path: Path) -> Path:
    (tmp_path / "forced.yaml").write_text(FORCED, encoding="utf-8")
    return tmp_path / "forced.yaml"


@pytest.fixture
def mathieu(tmp_path: Path) -> Path:
    (tmp_path / "mathieu.yaml").write_text(MATHIEU, encoding="utf-8")
    return tmp_path / "mathieu.yaml"


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_help_names_every_kind(call: Any) -> None:
    told = call("analyse", "--help")
    assert told.code == 0
    assert all(f" {kind} " in told.out for kind in KINDS)


@pytest.mark.parametrize("kind", [*(("analyse", kind) for kind in KINDS), ("sweep",)])
def test_each_kind_has_help_and_the_common_options(call: Any, kind: Sequence[str]) -> None:
    told = call(*kind, "--help")
    assert told.code == 0
    options = ("--preset", "--set", "--json", "--output", "--library", "--debug", "Example")
    assert all(option in told.out for option in options)
    assert f"tracewire {' '.join(kind)} " in told.out.partition("Options")[0]


def test_steady(call: Any, forced: Path, tmp_path: Path) -> None:
    told = call("analyse", "steady", forced, "--set", "f=0", "--output", tmp_path / "a.csv")
    assert told.code == 0
    assert "stable; the largest rate that is left is 0" in told.out
    assert [row["state"] for row in rows_of(tmp_path / "a.csv")] == ["x", "v"]
    data = call("analyse", "steady", forced, "--set", "f=0", "--json").data
    assert data["states"] == {"x": 0, "v": 0}
    assert data["eigenvalues"][0] == pytest.approx([-0.2, math.sqrt(4 - 0.04)])


def test_a_driven_diagram_has_no_steady_state(call: Any, forced: Path) -> None:
    told = call("analyse", "steady", forced)
    assert (told.code, told.out) == (1, "")
    assert "change with time by themselves" in told.err
    assert told.err.count("\n") == 1


def test_linearise(call: Any, forced: Path, tmp_path: Path) -> None:
    arguments = ("analyse", "linearise", forced, "--input", "wave", "--signal", "x", "--time", "1")
    data = call(*arguments, "--json", "--output", tmp_path / "m.npz").data
    assert data["A"] == [[0, 1], [-4, -0.4]]
    assert (data["B"], data["C"], data["D"]) == ([[0], [1]], [[1, 0]], [[0]])
    with np.load(tmp_path / "m.npz") as found:
        assert found["A"].tolist() == data["A"]
    assert "rate of" in call(*arguments).out
    at_rest = call(
        *("analyse", "linearise", forced, "--steady", "--set", "f=0", "--json"),
    ).data
    assert at_rest["x"] == [0, 0]
    call(*arguments, "--output", tmp_path / "m.csv")
    assert float(rows_of(tmp_path / "m.csv")[1]["x"]) == -4


def test_orbit_floquet_and_their_figure(call: Any, forced: Path, tmp_path: Path) -> None:
    figure, table = tmp_path / "orbit.svg", tmp_path / "orbit.csv"
    data = call(
        *("analyse", "orbit", forced, "--period", "2*pi/omega", "--skip", "2"),
        *("--figure", figure, "--output", table, "--json"),
    ).data
    assert data["verdict"] == "stable"
    assert data["period"] == pytest.approx(2 * math.pi / 1.5)
    assert data["written"] == [str(table), str(figure)]
    rows = rows_of(table)
    assert float(rows[0]["x"]) == pytest.approx(float(rows[-1]["x"]), abs=1e-8)
    assert "Floquet multipliers" in figure.read_text(encoding="utf-8")
    found = call("analyse", "floquet", forced, "--period", "2*pi/omega", "--json").data
    assert found["multipliers"] == pytest.approx(np.array(data["multipliers"]), abs=1e-6)
    shown = call("analyse", "floquet", forced, "--period", "2*pi/omega").out
    assert "stable" in shown
    assert "exponent [1/s]" in shown


def test_chart_and_its_partial_file(call: Any, mathieu: Path, tmp_path: Path) -> None:
    arguments = [
        *("analyse", "chart", mathieu, "--over", "a=0:5:11", "--over", "q=0:2:5"),
        *("--period", "pi", "--partial", tmp_path / "chart.npz"),
    ]
    told = call(*arguments, "--figure", tmp_path / "chart.png", "--output", tmp_path / "chart.csv")
    assert "of 55 points are unstable" in told.out
    assert len(rows_of(tmp_path / "chart.csv")) == 55
    assert (tmp_path / "chart.png").read_bytes().startswith(b"\x89PNG")
    again = call(*arguments, "--json").data  # from the partial file
    assert np.shape(again["radius"]) == (5, 11)
    other = call(*arguments[:-4], "--period", "2*pi", "--partial", tmp_path / "chart.npz")
    assert other.code == 2
    assert "this is the partial file of another sweep: it differs in options" in other.err


def test_section_and_bifurcation(call: Any, forced: Path, tmp_path: Path) -> None:
    table, figure = tmp_path / "points.csv", tmp_path / "points.png"
    data = call(
        *("analyse", "section", forced, "--edge", "wave", "--skip", "20", "--keep", "30"),
        *("--plane", "x", "v", "--output", table, "--figure", figure, "--json"),
    ).data
    assert (data["points"], data["clusters"], data["irregular"]) == (30, 1, False)
    assert len(rows_of(table)) == 30
    arguments = [
        *("analyse", "bifurcation", forced, "--over", "omega=1:2:5", "--period", "2*pi/omega"),
        *("--skip", "20", "--keep", "8", "--direction", "down_up"),
    ]
    told = call(*arguments, "--output", table, "--figure", figure, "--state", "v")
    assert told.code == 0
    assert "0 of 10 values are irregular" in told.out
    rows = rows_of(table)
    assert len(rows) == 80
    assert {row["direction"] for row in rows} == {"down", "up"}
    assert sorted({float(row["omega"]) for row in rows}) == [1, 1.25, 1.5, 1.75, 2]
    branches = call(*arguments, "--json").data["branches"]
    assert branches["up"]["clusters"] == [1] * 5


def test_lyapunov(call: Any, tmp_path: Path) -> None:
    file = tmp_path / "lorenz.yaml"
    file.write_text(LORENZ, encoding="utf-8")
    arguments = ("analyse", "lyapunov", file, "--length", "60", "--transient", "10", "--seed", "4")
    told = call(*arguments, "--figure", tmp_path / "l.svg", "--output", tmp_path / "l.npz")
    assert "mean divergence -13.6667 1/s, which the sum should be" in told.out
    assert "Lyapunov exponents" in (tmp_path / "l.svg").read_text(encoding="utf-8")
    data = call(*arguments, "--json").data
    assert data["sum"] == pytest.approx(-41 / 3, rel=1e-3)
    assert data == call(*arguments, "--json").data  # repeatable
    with np.load(tmp_path / "l.npz") as found:
        assert found["exponent_1"][-1] == pytest.approx(data["exponents"][0])


def test_the_kinds_of_one_run(call: Any, forced: Path, tmp_path: Path) -> None:
    figure, table = tmp_path / "f.png", tmp_path / "f.csv"
    files = ("--figure", figure, "--output", table, "--json")
    free = (forced, "--preset", "free")
    line = call("analyse", "spectrum", *free[:1], "x", *free[1:], "--lines", "1", *files).data
    assert line["lines"][0]["frequency"] == pytest.approx(1 / math.pi, abs=2e-3)
    assert line["lines"][0]["amplitude"] == pytest.approx(1.0, rel=0.01)
    assert line["unit"] == "m"
    grown = call("analyse", "growth", forced, "x", "--set", "f=0", *files).data
    assert grown["rate"] == pytest.approx(-0.2, abs=1e-3)
    drift = call("analyse", "invariants", *free[:1], "energy", *free[1:], *files).data["drift"]
    assert drift["energy"]["relative"] < 1e-6
    plane = call("analyse", "portrait", forced, "x", "v", "--since", "20", *files).data
    assert plane["samples"] == 401
    polar = call("analyse", "polar", forced, "x", "v", "--every", "0.5", *files).data
    assert polar["samples"] == 81
    assert list(rows_of(table)[0]) == ["t", "x", "v"]
    wavelet = call("analyse", "scalogram", *free[:1], "x", *free[1:], *files).data
    assert wavelet["largest"] == pytest.approx(1.0, rel=0.05)
    for kind in ("spectrum", "growth", "invariants", "scalogram"):
        signal = "energy" if kind == "invariants" else "x"
        told = call("analyse", kind, forced, signal, "--figure", figure)
        assert (told.code, f"written: {figure}" in told.out) == (0, True)


def test_sweep(call: Any, forced: Path, tmp_path: Path) -> None:
    table = tmp_path / "s.csv"
    data = call(
        *("sweep", forced, "--over", "omega=1:2:3", "--over", "start.x=0:1:2"),
        *("--keep", "max(x)", "--keep", "count()", "--since", "10", "--output", table, "--json"),
    ).data
    assert np.shape(data["values"]["max(x)"]) == (3, 2)
    assert len(rows_of(table)) == 6
    figure = tmp_path / "s.png"
    told = call(*("sweep", forced, "--over", "angle=0:90:4 deg", "--keep", "end(v)"),
                *("--figure", figure))  # fmt: skip
    assert "4 runs" in told.out
    assert figure.exists()


@pytest.mark.parametrize(
    ("over", "given"),
    [("omega=1:2:3", ("--set", "omega=1")), ("start.x=0:1:2", ("--start", "x=0"))],
)
def test_what_is_swept_cannot_be_set(
    call: Any, forced: Path, over: str, given: tuple[str, str]
) -> None:
    told = call("sweep", forced, "--over", over, "--keep", "end(x)", *given)
    assert told.code == 2
    assert "is set to one value, and has values in --over. Leave one of the two out." in told.err


@pytest.mark.parametrize("kind", [("chart", "--over", "omega=1:2:2"), ("bifurcation",)])
def test_an_analysis_goes_over_no_value_that_is_set(
    call: Any, forced: Path, kind: tuple[str, ...]
) -> None:
    told = call("analyse", *kind, "--over", "k=1:2:2", "--period", "1", "--set", "k=1", forced)
    assert told.code == 2
    assert "'k' is set to one value, and has values in --over." in told.err


def test_values_that_fail_are_counted(call: Any, tmp_path: Path) -> None:
    file = tmp_path / "root.yaml"
    file.write_text(
        "span: [0, 1]\nrecord: [x]\nparameters: {p: 1}\nblocks:\n"
        "  x: {type: integrator, of: r, start: 1}\n"
        "  r: {type: expression, formula: -p*sqrt(x)}\n",
        encoding="utf-8",
    )
    told = call("sweep", file, "--over", "p=1:9:2", "--keep", "end(x)")
    assert told.code == 0
    assert "1 point failed; the first of them, at p = 9: " in told.out
    told = call("sweep", file, "--over", "p=8:9:2", "--keep", "end(x)")
    assert told.code == 1
    assert "'x' is not finite" in told.err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["steady", "--preset", "fre"], "unknown preset 'fre'; there are: free"),
        (["steady", "--set", "K=1"], "unknown parameter 'K'"),
        (["steady", "--start", "y=1"], "unknown state 'y'"),
        (["orbit", "--period", "2*pi/w"], "unknown parameter 'w'"),
        (["orbit", "--period", "0"], "a period of 0 s has no use"),
        (["orbit", "--period", "4", "--plane", "x", "y"], None),
        (["floquet"], "Missing option '--period'"),
        (["floquet", "--period", "2*"], "2*"),
        (["chart", "--over", "k=1:2:3", "--period", "1"], "--over names 1 parameter, and a chart"),
        (["chart", "--over", "k=1:2", "--period", "1"], "is not a name, '=' and FROM:TO:COUNT"),
        (["chart", "--over", "k=1:2:0", "--period", "1"], "has no values. Give a COUNT"),
        (["section"], "a section needs one of a period, an edge and a guard"),
        (["section", "--edge", "wav"], "unknown signal 'wav'"),
        (["section", "--period", "1", "--crosses", "side"], "unknown direction 'side'"),
        (["bifurcation", "--over", "k=1:2:3", "--period", "1", "--direction", "left"], "'left'"),
        (["bifurcation", "--over", "start.x=1:2:3", "--period", "1"], "goes over a parameter"),
        (["lyapunov", "--length", "-1"], "are too few to average"),
        (["spectrum", "z"], "unknown signal 'z'"),
        (["spectrum", "x", "--window", "none"], "unknown window 'none'"),
        (["spectrum", "x", "--every", "0"], "an output every 0 s from 0 to 40 s cannot be kept"),
        (["growth", "x", "--by", "hand"], "unknown envelope 'hand'"),
        (["scalogram", "x", "--low", "9", "--high", "3"], "frequencies from 9 to 3 Hz"),
        (["invariants", "z"], "unknown signal 'z'"),
        (["portrait", "x", "z"], "unknown signal 'z'"),
        (["portrait", "x", "v", "--since", "99"], "there is no sample from 99 s on"),
        (["steady", "--output", "a.xls"], "unknown file ending '.xls'"),
        (["portrait", "x", "v", "--figure", "a.jpg"], "unknown file ending '.jpg'"),
        (["linearise", "--input", "w"], "unknown input 'w'"),
    ],
)
def test_a_wrong_argument_is_told_in_one_line(
    call: Any, forced: Path, tmp_path: Path, arguments: list[str], said: str | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    if said is None:
        arguments, said = [*arguments, "--figure", "a.png"], "unknown state 'y'"
    told = call("analyse", arguments[0], forced, *arguments[1:])
    assert told.code == 2
    assert told.out == ""
    assert said in told.err
    assert told.err.count("\n") == 1


def test_an_error_is_json_too(call: Any, forced: Path) -> None:
    told = call("analyse", "steady", forced, "--json")
    assert told.code == 1
    assert "change with time" in told.data["error"][0]["what"]


def test_a_deviation_that_is_lost_is_told(call: Any, tmp_path: Path) -> None:
    file = tmp_path / "stiff.yaml"
    file.write_text(
        "span: [0, 1]\nblocks:\n  x: {type: integrator, of: a, start: 1}\n"
        "  y: {type: integrator, of: b, start: 1}\n  a: {type: expression, formula: -x}\n"
        "  b: {type: expression, formula: -500*y}\n",
        encoding="utf-8",
    )
    arguments = ("analyse", "lyapunov", file, "--length", "20")
    assert "-inf: lost where something sticks" in call(*arguments, "--interval", "0.4").out
    assert "-inf" not in call(*arguments, "--interval", "0.02").out
    assert call(*arguments, "--interval", "0.4", "--json").data["exponents"][1] is None
