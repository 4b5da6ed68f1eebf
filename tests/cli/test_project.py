"""`tracewire.toml`: where it is looked for, what it may say, and that its use is told."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

BLOCK = """\
from tracewire.library import Block, Output

two = Block("two", "The number 2.", outputs=(Output("y", "2"),))
"""
DIAGRAM = "blocks: {a: {type: two}}\n"


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project with a library and a diagram; commands are started in a folder of it."""
    folder = tmp_path / "project"
    (folder / "blocks").mkdir(parents=True)
    (folder / "work" / "deep").mkdir(parents=True)
    (folder / "blocks" / "numbers.py").write_text(BLOCK, encoding="utf-8")
    (folder / "tracewire.toml").write_text('libraries = ["./blocks"]\n', encoding="utf-8")
    (folder / "work" / "a.yaml").write_text(DIAGRAM, encoding="utf-8")
    monkeypatch.chdir(folder / "work" / "deep")
    return folder


def test_the_libraries_of_a_project_are_used_and_told_once(call: Any, project: Path) -> None:
    told = call("check", "../a.yaml", "../a.yaml")
    assert told.code == 0
    assert told.err == f"libraries of {project / 'tracewire.toml'}: ./blocks\n"
    data = call("blocks", "two", "--json").data
    assert data["doc"] == "The number 2."


def test_a_library_of_the_command_line_is_used_too(call: Any, project: Path) -> None:
    more = project / "more.py"
    more.write_text(BLOCK.replace("two", "three"), encoding="utf-8")
    (project / "work" / "a.yaml").write_text("blocks: {a: {type: two}, b: {type: three}}")
    assert call("check", "../a.yaml", "--library", more).code == 0


def test_a_project_beside_the_diagram_only_is_not_used(
    call: Any, project: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The diagram may be a stranger's: its folder brings no Python that is run."""
    monkeypatch.chdir(tmp_path)
    told = call("check", project / "work" / "a.yaml")
    assert told.code == 2
    assert "unknown block type 'two'" in told.err
    assert "libraries of" not in told.err


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="files have no owner here")
def test_a_file_of_another_user_is_not_used(
    call: Any, project: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: (project / "tracewire.toml").stat().st_uid + 1)
    told = call("check", "../a.yaml")
    assert f"{project / 'tracewire.toml'} belongs to another user, so it is not used." in told.err
    assert "unknown block type 'two'" in told.err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("libraries = [", "this cannot be read as TOML: "),
        ("library = ['a']", "unknown key 'library'; there are: libraries. Did you mean 'libraries"),
        (
            "libraries = 'a'",
            "'libraries' must be a list of paths. Write it like libraries = [\"./b",
        ),
        ("libraries = [1]", "'libraries' must be a list of paths."),
        ("libraries = ['nothing']", "nothing: this does not exist."),
    ],
)
def test_what_is_wrong_in_it_is_told_with_the_file(
    call: Any, project: Path, text: str, message: str
) -> None:
    (project / "tracewire.toml").write_text(text, encoding="utf-8")
    told = call("check", "../a.yaml")
    assert told.code == 2
    assert message in told.err
    assert str(project) in told.err


def test_a_project_without_libraries_says_nothing(call: Any, project: Path) -> None:
    (project / "tracewire.toml").write_text("", encoding="utf-8")
    (project / "work" / "a.yaml").write_text("blocks: {a: {type: constant, value: 1}}")
    told = call("check", "../a.yaml")
    assert (told.code, told.err) == (0, "")


@pytest.mark.skipif(os.name == "nt", reason="a folder in use cannot be deleted there")
def test_a_working_folder_that_was_deleted_has_no_project(call: Any, project: Path) -> None:
    (project / "work" / "a.yaml").write_text("blocks: {a: {type: constant, value: 1}}")
    (project / "work" / "deep").rmdir()
    told = call("check", project / "work" / "a.yaml")
    assert (told.code, told.err) == (0, "")
