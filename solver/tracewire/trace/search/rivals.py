"""The effects that may stand in the place of one that was found, and their refits there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tracewire.trace.candidates.candidate import is_default
from tracewire.trace.screen.screening import Screen
from tracewire.trace.search.refits import few_of, target_of
from tracewire.trace.search.search import Search
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import Trial


def known_rivals(search: Search, effect: PlacedEffect) -> list[tuple[PlacedEffect, float]]:
    """Effects that looked like one when it was screened, or look like it beside it: those first
    that are as common and have no more numbers, and of these the most likely."""
    options = search.options.search
    for step in search.steps:
        rows = step.screen.observable()  # a sign that is wrong here may be right beside the others
        rows |= {str(row.candidate): row for row in step.screen.best()}
        mine = rows.get(str(effect))
        if mine is None or step.after is None:
            continue
        delta_bics = {
            str(one.trial.effects[-1]): one.delta_bic
            for one in step.refits
            if len(one.proposal.rows) == 1
        }
        together = len(step.after.effects) > len(step.before.effects) + 1
        least = options.related_together if together else options.related
        beside = _likeness_beside(search, effect, step.screen)
        found = []
        for name, row in rows.items():
            if name == str(effect):
                continue
            correlation = step.screen.columns.canonical_correlation(mine.columns, row.columns)
            like = correlation > least or beside.get(name, 0.0) > options.related_beside
            correlation = max(correlation, beside.get(name, 0.0))
            if like or name in delta_bics:
                found.append((row.placed_effect, correlation, delta_bics.get(name, np.inf)))
        found.sort(key=lambda item: (item[2], *_more_than(effect, item[0], search), -item[1]))
        return [(added, correlation) for added, correlation, _ in found]
    return []


def _more_than(effect: PlacedEffect, rival: PlacedEffect, search: Search) -> tuple[bool, bool]:
    """Whether a rival is less common than an effect, and whether it has more numbers."""
    rare = [one.candidate.effect in search.options.uncommon for one in (rival, effect)]
    return rare[0] and not rare[1], count_numbers(rival) > count_numbers(effect)


def _likeness_beside(search: Search, effect: PlacedEffect, first: Screen) -> dict[str, float]:
    """The correlation of effects with one that was found, beside it, by name: by the part of each
    that was its own in the screen that found it, and is absorbed where that effect is there.

    Along the runs of a model far from the data two laws may differ that do the same in the motion
    that was measured.
    """
    screens = (step.screen for step in search.steps if str(effect) in map(str, step.before.effects))
    now = next(screens, None)
    if now is None:
        return {}
    before = first.observable()
    found: dict[str, float] = {}
    for row in now.rows:
        name = str(row.candidate)
        if name in before:
            own = 1 - before[name].absorbed_fraction
            likeness = max(1 - (1 - row.absorbed_fraction) / own, 0.0) ** 0.5
            found[name] = max(likeness, found.get(name, 0.0))
    return found


def count_numbers(effect: PlacedEffect) -> int:
    """The numbers of an effect that are fitted: the coefficient, and shapes that are not off."""
    shapes = effect.candidate.shapes
    return 1 + sum(not is_default(effect.candidate, s, effect.values.get(s, 0.0)) for s in shapes)


def refit_rivals(
    search: Search, best: Trial, each: Sequence[Sequence[PlacedEffect]]
) -> list[Trial]:
    """The best model with other effects, refitted on its windows, as far as these run.

    Those are left out that do much worse than it on few short windows. The others begin at the
    values that they have there, from which those of the best model may be far; where that leads
    astray, they begin as they were given, at these.
    """
    few = _fit_few_short_windows(search, best)
    target = target_of(best, search.options)
    given = [(effects, dict[str, float]()) for effects in each]
    if few is None:
        return [trial for trial in _refit(search, best, given, target) if trial is not None]
    most = search.options.search.behind * few.rss
    short = zip(given, _refit(search, few, given, most), strict=True)
    near = [(one, trial) for one, trial in short if trial is not None and trial.rss <= most]
    begun = [(trial.effects, trial.values) for _, trial in near]
    found = dict(enumerate(_refit(search, best, begun, target)))
    astray = [n for n, trial in found.items() if trial is None or trial.rss > target]
    again = _refit(search, best, [near[n][0] for n in astray], target)
    for n, trial in zip(astray, again, strict=True):
        before = found[n]
        if before is None or (trial is not None and trial.rss < before.rss):
            found[n] = trial
    return [trial for trial in found.values() if trial is not None]


def _refit(
    search: Search,
    model: Trial,
    each: Sequence[tuple[Sequence[PlacedEffect], Mapping[str, float]]],
    target: float,
) -> list[Trial | None]:
    """A model with other effects on its windows, each from values of its own beside those of the
    model; what does not come down to the `target` at its pace is given up."""
    segments = model.windows.segments
    tasks = [
        search.refits.prepare(model, effects, segments, target=target, values=values)
        for effects, values in each
    ]
    return search.refits.run(model, tasks)


def _fit_few_short_windows(search: Search, best: Trial) -> Trial | None:
    """The best model on few of the shortest windows; None where it stands on less than twice as
    many samples, or where it is far from the noise on these."""
    length, options = search.lengths[0], search.options.search
    segments = search.windows(search.data_split.whole(), length)
    rows = few_of(segments, options.few)
    if 2 * len(rows) * length > len(best.windows.segments) * best.length:
        return None
    few = search.problem.try_refit(best, [segments[n] for n in rows], length)
    if few is None or not few.reduced_chi2 < search.options.trial.gate_noise:
        return None
    return few
