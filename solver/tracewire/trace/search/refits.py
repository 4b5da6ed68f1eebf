"""Refits: the proposals of a screen in the loop, a few steps on few windows each, then the best."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Unpack

import numpy as np

from tracewire.errors import TracewireError
from tracewire.residual import Segment
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.screening import Proposal
from tracewire.trace.search.workers import RefitTask, Workers
from tracewire.trace.thresholds import SearchOptions
from tracewire.trace.trials.fit_options import FitOptions
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import TraceProblem, Trial, with_starts_of


@dataclass(frozen=True, eq=False)
class RefitResult:
    """Effects that were refitted, at first in a few steps on few windows: how much BIC rose, their
    weight among those that were ranked with them, and what became of them."""

    trial: Trial
    proposal: Proposal
    delta_bic: float = 0.0
    weight: float = 0.0
    remark: str = ""

    @property
    def by_windows(self) -> float:
        """The mean over windows of the logarithm of what they leave, ln(E/n + 1): a few windows
        that were led astray, as by a friction that sticks, do not rule it."""
        return float(np.mean(np.log(self.trial.window_mean_squares + 1.0)))


@dataclass(frozen=True)
class Refits:
    """What refits share, and who carries them out; `words` gets what could not be tried."""

    problem: TraceProblem
    tell: Callable[[str], None]
    words: list[str]
    workers: Workers

    @property
    def options(self) -> SearchOptions:
        """The thresholds of refits."""
        return self.problem.options.search

    def refit_best(
        self, now: Trial, singles: Sequence[Proposal], pairs: Sequence[Proposal]
    ) -> list[RefitResult]:
        """The best of the proposals, refitted on all windows and ranked.

        Where a single effect comes near the noise, pairs are for later: if it reaches it, only
        those of as few numbers can say more. Elsewhere they all begin together, and what a pair
        leaves far behind is not refitted on all windows.
        """
        first_fits = self.begin_refits(now, singles)
        near = any(one.trial.reduced_chi2 < self.options.near for one in first_fits)
        results = self.refit_on_all(now, first_fits) if near else []
        at_noise = self.problem.options.at_noise
        if any(one.trial.reduced_chi2 < at_noise for one in results):
            pairs = [pair for pair in pairs if pair.count <= results[0].proposal.count]
            if not pairs:
                return results
        first_fits = [*([] if near else first_fits), *self.begin_refits(now, pairs)]
        target = min((one.trial.rss for one in results), default=np.inf)
        return self.rank(now, [*results, *self.refit_on_all(now, first_fits, target)])

    def begin_refits(self, now: Trial, proposals: Sequence[Proposal]) -> list[RefitResult]:
        """The proposals after a few steps on few windows."""
        segments = now.windows.segments
        rows = few_of(segments, self.options.few)
        few, least = [segments[n] for n in rows], float(now.windows.squares[rows].sum())
        first = [
            self.prepare(
                now,
                (*now.effects, *(row.placed_effect for row in proposal.rows)),
                few,
                steps=self.options.first_steps,
                values=proposal.values,
                words=f"refitting with {' and '.join(proposal.names)}",
            )
            for proposal in proposals
        ]
        trials = self.run(now, first)
        astray = [n for n, trial in enumerate(trials) if trial is not None and trial.rss > least]
        again = self.run(now, [self._from_small(now, proposals[n], few) for n in astray])
        for n, other in zip(astray, again, strict=True):  # the promised size led it astray
            trials[n] = min((t for t in (trials[n], other) if t), key=lambda trial: trial.rss)
        return [RefitResult(t, p) for t, p in zip(trials, proposals, strict=True) if t is not None]

    def _from_small(self, now: Trial, proposal: Proposal, few: Sequence[Segment]) -> RefitTask:
        """A proposal refitted from a small part of what it promises."""
        small = [
            row.placed_effect.with_value(
                row.candidate.parameter, self.options.small * row.placed_effect.coefficient
            )
            for row in proposal.rows
        ]
        effects = (*now.effects, *small)
        return self.prepare(now, effects, few, steps=self.options.first_steps)

    def refit_on_all(
        self, now: Trial, first_fits: Sequence[RefitResult], target: float = np.inf
    ) -> list[RefitResult]:
        """The best of the first fits, refitted on all windows and ranked.

        Those that are too slow to come near the best, or below `target`, are given up on the way.
        """
        most = self.options.kept if now.reduced_chi2 < self.options.far else self.options.kept_far
        kept: list[RefitResult] = []
        by_sum = sorted(first_fits, key=lambda one: one.trial.rss)
        by_windows = sorted(first_fits, key=lambda one: one.by_windows)
        for one, other in zip(by_sum, by_windows, strict=True):
            near = one.trial.rss < self.options.within * by_sum[0].trial.rss
            near_too = other.by_windows - by_windows[0].by_windows < np.log(self.options.within)
            for chosen, is_near in ((one, near), (other, near_too)):
                size = len(chosen.proposal.rows)
                alike = sum(len(known.proposal.rows) == size for known in kept)
                if is_near and chosen not in kept and alike < most:
                    kept.append(chosen)
        segments, results = now.windows.segments, []
        rows = few_of(segments, self.options.few)
        for number, one in enumerate(kept, start=1):
            names = new_effects(one.trial, now)
            self.tell(f"refitting {names} on all windows ({number} of {len(kept)})")
            there = with_starts_of(segments, one.trial, rows)
            refit = self.prepare(one.trial, one.trial.effects, there, target=target)
            (trial,) = self.run(one.trial, [refit])
            if trial is not None:
                results.append(RefitResult(trial, one.proposal))
                target = min(target, target_of(trial, self.problem.options))
        return self.rank(now, results)

    def rank(self, now: Trial, results: Sequence[RefitResult]) -> list[RefitResult]:
        """Trials on the same windows by BIC, the best first, with their weights."""
        if not results:
            return []
        effective_fraction = min(
            (one.trial for one in results), key=lambda trial: trial.rss
        ).effective_fraction
        delta_bics = np.array(
            [one.trial.bic(effective_fraction) - now.bic(effective_fraction) for one in results]
        )
        weights = np.exp(-0.5 * (delta_bics - delta_bics.min()))
        weights = weights / weights.sum()
        rows = [
            replace(one, delta_bic=float(delta_bic), weight=float(weight))
            for one, delta_bic, weight in zip(results, delta_bics, weights, strict=True)
        ]
        return sorted(rows, key=lambda one: one.delta_bic)

    def prepare(
        self,
        now: Trial,
        effects: Sequence[PlacedEffect],
        segments: Sequence[Segment],
        values: Mapping[str, float] | None = None,
        words: str = "",
        **options: Unpack[FitOptions],
    ) -> RefitTask:
        """The model with other effects, to be refitted from where it stood, or from other values of
        what is declared; `words` are told with its number among others."""
        steps = options.get("steps", self.options.steps)
        usual = FitOptions(
            fixed=now.windows.criterion.parameters,
            steps=steps,
            budget=self.options.slower * steps * len(segments) * now.steps_per_run,
            inlier_limit=now.inlier_limit,
        )
        begin = {**now.values, **(values or {})}
        return RefitTask(tuple(effects), tuple(segments), now.length, begin, usual | options, words)

    def run(self, now: Trial, refits: Sequence[RefitTask]) -> list[Trial | None]:
        """The trial of each refit, side by side where there are workers; None where a model does
        not run."""
        there = {str(effect) for effect in now.effects}
        trials: list[Trial | None] = []
        ended = self.workers.run(self.problem, refits, self.tell, self.words.append)
        for refit, result in zip(refits, ended, strict=True):
            if isinstance(result, TracewireError):
                new = [str(e) for e in refit.effects if str(e) not in there]
                beginning = f"{' and '.join(new)} {'was' if len(new) == 1 else 'were'} not tried: "
                if new and not any(words.startswith(beginning) for words in self.words):
                    self.words.append(f"{beginning}{result.problems[0].what}")
                trials.append(None)
            else:
                trials.append(result)
        return trials


def few_of(segments: Sequence[Segment], count: int) -> list[int]:
    """About so many of the windows by number, the first ones of each series, as memories go on
    between them."""
    names = [segment.measured.name for segment in segments]
    most = -(-count // len(set(names)))
    return [n for n, name in enumerate(names) if names[:n].count(name) < most]


def target_of(trial: Trial, options: TraceOptions) -> float:
    """The sum of squares that a rival must promise to reach, or be given up."""
    search, at_noise = options.search, trial.reduced_chi2 < options.at_noise
    return (search.within_noise if at_noise else search.within) * trial.rss


def new_effects(trial: Trial, now: Trial) -> str:
    """The effects that a trial has more than another one."""
    return " and ".join(str(e) for e in trial.effects[len(now.effects) :])
