"""What a new user tries on the command line works, or says what to do."""

from __future__ import annotations

import io
import re
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tracewire.formula.common_units import COMMON
from tracewire.formula.units import SYMBOLS
from tracewire.shipped import shipped

CART = """\
title: A cart that is pushed
span: [0, 2]
inputs: {F: {unit: N}}
parameters: {c: 0.5}
blocks:
  x: {type: integrator, of: v, unit: m}
  v: {type: integrator, of: a}
  a: {type: expression, formula: F/1 - c*v}        # of 1 kg
measured:
  push: {file: push.csv, time: t, signals: {x: x}, inputs: {F: F}}
  pull: {file: pull.csv, time: t, signals: {x: x}, inputs: {F: F}}
"""


@pytest.fixture
def cart(tmp_path: Path) -> Path:
    t = np.linspace(0, 2, 21)
    for name, sign in (("push", 1), ("pull", -1)):
        rows = "".join(f"{s},{sign * s * s / 2},{sign}\n" for s in t)
        (tmp_path / f"{name}.csv").write_text(f"t,x,F\n{rows}", encoding="utf-8")
    file = tmp_path / "cart.yaml"
    file.write_text(CART, encoding="utf-8")
    return file


@pytest.mark.parametrize("arguments", [["-h"], ["run", "-h"], ["analyse", "steady", "-h"]])
def test_h_is_help(call: Any, arguments: list[str]) -> None:
    told = call(*arguments)
    assert told.code == 0
    assert told.out == call(*arguments[:-1], "--help").out


def test_several_files_and_folders_are_checked(call: Any, cart: Path, swing: Path) -> None:
    told = call("check", cart, swing)
    assert told.code == 0
    assert "A cart that is pushed" in told.out
    assert "Pendulum with a dry bearing" in told.out
    (cart.parent / "notes.yaml").write_text("no: diagram\n", encoding="utf-8")
    inside = call("check", cart.parent, "--json").data
    titles = {part["title"] for part in inside["diagrams"]}
    assert titles == {"A cart that is pushed", "Pendulum with a dry bearing"}


def test_what_is_wrong_in_one_of_several_files_is_told(call: Any, cart: Path, swing: Path) -> None:
    swing.write_text("blocks: {x: {type: nothing}}\n", encoding="utf-8")
    cart.write_text(CART.replace("of: v", "of: w"), encoding="utf-8")
    told = call("check", cart, swing)
    assert told.code == 2
    assert re.search(r"cart\.yaml:6:.*\n.*swing\.yaml:1:", told.err)
    assert "no problems" not in told.out


def test_a_folder_without_diagrams_is_told(call: Any, tmp_path: Path) -> None:
    assert "there is no diagram in" in call("check", tmp_path).err


def test_a_diagram_with_an_input_is_swept_as_a_series(
    call: Any, cart: Path, tmp_path: Path
) -> None:
    grid = ["--over", "c=0:1:3", "--keep", "end(x)"]
    refused = call("sweep", cart, *grid)
    assert refused.code == 2
    assert "Name a measured series that has it (`--series` of `run` and `sweep`)" in refused.err
    ends = {}
    for series in ("push", "pull"):
        told = call("sweep", cart, *grid, "--series", series, "--json")
        assert told.code == 0
        ends[series] = told.data["values"]["end(x)"]
    assert ends["push"][0] == pytest.approx(2)  # F t^2/2 without friction
    assert ends["push"] == pytest.approx([-x for x in ends["pull"]])
    partial = tmp_path / "sweep.npz"
    assert call("sweep", cart, *grid, "--series", "push", "--partial", partial).code == 0
    other = call("sweep", cart, *grid, "--series", "pull", "--partial", partial)
    assert "this is the partial file of another sweep" in other.err


def test_measured_samples_are_drawn_over_a_run_as_its_series(
    call: Any, cart: Path, tmp_path: Path
) -> None:
    told = call("run", cart, "--series", "push", "--figure", tmp_path / "a.svg")
    assert told.code == 0
    assert "<!-- measured -->" in (tmp_path / "a.svg").read_text(encoding="utf-8")


QUICK = """\
span: [0, 60]
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  a: {type: gain, of: x, k: -400}
"""


