"""The choice between models by what they predict on blocks of time that their fits did not see.

For a model m, a horizon h, a fold f and a block b, with E/n the mean squared held-out residual,

    S[m,h,f,b] = 1/2 ln(E/n + phi^2),   phi^2[h,f] = median over b of the least E/n of any model,

and T[m,b] is the mean of S over h and f. Models compare by the differences of T over blocks, with
their standard error. Taken is the model of fewest numbers that is as near the best as one standard
error or 5 %, then without each effect that costs as little, and with a simpler effect in the place
of one that imitates it. The logarithm lets a decay be judged by all of its blocks, and not by the
first alone.

Source: cross-validation with the one-standard-error rule (Breiman et al. 1984, section 3.4.3;
Hastie et al., Elements of Statistical Learning, section 7.10).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracewire.trace.options import TraceOptions

Vector = NDArray[np.float64]
Array = NDArray[np.float64]


@dataclass(frozen=True)
class Entrant:
    """What the choice knows of a model: its effects by name, how many numbers it fits, how much
    speaks against it (uncommon effects as waves, drifts or a sensor's gain; values on bounds), how
    many of its effects may have either sign, so that no physics restricts them, and the effects
    that its own ones imitate."""

    effects: frozenset[str]
    numbers: int
    uncommon: int = 0
    unsigned: int = 0
    imitated: frozenset[str] = frozenset()

    def simplifies(self, other: Entrant) -> bool:
        """Whether it is another model with one effect in the place of one that imitates it, as
        Coulomb friction for a Stribeck curve, and fewer numbers."""
        new, old = self.effects - other.effects, other.effects - self.effects
        return len(new) == len(old) == 1 and new <= other.imitated and self.numbers < other.numbers


@dataclass(frozen=True, eq=False)
class Choice:
    """The model that was taken, by its number, and how the declared model 0 compares to it: the
    mean difference of T (0.05 is 5 % of the error), its z over blocks, and whether that is sure.
    `ties` are the models that these data cannot tell from it, the nearest first, each with its
    difference of T."""

    taken: int
    gain: float
    z: float
    sure: bool
    ties: tuple[tuple[int, float], ...]


def floor_of(errors: Array) -> Array:
    """phi^2 from errors E/n, shape (models, horizons, folds, blocks, channels): the median over
    blocks of the least error of any model, (1, horizons, folds, 1, channels)."""
    least = np.median(np.min(errors, axis=0), axis=2, keepdims=True)[None]
    return np.asarray(np.maximum(least, 1e-12 * np.median(errors[0]) + 1e-300))


def log_scores(errors: Array, floor: Array | None = None) -> Array:
    """S from errors E/n, shape (models, horizons, folds, blocks, channels): the mean over channels
    of 1/2 ln(E/n + phi^2), shape (models, horizons, folds, blocks). floor: phi^2, if not theirs."""
    floor = floor_of(errors) if floor is None else floor
    return np.asarray(np.mean(0.5 * np.log(errors + floor), axis=-1))


def choose(
    entrants: Sequence[Entrant],
    scores: Array,
    folds: Sequence[Sequence[Sequence[int]]],
    options: TraceOptions,
) -> Choice:
    """The simplest model that predicts as well as the best, pruned; model 0 is the declared one.

    Only models that are surely better than the declared one are compared, where there are any.
    scores: S, (models, horizons, families of folds, blocks); not finite where a model does not run.
    folds: the blocks that one fit predicts, by family.
    """
    tolerance = float(np.log1p(options.near))
    totals = scores.mean(axis=(1, 2))
    usable = _usable(totals)
    surer = [n for n in usable if n and is_sure(totals, 0, n, tolerance, options.sure)]
    among = surer or usable
    best = min(among, key=lambda n: totals[n].mean())
    near = [n for n in among if _cost(totals, n, best) <= max(tolerance, _error(totals, n, best))]

    def simplicity(n: int) -> tuple[int, int, int, float]:
        one = entrants[n]
        return one.numbers, one.uncommon, one.unsigned, float(totals[n].mean())

    taken = min(near, key=simplicity)
    taken = _pruned(entrants, totals, among, taken, tolerance)
    return choice_of(taken, entrants, scores, folds, options)


def choice_of(
    taken: int,
    entrants: Sequence[Entrant],
    scores: Array,
    folds: Sequence[Sequence[Sequence[int]]],
    options: TraceOptions,
) -> Choice:
    """A model taken, beside the declared one and those that predict as well; else as `choose`."""
    tolerance = float(np.log1p(options.near))
    totals = scores.mean(axis=(1, 2))
    gain, z = _cost(totals, 0, taken), _z(totals, 0, taken)
    sure = taken > 0 and is_sure(totals, 0, taken, tolerance, options.sure)
    ties = _ties(entrants, scores, folds, _usable(totals), taken, tolerance)
    return Choice(taken, gain, z, sure, ties)


def _usable(totals: Array) -> list[int]:
    return [n for n in range(len(totals)) if np.isfinite(totals[n]).all()]


def is_sure(totals: Array, one: int, other: int, tolerance: float, least: float) -> bool:
    """Whether one model is worse than another by the tolerance and so many standard errors."""
    return _cost(totals, one, other) >= tolerance and _z(totals, one, other) >= least


def _z(totals: Array, one: int, other: int) -> float:
    """The difference of two models in its standard errors over blocks."""
    cost, error = _cost(totals, one, other), _error(totals, one, other)
    return cost / error if error > 0 else float(np.copysign(np.inf, cost)) if cost else 0.0


def _pruned(
    entrants: Sequence[Entrant], totals: Array, usable: Sequence[int], taken: int, tolerance: float
) -> int:
    """The model without each effect that costs at most the tolerance or two standard errors, and
    with a simpler effect where that costs at most the tolerance."""
    while True:
        mine, costs = entrants[taken], []
        for n in usable:
            cost, error = _cost(totals, n, taken), _error(totals, n, taken)
            part = entrants[n].effects < mine.effects and cost <= max(tolerance, 2 * error)
            if part or (entrants[n].simplifies(mine) and cost <= tolerance):
                costs.append((entrants[n].numbers, cost, n))
        if not costs:
            return taken
        taken = min(costs)[2]


def _ties(
    entrants: Sequence[Entrant],
    scores: Array,
    folds: Sequence[Sequence[Sequence[int]]],
    usable: Sequence[int],
    taken: int,
    tolerance: float,
) -> tuple[tuple[int, float], ...]:
    """Models as near as the tolerance or one standard error, with at most one number more. Here the
    spread of the folds counts, too: errors inside a fold are common to its blocks."""
    totals, by_family = scores.mean(axis=(1, 2)), scores.mean(axis=1)
    found = []
    for n in usable:
        if n == taken or entrants[n].numbers > entrants[taken].numbers + 1:
            continue
        if entrants[n].effects == entrants[taken].effects or not entrants[n].effects:
            continue
        change = by_family[n] - by_family[taken]
        means = [
            float(np.mean(change[f][list(g)])) for f, groups in enumerate(folds) for g in groups
        ]
        spread = float(np.std(means, ddof=1)) / len(means) ** 0.5 if len(means) > 1 else 0.0
        cost = _cost(totals, n, taken)
        if cost <= max(tolerance, _error(totals, n, taken), spread):
            found.append((n, cost))
    return tuple(sorted(found, key=lambda tie: tie[1]))


def _cost(totals: Array, one: int, other: int) -> float:
    """How much worse one model is than another: the mean difference of T over blocks."""
    return float(np.mean(totals[one] - totals[other]))


def _error(totals: Array, one: int, other: int) -> float:
    """The standard error of that difference over blocks."""
    change = totals[one] - totals[other]
    return float(np.std(change, ddof=1)) / len(change) ** 0.5 if len(change) > 1 else 0.0
