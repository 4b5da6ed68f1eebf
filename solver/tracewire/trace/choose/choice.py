"""The choice between models by what they predict on blocks of time that their fits did not see.

For a model m, a horizon h, a fold f and a block b, with E/n the mean squared held-out residual,

    S[m,h,f,b] = 1/2 ln(E/n + phi^2),   phi^2[h,f] = median over b of the least E/n of any model,

and T[m,b] is the mean of S over h and f. Models compare by the differences of T over blocks, with
their standard error. Chosen is the model of fewest numbers that is as near the best as one standard
error or 5 %; where it has a wave, a drift or their kin, the best of common effects that leaves
hardly more of the squared error with fewer numbers; then without each effect that costs as little,
and with a simpler effect in the place of one that imitates it. The logarithm lets a decay be judged
by all of its blocks, and not by the first alone.

Blocks in which both models are at the noise say nothing for either. They outweigh a law that shows
at the start of each decay alone. So a model is also sure where it takes away what stands out, in
each block in which something does.

The logarithm has no measure of what matters: it counts the last per cent of the squared error as
much as the first half of it, and there the rest of laws that are only nearly right looks like some
effect. So an effect must also take a part of the declared model's squared error away, or nearly all
of what is left without it. Another effect in its place that leaves less than such a part more, and
no more than a few times as much, is a tie.

Source: cross-validation with the one-standard-error rule (Breiman et al. 1984, section 3.4.3;
Hastie et al., Elements of Statistical Learning, section 7.10).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import special

from tracewire.array_types import Array, Vector
from tracewire.trace.options import TraceOptions


@dataclass(frozen=True)
class Entrant:
    """What the choice knows of a model: its effects by name, how many numbers it fits, how much
    speaks against it (uncommon effects as waves, drifts or a sensor's gain; values on bounds), how
    many of its effects may have either sign, so that no physics restricts them, the effects that
    its own ones imitate, the part of the declared model's squared error on held-out blocks that it
    leaves, by horizon, and whether it takes away what stands out in the declared model's."""

    effects: frozenset[str]
    numbers: int
    uncommon: int = 0
    unsigned: int = 0
    imitated: frozenset[str] = frozenset()
    left: tuple[float, ...] = ()
    clears: bool = False

    def leaves_more(self, other: Entrant) -> float:
        """By how much more of the declared model's squared error it leaves, the mean over horizons;
        infinite where that is not known."""
        pairs = zip(self.left, other.left, strict=True)
        return float(np.mean([mine - theirs for mine, theirs in pairs] or [np.inf]))

    def is_as_good(self, other: Entrant, options: TraceOptions) -> bool:
        """Whether what another model has more may stand for anything: it takes a small part of the
        declared model's squared error away, and not nearly all of what is left without it."""
        nearly_all = self.times(other) > 1 / (1 - options.decisive)
        return self.leaves_more(other) <= options.material and not nearly_all

    def is_close(self, other: Entrant, blocks: int, options: TraceOptions) -> bool:
        """Whether it is another model with one effect exchanged, at most one number more, and too
        little more squared error on so many blocks to be excluded: a small part of the declared
        model's, and not significantly more than the other one leaves by an F-test."""
        if not self.exchanges(other) or self.numbers > other.numbers + 1:
            return False
        times = float(special.fdtri(blocks, blocks, options.tied))
        return self.leaves_more(other) <= options.material and self.times(other) <= times

    def times(self, other: Entrant) -> float:
        """How many times the squared error of another model it leaves, the most of all horizons;
        infinite where that is not known."""
        pairs = zip(self.left, other.left, strict=True)
        return max((mine / max(theirs, 1e-300) for mine, theirs in pairs), default=np.inf)

    def exchanges(self, other: Entrant) -> bool:
        """Whether it is another model with one effect in the place of one of its own."""
        return len(self.effects - other.effects) == len(other.effects - self.effects) == 1

    def simplifies(self, other: Entrant) -> bool:
        """Whether it is another model with one effect in the place of one that imitates it, as
        Coulomb friction for a Stribeck curve, and fewer numbers."""
        imitated = self.effects - other.effects <= other.imitated
        return self.exchanges(other) and imitated and self.numbers < other.numbers


@dataclass(frozen=True, eq=False)
class Choice:
    """The model that was chosen, by its number, and how the declared model 0 compares to it: the
    mean difference of T (0.05 is 5 % of the error), its z over blocks, and whether that is sure.
    `ties` are the models that these data cannot tell from it, the nearest first, each with its
    difference of T."""

    chosen: int
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

    Only models that are surely better than the declared one are compared, where there are any; none
    that fits as many numbers more than the declared one as there are blocks to judge them by, and
    none that has more squared error at each horizon.
    scores: S, (models, horizons, families of folds, blocks); not finite where a model does not run.
    folds: the blocks that one fit predicts, by family.
    """
    tolerance = float(np.log1p(options.near))
    totals = scores.mean(axis=(1, 2))
    fewer = entrants[0].numbers + totals.shape[-1]
    usable = [
        n
        for n in _usable(totals)
        if n == 0 or (entrants[n].numbers < fewer and min(entrants[n].left, default=0.0) < 1)
    ]
    surer = [n for n in usable if n and beats_declared(entrants, totals, n, options)]
    among = surer or usable
    chosen = _simplest_near_best(entrants, totals, among, tolerance)
    while commoner := _commoner_models(entrants, among, chosen, options):
        chosen = _simplest_near_best(entrants, totals, commoner, tolerance)
    # what predicts as well as a sure model with more effects is as sure
    parts = [n for n in usable if n not in among and entrants[n].effects < entrants[chosen].effects]
    near = [n for n in parts if n and _cost(totals, n, chosen) <= tolerance]
    pruned = _prune(entrants, totals, [*among, *near], chosen, options)
    found = choice_of(pruned, entrants, scores, folds, options)
    return replace(found, sure=found.sure or (pruned in near and bool(surer)))


def _simplest_near_best(
    entrants: Sequence[Entrant], totals: Array, among: Sequence[int], tolerance: float
) -> int:
    """The simplest model that is as near the best as the tolerance or one standard error."""
    best = min(among, key=lambda n: totals[n].mean())
    near = [n for n in among if _cost(totals, n, best) <= max(tolerance, _error(totals, n, best))]

    def simplicity(n: int) -> tuple[int, int, int, float]:
        one = entrants[n]
        return one.numbers, one.uncommon, one.unsigned, float(totals[n].mean())

    return min(near, key=simplicity)


def _commoner_models(
    entrants: Sequence[Entrant], among: Sequence[int], chosen: int, options: TraceOptions
) -> list[int]:
    """The models with fewer uncommon effects and no more numbers that leave hardly more of the
    squared error: waves and drifts follow whatever a law that is nearly right has left."""
    mine = entrants[chosen]
    return [
        n
        for n in among
        if entrants[n].uncommon < mine.uncommon
        and entrants[n].numbers <= mine.numbers
        and entrants[n].is_as_good(mine, options)
    ]


def choice_of(
    chosen: int,
    entrants: Sequence[Entrant],
    scores: Array,
    folds: Sequence[Sequence[Sequence[int]]],
    options: TraceOptions,
) -> Choice:
    """A model chosen, beside the declared one and those that predict as well; else as `choose`."""
    totals = scores.mean(axis=(1, 2))
    gain, z = _cost(totals, 0, chosen), _in_errors(totals[0] - totals[chosen])
    sure = chosen > 0 and beats_declared(entrants, totals, chosen, options)
    ties = _ties(entrants, scores, folds, chosen, options)
    return Choice(chosen, gain, z, sure, ties)


def _usable(totals: Array) -> list[int]:
    return [n for n in range(len(totals)) if np.isfinite(totals[n]).all()]


def beats_declared(
    entrants: Sequence[Entrant], totals: Array, number: int, options: TraceOptions
) -> bool:
    """Whether a model surely predicts better than the declared one: over all blocks, or as it takes
    away what stands out in some."""
    enough = _cost(totals, 0, number) >= np.log1p(options.near)
    return is_sure(totals, 0, number, options) or bool(enough and entrants[number].clears)


def take_away_what_stands_out(errors: Array, options: TraceOptions) -> NDArray[np.bool_]:
    """Whether each model takes nearly all of the declared one's excess over phi^2 away in each
    block where that stands out, and has no more error in any other by more than the tolerance;
    never where fewer blocks stand out than a law needs to be told from single events.

    errors: E/n, shape (models, horizons, folds, blocks, channels). Their thirds are predicted from
    the other thirds, so that no event is taken away by what follows it alone.
    """
    none = np.zeros(len(errors), dtype=bool)
    if not np.isfinite(errors[0]).all():
        return none
    excess = (errors / floor_of(errors) - 1).mean(axis=(1, 2))
    out = excess[0].max(axis=-1) > options.stands_out
    if np.count_nonzero(out) < options.standing_out:
        return none
    total, totals = excess.sum(axis=-1), log_scores(errors).mean(axis=(1, 2))
    taken = total[:, out] <= (1 - options.decisive) * total[0, out]
    no_worse = totals[:, ~out] <= totals[0, ~out] + np.log1p(options.near)
    return np.asarray(taken.all(axis=1) & no_worse.all(axis=1))


def is_sure(totals: Array, one: int, other: int, options: TraceOptions) -> bool:
    """Whether one model is worse than another by the tolerance and so many standard errors.

    Also of differences that are cut: a decay shows nearly all in its first blocks, and that these
    differ from the later ones is no doubt about the sign. And also, of blocks enough, without the
    largest and the smallest: a block that no other one is like is predicted by extrapolation, where
    a right model with one number more may be far off.
    """
    change, most = totals[one] - totals[other], np.log1p(options.block_counts)
    inner = np.sort(change)[1:-1] if len(change) >= options.least_blocks else change
    errors = max(map(_in_errors, (change, np.clip(change, -most, most), inner)))
    return bool(np.mean(change) >= np.log1p(options.near) and errors >= options.sure)


def _in_errors(change: Vector) -> float:
    """The mean of differences by block in its standard errors."""
    mean, error = float(np.mean(change)), _standard_error(change)
    return mean / error if error > 0 else float(np.copysign(np.inf, mean)) if mean else 0.0


def _prune(
    entrants: Sequence[Entrant],
    totals: Array,
    usable: Sequence[int],
    chosen: int,
    options: TraceOptions,
) -> int:
    """The model without each effect that costs at most the tolerance or two standard errors, or
    that takes too small a part of the squared error away, and with a simpler effect where that
    costs at most the tolerance; an uncommon effect gives way where it takes such a small part."""
    tolerance, first = float(np.log1p(options.near)), entrants[chosen]
    while True:
        mine, costs = entrants[chosen], []
        for n in usable:
            one = entrants[n]
            cost, error = _cost(totals, n, chosen), _error(totals, n, chosen)
            if one.effects < mine.effects:
                accepted = cost <= max(tolerance, 2 * error) or one.is_as_good(first, options)
            else:
                commoner = one.uncommon < mine.uncommon and one.is_as_good(mine, options)
                accepted = one.simplifies(mine) and (cost <= tolerance or commoner)
            if accepted:
                costs.append((one.numbers, cost, n))
        if not costs:
            return chosen
        chosen = min(costs)[2]


def _ties(
    entrants: Sequence[Entrant],
    scores: Array,
    folds: Sequence[Sequence[Sequence[int]]],
    chosen: int,
    options: TraceOptions,
) -> tuple[tuple[int, float], ...]:
    """Models as near as the tolerance or one standard error, with at most one number more. Here the
    spread of the folds counts, too: errors inside a fold are common to its blocks. A model with one
    effect exchanged is also a tie where it leaves too little more to exclude it."""
    totals, by_family = scores.mean(axis=(1, 2)), scores.mean(axis=1)
    tolerance, mine, found = float(np.log1p(options.near)), entrants[chosen], []
    for n in _usable(totals):
        one = entrants[n]
        if n == chosen or one.numbers > mine.numbers + 1:
            continue
        if one.effects == mine.effects or not one.effects:
            continue
        change = by_family[n] - by_family[chosen]
        means = [
            float(np.mean(change[f][list(g)])) for f, groups in enumerate(folds) for g in groups
        ]
        spread = float(np.std(means, ddof=1)) / len(means) ** 0.5 if len(means) > 1 else 0.0
        cost = _cost(totals, n, chosen)
        near = cost <= max(tolerance, _error(totals, n, chosen), spread)
        if near or one.is_close(mine, scores.shape[-1], options):
            found.append((n, cost))
    return tuple(sorted(found, key=lambda tie: tie[1]))


def _cost(totals: Array, one: int, other: int) -> float:
    """How much worse one model is than another: the mean difference of T over blocks."""
    return float(np.mean(totals[one] - totals[other]))


def _error(totals: Array, one: int, other: int) -> float:
    """The standard error of that difference over blocks."""
    return _standard_error(totals[one] - totals[other])


def _standard_error(change: Vector) -> float:
    """Of the mean of differences by block."""
    return float(np.std(change, ddof=1)) / len(change) ** 0.5 if len(change) > 1 else 0.0
