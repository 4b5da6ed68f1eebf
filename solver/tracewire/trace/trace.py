"""`trace`: fit, find the residual, try every effect at every place, accept only on unseen data."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from tracewire.compile import Model
from tracewire.errors import TracewireError
from tracewire.fit.fit import with_measured_signals
from tracewire.fit.measured import Measured, load_measured
from tracewire.fit.noise import channel_noise
from tracewire.fit.result import Fit
from tracewire.trace.account import compared, met, moved, rmse
from tracewire.trace.dependence import where_what
from tracewire.trace.experiment import separating
from tracewire.trace.finish import Final, finished
from tracewire.trace.force import forces
from tracewire.trace.found import Dependence, Experiment, Force, Found, Missing
from tracewire.trace.mistakes import refuse_mistakes
from tracewire.trace.places import find_places
from tracewire.trace.power import powers
from tracewire.trace.refusals import check_series, remarks
from tracewire.trace.search import Search
from tracewire.trace.spikes import without_spikes
from tracewire.trace.stretches import share_out, shortest_window
from tracewire.trace.tangent import Tangent
from tracewire.trace.telling import paragraph_of
from tracewire.trace.told import (
    confusable,
    edited,
    told_effects,
    told_steps,
    verdict_of,
)
from tracewire.trace.tolerance import refuse_loose
from tracewire.trace.trial import Bench, Trial

EXPERIMENTS = 2
SUSPICIOUS = 3.0


def trace(
    subject: Model | Fit,
    measured: Sequence[Measured] | None = None,
    *,
    rtol: float = 1e-6,
    progress: Callable[[str], None] | None = None,
) -> Found:
    """Trace the residual of a diagram on its measured series to an effect that it lacks.

    Every effect of the library is tried at every place, first by a score test on one linearisation,
    then the best, and pairs of them, by a refit in the loop, ranked by BIC. It is accepted only if
    it improves stretches that the fit did not see; the errors reported come from a third stretch.
    Ctrl-C ends it with what was found so far.

    Raises DataError where the series cannot be used, FitError where the model does not run, or
    where `rtol` is too loose for such small noise.
    """
    tell = progress or (lambda text: None)
    search = begun(subject, measured, rtol, tell)
    interrupted = False
    try:
        declared = search.declared()
        search.run(declared)
        final = finished(search, *search.standing)
        if final.best.effects:
            refuse_loose(search.bench, final.best)
        _refuse_mistakes(search, declared, final)
    except KeyboardInterrupt:
        if search.best is None:
            raise
        interrupted = True
        final = Final(*search.standing, {}, ())
    return _found(search, final, interrupted)


def _refuse_mistakes(search: Search, declared: Trial, final: Final) -> None:
    """Refuse records that a mistake explains better than what was found.

    Only where the noise is not reached, or where what was found may itself be a mistake: a sensor
    or a drive.
    """
    suspicious = any(e.candidate.place.kind != "sum" for e in final.best.effects)
    if suspicious or final.best.s2 > SUSPICIOUS:
        search.tell("looking for mistakes in the records")
        refuse_mistakes(
            search.bench.declared, search.bench.measured, declared.s2, search.bench.rtol
        )


def begun(
    subject: Model | Fit,
    measured: Sequence[Measured] | None,
    rtol: float,
    progress: Callable[[str], None],
) -> Search:
    """The search on a subject, ready to run."""
    values: dict[str, float] = {}
    if isinstance(subject, Fit):
        values = dict(subject.values)
        measured = subject.measured if measured is None else measured
        subject = subject.model
    model = with_measured_signals(subject, measured)
    series = tuple(load_measured(model) if measured is None else measured)
    check_series(model, series)
    sigma = channel_noise([m for m in series if m.use != "validate"])
    series = tuple(without_spikes(m, sigma) for m in series)
    bench = Bench(model, series, sigma, rtol)
    stretches = share_out(series)
    words = [*remarks(series), *stretches.words]
    return Search(
        bench, stretches, find_places(model), shortest_window(stretches), values, progress, words
    )


def _found(search: Search, final: Final, interrupted: bool) -> Found:
    """The result of a search."""
    search.tell("checking on what played no part")
    final = replace(final, best=met(search, final.best))
    bench, declared, best = search.bench, final.declared, final.best
    gate = _gate(search, best)
    dependences: tuple[Dependence, ...] = ()
    missing: Missing | None = None
    before = verdict_of(declared, best, gate, (), returns=search.returns)
    if before == "unexplained" or best.s2 > 2:
        search.tell("where and on what the missing torque depends")
        dependences, missing = _dependence(search, declared)
        left, _ = _dependence(search, best) if best.effects else (dependences, None)
    else:
        left = ()
    verdict = verdict_of(declared, best, gate, left, returns=search.returns)
    parts = compared(search, declared, best)
    claimed = [part for part in parts if part.use == "validate"]
    values = {**best.values, **dict.fromkeys(final.dropped, 0.0)}
    sigma = dict(bench.sigma)
    units = dict(best.model.flat.units)
    units |= {name: p.unit for name, p in best.model.flat.parameters.items()}
    interval = float(np.median([np.median(np.diff(m.t)) for m in bench.measured]))
    found = Found(
        verdict=verdict,
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
        steps=told_steps(search, interval),
        power=powers(search.steps[-1].screen) if search.steps else (),
        dependences=dependences,
        missing=missing if verdict == "unexplained" else None,
        experiments=() if interrupted else _experiments(search, final),
        confusable=confusable(search),
        curves=tuple(curve for part in parts for curve in part.curves(sigma, units)),
        find_forces=partial(_forces, search, best),
        paragraph="",
        words=tuple(search.words),
        original=bench.declared.diagram,
        diagram=edited(bench.declared, best, values),
        units=units,
        interrupted=interrupted,
    )
    return replace(found, paragraph=paragraph_of(found))


def _gate(search: Search, best: Trial) -> float:
    """The squared residual per residual on windows that no fit saw, their starts counted."""
    windows = search.windows(search.stretches.gate, search.short)
    residuals = search.bench.on(best, windows)
    count = sum(r.size for r in residuals) - sum(len(w.free) for w in windows)
    return sum(float(np.sum(r**2)) for r in residuals) / max(count, 1)


def _dependence(search: Search, trial: Trial) -> tuple[tuple[Dependence, ...], Missing | None]:
    """The where/what map of a trial in short windows."""
    length = search.short
    short = search.bench.again(trial, search.windows(search.stretches.train, length), length)
    tangent = Tangent(short.diagram, short.windows, search.places, search.bench.rtol)
    return where_what(tangent, short, search.places)


def _experiments(search: Search, final: Final) -> tuple[Experiment, ...]:
    """What would separate the effects from their closest ties."""
    found = []
    for effect in final.best.effects:
        tied = [rival for rival in final.rivals.get(str(effect), ()) if rival.tied]
        for rival in tied[:EXPERIMENTS]:
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
    tangent = Tangent(best.diagram, windows, search.places, bench.rtol)
    return forces(tangent, best, bench.rtol)
