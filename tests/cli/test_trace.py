"""`trace` on a short record with a strong effect that its diagram lacks, and on one without."""

from __future__ import annotations

import io
import json
import re
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from oracles import pendulum
from tracewire.cli import main
from tracewire.diagram import read
from tracewire.errors import OptionError
from tracewire.trace import TraceOptions

from benchmarks.rigs.records import generate

DIAGRAM = """\
title: Short swing   # to be traced
span: [0, 6]
parameters:
  w0_squared: {value: 38, unit: 1/s^2, fit: [10, 90]}   # g/l
blocks:
  theta: {type: integrator, of: omega, start: {value: 45, unit: deg}, unit: rad}
  omega: {type: integrator, of: acceleration, unit: rad/s}
  height: {type: sin, of: theta}
  gravity: {type: gain, of: height, k: -w0_squared}
  acceleration: {type: sum, of: [gravity]}
measured:
  swing:
    file: swing.csv
    time: t
    signals: {theta: {column: theta, sigma: 1e-3}}
    start: {theta: free, omega: free}
"""
LEVEL = 0.8


APPLIED = "coulomb: {type: coulomb, rate: omega, level: {value: "


def write_record(folder: Path) -> None:
    """A free swing from rest at 45 deg with dry friction, and noise of 0.001 rad."""
    t = np.arange(0.0, 6.001, 0.02)
    theta = pendulum.solve(t, np.radians(45), w0_squared=40.0, c=0.0, f_c=LEVEL).theta
    theta = theta + 1e-3 * np.random.default_rng(2).standard_normal(t.size)
    rows = "".join(f"{a:.2f},{b:.5f}\n" for a, b in zip(t, theta, strict=True))
    (folder / "swing.csv").write_text("t,theta\n" + rows, encoding="utf-8")


@dataclass(frozen=True)
class Traced:
    """One trace of the diagram that lacks the friction, with everything written that can be."""

    folder: Path
    code: int
    data: Any
    err: str


@pytest.fixture(scope="module")
def traced(tmp_path_factory: pytest.TempPathFactory) -> Traced:
    folder = tmp_path_factory.mktemp("swing")
    write_record(folder)
    (folder / "swing.yaml").write_text(DIAGRAM, encoding="utf-8")
    arguments = ["--apply", "--output", str(folder / "x.patch")]
    arguments += ["--report", str(folder / "report.html"), "--json"]
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        code = main(["trace", str(folder / "swing.yaml"), *arguments])
    return Traced(folder, code, json.loads(out.getvalue()), err.getvalue())


def test_the_missing_effect_is_named_with_place_and_coefficient(traced: Traced) -> None:
    assert traced.code == 0
    assert traced.data["verdict"] == "effect"
    (effect,) = traced.data["effects"]
    assert (effect["name"], effect["place"]) == ("coulomb", "acceleration")
    assert effect["params"]["level"] == pytest.approx(LEVEL, rel=0.02)
    assert traced.data["parameters"]["w0_squared"] == pytest.approx(40, rel=0.01)


def test_json_has_the_errors_on_data_that_played_no_part(traced: Traced) -> None:
    data = traced.data
    assert data["rmse_after"] < 0.2 * data["rmse_before"]
    assert data["rmse_after"] == pytest.approx(1e-3, rel=0.3)
    assert data["sigma"] == {"theta": 1e-3}
    assert data["s2_before"] > 10 > 2 > data["s2_after"]
    assert data["steps"][0]["tried"][0]["effects"] == "coulomb @ acceleration"
    assert data["interrupted"] is False
    assert data["paragraph"]
    assert data["words"]
    assert data["dropped"] == []


def test_progress_goes_to_stderr(traced: Traced) -> None:
    lines = traced.err.splitlines()
    assert re.fullmatch(r" +\d+ s  fitting the declared model", lines[0])
    assert any("s  refitting with coulomb @ acceleration" in line for line in lines)


def test_apply_adds_the_block_and_keeps_the_comments(traced: Traced) -> None:
    file = traced.folder / "swing.yaml"
    assert str(file) in traced.data["written"]
    before, after = DIAGRAM.splitlines(), file.read_text(encoding="utf-8").splitlines()
    new = [line for line in after if line not in before]
    assert len(after) == len(before) + 1
    assert [line.split(":")[0].strip() for line in new] == ["w0_squared", "acceleration", "coulomb"]
    assert new[0].endswith("# g/l")
    assert "of: [gravity, coulomb]" in new[1]
    assert APPLIED in new[2]
    assert read(file).blocks["coulomb"].type == "coulomb"


