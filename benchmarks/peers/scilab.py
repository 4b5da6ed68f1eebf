"""Scilab's ode(), from the command line: interpreted equations, compiled LSODA or LSODAR.

This is not Xcos: the command line's build has no Xcos engine. Scilab keeps its own clock, so its
start is not counted.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.peers.peer import Answer, Problem, Solve, TooSlow

SCRIPTS = Path(__file__).parents[1] / "scilab"
MOST_SECONDS = 60.0


class Scilab:
    """A script for each system; one process for each run."""

    name = "Scilab ode()"

    def missing(self, problem: Problem) -> str:
        """The command line's Scilab, and a script."""
        if not shutil.which("scilab-cli"):
            return "not installed (scilab-cli)"
        return "" if problem.script else "no script for it"

    def prepare(self, problem: Problem) -> Solve:
        """Nothing is kept between runs."""
        script = (SCRIPTS / problem.script).read_text()
        system = problem.system

        def solve(rtol: float) -> Answer:
            constants = ", ".join(repr(float(value)) for value in system.constants)
            count, end = len(system.times), float(system.times[-1])
            with tempfile.TemporaryDirectory(prefix="tracewire-benchmark-") as folder:
                out, file = Path(folder) / "states.csv", Path(folder) / "run.sce"
                head = f"""
                    %ODEOPTIONS = [1, 0, 0, %inf, 0, 2, 1000000, 12, 5, 0, -1, -1];
                    p = [{constants}]; rtol = {rtol!r};
                    times = linspace(0, {end!r}, {count});
                """
                tail = f"""
                    mprintf("seconds %.9f\\n", seconds);
                    csvWrite(states', "{out}", ",", ".", "%.17e");
                    exit
                """
                file.write_text(head + script + tail)
                command = ["scilab-cli", "-nb", "-quit", "-f", str(file)]
                try:
                    done = subprocess.run(
                        command,
                        stdin=subprocess.DEVNULL,
                        capture_output=True,
                        text=True,
                        check=False,
                        timeout=MOST_SECONDS,
                    )
                except subprocess.TimeoutExpired:
                    raise TooSlow(f"given up after {MOST_SECONDS:g} s") from None
                told = [line.split() for line in done.stdout.splitlines() if "seconds" in line]
                if not told or not out.exists():
                    raise RuntimeError((done.stdout + done.stderr).strip()[-200:])
                states = np.loadtxt(out, delimiter=",")
            return Answer(system.times, states, float(told[0][1]))

        return solve
