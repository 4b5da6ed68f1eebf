"""tracewire itself, through its public names only."""

from __future__ import annotations

import numpy as np
import tracewire as tw

from benchmarks.peers.peer import Answer, Problem, Solve


class Tracewire:
    """A diagram, compiled once; timed is the whole of `simulate`, samples and events included.

    `alone`: the time that the run itself tells, without what is done before and after it.
    """

    def __init__(self, alone: bool = False) -> None:
        self.alone = alone
        self.name = "tracewire, inside" if alone else "tracewire"

    def missing(self, problem: Problem) -> str:
        """It is always there."""
        return ""

    def prepare(self, problem: Problem) -> Solve:
        """Read and compile."""
        model = tw.compile(tw.read(problem.diagram), record=problem.names)
        times = problem.system.times

        def solve(rtol: float) -> Answer:
            run = tw.simulate(
                model,
                preset=problem.preset,
                parameters=problem.parameters,
                times=times,
                rtol=rtol,
            )
            states = np.column_stack([run[name] for name in problem.names])
            told = run.statistics
            return Answer(times, states, told.seconds if self.alone else None, told.steps)

        return solve
