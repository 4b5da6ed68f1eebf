"""From a finished search to the result of a trace."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from tracewire.diagram import Diagram
from tracewire.errors import TracewireError
from tracewire.trace.choose.prediction import Prediction
from tracewire.trace.choose.verdict import Judgement
from tracewire.trace.experiment.experiment import separating
from tracewire.trace.experiment.power import powers
from tracewire.trace.found import Experiment, Force, Found
from tracewire.trace.missing.force import forces
from tracewire.trace.results.account import compared, met, moved, rmse
from tracewire.trace.results.told import confusable, edited, told_effects, told_steps
from tracewire.trace.screen.tangent import Tangent
from tracewire.trace.search.finish import Final
from tracewire.trace.search.search import Search
from tracewire.trace.trials.bounds import at_bounds
from tracewire.trace.trials.trial import Trial


def result_of(
    search: Search, judgement: Judgement, prediction: Prediction | None, interrupted: bool
) -> Found:
    """The result of a search."""
    search.tell("checking on what played no part")
    final = judgement.final
    final = replace(final, best=met(search, final.best))
    bench, declared, best = search.bench, final.declared, final.best
    bounds = (one for t in (declared, best) for one in at_bounds(t))
    search.words += dict.fromkeys(one.words for one in bounds if not one.exact)
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
        diagram=edited(bench.declared, best.effects, values),
        units=units,
        interrupted=interrupted,
        options=search.options,
        explained=judgement.explained,
        remainder=judgement.remainder,
        remainder_depends=judgement.remainder_depends,
        held_out=judgement.held_out,
        noisy_inputs=judgement.noisy_inputs,
        find_diagram=partial(_with_some, search, final, values),
    )


def _with_some(
    search: Search, final: Final, values: Mapping[str, float], effects: Collection[str]
) -> Diagram:
    """The diagram with some of the effects, by their texts. A parameter that was dropped has its
    declared value: the effect that stands for it may be among those left out."""
    told = zip(final.best.effects, told_effects(search, final), strict=True)
    kept = [added for added, effect in told if str(effect) in effects]
    restored = {name: final.declared.values[name] for name in final.dropped}
    return edited(search.bench.declared, kept, {**values, **restored})


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
