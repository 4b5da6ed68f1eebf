"""From finalists to a choice: their errors on held-out blocks, and the model that these ask for."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracewire.array_types import Array
from tracewire.trace.choose.choice import (
    Choice,
    Entrant,
    choice_of,
    choose,
    floor_of,
    log_scores,
    take_away_what_stands_out,
)
from tracewire.trace.choose.finalists import fill_pool
from tracewire.trace.choose.heldout import Finalist, errors_held_out, errors_in_sample
from tracewire.trace.choose.horizons import Horizons, horizons_of
from tracewire.trace.choose.model_pool import Key, ModelPool
from tracewire.trace.found import CandidateScore, SearchStep
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.screening import Screen
from tracewire.trace.search.search import Search
from tracewire.trace.trials.bounds import upper_shapes
from tracewire.trace.trials.trial import Trial


@dataclass(frozen=True, eq=False)
class Prediction:
    """What held-out blocks say: the models that were compared, the declared one first, their errors
    E/n in sigma^2 (models, horizons, families, blocks, channels), and the choice among them."""

    horizons: Horizons
    models: tuple[Finalist, ...]
    errors: Array
    choice: Choice
    screen: Screen
    entrants: tuple[Entrant, ...]
    options: TraceOptions

    @property
    def chosen(self) -> Finalist:
        """The model that was chosen."""
        return self.models[self.choice.chosen]

    def choose_again(self, refused: Collection[frozenset[str]]) -> Prediction:
        """The same with another choice, of models that have none of some sets of effects; the
        declared model is always one of them."""
        scores = log_scores(self.errors)
        for number, entrant in enumerate(self.entrants):
            if number and entrant.effects in refused:
                scores[number] = np.inf
        choice = choose(self.entrants, scores, self.horizons.groups, self.options)
        return replace(self, choice=choice)

    def choosing(self, number: int) -> Prediction:
        """The same with another model chosen, by number; none ties with it that has an effect of
        the one before which this one lacks."""
        scores, groups = log_scores(self.errors), self.horizons.groups
        choice = choice_of(number, self.entrants, scores, groups, self.options)
        left_out = self.chosen.names - self.models[number].names
        ties = tuple(tie for tie in choice.ties if not self.models[tie[0]].names & left_out)
        return replace(self, choice=replace(choice, ties=ties))

    def exchanging(self, number: int) -> Prediction:
        """The same with another model chosen, by number, and the one before as its tie."""
        scores, before = log_scores(self.errors), self.choice.chosen
        choice = choice_of(number, self.entrants, scores, self.horizons.groups, self.options)
        totals = scores.mean(axis=(1, 2, 3))
        tie = before, float(totals[before] - totals[number])
        others = tuple(one for one in choice.ties if one[0] != before)
        return replace(self, choice=replace(choice, ties=(tie, *others)))

    def preferring_signs(self) -> Prediction:
        """The same with an effect of a physical sign in the place of one without, where both leave
        the same in their fits: as a dry friction and the offset of a speed, where a body turns one
        way."""
        mine, chosen = self.entrants[self.choice.chosen], self.chosen
        for number, one in enumerate(self.entrants):
            if (
                one.exchanges(mine)
                and one.numbers <= mine.numbers
                and one.unsigned < mine.unsigned
                and one.uncommon <= mine.uncommon
                and all(
                    abs(a.rss - b.rss) <= self.options.same * b.rss
                    for a, b in zip(self.models[number].trials, chosen.trials, strict=True)
                )
            ):
                return self.exchanging(number)
        return self

    def preferring_inner_shapes(self) -> Prediction:
        """The same with a tie of no more numbers in the place of a model that has a shape on its
        upper bound, where one effect is exchanged and none of its shapes sits on one: a law at the
        end of what the record can show stands for another one, which may be this."""
        mine = self.entrants[self.choice.chosen]
        if not upper_shapes(self.chosen.trials[-1]):
            return self
        for number, _ in self.choice.ties:
            one = self.entrants[number]
            simpler = one.exchanges(mine) and one.numbers <= mine.numbers
            if simpler and not upper_shapes(self.models[number].trials[-1]):
                return self.exchanging(number)
        return self

    def total(self, number: int) -> float:
        """The mean log score of a model on held-out blocks, the less the better."""
        return float(log_scores(self.errors)[number].mean())

    def smaller(self) -> list[int]:
        """The numbers of the models that have some of the effects of the one that was chosen, the
        largest first."""
        mine = self.entrants[self.choice.chosen].effects
        found = [n for n, one in enumerate(self.entrants) if one.effects and one.effects < mine]
        return sorted(found, key=lambda n: -self.entrants[n].numbers)

    def shares(self) -> dict[str, float]:
        """The part of the declared model's squared error that each of several effects takes away
        beside the others, as far as the model without it was compared."""
        mine, found = self.entrants[self.choice.chosen], dict[str, float]()
        for one in (self.entrants[number] for number in self.smaller()):
            if len(one.effects) == len(mine.effects) - 1:
                (name,) = mine.effects - one.effects
                taken = one.leaves_more(mine)
                if np.isfinite(taken):  # that model runs
                    found[name] = min(found.get(name, taken), taken)
        return found

    def without_effects(self) -> Prediction:
        """The same with the declared model chosen."""
        return replace(self, choice=replace(self.choice, chosen=0, ties=()))

    def correlation(self, one: str, other: str) -> float:
        """The correlation of what two effects do to the declared model's residual; nan where the
        screen has no such effect."""
        rows = self.screen.observable()
        if one not in rows or other not in rows:
            return float("nan")
        return self.screen.columns.canonical_correlation(rows[one].columns, rows[other].columns)

    def as_step(self) -> SearchStep:
        """The comparison as a step of the search."""
        scores = log_scores(self.errors).mean(axis=(1, 2, 3))
        order = np.argsort(scores)[: self.options.shown]
        rows = []
        for n in order.tolist():
            model, change = self.models[n], float(np.expm1(scores[n] - scores[0]))
            without = f", without {' and '.join(model.dropped)}" if model.dropped else ""
            rows.append(
                CandidateScore(
                    f"{model.title}{without}",
                    float("nan"),
                    float(scores[0] - scores[n]) * self.horizons.count,
                    s2=model.trials[-1].reduced_chi2,
                    remark=f"{model.numbers} numbers, {change:+.1%} error on a typical held-out"
                    " block",
                )
            )
        longest = self.horizons.each[-1].length * self.horizons.interval
        declared = self.models[0].trials[-1].reduced_chi2
        words = f"held-out blocks choose {self.chosen.title} (z = {self.choice.z:.3g})"
        return SearchStep(longest, declared, float("nan"), tuple(rows), words)


def predict(search: Search, declared_fit: Trial) -> Prediction:
    """Compare the declared model and the best extended ones by what they predict."""
    options, data_split = search.options, search.data_split
    if not search.has_revisits:  # what adds to an effect along one way is not to be told from it
        options = replace(options, effects=1)
        search.words.append(
            "one effect was looked for, as no body comes back to where it was: what adds to an"
            " effect along one way is not to be told from it"
        )
    gate = [section for section in data_split.gate if section.measured.use == "gate"]
    declared_model = search.problem.declared
    horizons = horizons_of(
        declared_model, data_split.whole(), gate, search.free, search.problem.sigma, options
    )
    search.tell("fitting the declared model at both horizons")
    pool = ModelPool(search, horizons, options)
    declared = pool.fit_declared_at_horizons(declared_fit)
    fill_pool(pool, declared)
    errors: dict[Key, Array] = {}
    _compare(pool, declared, errors)
    pruned: set[Key] = set()
    while True:
        prediction = _choose(pool, errors)
        chosen = prediction.chosen
        if chosen.key in pruned:
            return prediction
        pruned.add(chosen.key)
        known = dict(pool.models)
        parts = _parts(pool, chosen)
        whole, others = (
            _with_all_terms(pool, [*parts, chosen]),
            _close_exchanges(pool, chosen, errors),
        )
        for other in (*parts, *whole, *_simpler(pool, chosen), *others):
            if other.key not in errors or other is not known[other.key]:
                errors[other.key] = _predict_errors(pool, other)


def _parts(pool: ModelPool, model: Finalist) -> list[Finalist]:
    """The models without one effect of a model, and without two, and so on: each refitted once."""
    found: dict[Key, Finalist] = {}
    for name in sorted(model.names):
        if (model.names - {name}, model.dropped) not in found:
            fewer = pool.without(model, name)
            if fewer:
                found[fewer.key] = fewer
                for part in _parts(pool, fewer) if len(fewer.names) > 1 else ():
                    found.setdefault(part.key, part)
    return list(found.values())


def _with_all_terms(pool: ModelPool, models: Sequence[Finalist]) -> list[Finalist]:
    """The fitted models with the effects of some that lack declared terms, but with all terms."""
    keys = {(model.names, ()) for model in models if model.dropped and model.names}
    return [pool.converge(model) for key, model in list(pool.models.items()) if key in keys]


def _simpler(pool: ModelPool, model: Finalist) -> list[Finalist]:
    """The fitted models with one effect of a model exchanged for one that it imitates, as Coulomb
    friction for a friction that waves along the way."""
    found = []
    for effect in model.trials[0].effects:
        others = model.names - {str(effect)}
        for name in effect.candidate.imitated - model.names:
            key = others | {name}, model.dropped
            if key in pool.models:
                found.append(pool.converge(pool.models[key]))
    return found


def _close_exchanges(pool: ModelPool, model: Finalist, known: Collection[Key]) -> list[Finalist]:
    """Further models with one effect of a model exchanged that are close to it in their fits, and
    so may be ties."""

    def squares(one: Finalist) -> Array:
        return np.asarray(errors_in_sample(one, pool.horizons).mean(axis=(1, 2, 3)))

    declared = np.maximum(squares(pool.models[frozenset(), ()]), 1e-300)

    def entrant(one: Finalist) -> Entrant:
        left = tuple((squares(one) / declared).tolist())
        return Entrant(one.names, one.numbers, left=left)

    mine, found = entrant(model), []
    for key, one in pool.models.items():
        other = entrant(one)
        new = key not in known and one.dropped == model.dropped
        if new and other.is_close(mine, pool.horizons.count, pool.options):
            found.append((other.leaves_more(mine), one))
    nearest = sorted(found, key=lambda pair: pair[0])[: pool.options.alike]
    return [pool.converge(one) for _, one in nearest]


def _compare(pool: ModelPool, declared: Finalist, errors: dict[Key, Array]) -> None:
    """The held-out errors of the models that may be chosen, the best fits first.

    A model whose fit is worse than what another one predicts, by more than the tolerance, predicts
    worse still and is passed over.
    """
    margin = 2 * np.log1p(pool.options.near)
    errors[declared.key] = _predict_errors(pool, declared)
    fits = {key: errors_in_sample(model, pool.horizons) for key, model in pool.models.items()}
    floor = floor_of(np.stack(list(fits.values())))
    scores = {key: float(log_scores(fit[None], floor).mean()) for key, fit in fits.items()}
    best = float(log_scores(errors[declared.key][None], floor).mean())
    compared: dict[int, int] = {}
    finalists = pool.worthwhile_count(pool.options.finalists)
    ranks = pool.ranks()
    for key in sorted(ranks, key=lambda key: ranks[key]):
        numbers = pool.models[key].numbers
        behind = scores[key] > best + margin
        if key in errors or behind or compared.get(numbers, 0) >= finalists:
            continue
        compared[numbers] = compared.get(numbers, 0) + 1
        errors[key] = _predict_errors(pool, pool.converge(pool.models[key]))
        _record_best(pool, errors)
        best = min(best, float(log_scores(errors[key][None], floor).mean()))


def _record_best(pool: ModelPool, errors: dict[Key, Array]) -> None:
    """Let the search stand at the best model so far: it is kept where the comparison is ended."""
    prediction = _choose(pool, errors)
    if prediction.choice.sure:
        declared, chosen = prediction.models[0], prediction.chosen
        pool.search.first, pool.search.best = declared.trials[-1], chosen.trials[-1]


def _predict_errors(pool: ModelPool, model: Finalist) -> Array:
    search = pool.search
    search.tell(f"predicting with {' and '.join(sorted(model.names)) or 'the declared model'}")
    return errors_held_out(search.problem, model, pool.horizons, pool.options)


def _choose(pool: ModelPool, errors: dict[Key, Array]) -> Prediction:
    options = pool.options
    keys = [key for key in errors if not pool.models[key].has_idle_effect]
    models = tuple(pool.models[key] for key in keys)
    stacked = np.stack([errors[key] for key in keys])
    squares = stacked[:, :, 0].mean(axis=(2, 3))  # scattered blocks: the others extrapolate
    left = squares / np.maximum(squares[0], 1e-300)
    entrants = tuple(
        Entrant(
            model.names,
            model.numbers,
            sum(e.candidate.effect in options.uncommon for e in model.trials[0].effects)
            + len(model.at_bounds),
            sum(not e.candidate.sign for e in model.trials[0].effects),
            frozenset().union(*(e.candidate.imitated for e in model.trials[0].effects)),
            tuple(parts.tolist()),
            bool(clears),
        )
        for model, parts, clears in zip(
            models, left, take_away_what_stands_out(stacked, options), strict=True
        )
    )
    choice = choose(entrants, log_scores(stacked), pool.horizons.groups, options)
    return Prediction(pool.horizons, models, stacked, choice, pool.first[-1], entrants, options)
