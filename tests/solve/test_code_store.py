"""Machine code is read only where it is the user's own, private and whole; else it is made."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from tracewire.solve.code_store import DIGEST, LOCK, CodeStore
from tracewire.solve.core_file import kept_or_made
from tracewire.solve.limits import MEMORY

NAME = "core.o"
CODE = b"machine code" * 100
PLANTED = b"machine code of another"


@pytest.fixture
def said() -> list[str]:
    return []


@pytest.fixture
def store(tmp_path: Path, said: list[str]) -> CodeStore:
    return CodeStore(tmp_path / "cache" / "core", said.append)


def is_made(store: CodeStore) -> bool:
    """Whether the code was made when it was asked for; else it was read from the store."""
    times = []

    def make() -> bytes:
        times.append(1)
        return CODE

    assert kept_or_made(NAME, store, make) == CODE
    return bool(times)


def code_of(store: CodeStore) -> Path:
    return store.folder / NAME


def test_code_is_made_once(store: CodeStore, said: list[str]) -> None:
    assert is_made(store)
    assert not is_made(CodeStore(store.folder))
    assert store.folder.stat().st_mode & 0o777 == 0o700
    assert code_of(store).stat().st_mode & 0o777 == 0o600
    assert said == []


def test_code_of_old_sources_is_removed(store: CodeStore) -> None:
    for number in range(MEMORY.core_files + 3):
        store.write(f"old-{number}.o", CODE)
        os.utime(store.folder / f"old-{number}.o", (number, number))
    assert is_made(store)
    left = sorted(file.name for file in store.folder.iterdir() if file.name != LOCK)
    assert left == [NAME, *(f"old-{number}.o" for number in range(4, 4 + MEMORY.core_files - 1))]


def test_what_waits_for_another_process_takes_its_code(store: CodeStore) -> None:
    with store.alone():
        thread = threading.Thread(target=lambda: made.append(is_made(CodeStore(store.folder))))
        made: list[bool] = []
        thread.start()
        store.write(NAME, CODE)
    thread.join()
    assert made == [False]


@pytest.mark.parametrize("left", [0, 1, DIGEST - 1, DIGEST, DIGEST + 1, 500, -1])
def test_a_truncated_file_is_made_anew(store: CodeStore, said: list[str], left: int) -> None:
    assert is_made(store)
    file = code_of(store)
    whole = file.read_bytes()
    file.write_bytes(whole[:left])
    assert is_made(store)
    assert len(said) == 1
    assert f"'{file}' is damaged: it is made anew" in said[0]
    assert not is_made(CodeStore(store.folder))


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


def planted(store: CodeStore) -> Path:
    """The file of the code, with another content that is whole and valid."""
    assert is_made(store)
    store.write(NAME, PLANTED)
    assert store.read(NAME) == PLANTED
    return code_of(store)


@pytest.mark.parametrize("permissions", [0o777, 0o707, 0o770, 0o750, 0o701])
def test_nothing_is_read_from_a_folder_that_is_open_to_others(
    store: CodeStore, said: list[str], permissions: int
) -> None:
    planted(store)
    store.folder.chmod(permissions)
    assert is_made(CodeStore(store.folder, said.append))
    assert "was open to other users: what is in it is made anew" in said[0]
    assert not is_made(CodeStore(store.folder))


def test_nothing_is_read_from_a_folder_of_another_user(
    store: CodeStore, said: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    file = planted(store)
    before = file.read_bytes()
    monkeypatch.setattr(os, "geteuid", lambda: file.stat().st_uid + 1)
    assert is_made(CodeStore(store.folder, said.append))
    assert file.read_bytes() == before
    assert "it belongs to another user. It is made at each start" in said[0]


def test_nothing_is_read_from_a_file_that_is_open_to_others(
    store: CodeStore, said: list[str]
) -> None:
    file = planted(store)
    file.chmod(0o666)
    assert is_made(store)
    assert len(said) == 1


def test_nothing_is_read_through_a_link(store: CodeStore, said: list[str], tmp_path: Path) -> None:
    file = planted(store)
    file.rename(tmp_path / "elsewhere")
    file.symlink_to(tmp_path / "elsewhere")
    assert is_made(store)
    link = tmp_path / "link"
    link.symlink_to(store.folder)
    assert not CodeStore(link, said.append).works
    assert "it is no folder" in said[-1]


def test_a_pipe_does_not_hold_it_up(store: CodeStore, said: list[str]) -> None:
    assert is_made(store)
    file = code_of(store)
    file.unlink()
    os.mkfifo(file, 0o600)
    assert is_made(store)
    assert len(said) == 1


def test_without_a_folder_it_makes_the_code_and_says_why(tmp_path: Path, said: list[str]) -> None:
    (tmp_path / "file").touch()
    store = CodeStore(tmp_path / "file" / "core", said.append)
    assert is_made(store)
    assert is_made(store)
    assert len(said) == 1
    assert f"machine code cannot be kept in '{tmp_path}/file/core': " in said[0]
    assert "Set TRACEWIRE_CACHE_DIR to a folder of your own." in said[0]


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EROFS, errno.EIO])
def test_without_space_it_makes_the_code_and_says_why(
    store: CodeStore, said: list[str], number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(number, os.strerror(number))

    store.write("early", b"content")
    monkeypatch.setattr(os, "fsync", full)
    assert is_made(store)
    store.write("late", b"content")
    assert len(said) == 1
    assert os.strerror(number) in said[0]
    assert {file.name for file in store.folder.iterdir()} == {"early", LOCK}


def test_one_process_makes_it_and_another_waits(store: CodeStore) -> None:
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
