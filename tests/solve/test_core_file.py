"""Where the machine code of the core comes from."""

from __future__ import annotations

import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tracewire.errors import InstallationError
from tracewire.solve import core_file
from tracewire.solve.core_build.objects import join, split


@pytest.fixture
def changed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the core with another comment, without machine code; an empty cache folder."""
    there = tmp_path / "tracewire" / "solve"
    for folder in core_file.SOURCES:
        shutil.copytree(folder, there / folder.name)
    for name in ("errors.py", "files.py"):
        shutil.copy(core_file.HERE.parent / name, there.parent)
    monkeypatch.setattr(core_file, "HERE", there)
    monkeypatch.setattr(core_file, "SOURCES", tuple(there / f.name for f in core_file.SOURCES))
    monkeypatch.setattr(core_file, "PACKAGED", there / "core_library")
    monkeypatch.setenv("TRACEWIRE_CACHE_DIR", str(tmp_path / "cache"))
    with open(there / "core" / "codes.py", "a", encoding="utf-8") as file:
        file.write("# changed\n")
    return there


def test_another_text_has_another_file(changed: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    name = core_file.file_name()
    assert not core_file.is_there()
    monkeypatch.undo()
    assert core_file.file_name() != name
    assert core_file.is_there()


def test_without_numba_it_says_how_to_install(
    changed: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(core_file.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InstallationError, match=r"Install again: pip install -e \."):
        core_file.object_code()


def test_what_cannot_be_made_is_told_with_the_reason(
    changed: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    with open(changed / "core" / "codes.py", "a", encoding="utf-8") as file:
        file.write("raise ValueError('a slip of the pen')\n")
    with pytest.raises(InstallationError, match="a slip of the pen"):
        core_file.object_code()
    assert "has none yet. About a minute ..." in capfd.readouterr().err


def test_the_file_lies_beside_the_sources_then(
    changed: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those of older sources go."""
    monkeypatch.setattr(core_file, "make", lambda: b"machine code")
    core_file.PACKAGED.mkdir()
    (core_file.PACKAGED / "core-old.o").touch()
    file = core_file.put_beside_sources()
    assert [one.name for one in core_file.PACKAGED.iterdir()] == [core_file.file_name()]
    assert core_file.object_code() == b"machine code"
    assert file.read_bytes().endswith(b"machine code")


@pytest.mark.parametrize("left", [0, 10, 40, -1])
def test_a_damaged_file_of_the_package_is_not_used(
    changed: Path, left: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What LLVM makes of half an object file is a crash."""
    monkeypatch.setattr(core_file, "make", lambda: b"machine code")
    file = core_file.put_beside_sources()
    file.write_bytes(file.read_bytes()[:left])
    monkeypatch.setattr(core_file, "make", lambda: b"made anew")
    monkeypatch.setenv("TRACEWIRE_CACHE_DIR", str(changed / "another cache"))
    assert core_file.object_code() == b"made anew"


@given(st.lists(st.binary(max_size=40)))
def test_the_object_files_of_a_content_are_those_that_were_joined(objects: list[bytes]) -> None:
    assert split(join(objects)) == objects


@pytest.mark.slow
def test_machine_code_is_made_of_the_sources_alone(changed: Path) -> None:
    """The same sources have the same code, and the copy needs nothing else of the package."""
    code = core_file.object_code()
    assert len(code) > 100_000
    assert core_file.object_code() == code
    done = subprocess.run(["grep", "-c", str(changed), "-"], input=code, check=False)
    assert done.returncode == 1  # no path of this machine


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="looks for processes in /proc")
def test_the_processes_of_a_killed_build_end(tmp_path: Path) -> None:
    """They would work on for minutes, and slow down the next build."""
    command = [sys.executable, str(core_file.HERE / "core_build"), str(tmp_path / "a.o"), "generic"]
    build = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    try:
        children = Path(f"/proc/{build.pid}/task/{build.pid}/children")
        assert waited_for(lambda: len(children.read_text(encoding="ascii").split()) > 0)
        parts = children.read_text(encoding="ascii").split()
    finally:
        build.kill()
        build.wait()
    assert waited_for(lambda: not any(alive(int(part)) for part in parts))


def alive(process: int) -> bool:
    """Whether a process runs; one that has ended and that nobody asked about does not."""
    try:
        status = Path(f"/proc/{process}/stat").read_text(encoding="ascii")
    except OSError:
        return False
    return status.rpartition(")")[2].split()[0] != "Z"


def waited_for(condition: Callable[[], bool]) -> bool:
    """Whether the condition holds within 20 s."""
    until = time.monotonic() + 20.0
    while not condition() and time.monotonic() < until:
        time.sleep(0.02)
    return condition()
