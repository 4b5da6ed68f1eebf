"""Make the library of the core: `python solver/tracewire/solve/core_build FILE PROCESSOR`.

It reads the core without the rest of tracewire, and needs only numba. Several processes share the
units; each makes the helpers that its own units call.
"""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path
from threading import Thread
from types import ModuleType
from typing import Any

HERE = Path(__file__).resolve().parent
MOST_PROCESSES = 4  # more of them make the same helpers more often


def main(file: str, processor: str) -> None:
    """Write the object files for a kind of processor, as LLVM names it, one of each process."""
    count = min(os.cpu_count() or 1, MOST_PROCESSES)
    with tempfile.TemporaryDirectory() as folder:
        parts = [Path(folder, str(number)) for number in range(count)]
        command = [sys.executable, str(HERE), processor, str(count)]
        running = [
            subprocess.Popen([*command, str(number), str(part)], stdin=subprocess.PIPE)
            for number, part in enumerate(parts)
        ]
        try:
            codes = [process.wait() for process in running]
        finally:
            for process in running:
                process.kill()
        if any(codes):
            sys.exit(1)
        from tracewire.files import write_file
        from tracewire.solve.core_build.objects import join

        write_file(file, join(part.read_bytes() for part in parts))


def make_part(processor: str, count: str, number: str, file: str) -> None:
    """Write the object file of a share of the units, one of `count` that take about as long."""
    Thread(target=_end_with_parent, daemon=True).start()
    from tracewire.files import write_file
    from tracewire.solve.core_build import lower, without_python
    from tracewire.solve.core_build.link import object_of, target_of

    gc.disable()  # it would look through all that is needed to the end, which takes a third longer
    without_python.apply()
    units = lower.read_core()
    for unit in dealt(units.values(), int(count))[int(number)]:
        unit.lower()
    write_file(file, object_of(without_python.TEXTS, units, target_of(processor)))


def dealt(units: Iterable[Any], count: int) -> list[list[Any]]:
    """The units in `count` shares of about the same length of code: the long ones are dealt first,
    forth and back."""
    by_length = sorted(units, key=lambda unit: len(unit.function.__code__.co_code), reverse=True)
    rows = [by_length[i : i + count] for i in range(0, len(by_length), count)]
    shares: list[list[Any]] = [[] for _ in range(count)]
    for turn, row in enumerate(rows):
        for share, unit in zip(shares[:: -1 if turn % 2 else 1], row, strict=False):
            share.append(unit)
    return shares


def _end_with_parent() -> None:
    """End this process when the one that began it is no more, which closes the pipe."""
    os.read(0, 1)  # without the lock of sys.stdin, which Python needs to end
    os._exit(1)


def read_alone() -> None:
    """Let Python find the core without what `tracewire` and `tracewire.solve` import."""
    for name, folder in (("tracewire", HERE.parents[1]), ("tracewire.solve", HERE.parent)):
        sys.modules[name] = ModuleType(name)
        sys.modules[name].__path__ = [str(folder)]


if __name__ == "__main__":
    read_alone()
    arguments = sys.argv[1:]
    main(*arguments) if len(arguments) == 2 else make_part(*arguments)
