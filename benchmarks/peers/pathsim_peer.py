"""PathSim: one ODE block, and its zero-crossing events for every margin.

One block with all rates is the fastest form there is: PathSim passes no signal between blocks.
Its adaptive solvers step onto events, so it is judged at its own steps and not at the samples.
"""

from __future__ import annotations

import importlib.util
import math
import time
from typing import Any

import numpy as np

from benchmarks.peers.peer import Answer, Problem, Solve, TooSlow

MOST_SECONDS = 40.0


class PathSim:
    """RKDP54 with events, on the stiff barrier too.

    There, at rtol 1e-5, its implicit methods were measured to need as long or longer for ten times
    the error (ESDIRK32, ESDIRK43, ESDIRK54), or to fail (GEAR52A).
    """

    name = "PathSim"

    def missing(self, problem: Problem) -> str:
        """It is a package of its own."""
        return "" if importlib.util.find_spec("pathsim") else "not installed (pathsim)"

    def prepare(self, problem: Problem) -> Solve:
        """Import it."""
        from pathsim import Connection, Simulation
        from pathsim.blocks import ODE, Scope
        from pathsim.events import ScheduleList, ZeroCrossingDown
        from pathsim.solvers import RKDP54

        system = problem.system
        end = float(system.times[-1])

        def solve(rtol: float) -> Answer:
            x0, on = system.begin()
            deadline = time.perf_counter() + MOST_SECONDS

            def rates(x: Any, u: Any, t: float) -> Any:
                if time.perf_counter() > deadline:
                    raise TooSlow(f"given up after {MOST_SECONDS:g} s")
                return np.array(system.rates(t, x.tolist(), on))

            def watch(index: int) -> Any:
                """A watcher of one margin; one that these modes lack stays positive."""

                def margin(t: float) -> float:
                    if index >= system.count(on):
                        return 1.0
                    return system.margin(index, t, block.engine.state, on)

                def act(t: float) -> None:
                    if changed[0] != t:
                        cross(t, index)
                    while min(below := system.margins(t, block.engine.state, on)) < 0.0:
                        cross(t, int(np.argmin(below)))

                return ZeroCrossingDown(func_evt=margin, func_act=act, tolerance=1e-2 * rtol)

            def cross(t: float, index: int) -> None:
                nonlocal on
                block.engine.state, on = system.happen(t, block.engine.state, on, index)
                changed[0] = t

            def tick(t: float) -> None:
                nonlocal on
                on = system.tick(on)

            changed = [-1.0]
            block, scope = ODE(rates, x0), Scope()
            events: list[Any] = [watch(i) for i in range(8)] if system.count(on) else []
            first = system.due(on)
            if math.isfinite(first):
                grid = np.arange(1, math.ceil(end / first)) * first
                events.append(ScheduleList(times_evt=grid.tolist(), func_act=tick))
            simulation = Simulation(
                [block, scope],
                [Connection(block[i], scope[i]) for i in range(len(x0))],
                events=events,
                dt=1e-4,
                Solver=RKDP54,
                tolerance_lte_rel=rtol,
                tolerance_lte_abs=rtol * 1e-3,
                log=False,
            )
            simulation.run(end)
            times, states = scope.read()
            return Answer(np.array(times), np.array(states).T)

        return solve
