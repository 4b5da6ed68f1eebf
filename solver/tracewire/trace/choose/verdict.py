"""The verdict of a trace: whether something is missing, and whether the named effects are it."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracewire.errors import FitError
from tracewire.formula import two_digits
from tracewire.trace.choose.choice import is_sure, log_scores
from tracewire.trace.choose.heldout import Finalist
from tracewire.trace.choose.noisy_inputs import InputNoise, noisy_inputs
from tracewire.trace.choose.prediction import Prediction
from tracewire.trace.choose.remainder import (
    error_left,
    explained_share,
    held_out_errors,
    remainders,
)
from tracewire.trace.choose.settling import describe_few_samples, describe_settling
from tracewire.trace.choose.unseen import (
    better_unseen,
    describe_better_unseen,
    join_names,
    model_with,
    prune_by_other_runs,
    raises_unseen,
    simplify_by_unseen,
)
from tracewire.trace.found import (
    Dependence,
    Explained,
    HeldOut,
    LikelyInput,
    Missing,
    Remainder,
    Verdict,
)
from tracewire.trace.missing.dependence import map_dependence
from tracewire.trace.options import TraceOptions
from tracewire.trace.search.refinement import FinalModels, Rival, refine
from tracewire.trace.search.search import Search
from tracewire.trace.trials.bounds import upper_shapes
from tracewire.trace.trials.relative_error import relative_error
from tracewire.trace.trials.trial import Trial


@dataclass(frozen=True, eq=False)
class Judgement:
    """The verdict, the models that it is about, and what it rests on.

    `reason` says why effects that came near are not named, or do not explain what is missing.
    `prediction` is the comparison of models by what they predict, where the noise was not reached.
    `interrupted` says that the search was ended early: this is what it had found. `input_noise` is
    the noise of inputs with which a model reaches that of the sensors: the search is to be done
    again with it.
    """

    verdict: Verdict
    final: FinalModels
    dependences: tuple[Dependence, ...] = ()
    missing: Missing | None = None
    explained: Explained | None = None
    remainder: tuple[Remainder, ...] = ()
    remainder_depends: tuple[Dependence, ...] = ()
    held_out: tuple[HeldOut, ...] = ()
    noisy_inputs: tuple[LikelyInput, ...] = ()
    reason: str = ""
    prediction: Prediction | None = None
    interrupted: bool = False
    input_noise: InputNoise | None = None


def noise_limit(search: Search, trial: Trial) -> float:
    """The reduced chi-square up to which a residual is at the noise, some standard errors at least:
    its variance is 2/degrees_of_freedom."""
    return max(
        search.options.at_noise,
        1 + search.options.noise_errors * float(np.sqrt(2 / trial.degrees_of_freedom)),
    )


def is_at_noise(search: Search, trial: Trial) -> bool:
    """Whether a model leaves no more than the noise of the sensors, on fitted windows and, with the
    effects that were chosen there, on windows that no fit saw."""
    limit = noise_limit(search, trial)
    if not trial.reduced_chi2 < limit:
        return False
    if trial.length < search.short_length:  # the shortest windows alone see little
        windows = search.windows(search.data_split.train, search.short_length)
        try:
            longer = search.problem.refit(trial, windows, search.short_length)
        except FitError as error:  # nor can models be compared by what they predict there
            names, what = list(map(str, trial.effects)), error.problems[0].what
            search.note(
                f"in windows of {trial.length} samples {model_with(names)} leaves no more than the"
                f" noise; in longer ones it does not run: {what}"
            )
            return True
        if longer.reduced_chi2 > search.options.lost:
            return False
    return not trial.effects or _gate_mean_square(search, trial) < limit**2


def is_slow_noise(search: Search, trial: Trial) -> bool:
    """Whether what is left without effects may be slow noise of a sensor, in windows and in whole
    runs: where no body comes back to where it was, that is not to be told from a force. An
    estimate of the noise does not see what is slow; one that the user declares has all of it."""
    estimated = any(
        sigma is None
        for series in search.problem.measured
        for sigma in (series.sigma.get(signal) for signal in series.values)
    )
    if trial.effects or search.has_revisits or not estimated:
        return False
    residuals = search.problem.residuals_on(trial, search.whole_windows(search.data_split.whole()))
    whole = float(np.mean(np.concatenate(residuals) ** 2))
    return max(trial.reduced_chi2, whole) < search.options.slow_noise


def judge_at_noise(search: Search, first: Trial, best: Trial) -> Judgement | None:
    """`null` where the declared model `first` is at the noise, `effect` where the best one is; None
    where neither is, so that models must be compared by what they predict.

    Windows whose starts are free swallow what is slower than they are: nothing is missing only
    where the declared model is near the noise on the longest windows that it bears, too. Effects
    must take most of what was above the noise, or predict. Three small laws follow any smooth
    force, and a shape on its upper bound stands for another law: these must predict, too.
    """
    slow = is_slow_noise(search, best)
    if not slow and not is_at_noise(search, best):
        return None
    final = refine(search, first, best)
    if final.best.effects:
        few = len(final.best.effects) < search.options.many_effects
        if not few or _share_of_excess(final) < search.options.explained_at_noise:
            return None
        longer = final.best.length > best.length
        if not longer and final.best.reduced_chi2 > max(
            search.options.lost, noise_limit(search, final.best)
        ):
            return None
        if _describe_shape_on_bound(final.best):
            return None
        if longer and final.best.reduced_chi2 > search.options.lost:
            search.words.append(_describe_longer_windows(best, final.best))
        return Judgement("effect", final)
    lost = final.best.length > best.length and final.best.reduced_chi2 > search.options.lost
    return Judgement("null", final) if slow or not lost else None


def _describe_longer_windows(best: Trial, longer: Trial) -> str:
    """In words, that a model at the noise on some windows is not so on longer ones."""
    names = join_names(map(str, best.effects))
    short, long = best.reduced_chi2**0.5, longer.reduced_chi2**0.5
    return (
        f"something smaller may be missing, too: with {names} the residual is {two_digits(short)} σ"
        f" in windows of {best.length} samples, and {two_digits(long)} σ in windows of"
        f" {longer.length}. Apply the change and trace again"
    )


def _share_of_excess(final: FinalModels) -> float:
    """The share of what the declared model leaves above the noise that the best one takes away; all
    where the declared one does not bear windows as long."""
    before, after = final.declared, final.best
    if before.length < after.length:
        return 1.0
    taken, above = before.reduced_chi2 - after.reduced_chi2, before.reduced_chi2 - 1
    return taken / above if above > 0 else 0.0


def judge_prediction(search: Search, prediction: Prediction) -> Judgement:
    """The verdict on the model that predicts held-out blocks best.

    `effect`: it beats the declared one by three standard errors, explains the greater part of the
    excess error, and leaves no law behind that no block has. `null`: nothing is sure, or the
    declared model is at the noise, and a smooth map of what is left gains next to nothing. Else
    something is missing that no effect explains: `unexplained`.
    """
    options = search.options
    prediction, reason = _harmless(search, prediction)
    declared = prediction.models[0].trials
    above = any(trial.reduced_chi2 > noise_limit(search, trial) for trial in declared)
    names = bool(prediction.chosen.names)  # not by dropped terms alone
    named = above and prediction.choice.sure and names
    if not named:
        prediction = prediction.without_effects()
    final = final_of(search, prediction)
    chosen = prediction.chosen
    search.tell("where and on what the rest depends")
    spread = [
        horizon.sparse_windows(options.most_samples, options.least_blocks)
        for horizon in prediction.horizons.each
    ]
    maps = [
        residual_map(search, search.problem.on_some_windows(trial, numbers))
        for trial, numbers in zip(chosen.trials, spread, strict=True)
    ]
    floors = [_left(trial, shares) for trial, (shares, _) in zip(chosen.trials, maps, strict=True)]
    share, error = explained_share(prediction, floors)
    if not named:
        gain = 0.5 * float(np.mean(-np.log(floors)))
        missed = bool(reason) or gain >= max(np.log1p(options.near), options.map_gain)
        verdict: Verdict = "unexplained" if missed else "null"
        dependences, missing = maps[0]
        if missed:
            search.words.extend(describe_settling(declared[0], options))
        if above:
            search.words.extend(describe_few_samples(declared[-1], options))
        if above and not missed:
            search.words.append(
                f"the residual is {two_digits(declared[-1].reduced_chi2 ** 0.5)} σ, and no effect"
                " or smooth function explains it: the noise is larger than σ, or the record is"
                " disturbed otherwise"
            )
    else:
        law = ""
        if search.has_revisits:  # else all that is left is a function of the one way
            shares = [shares for shares, _ in maps]
            law = _describe_law_left(chosen.trials, shares, share.share, options)
        short = law or _describe_shortfall(prediction, share.share, share.share - error)
        if _only_uncommon(chosen, options):
            short = "stands for a law of another form: it has waves, drifts and their kin alone"
        short = short or _describe_shape_on_bound(chosen.trials[-1])
        reason = f"{model_with(chosen.names)} {short}" if short else ""
        verdict = "unexplained" if reason else "effect"
        dependences, missing = (
            residual_map(
                search, search.problem.on_some_windows(prediction.models[0].trials[0], spread[0])
            )
            if verdict == "unexplained"
            else ((), None)
        )
    depends = max((d.share for d in dependences), default=0.0)
    noisy: tuple[LikelyInput, ...] = ()
    if verdict == "unexplained" and depends < options.input_depends:
        noisy = noisy_inputs(search, prediction.models[0].trials[0])
    return Judgement(
        verdict,
        final,
        dependences,
        missing if verdict == "unexplained" else None,
        share if named else None,
        remainders(prediction, floors, search.problem.sigma, final.best.model.flat.units),
        maps[0][0],
        held_out_errors(prediction, floors),
        noisy,
        reason if verdict == "unexplained" else "",
    )


def _describe_shape_on_bound(trial: Trial) -> str:
    """In words, that a shape of an effect sits on its upper bound, beyond which the record tells
    nothing: the law has another form. '' where none does. At a lower bound it is a simpler law."""
    for one in upper_shapes(trial):
        shape = one.name.rpartition(".")[2]
        what = f"the {shape} of {one.effect} sits on its upper bound"
        return f"stands for a law of another form: {what}"
    return ""


def _describe_shortfall(prediction: Prediction, share: float, surely: float) -> str:
    """In words, why the named effects are not enough: they explain too little of the excess error,
    or leave too much of the error on held-out blocks; '' where they are. At the noise of all
    horizons they explain all there is."""
    options, trials = prediction.options, prediction.chosen.trials
    at_all = all(trial.reduced_chi2 <= options.at_noise for trial in trials)
    least, why = _least_share(prediction, options)
    if share < least or (surely < options.explained_surely and not at_all):
        taken = f"takes {100 * max(share, 0):.0f} % of the excess error on held-out blocks away"
        return taken + (why if options.explained <= share < least else "")
    left = error_left(prediction)
    if trials[-1].reduced_chi2 <= options.at_noise or left <= options.error_left:
        return ""
    return f"leaves {100 * left:.0f} % of the error on a typical held-out block (geometric mean)"


def _least_share(prediction: Prediction, options: TraceOptions) -> tuple[float, str]:
    """The share of the excess that the effects of a model must explain, and in words why more than
    others: waves and drifts follow a part of anything, and so do many laws together; and what is
    left by a model that explains nearly all motion is as small as what any rig has besides, unless
    a law takes the place of a declared one."""
    chosen = prediction.chosen
    effects = chosen.trials[0].effects
    more = len(effects) - len(chosen.dropped)
    if more >= options.many_effects:
        least = options.explained_many
        what = f"{len(effects)} effects, which together follow a part of anything, need"
    elif not {e.candidate.effect for e in effects}.isdisjoint(options.uncommon):
        least = options.explained_uncommon if more < 2 else options.explained_uncommon_beside
        beside = " beside another effect" if more > 1 else ""
        what = f"a wave or a drift{beside}, which follows a part of anything, needs"
    else:
        least, what = options.explained, ""
    left = relative_error(prediction.models[0].trials[-1])
    small = left < options.small_error and not chosen.dropped
    if small and least < options.explained_small:
        least = options.explained_small
        what = f"an effect behind an error of {two_digits(100 * left)} % of the motion needs"
    return least, f", and {what} {100 * least:.0f} %" if what else ""


def _only_uncommon(model: Finalist, options: TraceOptions) -> bool:
    """Whether a model has several effects, all of them waves, drifts and their kin: together they
    follow any smooth law."""
    names = [effect.candidate.effect for effect in model.trials[0].effects]
    return len(names) > 1 and all(name in options.uncommon for name in names)


def _harmless(search: Search, prediction: Prediction) -> tuple[Prediction, str]:
    """The prediction with the best choice that raises the error on no unseen data, and why the one
    before was refused for that; what was refused goes into the search's words."""
    reason = ""
    refused: list[frozenset[str]] = []
    lengths = [horizon.length for horizon in prediction.horizons.each]
    while prediction.choice.sure and len(refused) < search.options.refused:
        declared, chosen = (model.trials[-1] for model in (prediction.models[0], prediction.chosen))
        harm = raises_unseen(search, declared, chosen, lengths)
        if not harm:
            pruned = prune_by_other_runs(search, prediction)
            simplest = simplify_by_unseen(search, pruned).preferring_signs()
            simplest = simplest.preferring_inner_shapes()
            shortest = [min(search.short_length, max(lengths))]  # `safeguard` asks them, too
            harm = raises_unseen(search, declared, simplest.chosen.trials[-1], shortest)
            if not harm:
                return simplest, reason
            prediction = simplest
        left_out = join_names(prediction.chosen.dropped)
        names = prediction.chosen.names
        what = join_names(names) or f"the model without {left_out}"
        told = f"{what} is not named: it {harm}"
        if told not in search.words:  # what is simplified may come to the same model again
            search.words.append(told)
        reason = reason or (f"{model_with(names)} {harm}" if names else f"{what} {harm}")
        refused.append(prediction.chosen.names)
        prediction = prediction.choose_again(refused)
    if refused and len(refused) == search.options.refused:
        prediction = replace(prediction, choice=replace(prediction.choice, sure=False))
    if reason and not search.data_split.other_runs:
        search.words.append(
            "the part that was held back may show what the rest does not: name another run under"
            " `measured:`, with `use: validate`, so that this one is fitted whole"
        )
    return prediction, reason


