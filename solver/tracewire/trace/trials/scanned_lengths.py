"""Lengths that no fit changes, as of the steps of a drive, scanned beside a model that was fitted.

A fit follows how high the steps of a quantiser are, and not where they are: it would take a longer
step for a larger gain. So the length is that of a scan, at first beside a model that lacks the
effect, and then beside the model that has it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tracewire.residual import evaluate_windows, project_out_initial_states
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.statistics import orthonormal
from tracewire.trace.trials.trial import TraceProblem, Trial


def rescan_lengths(problem: TraceProblem, trial: Trial) -> Trial:
    """A trial whose scanned lengths are those near the ones that it has with the least squared
    residual, the rest refitted; the same trial where none is better."""
    for _ in range(problem.options.trial.rescans):
        effects = tuple(_rescan(problem, trial, effect) for effect in trial.effects)
        if all(new is old for new, old in zip(effects, trial.effects, strict=True)):
            break
        better = problem.try_refit(replace(trial, effects=effects))
        if better is None or not better.rss < trial.rss:
            break
        trial = better
    return trial


def _rescan(problem: TraceProblem, trial: Trial, effect: PlacedEffect) -> PlacedEffect:
    """An effect with the lengths that fit best near those that it has: on a coarse grid, and on one
    between two points of that."""
    options, candidate = problem.options.trial, effect.candidate
    for name in candidate.scanned:
        best, unknown, spread = effect.values[name], effect.unknown(name), options.rescan_spread
        least = _promised(problem, trial, {unknown: best})
        for _ in range(options.rescan_grids):
            low, high = candidate.limits[name]
            around = best * np.linspace(1 - spread, 1 + spread, options.rescan_lengths)
            for length in around[(around >= low) & (around <= high)].tolist():
                promised = _promised(problem, trial, {unknown: length})
                if promised < least:
                    best, least = length, promised
            spread /= (options.rescan_lengths - 1) / 2
        if best != effect.values[name]:
            effect = effect.with_value(name, best)
    return effect


def _promised(problem: TraceProblem, trial: Trial, lengths: Mapping[str, float]) -> float:
    """The sum of squares that a trial with other lengths promises to reach where its unknowns and
    the starts of its windows follow, by their linear answers; infinite where it does not run."""
    values = {**trial.values, **lengths}
    windows = evaluate_windows(problem.free_criterion(trial, trial.windows.segments, values))
    if not all(near.ran for near in windows.linearisations):
        return np.inf
    unknowns, residual = project_out_initial_states(windows)
    basis = orthonormal(unknowns)
    left = residual - basis @ (basis.T @ residual)
    return float(left @ left)