def test_figures_are_drawn_finer_than_files(
    call: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """190 swings: with five samples for each the line is a polygon."""
    drawn = []
    show = import_module("tracewire.show")
    for name in ("plot_run", "plot_portrait"):
        monkeypatch.setattr(show, name, lambda run, *_, **__: drawn.append(run), raising=False)
    file = tmp_path / "quick.yaml"
    file.write_text(QUICK, encoding="utf-8")
    figure, output = tmp_path / "a.svg", tmp_path / "a.npz"
    assert call("run", file, "--output", output).code == 0
    plain = dict(np.load(output))
    assert call("run", file, "--figure", figure, "--output", output).code == 0
    both = dict(np.load(output))
    assert len(plain["t"]) == len(both["t"]) == 1001
    assert both["t"] == pytest.approx(plain["t"])
    assert both["x"] == pytest.approx(plain["x"], abs=1e-9)
    assert call("analyse", "portrait", file, "x", "v", "--figure", figure).code == 0
    assert [len(run.t) for run in drawn] == [10_001, 10_001]
    assert call("run", file, "--figure", figure, "--every", "0.1").code == 0
    assert len(drawn[-1].t) == 601


RUBBING = """\
span: [0, 6]
every: 0.5
blocks:
  v: {type: integrator, of: net}
  pull: {type: sin, of: time}
  time: {type: gain, of: clock, k: 2}
  clock: {type: time}
  rub: {type: dry_friction, rate: v, slip: 0.3, stick: 0.5}
  net: {type: sum, of: [pull, rub]}
"""


def test_a_portrait_of_a_friction_is_its_law(
    call: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its jumps lie at rest, however far apart the samples are."""
    drawn = []
    show = import_module("tracewire.show")
    monkeypatch.setattr(show, "plot_portrait", lambda run, *_, **__: drawn.append(run), False)
    file = tmp_path / "rubbing.yaml"
    file.write_text(RUBBING, encoding="utf-8")
    told = call("analyse", "portrait", file, "v", "rub", "--figure", tmp_path / "a.svg", "--json")
    assert told.data["samples"] == 13
    v, rub = drawn[0]["v"], drawn[0]["rub"]
    jumps = np.flatnonzero(np.abs(np.diff(rub)) > 0.1)
    assert len(jumps) > 3
    assert np.abs(v[jumps]).max() < 1e-9
    moving = np.abs(v) > 1e-9
    assert rub[moving] == pytest.approx(-0.3 * np.sign(v[moving]))
    assert np.abs(rub).max() == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize(("sign", "said"), [("-", True), ("", False)])
def test_a_force_with_the_wrong_sign_is_told(
    call: Any, tmp_path: Path, sign: str, said: bool
) -> None:
    file = tmp_path / "a.yaml"
    file.write_text(
        "span: [0, 60]\nrecord: [x]\nblocks:\n"
        "  x: {type: integrator, of: v, start: 1}\n  v: {type: integrator, of: a}\n"
        f"  pull: {{type: viscous, rate: v, c: 1}}\n  a: {{type: sum, of: [{sign}pull, x_]}}\n"
        "  x_: {type: gain, of: x, k: -1}\n",
        encoding="utf-8",
    )
    told = call("run", file)
    assert told.code == 0
    assert ("'x' grows from" in told.err and "Is a sign wrong?" in told.err) is said


def test_a_wave_that_arrives_is_no_sign_of_a_wrong_sign(call: Any) -> None:
    """The far end of a chain moves 1e-17 at first and 1e-2 in the end."""
    chain = str(shipped("diagrams") / "gallery" / "chain.yaml")
    told = call("run", chain, "--set", "chain_1.start=1e-6", "--span", "0", "5")
    assert (told.code, told.err) == (0, "")


def test_a_series_may_only_drive_a_run(call: Any, cart: Path) -> None:
    """It has inputs and no signals: `run` and `check` take it, a fit passes it over."""
    text = cart.read_text(encoding="utf-8").replace("time: t, signals: {x: x}, ", "time: t, ", 1)
    cart.write_text(text, encoding="utf-8")
    told = call("run", cart, "--series", "push", "--json")
    assert told.code == 0
    told = call("check", cart, "--json")
    assert {part["name"]: part["signals"] for part in told.data["measured"]} == {
        "push": [],
        "pull": ["x"],
    }
    lines = [line for line in text.splitlines() if not line.startswith("  pull")]
    cart.write_text("\n".join(lines).replace("c: 0.5", "c: {value: 0.5, fit: [0, 1]}"), "utf-8")
    told = call("fit", cart)
    assert told.code == 2
    assert "the diagram names no measured series" in told.err


def test_a_series_of_nothing_is_told(call: Any, cart: Path) -> None:
    text = cart.read_text(encoding="utf-8").replace("signals: {x: x}, inputs: {F: F}", "use: gate")
    cart.write_text(text, encoding="utf-8")
    assert "series 'push' needs 'signals'" in call("check", cart).err


def test_a_diagram_from_stdin_is_checked(
    call: Any, swing: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Files that it names are looked for in the folder where one stands."""
    monkeypatch.chdir(swing.parent)
    text = swing.read_bytes()
    for content, code in ((text, 0), (text.replace(b"gain", b"gian"), 2), (b"\xff", 2)):
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(content)))
        result = call("check", "-")
        assert result.code == code
        assert ("<stdin>:" in result.err) == (code == 2)


