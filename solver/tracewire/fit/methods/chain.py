"""A record cut into segments with start states of their own, and the gaps between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.errors import FitError, Problem
from tracewire.fit.limits import SEGMENTS, TRACKING
from tracewire.fit.methods.tracking import count_tracked, spread_of
from tracewire.formula import evaluate
from tracewire.residual import (
    Criterion,
    Linearisation,
    Segment,
    half_square,
    of_diagram,
    start_from_data,
)
from tracewire.solve import parameter_values


@dataclass(frozen=True, eq=False)
class Normal:
    """The criterion with the gaps, its gradient (n,) and Gauss-Newton matrix (n, n)."""

    value: float
    gradient: Vector
    matrix: Matrix


class Chain:
    """The segments of a criterion's series, cut, as a criterion of its own (`criterion`).

    A segment begins at the last sample of the one before it. A gap is the difference of the states
    at the end of a segment and at the start of the next, in units of what each state changes from
    one start to the next.
    """

    def __init__(self, whole: Criterion) -> None:
        segments: list[Segment] = []
        self.follows: list[bool] = []  # whether a segment goes on into the next
        for n in range(len(whole.segments)):
            parts = _cut(whole, n)
            segments += parts
            self.follows += [True] * (len(parts) - 1) + [False]
        self.criterion = whole.on_segments(segments, "sum")
        self.parameters = len(whole.unknowns)
        counts = np.cumsum([0, *(len(segment.free) for segment in segments)]) + self.parameters
        self.columns = [
            [*range(self.parameters), *range(first, last)]
            for first, last in zip(counts[:-1].tolist(), counts[1:].tolist(), strict=True)
        ]
        states = whole.model.states
        begun = [[s.start.get(name, 0.0) for name in states] for s in segments if s.free]
        changes = np.diff(np.array(begun), axis=0) if len(begun) > 1 else np.ones((1, 1))
        size = np.sqrt(np.mean(changes**2, axis=0)) * np.ones(len(states))
        self.sizes = np.where(size > 0, size, 1.0)

    def value(self, z: Vector, weight: float) -> tuple[float, float]:
        """The criterion with weight/2 times the mean square of the gaps, and the largest gap.

        Infinite where a run fails.
        """
        named, starts = self.criterion.unpack(z)
        self.criterion.evaluations += 1
        found = self.criterion.linearise(named, dict(enumerate(starts)), slopes=False)
        if not all(near.ran for near in found.values()):
            return np.inf, np.inf
        gaps = np.concatenate([self._gap(n, near, starts) for n, near in found.items()])
        value = half_square(self.criterion.weigh([found[n].residual for n in range(len(found))]))
        value += weight * half_square(gaps) / max(sum(self.follows), 1)
        return value, float(np.max(np.abs(gaps), initial=0.0))

    def normal(self, z: Vector, weight: float) -> Normal:
        """The criterion with the gaps, and what a Gauss-Newton step needs.

        Raises FitError where a run fails.
        """
        criterion = self.criterion
        named, starts = criterion.unpack(z)
        gradient, matrix, total = np.zeros(len(z)), np.zeros((len(z), len(z))), 0.0
        criterion.evaluations += 1 + self.parameters + max(map(len, starts), default=0)
        share = np.sqrt(weight / max(sum(self.follows), 1))
        for n, near in criterion.linearise(named, dict(enumerate(starts))).items():
            if not near.ran and criterion.failure is not None:
                problems = criterion.failure.problems
                raise FitError(
                    [Problem(f"a segment does not run: {p.what}", p.place) for p in problems]
                )
            columns = self.columns[n]
            vector, jacobian = criterion.weigh_segment(n, near.residual, near.slopes)
            if self.follows[n]:
                moved = share * near.final_slopes / self.sizes[:, None]
                own = np.vstack([jacobian, moved])
                following = np.vstack(
                    [np.zeros((len(jacobian), len(moved))), -share * np.diag(1 / self.sizes)]
                )
                columns = [*columns, *self.columns[n + 1][self.parameters :]]
                jacobian = np.hstack([own, following])
                vector = np.concatenate([vector, share * self._gap(n, near, starts)])
            jacobian = jacobian * criterion.scales[columns]
            total += half_square(vector)
            gradient[columns] += jacobian.T @ vector
            matrix[np.ix_(columns, columns)] += jacobian.T @ jacobian
        return Normal(total, gradient, matrix)

    def _gap(self, n: int, near: Linearisation, starts: Sequence[Mapping[str, float]]) -> Vector:
        if not self.follows[n]:
            return np.zeros(0)
        gap = [end - starts[n + 1][name] for name, end in near.final.items()]
        return np.asarray(np.array(gap) / self.sizes)


def _cut(whole: Criterion, n: int) -> list[Segment]:
    """Segment n in parts, each as long as the model follows it from its start; all but the first
    have free starts, and each sample counts as much as in the whole.

    They begin at the states that the data tell; the other states are those to which the part before
    has come.
    """
    segment, model = whole.segments[n], whole.model
    named, starts = whole.unpack(whole.initial_unknowns())
    rows, measured = segment.rows, segment.measured
    if whole.weighting == "mean":
        measured = replace(measured, weight=measured.weight / len(rows))
    sigma, spread = whole.sigma[measured.name], spread_of(segment, TRACKING.parts)
    least = max(SEGMENTS.fewest_samples, -(-len(rows) // SEGMENTS.most_segments))
    known = parameter_values(
        model, of_diagram(model, {**whole.parameters, **named}, measured), measured.preset
    )
    there = {s.name: evaluate(s.start, known, s.place) for s in model.flat.states}
    now = {**there, **segment.start, **starts[n]}
    parts = [replace(segment, measured=measured)]
    first, longest = 0, least

    def followed_to(last: int) -> Linearisation:
        part = replace(parts[-1], rows=rows[first : last + 1], start=now, free=())
        return whole.on_segments([part]).linearise(named, {0: {}}, slopes=False)[0]

    while first + least < len(rows):
        last = min(first + SEGMENTS.longer * longest, len(rows) - 1)
        length = max(least, count_tracked(followed_to(last).residual * sigma, spread))
        longest = max(longest, min(length, last - first))
        after = min(first + length, last)
        if after + least >= len(rows):
            break  # the last part is rather longer than too short
        states = start_from_data(model, segment.measured, int(rows[after]))
        now = {**now, **followed_to(after).final, **states}
        parts[-1] = replace(parts[-1], rows=parts[-1].rows[: after + 1 - first - (first > 0)])
        begin = float(segment.t[after])
        parts.append(Segment(measured, begin, rows[after + 1 :], now, model.states))
        first = after
    return parts
