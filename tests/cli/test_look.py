"""`check`, `show` and `blocks`: what they tell of a good diagram, and of a broken one."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

BLOCK = """\
from tracewire.library import Block, Input, Output

doubled = Block(
    name="doubled",
    doc="Twice its input.",
    inputs=(Input("of"),),
    outputs=(Output("twice", "2*of"),),
)
"""


def replaced(file: Path, old: str, new: str) -> Path:
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")
    return file


def test_check_counts_what_is_there(call: Any, swing: Path) -> None:
    told = call("check", swing)
    assert (told.code, told.err) == (0, "")
    lines = told.out.splitlines()
    assert lines[0] == "Pendulum with a dry bearing"
    assert lines[-1] == "no problems"
    assert any("free in a fit: k, slip" in line for line in lines)
    assert any("run_1 (train): 3 samples from 1 to 2 s of theta" in line for line in lines)


def test_check_does_not_end_with_no_problems_where_a_measured_file_is_not_there(
    call: Any, swing: Path
) -> None:
    text = re.sub(r"file: \S+csv", "file: nothing.csv", swing.read_text(encoding="utf-8"))
    swing.write_text(text, encoding="utf-8")
    told = call("check", swing)
    assert told.code == 0
    assert told.out.splitlines()[-1] == (
        "no problems in the diagram, but 1 measured series has no file, which a fit or a trace"
        " needs: see above"
    )


def test_check_as_json(call: Any, swing: Path) -> None:
    data = call("check", swing, "--json").data
    assert data["problems"] == []
    assert (data["blocks"], data["parameters"]) == (6, 4)
    assert data["states"] == ["theta", "omega"]
    assert data["presets"] == ["free"]
    assert data["measured"][0]["samples"] == 3


def test_a_missing_diagram_is_named_with_its_neighbours(call: Any, swing: Path) -> None:
    told = call("check", swing.with_name("swig.yaml"))
    assert told.code == 2
    assert "swig.yaml" in told.err
    assert "Did you mean 'swing.yaml'?" in told.err


def test_every_problem_of_a_diagram_is_told_at_once_with_its_place(call: Any, swing: Path) -> None:
    replaced(swing, "type: integrator, of: alpha", "type: integratr, of: alpha")
    replaced(swing, "[column, bearing]", "[colum, bearing]")
    told = call("check", swing, "--json")
    assert told.code == 2
    assert told.err.count("\n") == 2
    told_of = [(p["line"], p["block"], p["hint"]) for p in told.data["error"]]
    assert told_of == [
        (11, "omega", "Did you mean 'integrator'?"),
        (14, "torque", "Did you mean 'column'?"),
    ]


def test_check_reads_the_measured_files(call: Any, swing: Path) -> None:
    replaced(swing.with_name("run_1.csv"), "1.5,0.2", "1.5,o.2")
    told = call("check", swing)
    assert told.code == 2
    assert "run_1.csv:3" in told.err


def test_check_tells_what_is_done_to_the_data_and_what_is_odd(call: Any, swing: Path) -> None:
    (swing.parent / "run_1.csv").write_text("t [ms],angle\n0,1\n500,1\n900,1\n1900,1\n")
    told = call("check", swing).out
    assert "- time: from ms to s, as the header says" in told
    assert "! theta is constant: 1 in every sample" in told
    (series,) = call("check", swing, "--json").data["measured"]
    assert series["steps"] == ["time: from ms to s, as the header says"]
    assert series["remarks"][0].startswith("the time step is not regular: 0.4 to 1 s, median 0.5 s")
    assert series["remarks"][-1] == "4 samples: a trace needs 40 at least"


def test_check_tells_the_declared_noise_in_the_unit_of_the_column(call: Any, swing: Path) -> None:
    """A sigma is in the unit of the column, which the header alone may say."""
    replaced(swing, "column: angle}", "column: angle, sigma: 0.1}")
    (swing.parent / "run_1.csv").write_text("t,angle [deg]\n0,1\n1,2\n1.5,3\n2,2\n")
    assert "- theta: noise of σ = 0.1 deg" in call("check", swing).out
    (series,) = call("check", swing, "--json").data["measured"]
    assert series["sigma"]["theta"] == pytest.approx(np.radians(0.1))


def test_check_tells_noise_and_rounding_in_the_unit_that_the_diagram_gives_the_column(
    call: Any, swing: Path
) -> None:
    replaced(swing, "column: angle}", "column: angle, unit: deg}")
    angles = np.round(20 * np.sin(0.3 * np.arange(400)))
    rows = [f"{t:.2f},{x:g}" for t, x in zip(0.01 * np.arange(400), angles, strict=True)]
    (swing.parent / "run_1.csv").write_text("\n".join(["t,angle", *rows, ""]))
    told = call("check", swing).out
    assert "! theta is read in steps of 1 deg (40 over its range)" in told
    (series,) = call("check", swing, "--json").data["measured"]
    sigma = np.degrees(series["estimated_sigma"]["theta"])
    assert f"- theta: noise of σ = {sigma:.4g} deg, estimated (" in told


def test_check_tells_the_noise_that_it_estimates(call: Any, swing: Path) -> None:
    noise = 0.01 * np.random.default_rng(2).standard_normal(400)
    rows = [f"{t:.3f},{x:.6f}" for t, x in zip(0.01 * np.arange(400), noise, strict=True)]
    (swing.parent / "run_1.csv").write_text("\n".join(["t,angle [rad]", *rows, ""]))
    (series,) = call("check", swing, "--json").data["measured"]
    assert series["sigma"] == {}
    assert series["estimated_sigma"]["theta"] == pytest.approx(0.01, rel=0.2)
    told = f"- theta: noise of σ = {series['estimated_sigma']['theta']:.4g} rad, estimated ("
    assert told in call("check", swing).out


def test_check_tells_the_windows_of_a_series(call: Any, swing: Path) -> None:
    replaced(swing, "time: t, ", "time: t, use: {train: [1, 1.6], gate: [1.6, 2]}, ")
    replaced(swing, "start: {theta: 0.5}", "start: {theta: free}")
    (swing.parent / "run_1.csv").write_text("t,angle\n1,1\n1.5,2\n1.7,3\n2,2\n")
    told = call("check", swing).out
    assert "run_1 (train): 2 samples from 1 to 1.5 s of theta" in told
    assert "run_1 (gate): 2 samples from 1.7 to 2 s of theta" in told


@pytest.mark.parametrize(
    ("text", "code", "told"),
    [
        (
            "span: [0, 1]\nparameters: {m: 1}\nrequire: [m > 0]\n"
            "blocks: {x: {type: integrator, of: r}, r: {type: constant, value: 1/m}}\n"
            "presets: {upside_down: {m: -2}}\n",
            1,
            "decay.yaml:3:11: the parameters do not meet 'm > 0': m = -2.",
        ),
        (
            "inputs: {u: {unit: 1/s}}\nparameters: {m: {value: 1, unit: 1}}\n"
            "blocks: {x: {type: integrator, of: r, start: 1/m}, r: {type: gain, of: u, k: 1}}\n"
            "presets: {massless: {m: 0}}\n",
            2,
            "decay.yaml:3:10: block 'x': the start of 'x' is inf. A start is a finite number",
        ),
    ],
)
def test_check_tells_what_a_run_of_a_preset_would_refuse(
    text: str, code: int, told: str, call: Any, tmp_path: Path
) -> None:
    file = tmp_path / "decay.yaml"
    file.write_text(text, encoding="utf-8")
    found = call("check", file)
    assert (found.code, found.out) == (code, "")
    assert told in found.err


def test_check_names_a_measured_file_that_is_missing(call: Any, swing: Path) -> None:
    swing.with_name("run_1.csv").unlink()
    told = call("check", swing)
    assert told.code == 0
    assert f"!           {swing}:19:3: series 'run_1': unknown file 'run_1.csv'" in told.out


def test_show_tells_what_stands_in_the_file_with_its_unit(call: Any, tmp_path: Path) -> None:
    file = tmp_path / "area.yaml"
    text = "parameters: {A: {value: 12, unit: cm^2}}\nblocks: {y: {type: constant, value: A}}\n"
    file.write_text(text, encoding="utf-8")
    (row,) = (line for line in call("show", file, "--parameters").out.splitlines() if " A " in line)
    assert row.split() == ["A", "0.0012", "m^2", "12", "cm^2"]


def test_show_has_parameters_states_signals_and_places(call: Any, swing: Path) -> None:
    out = call("show", swing).out
    for words in ("0.001 to 0.01", "free", "kg m^2", "recorded signals", "presets: free"):
        assert words in out
    # 60 deg is shown in SI, and beside it as the file has it
    assert any(line.split()[:3] == ["phi", "1.0472", "rad"] for line in out.splitlines())
    places = [line.split() for line in out.splitlines()]
    assert ["torque", "sum", "omega", "theta"] in places
    assert ["sensor.theta", "sensor"] in places


def test_show_as_json(call: Any, swing: Path) -> None:
    data = call("show", swing, "--json").data
    assert data["parameters"]["k"]["fit"] == [1e-3, 1e-2]
    assert data["parameters"]["slip"]["fit"] == [None, None]  # infinite bounds are no JSON
    torque, sensor = data["places"]
    assert (torque["name"], torque["kind"]) == ("torque", "sum")
    assert (torque["q"], torque["v"], torque["a"]) == ("theta", "omega", "alpha")
    assert (sensor["name"], sensor["kind"]) == ("sensor.theta", "sensor")
    assert data["states"][0] == {"name": "theta", "unit": "rad", "start": "phi", "rate": "omega"}
    assert "source" not in data


def test_show_equations_has_the_users_names_and_nothing_else(call: Any, swing: Path) -> None:
    lines = call("show", swing, "--equations").out.splitlines()
    assert "theta' = omega" in lines
    assert "torque = column + bearing" in lines
    assert not any("recorded" in line for line in lines)


def test_show_source_is_python(call: Any, swing: Path) -> None:
    source = call("show", swing, "--source").out
    assert {"rhs", "guards"} <= set(compile(source, "source", "exec").co_names)
    assert call("show", swing, "--source", "--json").data["source"].rstrip() == source.rstrip()


def test_show_text_is_the_whole_diagram(call: Any, swing: Path) -> None:
    file = swing.with_name("other.yaml")
    file.write_text("extends: swing.yaml\ntitle: other\n", encoding="utf-8")
    text = call("show", file, "--text").out
    assert text.startswith("title: other\n") and "\nblocks:\n  theta: {type: integrator," in text
    assert call("show", file, "--text", "--json").data["text"].rstrip() == text.rstrip()
    whole = swing.with_name("whole.yaml")
    whole.write_text(text, encoding="utf-8")
    assert call("check", whole).out == call("check", file).out
    assert "\nno problems" in call("check", file.parent).out


def test_show_tree_goes_into_subsystems(call: Any, swing: Path) -> None:
    replaced(
        swing, "bearing: {type: dry_friction, rate: omega, slip: slip}", "bearing: {type: rub}"
    )
    replaced(swing, "[column, bearing]", "[column, -bearing.out]")
    with swing.open("a", encoding="utf-8") as file:
        file.write(
            "subsystems:\n  rub:\n    outputs: {out: still}\n"
            "    blocks: {still: {type: constant, value: 0}}\n"
        )
    lines = call("show", swing, "--tree").out.splitlines()
    inside = next(n for n, line in enumerate(lines) if line.split()[0] == "bearing") + 1
    assert lines[inside].split() == ["still", "constant"]
    assert lines[inside].startswith("    ")
    assert lines[inside + 1].split() == ["torque", "sum", "of:", "column", "-bearing.out"]
    data = call("show", swing, "--tree", "--json").data
    assert data["tree"][3]["blocks"][0]["name"] == "still"


def test_blocks_lists_them_and_describes_one(call: Any) -> None:
    listed = call("blocks").out
    assert "dry_friction" in listed
    assert "integrator" in listed
    assert "slip" in call("blocks", "dry_friction").out


def test_blocks_as_json(call: Any) -> None:
    one = call("blocks", "gain", "--json").data
    every = call("blocks", "--json").data["blocks"]
    assert one in every
    assert one["parameters"][0]["name"] == "k"


def test_an_unknown_block_is_told_with_the_nearest(call: Any) -> None:
    told = call("blocks", "dry_frction")
    assert told.code == 2
    assert "Did you mean 'dry_friction'?" in told.err


def test_a_library_of_the_user_is_read_where_it_is_named(
    call: Any, swing: Path, tmp_path: Path
) -> None:
    library = tmp_path / "mine.py"
    library.write_text(BLOCK, encoding="utf-8")
    replaced(swing, "column: {type: gain, of: theta, k: -k, unit: N m}",
             "column: {type: doubled, of: theta}")  # fmt: skip
    assert call("check", swing).code == 2
    assert call("check", swing, "--library", library).code == 0
    assert "Twice its input." in call("blocks", "doubled", "--library", library).out


@pytest.mark.parametrize("content", ["x = 1/0\n", "def broken(:\n"])
def test_a_library_that_fails_is_named(call: Any, tmp_path: Path, content: str) -> None:
    library = tmp_path / "mine.py"
    library.write_text(content, encoding="utf-8")
    told = call("blocks", "--library", library)
    assert told.code == 2
    assert f"{library}:1: the block file cannot be read" in told.err