def test_a_diagram_from_stdin_is_run_and_has_no_file_to_change(
    call: Any, swing: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(swing.parent)
    for arguments, code in ((("run", "-"), 0), (("fit", "-", "--apply"), 2)):
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(swing.read_bytes())))
        result = call(*arguments)
        assert result.code == code
        assert ("this one comes from stdin" in result.err) == (code == 2)


def test_units_are_listed_and_explained(call: Any) -> None:
    listed = call("units")
    assert "\nacceleration:  m/s^2, " in listed.out
    assert "deg = 0.0174533 rad" in listed.out
    assert "\ncharge:        C, mC = 0.001 C, " in listed.out
    data = call("units", "--json").data
    names = [name for group in data.values() for name in group]
    assert {*SYMBOLS, *COMMON} <= {*names} and len(names) == len({*names})
    assert call("units", "mN m s/deg").out == "1 mN m s/deg = 0.0572957795131 N m s/rad\n"
    assert call("units", "furlong", "--json").data["factor"] == pytest.approx(201.168, rel=1e-5)
    wrong = call("units", "degC")
    assert (wrong.code, "is in K" in wrong.err) == (2, True)


def test_a_unit_that_is_none_is_told_once_with_all_its_lines(call: Any, cart: Path) -> None:
    text = cart.read_text(encoding="utf-8").replace(
        "{c: 0.5}", "{c: 0.5, T: {value: 2, unit: degC}}"
    )
    cart.write_text(text.replace("unit: m}", "unit: degC}"), encoding="utf-8")
    (line,) = call("check", cart).err.strip().splitlines()
    assert "cart.yaml:4:" in line
    assert "'degC' is not a unit, also in line 6. A temperature is in K" in line


def test_gravity_is_told_where_gram_is_written(call: Any, cart: Path) -> None:
    text = cart.read_text(encoding="utf-8").replace(
        "type: expression,", "type: expression, unit: m/s^2,"
    )
    (cart.parent / "push.csv").write_text("t,x,F,b [g]\n0,0,0,0\n1,1,1,1\n2,2,2,1\n", "utf-8")
    cart.write_text(text.replace("{x: x}", "{x: x, a: b}", 1), encoding="utf-8")
    told = call("check", cart)
    assert told.code == 2
    assert "'a' is in m/s^2 in the diagram" in told.err
    assert "has the unit 'gravity'" in told.err


def test_check_lists_all_that_is_free_in_a_fit(call: Any, cart: Path) -> None:
    text = cart.read_text(encoding="utf-8").replace("c: 0.5", "c: {value: 0.5, fit: [0, 1]}")
    sensor = "{column: x, offset: {fit: [-1, 1]}, delay: {value: 0, fit: [0, 0.1]}}"
    text = text.replace("signals: {x: x},", f"signals: {{x: {sensor}}}, start: {{v: free}},", 1)
    cart.write_text(text, encoding="utf-8")
    told = call("check", cart)
    assert "free in a fit: c, offset.x, delay.x, start.v\n" in told.out


