"""`trace`: fit, find the residual, try every effect at every place, accept only on unseen data."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from tracewire.compile import Model
from tracewire.errors import FitError, Problem, TracewireError
from tracewire.fit import Fit
from tracewire.residual import (
    InputCovariance,
    Measured,
    channel_noise,
    load_measured,
    with_measured_signals,
)
from tracewire.trace.candidates.places import find_places, untried
from tracewire.trace.check.mistakes import refuse_mistakes
from tracewire.trace.check.option_checks import check_options
from tracewire.trace.check.refusals import check_series, remarks
from tracewire.trace.check.spikes import without_spikes
from tracewire.trace.check.tolerance import is_loose, tightened
from tracewire.trace.choose.account import compared, met, moved, rmse
from tracewire.trace.choose.prediction import Prediction, predict
from tracewire.trace.choose.told import confusable, edited, told_effects, told_steps
from tracewire.trace.choose.verdict import (
    Judgement,
    is_at_noise,
    is_slow_noise,
    judge_at_noise,
    judge_prediction,
    raises_unseen,
    residual_map,
)
from tracewire.trace.experiment.experiment import separating
from tracewire.trace.experiment.power import powers
from tracewire.trace.found import Experiment, Force, Found
from tracewire.trace.missing.force import forces
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.tangent import Tangent
from tracewire.trace.search.finish import Final, finished
from tracewire.trace.search.search import Search
from tracewire.trace.trials.bounds import at_bounds
from tracewire.trace.trials.stretches import share_out, shortest_window
from tracewire.trace.trials.trial import Bench, Trial


def trace(
    subject: Model | Fit,
    measured: Sequence[Measured] | None = None,
    *,
    options: TraceOptions | None = None,
    rtol: float = 1e-6,
    progress: Callable[[str], None] | None = None,
) -> Found:
    """Trace the residual of a diagram on its measured series to an effect that it lacks.

    Every effect of the library is tried at every place, first by a score test on one linearisation,
    then the best, and pairs of them, by a refit in the loop, ranked by BIC. It is accepted only if
    it improves stretches that the fit did not see; the errors reported come from a third stretch.
    `options` says what is tried, and from when on an effect is believed.
    Ctrl-C ends it with what was found so far.

    Raises DataError where the series cannot be used, FitError where the model does not run, or
    where `rtol` is too loose for such small noise.
    """
    options = options or TraceOptions()
    tell = progress or (lambda text: None)
    search = begun(subject, measured, rtol, within(options.budget, tell), options)
    interrupted = False
    prediction: Prediction | None = None
    try:
        declared = _precise(search)
        search.run(declared)
        first, best = search.standing
        if is_at_noise(search, best) or is_slow_noise(search, best):
            judgement = judge_at_noise(search, finished(search, first, best))
        else:
            prediction = predict(search, first)
            judgement = judge_prediction(search, prediction)
        judgement = _checked(search, judgement)
        _refuse_mistakes(search, declared, judgement)
    except (KeyboardInterrupt, OutOfTime) as stopped:
        if search.best is None:
            raise
        interrupted = True
        if isinstance(stopped, OutOfTime):
            search.words.append(f"the search ended after its budget of {options.budget:g} s")
    search.tell = tell
    if interrupted:
        judgement = Judgement("unexplained", Final(*search.standing, {}, ()))
    return _found(search, judgement, prediction, interrupted)


class OutOfTime(FitError):
    """A search has taken longer than the user allows."""


def within(seconds: float, tell: Callable[[str], None]) -> Callable[[str], None]:
    """A `tell` that raises OutOfTime where it is called after so many seconds."""
    end = time.monotonic() + seconds

    def told(text: str) -> None:
        if time.monotonic() > end:
            what = f"the declared model was not fitted within the budget of {seconds:g} s"
            raise OutOfTime([Problem(what, hint="Give more with --budget.")])
        tell(text)

    return told


def _precise(search: Search) -> Trial:
    """The declared fit, with a tolerance at which the solver's error does not count."""
    declared = search.declared()
    for _ in range(search.options.check.tightened):
        if not is_loose(search.bench, declared):
            break
        _tighten(search)
        declared = search.declared()
    return declared


def _tighten(search: Search) -> None:
    search.bench = tightened(search.bench)
    search.words.append(
        f"the solver's error counted beside the residual: rtol is {search.bench.rtol:.0e} now"
    )


def _checked(search: Search, judgement: Judgement) -> Judgement:
    """The judgement where the solver is precise enough, and no effect raises the error on unseen
    data; without the effects where they do."""
    final = judgement.final
    for _ in range(search.options.check.tightened):
        if not (final.best.effects and is_loose(search.bench, final.best)):
            break
        _tighten(search)
        declared, best = (
            search.bench.again(trial, trial.windows.segments, trial.length)
            for trial in (final.declared, final.best)
        )
        final = replace(final, declared=declared, best=best)
    if final.best.effects:
        lengths = sorted({min(search.short, final.best.length), final.best.length})
        harm = raises_unseen(search, final, lengths)
        if harm:
            names = " and ".join(map(str, final.best.effects))
            search.words.append(f"{names} is not named: it {harm}")
            final = Final(final.declared, final.declared, {}, ())
            dependences, missing = residual_map(search, final.declared)
            return Judgement("unexplained", final, dependences, missing)
    return replace(judgement, final=final)


