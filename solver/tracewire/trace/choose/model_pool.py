"""The models of a choice: each fitted at every horizon, kept once, refitted where it is needed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from tracewire.residual import Segment, is_out_of_step
from tracewire.trace.choose.choice import log_scores
from tracewire.trace.choose.heldout import Finalist, errors_by_block, errors_in_sample
from tracewire.trace.choose.horizons import Horizon, Horizons
from tracewire.trace.choose.loosen import loosen_bounds
from tracewire.trace.choose.promising import select_promising
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.screening import Proposal, Screen
from tracewire.trace.search.search import Search, moved_values
from tracewire.trace.trials.growing import follow_further
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.scanned_lengths import rescan_lengths
from tracewire.trace.trials.trial import Trial, with_starts_of

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
    """The models that have converged."""
    _freed: dict[Key, Finalist] = field(default_factory=dict)
    """The models that were refitted below bounds that are a guess, as they were then."""
    _sparse: dict[int, tuple[Trial, Trial]] = field(default_factory=dict)
    """By horizon, the last model of which some windows were asked for, and these: a screen, one
    along the data, and the refits that they ask for begin there."""

    def fit_declared_at_horizons(self, declared_fit: Trial) -> Finalist:
        """The declared model at each horizon, from a fit of it."""
        problem, trials, trial = self.search.problem, [], declared_fit
        for horizon in self.horizons.each:
            before = trial
            trial = problem.fit((), list(horizon.segments), horizon.length, before.values)
            trial = self.in_step(before, trial, horizon)
            trials.append(trial)
        return self._keep(Finalist(tuple(trials)))

    def in_step(self, before: Trial, trial: Trial, horizon: Horizon) -> Trial:
        """A trial at a horizon, which follows the data from the shorter windows of the trial before
        it on where it is out of step."""
        if not is_out_of_step(trial.windows, self.options.out_of_step):
            return trial
        return follow_further(self.search.problem, before, trial, horizon.segments)

    def worthwhile_count(self, count: int) -> int:
        """How many refits are worth their time where a long record is worth `count` of them."""
        samples = sum(len(of) for of in self.horizons.each[-1].blocks)
        return max(count, self.options.cheap_samples // samples)

    def keep_better(self, finalist: Finalist) -> None:
        """Keep a model, or the fit of it that is known where that is better over the horizons."""
        known = self.models.get(finalist.key)
        if known is None or finalist.rss < (1 - self.options.coarse) * known.rss:
            self.models[finalist.key] = finalist
            self._final.discard(finalist.key)

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
        whole = parent.trials[number]
        known = self._sparse.get(number)
        if known is None or known[0] is not whole:
            part = self.search.problem.on_some_windows(whole, self.sparse_windows[number])
            known = self._sparse[number] = whole, part
        return known[1]

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
        declared, most = self.search.problem.declared, options.moved
        moved = {} if parent.names else moved_values(declared, now.values, most)
        for proposal in proposals:
            names = parent.names.union(proposal.names)
            known = (names, parent.dropped) in self.models or parent.names & {*proposal.names}
            if known or len(proposal.rows) > left or self.spent > options.most_steps:
                continue
            self.search.tell(f"refitting with {' and '.join(sorted(names))}")
            target = options.hopeful * min((trial.rss for trial in first_fits), default=np.inf)
            first = [row.placed_effect for row in proposal.rows]
            trial = self._refit(now, first, (), options.first_steps, target, proposal.values)
            if not parent.names and len(first) == 1:
                trial = self._from_other_sizes(now, first[0], trial)
            if moved and (trial is None or trial.rss > target):
                again = self._refit(now, first, (), options.first_steps, target, moved)
                trial = min((t for t in (trial, again) if t), key=lambda t: t.rss, default=None)
            if trial is not None:
                first_fits.append(trial)
        for trial in self._select_first_fits(now, first_fits, number):
            new = trial.effects[len(parent.names) :]
            fitted = self.fit(parent, new, first_fit=(number, trial))
            if fitted is not None:
                self._keep(fitted)

    def _from_other_sizes(
        self, now: Trial, effect: PlacedEffect, trial: Trial | None
    ) -> Trial | None:
        """The refit of an effect alone, or a better one from another size of its coefficient: a lag
        of a minute is not reached from one of two samples. The same refit where it takes nearly all
        of the squared error."""
        sizes = effect.candidate.at_sizes[1:]
        if not sizes or (trial and trial.rss < (1 - self.options.decisive) * now.rss):
            return trial
        found = [trial] if trial else []
        fixed, steps = dict(now.windows.criterion.parameters), self.options.first_steps
        for size in sizes:
            target = min((one.rss for one in found), default=np.inf)
            effects = (*now.effects, effect.with_value(effect.candidate.parameter, size))
            other = self.run_refit(now, effects, fixed, steps, target)
            found += [other] if other else []
        return min(found, key=lambda one: one.rss, default=None)

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
            target = self.target(now.length, len(parent.names) + len(effects))
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
            rescan_lengths(
                problem,
                trial if trial.converged else problem.refit(trial),
            )
            for trial in model.trials
        )
        model = replace(model, trials=trials)
        self.models[model.key] = model
        self._final.add(model.key)
        return model

    def free_single_effects(self) -> None:
        """Models of one effect below bounds that are a guess: at the bound the right one may be
        behind another law, and would not be looked at again."""
        for key, model in list(self.models.items()):
            if len(model.names) == 1 and key not in self._final and self._freed.get(key) != model:
                freed = loosen_bounds(self.search.problem, model, self.options)
                self.models[key] = self._freed[key] = freed or model

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

    def without(self, model: Finalist, name: str) -> Finalist | None:
        """The model without one of its effects: from its values, or the fit that is known, where
        that is better. A smaller model that stands in the next minimum makes an effect look
        needed that only led out of it."""
        key = model.names - {name}, model.dropped
        trials = []
        for trial in model.trials:
            effects = [e for e in trial.effects if str(e) != name]
            fixed = dict(trial.windows.criterion.parameters)
            fewer = self.run_refit(trial, effects, fixed, self.options.steps, np.inf)
            if fewer is None:
                return self.converge(self.models[key]) if key in self.models else None
            trials.append(fewer)
        self.keep_better(Finalist(tuple(trials), model.dropped))
        return self.converge(self.models[key])

    def without_terms(self, model: Finalist) -> list[Finalist]:
        """The model without each declared term that may be zero and is not."""
        own, found = self.search.problem.declared.flat.parameters, []
        for unknown in model.trials[0].windows.criterion.unknowns:
            if unknown.low != 0.0 or unknown.name not in own or unknown.name in model.vanished:
                continue
            if not any(trial.depends_on(unknown.name) for trial in model.trials):
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
        trial = self.run_refit(now, effects, fixed, steps, target, values, segments)
        if added and (trial is None or trial.rss > now.rss):  # the promised size led it astray
            part = self.options.restart
            small = [
                one.with_value(one.candidate.parameter, part * one.coefficient) for one in added
            ]
            again = self.run_refit(now, (*now.effects, *small), fixed, steps, target)
            trial = min((t for t in (trial, again) if t), key=lambda t: t.rss, default=None)
        return trial

    def run_refit(
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

    def target(self, length: int, size: int) -> float:
        """The sum of squares that a fit must promise to reach, or be given up: twice the least one
        of as many effects."""
        known = [
            trial.rss
            for model in self.models.values()
            for trial in model.trials
            if trial.length == length and len(trial.effects) == size
        ]
        return self.options.hopeful * min(known, default=np.inf)
