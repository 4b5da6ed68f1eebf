"""Where something is missing and what it depends on: smooth torques at each place, cross-validated.

At each place, for each set of variables, the missing torque is a smooth function: many bumps. The
torque linearisation says what each of them does to the residuals; a ridge fits them, together with
what the unknowns of the declared model can still do; and the squared residual is taken on data that
the fit did not see. What share of the excess goes says whether the torque depends on these
variables.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Matrix, Vector
from tracewire.residual import Projection, project_out_initial_states
from tracewire.trace.candidates.places import Place
from tracewire.trace.found import Dependence, Missing
from tracewire.trace.limits import BATCH
from tracewire.trace.missing.bases import Basis, bases_of
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation, WindowPieces
from tracewire.trace.thresholds import MapOptions
from tracewire.trace.trials.statistics import orthonormal
from tracewire.trace.trials.trial import Trial


@dataclass(frozen=True, eq=False)
class ScoredBasis:
    """A basis at a place with its cross-validated share, ridge, and coefficients on all data."""

    place: Place
    basis: Basis
    share: float
    rss_reduction: float
    coefficients: Vector

    def size(self, history: int) -> int:
        """How many variables it takes; the history of a motion counts as some."""
        names = (name.partition(" of ")[0] for name in self.basis.variables)
        return sum(history if name == "history" else 1 for name in names)


def map_dependence(
    linearisation: TorqueLinearisation, trial: Trial, places: Sequence[Place]
) -> tuple[tuple[Dependence, ...], Missing | None]:
    """The share of the excess that each set of variables explains at each place, the best first.

    The excess is the squared residual beyond its degrees of freedom. `Missing` is the torque of the
    smallest set of variables that is nearly as good as the best, at its place or at another one;
    None where nothing explains more than noise does. Its torque is what is missing beyond what the
    free parameters can still do. Variables are named as in `bases_of`.
    """
    problem = _problem(linearisation, trial)
    found = [
        scored
        for place in places
        for scored in _score_bases(
            problem, place, bases_of(place, linearisation.trajectories, linearisation.options.map)
        )
    ]
    best: dict[tuple[str, tuple[str, ...]], ScoredBasis] = {}
    for scored in found:
        key = scored.place.name, scored.basis.variables
        if key not in best or scored.rss_reduction > best[key].rss_reduction:
            best[key] = scored
    ranked = sorted(best.values(), key=lambda scored: -scored.rss_reduction)
    shares = tuple(Dependence(s.place.name, s.basis.variables, s.share) for s in ranked)
    chosen = choose_smallest(ranked, linearisation.options.map)
    return shares, None if chosen is None else _missing(problem, chosen)


def choose_smallest(ranked: Sequence[ScoredBasis], options: MapOptions) -> ScoredBasis | None:
    """The one of fewest variables among those that are as good as the best; None: noise."""
    top = max(ranked, key=lambda scored: scored.share, default=None)
    if top is None or top.share < options.least_share or top.rss_reduction < options.least_fall:
        return None

    def is_good(scored: ScoredBasis) -> bool:
        near = options.near if scored.place == top.place else options.near_elsewhere
        return scored.share >= near * top.share

    def rank(scored: ScoredBasis) -> tuple[int, bool, bool, float]:
        driven = scored.basis.variables[0].startswith(("u", "drive"))
        elsewhere = scored.place != top.place and not driven
        size = scored.size(options.history_counts)
        return size, driven and scored.place.kind != "drive", elsewhere, -scored.share

    return min(filter(is_good, ranked), key=rank)


# --- the linear problem ---------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class MapProblem:
    """Residuals (M,) and the unknowns' derivatives (M, n) without window starts, folds (M,)."""

    linearisation: TorqueLinearisation
    projections: Sequence[Projection]
    residual: Vector
    unknowns: Matrix
    folds: NDArray[np.intp]
    degrees_of_freedom: int

    @property
    def excess(self) -> float:
        """The squared residual beyond the noise's; at least what noise makes it vary by."""
        rss = float(self.residual @ self.residual)
        return max(rss - self.degrees_of_freedom, 3 * float(np.sqrt(2 * self.degrees_of_freedom)))

    def products(self, place: Place, bases: Sequence[Basis]) -> Matrix:
        """The scalar products by fold, (folds, n + K + 1, n + K + 1), of the unknowns, of what all
        functions of some bases at a place do to the residuals, and of the residual.

        They are added up a few windows at a time: the columns of a long record are much memory.
        """
        series = range(len(self.linearisation.trajectories))
        given = [np.concatenate([b.columns[n] for b in bases], axis=1) for n in series]
        width = self.unknowns.shape[1] + given[0].shape[1] + 1
        total = np.zeros((self.linearisation.options.map.folds, width, width))
        first, waiting, rows = 0, list[Matrix](), 0
        for n, (window, view) in enumerate(
            zip(self.linearisation.window_pieces, self.projections, strict=True)
        ):
            if place.kind == "sensor":
                columns = _sensor_response(self.linearisation, place.definition, window, given)
            else:
                columns = self.linearisation.window_response(window, {place.name: given})
            last = first + rows + len(columns)
            here = slice(first + rows, last)
            known, left = self.unknowns[here], self.residual[here]
            waiting.append(np.column_stack((known, view.project_out(columns), left)))
            rows = last - first
            if rows >= BATCH.map_rows or n + 1 == len(self.projections):
                block, folds = np.concatenate(waiting), self.folds[first:last]
                for fold in np.unique(folds).tolist():
                    rows_of = block[folds == fold]
                    total[fold] += rows_of.T @ rows_of
                first, waiting, rows = last, [], 0
        return total


