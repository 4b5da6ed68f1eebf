"""`fit`: what it prints, what it writes, and what it says when the input is wrong."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tracewire.diagram import read

ROOT = Path(__file__).parents[2]
TORSION = ROOT / "diagrams" / "papers" / "a_torsion" / "pendulum.yaml"

DECAY = """\
# a charge that leaks away
title: Decay
span: [0, 2]   # s
parameters:
  rate: {value: 1.0, unit: 1/s, fit: [0, 10]}   # to be found
  x0: {value: 100, unit: mm, fit: [1, 1000]}   # too
blocks:
  x: {type: integrator, of: fall, start: x0, unit: m}
  fall: {type: gain, of: x, k: -rate}
measured:
  run: {file: run.csv, time: t, signals: {x: position}}
  check: {file: check.csv, time: t, signals: {x: position}, use: validate}
"""
T = np.linspace(0.0, 2.0, 41)
COLUMN = {"run": 0.15 * np.exp(-1.7 * T), "check": 0.12 * np.exp(-1.7 * T)}


@pytest.fixture
def decay(tmp_path: Path) -> Path:
    for name, x in COLUMN.items():
        rows = [f"{t},{value}" for t, value in zip(T.tolist(), x.tolist(), strict=True)]
        (tmp_path / f"{name}.csv").write_text("\n".join(["t,position", *rows]), encoding="utf-8")
    file = tmp_path / "decay.yaml"
    file.write_text(DECAY, encoding="utf-8")
    return file


def replaced(file: Path, old: str, new: str) -> Path:
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    return file


def test_fit_prints_values_and_errors(call: Any, decay: Path) -> None:
    told = call("fit", decay)
    assert (told.code, told.err) == (0, "")
    assert told.out.startswith("least_squares: the criterion fell from ")
    assert "converged.\n" in told.out
    rows: dict[str, list[str]] = {}
    for words in map(str.split, told.out.splitlines()):
        rows.setdefault(words[0] if words else "", words)
    assert rows["rate"][1] == "1"
    assert float(rows["rate"][2]) == pytest.approx(1.7, rel=1e-6)
    assert rows["x0"][1] == "100"  # in the unit of the file, mm
    assert float(rows["x0"][2]) == pytest.approx(150.0, rel=1e-6)
    assert rows["run"][1:5] == ["train", "x", "41", "m"]
    assert float(rows["check"][-1]) == pytest.approx(
        np.sqrt(np.mean((0.03 * np.exp(-1.7 * T)) ** 2)), rel=1e-3
    )
    assert "written" not in told.out


def test_errors_starts_and_offsets_are_in_the_unit_of_the_column(call: Any, decay: Path) -> None:
    """The file has numbers in m, which the diagram calls km: all that is told of x is in km."""
    given = "{column: position, unit: km, offset: {value: 0, fit: [-1, 1]}}"
    replaced(decay, "signals: {x: position}}", f"signals: {{x: {given}}}, start: {{x: free}}}}")
    replaced(decay, "signals: {x: position}", "signals: {x: {column: position, unit: km}}")
    replaced(decay, ", fit: [1, 1000]", "")
    out = call("fit", decay).out
    rows = {words[0]: words for words in map(str.split, out.splitlines()) if words}
    assert rows["offset.x"][-1] == "km" and abs(float(rows["offset.x"][2])) < 1e-6
    assert re.search(r"run +x +0\.15\d* +km", out)
    assert re.search(r"check +validate +x +41 +km +\S+ +0\.0", out)


def test_fit_as_json(call: Any, decay: Path) -> None:
    told = call("fit", decay, "--json", "--MaxIter", "150")
    assert (told.code, told.err) == (0, "")
    data = told.data
    assert list(data) == [
        *("method", "values", "before", "errors", "intervals", "correlation", "not_determined"),
        *("at_bounds", "unmoved", "words", "remarks", "starts", "criterion_before", "criterion"),
        *("evaluations", "iterations", "exitflag", "message", "unfinished", "seconds", "seed"),
        *("comparisons", "profiles", "written"),
    ]
    assert data["method"] == "least_squares"
    assert data["before"] == {"rate": 1.0, "x0": 0.1}
    assert data["values"] == pytest.approx({"rate": 1.7, "x0": 0.15}, rel=1e-2)
    assert data["criterion_before"] == pytest.approx(
        np.mean((COLUMN["run"] - 0.1 * np.exp(-T)) ** 2) / 2, rel=1e-4
    )
    assert data["criterion"] < data["criterion_before"]
    assert data["exitflag"] == 1
    assert [sorted(c) for c in data["comparisons"]] == [
        ["rmse_after", "rmse_before", "series", "signal", "unit", "use"]
    ] * 2
    assert data["written"] == []


def test_limits_and_starts_reach_the_search(call: Any, decay: Path) -> None:
    data = call("fit", decay, "--MaxIter", "3", "--set", "x0=0.2 m", "--json").data
    assert (data["iterations"], data["exitflag"]) == (3, 0)
    assert data["before"]["x0"] == 0.2
    simplex = ("--method", "fminsearch", "--TolX", "1", "--TolFun", "1")
    few = call("fit", decay, "--MaxFunEvals", "4", *simplex, "--json").data
    assert few["evaluations"] < 30


def test_a_tolerance_of_the_simplex_is_refused_for_least_squares(call: Any, decay: Path) -> None:
    told = call("fit", decay, "--TolX", "1e-3")
    assert told.code == 2
    assert "TolX of a search by least_squares: only fminsearch has such tolerances" in told.err


def test_the_tolerance_of_runs_reaches_the_search(call: Any, decay: Path) -> None:
    found = [
        call("fit", decay, "--rtol", rtol, "--json").data["values"]["rate"]
        for rtol in ("1e-3", "1e-9")
    ]
    assert abs(found[0] - 1.7) > 1e-7 > abs(found[1] - 1.7)


def test_free_names_the_parameters(call: Any, decay: Path) -> None:
    data = call("fit", decay, "--free", "x0", "--set", "rate=1.7", "--json").data
    assert data["values"] == pytest.approx({"x0": 0.15}, rel=1e-4)


def test_what_is_not_determined_is_null_and_told(call: Any, decay: Path) -> None:
    replaced(decay, "  x0:", "  part: {value: 1, fit: [0, 3]}\n  x0:")
    replaced(decay, "k: -rate", "k: -rate*part")
    data = call("fit", decay, "--json").data
    assert data["errors"]["rate"] is None
    assert data["errors"]["x0"] is not None
    assert "not determined" in call("fit", decay).out


def test_apply_changes_the_values_and_nothing_else(call: Any, decay: Path) -> None:
    before = decay.read_text(encoding="utf-8")
    data = call("fit", decay, "--apply", "--json").data
    assert data["written"] == [str(decay)]
    rate, x0 = (read(decay).parameters[n].formula.value for n in ("rate", "x0"))  # type: ignore[union-attr]
    assert (rate, x0) == pytest.approx((1.7, 150), rel=1e-4)  # in mm, as it was
    after = decay.read_text(encoding="utf-8")
    written = {"rate": f"{{value: {rate:g},", "x0": f"{{value: {x0:g},"}
    assert after == before.replace("{value: 1.0,", written["rate"]).replace(
        "{value: 100,", written["x0"]
    )


def test_output_as_diagram_and_as_patch(call: Any, decay: Path) -> None:
    before = decay.read_text(encoding="utf-8")
    other, patch = decay.with_name("fitted.yaml"), decay.with_name("fitted.patch")
    told = call("fit", decay, "--output", other)
    assert told.out.endswith(f"written: {other}\n")
    assert call("fit", decay, "--output", patch, "--json").data["written"] == [str(patch)]
    assert decay.read_text(encoding="utf-8") == before
    assert call("check", other).code == 0
    lines = patch.read_text(encoding="utf-8").splitlines()
    removed = [line[1:] for line in lines if line[0] == "-" and not line.startswith("---")]
    added = [line[1:] for line in lines if line[0] == "+" and not line.startswith("+++")]
    assert removed == [line for line in before.splitlines() if "fit:" in line]
    assert added == [line for line in other.read_text().splitlines() if "fit:" in line]


def test_apply_and_output_both_happen(call: Any, decay: Path) -> None:
    patch = decay.with_name("fitted.patch")
    data = call("fit", decay, "--apply", "--output", patch, "--json").data
    assert data["written"] == [str(patch), str(decay)]
    assert "value: 1.7" in decay.read_text(encoding="utf-8")
    assert "+  rate: {value: 1.7," in patch.read_text(encoding="utf-8")


def test_a_fit_is_applied_to_the_diagram_that_extends_another_one(call: Any, decay: Path) -> None:
    base = decay.read_text(encoding="utf-8")
    file = decay.with_name("warm.yaml")
    file.write_text(f"extends: {decay.name}\ntitle: warm\n", encoding="utf-8")
    data = call("fit", file, "--apply", "--json").data
    assert data["written"] == [str(file)]
    assert decay.read_text(encoding="utf-8") == base
    lines = file.read_text(encoding="utf-8").splitlines()
    assert lines[:3] == [f"extends: {decay.name}", "title: warm", "parameters:"]
    assert lines[3].startswith("  rate: {value: 1.7") and "fit: [" in lines[3]
    assert len(lines) == 5


@pytest.mark.parametrize("ending", [".md", ".html"])
def test_report_is_written_with_its_figure(call: Any, decay: Path, ending: str) -> None:
    report = decay.with_name(f"report{ending}")
    told = call("fit", decay, "--report", report)
    assert told.out.endswith(f"written: {report}\n")
    text = report.read_text(encoding="utf-8")
    for words in ("Fit of Decay", "fitted parameters", "standard error", "rmse after"):
        assert words in text
    if ending == ".md":
        assert "(report_fit.png)" in text
        assert report.with_name("report_fit.png").read_bytes().startswith(b"\x89PNG")
    else:
        assert 'src="data:image/png;base64,' in text


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("\n0.5,", "\n0.3,", "run.csv:12: time goes back to 0.3, from 0.45 in line 11. Sort the"),
        ("position", "postion", "there are: postion, t. Did you mean 'postion'?"),
    ],
)
def test_a_bad_record_is_told_with_its_line(
    call: Any, decay: Path, old: str, new: str, said: str
) -> None:
    replaced(decay.with_name("run.csv"), old, new)
    told = call("fit", decay, "--json")
    assert told.code == 2
    assert said in told.err
    assert told.data["error"][0]["file"]


def test_a_value_that_is_not_finite_is_told_with_its_line(call: Any, decay: Path) -> None:
    csv = decay.with_name("run.csv")
    lines = csv.read_text(encoding="utf-8").splitlines()
    lines[7] = "0.35,inf"
    csv.write_text("\n".join(lines), encoding="utf-8")
    told = call("fit", decay)
    assert told.code == 2
    assert told.err == (
        f"{csv}:8: column 'position' is not finite in this row. "
        "Leave out the rows without a value.\n"
    )


def test_a_missing_record_is_told(call: Any, decay: Path) -> None:
    decay.with_name("run.csv").unlink()
    told = call("fit", decay)
    assert told.code == 2
    assert f"{decay}:11:3: unknown file 'run.csv'" in told.err


def test_a_diagram_without_measured_series_is_told(call: Any, decay: Path) -> None:
    decay.write_text(DECAY.partition("measured:")[0], encoding="utf-8")
    told = call("fit", decay)
    assert told.code == 2
    assert told.err == (
        f"{decay}: the diagram names no measured series. "
        "Add one under `measured:` with file, time and signals.\n"
    )


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--method", "fminsarch"], "unknown method 'fminsarch'"),
        (["--method", "fminsarch"], "Did you mean 'fminsearch'?"),
        (["--free", "rat"], "unknown parameter 'rat'; there are: rate, x0. Did you mean 'rate'?"),
        (["--set", "rate=20"], "'rate' begins at 20, outside its bounds 0 to 10 (SI)."),
        (["--MaxIter", "0"], "MaxIter is 0. Give a number of at least 1"),
        (["--rtol", "0"], "rtol = 0 and atol = 0 cannot be met. Take rtol between"),
        (["--TolX", "-1"], "TolX is -1.0. Give a tolerance of at least 0."),
        (["--fix", "rat"], "unknown parameter 'rat'; there are: rate, x0. Did you mean 'rate'?"),
        (["--loss", "hubert"], "unknown loss 'hubert'; there are: cauchy, huber, linear."),
        (["--loss", "huber"], "a robust loss needs the noise, and no sigma is known of x in run."),
        (["--resume", "none.json"], "the saved fit cannot be read: No such file or directory."),
        (["--profile", "x1"], "'x1'"),
        (["--report", "a.txt"], "unknown file ending '.txt'. End the name of the report in .md or"),
        (
            ["--output", "a.txt"],
            "unknown file ending '.txt'. End the name of the edited diagram in",
        ),
        (["--output", "no/a.yaml"], "there is no folder 'no'. Make the folder first"),
    ],
)
def test_a_wrong_argument_is_told_in_one_line(
    call: Any, decay: Path, arguments: list[str], said: str
) -> None:
    told = call("fit", decay, *arguments)
    assert (told.code, told.out) == (2, "")
    assert said in told.err
    assert told.err.count("\n") == 1


def test_what_is_not_free_cannot_be_fixed(call: Any, decay: Path) -> None:
    replaced(decay, ", fit: [1, 1000]", "")
    told = call("fit", decay, "--fix", "x0")
    assert told.code == 2
    assert "'x0' is not free: a fit leaves it as it is, fixed or not. Free are: rate." in told.err


def test_nothing_free_is_told(call: Any, decay: Path) -> None:
    decay.write_text(
        DECAY.replace(", fit: [0, 10]", "").replace(", fit: [1, 1000]", ""), encoding="utf-8"
    )
    told = call("fit", decay)
    assert told.code == 2
    assert "no parameter of the diagram is free. Give a parameter bounds" in told.err


def test_a_diagram_that_does_not_run_exits_with_1(call: Any, decay: Path) -> None:
    replaced(decay, "{type: gain, of: x, k: -rate}", "{type: expression, formula: 50*rate*x**2}")
    told = call("fit", decay, "--json")
    assert told.code == 1
    problem = told.data["error"][0]
    assert problem["block"] == "x"
    assert problem["what"].startswith("the model does not run at the start: ")
    assert "t = 0.2" in problem["what"]


def test_a_fixed_parameter_stays(call: Any, decay: Path) -> None:
    data = call("fit", decay, "--fix", "x0", "--json").data
    assert list(data["values"]) == ["rate"]


def test_what_is_found_of_sensors_is_written_in_their_units(call: Any, decay: Path) -> None:
    """The record in mm, shown 5 mm too high, 40 ms late, and 10 % too large."""
    late = 1000 * (1.1 * 0.15 * np.exp(-1.7 * np.maximum(T - 0.04, 0)) + 0.005)
    rows = [f"{t},{value}" for t, value in zip(T.tolist(), late.tolist(), strict=True)]
    decay.with_name("run.csv").write_text("\n".join(["t,position", *rows]), encoding="utf-8")
    sensor = (
        "{column: position, unit: mm, offset: {fit: [-20, 20]}, gain: {value: 1, fit: [0.5, 2]}, "
        "delay: {fit: [0, 0.1]}}"
    )
    replaced(decay, "signals: {x: position}}", f"signals: {{x: {sensor}}}}}")
    replaced(decay, "value: 100, unit: mm", "value: 150, unit: mm")
    told = call("fit", decay, "--fix", "x0", "--apply", "--json")
    assert told.data["values"] == pytest.approx(
        {"rate": 1.7, "gain.x": 1.1, "offset.x": 0.005, "delay.x": 0.04}, rel=1e-3
    )
    text = decay.read_text(encoding="utf-8")
    assert re.search(r"offset: \{fit: \[-20, 20\], value: (5|5\.0000\d|4\.9999\d)\}", text)
    assert re.search(r"gain: \{value: 1\.(1|10000\d|09999\d*), fit: \[0\.5, 2\]\}", text)
    assert call("fit", decay, "--fix", "x0", "--json").data["before"] == pytest.approx(
        told.data["values"], rel=1e-4
    )


def test_a_profile_is_told(call: Any, decay: Path) -> None:
    noisy = COLUMN["run"] + 0.002 * np.random.default_rng(1).standard_normal(T.size)
    rows = [f"{t},{value}" for t, value in zip(T.tolist(), noisy.tolist(), strict=True)]
    decay.with_name("run.csv").write_text("\n".join(["t,position", *rows]), encoding="utf-8")
    told = call("fit", decay, "--profile", "rate", "--json")
    low, high = told.data["profiles"][0]["interval"]
    assert told.data["intervals"]["rate"] == pytest.approx([low, high], rel=0.02)
    assert low < 1.7 < high
    told = call("fit", decay, "--profile", "rate")
    assert "rate lies between " in told.out


def test_a_saved_search_goes_on(call: Any, decay: Path) -> None:
    saved = decay.with_name("fit.json")
    simplex = ("--method", "fminsearch")
    first = call("fit", decay, *simplex, "--MaxIter", "10", "--save", saved, "--json").data
    second = call("fit", decay, *simplex, "--resume", saved, "--json").data
    assert first["iterations"] == 10 < second["iterations"]
    assert second["criterion"] < first["criterion"]


def test_plots_are_saved_where_there_is_no_display(
    call: Any, decay: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(decay.parent)
    told = call("fit", decay, "--plot")
    assert told.code == 0
    for name in ("optimplotfval", "optimplotfit"):
        assert (decay.parent / "fit_frames" / f"{name}.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_the_fit_of_the_papers_appendix(call: Any, tmp_path: Path) -> None:
    """Nine parameters by fminsearch with MaxIter 150: the criterion falls at least 100-fold."""
    report = tmp_path / "report.md"
    told = call("fit", TORSION, "--MaxIter", "150", "--report", report, "--json")
    assert told.code == 0
    data = told.data
    assert len(data["values"]) == 9
    assert data["iterations"] <= 150
    assert data["criterion"] <= data["criterion_before"] / 100
    assert (tmp_path / "report_fit.png").is_file()
