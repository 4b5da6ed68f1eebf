"""Hand-written C, compiled on the spot: our algorithm, a leaner one, and CVODE with roots."""

from __future__ import annotations

import ctypes
import functools
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.peers.peer import Answer, Problem, Solve

SOURCES = Path(__file__).parents[1] / "c"
SUNDIALS = ("sundials_cvode", "sundials_nvecserial", "sundials_sunmatrixdense")
DOUBLES = np.ctypeslib.ndpointer(np.float64, flags="C_CONTIGUOUS")
COUNTS = np.ctypeslib.ndpointer(np.int_, flags="C_CONTIGUOUS")
_FOLDERS: list[tempfile.TemporaryDirectory[str]] = []  # kept until the end: libraries are loaded


def compiler() -> str:
    """The C compiler: $CC, else cc; empty where there is none."""
    return shutil.which(os.environ.get("CC", "cc")) or ""


def build(source: str, case: str, *options: str) -> tuple[ctypes.CDLL | None, str]:
    """The library of a source for a case's header, or None and what the compiler said."""
    folder = tempfile.TemporaryDirectory(prefix="tracewire-benchmark-")
    _FOLDERS.append(folder)
    target = Path(folder.name) / f"{Path(source).stem}.so"
    command = [
        compiler(),
        "-O2",
        "-shared",
        "-fPIC",
        "-w",
        f'-DCASE="{case}"',
        str(SOURCES / source),
    ]
    command += ["-o", str(target), *options, "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        return None, done.stderr.strip() or "the compiler failed"
    try:
        return ctypes.CDLL(str(target)), ""
    except OSError as error:
        return None, str(error)


@functools.cache
def _library(source: str, case: str, *options: str) -> tuple[ctypes.CDLL | None, str]:
    return build(source, case, *options)


class Native:
    """The same algorithm in C; `method` is BDF or Adams for CVODE, empty for our own.

    `source` is ours; where it is written for one system, `case` is the header of that.
    """

    def __init__(
        self,
        method: str = "",
        name: str = "C, same algorithm",
        source: str = "run.c",
        case: str = "",
    ) -> None:
        self.method, self.case = method, case
        self.name = f"C, CVODE {method}" if method else name
        self.source = "cvode.c" if method else source
        self.options = tuple(f"-l{name}" for name in SUNDIALS) if method else ()

    def missing(self, problem: Problem) -> str:
        """A compiler, and SUNDIALS' headers and libraries."""
        if not compiler():
            return "no C compiler"
        if self.method == "Adams" and problem.stiff:
            return "not for stiff problems"
        if self.case and self.case != problem.system.file:
            return "not for this problem"
        library, why = _library(self.source, problem.system.file, *self.options)
        if library is None and self.method:
            return "no SUNDIALS to compile with"
        return "" if library is not None else why.splitlines()[0]

    def prepare(self, problem: Problem) -> Solve:
        """Load the library."""
        library, _ = _library(self.source, problem.system.file, *self.options)
        assert library is not None
        run = library.run
        number, whole = ctypes.c_double, ctypes.c_int
        run.argtypes = [DOUBLES, number, number, DOUBLES, whole, DOUBLES, COUNTS, whole]
        run.restype = whole
        system = problem.system
        times, constants = np.ascontiguousarray(system.times), system.constants
        states = len(problem.names)

        def solve(rtol: float) -> Answer:
            out, counts = np.empty((len(times), states)), np.zeros(3, dtype=np.int_)
            adams = int(self.method == "Adams")
            status = run(constants, rtol, rtol * 1e-3, times, len(times), out, counts, adams)
            if status:
                raise RuntimeError(f"{self.name} stopped with {status}")
            return Answer(times, out, steps=None if self.method else int(counts[0]))

        return solve