def _problem(linearisation: TorqueLinearisation, trial: Trial) -> MapProblem:
    windows = linearisation.windows
    views = windows.projections
    unknowns, residual = project_out_initial_states(windows)
    sizes = np.linalg.norm(unknowns, axis=0)
    seen = sizes > 1e-12 * max(float(sizes.max(initial=0.0)), 1e-300)
    basis = orthonormal(unknowns[:, seen])
    return MapProblem(
        linearisation, views, residual, basis, _folds(linearisation), trial.degrees_of_freedom
    )


def _folds(linearisation: TorqueLinearisation) -> NDArray[np.intp]:
    """The fold of each residual: neighbouring pieces of a series have different ones.

    Their order is shuffled, so that no fold is always the same phase of a drive.
    """
    options = linearisation.options.map
    rng = np.random.default_rng(options.seed)
    order = np.concatenate([rng.permutation(options.folds) for _ in range(options.pieces)])
    windows = linearisation.windows
    names = [s.measured.name for s in windows.criterion.segments]
    totals = dict.fromkeys(names, 0)
    for name, near in zip(names, windows.linearisations, strict=True):
        totals[name] += len(near.residual)
    passed = dict.fromkeys(totals, 0)
    found = []
    for name, near in zip(names, windows.linearisations, strict=True):
        rows, width = near.residual.shape
        first, longest = passed[name], totals[name] / options.pieces
        at = np.full(rows, first + rows // 2) if rows <= longest else first + np.arange(rows)
        chunks = np.minimum(at / longest, options.pieces - 1).astype(int)
        found.append(np.repeat(order[chunks], width))
        passed[name] = first + rows
    return np.concatenate(found)


def _sensor_response(
    linearisation: TorqueLinearisation, signal: str, window: WindowPieces, given: Sequence[Matrix]
) -> Matrix:
    """What a sensor's error of its signal (N, k) by series does to the residuals of a window."""
    criterion = linearisation.windows.criterion
    name = criterion.segments[window.index].measured.name
    at = linearisation.outputs.index(signal)
    error = given[linearisation.series[window.index]][window.samples[window.counts]]
    rows = np.zeros((len(error), len(linearisation.outputs), error.shape[1]))
    rows[:, at] = error / criterion.sigma[name][at]
    return criterion.whiten(window.index, rows.reshape(-1, error.shape[1]))


def _score_bases(
    problem: MapProblem, place: Place, bases: Iterator[Basis]
) -> Iterator[ScoredBasis]:
    """Each basis at a place, cross-validated."""
    some: list[Basis] = []
    for basis in bases:
        some.append(basis)
        if sum(b.columns[0].shape[1] for b in some) >= BATCH.map_columns:
            yield from _score_batch(problem, place, some)
            some = []
    if some:
        yield from _score_batch(problem, place, some)


def _score_batch(problem: MapProblem, place: Place, bases: Sequence[Basis]) -> list[ScoredBasis]:
    """Some bases at a place, each cross-validated: from scalar products of columns by fold."""
    products, excess = problem.products(place, bases), problem.excess
    known, ridges = problem.unknowns.shape[1], np.array(problem.linearisation.options.map.ridges)
    first, found = known, []
    for basis in bases:
        last = first + basis.columns[0].shape[1]
        chosen = [*range(known), *range(first, last), products.shape[1] - 1]
        own = products[:, chosen][:, :, chosen]
        left = _held_out_squares(own, known, ridges)
        best = int(np.argmin(left))
        before = float(np.sum(own[:, -1, -1]))
        rss_reduction = before - float(left[best])
        share = min(max(rss_reduction / excess, 0.0), 1.0)
        (values,) = _solve_ridge(np.sum(own, axis=0), known, ridges[best : best + 1])
        # what a basis is made of does not matter any more, and is much memory
        found.append(
            ScoredBasis(place, replace(basis, columns=()), share, rss_reduction, values[known:])
        )
        first = last
    return found


def _held_out_squares(products: Matrix, known: int, ridges: Vector) -> Vector:
    """The squared residual on the folds that were left out, for each ridge."""
    total = np.sum(products, axis=0)
    left = np.zeros(len(ridges))
    for own in products:
        values = _solve_ridge(total - own, known, ridges)
        full = np.column_stack((values, np.ones(len(values))))
        left += np.einsum("ri,ij,rj->r", full, own, full)
    return left


def _solve_ridge(products: Matrix, known: int, ridges: Vector) -> Matrix:
    """The coefficients for each ridge, (ridges, n), which minimise |r + A c|^2 + ridge |c|^2.

    The first `known` columns bear no ridge. The ridge is in units of the mean square of the rest.
    Without them the information of the rest has no negative eigenvalue but for rounding, which
    grows as they are more alike.
    """
    a, b, c = products[:known, :known], products[:known, known:-1], products[known:-1, known:-1]
    p, q = products[:known, -1], products[known:-1, -1]
    inverse = np.linalg.pinv(a, rcond=1e-10, hermitian=True)
    inner = c - b.T @ inverse @ b
    right = q - b.T @ inverse @ p
    unit = max(float(np.trace(c)) / max(len(c), 1), 1e-200)
    information, directions = np.linalg.eigh(inner)
    penalised = np.maximum(information, 0.0) + unit * ridges[:, None]
    smooth = -(directions.T @ right / penalised) @ directions.T
    exact = -(p + smooth @ b.T) @ inverse
    return np.concatenate((exact, smooth), axis=1)


# --- the missing torque ---------------------------------------------------------------------------


def _missing(problem: MapProblem, chosen: ScoredBasis) -> Missing:
    """The torque of the winner on a grid, with the number of samples near each point."""
    basis = chosen.basis
    names, share = basis.variables, chosen.share
    if not basis.axes or len(basis.axes) != len(names):
        nothing = np.zeros(0)
        return Missing(chosen.place.name, names, share, (), nothing, nothing)
    count = problem.linearisation.options.map.grid
    grid = tuple(np.linspace(*axis.ends, count[len(names) - 1]) for axis in basis.axes)
    points = [x.ravel() for x in np.meshgrid(*grid, indexing="ij")]
    shape = tuple(len(x) for x in grid)
    torque = (basis.at(*points) @ chosen.coefficients).reshape(shape)
    values = [np.concatenate(axis.values) for axis in basis.axes]
    edges = [_edges(x) for x in grid]
    density, _ = np.histogramdd(values, edges)
    return Missing(chosen.place.name, names, share, grid, torque, np.asarray(density))


def _edges(grid: Vector) -> Vector:
    """The bounds of the cells around evenly spaced points."""
    half = (grid[1] - grid[0]) / 2
    return np.concatenate((grid - half, grid[-1:] + half * (1 + 1e-9)))
