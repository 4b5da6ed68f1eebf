"""A file system that fails, or a process that dies, at the n-th call that changes a file."""

from __future__ import annotations

import builtins
import errno
import io
import os
import warnings
from collections.abc import Callable
from typing import Any

import pytest

BUFFER = 2048  # B: even a small file takes more than one write
KILLED = 99


def raising(number: int) -> Callable[[], None]:
    """A failure with the number of an error of the operating system."""

    def fail() -> None:
        raise OSError(number, os.strerror(number))

    return fail


def die() -> None:
    """What a kill is: nothing is flushed, nothing is cleaned up."""
    os._exit(KILLED)


ERRORS = {name: raising(getattr(errno, name)) for name in ("EIO", "ENOSPC")}


class Faulty:
    """Counts the calls that change files, and does `act` in place of the call number `at`."""

    def __init__(self, patch: pytest.MonkeyPatch, at: int, act: Callable[[], None]) -> None:
        self.at, self.act, self.count = at, act, 0
        for name in ("fsync", "replace", "rename", "chmod", "mkdir"):
            patch.setattr(os, name, self.counted(getattr(os, name)))
        self.os_open, self.open = os.open, builtins.open
        patch.setattr(os, "open", self.opened_by_number)
        patch.setattr(builtins, "open", self.opened)
        patch.setattr(io, "open", self.opened)

    def step(self) -> None:
        """Count a call; the one that is meant fails."""
        self.count += 1
        if self.count == self.at:
            self.act()

    def counted(self, usual: Callable[..., Any]) -> Callable[..., Any]:
        def call(*given: Any, **named: Any) -> Any:
            self.step()
            return usual(*given, **named)

        return call

    def opened_by_number(self, path: Any, flags: int, *more: Any, **named: Any) -> int:
        if flags & (os.O_WRONLY | os.O_RDWR):
            self.step()
        return self.os_open(path, flags, *more, **named)

    def opened(self, file: Any, mode: str = "r", *more: Any, **named: Any) -> Any:
        if not set(mode) & set("wax+"):
            return self.open(file, mode, *more, **named)
        if not isinstance(file, int):
            self.step()
        whole = io.BufferedWriter(
            Raw(self.step, file, mode.replace("b", "").replace("t", "")), BUFFER
        )
        if "b" in mode:
            return whole
        return io.TextIOWrapper(whole, named.get("encoding", "utf-8"), newline=named.get("newline"))


class Raw(io.FileIO):
    """A file whose writes are counted."""

    def __init__(self, step: Callable[[], None], file: Any, mode: str) -> None:
        super().__init__(file, mode)
        self.step = step

    def write(self, data: Any) -> int:
        self.step()
        return super().write(data)


def calls(work: Callable[[], object]) -> int:
    """How many calls of `work` change files."""
    with pytest.MonkeyPatch.context() as patch:
        faulty = Faulty(patch, 0, die)
        work()
        return faulty.count


def failing(work: Callable[[], object], at: int, act: Callable[[], None]) -> BaseException | None:
    """What `work` raises where its call number `at` fails."""
    with pytest.MonkeyPatch.context() as patch:
        Faulty(patch, at, act)
        try:
            work()
        except Exception as error:
            return error
    return None


def killed(work: Callable[[], object], at: int) -> bool:
    """Whether a process that does `work` died at its call number `at`."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of a fork beside other threads
        child = os.fork()
    if child == 0:
        try:
            failing(work, at, die)
        finally:
            os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == KILLED
