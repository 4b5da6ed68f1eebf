"""What a judgement must withstand: a tighter solver, unseen data, and mistakes of the record."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tracewire.errors import FitError
from tracewire.formula import two_digits
from tracewire.residual import project_out_initial_states
from tracewire.trace.candidates.candidate import PHASE
from tracewire.trace.check.mistakes import refuse_mistakes
from tracewire.trace.choose.own_rhythm import describe_own_rhythm
from tracewire.trace.choose.unseen import (
    excess_of_whole_runs,
    is_no_better_on_claim,
    join_names,
    lowers_unseen,
    model_with,
    raises_unseen,
    raises_whole_runs,
    share_of_whole_runs,
)
from tracewire.trace.choose.verdict import Judgement, residual_map
from tracewire.trace.search.refinement import FinalModels
from tracewire.trace.search.search import Search
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.statistics import inverse_information
from tracewire.trace.trials.trial import Trial


def safeguard(search: Search, judgement: Judgement) -> Judgement:
    """The judgement where the solver is precise enough, and no effect raises the error on unseen
    data, nor an approximation that of whole runs; without the effects where they do. Effects that
    hardly lower the error of whole unseen runs are an approximation."""
    final = judgement.final
    best = search.refit_precisely(final.best) if final.best.effects else final.best
    if best is not final.best:
        final = replace(final, declared=search.problem.refit(final.declared), best=best)
    judgement = _without_undetermined(search, replace(judgement, final=final))
    if judgement.explained is None:  # at the noise; else other runs have been asked already
        judgement = replace(judgement, final=_without_harmful(search, judgement.final))
    final = judgement.final
    if final.best.effects:
        lengths = sorted({min(search.short_length, final.best.length), final.best.length})
        harm = raises_unseen(search, final.declared, final.best, lengths)
        if not harm and judgement.verdict == "effect":
            judgement = _confirm(search, judgement)
        if not harm and judgement.verdict == "unexplained":
            harm = raises_whole_runs(search, final.declared, final.best)
        if harm:
            names = list(map(str, final.best.effects))
            search.words.append(f"{join_names(names)} is not named: it {harm}")
            final = FinalModels(final.declared, final.declared)
            dependences, missing = residual_map(search, final.declared)
            reason = f"{model_with(names)} {harm}"
            return Judgement("unexplained", final, dependences, missing, reason=reason)
    return judgement


def tell_waves_tried_once(search: Search, judgement: Judgement) -> None:
    """Say that more waves of a named kind may be left: a search tries one of a kind at a place."""
    best = judgement.final.best
    waves = [e for e in best.effects if e.candidate.waves or e.candidate.lines]
    kinds = [str(e) for e in waves if PHASE in e.candidate.shapes]  # a resonance is no wave
    named = judgement.verdict == "effect" and kinds
    if named and best.reduced_chi2 > search.options.informative:
        search.words.append(
            f"{join_names(kinds)} is tried once, and {two_digits(best.reduced_chi2**0.5)} σ are"
            " left, where 1 is the noise: for another wave of this kind apply the change and trace"
            " again"
        )


def undetermined_effects(trial: Trial, confidence: float) -> list[str]:
    """The effects of a trial, by name, whose coefficient may as well be zero.

    It may not where its ratio to a declared parameter is known: a motor whose time constant is
    shorter than a sample tells a friction, a gain and a damping up to a common factor.
    """
    ends = trial.intervals(confidence)
    found = []
    for effect in trial.effects:
        name = effect.candidate.coefficient
        low, high = ends.get(name, (1.0, 1.0))
        if low <= 0 <= high and not _has_known_ratio(trial, name, (high - low) / 2):
            found.append(str(effect))
    return found


def _has_known_ratio(trial: Trial, name: str, half: float) -> bool:
    """Whether the ratio of a fitted value to that of a declared parameter is surely not zero;
    `half` is half the interval of the value."""
    errors, values = trial.standard_errors, trial.values
    declared, correlations = trial.model.flat.parameters, _correlations(trial, name)
    if not values[name] or not 0 < errors[name] < np.inf:
        return False
    own = errors[name] / abs(values[name])
    for other in values:
        if other == name or "." in other or other not in declared or not values[other]:
            continue
        its = errors[other] / abs(values[other])
        if not np.isfinite(its):
            continue
        together = correlations[other] * np.sign(values[name]) * np.sign(values[other])
        square = max(own**2 + its**2 - 2 * together * own * its, 0.0)
        if half / errors[name] * square**0.5 < 1:
            return True
    return False


def _correlations(trial: Trial, name: str) -> dict[str, float]:
    """The correlation of the error of a fitted value with those of all; 0 where one has none."""
    inverse, _ = inverse_information(project_out_initial_states(trial.windows)[0])
    spread = np.sqrt(np.maximum(np.diag(inverse), 0.0))
    n = list(trial.values).index(name)
    size = spread * spread[n]
    found = np.divide(inverse[n], size, out=np.zeros(len(size)), where=size > 0)
    return dict(zip(trial.values, found.tolist(), strict=True))


def _without_undetermined(search: Search, judgement: Judgement) -> Judgement:
    """The judgement without effects whose coefficient may as well be zero, also of what is left
    where some of them are gone."""
    final = judgement.final
    names = undetermined_effects(final.best, search.options.confidence)
    kept = [effect for effect in final.best.effects if str(effect) not in names]
    fewer = _refit_with(search, final.best, kept) if names and kept else None
    if not names or (kept and fewer is None):
        return judgement
    one = len(names) == 1
    search.words.append(
        f"{join_names(names)} {'is' if one else 'are'} not named: the"
        f" {search.options.confidence:.0%} interval of {'its' if one else 'their'}"
        f" coefficient{'s' * (not one)} holds zero"
    )
    if fewer is not None:
        fewer_effects = replace(judgement, final=_with_effects(final, fewer))
        return _without_undetermined(search, fewer_effects)
    alone = FinalModels(final.declared, final.declared)
    if final.declared.reduced_chi2 <= search.options.at_noise:
        return Judgement("null", alone)
    return Judgement("unexplained", alone, *residual_map(search, final.declared))


def _without_harmful(search: Search, final: FinalModels) -> FinalModels:
    """The models without an effect beside others that raises the error of whole unseen runs, and
    does not lower that of windows there."""
    best, short = final.best, search.short_length
    for effect in best.effects if len(best.effects) > 1 else ():
        kept = [one for one in best.effects if one is not effect]
        fewer = _refit_with(search, best, kept)
        if fewer is None:
            continue
        harm = raises_whole_runs(search, fewer, best)
        if harm and not lowers_unseen(search, fewer, best, short):
            known = join_names(map(str, kept))
            search.words.append(f"{effect} is not named beside {known}: it {harm}")
            return _without_harmful(search, _with_effects(final, fewer))
    return final


def _refit_with(search: Search, best: Trial, kept: Sequence[PlacedEffect]) -> Trial | None:
    """A trial with some of its effects, fitted to its windows; None where it does not run."""
    windows, fixed = best.windows.segments, best.windows.criterion.parameters
    try:
        return search.problem.fit(kept, windows, best.length, best.values, fixed=fixed)
    except FitError:
        return None


def _with_effects(final: FinalModels, best: Trial) -> FinalModels:
    """The models with another best one, and the rivals of its effects."""
    rivals = {str(effect): final.rivals.get(str(effect), ()) for effect in best.effects}
    return replace(final, best=best, rivals=rivals)


def _confirm(search: Search, judgement: Judgement) -> Judgement:
    """The judgement, or `unexplained` where unseen data do not confirm the effects.

    They hardly lower the error of whole unseen runs: what follows a rest of no block's form on
    windows does not carry over to them. Or they do not lower it at all where the claim is made.
    Both count only where these runs move alike. Or they are waves that keep the rhythm of the
    motion.
    """
    declared, best = judgement.final.declared, judgement.final.best
    share, what = share_of_whole_runs(search, declared, best), ""
    if share < search.options.whole_runs:
        part = f"{100 * max(share, 0):.0f} %"
        what = f"takes {part} of the excess squared error of whole unseen runs away"
    elif is_no_better_on_claim(search, declared, best):
        what = f"takes less than {search.options.claimed:.0%} of the excess squared error of"
        what += " windows and of free runs away in the part of the data that played no part"
    if not (what and _moves_alike(search, declared, best)):
        what = describe_own_rhythm(search, best)
    if not what:
        return judgement
    reason = f"{model_with(map(str, best.effects))} {what}"
    dependences, missing = residual_map(search, declared)
    return replace(
        judgement, verdict="unexplained", dependences=dependences, missing=missing, reason=reason
    )


def _moves_alike(search: Search, declared: Trial, best: Trial) -> bool:
    """Whether whole unseen runs show what effects are for; if not, the search's words say so."""
    excess = excess_of_whole_runs(search, declared, best)
    if excess < search.options.excited:
        search.words.append(
            f"whole unseen runs show {max(excess, 0.0):.0%} of the squared error that the effects"
            " take in the fitted ones: they do not move alike, and confirm nothing; let `use:"
            " validate` name a part, or a run, in which drives and signals move as in the rest"
        )
        return False
    return True


def refuse_mistaken(search: Search, declared: Trial, judgement: Judgement) -> None:
    """Refuse records that a mistake explains better than what was found.

    Only where no effect explains what is left far above the noise, or where what was found may
    itself be a mistake: a sensor or a drive.
    """
    best = judgement.final.best
    suspicious = any(e.candidate.place.kind != "sum" for e in best.effects)
    if suspicious or (
        judgement.verdict == "unexplained" and best.reduced_chi2 > search.options.check.suspicious
    ):
        search.tell("looking for mistakes in the records")
        problem, options = search.problem, search.options.check
        refuse_mistakes(
            problem.declared, problem.measured, options, declared.reduced_chi2, problem.rtol
        )
