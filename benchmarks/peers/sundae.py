"""scikit-sundae: SUNDIALS' CVODE for Python, restarted at each event."""

from __future__ import annotations

import importlib.util
import os
from typing import Any

import numpy as np

from benchmarks.peers.peer import Problem, Solve
from benchmarks.peers.segments import chain
from benchmarks.systems.hybrid import Modes, Vector


class Sundae:
    """CVODE with BDF or Adams."""

    def __init__(self, method: str) -> None:
        self.method = method
        self.name = f"scikit-sundae {method}"

    def missing(self, problem: Problem) -> str:
        """It is a package of its own."""
        if importlib.util.find_spec("sksundae") is None:
            return "not installed (scikit-sundae)"
        explicit = self.method == "Adams" and problem.stiff
        return "not for stiff problems" if explicit else ""

    def prepare(self, problem: Problem) -> Solve:
        """Import it."""
        from sksundae.cvode import CVODE

        # it warns, from C, of root functions that are zero where a segment begins
        os.environ.setdefault("SUNLOGGER_WARNING_FILENAME", os.devnull)
        system = problem.system

        def segment(
            t: float, end: float, x: Vector, on: Modes, samples: Vector, rtol: float
        ) -> tuple[Vector, float, Vector, int | None]:
            def field(t: float, x: Vector, out: Vector) -> None:
                out[:] = system.rates(t, x.tolist(), on)

            def events(t: float, x: Vector, out: Vector) -> None:
                out[:] = system.margins(t, x.tolist(), on)

            count = system.count(on)
            events.direction = [-1] * count  # type: ignore[attr-defined]
            options: dict[str, Any] = {"eventsfn": events, "num_events": count} if count else {}
            solver = CVODE(
                field,
                method=self.method,
                rtol=rtol,
                atol=rtol * 1e-3,
                max_num_steps=1_000_000,
                **options,
            )
            due = end < system.times[-1]
            ahead = samples[: np.searchsorted(samples, end, side="left" if due else "right")]
            inner = ahead[ahead > t]
            grid = np.unique(np.concatenate(([t], inner, [end])))
            if len(grid) == 2:  # two would mean its own steps
                grid = np.array([t, 0.5 * (t + end), end])
            run = solver.solve(grid, x)
            if not run.success:
                raise RuntimeError(run.message)
            hit = run.i_events is not None and len(run.i_events) > 0
            stop = float(run.t_events[0]) if hit else end
            last = np.asarray(run.y_events[0] if hit else run.y[-1])
            at = np.searchsorted(run.t, inner[inner < stop] if hit else inner)
            rows = run.y[at]
            if len(ahead) > len(inner):  # the sample at the segment's own start
                rows = np.vstack([x, rows])
            which = int(np.flatnonzero(run.i_events[0])[0]) if hit else None
            return rows, stop, last, which

        return chain(problem, segment)
