"""From a finished search to the parts of its result: effects, ties, steps, verdict, and the edited
diagram."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.diagram import Diagram, SetValues, patch
from tracewire.residual import SENSED
from tracewire.trace.candidates.changes import changes_of
from tracewire.trace.found import CandidateScore, FoundEffect, SearchStep, Tie
from tracewire.trace.search.refinement import FinalModels, Rival
from tracewire.trace.search.search import Search, Step
from tracewire.trace.trials.intervals import intervals
from tracewire.trace.trials.trial import PlacedEffect, Trial

Matrix = NDArray[np.float64]


def build_effects(search: Search, final: FinalModels) -> tuple[FoundEffect, ...]:
    """The effects of the result, the one that brings most first."""
    ends = intervals(final.best, search.options.confidence) if final.best.effects else {}
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
                ties=tuple(map(tie_of, rivals)),
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
            )
        )
    return tuple(found)


def tie_of(rival: Rival) -> Tie:
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
    """The parameters of an effect that were fitted."""
    fitted = {**trial.windows.criterion.parameters, **trial.values}
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


def build_steps(search: Search, interval: float) -> tuple[SearchStep, ...]:
    """The steps of the search."""
    return tuple(_build_step(step, interval, search.options.shown) for step in search.steps)


def _build_step(step: Step, interval: float, shown: int) -> SearchStep:
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


def candidate_correlations(search: Search) -> tuple[tuple[str, ...], Matrix]:
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


def edit_diagram(
    model: Model, effects: Sequence[PlacedEffect], values: Mapping[str, float]
) -> Diagram:
    """The original text with effects and with the refitted parameters."""
    if not effects:
        return model.diagram
    chosen = [(effect.candidate, effect.values) for effect in effects]
    added = {effect.candidate.coefficient for effect in effects}
    kept = {
        name: value
        for name, value in values.items()
        if name in model.flat.parameters or (name.startswith(SENSED) and name not in added)
    }
    return patch(model.diagram, [*changes_of(model.diagram, chosen), SetValues(kept)])
