"""Finalists: the best models of each size, whose predictions are then compared.

A greedy path is not enough: a pendulum with dry friction and drag shows no single effect beside a
declared viscous friction, and the pair is obvious. So single effects are refitted at both horizons,
pairs come from the screen of the declared model and from screens beside the best single effects,
threes from screens beside the best pairs. In the best of these each effect is exchanged for those
that look alike, and each declared term that may be zero is left out. Fits rank by BIC with blocks
of time as the independent observations.
"""

from __future__ import annotations

import math
from contextlib import suppress
from itertools import chain, repeat

import numpy as np

from tracewire.errors import FitError
from tracewire.trace.choose.exchanges import (
    exchange_effects,
    exchange_for_simpler,
    exchange_single_effects,
)
from tracewire.trace.choose.heldout import Finalist
from tracewire.trace.choose.model_pool import ModelPool
from tracewire.trace.choose.promising import no_longer_absorbed
from tracewire.trace.screen.screening import Proposal
from tracewire.trace.screen.shortlist import distinct
from tracewire.trace.trials.trial import Trial


def fill_pool(pool: ModelPool, declared: Finalist) -> None:
    """Models of one, two and three effects, and those without declared terms."""
    options = pool.options
    numbers = range(len(pool.horizons.each))
    for number in numbers:
        pool.first.append(pool.screen(declared, number))
        singles, pairs = pool.worthwhile_count(options.singles) // len(numbers), options.pairs
        proposals = pool.select_promising(number, pool.first[number], singles, pairs)
        along = _along_data(pool, declared, number, singles, pairs)
        pool.extend(declared, number, distinct([*along, *proposals]))
    for trial in _search_models(pool):
        refitted = _fit_horizons(pool, trial)
        if refitted is not None:
            pool.keep_better(refitted)
    pool.free_single_effects()
    # where no body comes back much looks the same, and what takes all is as good as its kin
    if _improves(pool, 1) and (pool.search.has_revisits or not _takes_all(pool, 1)):
        exchange_single_effects(pool)
        pool.free_single_effects()
    for smaller in pool.without_terms(declared) if not _takes_all(pool, 1) else ():
        with suppress(FitError):
            _extend_without(pool, smaller)
    for size, parents in zip(range(1, options.effects), options.parents, strict=False):
        if not _improves(pool, size) or _takes_all(pool, size):
            break
        for parent in pool.best(size, parents):
            if _is_near(pool, parent, size):
                with suppress(FitError):  # it does not run with its places open
                    _extend_beside(pool, parent)
        if _improves(pool, size + 1):
            exchange_effects(pool, size + 1)
    _simplify(pool)


def _simplify(pool: ModelPool) -> None:
    """The best models of each size with simpler laws, and without declared terms."""
    options = pool.options
    counts = chain(options.parents, repeat(1))
    for size, count in zip(range(1, options.effects + 1), counts, strict=False):
        exchange_for_simpler(pool, size, count)
        for model in pool.best(size, options.exchanged):
            pool.without_terms(model)


def _takes_all(pool: ModelPool, size: int) -> bool:
    """Whether the best model of a size leaves so little at each horizon that no further effect
    is worth its time, and has none that is uncommon, for which others may stand."""
    most, declared = pool.options.negligible, pool.models[frozenset(), ()].trials
    return any(
        all(
            one.rss - one.degrees_of_freedom <= most * (whole.rss - whole.degrees_of_freedom)
            for one, whole in zip(model.trials, declared, strict=True)
        )
        and not any(e.candidate.effect in pool.options.uncommon for e in model.trials[0].effects)
        for model in pool.best(size, 1)
    )