def test_what_a_sensor_does_is_no_block(call: Any, cart: Path) -> None:
    extra = "blocks:\n  s: {type: sensor_delay, of: x}\n"
    text = cart.read_text(encoding="utf-8").replace("blocks:\n", extra)
    cart.write_text(text, encoding="utf-8")
    told = call("check", cart)
    assert told.code == 2
    assert "signals: {x: {column: x, delay: ...}}" in told.err
    assert "there are" not in told.err


PENDULUM = """\
title: A pendulum
span: [0, 10]
record: [phi, omega]
parameters: {c: {value: 0.1, unit: 1/s}}
presets: {free: {c: 0}, held: {c: 9}}
blocks:
  phi: {type: integrator, of: omega, start: 0.5, unit: deg, label: φ}
  omega: {type: integrator, of: a, unit: rad/s}
  a: {type: expression, formula: -9*phi - c*omega}
"""


@pytest.fixture
def pendulum(tmp_path: Path) -> Path:
    file = tmp_path / "pendulum.yaml"
    file.write_text(PENDULUM, encoding="utf-8")
    return file


def test_several_values_are_in_one_figure(call: Any, pendulum: Path, tmp_path: Path) -> None:
    figure = tmp_path / "a.svg"
    told = call("run", pendulum, "--over", "c=0.1,1,3", "--figure", figure)
    assert told.code == 0
    assert [line.split()[5] for line in told.out.splitlines() if "phi" in line] == ["0.1", "1", "3"]
    drawn = figure.read_text(encoding="utf-8")
    for legend in ("c = 0.1 1/s", "c = 1 1/s", "c = 3 1/s", "φ [deg]"):
        assert f"<!-- {legend} -->" in drawn
    data = call("run", pendulum, "--over", "c=0:3:4", "--json").data["runs"]
    assert list(data) == ["c = 0 1/s", "c = 1 1/s", "c = 2 1/s", "c = 3 1/s"]
    alone = call("run", pendulum, "--set", "c=2", "--json").data
    assert data["c = 2 1/s"]["final"] == alone["final"]


def test_several_presets_and_starts_are_in_one_table(call: Any, pendulum: Path) -> None:
    presets = ["--preset", "free", "--preset", "held"]
    told = call("run", pendulum, *presets, "--over", "start.phi=10,20 deg", "--json").data["runs"]
    assert [run["parameters"]["c"] for run in told.values()] == [0, 0, 9, 9]
    assert [run["start"]["phi"] for run in told.values()] == pytest.approx(
        2 * [np.pi / 18, np.pi / 9]
    )
    assert next(iter(told)) == "free, start.phi = 0.174533 rad"


ROOT = """\
span: [0, 1]
record: [x]
parameters: {p: 1}
require: [p > 0]
blocks:
  x: {type: integrator, of: r, start: 1}
  r: {type: expression, formula: -p*sqrt(x)}
"""


def test_of_several_runs_those_that_fail_are_named(call: Any, tmp_path: Path) -> None:
    file, figure = tmp_path / "root.yaml", tmp_path / "a.svg"
    file.write_text(ROOT, encoding="utf-8")
    told = call("run", file, "--over", "p=-1,1,9", "--figure", figure)
    assert told.code == 0
    rows = [line.split()[:4] for line in told.out.splitlines() if line.startswith(" x ")]
    assert rows == [["x", "p", "=", "1"]]
    assert "the run with p = -1 failed: " in told.out
    assert "the run with p = 9 failed: " in told.out and "'x' is not finite" in told.out
    drawn = figure.read_text(encoding="utf-8")
    assert "<!-- p = 1 -->" in drawn and "<!-- p = 9 -->" not in drawn
    data = call("run", file, "--over", "p=1,9", "--json").data
    assert list(data["runs"]) == ["p = 1"] and list(data["failed"]) == ["p = 9"]