def test_the_patch_has_the_same_lines(traced: Traced) -> None:
    patch = (traced.folder / "x.patch").read_text(encoding="utf-8").splitlines()
    added = [line[1:] for line in patch if line.startswith("+") and not line.startswith("+++")]
    text = (traced.folder / "swing.yaml").read_text(encoding="utf-8").splitlines()
    assert added == [line for line in text if line not in DIAGRAM.splitlines()]


def test_the_report_has_verdict_ranking_change_and_figures(traced: Traced) -> None:
    report = traced.folder / "report.html"
    assert traced.data["written"][-1] == str(report)
    text = report.read_text(encoding="utf-8")
    for words in ("Trace of Short swing", "VERDICT effect", "what was tried", "gate", APPLIED):
        assert words in text
    assert text.count('src="data:image/png;base64,') >= 4


def test_nothing_is_found_where_nothing_is_missing(call: Any, tmp_path: Path) -> None:
    write_record(tmp_path)
    file = tmp_path / "swing.yaml"
    text = DIAGRAM.replace(
        "{type: sum, of: [gravity]}",
        "{type: sum, of: [gravity, rub]}\n"
        "  rub: {type: coulomb, rate: omega, level: {value: 0.5, fit: [0, 9]}}",
    )
    file.write_text(text, encoding="utf-8")
    told = call("trace", file, "--apply")
    assert told.code == 0
    assert told.out.startswith("VERDICT null: nothing is missing that these data could show\n")
    assert "ties" not in told.out and "best approximation" not in told.out
    assert "fitted   standard error" in told.out
    before, after = text.splitlines(), file.read_text(encoding="utf-8").splitlines()
    changed = [(old, new) for old, new in zip(before, after, strict=True) if old != new]
    assert len(changed) == 2, "the fitted values of a line and of `rub`"
    assert all("fit: [" in old and "fit: [" in new for old, new in changed)


def test_a_record_that_is_too_short_is_told(call: Any, tmp_path: Path) -> None:
    write_record(tmp_path)
    csv = tmp_path / "swing.csv"
    csv.write_text("".join(csv.read_text().splitlines(keepends=True)[:31]), encoding="utf-8")
    (tmp_path / "swing.yaml").write_text(DIAGRAM, encoding="utf-8")
    told = call("trace", tmp_path / "swing.yaml", "--json")
    assert told.code == 2
    assert "the series 'swing' has 30 samples, too few to trace anything" in told.err
    assert "too few" in told.data["error"][0]["what"]


def test_a_diagram_without_measured_series_is_told(call: Any, tmp_path: Path) -> None:
    (tmp_path / "swing.yaml").write_text(DIAGRAM.partition("measured:")[0], encoding="utf-8")
    told = call("trace", tmp_path / "swing.yaml")
    assert told.code == 2
    assert "the diagram names no measured series. Add one under `measured:`" in told.err


def test_a_bad_record_is_told_with_its_line(call: Any, tmp_path: Path) -> None:
    (tmp_path / "swing.csv").write_text("t,theta\n0,0\n0.1,inf\n0.2,1\n", encoding="utf-8")
    (tmp_path / "swing.yaml").write_text(DIAGRAM, encoding="utf-8")
    told = call("trace", tmp_path / "swing.yaml")
    assert told.code == 2
    assert "swing.csv:3: column 'theta' is not finite in this row." in told.err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--report", "a.txt"], "unknown file ending '.txt'. End the name of the report in .md or"),
        (["--output", "no/a.patch"], "there is no folder 'no'. Make the folder first"),
        (["--patch", "a.txt"], "End the name of the patch in .patch or .diff"),
        (["--table", "a.txt"], "End the name of the table in .csv"),
        (["--save", "a.pkl"], "End the name of the saved trace in .json"),
    ],
)
def test_a_target_that_cannot_be_written_is_told_before_the_work(
    call: Any, tmp_path: Path, arguments: list[str], said: str
) -> None:
    told = call("trace", tmp_path / "not_even_read.yaml", *arguments)
    assert (told.code, told.out) == (2, "")
    assert said in told.err
    assert told.err.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            ["--only", "aceleration"],
            "unknown place 'aceleration'; there are: acceleration, sensor.theta. Did you mean",
        ),
        (["--without", "coulom"], "Did you mean 'coulomb'?"),
        (["--without", "coulomb @ force"], "unknown place 'force'; there are: acceleration"),
        (["--effects", "-1"], "a trace cannot add -1 effects"),
        (["--horizon", "0"], "the horizon must be longer than 0 s, got 0 s"),
        (["--budget", "0"], "the budget must be more than 0 s, got 0 s"),
        (["--effects", "many"], "'--effects'"),
    ],
)
def test_what_is_asked_for_and_does_not_exist_is_told_before_the_work(
    call: Any, tmp_path: Path, arguments: list[str], said: str
) -> None:
    write_record(tmp_path)
    (tmp_path / "swing.yaml").write_text(DIAGRAM, encoding="utf-8")
    told = call("trace", tmp_path / "swing.yaml", *arguments)
    assert (told.code, told.out) == (2, "")
    assert said in told.err
    assert told.err.count("\n") == 1


