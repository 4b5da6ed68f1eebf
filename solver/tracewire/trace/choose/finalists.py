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
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tracewire.errors import FitError
from tracewire.residual import Segment
from tracewire.trace.choose.choice import log_scores
from tracewire.trace.choose.heldout import Finalist, errors_by_block, errors_in_sample
from tracewire.trace.choose.horizons import Horizons
from tracewire.trace.choose.loosen import loosen_bounds
from tracewire.trace.choose.promising import no_longer_absorbed, select_promising
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.screening import Proposal, Screen
from tracewire.trace.screen.shortlist import distinct
from tracewire.trace.search.search import Search
from tracewire.trace.trials.trial import PlacedEffect, Trial, with_starts_of

Array = NDArray[np.float64]
Key = tuple[frozenset[str], tuple[str, ...]]


@dataclass
class ModelPool:
    """The models that were fitted so far, by their effects and the terms that were left out."""

    search: Search
    horizons: Horizons
    options: TraceOptions
    models: dict[Key, Finalist] = field(default_factory=dict)
    spent: int = 0
    """The solver's steps that all refits took."""
    first: list[Screen] = field(default_factory=list)
    """The screens beside the declared model, one for each horizon."""
    _final: set[Key] = field(default_factory=set)

    def fit_declared(self, declared_fit: Trial) -> Finalist:
        """The declared model at each horizon, from a fit of it."""
        problem, trials, trial = self.search.problem, [], declared_fit
        for horizon in self.horizons.each:
            trial = problem.fit((), list(horizon.segments), horizon.length, trial.values)
            trials.append(trial)
        return self._keep(Finalist(tuple(trials)))

    def fill(self, declared: Finalist) -> None:
        """Models of one, two and three effects, and those without declared terms."""
        options = self.options
        numbers = range(len(self.horizons.each))
        self.first = [self.screen(declared, number) for number in numbers]
        for number in numbers:
            singles, pairs = self.worthwhile_count(options.singles) // len(numbers), options.pairs
            proposals = self.select_promising(number, self.first[number], singles, pairs)
            along = self._along_data(declared, number, singles, pairs)
            self.extend(declared, number, distinct([*along, *proposals]))
        for trial in self._search_models():
            refitted = self._fit_horizons(trial)
            if refitted is not None:
                self._keep_better(refitted)
        for smaller in self.without_terms(declared) if not self._takes_all(1) else ():
            with suppress(FitError):
                self._extend_without(smaller)
        for size, parents in zip(range(1, options.effects), options.parents, strict=False):
            if not self._improves(size) or self._takes_all(size):
                break
            for parent in self.best(size, parents):
                if self._is_near(parent, size):
                    with suppress(FitError):  # it does not run with its places open
                        self._extend_beside(parent)
            if self._improves(size + 1):
                self._exchange(size + 1)
        for size in range(1, options.effects + 1):
            for model in self.best(size, options.exchanged):
                self.without_terms(model)

    def _takes_all(self, size: int) -> bool:
        """Whether the best model of a size leaves so little at each horizon that no further effect
        is worth its time, and has none that is uncommon, for which others may stand."""
        most, declared = self.options.negligible, self.models[frozenset(), ()].trials
        return any(
            all(
                one.rss - one.degrees_of_freedom <= most * (whole.rss - whole.degrees_of_freedom)
                for one, whole in zip(model.trials, declared, strict=True)
            )
            and not any(
                e.candidate.effect in self.options.uncommon for e in model.trials[0].effects
            )
            for model in self.best(size, 1)
        )

    def worthwhile_count(self, count: int) -> int:
        """How many refits are worth their time where a long record is worth `count` of them."""
        samples = sum(len(of) for of in self.horizons.each[-1].blocks)
        return max(count, self.options.cheap_samples // samples)

    def _search_models(self) -> list[Trial]:
        """The models that came through the refits on the shortest windows, the best first: there
        a screen promises what a refit keeps, where whole runs are far from what was measured."""
        first = [step for step in self.search.steps if not step.before.effects]
        trials = [one.trial for step in first[:1] for one in step.refits]
        best = self.search.best
        found = [*trials[: self.options.tried_before], *([best] if best else [])]
        return [trial for trial in found if 0 < len(trial.effects) <= self.options.effects]

    def _fit_horizons(self, trial: Trial) -> Finalist | None:
        """A model that was fitted to shorter windows, refitted at each horizon, the shorter one
        first, from the values that it has: a fit to long windows from afar ends in the next
        minimum. None where it does not run."""
        trials: list[Trial] = []
        for horizon in self.horizons.each:
            try:
                target = self._target(horizon.length, len(trial.effects))
                trial = self.search.problem.refit(trial, horizon.segments, horizon.length, target)
            except FitError:
                return None
            self.spent += trial.windows.criterion.steps
            trials.append(trial)
        return Finalist(tuple(trials))

    def _keep_better(self, finalist: Finalist) -> None:
        """Keep a model, or the fit of it that is known where that is better over the horizons."""
        known = self.models.get(finalist.key)
        if known is None or finalist.rss < (1 - self.options.coarse) * known.rss:
            self.models[finalist.key] = finalist
            self._final.discard(finalist.key)

    def _extend_beside(self, parent: Finalist) -> None:
        """A model with the most promising effects and pairs: what shows in short windows is looked
        for in those of the declared model."""
        options, pairs = self.options, max(self.options.beside - 2, 0)
        for number, screen in enumerate([*self.first[:-1], self.screen(parent, -1)]):
            along = self._along_data(parent, number, options.beside, pairs)
            if along and number < len(self.first) - 1:  # that screen is of the declared model
                self.extend(parent, number, along)
                continue
            proposals = self.select_promising(number, screen, options.beside, pairs)
            self.extend(parent, number, distinct([*along, *proposals]))

    def _along_data(
        self, parent: Finalist, number: int, singles: int, pairs: int
    ) -> list[Proposal]:
        """What a model far from the data lacks at a horizon, judged along the data."""
        screen = self.search.screen_along_data(self.on_sparse_windows(parent, number))
        if screen is None:
            return []
        return [
            screen.with_values(p) for p in self.select_promising(number, screen, singles, pairs)
        ]

    def _extend_without(self, smaller: Finalist) -> None:
        """A model without a declared term with what imitates that term: it shows only where the
        term is not there. What imitates it completely is that term itself."""
        options, number = self.options, len(self.horizons.each) - 1
        screen = self.screen(smaller, number)
        new = no_longer_absorbed(screen, self.first[number], options.imitated)
        others = self.first[number].observable()
        proposals = [
            proposal
            for proposal in self.select_promising(
                number, screen, 2 * options.beside, options.beside
            )
            if not new.isdisjoint(proposal.names) and others.keys() >= {*proposal.names}
        ]
        self.extend(smaller, number, proposals)

    def select_promising(
        self, number: int, screen: Screen, singles: int, pairs: int
    ) -> list[Proposal]:
        """What a screen at a horizon asks to refit."""
        horizon = self.horizons.each[number]
        count = len(horizon.segments[0].signals)
        blocks = np.concatenate([horizon.blocks[n] for n in self.sparse_windows[number]])
        return select_promising(screen, np.repeat(blocks, count), singles, pairs)

    @cached_property
    def sparse_windows(self) -> list[list[int]]:
        """The windows of each horizon on which effects are screened and refits begin."""
        options = self.options
        return [
            horizon.sparse_windows(options.most_samples, options.least_blocks)
            for horizon in self.horizons.each
        ]

    def on_sparse_windows(self, parent: Finalist, number: int) -> Trial:
        """A model on the windows of a horizon on which effects are screened."""
        return self.search.problem.on_some_windows(
            parent.trials[number], self.sparse_windows[number]
        )

    def screen(self, parent: Finalist, number: int) -> Screen:
        """The screen beside a model at a horizon."""
        search, trial = self.search, self.on_sparse_windows(parent, number)
        beside = " and ".join(sorted(parent.names)) or "the declared model"
        search.tell(f"screening effects beside {beside}")
        return search.screen(trial).best_rows_only()

    def extend(self, parent: Finalist, number: int, proposals: Iterable[Proposal]) -> None:
        """Refit a model with each of some proposals in few steps, at the horizon whose screen made
        them, and the best of them at each horizon."""
        options = self.options
        left = options.effects - len(parent.names)
        now = self.on_sparse_windows(parent, number)
        first_fits: list[Trial] = []
        for proposal in proposals:
            names = parent.names.union(proposal.names)
            known = (names, parent.dropped) in self.models or parent.names & {*proposal.names}
            if known or len(proposal.rows) > left or self.spent > options.most_steps:
                continue
            self.search.tell(f"refitting with {' and '.join(sorted(names))}")
            target = options.hopeful * min((trial.rss for trial in first_fits), default=np.inf)
            first = [row.placed_effect for row in proposal.rows]
            trial = self._refit(now, first, (), options.first_steps, target, proposal.values)
            if trial is not None:
                first_fits.append(trial)
        for trial in self._select_first_fits(now, first_fits, number):
            new = trial.effects[len(parent.names) :]
            fitted = self.fit(parent, new, first_fit=(number, trial))
            if fitted is not None:
                self._keep(fitted)

    def _select_first_fits(
        self, now: Trial, first_fits: Sequence[Trial], number: int
    ) -> list[Trial]:
        """The best first fits at a horizon beside a model, by the scores of blocks, and what
        leaves too little more of that model's squared error to be told from the best."""
        if not first_fits:
            return []
        blocks = [self.horizons.each[number].blocks[n] for n in self.sparse_windows[number]]
        errors = np.stack([
            errors_by_block(
                self.horizons.fitted, list(zip(blocks, trial.windows.residuals, strict=True))
            )
            for trial in first_fits
        ])  # fmt: skip
        seen = np.unique(np.concatenate(blocks))
        errors = errors[:, None, None, seen[seen >= 0]]
        scores = log_scores(errors).mean(axis=(1, 2, 3))
        scores = scores + self._price * np.array(
            [len(trial.windows.values) for trial in first_fits]
        )
        most = self.worthwhile_count(self.options.begun) // len(self.horizons.each)
        best = np.argsort(scores, kind="stable")[:most]
        near = scores[best[0]] + 0.5 * np.log(self.options.hopeful)
        close = min(trial.rss for trial in first_fits) + self.options.material * now.rss
        return [
            first_fits[n] for n in best.tolist() if scores[n] <= near or first_fits[n].rss <= close
        ]

    def fit(
        self,
        parent: Finalist,
        added: Sequence[PlacedEffect],
        dropped: Sequence[str] = (),
        first_fit: tuple[int, Trial] | None = None,
    ) -> Finalist | None:
        """A model with more effects, or without declared terms, refitted at each horizon; None
        where it does not run.

        first_fit: a horizon, and a fit on some of its windows, from which the refits begin. Else
        they begin where the parent stands, and with the longer horizon, which determines more.
        """
        trials: dict[int, Trial] = {}
        effects, values = list(added), first_fit[1].values if first_fit else None
        numbers = range(len(parent.trials))[::-1]
        for number in sorted(numbers, key=lambda n: first_fit is not None and n != first_fit[0]):
            now = parent.trials[number]
            segments = now.windows.segments
            if first_fit and number == first_fit[0]:
                segments = with_starts_of(segments, first_fit[1], self.sparse_windows[number])
            target = self._target(now.length, len(parent.names) + len(effects))
            steps = self.options.steps
            trial = self._refit(now, effects, dropped, steps, target, values, segments)
            if trial is None:
                return None
            trials[number] = trial
            effects = list(trial.effects[len(parent.names) :])
            values = trial.values if first_fit else None
        return Finalist(tuple(trials[n] for n in sorted(trials)), (*parent.dropped, *dropped))

    def converge(self, model: Finalist) -> Finalist:
        """The model refitted until it converges, also below bounds that are a guess."""
        if model.key in self._final:
            return model
        problem = self.search.problem
        model = loosen_bounds(problem, model, self.options) or model
        trials = tuple(
            trial if trial.converged else problem.refit(trial, trial.windows.segments, trial.length)
            for trial in model.trials
        )
        model = replace(model, trials=trials)
        self.models[model.key] = model
        self._final.add(model.key)
        return model

    def scores(self) -> dict[Key, float]:
        """How well each model fits, the mean of the in-sample log scores."""
        errors = np.stack([errors_in_sample(m, self.horizons) for m in self.models.values()])
        means = log_scores(errors).mean(axis=(1, 2, 3))
        return dict(zip(self.models, means.tolist(), strict=True))

    def ranks(self) -> dict[Key, float]:
        """The scores with the price of each fitted number, BIC over twice the number of blocks."""
        price = self._price
        return {key: s + price * self.models[key].numbers for key, s in self.scores().items()}

    @property
    def _price(self) -> float:
        """What a fitted number costs in scores."""
        blocks = self.horizons.fitted
        return float(np.log(blocks)) / (2 * blocks)

    def best(self, size: int, count: int) -> list[Finalist]:
        """The best fits with so many effects, each set of effects once, refitted until they
        converge."""
        ranks = self.ranks()
        of_names: dict[frozenset[str], Key] = {}
        for key in sorted(ranks, key=lambda key: -ranks[key]):
            of_names[self.models[key].names] = key
        mine = [key for names, key in of_names.items() if len(names) == size]
        return [
            self.converge(self.models[key])
            for key in sorted(mine, key=lambda key: ranks[key])[:count]
        ]

    def _is_near(self, model: Finalist, size: int) -> bool:
        """Whether a model leaves so little more than the best one, and than the best one of its
        size, that it is worth extending."""
        scores = self.scores()
        best_of_size = min(score for key, score in scores.items() if len(key[0]) == size)
        behind = 2 * (scores[model.key] - min(scores.values()))
        beside = 2 * (scores[model.key] - best_of_size)
        options = self.options
        return behind < math.log(options.parent_behind) and beside < math.log(options.parent_beside)

    def without(self, model: Finalist, name: str) -> Finalist | None:
        """The model without one of its effects: from its values, or the fit that is known, where
        that is better. A smaller model that stands in the next minimum makes an effect look
        needed that only led out of it."""
        key = model.names - {name}, model.dropped
        trials = []
        for trial in model.trials:
            effects = [e for e in trial.effects if str(e) != name]
            fixed = dict(trial.windows.criterion.parameters)
            fewer = self._run_refit(trial, effects, fixed, self.options.steps, np.inf)
            if fewer is None:
                return self.converge(self.models[key]) if key in self.models else None
            trials.append(fewer)
        self._keep_better(Finalist(tuple(trials), model.dropped))
        return self.converge(self.models[key])

    def without_terms(self, model: Finalist) -> list[Finalist]:
        """The model without each declared term that may be zero and is not."""
        own, found = self.search.problem.declared.flat.parameters, []
        for unknown in model.trials[0].windows.criterion.unknowns:
            if unknown.low != 0.0 or unknown.name not in own or unknown.name in model.vanished:
                continue
            self.search.tell(f"refitting without {unknown.name}")
            smaller = self.fit(model, (), [unknown.name])
            if smaller is not None:
                found.append(self._keep(smaller))
        return found

    def _keep(self, finalist: Finalist) -> Finalist:
        return self.models.setdefault(finalist.key, finalist)

    def _refit(
        self,
        now: Trial,
        added: Sequence[PlacedEffect],
        dropped: Sequence[str],
        steps: int,
        target: float,
        values: Mapping[str, float] | None = None,
        segments: Sequence[Segment] | None = None,
    ) -> Trial | None:
        fixed = {**now.windows.criterion.parameters, **dict.fromkeys(dropped, 0.0)}
        effects = (*now.effects, *added)
        trial = self._run_refit(now, effects, fixed, steps, target, values, segments)
        if added and (trial is None or trial.rss > now.rss):  # the promised size led it astray
            part = self.options.restart
            small = [
                one.with_value(one.candidate.parameter, part * one.coefficient) for one in added
            ]
            again = self._run_refit(now, (*now.effects, *small), fixed, steps, target)
            trial = min((t for t in (trial, again) if t), key=lambda t: t.rss, default=None)
        return trial

    def _run_refit(
        self,
        now: Trial,
        effects: Sequence[PlacedEffect],
        fixed: dict[str, float],
        steps: int,
        target: float,
        values: Mapping[str, float] | None = None,
        segments: Sequence[Segment] | None = None,
    ) -> Trial | None:
        windows = now.windows
        refit = self.search.refits.prepare(
            now,
            effects,
            windows.segments if segments is None else segments,
            fixed=fixed,
            steps=steps,
            target=target,
            ftol=self.options.coarse,
            initial_state_steps=1,
            values=values,
        )
        (fitted,) = self.search.refits.run(now, [refit])
        self.spent += (fitted or now).windows.criterion.steps
        return fitted

    def _target(self, length: int, size: int) -> float:
        """The sum of squares that a fit must promise to reach, or be given up: twice the least one
        of as many effects."""
        known = [
            trial.rss
            for model in self.models.values()
            for trial in model.trials
            if trial.length == length and len(trial.effects) == size
        ]
        return self.options.hopeful * min(known, default=np.inf)

    def _exchange(self, size: int) -> None:
        """The best models of a size with each effect exchanged for those that may stand there."""
        for model in self.best(size, self.options.exchanged):
            for name in sorted(model.names):
                self._replace_effect(model, name, self._alternatives(model, name))

    def _alternatives(self, model: Finalist, name: str) -> list[PlacedEffect]:
        """The effects that promise the most in the place of one, at the values that the model has
        with it: refitted without it these may be far away, and others look alike there."""
        number = len(self.horizons.each) - 1
        now = self.on_sparse_windows(model, number)
        kept = [effect for effect in now.effects if str(effect) != name]
        fixed = now.windows.criterion.parameters
        self.search.tell(f"screening effects in the place of {name}")
        try:
            bare = self.search.problem.fit(
                kept, now.windows.segments, now.length, now.values, fixed=fixed, steps=0
            )
            screen = self.search.screen(bare)
        except FitError:
            return []
        count = self.options.alike
        proposals = self.select_promising(number, screen, count + 1, 0)
        found = [row.placed_effect for proposal in proposals for row in proposal.rows]
        return [one for one in found if str(one) not in model.names][:count]

    def _replace_effect(self, model: Finalist, name: str, others: Sequence[PlacedEffect]) -> None:
        """Refit a model with others in the place of an effect, from its values: also one that is
        known and far behind, as its fit may have ended in another minimum."""
        for other in others:
            names = model.names - {name} | {str(other)}
            known = self.models.get((names, model.dropped))
            near = known is not None and known.rss <= self.options.hopeful * model.rss
            if near or self.spent > self.options.most_steps:
                continue
            self.search.tell(f"refitting with {' and '.join(sorted(names))}")
            trials: list[Trial] = []
            replacement = other
            for trial in reversed(model.trials):
                kept = [effect for effect in trial.effects if str(effect) != name]
                fixed = dict(trial.windows.criterion.parameters)
                target = self._target(trial.length, len(kept) + 1)
                steps = self.options.steps
                fitted = self._run_refit(trial, (*kept, replacement), fixed, steps, target)
                if fitted is None:
                    break
                trials.append(fitted)
                replacement = fitted.effects[-1]
            else:
                self._keep_better(Finalist(tuple(reversed(trials)), model.dropped))

    def _improves(self, size: int) -> bool:
        """Whether models of this size fit better than smaller ones by more than the tolerance."""
        scores = self.scores()
        mine = [scores[key] for key, model in self.models.items() if len(model.names) == size]
        less = [scores[key] for key, model in self.models.items() if len(model.names) < size]
        return bool(mine) and min(less) - min(mine) > np.log1p(self.options.near)
