"""The numbers by which effects are judged: effective sample size, BIC, scores, p-values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear
from scipy.special import chdtrc

from tracewire.array_types import Matrix, Vector
from tracewire.trace.limits import ROUNDING
from tracewire.trace.thresholds import ScreenOptions


def effective_fraction(residuals: Sequence[Vector]) -> float:
    """N_eff/N = 2 arccos(rho)/pi, rho the lag-1 correlation of residuals inside windows.

    For white residuals it is 1. For a smooth, oscillating residual it is twice its number of sign
    changes per sample (Rice), which does not depend on how finely the residual is sampled.
    """
    products = sum(float(np.sum(r[1:] * r[:-1])) for r in residuals)
    squares = sum(float(np.sum(r * r)) for r in residuals)
    rho = min(max(products / squares, 0.0), 1.0) if squares > 0 else 0.0
    return max(2 * float(np.arccos(rho)) / np.pi, 1e-4)


def inverse_information(slopes: Matrix) -> tuple[Matrix, Vector]:
    """The covariance of values times their sizes, of residuals of variance 1 with slopes (M, n),
    and the sizes (n,): the norms of the slopes."""
    sizes = np.linalg.norm(slopes, axis=0)
    scaled = slopes / np.where(sizes > 0, sizes, 1.0)
    return np.asarray(np.linalg.pinv(scaled.T @ scaled, rcond=1e-12)), sizes


def flat_values(slopes: Matrix, part: float) -> NDArray[np.bool_]:
    """Which values (n,) take part, by more than a `part`, in a direction along which residuals with
    slopes (M, n) stay as they are."""
    sizes = np.linalg.norm(slopes, axis=0)
    scaled = slopes / np.where(sizes > 0, sizes, 1.0)
    information, directions = np.linalg.eigh(scaled.T @ scaled)
    flat = directions[:, information < ROUNDING.flat * max(float(information[-1]), 1e-300)]
    return np.asarray((np.abs(flat) > part).any(axis=1) | (sizes == 0))


def errors_behind(residuals: Sequence[Vector], others: Sequence[Vector], blocks: int) -> float:
    """By how many standard errors over blocks of time the squared residuals of another model are
    larger than those of one, on the same windows; of white noise half the root of how much larger.
    """
    one, other = (np.concatenate([r.ravel() for r in each]) for each in (residuals, others))
    count = min(blocks, len(one))
    more = np.array([part.sum() for part in np.array_split(other**2 - one**2, count)])
    spread = float(np.std(more, ddof=1)) * count**0.5 if count > 1 else 0.0
    return float(more.sum()) / spread if spread > 0 else float(np.inf)


def bic(rss: float, count: int, effective_fraction: float, unknowns: int) -> float:
    """N_eff ln(RSS/N) + k ln(N): smaller is better."""
    return count * effective_fraction * float(np.log(max(rss, 1e-300) / count)) + unknowns * float(
        np.log(count)
    )


def orthonormal(columns: Matrix) -> Matrix:
    """An orthonormal basis of columns (M, K), without directions that are only rounding.

    The columns count alike, whatever their sizes; those that are zero do not.
    """
    sizes = np.linalg.norm(columns, axis=0)
    kept = columns[:, sizes > 0] / sizes[sizes > 0]
    if not kept.size:
        return np.zeros((len(columns), 0))
    left, singular, _ = np.linalg.svd(kept, full_matrices=False)
    return np.asarray(left[:, singular > ROUNDING.direction * singular[0]])


@dataclass(frozen=True, eq=False)
class CandidateColumns:
    """Candidate columns beside what is there already: d residual/d coefficient, without what
    start values and unknowns can imitate.

    residual (M,), matrix (M, K), `absorbed_fraction` (K,) the part of each column's square that the
    unknowns imitate (that beyond the start values: 1 = completely), `effective_fraction` N_eff/N of
    the residual, `degrees_of_freedom` those of it.
    """

    residual: Vector
    matrix: Matrix
    absorbed_fraction: Vector
    effective_fraction: float
    degrees_of_freedom: int
    options: ScreenOptions = field(default_factory=ScreenOptions)

    @property
    def rss(self) -> float:
        """The sum of squared residuals."""
        return float(self.residual @ self.residual)

    def some(self, indices: Sequence[int]) -> Self:
        """Some of the columns, by number."""
        chosen = list(indices)
        return replace(
            self, matrix=self.matrix[:, chosen], absorbed_fraction=self.absorbed_fraction[chosen]
        )

    @cached_property
    def _alone(self) -> tuple[Vector, Vector]:
        """The falls and the coefficients (K,) of each column alone."""
        sizes = np.einsum("ij,ij->j", self.matrix, self.matrix)
        seen = (1 - self.absorbed_fraction >= ROUNDING.absorbed) & (sizes > 0)
        along = self.residual @ self.matrix
        values = np.where(seen, -along / np.where(seen, sizes, 1.0), 0.0)
        return -along * values, values

    def score(self, indices: Sequence[int]) -> tuple[float, Vector]:
        """By how much columns taken together lower the sum of squares, and their coefficients."""
        if len(indices) == 1:
            falls, values = self._alone
            return float(falls[indices[0]]), values[list(indices)]
        chosen = self.matrix[:, list(indices)]
        if min(1 - self.absorbed_fraction[list(indices)]) < ROUNDING.absorbed:
            return 0.0, np.zeros(len(indices))
        sizes = np.linalg.norm(chosen, axis=0)
        matrix, along = chosen.T @ chosen, self.residual @ chosen
        scaled = np.linalg.lstsq(matrix / np.outer(sizes, sizes), -along / sizes, rcond=1e-12)[0]
        values = np.asarray(scaled / sizes)
        left = self.residual + chosen @ values
        return max(self.rss - float(left @ left), 0.0), values

    def left(self, indices: Sequence[int]) -> Vector:
        """The residual (M,) that columns taken together leave."""
        _, values = self.score(indices)
        return np.asarray(self.residual + self.matrix[:, list(indices)] @ values)

    def unknown_changes(self, indices: Sequence[int]) -> Vector | None:
        """How the unknowns move beside columns, in SI; None where only the effects are known."""
        return None

    def gain(self, rss_reduction: float, count: int) -> float:
        """What a fall of the sum of squares is worth: half the fall of BIC, for `count` numbers."""
        rows = len(self.residual)
        left = max(self.rss - rss_reduction, 1e-12 * self.rss, 1e-300)
        size = 0.5 * rows * self.effective_fraction * float(np.log(self.rss / left))
        return size - 0.5 * count * float(np.log(rows))

    def canonical_correlation(self, one: Sequence[int], other: Sequence[int]) -> float:
        """The canonical correlation of two groups of columns: 1 where no data tell them apart."""
        mine, its = (orthonormal(self.matrix[:, list(indices)]) for indices in (one, other))
        return float(np.linalg.norm(mine.T @ its, 2)) if mine.size and its.size else 0.0

    def p_value(self, groups: Sequence[Sequence[int]], signs: Sequence[int], best: float) -> float:
        """The probability that noise alone gives some group a fall of `best` or more.

        Draws of white noise are scored as the residual is, all groups at once, and a Gumbel
        distribution is fitted to the largest scores by their moments; so correlations between
        columns count, and no run is needed. `best` is a fall in the noise's variance, counted by
        N_eff. Where the sum of the chances of all groups, which is never less, is next to nothing,
        it is that sum.
        """
        variance = (self.rss - best) / max(self.degrees_of_freedom, 1)
        rss_reduction = best * self.effective_fraction / max(variance, 1e-300)
        most = sum(float(chdtrc(len(group), rss_reduction)) for group in groups)
        if most < ROUNDING.negligible:
            return most
        rng = np.random.default_rng(self.options.seed)
        for draws in self.options.draws:
            p_value = self._monte_carlo_p_value(
                groups, signs, rss_reduction, rng.standard_normal((draws, len(self.residual)))
            )
            if not self.options.sure[0] < p_value < self.options.sure[1]:
                break
        return p_value

    def _monte_carlo_p_value(
        self,
        groups: Sequence[Sequence[int]],
        signs: Sequence[int],
        rss_reduction: float,
        noise: Matrix,
    ) -> float:
        """The p-value of a fall by draws of noise, (draws, M)."""
        largest = np.zeros(len(noise))
        single = [n for n, group in enumerate(groups) if len(group) == 1]
        alone = self.matrix[:, [groups[n][0] for n in single]]
        sizes = np.linalg.norm(alone, axis=0)
        scores = noise @ alone / np.maximum(sizes, 1e-300)
        sided = np.array([signs[n] for n in single])
        scores = np.where((sided == 0) | (scores * sided < 0), scores, 0.0)
        if single:
            largest = np.max(scores**2, axis=1)
        for group in groups:
            if len(group) > 1:
                basis, _ = np.linalg.qr(self.matrix[:, list(group)])
                largest = np.maximum(largest, np.sum((noise @ basis) ** 2, axis=1))
        scale = float(np.std(largest, ddof=1)) * 6**0.5 / np.pi
        place = float(np.mean(largest)) - np.euler_gamma * scale
        return float(-np.expm1(-np.exp(-(rss_reduction - place) / max(scale, 1e-300))))


@dataclass(frozen=True, eq=False)
class BoundedColumns(CandidateColumns):
    """Candidate columns far from the noise: unknowns move far beside them, up to their bounds.

    residual (M,) is what the unknowns leave where they move alone, `whole` (M, K) the columns with
    what unknowns imitate, `unknowns` (M, n) their own columns in SI, `rest` (M,) the residual where
    they do not move, and `room` the lowest and the highest shift (n,) of each.
    """

    whole: Matrix = field(default_factory=lambda: np.zeros((0, 0)))
    unknowns: Matrix = field(default_factory=lambda: np.zeros((0, 0)))
    rest: Vector = field(default_factory=lambda: np.zeros(0))
    room: tuple[Vector, Vector] = field(default_factory=lambda: (np.zeros(0), np.zeros(0)))

    @cached_property
    def _sizes(self) -> Vector:
        """The sizes of the unknowns' columns and of the candidates' (n + K,), 1 for those of
        zeros."""
        both = (np.linalg.norm(part, axis=0) for part in (self.unknowns, self.whole))
        sizes = np.concatenate(list(both))
        return np.asarray(np.where(sizes > 0, sizes, 1.0))

    @cached_property
    def _products(self) -> tuple[Matrix, Vector]:
        """The products of all columns of size 1 with each other and with the residual."""
        columns = np.hstack((self.unknowns, self.whole)) / self._sizes
        return columns.T @ columns, columns.T @ self.rest

    @cached_property
    def _unknowns_reduction(self) -> float:
        """The fall of the sum of squares where the unknowns move alone."""
        return self._solve(())[0]

    def some(self, indices: Sequence[int]) -> Self:
        """As of columns without bounds."""
        return replace(super().some(indices), whole=self.whole[:, list(indices)])

    def score(self, indices: Sequence[int]) -> tuple[float, Vector]:
        """As of columns without bounds; the unknowns move with them."""
        if min(1 - self.absorbed_fraction[list(indices)]) < ROUNDING.absorbed:
            return 0.0, np.zeros(len(indices))
        rss_reduction, values = self._solve(indices)
        return max(rss_reduction - self._unknowns_reduction, 0.0), values[self.unknowns.shape[1] :]

    def left(self, indices: Sequence[int]) -> Vector:
        """As of columns without bounds; the unknowns move with them."""
        _, values = self._solve(indices)
        count = self.unknowns.shape[1]
        with_unknowns = self.rest + self.unknowns @ values[:count]
        return np.asarray(with_unknowns + self.whole[:, list(indices)] @ values[count:])

    def unknown_changes(self, indices: Sequence[int]) -> Vector:
        """How the unknowns move beside columns, in SI (n,)."""
        return self._solve(indices)[1][: self.unknowns.shape[1]]

    def _solve(self, indices: Sequence[int]) -> tuple[float, Vector]:
        """The fall from `rest`, and the values of the unknowns' columns and of some others."""
        count = self.unknowns.shape[1]
        chosen = [*range(count), *(count + n for n in indices)]
        if not chosen:
            return 0.0, np.zeros(0)
        sizes = self._sizes[chosen]
        products, along = self._products
        matrix, right = products[np.ix_(chosen, chosen)], along[chosen]
        free = np.full(len(indices), np.inf)
        low = np.concatenate((self.room[0] * sizes[:count], -free))
        high = np.concatenate((self.room[1] * sizes[:count], free))
        size, turned = np.linalg.eigh(matrix)
        kept = size > 1e-12 * max(float(size[-1]), 1e-300)
        root = (np.sqrt(size[kept]) * turned[:, kept]).T
        target = (turned[:, kept] / np.sqrt(size[kept])).T @ -right
        found = lsq_linear(root, target, (low, high), method="bvls").x
        rss_reduction = -float(found @ (matrix @ found) + 2 * right @ found)
        return rss_reduction, np.asarray(found / sizes)
