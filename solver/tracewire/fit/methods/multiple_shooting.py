"""The method multiple_shooting: segments with free start states that grow together.

A chaotic record cannot be followed by one run: whatever the parameters, small errors grow until
nothing is left of the beginning. Segments of about a swing can be followed; their gaps are closed
while the parameters are found (H. G. Bock, 1983; E. Baake et al., Phys. Rev. A 45, 1992, 5524).
"""

from __future__ import annotations

import numpy as np

from tracewire.array_types import Vector
from tracewire.fit.limits import SEGMENTS
from tracewire.fit.methods.chain import Chain
from tracewire.fit.search import MethodResult, Search, Stopped
from tracewire.residual import solve_least_squares

WEIGHTS = tuple(10.0**k for k in range(-1, 7))
"""Of the gaps in the criterion, as a part of what the data spread, one stage after the other."""


def by_multiple_shooting(search: Search) -> MethodResult:
    """The minimum over parameters and start states of segments, whose gaps weigh more and more.

    Each stage is a damped Gauss-Newton search (Levenberg and Marquardt) by forward sensitivities.
    Where one run over the whole series is as good as the segments at the end, least squares goes on
    with it; else the record is chaotic, and the result is that of the segments.

    Raises FitError where a segment cannot be simulated at the begin.
    """
    chain = _Shooting(search)
    try:
        chain.close_gaps()
    except Stopped as stopped:
        return chain.result(stopped.exitflag, stopped.message)
    except KeyboardInterrupt:
        message = "stopped by Ctrl-C: this is the last state"
        return chain.result(-1, message, interrupted=True)
    return chain.merge_segments()


class _Shooting:
    """How far the search is: the unknowns z of the chain, the stage, and the largest gap."""

    def __init__(self, search: Search) -> None:
        self.search = search
        self.chain = Chain(search.criterion)
        criterion = self.chain.criterion
        self.criterion, self.scales = criterion, criterion.scales
        self.low, self.high = criterion.bounds()
        kept = search.resumed
        self.stage, self.gap = int(kept["stage"]) if kept else 0, np.inf
        self.z = np.array(kept["z"]) / self.scales if kept else criterion.initial_unknowns()
        if not kept:
            self.z[: self.chain.parameters] = search.begin[: self.chain.parameters]
        spread = sum(
            float(np.sum(criterion.weights(n) ** 2 * np.var(s.samples(), axis=0)))
            for n, s in enumerate(criterion.segments)
        )
        sigmas = np.concatenate(list(criterion.sigma.values()))
        self.unit = max(spread, 1e-300) / float(np.mean(sigmas**2))
        self.segments = f"{len(criterion.segments)} segments"

    def close_gaps(self) -> None:
        """Close the gaps."""
        for stage in range(self.stage, len(WEIGHTS)):
            self.stage = stage
            last = stage == len(WEIGHTS) - 1
            steps = SEGMENTS.last_steps if last else SEGMENTS.steps
            ftol = SEGMENTS.last_ftol if last else SEGMENTS.ftol
            self.minimise(WEIGHTS[stage] * self.unit, steps, ftol)
            self.search.checkpoint({"stage": stage + 1, "z": (self.z * self.scales).tolist()})
            if self.gap < SEGMENTS.closed:
                return

    def minimise(self, weight: float, steps: int, enough: float) -> None:
        """Levenberg-Marquardt steps with one weight of the gaps."""
        search, chain, damping = self.search, self.chain, SEGMENTS.first_damping
        for number in range(steps):
            share = (self.stage + number / steps) / len(WEIGHTS)
            search.set_stage(share, f"{self.segments}, gaps up to {self.gap:.2g}")
            normal = chain.normal(self.z, weight)
            self._count_evaluations()
            outward = (self.z <= self.low) & (normal.gradient > 0)
            outward |= (self.z >= self.high) & (normal.gradient < 0)
            free = np.flatnonzero(~outward)
            diagonal = np.maximum(np.diag(normal.matrix), 1e-12 * np.diag(normal.matrix).max())
            while damping <= SEGMENTS.most_damping:
                damped = normal.matrix + damping * np.diag(diagonal)
                step = np.zeros(len(self.z))
                step[free] = -np.linalg.solve(damped[np.ix_(free, free)], normal.gradient[free])
                trial = np.clip(self.z + step, self.low, self.high)
                value, gap = chain.value(trial, weight)
                self._count_evaluations()
                if value < normal.value:
                    break
                damping *= 5.0
            else:
                return
            damping = max(damping / 5.0, SEGMENTS.least_damping)
            self.z, self.gap = trial, gap
            search.count_iteration(self._search_unknowns(), value, f"gaps up to {gap:.2g}")
            if value > (1 - enough) * normal.value:
                return

    def merge_segments(self) -> MethodResult:
        """The end, on one run over the whole series where that is as good as the segments."""
        search, z = self.search, self._search_unknowns()
        apart = self.criterion.value(self.z)
        if search.value(z) <= SEGMENTS.alike * apart + SEGMENTS.nothing * self.unit:
            result = solve_least_squares(search, z, callback=search.count_iteration)
            message = f"{result.message}; {self.segments} have grown together"
            return MethodResult(result.z, search.iterations, int(result.converged), message)
        closed = self.gap < SEGMENTS.closed
        return self.result(int(closed), "converged" if closed else "the gaps did not close")

    def result(self, exitflag: int, message: str, interrupted: bool = False) -> MethodResult:
        """The end as it is, on segments."""
        what = f"{self.segments}, gaps up to {self.gap:.1e} of a segment"
        iterations = self.search.iterations
        message = f"{message}: {what}"
        return MethodResult(self.z, iterations, exitflag, message, self.criterion, interrupted)

    def _search_unknowns(self) -> Vector:
        """The unknowns of the search among those of the chain."""
        values, starts = self.criterion.unpack(self.z)
        heads = [0, *(n + 1 for n, on in enumerate(self.chain.follows[:-1]) if not on)]
        found = [*values.values(), *(v for n in heads for v in starts[n].values())]
        z = np.array(found) / self.search.criterion.scales
        return np.asarray(np.clip(z, self.search.low, self.search.high))

    def _count_evaluations(self) -> None:
        """Count what the chain has evaluated as evaluations of the search, and report progress."""
        self.search.count_evaluations(self.criterion)
        self.search.record_best(self.search.begin, np.inf)
        self.search.check_limits()
