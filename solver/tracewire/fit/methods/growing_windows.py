"""The method growing_windows: least squares on growing parts of each series.

On a long record the criterion of an unstable or barely damped system is full of minima; on its
first samples it has one. So the search begins there, and goes on as far as the model follows.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Matrix, Vector
from tracewire.fit.limits import GROWING, TRACKING
from tracewire.fit.methods.tracking import count_tracked, spread_of
from tracewire.fit.search import MethodResult, Search
from tracewire.residual import Criterion, half_square, solve_least_squares

Counts = NDArray[np.intp]


def by_growing_windows(search: Search) -> MethodResult:
    """The minimum by least squares on the first samples, then on more and more of them.

    A part grows to where the model has followed the series so far. On each, unknowns are held to
    where they stood, with the weight that the residual's size gives to a relative width of 0.3, so
    that a short part cannot move what it does not determine. Where the search goes astray on a
    part, it goes back and tries a shorter one. At the end comes least squares on the whole series.
    """
    windows = _Windows(search)
    while not windows.is_whole() and windows.number < GROWING.most_parts:
        windows.next()
    search.set_stage(0.9, "the whole series")
    result = solve_least_squares(
        search,
        windows.z,
        steps=GROWING.last_steps,
        tolerance=GROWING.last_ftol,
        callback=search.count_iteration,
    )
    if search.best_value < 0.5 * result.cost:  # an earlier part has led to a better minimum
        result = solve_least_squares(
            search,
            search.best,
            steps=GROWING.last_steps,
            tolerance=GROWING.last_ftol,
            callback=search.count_iteration,
        )
    parts = f"after {windows.number} growing parts"
    return MethodResult(
        result.z, search.iterations, int(result.converged), f"{result.message} {parts}"
    )


class _Windows:
    """How far the search is: the unknowns z, the samples of each series that are followed, and
    those of the next part."""

    def __init__(self, search: Search) -> None:
        self.search = search
        segments = search.criterion.segments
        self.sizes = np.array([len(s.rows) for s in segments])
        self.spreads = [spread_of(s, TRACKING.parts) for s in segments]
        kept = search.resumed
        self.z = np.array(kept["z"]) / search.criterion.scales if kept else search.begin
        self.value = search.best_value  # of the whole series at z
        self.number = int(kept["number"]) if kept else 0
        least = np.minimum(GROWING.fewest_samples, self.sizes)
        first = np.minimum(GROWING.fewest_samples // 2, self.sizes)
        self.reached = np.array(kept["reached"]) if kept else first
        self.counts = (
            np.array(kept["counts"]) if kept else np.maximum(self.count_tracked(self.z), least)
        )

    def is_whole(self) -> bool:
        """Whether the next part is the whole series."""
        return bool(np.all(self.counts >= self.sizes))

    def next(self) -> None:
        """Least squares on the next part, and how much of the series comes after it."""
        search = self.search
        self.number += 1
        share = float(np.mean(self.counts / self.sizes))
        search.set_stage(0.9 * share, f"part {self.number}, {100 * share:.2g} % of the series")
        part = _Part(search, self.counts, self.z)
        result = solve_least_squares(part, self.z, steps=GROWING.steps, tolerance=GROWING.ftol)
        longest = self.counts.copy()
        between = np.sqrt(self.reached * self.counts).astype(int)
        if part.is_astray(result.z) and np.any(self.counts > GROWING.slowest * between):
            self.counts = np.maximum(between, 1)
        else:
            self.z, self.reached = result.z, longest
            most = np.ceil(GROWING.fastest * longest).astype(int)
            least = np.ceil(GROWING.slowest * longest).astype(int)
            tracked = np.clip(self.count_tracked(self.z), least, most)
            self.counts = np.minimum(tracked, self.sizes)
        search.checkpoint(
            {
                "z": (self.z * search.criterion.scales).tolist(),
                "number": self.number,
                "reached": self.reached.tolist(),
                "counts": self.counts.tolist(),
            }
        )
        search.count_iteration(self.z, self.value, f"part {self.number}")

    def count_tracked(self, z: Vector) -> Counts:
        """How many first samples of each series the model follows, shape (segments,)."""
        search = self.search
        search.check_limits()
        residuals = search.criterion.residuals(z)
        self.value = half_square(search.criterion.weigh(residuals))
        search.record_best(z, self.value)
        found = []
        for segment, residual, spread in zip(
            search.criterion.segments, residuals, self.spreads, strict=True
        ):
            sigma = search.criterion.sigma[segment.measured.name]
            found.append(count_tracked(residual * sigma, spread))
        return np.array(found)


class _Part:
    """The criterion on the first samples of each series, with the unknowns held to where they are.

    Its vector has that of the criterion, and then one entry for each unknown.
    """

    def __init__(self, search: Search, counts: Counts, around: Vector) -> None:
        self.search, self.around = search, around
        segments = search.criterion.segments
        shorter = [replace(s, rows=s.rows[:n]) for s, n in zip(segments, counts, strict=True)]
        self.criterion: Criterion = search.criterion.on_segments(shorter)
        before = search.vector(around, self.criterion)
        noise = 2 * half_square(before) / max(len(before), 1)
        self.pull = np.sqrt(noise) / (GROWING.width * np.maximum(np.abs(around), 1.0))

    def bounds(self) -> tuple[Vector, Vector]:
        """Those of the search."""
        return self.search.bounds()

    def vector(self, z: Vector) -> Vector:
        """The vector (M + n,)."""
        vector = self.search.vector(z, self.criterion)
        return np.concatenate([vector, self.pull * (z - self.around)])

    def vector_and_jacobian(self, z: Vector) -> tuple[Vector, Matrix]:
        """The vector (M + n,) and its derivatives (M + n, n)."""
        vector, matrix = self.search.vector_and_jacobian(z, self.criterion)
        held = self.pull * (z - self.around)
        return np.concatenate([vector, held]), np.concatenate([matrix, np.diag(self.pull)])

    def is_astray(self, z: Vector) -> bool:
        """Whether much of the spread of the data on this part remains."""
        residuals = self.criterion.residuals(z)
        self.search.count_evaluations(self.criterion)
        for segment, residual in zip(self.criterion.segments, residuals, strict=True):
            off = np.sqrt(np.mean(residual**2, axis=0))
            sigma = self.criterion.sigma[segment.measured.name]
            if np.any(off * sigma > GROWING.diverged * spread_of(segment)):
                return True
        return False
