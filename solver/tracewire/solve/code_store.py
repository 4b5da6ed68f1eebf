"""Machine code on disk, in a folder that is the user's own and private.

Code that is read from here runs. So nothing is read from a folder or a file that belongs to
another user or that others may write to, nor a file whose SHA-256 is not the one at its beginning.
What is missing or damaged is made anew. Where nothing can be kept, it is made at each start; one
line on stderr says so, and why.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import shutil
import stat
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from tracewire.files import write_file
from tracewire.solve.limits import MEMORY

DIGEST = hashlib.sha256().digest_size
LOCK = "lock"
OTHERS = stat.S_IRWXG | stat.S_IRWXO
CACHE = "TRACEWIRE_CACHE_DIR"
"""The variable of the environment that names another folder than the system's."""
LATER = f"It is made at each start, which takes a minute. Set {CACHE} to a folder of your own."


def tell(text: str) -> None:
    """Print a line to stderr, where there is one that takes it."""
    if sys.stderr is not None:
        with contextlib.suppress(OSError, ValueError):
            print(f"tracewire: {text}", file=sys.stderr, flush=True)  # noqa: T201


class CodeStore:
    """The files of a folder by name, each with the SHA-256 of its name and content before it."""

    def __init__(self, folder: Path, tell: Callable[[str], None] = tell) -> None:
        self.folder, self.tell = folder, tell
        self._checked = self._works = self._told_damage = False

    @property
    def works(self) -> bool:
        """Whether the folder is there and private; it is made where it can be."""
        if not self._checked:
            self._checked = True
            try:
                self._works = self._prepare()
            except OSError as error:
                self._give_up(error.strerror or str(error))
        return self._works

    def read(self, name: str) -> bytes | None:
        """The content that was written under a name; None where there is none, or it is damaged."""
        if not self.works:
            return None
        flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
        try:
            with open(
                self.folder / name, "rb", opener=lambda path, _: os.open(path, flags)
            ) as file:
                status = os.fstat(file.fileno())
                whole = file.read() if _is_private(status, stat.S_IFREG) else b""
        except FileNotFoundError:
            return None
        except OSError:
            whole = b""
        content = unseal(name, whole)
        if content is None:
            self.damaged(name)
        return content

    def write(self, name: str, content: bytes) -> None:
        """Keep a content under a name, where that is possible."""
        if not self.works:
            return
        try:
            write_file(self.folder / name, seal(name, content), 0o600)
        except OSError as error:
            self._give_up(error.strerror or str(error))

    def forget_all_but(self, most: int) -> None:
        """Remove all files but those that were written last."""
        with contextlib.suppress(OSError):
            files = [file for file in self.folder.iterdir() if file.name != LOCK]
            for file in sorted(files, key=lambda file: file.stat().st_mtime)[:-most]:
                file.unlink()

    def damaged(self, name: str) -> None:
        """Remove what is there under a name, and say, once, that it is made anew."""
        with contextlib.suppress(OSError):
            (self.folder / name).unlink()
        if not self._told_damage:
            self._told_damage = True
            self.tell(f"'{self.folder / name}' is damaged: it is made anew")

    @contextmanager
    def alone(self) -> Iterator[None]:
        """Keep other processes that make it waiting, so that they find what this one makes.

        A lock ends with its process. After 10 min, and where there are no locks, nobody waits.
        """
        descriptor = self._lock() if self.works else None
        try:
            yield
        finally:
            if descriptor is not None:
                os.close(descriptor)

    def _prepare(self) -> bool:
        self.folder.parent.mkdir(parents=True, exist_ok=True)
        with contextlib.suppress(FileExistsError):
            self.folder.mkdir(mode=0o700)
        status = self.folder.lstat()
        if not stat.S_ISDIR(status.st_mode):
            return self._give_up("it is no folder")
        if not _is_own(status):
            return self._give_up("it belongs to another user")
        if not _is_private(status, stat.S_IFDIR):
            self.tell(f"'{self.folder}' was open to other users: what is in it is made anew")
            shutil.rmtree(self.folder)
            self.folder.mkdir(mode=0o700)
        return True

    def _give_up(self, reason: str) -> bool:
        self._works = False
        self.tell(f"machine code cannot be kept in '{self.folder}': {reason}. {LATER}")
        return False

    def _lock(self) -> int | None:
        try:
            import fcntl
        except ImportError:  # Windows
            return None
        flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC
        descriptor = None
        try:
            descriptor = os.open(self.folder / LOCK, flags, 0o600)
            began, told = time.monotonic(), False
            while True:
                try:
                    fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    return descriptor
                except BlockingIOError:
                    waited = time.monotonic() - began
                    if waited > MEMORY.code_wait:
                        return descriptor
                if waited > MEMORY.code_soon and not told:
                    told = True
                    self.tell("another tracewire makes this machine code: waiting for it ...")
                time.sleep(0.05)
        except OSError:
            return descriptor


def seal(name: str, content: bytes) -> bytes:
    """A content with the SHA-256 of its name and itself before it."""
    return hashlib.sha256(name.encode() + b"\0" + content).digest() + content


def unseal(name: str, whole: bytes) -> bytes | None:
    """The content that was sealed under a name; None where it is damaged."""
    content = whole[DIGEST:]
    return content if whole == seal(name, content) else None


def _is_own(status: os.stat_result) -> bool:
    """Whether it belongs to this user; on Windows the user's folder is private by itself."""
    return not hasattr(os, "geteuid") or status.st_uid == os.geteuid()


def _is_private(status: os.stat_result, kind: int) -> bool:
    """Whether it is of this kind, belongs to this user, and is closed to others."""
    if stat.S_IFMT(status.st_mode) != kind:
        return False
    return not hasattr(os, "geteuid") or (_is_own(status) and not status.st_mode & OTHERS)
