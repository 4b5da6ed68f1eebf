"""Ctrl-C while the machine code of the core is loaded."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from tracewire.solve import loading


@pytest.fixture
def heard() -> Iterator[None]:
    """Ctrl-C is a KeyboardInterrupt, as in a program of its own."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    loading.load_core.cache_clear()
    yield
    signal.signal(signal.SIGINT, before)
    loading.load_core.cache_clear()


def test_ctrl_c_is_heard_when_the_core_is_loaded(
    heard: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An exception inside of a callback of LLVM ended the process with signal 11."""
    done: list[Callable[..., Any]] = []

    def interrupted(function: Callable[..., Any]) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        done.append(function)

    monkeypatch.setattr(loading.STORE, "read", lambda name: b"")
    monkeypatch.setattr(loading, "ready", interrupted)
    with pytest.raises(KeyboardInterrupt):
        loading.load_core()
    assert done == [loading.advance]


def test_nothing_is_loaded_that_is_to_be_compiled_first(
    heard: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """That takes minutes, which Ctrl-C ends at once."""
    monkeypatch.setattr(loading.STORE, "read", lambda name: None)
    monkeypatch.setattr(loading, "ready", pytest.fail)
    loading.load_core()
