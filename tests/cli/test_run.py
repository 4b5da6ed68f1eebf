"""`run`: values, units, files, figures, and what it says when an argument is wrong."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tracewire.solve.core.methods import NAMES

BLOW_UP = """\
span: [0, 2]
blocks:
  x: {type: integrator, of: r, start: 1}
  r: {type: expression, formula: x**2}
"""


def test_the_help_names_every_method(call: Any) -> None:
    told = call("run", "--help").out
    assert [name for name in ("auto", *NAMES) if name not in told] == []


def test_run_prints_signals_events_and_cost(call: Any, swing: Path) -> None:
    told = call("run", swing)
    assert (told.code, told.err) == (0, "")
    row = next(line.split() for line in told.out.splitlines() if line.split()[:1] == ["theta"])
    assert row[:3] == ["theta", "rad", "1.0472"]
    assert "events: " in told.out
    assert "4 s simulated in " in told.out


def test_json_has_all_but_the_samples(call: Any, swing: Path) -> None:
    data = call("run", swing, "--json").data
    assert data["span"] == [0.0, 4.0]
    assert data["signals"]["theta"]["start"] == pytest.approx(math.pi / 3)
    assert data["final"]["theta"] == pytest.approx(data["signals"]["theta"]["end"])
    assert data["event_counts"]["crossing"] == len(
        [event for event in data["events"] if event["kind"] == "crossing"]
    )
    assert data["statistics"]["steps"] > 0
    assert "samples" not in data


def test_samples_come_with_json_only(call: Any, swing: Path) -> None:
    data = call("run", swing, "--json", "--samples", "--every", "0.5").data
    assert data["samples"]["t"] == pytest.approx(np.arange(0, 4.1, 0.5))
    assert set(data["samples"]) == {"t", "theta", "omega"}
    told = call("run", swing, "--samples")
    assert told.code == 2
    assert "--samples prints samples as JSON only. Add --json" in told.err


def test_the_exact_swing_without_friction(call: Any, swing: Path) -> None:
    # theta = phi cos(sqrt(k/J) t)
    end = math.radians(10) * math.cos(math.sqrt(3.1e-3 / 4.2e-4) * 3)
    data = call(
        *("run", swing, "--preset", "free", "--set", "phi=10 deg", "--span", "0", "3"),
        *("--rtol", "1e-9", "--atol", "1e-12", "--method", "dormand_prince", "--json"),
    ).data
    assert data["final"]["theta"] == pytest.approx(end, abs=1e-7)


def test_the_step_of_rk4_is_an_option(call: Any, swing: Path) -> None:
    ends = [
        call("run", swing, "--preset", "free", "--json", *way).data["final"]["theta"]
        for way in (["--method", "rk4", "--step", "0.01"], ["--rtol", "1e-9"])
    ]
    assert ends[0] == pytest.approx(ends[1], abs=1e-7)
    told = call("run", swing, "--method", "rk4")
    assert told.code == 2 and "step" in told.err


@pytest.mark.parametrize(
    ("text", "name", "value"),
    [
        ("phi=45", "phi", math.pi / 4),  # as in the diagram's file, which has deg
        ("phi=45 deg", "phi", math.pi / 4),
        ("phi=0.5rad", "phi", 0.5),
        ("phi = -.5 rad", "phi", -0.5),
        ("k=2e-3", "k", 2e-3),
        ("slip=0.2 mN m", "slip", 2e-4),
        ("slip=2e-4 kg m^2/s^2", "slip", 2e-4),
    ],
)
def test_set_takes_units(call: Any, swing: Path, text: str, name: str, value: float) -> None:
    data = call("run", swing, "--set", text, "--json").data
    assert data["parameters"][name] == pytest.approx(value)


def test_start_takes_units(call: Any, swing: Path) -> None:
    starts = ("--start", "theta=30 deg", "--start", "omega=-1")
    data = call("run", swing, *starts, "--json").data
    assert data["start"] == pytest.approx({"theta": math.pi / 6, "omega": -1})


def test_events_prints_the_log_with_jumps(call: Any, swing: Path) -> None:
    with swing.open("a", encoding="utf-8") as file:
        file.write("events: [{when: theta - 0.5, crosses: down, set: {omega: -0.5*omega}}]\n")
    row = next(
        line.split() for line in call("run", swing, "--events").out.splitlines() if "reset" in line
    )
    before, after = float(row[-3]), float(row[-1])
    assert after == pytest.approx(-0.5 * before, rel=1e-4)
    assert "reset" not in call("run", swing, "--events", "--set", "phi=20").out


def test_a_further_signal_is_recorded(call: Any, swing: Path) -> None:
    assert "bearing" in call("run", swing, "--record", "bearing", "--json").data["signals"]
    told = call("run", swing, "--record", "berring")
    assert told.code == 2
    assert "Did you mean 'bearing'?" in told.err


def test_a_run_as_a_measured_series(call: Any, swing: Path) -> None:
    data = call("run", swing, "--series", "run_1", "--json").data
    assert data["start"]["theta"] == 0.5
    assert data["span"] == [1.0, 2.0]
    told = call("run", swing, "--series", "run_2")
    assert told.code == 2
    assert "unknown measured series 'run_2'; there are: run_1. Did you mean 'run_1'?" in told.err


def test_a_run_as_a_series_with_windows_is_that_of_the_first(call: Any, swing: Path) -> None:
    text = swing.read_text(encoding="utf-8").replace("{theta: 0.5}", "{theta: free}")
    windows = "time: t, use: {train: [1, 1.6], gate: [1.6, 2]}, "
    swing.write_text(text.replace("time: t, ", windows), encoding="utf-8")
    (swing.parent / "run_1.csv").write_text("t,angle\n1,1\n1.5,2\n1.7,3\n2,2\n", encoding="utf-8")
    assert call("run", swing, "--series", "run_1", "--json").data["span"] == [1.0, 1.5]


def test_output_as_csv_and_npz(call: Any, swing: Path, tmp_path: Path) -> None:
    table, arrays = tmp_path / "swing.csv", tmp_path / "swing.npz"
    assert f"written: {table}" in call("run", swing, "--every", "1", "--output", table).out
    with table.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["t"]) for row in rows] == [0, 1, 2, 3, 4]
    assert call("run", swing, "--output", arrays, "--json").data["written"] == [str(arrays)]
    with np.load(arrays) as found:
        assert found["theta"][0] == pytest.approx(math.pi / 3)


@pytest.mark.parametrize(("ending", "magic"), [(".png", b"\x89PNG"), (".svg", b"<?xml")])
def test_figure(call: Any, swing: Path, tmp_path: Path, ending: str, magic: bytes) -> None:
    figure = tmp_path / f"swing{ending}"
    assert call("run", swing, "--figure", figure).code == 0
    assert figure.read_bytes().startswith(magic)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--preset", "fre"], "unknown preset 'fre'; there are: free. Did you mean 'free'?"),
        (["--set", "slipp=2"], "unknown parameter 'slipp'"),
        (["--set", "slipp=2"], "Did you mean 'slip'?"),
        (["--start", "thet=2"], "unknown state 'thet'; there are: omega, theta. Did you mean"),
        (["--set", "k"], "--set 'k' is not a name, '=' and a number. Write it like --set k=2.5"),
        (["--set", "k=two"], "--set 'k=two' is not a name, '=' and a number."),
        (["--set", "=2"], "--set '=2' is not a name"),
        (["--set", "k=1.2.3"], "--set 'k=1.2.3' is not a name"),
        (["--set", "k=nan"], "--set 'k=nan' is not a name"),
        (["--start", "theta=1e"], "'e' "),
        (["--set", "k=1e999"], "--set 'k=1e999' is too large for a number."),
        (["--set", "k=1", "--set", "k=2"], "--set gives 'k' twice. Leave one out, or run"),
        (["--set", "phi=3 kg"], "--set 'phi=3 kg': 'kg' is another quantity than rad. Give it in"),
        (["--start", "omega=3 rad"], "'rad' is another quantity than rad/s."),
        (["--set", "phi=3 parsnips"], "'parsnips' is not a unit."),
        (["--method", "rosenbrok"], "Did you mean 'rosenbrock'?"),
        (["--span", "3", "1"], "the span from 3 to 1 s is empty"),
        (["--over", "k=1:2:2.5"], "the COUNT of --over 'k=1:2:2.5' is no whole number."),
        (["--over", "k=1:2:1e6"], "the COUNT of --over 'k=1:2:1e6' is no whole number."),
        (["--every", "0"], "an output every 0 s from 0 to 4 s cannot be kept"),
        (["--rtol", "0"], "rtol = 0 and atol = 0 cannot be met"),
        (["--output", "a.xls"], "unknown file ending '.xls'. End the name of the output in .csv"),
        (["--figure", "a.jpg"], "unknown file ending '.jpg'. End the name of the figure in .png"),
        (["--output", "no/such/a.csv"], "there is no folder 'no/such'. Make the folder first"),
    ],
)
def test_a_wrong_argument_is_told_in_one_line(
    call: Any, swing: Path, arguments: list[str], said: str
) -> None:
    told = call("run", swing, *arguments)
    assert told.code == 2
    assert told.out == ""
    assert said in told.err
    assert told.err.count("\n") == 1


def test_all_wrong_values_are_told_at_once(call: Any, swing: Path) -> None:
    told = call("run", swing, "--set", "kk=2", "--set", "phi", "--set", "phi=1 kg", "--json")
    assert told.code == 2
    assert len(told.data["error"]) == 3


def test_a_folder_is_no_output(call: Any, swing: Path, tmp_path: Path) -> None:
    folder = tmp_path / "out.csv"
    folder.mkdir()
    told = call("run", swing, "--output", folder)
    assert told.code == 2
    assert told.err == f"'{folder}' is a folder. Name a file.\n"


def test_a_file_that_cannot_be_written_is_told(
    call: Any, swing: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("tracewire.solve.Run.save", full)
    told = call("run", swing, "--output", "a.csv")
    assert told.code == 2
    assert told.err.startswith("'a.csv' cannot be written: No space left on device.")


def test_a_run_that_cannot_be_finished_exits_with_1(call: Any, tmp_path: Path) -> None:
    file = tmp_path / "blow.yaml"
    file.write_text(BLOW_UP, encoding="utf-8")
    told = call("run", file, "--json")
    assert told.code == 1
    assert told.data["error"][0]["block"] == "x"
    assert "t = 1" in told.err


def test_a_report_of_a_run_opens_with_the_diagram_and_has_the_series(
    call: Any, swing: Path, tmp_path: Path
) -> None:
    file = tmp_path / "run.html"
    told = call("run", swing, "--series", "run_1", "--report", file)
    assert (told.code, told.err) == (0, "")
    assert f"written: {file}" in told.out
    page = file.read_text(encoding="utf-8")
    assert page.index("The diagram") < page.index("The run") < page.index("The values")
    assert "The recorded signals, and the series run_1" in page
    assert page.count("<img") == 2


def test_measured_data_that_could_be_drawn_are_told(call: Any, swing: Path, tmp_path: Path) -> None:
    file = tmp_path / "run.png"
    hint = "without measured data; --series runs as one of these and draws it: run_1"
    assert hint in call("run", swing, "--figure", file).out.splitlines()
    assert hint not in call("run", swing, "--figure", file, "--series", "run_1").out
    assert hint not in call("run", swing, "--figure", file, "--preset", "free").out
    assert hint not in call("run", swing).out


def test_a_report_is_that_of_one_run(call: Any, swing: Path) -> None:
    told = call("run", swing, "--over", "slip=1e-4,2e-4", "--report", "run.html")
    assert told.code == 2
    assert "--output, --report, --samples and --events are those of one run" in told.err
    assert "'run.pdf': unknown file ending '.pdf'" in call("run", swing, "--report", "run.pdf").err


def test_units_that_contradict_are_told_and_the_run_goes_on(call: Any, tmp_path: Path) -> None:
    file = tmp_path / "mixed.yaml"
    lines = "".join(f"  s{n}: {{type: sum, of: [force, angle], unit: N}}\n" for n in range(5))
    file.write_text(
        "blocks:\n  force: {type: constant, value: 1, unit: N}\n"
        f"  angle: {{type: constant, value: 1, unit: rad}}\n{lines}",
        encoding="utf-8",
    )
    told = call("run", file)
    assert told.code == 0
    assert "units: " in told.err
    assert (
        "mixed.yaml:4:3: block 's0': 'force' (line 2) is in N and 'angle' (line 3) is" in told.err
    )
    assert told.err.count("cannot be added") == 3
    assert "units: 2 more; `tracewire check` tells them all." in told.err
    assert call("check", file).code == 2
