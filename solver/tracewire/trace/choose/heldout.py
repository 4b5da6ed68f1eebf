"""What models predict on blocks of time that their fits did not see."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Array, Vector
from tracewire.residual import (
    DESCENT,
    bounded_step,
    evaluate_windows,
    fit_initial_states,
    fit_windows,
    project_out_initial_states,
)
from tracewire.solve import release
from tracewire.trace.choose.horizons import REST, Horizon, Horizons, restrict
from tracewire.trace.limits import ROUNDING
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.bounds import at_bounds
from tracewire.trace.trials.trial import TraceProblem, Trial

Ints = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Finalist:
    """A model fitted at each horizon, and the declared parameters that were set to zero in it."""

    trials: tuple[Trial, ...]
    dropped: tuple[str, ...] = ()

    @property
    def names(self) -> frozenset[str]:
        """The effects that it has, as `name @ place`."""
        return frozenset(str(effect) for effect in self.trials[0].effects)

    @property
    def rss(self) -> float:
        """The product of the sums of squares at each horizon."""
        return math.prod(trial.rss for trial in self.trials)

    @property
    def title(self) -> str:
        """The effects in words."""
        return " + ".join(sorted(self.names)) or "the declared model"

    @property
    def vanished(self) -> tuple[str, ...]:
        """The fitted values that are zero, the bound below which they may not fall: such terms are
        not there. A shape that a fit has left at its default is not among its values."""
        unknowns = self.trials[0].windows.criterion.unknowns

        def is_zero(name: str, scale: float) -> bool:
            return all(
                trial.values.get(name, 0.0) <= ROUNDING.on_bound * scale for trial in self.trials
            )

        return tuple(u.name for u in unknowns if u.low == 0.0 and is_zero(u.name, u.scale))

    @property
    def has_idle_effect(self) -> bool:
        """Whether the coefficient of an effect vanished: it is the model without that effect."""
        coefficients = {effect.candidate.coefficient for effect in self.trials[0].effects}
        return not coefficients.isdisjoint(self.vanished)

    @property
    def numbers(self) -> int:
        """How many numbers are fitted or scanned beside the starts, without those that vanished."""
        first = self.trials[0]
        scanned = sum(len(effect.candidate.scanned) for effect in first.effects)
        return len(first.windows.values) + scanned - len(self.vanished)

    @property
    def at_bounds(self) -> tuple[str, ...]:
        """The fitted values that sit on a bound at some horizon, but for terms that vanished."""
        found = (one for trial in self.trials for one in at_bounds(trial) if not one.absent)
        return tuple(dict.fromkeys(one.name for one in found))

    @property
    def key(self) -> tuple[frozenset[str], tuple[str, ...]]:
        """What tells it from other finalists."""
        return self.names, self.dropped


def errors_in_sample(finalist: Finalist, horizons: Horizons) -> Array:
    """The mean squared residual E/n of the fit itself, (horizons, 1, blocks, channels)."""
    return np.stack([
        errors_by_block(
            horizons.fitted,
            [(of, r) for of, r in zip(horizon.blocks, trial.windows.residuals, strict=True)],
        )[None]
        for horizon, trial in zip(horizons.each, finalist.trials, strict=True)
    ])  # fmt: skip


def errors_held_out(
    problem: TraceProblem, finalist: Finalist, horizons: Horizons, options: TraceOptions
) -> Array:
    """The mean squared residual E/n in sigma of each block, predicted by fits without it.

    Shape (horizons, families of folds, blocks, channels). In windows whose first rows are left out
    only the start is fitted, to what is left out. Fits without scattered blocks are one bounded
    Newton step from the fit to all, those without contiguous parts go on from there. Infinite where
    the model does not run.
    """
    found = []
    for at, (horizon, trial) in enumerate(zip(horizons.each, finalist.trials, strict=True)):
        newton = _Newton(trial, horizon, options.fold_ridge)
        families = []
        for number, family in enumerate(horizons.folds):
            steps = options.fold_steps if number else 0
            parts = [
                _predict_fold(problem, trial, horizon, newton, group, steps, options.coarse)
                for group in family
            ]
            families.append(
                errors_by_block(horizons.fitted, [row for part in parts for row in part])
            )
        predicted = np.stack(families)
        if horizons.gate:
            gate_errors = _gate_errors(
                problem, trial, horizons.gate[at], horizons.count - horizons.fitted
            )
            predicted = np.concatenate((predicted, np.stack([gate_errors] * len(families))), axis=1)
        release(trial.model)
        found.append(predicted)
    return np.stack(found)


def _gate_errors(problem: TraceProblem, trial: Trial, horizon: Horizon, count: int) -> Array:
    """The mean squared residual of blocks of series that no fit sees, (blocks, channels)."""
    windows = problem.windows_on(trial, horizon.segments, trial.windows.inlier_limit)
    return errors_by_block(count, list(zip(horizon.blocks, windows.residuals, strict=True)))


class _Newton:
    """The linearised fit of a trial, from which a fit without some blocks is one step away."""

    def __init__(self, trial: Trial, horizon: Horizon, ridge: float) -> None:
        windows = trial.windows
        self.windows = windows
        self.exact = all(
            not segment.free or len(np.unique(of)) == 1
            for segment, of in zip(windows.criterion.segments, horizon.blocks, strict=True)
        )
        """Whether no window with a free start is left out in part."""
        self.scales = np.array([u.scale for u in windows.criterion.unknowns])
        reduced, self.residual = project_out_initial_states(windows)
        self.reduced = reduced * self.scales
        self.ridge = np.diag(ridge**0.5 * np.linalg.norm(self.reduced, axis=0))
        self.blocks = np.concatenate([
            np.repeat(of, near.residual.shape[1])
            for of, near in zip(horizon.blocks, windows.linearisations, strict=True)
        ])  # fmt: skip

    def without(self, group: Sequence[int]) -> dict[str, float]:
        """The values that a fit without some blocks would have."""
        unknowns, values = self.windows.criterion.unknowns, dict(self.windows.values)
        if not unknowns:
            return values
        kept = ~np.isin(self.blocks, group)
        now = np.array([values[u.name] for u in unknowns])
        low, high = np.array([u.low for u in unknowns]), np.array([u.high for u in unknowns])
        room = (low - now) / self.scales, (high - now) / self.scales
        reduced = np.concatenate((self.reduced[kept], self.ridge))
        residual = np.concatenate((self.residual[kept], np.zeros(len(unknowns))))
        step = bounded_step(reduced, residual, DESCENT.least_damping, room)
        moved = np.clip(now + step * self.scales, low, high)
        return dict(zip((u.name for u in unknowns), moved.tolist(), strict=True))


def _predict_fold(
    problem: TraceProblem,
    trial: Trial,
    horizon: Horizon,
    newton: _Newton,
    group: Sequence[int],
    steps: int,
    ftol: float,
) -> list[tuple[Ints, Vector]]:
    """The blocks and the residuals in sigma of the rows that a fold leaves out."""
    known = trial.windows.segments
    kept, held = horizon.without(group), horizon.within(group)
    columns = trial.windows.residuals[0].shape[1]
    failed = [(horizon.blocks[n][rows], np.full((len(rows), columns), np.inf)) for n, rows in held]
    if not kept:
        return failed
    values: Mapping[str, float] = newton.without(group)
    starts: dict[int, Mapping[str, float]] = {}
    if steps or not newton.exact:
        segments = [restrict(known[n], rows) for n, rows in kept]
        first = evaluate_windows(
            problem.free_criterion(trial, segments, values), trial.windows.inlier_limit
        )
        fitted, _ = fit_windows(first, max(steps, 1), ftol=ftol, initial_state_steps=1)
        values = fitted.values
        first_held = {n: rows[0] for n, rows in held}
        starts = {
            n: start
            for (n, rows), start in zip(kept, fitted.starts, strict=True)
            if rows[0] < first_held.get(n, -1)  # later rows hardly tell a start that is damped
        }
    residuals = _fold_residuals(problem, trial, held, starts, values)
    return [(horizon.blocks[n][rows], r) for (n, rows), r in zip(held, residuals, strict=True)]


def _fold_residuals(
    problem: TraceProblem,
    trial: Trial,
    held: Sequence[tuple[int, Ints]],
    starts: Mapping[int, Mapping[str, float]],
    values: Mapping[str, float],
) -> list[Vector]:
    """The residuals of left out rows with the values of a fold."""
    segments, known = [], trial.windows.segments
    for n, rows in held:
        segment = restrict(known[n], rows)
        if n in starts:  # its first rows were fitted, and with them its start
            segment = replace(segment, start={**segment.start, **starts[n]}, free=())
        segments.append(segment)
    first = evaluate_windows(
        problem.fixed_criterion(trial, segments, values), trial.windows.inlier_limit
    )
    return fit_initial_states(first).residuals


def errors_by_block(count: int, parts: Sequence[tuple[Ints, Vector]]) -> Array:
    """The mean of squared residuals by block and channel, (blocks, channels)."""
    blocks = np.concatenate([of for of, _ in parts])
    squares = np.concatenate([r for _, r in parts]) ** 2
    blocks, squares = blocks[blocks != REST], squares[blocks != REST]
    sums = np.zeros((count, squares.shape[1]))
    np.add.at(sums, blocks, squares)
    return np.asarray(sums / np.maximum(np.bincount(blocks, minlength=count), 1)[:, None])