def final_of(search: Search, prediction: Prediction) -> FinalModels:
    """The models of a prediction at the longer horizon, and the ties of each effect; other models
    that predict as well go into the search's words."""
    chosen = prediction.chosen
    best, declared = chosen.trials[-1], prediction.models[0].trials[-1]
    rivals: dict[str, list[Rival]] = {str(effect): [] for effect in best.effects}
    options, blocks = prediction.options, prediction.horizons.count
    totals = log_scores(prediction.errors).mean(axis=(1, 2, 3))
    known = {number for number, _ in prediction.choice.ties}
    unseen = []
    for number, left in better_unseen(search, prediction).items():
        search.words.append(describe_better_unseen(prediction, number, left))
        if number not in known:
            unseen.append((number, float(totals[number] - totals[prediction.choice.chosen])))
    others: list[tuple[float, str]] = []
    for number, cost in (*prediction.choice.ties, *unseen):
        other = prediction.models[number]
        if chosen.names < other.names:
            continue  # a refinement, if it is sure
        trial = other.trials[-1]
        here, there = chosen.names - other.names, other.names - chosen.names
        more = other.numbers - chosen.numbers
        delta_bic = 2 * blocks * cost + more * float(np.log(blocks))
        if len(here) == len(there) == 1:
            (name,), (rival,) = here, there
            if any(str(known.effect) == rival for known in rivals[name]):
                continue  # the same without a declared term
            added = next(e for e in trial.effects if str(e) == rival)
            correlation = prediction.correlation(name, rival)
            rivals[name].append(Rival(added, correlation, trial, delta_bic, tied=True))
        else:
            others.append((cost, _as_good_words(other.names, cost, more)))
    others.sort()
    search.words += [words for _, words in others[: options.told]]
    if len(others) > options.told:
        more = len(others) - options.told
        search.words.append(f"{more} other models with several effects predict as well, too")
    search.words += _describe_refinement(prediction)
    own = search.problem.declared.flat.parameters
    dropped = (*chosen.dropped, *(name for name in chosen.vanished if name in own))
    shares = prediction.shares()
    return FinalModels(declared, best, {k: tuple(v) for k, v in rivals.items()}, dropped, shares)


