"""What every method of a fit is given: the criterion, counted and watched, and its limits."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.fit.limits import SEARCH
from tracewire.fit.optimset import OptimValues, Options
from tracewire.fit.result import Comparison, Improvement
from tracewire.residual import Criterion, half_square


@dataclass(frozen=True)
class Progress:
    """How far a fit is: evaluations of the criterion, best criterion and its values by name in SI,
    seconds spent and still to go.

    `remaining` is what the limits still allow; a search that converges is done before. `stage`
    says in words what the method is at.
    """

    evaluations: int
    best: float
    seconds: float
    remaining: float
    values: Mapping[str, float]
    stage: str = ""


@dataclass(frozen=True, eq=False)
class MethodResult:
    """Where a search ended, in scaled unknowns, and why.

    A method that has cut the series into segments of its own gives their `criterion`, to which `z`
    belongs then.
    """

    z: Vector
    iterations: int
    exitflag: int
    message: str
    criterion: Criterion | None = None
    interrupted: bool = False


class Stopped(Exception):
    """A search is over: a limit is reached (exit flag 0), or an output function says so (-1)."""

    def __init__(self, exitflag: int, message: str) -> None:
        super().__init__(message)
        self.exitflag, self.message = exitflag, message


class Search:
    """A criterion as a method sees it: every evaluation is counted, the best is remembered,
    progress is reported, limits end it.

    `begin` are the scaled unknowns to begin with, `units` the sizes in which tolerances of the
    simplex are meant (1 is SI), `seed` what random numbers are made from,
    `options` those of optimset (limits hold for every method, tolerances for the simplex),
    `resumed` what the same method has kept in a saved file. A method calls `vector`,
    `vector_and_jacobian` or `value`, `count_iteration` after each of its iterations, and
    `checkpoint` with what it needs to go on.
    """

    def __init__(
        self,
        criterion: Criterion,
        options: Options,
        seed: int = 0,
        units: Vector | None = None,
        progress: Callable[[Progress], None] | None = None,
        store: Callable[[Search, bool], None] | None = None,
        comparisons: Callable[[Vector], tuple[Comparison, ...]] | None = None,
    ) -> None:
        self.criterion, self.options, self.seed = criterion, options, seed
        self.begin = criterion.initial_unknowns()
        self.units = np.ones(len(self.begin)) if units is None else units
        self.low, self.high = criterion.bounds()
        self.resumed: Mapping[str, Any] = {}
        self.state: Mapping[str, Any] = {}
        self.best, self.best_value = self.begin, np.inf
        self.iterations = 0
        self.stage = ""
        self.history: list[Improvement] = []
        self._progress, self._store, self._comparisons = progress, store, comparisons
        self._began, self._told, self._share = time.perf_counter(), -np.inf, 0.0

    # --- what a method calls ----------------------------------------------------------------------

    @property
    def size(self) -> int:
        """The number of unknowns, free starts among them."""
        return len(self.begin)

    def rng(self, *path: int) -> np.random.Generator:
        """Random numbers of a part of the search, the same whenever it is done."""
        return np.random.default_rng([self.seed, *path])

    def bounds(self) -> tuple[Vector, Vector]:
        """The scaled bounds."""
        return self.low, self.high

    def reflect(self, z: Vector) -> Vector:
        """Unknowns reflected at their bounds until they are inside.

        The identity inside, so that a search that keeps away from bounds does not notice them.
        """
        inside = np.where(z < self.low, 2 * self.low - z, z)
        inside = np.where(inside > self.high, 2 * self.high - inside, inside)
        return np.asarray(np.clip(inside, self.low, self.high))

    def value(self, z: Vector) -> float:
        """The criterion, and where it is the best so far remembered."""
        return half_square(self.vector(z))

    def vector(self, z: Vector, part: Criterion | None = None) -> Vector:
        """What the criterion squares (M,), or that of a `part` of the series, which is counted."""
        self.check_limits()
        found = (part or self.criterion).vector(z)
        self._record(z, found, part)
        return found

    def vector_and_jacobian(
        self, z: Vector, part: Criterion | None = None
    ) -> tuple[Vector, Matrix]:
        """`vector` (M,) and its Jacobian (M, n), by forward sensitivities."""
        self.check_limits()
        found, matrix = (part or self.criterion).vector_and_jacobian(z)
        self._record(z, found, part)
        return found, matrix

    def _record(self, z: Vector, found: Vector, part: Criterion | None) -> None:
        if part is not None:
            self.count_evaluations(part)
        self.record_best(z, half_square(found) if part is None else np.inf)

    def record_best(self, z: Vector, value: float) -> None:
        """Remember a point where it is the best so far, and report progress."""
        if value < self.best_value:
            self.best, self.best_value = z.copy(), value
            named, _ = self.criterion.unpack(z)
            self.history.append(Improvement(self.criterion.evaluations, value, named))
        now = time.perf_counter()
        if now - self._told > SEARCH.report_every:
            self._told = now
            self._save(last=False)
            if self._progress is not None:
                self._progress(self.progress())

    def count_evaluations(self, other: Criterion) -> None:
        """Count what another criterion has evaluated as evaluations of the search."""
        whole = self.criterion
        whole.evaluations += other.evaluations
        whole.failures += other.failures
        whole.failure = other.failure or whole.failure
        other.evaluations = 0
        other.failures.clear()

    def check_limits(self) -> None:
        """Raises Stopped where no evaluation is left; for those that a method makes elsewhere."""
        limit = self.options.evaluations(self.size)
        if self.criterion.evaluations >= limit:
            raise Stopped(0, f"stopped at the limit of evaluations: MaxFunEvals is {limit:g}")

    def set_stage(self, share: float, stage: str = "") -> None:
        """How much of what the limits allow is done, 0 to 1, and what the method is at."""
        self._share, self.stage = float(np.clip(share, 0.0, 1.0)), stage

    def checkpoint(self, state: Mapping[str, Any]) -> None:
        """What is needed to go on from here: numbers, texts, lists and mappings of these."""
        self.state = state

    def count_iteration(self, z: Vector, value: float, procedure: str = "") -> None:
        """Count an iteration of the method, and ask the output functions of the options.

        Raises Stopped where the limit of iterations is reached, or one of them wants to stop.
        """
        self.iterations += 1
        self._announce(z, value, "iter", procedure)
        if self.iterations >= self.options.iterations(self.size):
            limit = self.options.iterations(self.size)
            raise Stopped(0, f"stopped at the limit of iterations: MaxIter is {limit:g}")

    def with_comparisons(self, values: OptimValues) -> OptimValues:
        """What an output function is told, with every series beside the best model so far."""
        make = self._comparisons
        return values if make is None else replace(values, comparisons=lambda: make(self.best))

    # --- what `fit` calls -------------------------------------------------------------------------

    def announce(self, state: str) -> None:
        """Tell the output functions of the options that the search begins or ends.

        Raises Stopped where one of them wants to stop.
        """
        self._announce(self.best, self.best_value, state)

    def progress(self) -> Progress:
        """How far the search is."""
        spent = time.perf_counter() - self._began
        used = self.criterion.evaluations / self.options.evaluations(self.size)
        share = min(max(self._share, used), 1.0)
        remaining = spent * (1 / share - 1) if share > 0 else np.inf
        named, _ = self.criterion.unpack(self.best)
        return Progress(
            self.criterion.evaluations, self.best_value, spent, remaining, named, self.stage
        )

    def finish(self) -> None:
        """Store the last state, and tell that it is done."""
        self._save(last=True)
        self.set_stage(1.0, self.stage)
        if self._progress is not None:
            self._progress(self.progress())

    def _announce(self, z: Vector, value: float, state: str, procedure: str = "") -> None:
        values = OptimValues(self.criterion.evaluations, self.iterations, value, procedure)
        values = self.with_comparisons(values)
        x = z * self.criterion.scales
        if self.options.stops(x, values, state):
            raise Stopped(-1, "stopped by an output function")

    def _save(self, last: bool) -> None:
        if self._store is not None:
            self._store(self, last)
