"""scipy's solve_ivp, restarted at each event."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.peers.peer import Problem, Solve
from benchmarks.peers.segments import chain
from benchmarks.systems.hybrid import Hybrid, Modes, Vector

TINY = 1e-300
EXPLICIT = ("RK45", "DOP853")


class Scipy:
    """One method of solve_ivp."""

    def __init__(self, method: Literal["RK45", "DOP853", "LSODA", "Radau"]) -> None:
        self.method = method
        self.name = f"scipy {method}"

    def missing(self, problem: Problem) -> str:
        """An explicit method for a stiff problem is no use."""
        explicit = self.method in EXPLICIT and problem.stiff
        return "not for stiff problems" if explicit else ""

    def prepare(self, problem: Problem) -> Solve:
        """Functions only."""
        system = problem.system

        def segment(
            t: float, end: float, x: Vector, on: Modes, samples: Vector, rtol: float
        ) -> tuple[Vector, float, Vector, int | None]:
            due = end < system.times[-1]
            ahead = samples[: np.searchsorted(samples, end, side="left" if due else "right")]
            run: Any = solve_ivp(
                lambda t, x: system.rates(t, x, on),
                (t, end),
                x,
                method=self.method,
                t_eval=np.append(ahead, end) if due else ahead,
                events=[_terminal(system, on, i, t) for i in range(system.count(on))] or None,
                rtol=max(rtol, 2.3e-14),
                atol=rtol * 1e-3,
            )
            if not run.success:
                raise RuntimeError(run.message)
            rows = run.y.T if len(run.t) else np.empty((0, len(x)))  # without samples y is a list
            if run.status == 0:
                return rows[: len(ahead)], end, run.y[:, -1], None
            which = next(i for i, hit in enumerate(run.t_events) if hit.size)
            return rows, float(run.t_events[which][0]), run.y_events[which][0], which

        return chain(problem, segment)


def _terminal(
    system: Hybrid, on: Modes, index: int, start: float
) -> Callable[[float, Vector], float]:
    """A margin that ends the segment; one that is zero where it begins counts as open."""

    def event(t: float, x: Vector) -> float:
        value = system.margin(index, t, x, on)
        return max(value, TINY) if t == start else value

    event.terminal = True  # type: ignore[attr-defined]
    event.direction = -1.0  # type: ignore[attr-defined]
    return event