def _refuse_mistakes(search: Search, declared: Trial, judgement: Judgement) -> None:
    """Refuse records that a mistake explains better than what was found.

    Only where no effect explains what is left far above the noise, or where what was found may
    itself be a mistake: a sensor or a drive.
    """
    best = judgement.final.best
    suspicious = any(e.candidate.place.kind != "sum" for e in best.effects)
    if suspicious or (
        judgement.verdict == "unexplained" and best.s2 > search.options.check.suspicious
    ):
        search.tell("looking for mistakes in the records")
        bench, options = search.bench, search.options.check
        refuse_mistakes(bench.declared, bench.measured, options, declared.s2, bench.rtol)


def begun(
    subject: Model | Fit,
    measured: Sequence[Measured] | None,
    rtol: float,
    progress: Callable[[str], None],
    options: TraceOptions,
) -> Search:
    """The search on a subject, ready to run."""
    values: dict[str, float] = {}
    if isinstance(subject, Fit):
        values = dict(subject.values)
        measured = subject.measured if measured is None else measured
        subject = subject.model
    model = with_measured_signals(subject, measured)
    series = tuple(load_measured(model) if measured is None else measured)
    check_series(model, series, options.check)
    check_options(options, model)
    sigma = channel_noise([m for m in series if m.use != "validate"])
    series = tuple(without_spikes(m, sigma, options.check) for m in series)
    stretches = share_out(series, options.split)
    shortest = shortest_window(stretches, options.split)
    inputs = InputCovariance(sigma, model, series, shortest)
    bench = Bench(model, series, sigma, rtol, inputs, options)
    places = find_places(model)
    words = [*remarks(series, options.check), *stretches.words]
    words += untried(model.diagram, [place for place in places if place.q])
    return Search(
        bench,
        stretches,
        places,
        shortest,
        values,
        progress,
        words,
    )


def _found(
    search: Search, judgement: Judgement, prediction: Prediction | None, interrupted: bool
) -> Found:
    """The result of a search."""
    search.tell("checking on what played no part")
    final = judgement.final
    final = replace(final, best=met(search, final.best))
    bench, declared, best = search.bench, final.declared, final.best
    search.words += dict.fromkeys(one.words for t in (declared, best) for one in at_bounds(t))
    parts = compared(search, declared, best)
    claimed = [part for part in parts if part.use == "validate"]
    values = {**best.values, **dict.fromkeys(final.dropped, 0.0)}
    sigma = dict(bench.sigma)
    units = dict(best.model.flat.units)
    units |= {name: p.unit for name, p in best.model.flat.parameters.items()}
    interval = float(np.median([np.median(np.diff(m.t)) for m in bench.measured]))
    return Found(
        verdict=judgement.verdict,
        effects=told_effects(search, final),
        dropped=final.dropped,
        values=values,
        declared=declared.values,
        rmse_before=rmse(claimed, 0),
        rmse_after=rmse(claimed, 1),
        sigma=sigma,
        s2_before=declared.s2,
        s2_after=best.s2,
        moved=tuple(moved(bench, declared, best, values)) if best.effects else (),
        errors=tuple(error for part in parts for error in part.errors(sigma, units)),
        steps=(*told_steps(search, interval), *([prediction.told()] if prediction else [])),
        power=powers(search.steps[-1].screen) if search.steps else (),
        dependences=judgement.dependences,
        missing=judgement.missing,
        experiments=() if interrupted else _experiments(search, final),
        confusable=confusable(search),
        curves=tuple(curve for part in parts for curve in part.curves(sigma, units)),
        find_forces=partial(_forces, search, best),
        words=tuple(search.words),
        original=bench.declared.diagram,
        diagram=edited(bench.declared, best, values),
        units=units,
        interrupted=interrupted,
        options=search.options,
        explained=judgement.explained,
        remainder=judgement.remainder,
        remainder_depends=judgement.remainder_depends,
        held_out=judgement.held_out,
    )


def _experiments(search: Search, final: Final) -> tuple[Experiment, ...]:
    """What would separate the effects from their closest ties."""
    found = []
    for effect in final.best.effects:
        tied = [rival for rival in final.rivals.get(str(effect), ()) if rival.tied]
        for rival in tied[: search.options.experiment.tied]:
            search.tell(f"an experiment to tell {effect} from {rival.added}")
            try:
                found.append(
                    separating(search.bench, final.best, rival.trial, str(effect), str(rival.added))
                )
            except TracewireError as error:
                search.words.append(error.problems[0].what)
    return tuple(found)


def _forces(search: Search, best: Trial) -> tuple[Force, ...]:
    """The restoring-force picture of the places that got an effect."""
    if not any(effect.candidate.block for effect in best.effects) or not search.steps:
        return ()
    bench = search.bench
    windows = bench.settled(best, search.windows(search.stretches.train, search.short))
    tangent = Tangent(best.diagram, windows, search.places, bench.rtol, search.options)
    fitted = Tangent(best.diagram, best.windows, search.places, bench.rtol, search.options)
    return forces(tangent, best, bench.rtol, fitted)
