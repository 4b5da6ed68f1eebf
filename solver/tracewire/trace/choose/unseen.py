"""What models do on data that no fit saw: which effects raise the error there, and which add
nothing."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tracewire.array_types import Vector
from tracewire.formula import two_digits
from tracewire.residual import Section, restart_from_others
from tracewire.trace.choose.choice import beats_declared, log_scores
from tracewire.trace.choose.prediction import Prediction
from tracewire.trace.search.search import Search
from tracewire.trace.trials.free_run import free_run
from tracewire.trace.trials.trial import Trial


def raises_unseen(search: Search, fewer: Trial, more: Trial, lengths: Sequence[int]) -> str:
    """By how much a model raises the error of one with fewer effects on unseen data, in words;
    empty where it does not.

    Windows of each length, in samples, of which only the starts are fitted. Of several windows the
    rise is more than chance where it is two standard errors; of few, where it is a tenth. An error
    within the noise of the sensors is no harm.
    """
    options, unseen = search.options, search.data_split.unseen
    for length in lengths:
        before, after = squares_of_both(search, unseen, fewer, more, length)
        if not np.isfinite(before.sum()):
            continue
        longest = min(length, _longest(unseen))
        if not np.isfinite(after.sum()):
            return f"does not run through unseen windows of {longest} samples"
        rise, count = after - before, len(before)
        many = count >= options.few_windows
        part = options.harm if many else options.harm_few
        if after.sum() <= max(_count(unseen), (1 + part) ** 2 * before.sum()):
            continue
        error = float(np.std(rise, ddof=1)) * count**0.5 if many else 0.0
        if rise.sum() > options.harm_errors * error:
            factor = (after.sum() / before.sum()) ** 0.5 if before.sum() > 0 else float("inf")
            return f"multiplies the error on unseen windows of {longest} samples by {factor:.3g}"
    return ""


def raises_whole_runs(search: Search, fewer: Trial, more: Trial) -> str:
    """By how much a model raises the error of one with fewer effects in whole unseen runs, in
    words; empty where it does not, or where these runs tell nothing, as at the noise.

    An effect that is right may raise that of one run, where long runs depend on everything: this is
    asked of what only approximates.
    """
    options = search.options
    before, after, count = _whole_runs(search, fewer, more)
    if after <= max(options.informative * count, (1 + options.harm) ** 2 * before):
        return ""
    return f"multiplies the error of whole unseen runs by {(after / before) ** 0.5:.3g}"


def share_of_whole_runs(search: Search, fewer: Trial, more: Trial) -> float:
    """The part that a model takes of the excess squared error which one with fewer effects has in
    whole unseen runs; 1 where that is at the noise, or where these runs tell nothing."""
    before, after, count = _whole_runs(search, fewer, more)
    if before <= search.options.informative * count:
        return 1.0
    return 1 - (after - count) / (before - count)


def excess_of_whole_runs(search: Search, fewer: Trial, more: Trial) -> float:
    """What a model leaves per residual in whole unseen runs above what one with more effects leaves
    where it was fitted, as a part of the same where both were fitted; infinity where that is not
    known. Near 0 these runs do not move as those did, and tell nothing of the effects."""
    taken = fewer.reduced_chi2 - more.reduced_chi2
    unseen = search.data_split.unseen
    if not unseen or not taken > 0 or fewer.length != more.length:
        return float("inf")
    before = float(squares_on(search, unseen, fewer, _longest(unseen)).sum())
    return (before / _count(unseen) - more.reduced_chi2) / taken


def lowers_unseen(search: Search, fewer: Trial, more: Trial, length: int) -> bool:
    """Whether a model lowers the error of one with fewer effects on unseen windows of a length, by
    more than chance."""
    unseen = search.data_split.unseen
    before, after = squares_of_both(search, unseen, fewer, more, length)
    return (1 + search.options.harm) ** 2 * float(after.sum()) < float(before.sum())


def is_no_better_on_claim(search: Search, fewer: Trial, more: Trial) -> bool:
    """Whether a model takes next to nothing of the excess error that one with fewer effects has in
    the part of the data that is kept for the claim, neither of windows nor of free runs; false
    where the latter are at the noise. Where they have lost track of the data, windows must show a
    rise that is no chance."""
    claim, short, options = search.data_split.validate, search.short_length, search.options
    count = _count(claim)
    before, after = (_squares_of_free_runs(search, claim, trial) for trial in (fewer, more))
    at_noise = before <= options.informative * count
    if at_noise or before - after >= options.claimed * (before - count):
        return False
    lost = before >= _tracked(search, claim)
    before, after = (float(x.sum()) for x in squares_of_both(search, claim, fewer, more, short))
    if lost:
        return after >= (1 + options.harm) ** 2 * before
    return before - after <= options.claimed * max(before - count, 0.0)


def _squares_of_free_runs(search: Search, sections: Sequence[Section], trial: Trial) -> float:
    """The sum of squared residuals in sigma of a run over each section, whose start is fitted on
    the first part of it alone."""
    runs = [
        free_run(search.problem, trial, whole, search.shortest)
        for whole in search.whole_windows(sections)
    ]
    return sum(float(np.sum(run**2)) for run in runs)


def _whole_runs(search: Search, fewer: Trial, more: Trial) -> tuple[float, float, int]:
    """The sums of squares of two models in whole unseen runs, in sigma^2, and of how many
    residuals; nothing where the first has lost track of the data."""
    unseen = search.data_split.unseen
    whole = _longest(unseen)
    before, after = squares_of_both(search, unseen, fewer, more, whole)
    if not before.sum() < _tracked(search, unseen):
        return 0.0, 0.0, 0
    return float(before.sum()), float(after.sum()), _count(unseen)


def better_unseen(search: Search, prediction: Prediction) -> dict[int, float]:
    """The numbers of the models with one effect of the chosen one exchanged that do better on
    unseen data: no worse in windows of each horizon, and surely better in whole runs; and what each
    leaves there, in units of the error of the chosen one. They surely beat the declared model, and
    have at most one number more.

    What the fitted run prefers, another run may not: then neither names the effect alone.
    """
    options, chosen = search.options, prediction.choice.chosen
    mine, totals = prediction.entrants[chosen], log_scores(prediction.errors).mean(axis=(1, 2))
    rivals = [
        n
        for n, one in enumerate(prediction.entrants)
        if one.exchanges(mine)
        and one.numbers <= mine.numbers + 1
        and np.isfinite(totals[n]).all()
        and beats_declared(prediction.entrants, totals, n, options)
    ]
    if not rivals:
        return {}
    unseen = search.data_split.unseen
    lengths = {horizon.length for horizon in prediction.horizons.each}
    whole = _longest(unseen)

    def error(number: int, length: int) -> float:
        trial = prediction.models[number].trials[-1]
        return float(np.sqrt(squares_on(search, unseen, trial, length).sum()))

    found, most = dict[int, float](), error(chosen, whole)
    for n in rivals:
        left = error(n, whole) / most
        no_worse = all(error(n, length) <= error(chosen, length) for length in lengths)
        if no_worse and left < 1 / (1 + options.harm_few):
            found[n] = left
    return found


def describe_better_unseen(prediction: Prediction, number: int, left: float) -> str:
    """In words, that a model does better than the chosen one on unseen data, and not on held-out
    blocks, or that it has more numbers."""
    chosen = prediction.choice.chosen
    other, known = (join_names(prediction.models[n].names) for n in (number, chosen))
    held_out = f"predicts held-out blocks less well than {known}, but"
    if prediction.total(number) <= prediction.total(chosen):
        held_out = f"has more fitted numbers than {known}, and"
    return (
        f"{other} {held_out} leaves {two_digits(left)} times its error in whole unseen runs:"
        " these data do not decide between them"
    )


def simplify_by_unseen(search: Search, prediction: Prediction) -> Prediction:
    """The prediction with an effect that the chosen one imitates in its place, where that takes
    fewer numbers and does better on unseen data: the chosen one is a tie then."""
    mine = prediction.entrants[prediction.choice.chosen]
    for number, left in better_unseen(search, prediction).items():
        if prediction.entrants[number].simplifies(mine):
            search.words.append(
                f"{join_names(prediction.chosen.names)} predicts held-out blocks better than"
                f" {join_names(prediction.models[number].names)}, which is simpler and leaves"
                f" {two_digits(left)} times its error in whole unseen runs"
            )
            return prediction.exchanging(number)
    return prediction


def prune_by_other_runs(search: Search, prediction: Prediction) -> Prediction:
    """The prediction without effects beside which others do as well alone on other runs.

    What is left of laws that are only nearly right has the shape of some effect on the run that is
    fitted, and not on others. Where there is no other run, the blocks that were held out decide.
    """
    others = search.data_split.other_runs
    if not others:
        return prediction
    length = prediction.horizons.each[-1].length
    chosen = prediction.chosen
    after = float(squares_on(search, others, chosen.trials[-1], length).sum())
    for number in prediction.smaller():
        one = prediction.choosing(number)
        before = float(squares_on(search, others, one.chosen.trials[-1], length).sum())
        if one.choice.sure and 0 < before < np.inf and not after < before:
            more, known = join_names(chosen.names - one.chosen.names), join_names(one.chosen.names)
            search.words.append(
                f"{more} is not named beside {known}: on another run, in windows of {length}"
                f" samples, that multiplies the error by {(after / before) ** 0.5:.3g}"
            )
            return prune_by_other_runs(search, one)
    return prediction


def squares_of_both(
    search: Search, sections: Sequence[Section], fewer: Trial, more: Trial, length: int
) -> tuple[Vector, Vector]:
    """`squares_on` of two models, each of which begins a window also where the other one does."""
    windows = [w for section in sections for w in search.windows([section], length)]
    one, other = (search.problem.windows_on(trial, windows) for trial in (fewer, more))
    return restart_from_others(one, other).squares, restart_from_others(other, one).squares


def squares_on(search: Search, sections: Sequence[Section], trial: Trial, length: int) -> Vector:
    """The sum of squared residuals in sigma of each window of about so many samples, where only
    starts are fitted."""
    windows = [w for section in sections for w in search.windows([section], length)]
    return np.array([float(np.sum(r**2)) for r in search.problem.residuals_on(trial, windows)])


def _longest(sections: Sequence[Section]) -> int:
    """The samples of the longest section."""
    return max((section.count for section in sections), default=0)


def _count(sections: Sequence[Section]) -> int:
    """How many samples of all signals sections have."""
    return sum(s.count * len(s.measured.values) for s in sections)


def _tracked(search: Search, sections: Sequence[Section]) -> float:
    """The sum of squared residuals, in sigma, below which a whole run has not lost track of the
    data: a part of the sum of squares of the measured signals about their means."""
    sigma = search.problem.sigma
    return search.options.tracked**2 * sum(
        float(np.var(values[section.first : section.end])) * section.count
        / sigma[name] ** 2
        for section in sections
        for name, values in section.measured.values.items()
    )  # fmt: skip


def join_names(names: Iterable[str]) -> str:
    """Effects in words."""
    return " and ".join(sorted(names))


def model_with(names: Iterable[str]) -> str:
    """The diagram with some effects, or with none, in words."""
    joined = join_names(names)
    return f"a model with {joined}" if joined else "the declared model"
