"""The loop that peers without event iteration need: one segment after the other."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from benchmarks.peers.peer import Answer, Problem, Solve, TooSlow
from benchmarks.systems.hybrid import Hybrid, Modes, Vector

MOST_SECONDS = 30.0
# of t, its end, x, modes, the samples ahead, rtol, the watchdog:
# the samples reached (k, n), the end time, the state there, and the margin that ended it or None
Segment = Callable[
    [float, float, Vector, Modes, Vector, float], tuple[Vector, float, Vector, int | None]
]


def chain(problem: Problem, segment: Segment) -> Solve:
    """A run made of segments that end at events."""
    system: Hybrid = problem.system

    def solve(rtol: float) -> Answer:
        began = time.perf_counter()
        times = system.times
        t, end = float(times[0]), float(times[-1])
        x, on = system.begin()
        states = np.empty((len(times), len(x)))
        filled = 0
        while t < end - 4.0 * np.spacing(end):
            until = min(system.due(on), end)
            reached, t, x, which = segment(t, until, x, on, times[filled:], rtol)
            states[filled : filled + len(reached)] = reached
            filled += len(reached)
            if which is not None:
                x, on = system.happen(t, x, on, which)
            elif t < end:
                on = system.tick(on)
            if time.perf_counter() - began > MOST_SECONDS:
                raise TooSlow(f"more than {MOST_SECONDS:g} s")
        states[filled:] = x
        return Answer(times, states)

    return solve