def _search_models(pool: ModelPool) -> list[Trial]:
    """The models that came through the refits on the shortest windows, the best first, also
    those from the declared values, and those along the path of the search: there a screen promises
    what a refit keeps, where whole runs are far from what was measured."""
    steps, best = pool.search.steps, pool.search.best
    first = [step for step in steps if not step.before.effects]
    most = pool.options.tried_before
    trials = [one.trial for step in first for one in step.refits[:most]]
    path = [step.before for step in steps if step.before.effects and step.before is not best]
    found = [*trials, *path, *([best] if best else [])]
    return [trial for trial in found if 0 < len(trial.effects) <= pool.options.effects]


def _fit_horizons(pool: ModelPool, trial: Trial) -> Finalist | None:
    """A model that was fitted to shorter windows, refitted at each horizon, the shorter one
    first, from the values that it has: a fit to long windows from afar ends in the next
    minimum. None where it does not run."""
    trials: list[Trial] = []
    pool.search.tell(f"refitting with {' and '.join(sorted(map(str, trial.effects)))}")
    for horizon in pool.horizons.each:
        target = pool.target(horizon.length, len(trial.effects))
        fitted = pool.search.problem.try_refit(trial, horizon.segments, horizon.length, target)
        if fitted is None:
            return None
        trial = pool.in_step(trial, fitted, horizon)
        pool.spent += trial.windows.criterion.steps
        trials.append(trial)
    return Finalist(tuple(trials))


def _extend_beside(pool: ModelPool, parent: Finalist) -> None:
    """A model with the most promising effects and pairs: what shows in short windows is looked
    for in those of the declared model."""
    options, pairs = pool.options, max(pool.options.beside - 2, 0)
    last = len(pool.first) - 1
    for number in range(last + 1):
        screen = pool.screen(parent, number) if number == last else pool.first[number]
        along = _along_data(pool, parent, number, options.beside, pairs)
        if along and number < last:  # that screen is of the declared model
            pool.extend(parent, number, along)
            continue
        proposals = pool.select_promising(number, screen, options.beside, pairs)
        pool.extend(parent, number, distinct([*along, *proposals]))


def _along_data(
    pool: ModelPool, parent: Finalist, number: int, singles: int, pairs: int
) -> list[Proposal]:
    """What a model far from the data lacks at a horizon, judged along the data."""
    screen = pool.search.screen_along_data(pool.on_sparse_windows(parent, number))
    if screen is None:
        return []
    return [screen.with_values(p) for p in pool.select_promising(number, screen, singles, pairs)]


def _extend_without(pool: ModelPool, smaller: Finalist) -> None:
    """A model without a declared term with what imitates that term: it shows only where the
    term is not there. What imitates it completely is that term itself."""
    options, number = pool.options, len(pool.horizons.each) - 1
    screen = pool.screen(smaller, number)
    new = no_longer_absorbed(screen, pool.first[number], options.imitated)
    others = pool.first[number].observable()
    proposals = [
        proposal
        for proposal in pool.select_promising(number, screen, 2 * options.beside, options.beside)
        if not new.isdisjoint(proposal.names) and others.keys() >= {*proposal.names}
    ]
    pool.extend(smaller, number, proposals)


def _is_near(pool: ModelPool, model: Finalist, size: int) -> bool:
    """Whether a model leaves so little more than the best one, and than the best one of its
    size, that it is worth extending."""
    scores = pool.scores()
    best_of_size = min(score for key, score in scores.items() if len(key[0]) == size)
    behind = 2 * (scores[model.key] - min(scores.values()))
    beside = 2 * (scores[model.key] - best_of_size)
    options = pool.options
    return behind < math.log(options.parent_behind) and beside < math.log(options.parent_beside)


def _improves(pool: ModelPool, size: int) -> bool:
    """Whether models of this size fit better than smaller ones by more than the tolerance."""
    scores = pool.scores()
    mine = [scores[key] for key, model in pool.models.items() if len(model.names) == size]
    less = [scores[key] for key, model in pool.models.items() if len(model.names) < size]
    return bool(mine) and min(less) - min(mine) > np.log1p(pool.options.near)
