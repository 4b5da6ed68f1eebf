"""`tracewire draw`: the files it writes, and what it says of what is wrong."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest


@pytest.fixture(autouse=True)
def _here(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    folder = tmp_path / "here"
    folder.mkdir()
    monkeypatch.chdir(folder)


def test_the_picture_goes_into_this_folder(call: Any, swing: Path) -> None:
    told = call("draw", swing)
    assert (told.code, told.out, told.err) == (0, "written: swing.svg\n", "")
    assert Path("swing.svg").read_text(encoding="utf-8").startswith("<svg ")


@pytest.mark.parametrize(("name", "begin"), [("a.png", b"\x89PNG"), ("a.mmd", b"flowchart LR")])
def test_the_ending_says_what_is_written(call: Any, swing: Path, name: str, begin: bytes) -> None:
    assert call("draw", swing, "--output", name).out == f"written: {name}\n"
    assert Path(name).read_bytes().startswith(begin)


def test_names_units_and_sensors_are_drawn_on_demand(call: Any, swing: Path) -> None:
    call("draw", swing, "--names", "--units", "--measured")
    picture = Path("swing.svg").read_text(encoding="utf-8")
    assert ">omega [rad/s]</text>" in picture
    assert 'class="block measured" data-block="theta"' in picture


def test_draw_as_json(call: Any, swing: Path) -> None:
    data = call("draw", swing, "--json").data
    assert data["written"] == ["swing.svg"]
    assert data["blocks"]["theta"] == "integrator"
    assert data["problems"] == []


def test_a_diagram_with_mistakes_is_drawn_and_they_are_told(call: Any, swing: Path) -> None:
    text = swing.read_text(encoding="utf-8")
    swing.write_text(text.replace("[column, bearing]", "[colum, bearing]"), encoding="utf-8")
    told = call("draw", swing)
    assert told.code == 2
    assert told.out == "written: swing.svg\n"
    assert "block 'torque': unknown signal 'colum'" in told.err
    assert "Did you mean 'column'?" in told.err
    assert 'class="block wrong" data-block="torque"' in Path("swing.svg").read_text("utf-8")


@pytest.mark.parametrize(
    ("blocks", "wrong", "words"),
    [
        ("x: {type: gain, of: y, k: 2}\n  y: {type: gain, of: x, k: 0.5}", "x", "algebraic loop"),
        ("x: {type: integrator, of: v, unit: m}\n  v: {type: constant, value: 1, unit: N}", "x",
         "needs a rate in m/s"),
    ],
)  # fmt: skip
def test_what_only_the_compiler_sees_is_red_too(
    call: Any, tmp_path: Path, blocks: str, wrong: str, words: str
) -> None:
    file = tmp_path / "wrong.yaml"
    file.write_text(f"blocks:\n  {blocks}\n", encoding="utf-8")
    told = call("draw", file)
    assert (told.code, told.out) == (2, "written: wrong.svg\n")
    assert words in told.err
    assert f'class="block wrong" data-block="{wrong}"' in Path("wrong.svg").read_text("utf-8")


def test_measured_files_need_not_be_there(call: Any, swing: Path) -> None:
    swing.with_name("run_1.csv").unlink()
    told = call("draw", swing)
    assert (told.code, told.err) == (0, "")
    assert Path("swing.svg").exists()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--output", "a.pdf"], "'a.pdf': unknown file ending '.pdf'. End the name of the picture"),
        (["--output", "no/a.svg"], "there is no folder 'no'"),
        (["--depth", "-1"], "the depth of a picture cannot be -1. 0 draws subsystems as boxes"),
    ],
)
def test_a_wrong_option_is_told(call: Any, swing: Path, options: list[str], words: str) -> None:
    told = call("draw", swing, *options)
    assert told.code == 2
    assert words in told.err
    assert list(Path().iterdir()) == []


def test_a_file_that_is_no_diagram_is_told(call: Any, tmp_path: Path) -> None:
    told = call("draw", tmp_path / "swig.yaml")
    assert told.code == 2
    assert "swig.yaml" in told.err
    file = tmp_path / "list.yaml"
    file.write_text("[1, 2]\n", encoding="utf-8")
    assert call("draw", file).code == 2
    assert list(Path().iterdir()) == []
