"""From a finished search to the result of a trace."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from tracewire.blas import one_blas_thread
from tracewire.diagram import Diagram
from tracewire.errors import TracewireError
from tracewire.fit import describe_undetermined
from tracewire.trace.choose.prediction import Prediction
from tracewire.trace.choose.verdict import Judgement
from tracewire.trace.experiment.experiment import design_experiment
from tracewire.trace.experiment.power import detection_limits
from tracewire.trace.found import Experiment, Force, Found
from tracewire.trace.missing.restoring_force import restoring_forces
from tracewire.trace.results.build import (
    build_effects,
    build_steps,
    candidate_correlations,
    edit_diagram,
)
from tracewire.trace.results.comparison import (
    compare_models,
    parameter_changes,
    rmse,
    with_unseen_phases,
)
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.search.refinement import FinalModels
from tracewire.trace.search.search import Search
from tracewire.trace.trials.bounds import at_bounds
from tracewire.trace.trials.trial import Trial


def result_of(
    search: Search, judgement: Judgement, prediction: Prediction | None, interrupted: bool
) -> Found:
    """The result of a search."""
    search.tell("checking on what played no part")
    final = judgement.final
    final = replace(final, best=with_unseen_phases(search, final.best))
    problem, declared, best = search.problem, final.declared, final.best
    bounds = (one for t in (declared, best) for one in at_bounds(t))
    search.words += dict.fromkeys(one.words for one in bounds if not one.exact)
    search.words += [w for w in describe_undetermined(best.windows) if w not in search.words]
    parts = compare_models(search, declared, best)
    claimed = [part for part in parts if part.use == "validate"]
    values = {**best.values, **dict.fromkeys(final.dropped, 0.0)}
    sigma = dict(problem.sigma)
    units = dict(best.model.flat.units)
    units |= {name: p.unit for name, p in best.model.flat.parameters.items()}
    interval = float(np.median([np.median(np.diff(m.t)) for m in problem.measured]))
    return Found(
        verdict=judgement.verdict,
        effects=build_effects(search, final),
        dropped=final.dropped,
        values=values,
        declared=declared.values,
        rmse_before=rmse(claimed, 0),
        rmse_after=rmse(claimed, 1),
        sigma=sigma,
        s2_before=declared.reduced_chi2,
        s2_after=best.reduced_chi2,
        moved=tuple(parameter_changes(problem, declared, best, values)) if best.effects else (),
        errors=tuple(error for part in parts for error in part.errors(sigma, units)),
        steps=(*build_steps(search, interval), *([prediction.as_step()] if prediction else [])),
        power=detection_limits(search.steps[-1].screen) if search.steps else (),
        dependences=judgement.dependences,
        missing=judgement.missing,
        experiments=() if interrupted else _find_experiments(search, final),
        confusable=candidate_correlations(search),
        curves=tuple(curve for part in parts for curve in part.curves(sigma, units)),
        find_forces=partial(_find_forces, search, best),
        words=tuple(search.words),
        original=problem.declared.diagram,
        diagram=(
            edit_diagram(problem.declared, best.effects, values)
            if judgement.verdict == "effect" or interrupted
            else problem.declared.diagram  # an approximation is told, and written where one asks
        ),
        units=units,
        interrupted=interrupted,
        options=search.options,
        explained=judgement.explained,
        remainder=judgement.remainder,
        remainder_depends=judgement.remainder_depends,
        held_out=judgement.held_out,
        noisy_inputs=judgement.noisy_inputs,
        reason=judgement.reason,
        find_diagram=partial(_apply_some, search, final, values),
    )


def _apply_some(
    search: Search, final: FinalModels, values: Mapping[str, float], effects: Collection[str]
) -> Diagram:
    """The diagram with some of the effects, by their texts. Where some are left out, a parameter
    that was dropped has its declared value: the effect that stands for it may be among them."""
    pairs = zip(final.best.effects, build_effects(search, final), strict=True)
    kept = [added for added, effect in pairs if str(effect) in effects]
    left_out = final.dropped if len(kept) < len(final.best.effects) else ()
    restored = {name: final.declared.values[name] for name in left_out}
    return edit_diagram(search.problem.declared, kept, {**values, **restored})


def _find_experiments(search: Search, final: FinalModels) -> tuple[Experiment, ...]:
    """What would separate the effects from their closest ties."""
    found = []
    for effect in final.best.effects:
        tied = [rival for rival in final.rivals.get(str(effect), ()) if rival.tied]
        for rival in tied[: search.options.experiment.tied]:
            search.tell(f"an experiment to tell {effect} from {rival.effect}")
            try:
                found.append(
                    design_experiment(
                        search.problem, final.best, rival.trial, str(effect), str(rival.effect)
                    )
                )
            except TracewireError as error:
                search.words.append(error.problems[0].what)
    return tuple(found)


@one_blas_thread()
def _find_forces(search: Search, best: Trial) -> tuple[Force, ...]:
    """The restoring-force picture of the places that got an effect."""
    if not any(effect.candidate.block for effect in best.effects) or not search.steps:
        return ()
    problem = search.problem
    windows = problem.windows_on(best, search.windows(search.data_split.train, search.short_length))
    linearisation = TorqueLinearisation(
        best.diagram, windows, search.places, problem.rtol, search.options
    )
    fitted = TorqueLinearisation(
        best.diagram, best.windows, search.places, problem.rtol, search.options
    )
    return restoring_forces(linearisation, best, problem.rtol, fitted)
