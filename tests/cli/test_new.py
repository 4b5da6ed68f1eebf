"""`tracewire new`: the starts pass their tests as they are, and nothing is written over."""

from __future__ import annotations

import json
import re
import runpy
import tomllib
from pathlib import Path
from typing import Any

import pytest
from library.installed import install
from tracewire.diagram import is_modeline, schema_of
from tracewire.library import load_library


def run_tests(file: Path) -> int:
    """Run the tests of a file; how many there are."""
    tests = [f for name, f in runpy.run_path(str(file)).items() if name.startswith("test_")]
    for test in tests:
        test()
    return len(tests)


@pytest.mark.parametrize(("kind", "ending"), [("block", ".py"), ("diagram", ".yaml")])
def test_a_start_passes_its_test(call: Any, tmp_path: Path, kind: str, ending: str) -> None:
    told = call("new", kind, "bumper", "--to", tmp_path / "further", "--json")
    files = [tmp_path / "further" / f"bumper{ending}", tmp_path / "further" / "test_bumper.py"]
    more = [tmp_path / "further" / ".tracewire" / "schema.json"] if kind == "diagram" else []
    assert told.data == {"written": [str(file) for file in files + more]}
    assert run_tests(files[1]) == 1


def test_the_block_and_the_diagram_are_told_how_to_go_on(
    call: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    last = call("new", "block", "bumper").out.splitlines()[-1]
    assert last == "'tracewire blocks bumper --library bumper.py' shows it."
    assert call("blocks", "bumper", "--library", "bumper.py").out.startswith("bumper: A spring")
    assert call("new", "diagram", "rig").out.endswith("'tracewire run rig.yaml' runs it.\n")
    assert call("check", "rig.yaml").code == 0


def test_a_library_is_whole(call: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert call("new", "library", "my_lab", "--to", tmp_path).code == 0
    project = tmp_path / "my-lab-blocks"
    declared = tomllib.loads((project / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert declared["entry-points"] == {"tracewire.blocks": {"my_lab": "my_lab_blocks"}}
    assert declared["name"] == "my-lab-blocks"
    monkeypatch.syspath_prepend(project)  # as an editable install does
    install(tmp_path / "site", {}, "my_lab", declared["version"], declared["name"])
    monkeypatch.syspath_prepend(tmp_path / "site")
    assert run_tests(project / "tests" / "test_my_lab.py") == 2
    assert call("check", project / "example.yaml").code == 0
    assert "`type: my_lab.hard_spring`" in (project / "README.md").read_text(encoding="utf-8")
    written = (file for file in project.rglob("*.*") if file.suffix not in ("", ".json"))
    assert not any(
        re.search(r"\$(?!schema=)", file.read_text(encoding="utf-8")) for file in written
    )


def test_the_diagrams_of_a_start_name_the_schema_beside_them(call: Any, tmp_path: Path) -> None:
    assert call("new", "library", "my_lab", "--to", tmp_path).code == 0
    assert call("new", "diagram", "rig", "--to", tmp_path).code == 0
    files = sorted(tmp_path.rglob("*.yaml"))
    assert [file.name for file in files] == ["example.yaml", "masses.yaml", "rig.yaml"]
    for file in files:
        first = file.read_text(encoding="utf-8").splitlines()[0]
        assert is_modeline(first)
        schema = file.parent / first.partition("$schema=")[2]
        assert json.loads(schema.read_text(encoding="utf-8")) == schema_of(load_library())
    again = call("new", "diagram", "other", "--to", tmp_path, "--json").data["written"]
    assert not any("schema" in path for path in again)


@pytest.mark.parametrize("kind", ["block", "diagram", "library"])
def test_files_that_exist_stay_as_they_are(call: Any, tmp_path: Path, kind: str) -> None:
    assert call("new", kind, "bumper", "--to", tmp_path).code == 0
    (changed,) = tmp_path.rglob("test_bumper.py")
    changed.write_text("mine", encoding="utf-8")
    others = [file for file in tmp_path.rglob("*.*") if file.is_file() and file != changed]
    for file in others:
        file.unlink()
    told = call("new", kind, "bumper", "--to", tmp_path)
    assert told.code == 2
    assert told.err.startswith(f"'{changed}' exists already. Choose another name, or name another")
    assert changed.read_text(encoding="utf-8") == "mine"
    assert not any(file.exists() for file in others)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["block", "gain"], "tracewire has a block 'gain' already. Choose another name."),
        (["library", "gain"], "tracewire has a block 'gain' already. Choose another name."),
        (["library", "tracewire"], "'tracewire' cannot be the name of a library. tracewire has it"),
        (["library", "x"], "'x' cannot be the name of a library. Use two letters or more."),
        (["block", "../x"], "'../x' cannot be the name of a block. Use the letters a to z"),
        (["diagram", "a b"], "'a b' cannot be the name of a diagram. Use the letters a to z"),
        (["library", "sin"], "'sin' cannot be the name of a library. 'sin' is a word of formulas"),
        (["block", ""], "'' cannot be the name of a block."),
    ],
)
def test_a_name_is_checked(call: Any, tmp_path: Path, arguments: list[str], message: str) -> None:
    told = call("new", *arguments, "--to", tmp_path)
    assert told.code == 2
    assert message in told.err
    assert not any(tmp_path.iterdir())


def test_a_folder_that_cannot_be_made_is_told(call: Any, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    told = call("new", "diagram", "rig", "--to", tmp_path / "file")
    assert told.code == 2
    assert told.err.startswith(f"'{tmp_path / 'file'}' cannot be written: ")
