"""A record cut into segments with start states of their own, and the gaps between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model, compile
from tracewire.errors import SimulationError
from tracewire.fit.methods.cutting import cut
from tracewire.residual import LOSSES, Criterion, Segment, Sensing, parameter_in
from tracewire.solve import Run

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Normal:
    """The criterion with the gaps, its gradient (n,) and Gauss-Newton matrix (n, n)."""

    value: float
    gradient: Vector
    matrix: Matrix


class Chain:
    """The segments of a criterion's series, cut, as a criterion of its own (`criterion`).

    A gap is the difference of the states at the end of a segment and at the start of the next, in
    units of what each state changes from one start to the next.
    """

    def __init__(self, whole: Criterion) -> None:
        model = _with_states(whole.model)
        segments: list[Segment] = []
        self.follows: list[bool] = []  # whether a segment goes on into the next
        for segment in whole.segments:
            parts = cut(model, whole, segment)
            segments += parts
            self.follows += [True] * (len(parts) - 1) + [False]
        self.criterion = Criterion(
            model,
            segments,
            whole.unknowns,
            whole.parameters,
            whole.rtol,
            weighting=whole.weighting,
        )
        self.criterion.loss = whole.loss
        self.criterion.sigma = dict(whole.sigma)
        self.states = model.states
        self.sizes = self._sizes()
        self.parameters = len(whole.unknowns)
        counts = np.array([len(s.free) for s in segments])
        self.offsets = self.parameters + np.concatenate(([0], np.cumsum(counts)))

    def _sizes(self) -> Vector:
        """What each state changes from one start to the next, shape (states,)."""
        known = [[s.start.get(name, 0.0) for name in self.states] for s in self.segments if s.free]
        changes = np.diff(np.array(known), axis=0) if len(known) > 1 else np.ones((1, 1))
        size = np.sqrt(np.mean(changes**2, axis=0)) * np.ones(len(self.states))
        return np.where(size > 0, size, 1.0)

    @property
    def segments(self) -> Sequence[Segment]:
        """The segments, those of a series one after the other."""
        return self.criterion.segments

    def value(self, z: Vector, weight: float) -> tuple[float, float]:
        """The criterion with weight/2 times the mean square of the gaps, and the largest gap.

        Infinite where a run fails.
        """
        named, starts = self.criterion.split(z)
        total, largest = 0.0, 0.0
        self.criterion.evaluations += 1
        for n in range(len(self.segments)):
            try:
                run, sensing = self._run(n, named, starts)
            except SimulationError:
                return np.inf, np.inf
            residual = self.criterion.difference(n, sensing.shown(run))
            lost = LOSSES[self.criterion.loss](residual).residual * self.criterion.weights(n)
            total += 0.5 * float(np.sum(lost**2))
            gap = self._gap(n, run, starts)
            total += 0.5 * weight * float(gap @ gap) / max(sum(self.follows), 1)
            largest = max(largest, float(np.max(np.abs(gap), initial=0.0)))
        return total, largest

    def normal(self, z: Vector, weight: float) -> Normal:
        """The criterion with the gaps, and what a Gauss-Newton step needs.

        Raises SimulationError where a run fails.
        """
        criterion = self.criterion
        named, starts = criterion.split(z)
        gradient, matrix, total = np.zeros(len(z)), np.zeros((len(z), len(z))), 0.0
        criterion.evaluations += 1 + self.parameters + max((len(s) for s in starts), default=0)
        share = np.sqrt(weight / max(sum(self.follows), 1))
        for n in range(len(self.segments)):
            measured = self.segments[n].measured
            answers = {name: parameter_in(name, measured) for name in named}
            answers |= {f"start.{state}": f"start.{state}" for state in starts[n]}
            run, sensing = self._run(n, named, starts, [name for name in answers.values() if name])
            lost = LOSSES[criterion.loss](criterion.difference(n, sensing.shown(run)))
            weights = criterion.weights(n)
            own = [*range(self.parameters), *range(self.offsets[n], self.offsets[n + 1])]
            sigma = criterion.sigma[measured.name]
            slopes = sensing.derivatives(run, answers) / sigma[:, None]
            rows = [(lost.residual * weights).ravel()]
            columns = [*own]
            slopes *= (lost.slope * weights)[:, :, None]
            parts = [slopes.reshape(lost.residual.size, len(answers))]
            if self.follows[n]:
                following = range(self.offsets[n + 1], self.offsets[n + 2])
                columns += following
                rows.append(share * self._gap(n, run, starts))
                ends = np.zeros((len(self.states), len(own)))
                for j, name in enumerate(answers.values()):
                    if name:
                        ends[:, j] = [run.sensitivities[name][x][-1] for x in self.states]
                parts[0] = np.hstack([parts[0], np.zeros((len(parts[0]), len(following)))])
                moved = np.hstack([ends, -np.eye(len(self.states))])
                parts.append(share * moved / self.sizes[:, None])
            vector, jacobian = np.concatenate(rows), np.vstack(parts) * criterion.scales[columns]
            total += 0.5 * float(vector @ vector)
            gradient[columns] += jacobian.T @ vector
            matrix[np.ix_(columns, columns)] += jacobian.T @ jacobian
        return Normal(total, gradient, matrix)

    def _gap(self, n: int, run: Run, starts: Sequence[dict[str, float]]) -> Vector:
        if not self.follows[n]:
            return np.zeros(0)
        end = np.array([run[name][-1] for name in self.states])
        begin = np.array([starts[n + 1][name] for name in self.states])
        return np.asarray((end - begin) / self.sizes)

    def _run(
        self,
        n: int,
        named: dict[str, float],
        starts: Sequence[dict[str, float]],
        sensitivities: Sequence[str] = (),
    ) -> tuple[Run, Sensing]:
        """The run of a segment up to the start of the next, and its sensors."""
        until = self.segments[n + 1].begin if self.follows[n] else None
        return self.criterion.run(self.segments[n], named, starts[n], until, sensitivities)


def _with_states(model: Model) -> Model:
    """The model with all states among the recorded signals."""
    if set(model.states) <= set(model.recorded):
        return model
    return compile(model.diagram, record=[*model.recorded, *model.states])