def _describe_refinement(prediction: Prediction) -> list[str]:
    """In words, the model that predicts surely better with more effects, none of which takes enough
    of what was missing to be named."""
    chosen, mine = prediction.chosen, prediction.entrants[prediction.choice.chosen]
    totals = log_scores(prediction.errors).mean(axis=(1, 2))
    finer = [
        n
        for n, one in enumerate(prediction.entrants)
        if chosen.names and chosen.names < one.effects and np.isfinite(totals[n]).all()
        and is_sure(totals, prediction.choice.chosen, n, prediction.options)
        and mine.is_as_good(one, prediction.options)
    ]  # fmt: skip
    if not finer:
        return []
    best = min(finer, key=lambda n: float(totals[n].mean()))
    less = -np.expm1(float(np.mean(totals[best] - totals[prediction.choice.chosen])))
    part = max(mine.leaves_more(prediction.entrants[best]), 0.0)
    more = join_names(prediction.models[best].names - chosen.names)
    return [
        f"{more} would be a refinement: it lowers the error on held-out blocks by {less:.0%}, but"
        f" takes only {two_digits(100 * part)} % of the squared error that was missing, so it"
        " may stand for anything, and is not named"
    ]


def residual_map(search: Search, trial: Trial) -> tuple[tuple[Dependence, ...], Missing | None]:
    """Where and on what the residual of a trial depends, in its windows; on nothing that is known
    where it does not run with its places open, which is told."""
    try:
        along = search.linearise(trial)
    except FitError as error:
        what = error.problems[0].what
        search.words.append(f"where and on what the rest depends was not looked at: {what}")
        return (), None
    return map_dependence(along, trial, search.places)