def test_where_all_runs_fail_the_first_one_is_named(call: Any, tmp_path: Path) -> None:
    file = tmp_path / "root.yaml"
    file.write_text(ROOT, encoding="utf-8")
    told = call("run", file, "--over", "p=8,9")
    assert told.code == 1
    assert "all 2 runs failed, the first one with p = 8: the run stopped at t = " in told.err
    told = call("run", file, "--over", "p=8,9", "--span", "5", "1")
    assert told.code == 2
    assert told.err == "the span from 5 to 1 s is empty. Give a begin before the end.\n"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--over", "c=0:1:13"], "13 runs do not go into one figure. Take 12 at most; `tracewire"),
        (["--over", "c=1,2", "--events"], "--events are those of one run, and here are several"),
        (["--over", "c=1,2", "--output", "a.csv"], "--events are those of one run"),
        (["--over", "c=1,2", "--over", "c=3"], "--over gives 'c' twice"),
        (["--set", "c=3", "--over", "c=1,2"], "'c' is set to one value, and has values in --over."),
        (["--start", "phi=1", "--over", "start.phi=1,2"], "'start.phi' is set to one value, and"),
        (["--over", "c=1;2"], "--over 'c=1;2' is not a name, '=' and FROM:TO:COUNT or values"),
        (["--over", "d=1,2"], "unknown parameter 'd'"),
        (["--over", "c=1,2 m"], "'m' is another quantity than 1/s"),
        (["--set", "c=1", "--set", "c=2"], "Leave one out, or run both: --over c=1,2."),
        (["--unit", "phi"], "--unit 'phi' is not a signal, '=' and a unit"),
        (["--unit", "phi=m"], "'m' is another quantity than rad. Give it in rad or a unit like"),
        (["--unit", "psi=deg"], "unknown recorded signal 'psi'"),
    ],
)
def test_several_runs_that_cannot_be_are_told(
    call: Any, pendulum: Path, arguments: list[str], said: str
) -> None:
    told = call("run", pendulum, *arguments)
    assert told.code == 2
    assert said in told.err


def test_results_are_in_the_unit_that_is_asked_for(
    call: Any, pendulum: Path, tmp_path: Path
) -> None:
    file, figure = tmp_path / "a.csv", tmp_path / "a.svg"
    told = call("run", pendulum, "--unit", "omega=rpm", "--figure", figure, "--output", file)
    rows = {line.split()[0]: line.split()[1:] for line in told.out.splitlines() if line.strip()}
    assert rows["phi"][:3] == ["(φ)", "deg", "28.6479"]  # 0.5 rad
    assert rows["omega"][0] == "rpm"
    assert float(rows["omega"][4]) == pytest.approx(60 / (2 * np.pi) * 1.4, rel=0.05)
    drawn = figure.read_text(encoding="utf-8")
    assert "<!-- φ [deg] -->" in drawn
    assert "<!-- omega [rpm] -->" in drawn
    assert file.read_text(encoding="utf-8").splitlines()[1].startswith("0.0,0.5,")
    data = call("run", pendulum, "--json").data["signals"]["phi"]
    assert (data["unit"], data["start"]) == ("rad", 0.5)


def test_a_unit_that_the_equations_contradict_is_refused(call: Any, pendulum: Path) -> None:
    pendulum.write_text(
        "parameters: {end: {value: 1, unit: m}}\n"
        "blocks: {body: {type: hard_stop, high: end, start_rate: 1}}",
        encoding="utf-8",
    )
    told = call("run", pendulum, "--unit", "body.x=bar")
    assert told.code == 2
    assert "'bar' is another quantity than m. Give it in m or a unit like it." in told.err
    assert call("run", pendulum, "--unit", "body.x=mm").code == 0


def test_a_portrait_has_labels_and_units(call: Any, pendulum: Path, tmp_path: Path) -> None:
    figure = tmp_path / "a.svg"
    assert call("analyse", "portrait", pendulum, "phi", "omega", "--figure", figure).code == 0
    assert "<!-- φ [deg] -->" in figure.read_text(encoding="utf-8")


def test_check_tells_a_spring_that_pushes(call: Any, pendulum: Path) -> None:
    text = PENDULUM.replace(
        "a: {type: expression, formula: -9*phi - c*omega}", "a: {type: sum, of: [-spring]}"
    )
    pendulum.write_text(f"{text}  spring: {{type: stiffness, of: phi, k: 9}}\n", encoding="utf-8")
    said = "'spring' pushes 'omega' on: a stiffness acts against 'phi' by itself"
    assert f"!           {said}" in call("check", pendulum).out
    assert call("check", pendulum, "--json").data["remarks"][0].startswith(said)
    pendulum.write_text(pendulum.read_text(encoding="utf-8").replace("-spring", "spring"), "utf-8")
    assert call("check", pendulum, "--json").data["remarks"] == []
