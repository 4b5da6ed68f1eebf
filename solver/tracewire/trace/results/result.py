"""From a finished search to the result of a trace: effects, ties, steps, and the edited diagram."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from tracewire.array_types import Matrix
from tracewire.blas import one_blas_thread
from tracewire.compile import Model
from tracewire.diagram import Diagram, SetValues, patch
from tracewire.errors import TracewireError
from tracewire.fit import describe_undetermined
from tracewire.formula import two_digits
from tracewire.library import SENSOR_TERMS
from tracewire.residual import is_of_sensor
from tracewire.trace.candidates.changes import changes_of
from tracewire.trace.choose.verdict import Judgement
from tracewire.trace.experiment.experiment import design_experiment
from tracewire.trace.experiment.power import detection_limits
from tracewire.trace.found import (
    CandidateScore,
    Experiment,
    Force,
    Found,
    FoundEffect,
    SearchStep,
    Tie,
)
from tracewire.trace.missing.restoring_force import restoring_forces
from tracewire.trace.options import TraceOptions
from tracewire.trace.results.comparison import (
    compare_models,
    on_equal_windows,
    parameter_changes,
    rmse,
    with_unseen_phases,
)
from tracewire.trace.results.held_inputs import describe_held_input
from tracewire.trace.results.intervals import reported_intervals
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.search.refinement import FinalModels, Rival, largest_first
from tracewire.trace.search.search import Search, Step
from tracewire.trace.trials.bounds import describe_bounds
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import Trial


def result_of(search: Search, judgement: Judgement) -> Found:
    """The result of a search."""
    search.tell("checking on what played no part")
    final, interrupted = judgement.final, judgement.interrupted
    final = final if interrupted else largest_first(search, final)
    final = replace(final, best=with_unseen_phases(search, final.best))
    problem, declared, best = search.problem, final.declared, final.best
    search.words += describe_bounds(declared, best)
    search.words += [w for w in describe_undetermined(best.windows) if w not in search.words]
    parts = compare_models(search, declared, best)
    claimed = [part for part in parts if part.use == "validate"]
    values = {**best.values, **dict.fromkeys(final.dropped, 0.0)}
    sigma = dict(problem.sigma)
    units = dict(best.model.flat.units)
    units |= {name: p.unit for name, p in best.model.flat.parameters.items()}
    interval = float(np.median([m.interval for m in problem.measured]))
    steps = [_step_of(step, interval, search.options.shown) for step in search.steps]
    if judgement.prediction is not None:
        steps.append(judgement.prediction.as_step())
    return Found(
        verdict=judgement.verdict,
        effects=_effects_of(search, final),
        dropped=final.dropped,
        values=values,
        declared=declared.values,
        rmse_before=rmse(claimed, 0),
        rmse_after=rmse(claimed, 1),
        sigma=sigma,
        s2_before=on_equal_windows(problem, declared, best).reduced_chi2,
        s2_after=best.reduced_chi2,
        moved=tuple(parameter_changes(problem, declared, best, values)),
        errors=tuple(error for part in parts for error in part.errors(sigma, units)),
        steps=tuple(steps),
        power=detection_limits(search.steps[-1].screen) if search.steps else (),
        dependences=judgement.dependences,
        missing=judgement.missing,
        experiments=() if interrupted else _find_experiments(search, final),
        confusable=_candidate_correlations(search),
        curves=tuple(curve for part in parts for curve in part.curves(sigma, units)),
        find_forces=partial(_find_forces, search, best),
        words=tuple(search.words),
        original=problem.declared.diagram,
        diagram=(
            _edit_diagram(problem.declared, best, best.effects, values)
            if judgement.verdict != "unexplained" or (interrupted and best.effects)
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


def _effects_of(search: Search, final: FinalModels) -> tuple[FoundEffect, ...]:
    """The effects of the result, the one that brings most first."""
    ends = reported_intervals(final.best, search.options) if final.best.effects else {}
    found = []
    for effect in final.best.effects:
        gain, masked, weight = _scores_of(search, effect)
        rivals = [r for r in final.rivals.get(str(effect), ()) if r.tied]
        parameters = _fitted_parameters(effect, final.best)
        found.append(
            FoundEffect(
                name=effect.candidate.effect,
                place=effect.candidate.place.name,
                params=parameters,
                ties=tuple(map(_tie_of, rivals)),
                block=effect.candidate.block,
                coefficient=effect.candidate.parameter,
                intervals={
                    name: ends[effect.unknown(name)]
                    for name in parameters
                    if effect.unknown(name) in ends
                },
                gain=gain,
                masked=masked,
                weight=weight,
                share=(share := final.shares.get(str(effect))),
                doubt=_doubt_of(search, effect, final.best)
                or _small_share(str(effect), share, search.options),
            )
        )
    return tuple(found)


def _doubt_of(search: Search, effect: PlacedEffect, best: Trial) -> str:
    """What else would look like a time, as of a delay, in a sensor or a drive."""
    candidate, parameters = effect.candidate, best.model.flat.parameters
    if candidate.place.kind == "sum":
        return ""
    known = parameters if candidate.block else SENSOR_TERMS
    name = candidate.coefficient if candidate.block else candidate.parameter
    if known[name].unit != "s":
        return ""
    value = _fitted_parameters(effect, best)[candidate.parameter]
    measured, options = search.problem.measured, search.options.check
    return describe_held_input(candidate.place.name, value, measured, options)


def _small_share(effect: str, share: float | None, options: TraceOptions) -> str:
    """In words, that an effect takes little beside the others; '' where it does not."""
    if share is None or share >= options.small_share:
        return ""
    return (
        f"{effect} takes {two_digits(100 * max(share, 0.0))} % of the squared error that was"
        " missing: so small a part may stand for another law, and other values then make up for it"
    )


def _tie_of(rival: Rival) -> Tie:
    """A rival as a tie of the result."""
    candidate = rival.effect.candidate
    return Tie(
        candidate.effect,
        candidate.place.name,
        rival.correlation,
        _fitted_parameters(rival.effect, rival.trial),
        rival.delta_bic,
    )


def _fitted_parameters(effect: PlacedEffect, trial: Trial) -> dict[str, float]:
    """The parameters of an effect that were fitted, or found by a scan."""
    fitted = {effect.unknown(name): effect.values[name] for name in effect.candidate.scanned}
    fitted |= {**trial.windows.criterion.parameters, **trial.values}
    return {
        name: fitted[effect.unknown(name)]
        for name in effect.values
        if effect.unknown(name) in fitted
    }


def _scores_of(search: Search, effect: PlacedEffect) -> tuple[float, float, float]:
    """The gain, the masked part and the weight of an effect in the step that found it."""
    for step in search.steps:
        rows = {str(row.candidate): row for row in step.screen.best()}
        for one in step.refits:
            if str(effect) in one.proposal.names and one.trial is step.after:
                row = rows.get(str(effect))
                return (
                    -one.delta_bic / 2,
                    row.absorbed_fraction if row else float("nan"),
                    one.weight,
                )
    return (float("nan"),) * 3


def _step_of(step: Step, interval: float, shown: int) -> SearchStep:
    """A step of the search; `interval` is the time in s between samples."""
    rows = [
        CandidateScore(
            " + ".join(one.proposal.names),
            one.proposal.gain,
            -one.delta_bic / 2,
            one.weight,
            max(row.absorbed_fraction for row in one.proposal.rows),
            one.trial.reduced_chi2,
            one.remark,
        )
        for one in step.refits
    ]
    seen = {row.effects for row in rows}
    for row in step.screen.best()[:shown]:
        if str(row.candidate) not in seen:
            rows.append(CandidateScore(str(row.candidate), row.gain, masked=row.absorbed_fraction))
    return SearchStep(
        step.before.length * interval,
        step.before.reduced_chi2,
        step.p_value,
        tuple(rows),
        step.words,
    )


def _candidate_correlations(search: Search) -> tuple[tuple[str, ...], Matrix]:
    """The best candidates of the first step, and the correlation of each two on the data."""
    if not search.steps:
        return (), np.zeros((0, 0))
    screen = search.steps[0].screen
    rows = screen.best()[: search.options.shown]
    matrix = np.eye(len(rows))
    for i, one in enumerate(rows):
        for j in range(i):
            matrix[i, j] = matrix[j, i] = screen.columns.canonical_correlation(
                one.columns, rows[j].columns
            )
    return tuple(str(row.candidate) for row in rows), matrix


def _edit_diagram(
    model: Model, best: Trial, effects: Sequence[PlacedEffect], values: Mapping[str, float]
) -> Diagram:
    """The original text with effects, if any, and with the refitted parameters."""
    chosen = [(effect.candidate, effect.values) for effect in effects]
    added = {effect.candidate.coefficient for effect in effects}
    kept = {
        name: value
        for name, value in values.items()
        if name in model.flat.parameters or (is_of_sensor(best.model, name) and name not in added)
    }
    return patch(model.diagram, [*changes_of(model.diagram, chosen), SetValues(kept)])


def _apply_some(
    search: Search, final: FinalModels, values: Mapping[str, float], effects: Collection[str]
) -> Diagram:
    """The diagram with some of the effects, by their texts. Where some are left out, a parameter
    that was dropped has its declared value: the effect that stands for it may be among them."""
    pairs = zip(final.best.effects, _effects_of(search, final), strict=True)
    kept = [added for added, effect in pairs if str(effect) in effects]
    left_out = final.dropped if len(kept) < len(final.best.effects) else ()
    restored = {name: final.declared.values[name] for name in left_out}
    return _edit_diagram(search.problem.declared, final.best, kept, {**values, **restored})


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
                        search.problem,
                        final.best,
                        rival.trial,
                        str(effect),
                        str(rival.effect),
                        search.has_revisits,
                    )
                )
            except TracewireError as error:
                search.words.append(error.problems[0].what)
    return tuple(found)


@one_blas_thread()
def _find_forces(search: Search, best: Trial) -> tuple[Force, ...]:
    """The restoring-force picture of the places that got an effect."""
    named = {effect.candidate.place.name for effect in best.effects}
    places = [place for place in search.places if place.name in named]
    if not any(place.kind == "sum" for place in places) or not search.steps:
        return ()
    problem = search.problem
    windows = problem.windows_on(best, search.windows(search.data_split.train, search.short_length))
    linearisation = TorqueLinearisation(best.diagram, windows, places, problem.rtol, search.options)
    fitted = TorqueLinearisation(best.diagram, best.windows, places, problem.rtol, search.options)
    return restoring_forces(linearisation, best, problem.rtol, fitted)
