"""Effects of the best models exchanged for others that look alike."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from tracewire.errors import FitError
from tracewire.trace.choose.heldout import Finalist
from tracewire.trace.choose.model_pool import ModelPool
from tracewire.trace.search.rivals import count_numbers
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import Trial


def exchange_single_effects(pool: ModelPool) -> None:
    """The best models of one effect with each of those that do most like it to the residual of the
    declared model, however long the search was. A screen is linear: where an effect lets a declared
    parameter come far, as drag does that of a friction that falls with the speed, another law may
    promise more and leave more.
    """
    for model in pool.best(1, pool.options.exchanged):
        (name,) = model.names
        _replace_effect(pool, model, name, _look_alikes(pool, name))


def exchange_effects(pool: ModelPool, size: int) -> None:
    """The best models of a size with each effect exchanged for those that may stand there: those
    that look like it to the declared model's residual, and those that promise most in its place.
    First the one that takes least, however long the search was, as it was found where another one
    hid much; then those that take more, while there is time."""
    for model in pool.best(size, pool.options.exchanged):
        for number, name in enumerate(_least_first(pool, model)):
            if number == 0 or pool.spent <= pool.options.most_steps:
                others = [*_look_alikes(pool, name), *_alternatives(pool, model, name)]
                new = {str(one): one for one in others if str(one) not in model.names}
                _replace_effect(pool, model, name, list(new.values()))


def exchange_for_simpler(pool: ModelPool, size: int, count: int) -> None:
    """The best models of a size with each effect exchanged for those of fewer numbers that it
    imitates by the same coefficient, as a Stribeck curve does Coulomb friction, however long the
    search was: the fit of the simpler one may have ended in another minimum."""
    rows = {name: row for screen in pool.first for name, row in screen.observable().items()}
    for model in pool.best(size, count):
        for effect in model.trials[-1].effects:
            imitated = sorted(effect.candidate.imitated & rows.keys() - model.names)
            simpler = [
                one
                for name in imitated
                for one in _with_numbers_of(effect, rows[name].placed_effect)
                if count_numbers(one) < count_numbers(effect)
            ]
            _replace_effect(pool, model, str(effect), simpler)


def _least_first(pool: ModelPool, model: Finalist) -> list[str]:
    """The effects of a model by the squared error that is left without them, as far as models that
    lack one are known."""

    def left_without(name: str) -> float:
        smaller = pool.models.get((model.names - {name}, model.dropped))
        return smaller.rss if smaller is not None else math.inf

    return sorted(sorted(model.names), key=left_without)


def _look_alikes(pool: ModelPool, name: str) -> list[PlacedEffect]:
    """The effects that do most like one to the declared model's residual, at any horizon."""
    found: dict[str, tuple[float, PlacedEffect]] = {}
    for screen in pool.first:
        rows = screen.observable()
        mine = rows.pop(name, None)
        if mine is None:
            continue
        for other, row in rows.items():
            alike = screen.columns.canonical_correlation(mine.columns, row.columns)
            if other not in found or alike > found[other][0]:
                found[other] = alike, row.placed_effect
    nearest = sorted(found.values(), key=lambda pair: -pair[0])
    return [effect for _, effect in nearest[: pool.options.alike]]


def _alternatives(pool: ModelPool, model: Finalist, name: str) -> list[PlacedEffect]:
    """The effects that promise the most in the place of one, at the values that the model has
    with it: refitted without it these may be far away, and others look alike there."""
    number = len(pool.horizons.each) - 1
    now = pool.on_sparse_windows(model, number)
    kept = [effect for effect in now.effects if str(effect) != name]
    fixed = now.windows.criterion.parameters
    pool.search.tell(f"screening effects in the place of {name}")
    try:
        bare = pool.search.problem.fit(
            kept, now.windows.segments, now.length, now.values, fixed=fixed, steps=0
        )
        screen = pool.search.screen(bare)
    except FitError:
        return []
    count = pool.options.alike
    proposals = pool.select_promising(number, screen, count + 1, 0)
    found = [row.placed_effect for proposal in proposals for row in proposal.rows]
    return [one for one in found if str(one) not in model.names][:count]


def _replace_effect(
    pool: ModelPool, model: Finalist, name: str, others: Sequence[PlacedEffect]
) -> None:
    """Refit a model with others in the place of an effect, from its values: also one that is
    known and far behind, as its fit may have ended in another minimum."""
    (effect,) = (e for e in model.trials[-1].effects if str(e) == name)
    for other in others:
        names = model.names - {name} | {str(other)}
        known = pool.models.get((names, model.dropped))
        if known is not None and _is_near(pool, known, model):
            continue
        pool.search.tell(f"refitting with {' and '.join(sorted(names))}")
        again = [one for one in _with_numbers_of(effect, other) if one.values != other.values]
        for begun in (other, *again):
            replaced = _with_effect(pool, model, name, begun)
            if replaced is not None:
                pool.keep_better(replaced)
                if _is_near(pool, replaced, model):
                    break


def _is_near(pool: ModelPool, one: Finalist, model: Finalist) -> bool:
    """Whether a model leaves not much more than another one."""
    return one.rss <= pool.options.hopeful * model.rss


def _with_numbers_of(effect: PlacedEffect, other: PlacedEffect) -> list[PlacedEffect]:
    """An effect with the numbers of one that imitates it by the same coefficient, as far as it has
    these; none where that does not. At a level below its own a friction lets a body make one move
    more, and no slope of a fit shows the way back."""
    parameter = other.candidate.parameter
    imitated = str(other) in effect.candidate.imitated
    if not imitated or parameter != effect.candidate.parameter:
        return []
    shared = {name: x for name, x in effect.values.items() if name in other.values}
    return [replace(other, values={**other.values, **shared})]


def _with_effect(
    pool: ModelPool, model: Finalist, name: str, replacement: PlacedEffect
) -> Finalist | None:
    """A model with another effect in the place of one, refitted at each horizon, the longer one
    first; None where it does not run."""
    trials: list[Trial] = []
    for trial in reversed(model.trials):
        kept = [effect for effect in trial.effects if str(effect) != name]
        fixed = dict(trial.windows.criterion.parameters)
        target = pool.target(trial.length, len(kept) + 1)
        fitted = pool.run_refit(trial, (*kept, replacement), fixed, pool.options.steps, target)
        if fitted is None:
            return None
        trials.append(fitted)
        replacement = fitted.effects[-1]
    return Finalist(tuple(reversed(trials)), model.dropped)
