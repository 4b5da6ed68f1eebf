"""Compiled code is read only where it is the user's own, private and whole; else it is made."""

from __future__ import annotations

import errno
import os
import pickle
import shutil
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import numba
import pytest
from tracewire.cli import main
from tracewire.solve.code_store import DIGEST, CodeStore, FunctionCode
from tracewire.solve.core import jit

SWING = """\
span: [0, 1]
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  a: {type: gain, of: x, k: -1}
"""


class Trap:
    """What runs when it is unpickled."""

    sprung = False

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        return spring, ()


def spring() -> None:
    Trap.sprung = True


def twice(x: float) -> float:
    return 2 * x


@pytest.fixture
def said() -> list[str]:
    return []


@pytest.fixture
def store(tmp_path: Path, said: list[str]) -> CodeStore:
    return CodeStore(tmp_path / "cache" / "core", said.append)


def compiled(store: CodeStore) -> Any:
    """The function, compiled or from the store; it has been called once."""
    built = numba.njit(twice)
    built._cache = FunctionCode(twice, store)
    assert built(4.0) == 8.0
    return built.stats


def only_file(store: CodeStore) -> Path:
    (file,) = store.folder.iterdir()
    return file


def test_a_function_is_compiled_once(store: CodeStore, said: list[str]) -> None:
    assert compiled(store).cache_misses
    assert compiled(CodeStore(store.folder)).cache_hits
    assert store.folder.stat().st_mode & 0o777 == 0o700
    assert only_file(store).stat().st_mode & 0o777 == 0o600
    assert said == []


@pytest.mark.parametrize("left", [0, 1, DIGEST - 1, DIGEST, DIGEST + 1, 500, -1])
def test_a_truncated_file_is_made_anew(store: CodeStore, said: list[str], left: int) -> None:
    compiled(store)
    file = only_file(store)
    whole = file.read_bytes()
    file.write_bytes(whole[:left])
    assert compiled(store).cache_misses
    assert len(said) == 1
    assert f"'{file}' is damaged: what is damaged there is compiled anew" in said[0]
    assert compiled(CodeStore(store.folder)).cache_hits


def test_any_changed_byte_is_found(store: CodeStore, said: list[str]) -> None:
    store.write("a", b"content")
    file = store.folder / "a"
    whole = file.read_bytes()
    for place in range(len(whole)):
        file.write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
        assert store.read("a") is None
    assert len(said) == 1
    store.write("a", b"content")
    assert store.read("a") == b"content"


def test_a_file_under_another_name_is_damaged(store: CodeStore, said: list[str]) -> None:
    store.write("a", b"content")
    (store.folder / "a").rename(store.folder / "b")
    assert store.read("b") is None
    assert said != []


def test_what_numba_cannot_use_is_made_anew(store: CodeStore, said: list[str]) -> None:
    compiled(store)
    store.write(only_file(store).name, pickle.dumps((1, 2, 3)))
    assert compiled(store).cache_misses
    assert len(said) == 1
    assert compiled(CodeStore(store.folder)).cache_hits


def planted(store: CodeStore) -> Path:
    """The file of the function, with a whole and valid content that would run code."""
    compiled(store)
    file = only_file(store)
    store.write(file.name, pickle.dumps(Trap()))
    return file


def test_the_trap_would_spring(store: CodeStore) -> None:
    planted(store)
    Trap.sprung = False
    compiled(store)
    assert Trap.sprung


@pytest.mark.parametrize("permissions", [0o777, 0o707, 0o770, 0o750, 0o701])
def test_nothing_is_read_from_a_folder_that_is_open_to_others(
    store: CodeStore, said: list[str], permissions: int
) -> None:
    planted(store)
    Trap.sprung = False
    store.folder.chmod(permissions)
    compiled(CodeStore(store.folder, said.append))
    assert not Trap.sprung
    assert "was open to other users: what is in it is compiled anew" in said[0]
    assert compiled(CodeStore(store.folder)).cache_hits


