"""The refinement of what a search found: on the longest windows, rivals once more, shapes, what is
superfluous."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tracewire.formula import two_digits
from tracewire.trace.candidates.candidate import is_default
from tracewire.trace.search.common import least_part, uncommon
from tracewire.trace.search.refits import few_of, target_of
from tracewire.trace.search.rivals import count_numbers, known_rivals, refit_rivals
from tracewire.trace.search.search import Search
from tracewire.trace.thresholds import SearchOptions
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.statistics import errors_behind
from tracewire.trace.trials.trial import Trial


@dataclass(frozen=True, eq=False)
class Rival:
    """An effect in the place of one that was found: their correlation on the data, the rise of BIC
    when it takes that place, and the trial where it does. `tied`: it predicts as well, or BIC puts
    it next to nothing behind: these data cannot tell it from what was found."""

    effect: PlacedEffect
    correlation: float
    trial: Trial
    delta_bic: float
    tied: bool


@dataclass(frozen=True, eq=False)
class FinalModels:
    """The declared model and the best one on the longest windows that they bear, the rivals of each
    effect by its name, the declared parameters that went to zero, and what each of several effects
    takes away beside the others, as a part of the squared error that was missing."""

    declared: Trial
    best: Trial
    rivals: dict[str, tuple[Rival, ...]] = field(default_factory=dict)
    dropped: tuple[str, ...] = ()
    shares: Mapping[str, float] = field(default_factory=dict)


def refine(search: Search, declared: Trial, best: Trial) -> FinalModels:
    """The best model on long windows, without what is superfluous, effects beside their rivals.

    Where one was superfluous the others meet their rivals again: it may have made up for what the
    right one of these would have done.
    """
    sections = search.data_split.whole()
    declared = search.lengthen_windows(
        _refit_on_all_data(search, declared), sections, np.inf
    )  # its best free run
    if not best.effects:
        return FinalModels(declared, declared)
    best = search.lengthen_windows(_refit_on_all_data(search, best), sections)
    best = _prune(search, best)
    rivals: dict[str, tuple[Rival, ...]] = {}
    compared = 0
    while len(best.effects) != compared:
        compared = len(best.effects)
        for number in range(compared):
            best, found = _exchange_effect(search, declared, best, number)
            rivals[str(best.effects[number])] = found
        for number in range(compared):
            best = _free_shapes(search, best, number)
        best = _share_phases(search, best)
        best = _drop_trifles(search, _prune(search, best), declared, rivals)
    best, dropped = _drop_terms(search, best)
    return FinalModels(declared, best, rivals, dropped)


def _refit_on_all_data(search: Search, trial: Trial) -> Trial:
    """The trial over all that is not held back for the final claim, on windows as they are; where
    it does not run on some of them, as it was."""
    windows = search.windows(search.data_split.whole(), trial.length)
    return search.problem.try_refit(trial, windows, trial.length) or trial


def _run_refit(
    search: Search,
    trial: Trial,
    effects: Sequence[PlacedEffect],
    fixed: Mapping[str, float] | None = None,
) -> Trial | None:
    """The trial with other effects on the same windows; None where that does not run."""
    target = target_of(trial, search.options)
    fixed = trial.windows.criterion.parameters if fixed is None else fixed
    segments = trial.windows.segments
    task = search.refits.prepare(trial, effects, segments, fixed=fixed, target=target)
    (other,) = search.refits.run(trial, [task])
    return other


def _exchange_effect(
    search: Search, declared: Trial, best: Trial, number: int
) -> tuple[Trial, tuple[Rival, ...]]:
    """The best model with the best of the rivals of one effect, and the other rivals.

    Of those that BIC hardly tells apart the one with the fewest numbers is the best. A wave, a
    drift or their kin takes the place of a common effect only where it takes that much more of what
    is missing; and a law goes before one that imitates it with more numbers, as
    Coulomb friction before a Stribeck curve, where it leaves next to nothing more.
    """
    effect = best.effects[number]
    search.tell(f"comparing {effect} with its rivals")
    others = [e for e in best.effects if e is not effect]
    effective_fraction = best.effective_fraction
    results: list[tuple[float, Trial, PlacedEffect]] = []
    known = known_rivals(search, effect)
    kept = {str(e) for e in others}
    options = search.options
    most = options.search.rivals if search.has_revisits else options.screen.many
    each = [
        [*best.effects[:number], added, *best.effects[number + 1 :]]
        for added, _ in known[:most]
        if str(added) not in kept
    ]
    for trial in refit_rivals(search, best, each):
        if count_numbers(trial.effects[number]) < count_numbers(effect):
            trial = _free_shapes(search, trial, number)  # it may have as many
        results.append((trial.bic(effective_fraction), trial, trial.effects[number]))
    results.append((best.bic(effective_fraction), best, effect))
    # where BIC is the same, a law with a physical sign goes before others, and a sensor comes last
    results.sort(
        key=lambda result: (
            round(result[0], 2),
            result[2].candidate.place.kind == "sensor",
            not result[2].candidate.sign,
        )
    )
    enough = results[0][0] + options.search.bare
    results.sort(key=lambda result: result[1].unknowns if result[0] <= enough else np.inf)
    missing = declared.reduced_chi2 - best.reduced_chi2
    quality, winner, chosen = next(
        (bic, trial, added)
        for bic, trial, added in results
        if uncommon(trial, options) <= uncommon(best, options)
        or best.reduced_chi2 - trial.reduced_chi2 > least_part(trial, options) * missing
    )
    trifle = options.search.trifle * (declared.reduced_chi2 - winner.reduced_chi2) * winner.count
    for bic, trial, added in results:  # a law that it imitates, and that is next to nothing behind
        fewer = trial.unknowns < winner.unknowns
        if str(added) in chosen.candidate.imitated and fewer and trial.rss < winner.rss + trifle:
            quality, winner, chosen = bic, trial, added
    correlation = {str(added): value for added, value in known} | {str(effect): 1.0}
    if str(chosen) != str(effect):
        search.words.append(f"refits on longer windows put {chosen} in the place of {effect}")
        correlation = {str(added): value for added, value in known_rivals(search, chosen)}
    found = [
        Rival(
            added,
            correlation.get(str(added), np.nan),
            trial,
            delta_bic - quality,
            _is_tied(winner, trial, delta_bic - quality, options.search),
        )
        for delta_bic, trial, added in results
        if trial is not winner
    ]
    return winner, tuple(found)


def _is_tied(best: Trial, rival: Trial, delta_bic: float, options: SearchOptions) -> bool:
    """Whether a rival is as good: BIC puts it next to nothing behind, or it is not surely behind
    over blocks of time, as where all that speaks against it is in one of them. What leaves clearly
    more is behind however few blocks show it."""
    if delta_bic < options.tied:
        return True
    if rival.rss > options.tie_left * best.rss:
        return False
    one, other = best.windows.residuals, rival.windows.residuals
    return errors_behind(one, other, options.tie_blocks) < options.tie_errors


def _free_shapes(search: Search, best: Trial, number: int) -> Trial:
    """A model with shapes of one effect free that had kept their default, where that is worth
    it."""
    effect = best.effects[number]
    for shape, grid in effect.candidate.shapes.items():
        current = effect.values.get(shape, 0.0)
        first = min((value for value in grid if value > 0), default=0.0)
        if not first or not is_default(effect.candidate, shape, current):
            continue
        wider = replace(effect, values={**effect.values, shape: first})
        effects = [*best.effects[:number], wider, *best.effects[number + 1 :]]
        trial = _run_refit(search, best, effects)
        worth = search.options.search.cheap
        if (
            trial is not None
            and trial.bic(best.effective_fraction) < best.bic(best.effective_fraction) - worth
        ):
            best = trial
            effect = best.effects[number]
    return best


def _share_phases(search: Search, best: Trial) -> Trial:
    """The best model with one phase for all series where that is no worse: a clock of the rig, not
    of the record."""
    for number, effect in enumerate(best.effects):
        if not effect.own_series:
            continue
        search.tell(f"{effect} with one phase in all series")
        values = {name: value for name, value in effect.values.items() if "@" not in name}
        for shape in effect.candidate.each:
            own = [x for name, x in effect.values.items() if name.startswith(f"{shape}@")]
            values[shape] = float(np.angle(np.mean(np.exp(1j * np.array(own)))))
        effects = [*best.effects[:number], replace(effect, values=values)]
        trial = _run_refit(search, best, [*effects, *best.effects[number + 1 :]])
        if trial is not None and trial.bic(best.effective_fraction) < best.bic(
            best.effective_fraction
        ):
            best = trial
    return best


def _prune(search: Search, best: Trial) -> Trial:
    """The best model without effects that the others make superfluous.

    At the noise BIC decides, and what is many standard errors from nothing is not tried without,
    unless declared parameters can make up for it; far above the noise an effect must take a third
    off the squared error.
    """
    options = search.options
    while len(best.effects) > 1:
        costs = []
        at_noise = best.reduced_chi2 < options.trial.gate_noise
        tasks = [
            search.refits.prepare(
                best,
                [e for e in best.effects if e is not effect],
                best.windows.segments,
                words=f"trying without {effect}",
                target=target_of(best, options),
            )
            for effect in best.effects
            if not at_noise
            or effect.candidate.coefficient in best.undetermined
            or _errors_from_nothing(best, effect) <= options.search.certain
        ]
        for smaller in search.refits.run(best, tasks):
            if smaller is None:
                continue
            loss = smaller.bic(best.effective_fraction) - best.bic(best.effective_fraction)
            left = 1 - options.trial.gate_material
            immaterial = not at_noise and best.rss > left * smaller.rss
            if loss < options.search.cheap or immaterial:
                costs.append((loss, smaller))
        if not costs:
            return best
        best = min(costs, key=lambda cost: cost[0])[1]
    return best


def _errors_from_nothing(best: Trial, effect: PlacedEffect) -> float:
    """By how many standard errors a coefficient differs from that of no effect."""
    error = best.standard_errors.get(effect.candidate.coefficient, np.inf)
    return float(abs(effect.coefficient - effect.candidate.neutral) / max(error, 1e-300))


def _drop_trifles(
    search: Search, best: Trial, declared: Trial, rivals: Mapping[str, Sequence[Rival]]
) -> Trial:
    """The best model without effects that explain next to nothing of what was missing and may stand
    for anything: waves, drifts and their kin, and those with rivals that do as well. What is left
    of laws that are only nearly right has the shape of some effect. One of z standard errors takes
    about z^2 variances off the sum of squares, but where others hold it far more. What takes more
    than the noise has, and leaves nothing, is no trifle."""
    options = search.options
    needed = set[str]()
    while len(best.effects) > 1:
        excess = (declared.reduced_chi2 - best.reduced_chi2) * best.count
        for effect in _least_first(best, options.uncommon):
            if str(effect) in needed:
                continue
            taken = _errors_from_nothing(best, effect) ** 2 * best.reduced_chi2
            ties = [str(rival.effect) for rival in rivals.get(str(effect), ()) if rival.tied]
            unsure = effect.candidate.effect in options.uncommon or ties
            most = options.search.trifle * excess
            small = unsure and taken < most
            if small and not (taken > best.rss and _is_complete(search, best)):
                part = f"{two_digits(100 * taken / excess)} % of the squared error that was missing"
                as_well = f", as {' and '.join(ties)} would" if ties else ""
                words = f"it takes only {part}{as_well}, so it may stand for anything"
                break
            most = options.search.slight * best.rss
            if _is_part_of_remainder(search, best, taken):
                part = f"{two_digits(100 * taken / best.rss)} % of the squared error of the noise"
                words = f"it takes {part}, and more is left that no effect takes"
                break
        else:
            return best
        search.tell(f"trying without {effect}")
        smaller = _run_refit(search, best, [e for e in best.effects if e is not effect])
        if smaller is None or smaller.rss - best.rss > options.search.rough * most:
            needed.add(str(effect))
            continue
        best = smaller
        search.words.append(f"{effect} would be a refinement: {words}, and is not named")
    return best


def _least_first(best: Trial, uncommon: Collection[str]) -> list[PlacedEffect]:
    """The effects of a trial, waves and drifts and their kin first, then the least sure."""
    return sorted(
        best.effects,
        key=lambda effect: (
            effect.candidate.effect not in uncommon,
            _errors_from_nothing(best, effect),
        ),
    )


def _is_part_of_remainder(search: Search, best: Trial, taken: float) -> bool:
    """Whether an effect beside others takes little beside the noise, and what is left is no noise:
    it is the part with its shape of a small law that no block has."""
    options = search.options
    if best.reduced_chi2 >= options.trial.gate_noise or taken >= options.search.slight * best.rss:
        return False
    return not _is_complete(search, best)


def _is_complete(search: Search, best: Trial) -> bool:
    """Whether no effect stands out of what a model leaves."""
    search.tell("looking for what is left")
    return search.screen(best).p_value() > search.options.screen.chance


def largest_first(search: Search, final: FinalModels) -> FinalModels:
    """The models with that effect first without which the squared error rises most, all others and
    the free parameters refitted in a few steps on a few of the windows, and with the shares of
    these rises where no comparison has told them. A standard error tells how sure a coefficient
    is, not how much its effect does: a tiny one may be the surest."""
    best = final.best
    if len(best.effects) < 2:
        return final
    few = few_of(best.windows.segments, search.options.search.few)
    segments = [best.windows.segments[n] for n in few]
    steps = search.options.search.first_steps
    each = [[e for e in best.effects if e is not effect] for effect in best.effects]
    tasks = [search.refits.prepare(best, some, segments, steps=steps) for some in ([], *each)]
    bare, *left = [np.inf if t is None else t.rss for t in search.refits.run(best, tasks)]
    least = sum(float(best.windows.squares[n]) for n in few)
    shares = {
        str(effect): float(np.clip((rss - least) / (bare - least), 0.0, 1.0))
        for effect, rss in zip(best.effects, left, strict=True)
        if least < bare < np.inf and rss < np.inf
    }
    order = sorted(range(len(left)), key=lambda n: -left[n])
    best = replace(best, effects=tuple(best.effects[n] for n in order))
    return replace(final, best=best, shares={**shares, **final.shares})


def _drop_terms(search: Search, best: Trial) -> tuple[Trial, tuple[str, ...]]:
    """The best model without declared terms that the effects make superfluous, and their names."""
    names = []
    options = search.options.search
    own = search.problem.declared.flat.parameters
    for unknown in best.windows.criterion.unknowns:
        if unknown.low != 0.0 or unknown.name not in own or not best.depends_on(unknown.name):
            continue
        at_noise = best.reduced_chi2 < search.options.trial.gate_noise
        error = best.standard_errors[unknown.name]
        if at_noise and best.values[unknown.name] > options.certain * error:
            continue
        fixed = {**best.windows.criterion.parameters, unknown.name: 0.0}
        smaller = _run_refit(search, best, best.effects, fixed=fixed)
        if smaller is None:
            continue
        loss = smaller.bic(best.effective_fraction) - best.bic(best.effective_fraction)
        if loss < 0 or (not at_noise and best.rss > (1 - options.immaterial) * smaller.rss):
            names.append(unknown.name)
            best = smaller
    return best, tuple(names)
