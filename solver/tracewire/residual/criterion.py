"""How far a model is from measured data: residuals of segments, derivatives, the criterion."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import Literal

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import DataError, OptionError, Problem, SimulationError, unknown
from tracewire.residual.limits import CRITERION
from tracewire.residual.linearisation import BatchLinearisation, Linearisation, Point, SegmentBatch
from tracewire.residual.loss import LOSSES
from tracewire.residual.segment import Segment, Unknown
from tracewire.solve import Interrupted, Limits, StopFlag, beyond_budget, cores, until_interrupted

Weighting = Literal["mean", "sum"]
Numbers = tuple[int, ...]
LIMITS = Limits(steps=500_000, seconds=120.0)


class Criterion:
    """Residuals of a model on segments, as a function of unknowns and of the segments' free starts.

    The vector of unknowns is scaled: parameters first, then the free starts of each segment. The
    residual of a sample is (shown - measured)/sigma, where the sensor shows gain*y(t - delay) +
    offset; of a signal with a period it is modulo that (`wrap_to_period`). The criterion is

        value = 1/2 sum over segments, signals and samples of w^2 rho(residual^2)

    with w^2 = weight of the series * weight of the signal, divided by the number of samples where
    `weighting` is "mean", and rho the loss. So for one series and one signal it is
    mean(residual^2)/2, the objective of paper A's appendix; for several, Eq 5 of paper B.
    `parameters` holds what is fixed, by the names that unknowns have; `sigma` the noise of each
    signal instead of the declared one, `limits` what one run may cost. Where segments are
    `chained`, states that are not free go on from one to the next, where it begins at its end.
    `whitening` gives, for a segment whose residuals are not white, the matrix W, or its diagonal,
    that makes them so: the residuals and their derivatives are then W times the above.

    A segment whose run fails counts as 100 times the spread of its data, and is told in `failures`.

    Raises DataError where only some signals have a declared sigma, or none has and a robust loss
    needs it; OptionError for a loss that does not exist.
    """

    def __init__(
        self,
        model: Model,
        segments: Sequence[Segment],
        unknowns: Sequence[Unknown],
        parameters: Mapping[str, float],
        rtol: float = 1e-7,
        sigma: Mapping[str, float] | None = None,
        *,
        weighting: Weighting = "mean",
        loss: str = "linear",
        limits: Limits = LIMITS,
        chained: bool = False,
        whitening: Callable[[Segment], Matrix | Vector | None] | None = None,
    ) -> None:
        if loss not in LOSSES:
            raise OptionError([unknown("loss", loss, LOSSES)])
        self.model, self.unknowns = model, tuple(unknowns)
        self.segments = tuple(segments)
        self.parameters = dict(parameters)
        self.rtol, self.limits = rtol, limits
        self.weighting, self.loss = weighting, loss
        self.sigma = _sigma_of(self.segments, sigma, needed=loss != "linear")
        self.whitening = whitening
        self.evaluations = 0
        self.runs, self.steps, self.budget = 0, 0, np.inf
        self.failure: SimulationError | None = None
        self.failures: Counter[str] = Counter()
        self.warnings: set[tuple[str, str]] = set()
        self.scales = np.array(
            [u.scale for u in self.unknowns]
            + [s.start_scales[name] for s in self.segments for name in s.free]
        )
        self._weights: dict[int, Vector] = {}
        self._batches: dict[int, tuple[Numbers, tuple[bool, ...], SegmentBatch]] = {}
        self._following = (
            {n for n, pair in enumerate(pairwise(segments), 1) if pair[1].continues(pair[0])}
            if chained
            else set()
        )

    def follows(self, n: int) -> bool:
        """Whether segment n goes on where the one before it ends, and is chained to it."""
        return n in self._following

    @property
    def remembers(self) -> bool:
        """Whether states go on from one segment to the next, so that these run together."""
        return any(set(self.model.states) - set(self.segments[n].free) for n in self._following)

    def on_segments(
        self, segments: Sequence[Segment], weighting: Weighting | None = None
    ) -> Criterion:
        """The same criterion on other segments, of the same series."""
        fresh = Criterion(
            self.model, segments, self.unknowns, self.parameters, self.rtol,
            weighting=weighting or self.weighting, limits=self.limits, whitening=self.whitening,
        )  # fmt: skip
        fresh.loss = self.loss
        fresh.sigma = {s.measured.name: self.sigma[s.measured.name] for s in segments}
        return fresh

    # --- unknowns -----------------------------------------------------------------------------

    @property
    def names(self) -> list[str]:
        """The unknowns by name; free starts say of which series, where there are several."""
        several = len({segment.measured.name for segment in self.segments}) > 1
        return [unknown.name for unknown in self.unknowns] + [
            f"start.{state}" + (f" of {segment.measured.name}" if several else "")
            for segment in self.segments
            for state in segment.free
        ]

    def initial_unknowns(self) -> Vector:
        """The scaled unknowns to begin with."""
        values = [u.value for u in self.unknowns]
        values += [s.start[name] for s in self.segments for name in s.free]
        return np.asarray(np.array(values) / self.scales)

    def bounds(self) -> tuple[Vector, Vector]:
        """The scaled bounds; start values are free."""
        extra = sum(len(s.free) for s in self.segments)
        low = np.array([u.low for u in self.unknowns] + [-np.inf] * extra) / self.scales
        high = np.array([u.high for u in self.unknowns] + [np.inf] * extra) / self.scales
        return low, high

    def unpack(self, z: Vector) -> tuple[dict[str, float], list[dict[str, float]]]:
        """Scaled unknowns as values by name, and the free starts of each segment."""
        values = (z * self.scales).tolist()
        count = len(self.unknowns)
        named = dict(zip((u.name for u in self.unknowns), values[:count], strict=True))
        starts, at = [], count
        for segment in self.segments:
            starts.append(dict(zip(segment.free, values[at : at + len(segment.free)], strict=True)))
            at += len(segment.free)
        return named, starts

    def with_values(self, z: Vector) -> tuple[list[Unknown], list[Segment]]:
        """The unknowns and segments with the values of z."""
        named, starts = self.unpack(z)
        unknowns = [replace(u, value=named[u.name]) for u in self.unknowns]
        segments = [
            replace(s, start={**s.start, **start})
            for s, start in zip(self.segments, starts, strict=True)
        ]
        return unknowns, segments

    # --- the criterion --------------------------------------------------------------------------

    def value(self, z: Vector) -> float:
        """The criterion."""
        return half_square(self.vector(z))

    def vector(self, z: Vector) -> Vector:
        """What the criterion squares, shape (M,): value = 1/2 sum of squares."""
        return self.weigh(self.residuals(z))

    def vector_and_jacobian(self, z: Vector) -> tuple[Vector, Matrix]:
        """`vector` (M,) and its Jacobian (M, n), from one run with sensitivities."""
        residuals, derivatives = self.residuals_and_jacobians(z)
        return self.weigh(residuals), self.weigh_jacobians(residuals, derivatives)

    def weigh(self, residuals: Sequence[Vector]) -> Vector:
        """The residuals of all segments as `vector` has them."""
        loss = LOSSES[self.loss]
        return np.concatenate(
            [(loss(r).residual * self.weights(n)).ravel() for n, r in enumerate(residuals)]
        )

    def weigh_jacobians(self, residuals: Sequence[Vector], derivatives: Sequence[Matrix]) -> Matrix:
        """The derivatives (M, n) of what `weigh` makes of the residuals."""
        both = enumerate(zip(residuals, derivatives, strict=True))
        return np.concatenate([self.weigh_segment(n, r, matrix)[1] for n, (r, matrix) in both])

    def weigh_segment(self, n: int, residual: Vector, derivatives: Matrix) -> tuple[Vector, Matrix]:
        """The part of `vector` that segment n makes, and its derivatives."""
        lossy, weights = LOSSES[self.loss](residual), self.weights(n)
        slope = (lossy.slope * weights).reshape(-1, 1)
        return (lossy.residual * weights).ravel(), slope * derivatives

    def weights(self, n: int) -> Vector:
        """The weights w (N, signals) of the residuals of segment n."""
        if n not in self._weights:
            self._weights[n] = self._weights_of(n)
        return self._weights[n]

    def _weights_of(self, n: int) -> Vector:
        segment, measured = self.segments[n], self.segments[n].measured
        counts = [measured.weights.get(name, 1.0) for name in measured.values]
        shares = measured.weight * np.array(counts)
        if self.weighting == "mean":
            shares = shares / len(segment.rows)
        return np.broadcast_to(np.sqrt(shares), (len(segment.rows), len(shares)))

    # --- residuals ------------------------------------------------------------------------------

    def residuals(self, z: Vector) -> list[Vector]:
        """The residuals of each segment, shape (N, signals); a failed run counts as far away."""
        self.evaluations += 1
        named, starts = self.unpack(z)
        found = self.linearise(named, dict(enumerate(starts)), slopes=False)
        return [found[n].residual for n in range(len(starts))]

    def residuals_and_jacobians(self, z: Vector) -> tuple[list[Vector], list[Matrix]]:
        """`residuals`, and d residuals/d scaled unknowns, for each segment (N*signals, n).

        By forward sensitivities of one run for each segment, which counts as one evaluation and
        one more for each unknown; by differences where such a run fails.
        """
        named, starts = self.unpack(z)
        self.evaluations += 1 + len(self.unknowns) + max((len(s) for s in starts), default=0)
        residuals, matrices = [], []
        self.warnings = set()
        linearised = self.linearise(named, dict(enumerate(starts)))
        at = len(self.unknowns)
        for n, start in enumerate(starts):
            columns = [*range(len(self.unknowns)), *range(at, at + len(start))]
            at += len(start)
            near = linearised[n]
            matrix = np.zeros((near.residual.size, len(z)))
            matrix[:, columns] = near.slopes * self.scales[columns]
            residuals.append(near.residual)
            matrices.append(matrix)
        return residuals, matrices

    def linearise(
        self,
        named: Mapping[str, float],
        starts: Mapping[int, Mapping[str, float]],
        slopes: bool = True,
    ) -> dict[int, Linearisation]:
        """The segments near these unknowns and starts, by number, each by the sensitivities of one
        run, and by differences where such a run fails. Many steps run in parallel.

        Without `slopes` from a plain run; one that fails counts as far away.
        """
        if self.runs:
            steps = len(starts) * self.steps / self.runs
        else:  # about as many as samples
            steps = sum(len(self.segments[n].rows) for n in starts)
        many = steps > CRITERION.many
        groups = self._groups(sorted(starts), halves=many and not self.remembers)
        with _Interruptible() as stop_flag:

            def linearise_group(group: int, numbers: Sequence[int]) -> BatchLinearisation:
                if self.steps > self.budget:  # nothing more is run, and nothing counted
                    beyond = dict.fromkeys(range(len(numbers)), beyond_budget(self.budget))
                    return BatchLinearisation({}, beyond, 0, frozenset())
                follows = tuple(self.follows(n) and n - 1 in starts for n in numbers)
                batch = self._batch(group, tuple(numbers), follows)
                point = self._point(named, [starts[n] for n in numbers])
                sigma = self.sigma[batch.segments[0].measured.name]
                return batch.linearise(point, sigma, [*named] if slopes else None, stop_flag)

            apart = _threads().map if many and len(groups) > 1 and cores() > 1 else map
            done = list(apart(linearise_group, range(len(groups)), groups))
        found: dict[int, Linearisation] = {}
        for numbers, group in zip(groups, done, strict=True):
            self.runs += len(numbers)
            self.steps += group.steps
            found |= {
                numbers[n]: self._whiten_linearisation(numbers[n], x)
                for n, x in group.linearisations.items()
            }
            if slopes:
                series = self.segments[numbers[0]].measured.name
                self.warnings |= {(series, warning) for warning in group.warnings}
                continue
            for n, error in group.errors.items():
                found[numbers[n]] = self._failed_segment(numbers[n], starts[numbers[n]], error)
        for n in starts.keys() - found.keys():
            found[n] = self._differences(n, named, starts[n])
        return found

    def _groups(self, numbers: Sequence[int], halves: bool) -> list[list[int]]:
        """Segments that run together: those of a series, or of half of it."""
        series: dict[str, list[int]] = {}
        for n in numbers:
            series.setdefault(self.segments[n].measured.name, []).append(n)
        if not halves:
            return list(series.values())
        middles = [(group, -(-len(group) // 2)) for group in series.values()]
        parts = [part for group, at in middles for part in (group[:at], group[at:])]
        return [part for part in parts if part]

    def _batch(self, group: int, numbers: Numbers, follows: tuple[bool, ...]) -> SegmentBatch:
        """A group of segments; that of the last time, where it is of the same ones."""
        kept = self._batches.get(group)
        if kept is not None and kept[:2] == (numbers, follows):
            return kept[2]
        batch = self._new_batch([self.segments[n] for n in numbers], follows)
        self._batches[group] = numbers, follows, batch
        return batch

    def _new_batch(self, segments: Sequence[Segment], follows: Sequence[bool]) -> SegmentBatch:
        return SegmentBatch(self.model, segments, follows, self.rtol, self.limits)

    def _point(self, named: Mapping[str, float], starts: Sequence[Mapping[str, float]]) -> Point:
        return Point({**self.parameters, **named}, starts, self.budget - self.steps)

    def outputs(
        self, segment: Segment, named: Mapping[str, float], start: Mapping[str, float]
    ) -> Vector:
        """What the sensors of a segment show in a run, shape (N, signals).

        Raises SimulationError where it fails, KeyboardInterrupt for Ctrl-C: the whole search shall
        stop.
        """
        with _Interruptible() as stop_flag:
            batch = self._new_batch([segment], [False])
            runs, observation = batch.simulate(self._point(named, [start]), stop_flag)
        for error in runs.errors.values():
            raise error
        return observation.observe(runs)

    def whiten(self, n: int, rows: Vector) -> Vector:
        """Rows (N, signals) or (N*signals, ...) of segment n, in sigma, as its residuals are."""
        whitening = None if self.whitening is None else self.whitening(self.segments[n])
        if whitening is None:
            return rows
        flat = rows.reshape(len(whitening), -1)
        white = whitening @ flat if whitening.ndim == 2 else whitening[:, None] * flat
        return np.asarray(white.reshape(rows.shape))

    def _whiten_linearisation(self, n: int, near: Linearisation) -> Linearisation:
        if self.whitening is None:
            return near
        residual, slopes = self.whiten(n, near.residual), self.whiten(n, near.slopes)
        return replace(near, residual=residual, slopes=slopes)

    def _failed_segment(
        self, n: int, start: Mapping[str, float], error: SimulationError
    ) -> Linearisation:
        """A segment whose run failed: far from the data, whatever the unknowns."""
        self.failure = error
        self.failures[self.segments[n].measured.name] += 1
        sigma = self.sigma[self.segments[n].measured.name]
        samples = self.segments[n].samples()
        spread = CRITERION.penalty * np.maximum(np.std(samples, axis=0), sigma)
        residual = np.asarray(np.broadcast_to(spread / sigma, samples.shape))
        scales = np.array([self.segments[n].start_scales[name] for name in start])
        none, ends = np.zeros((residual.size, 0)), np.zeros((len(self.model.states), 0))
        return Linearisation(residual, none, scales, {}, ends, ran=False)

    def _differences(
        self, n: int, named: Mapping[str, float], start: Mapping[str, float]
    ) -> Linearisation:
        """A segment by differences to one side, away from a bound; without where the run fails."""

        def there(named: Mapping[str, float], start: Mapping[str, float]) -> Linearisation:
            return self.linearise(named, {n: start}, slopes=False)[n]

        if self.steps > self.budget:  # no run is worth its call
            at = self._failed_segment(n, start, beyond_budget(self.budget))
        else:
            at = there(named, start)
        if not at.ran:
            return replace(at, slopes=np.zeros((at.residual.size, len(named) + len(start))))
        steps, moved = [], []
        for u in self.unknowns:
            h = CRITERION.step * max(u.scale, abs(named[u.name]))
            steps.append(-h if named[u.name] + h > u.high else h)
            moved.append(there({**named, u.name: named[u.name] + steps[-1]}, start))
        for state, value in start.items():
            steps.append(CRITERION.step * max(self.segments[n].start_scales[state], abs(value)))
            moved.append(there(named, {**start, state: value + steps[-1]}))
        rows = np.array([(near.residual - at.residual).ravel() for near in moved])
        ends = np.array([[near.final.get(x, y) - y for x, y in at.final.items()] for near in moved])
        return replace(
            at,
            slopes=rows.reshape(len(steps), at.residual.size).T / np.array(steps),
            final_slopes=ends.reshape(len(steps), len(at.final)).T / np.array(steps),
        )


class _Interruptible:
    """Ctrl-C during runs is no failed run: the whole search shall stop."""

    def __init__(self) -> None:
        self.noting = until_interrupted()

    def __enter__(self) -> StopFlag:
        return self.noting.__enter__()

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        self.noting.__exit__(None, None, None)
        if isinstance(error, Interrupted):
            raise KeyboardInterrupt from error


@cache
def _threads() -> ThreadPoolExecutor:
    """Threads that wait for work: to begin them takes as long as hundreds of short runs."""
    return ThreadPoolExecutor(cores(), thread_name_prefix="tracewire")


if hasattr(os, "register_at_fork"):  # a forked process has no threads, and would wait for them
    os.register_at_fork(after_in_child=_threads.cache_clear)


def half_square(vector: Vector) -> float:
    """Half the sum of squares: the criterion of its vector."""
    return 0.5 * float(vector @ vector)


def _sigma_of(
    segments: Sequence[Segment], given: Mapping[str, float] | None, needed: bool
) -> dict[str, Vector]:
    """The noise of the signals of each series: as given, else as declared, 1 where none is."""
    known = {
        (s.measured.name, signal): (s.measured.sigma if given is None else given).get(signal)
        for s in segments
        for signal in s.signals
    }
    missing = [f"{signal} in {series}" for (series, signal), x in known.items() if x is None]
    if missing and (given is not None or len(missing) < len(known)):
        what = f"no sigma is known of {', '.join(missing)}, but of others"
        raise DataError([Problem(what, hint="Give every measured signal a sigma, or none.")])
    if missing and needed:
        what = f"a robust loss needs the noise, and no sigma is known of {', '.join(missing)}"
        raise DataError([Problem(what, hint="Give every measured signal a `sigma:`.")])
    return {
        s.measured.name: np.array([known[s.measured.name, signal] or 1.0 for signal in s.signals])
        for s in segments
    }