def test_nothing_is_read_from_a_folder_of_another_user(
    store: CodeStore, said: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    file = planted(store)
    Trap.sprung = False
    before = file.read_bytes()
    monkeypatch.setattr(os, "geteuid", lambda: file.stat().st_uid + 1)
    compiled(CodeStore(store.folder, said.append))
    assert not Trap.sprung
    assert file.read_bytes() == before
    assert "it belongs to another user. The integrators are compiled at each start" in said[0]


def test_nothing_is_read_from_a_file_that_is_open_to_others(
    store: CodeStore, said: list[str]
) -> None:
    file = planted(store)
    Trap.sprung = False
    file.chmod(0o666)
    compiled(store)
    assert not Trap.sprung
    assert len(said) == 1


def test_nothing_is_read_through_a_link(store: CodeStore, said: list[str], tmp_path: Path) -> None:
    file = planted(store)
    Trap.sprung = False
    file.rename(tmp_path / "elsewhere")
    file.symlink_to(tmp_path / "elsewhere")
    compiled(store)
    assert not Trap.sprung
    link = tmp_path / "link"
    link.symlink_to(store.folder)
    assert not CodeStore(link, said.append).works
    assert "it is no folder" in said[-1]


def test_a_pipe_does_not_hold_it_up(store: CodeStore, said: list[str]) -> None:
    compiled(store)
    file = only_file(store)
    file.unlink()
    os.mkfifo(file, 0o600)
    assert compiled(store).cache_misses
    assert len(said) == 1


def test_no_folder_takes_the_place_of_the_user_s_own(
    tmp_path: Path, said: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "home").touch()
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    monkeypatch.setattr(jit.platformdirs, "user_cache_path", lambda name: tmp_path / "home" / name)
    folder = jit._folder()
    assert folder.parent == tmp_path / "home" / "tracewire"
    assert not CodeStore(folder, said.append).works
    assert "compiled code cannot be kept" in said[0]


def test_without_a_folder_it_compiles_and_says_why(tmp_path: Path, said: list[str]) -> None:
    (tmp_path / "file").touch()
    store = CodeStore(tmp_path / "file" / "core", said.append)
    compiled(store)
    compiled(store)
    assert len(said) == 1
    assert f"compiled code cannot be kept in '{tmp_path}/file/core': " in said[0]
    assert "Set NUMBA_CACHE_DIR to a folder of your own." in said[0]


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EROFS, errno.EIO])
def test_without_space_it_compiles_and_says_why(
    store: CodeStore, said: list[str], number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(number, os.strerror(number))

    store.write("early", b"content")
    monkeypatch.setattr(os, "fsync", full)
    compiled(store)
    store.write("late", b"content")
    assert len(said) == 1
    assert os.strerror(number) in said[0]
    assert [file.name for file in store.folder.iterdir()] == ["early"]


def test_one_process_compiles_and_another_waits(store: CodeStore) -> None:
    order = []
    inside = threading.Event()

    def first() -> None:
        with store.alone():
            inside.set()
            threading.Event().wait(0.2)
            order.append("first")

    thread = threading.Thread(target=first)
    thread.start()
    inside.wait()
    with CodeStore(store.folder).alone():
        order.append("second")
    thread.join()
    assert order == ["first", "second"]


def test_a_killed_process_holds_nobody_up(store: CodeStore) -> None:
    text = "import sys, time; from pathlib import Path\n"
    text += "from tracewire.solve.code_store import CodeStore\n"
    text += "with CodeStore(Path(sys.argv[1])).alone():\n    print(flush=True); time.sleep(60)"
    environment = {**os.environ, "PYTHONPATH": ":".join(p for p in sys.path if p)}
    child = subprocess.Popen(
        [sys.executable, "-c", text, store.folder], stdout=subprocess.PIPE, env=environment
    )
    assert child.stdout is not None
    child.stdout.readline()
    child.send_signal(signal.SIGKILL)
    child.communicate()
    entered = threading.Event()

    def enter() -> None:
        with store.alone():
            entered.set()

    thread = threading.Thread(target=enter, daemon=True)
    thread.start()
    assert entered.wait(30)


@pytest.mark.slow
def test_a_damaged_core_runs_and_is_whole_again(tmp_path: Path) -> None:
    """The real core: some files are cut, some are noise; one line is told, and only once."""
    swing = tmp_path / "swing.yaml"
    swing.write_text(SWING, encoding="utf-8")
    assert main(["run", str(swing)]) == 0
    folder = tmp_path / jit.STORE.folder.name
    shutil.copytree(jit.STORE.folder, folder)
    files = [file for file in sorted(folder.iterdir()) if file.name.startswith("modes.")]
    whole = [file.read_bytes() for file in files]
    assert len(files) > 1
    for number, file in enumerate(files):
        file.write_bytes(whole[number][: number * 40] if number % 2 else os.urandom(300))
    environment = {
        **os.environ,
        "PYTHONPATH": ":".join(p for p in sys.path if p),
        "NUMBA_CACHE_DIR": str(tmp_path),
    }
    lines = []
    for _ in range(2):
        command = [sys.executable, "-m", "tracewire", "run", str(swing)]
        done = subprocess.run(command, env=environment, capture_output=True, text=True)
        assert done.returncode == 0
        lines.append([line for line in done.stderr.splitlines() if "damaged" in line])
    assert [len(found) for found in lines] == [1, 0]