def test_what_the_user_asks_for_reaches_the_trace(
    tmp_path: Path, call: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_record(tmp_path)
    (tmp_path / "swing.yaml").write_text(DIAGRAM, encoding="utf-8")
    seen = []

    def only_look(model: Any, **options: Any) -> Any:
        seen.append(options["options"])
        raise OptionError.one("this is far enough")

    monkeypatch.setattr(import_module("tracewire.trace"), "trace", only_look)
    call("trace", tmp_path / "swing.yaml")
    arguments = ["--only", "acceleration", "sensor.theta", "--without", "cogging"]
    arguments += ["--without", "coulomb @ acceleration", "--effects", "1", "--horizon", "2.5"]
    call("trace", *arguments, "--budget", "60", tmp_path / "swing.yaml")
    assert seen == [
        TraceOptions(),
        TraceOptions(
            only=("acceleration", "sensor.theta"),
            without=("cogging", "coulomb @ acceleration"),
            effects=1,
            horizon=2.5,
            budget=60.0,
        ),
    ]


def test_files_named_beside_the_diagram(
    tmp_path: Path, call: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All values of an option count, however they are given, and a diagram ends them."""
    (tmp_path / "swing.yaml").write_text(DIAGRAM.partition("measured:")[0], encoding="utf-8")
    seen = []
    for name in "abcd":
        write_record(tmp_path)
        (tmp_path / "swing.csv").rename(tmp_path / f"{name}.csv")

    def only_look(model: Any, **options: Any) -> Any:
        seen.append([(s.name, s.use) for s in model.diagram.measured.values()])
        raise OptionError.one("this is far enough")

    monkeypatch.setattr(import_module("tracewire.trace"), "trace", only_look)
    monkeypatch.chdir(tmp_path)
    files = ["--train", "a.csv", "b.csv", "--gate", "c.csv", "--validate=d.csv"]
    for arguments in (
        ["swing.yaml", *files],
        [*files, "swing.yaml"],
        ["--gate", "c.csv", "--train", "a.csv", "b.csv", "swing.yaml", "--validate", "d.csv"],
        ["--train", "a.csv", "--train", "b.csv", "--json", "swing.yaml", *files[3:]],
    ):
        told = call("trace", *arguments)
        assert told.code == 2
        assert "this is far enough" in told.err
    wanted = [("a", "train"), ("b", "train"), ("c", "gate"), ("d", "validate")]
    assert [sorted(found) for found in seen] == [wanted] * 4
    told = call("trace", "swing.yaml", "--validate", "a.csv")
    assert told.code == 2
    assert "none of them to train on" in told.err


def test_what_an_effect_remembers_begins_free_in_the_diagram_that_is_written(
    call: Any, tmp_path: Path
) -> None:
    """Its state was free in the trace, and began at 0 in the diagram that the trace wrote: a slab
    on a plate that is warm where the second record begins."""
    file = generate("r105_plate", tmp_path)
    told = call("trace", file, "--apply")
    assert told.out.startswith("VERDICT effect: viscous_load @ flows is missing\n")
    diagram = read(file)
    starts = {name: dict(series.start) for name, series in diagram.measured.items()}
    free = {"rise": None, "viscous_load.slip": None}
    assert starts == {"from_cold": free, "from_warm": free}
