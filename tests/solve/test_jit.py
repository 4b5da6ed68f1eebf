"""Machine code is made by one thread at a time."""

from __future__ import annotations

import threading
from pathlib import Path

import numba
import pytest
from tracewire.solve.core import jit


def test_the_folder_of_the_machine_code_stands_while_another_thread_compiles(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """One thread ends while another is inside: the setting of the process must not be lost."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    inside, seen = threading.Event(), []

    def first() -> None:
        with jit._cached_here():
            inside.set()
            threading.Event().wait(0.02)
            seen.append(numba.config.CACHE_DIR)

    def second() -> None:
        inside.wait()
        with jit._cached_here():
            threading.Event().wait(0.1)  # longer than the first one stays
            seen.append(numba.config.CACHE_DIR)

    threads = [threading.Thread(target=work) for work in (first, second)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert seen == [str(jit.CACHE)] * 2
    assert numba.config.CACHE_DIR == ""
    assert Path(jit.CACHE).is_absolute()