def _left(trial: Trial, shares: Sequence[Dependence]) -> float:
    """The part of the squared residual that the best smooth map leaves."""
    best = max((d.share for d in shares), default=0.0)
    excess = max(trial.rss - trial.degrees_of_freedom, 0.0)
    return float(np.clip(1 - best * excess / trial.rss, 1e-6, 1.0)) if trial.rss > 0 else 1.0


def _describe_law_left(
    trials: Sequence[Trial],
    shares: Sequence[Sequence[Dependence]],
    explained: float,
    options: TraceOptions,
) -> str:
    """In words, the law that the named effects leave behind at one of the horizons, where they
    explain too little: a smooth function at one place that takes the rest down to the noise, or
    nearly all of it. A function of time alone is no law: gusts, and the air of a room, do not come
    again."""
    if explained >= options.law_below:
        return ""
    from_shares = options.law_share, options.law_share_long
    for trial, found, from_share in zip(trials, shares, from_shares, strict=False):
        laws = [d for d in found if d.variables != ("t",)]
        best = max(laws, key=lambda d: d.share, default=None)
        if best is None or trial.reduced_chi2 < options.law_from:
            continue
        left = 1 + (1 - best.share) * (trial.reduced_chi2 - 1)
        if left > options.at_noise and best.share < from_share:
            continue
        part, of = f"{100 * best.share:.1f} %", " and ".join(best.variables)
        return (
            f"leaves a law of no block's form: {part} of the rest is a function of {of} at "
            f"{best.place}"
        )
    return ""


def _gate_mean_square(search: Search, best: Trial) -> float:
    """The squared residual per residual on windows that no fit saw, their starts counted."""
    windows = search.windows(search.data_split.gate, search.short_length)
    residuals = search.problem.residuals_on(best, windows)
    count = sum(r.size for r in residuals) - sum(len(w.free) for w in windows)
    return sum(float(np.sum(r**2)) for r in residuals) / max(count, 1)


def _as_good_words(names: Collection[str], cost: float, more: int) -> str:
    """That another model predicts as well, with how many fitted numbers more."""
    numbers = f"{abs(more)} fitted number{'s' * (abs(more) != 1)} {'more' if more > 0 else 'fewer'}"
    predict = "predict" if len(names) > 1 else "predicts"
    with_them = numbers if more else "as many fitted numbers"
    return f"{join_names(names)} {predict} as well: {_change(cost)} error, {with_them}"


def _change(cost: float) -> str:
    percent = 100 * float(np.expm1(cost))
    return f"{two_digits(abs(percent))} % {'more' if cost > 0 else 'less'}"
