"""What models predict on blocks that their fits did not see."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from oracles.oscillator import DIAGRAM, NOISE, candidates_of, problem_of, record
from tracewire.residual.windows import Section
from tracewire.trace.choose.heldout import Finalist, errors_held_out, errors_in_sample
from tracewire.trace.choose.horizons import Horizons, horizons_of
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import TraceProblem

OPTIONS = TraceOptions()


def coulomb(x: float, v: float) -> float:
    return -0.4 * np.tanh(v / 0.01)


def horizons(problem: TraceProblem, gate: bool = False) -> Horizons:
    sections, judging = (
        [Section(m, 0, len(m.t)) for m in problem.measured if m.use == use]
        for use in ("train", "gate")
    )
    return horizons_of(problem.declared, sections, judging, problem.states, problem.sigma, OPTIONS)


def fitted(problem: TraceProblem, at: Horizons, *effects: PlacedEffect) -> Finalist:
    return Finalist(tuple(problem.fit(effects, list(h.segments), h.length, {}) for h in at.each))


def added(problem: TraceProblem, name: str, **values: float) -> PlacedEffect:
    return PlacedEffect(candidates_of(problem)[f"{name} @ force"], values)


@pytest.fixture(scope="module")
def dry() -> TraceProblem:
    return problem_of(
        record(coulomb, end=24.0), replace(record(coulomb, end=12.0, seed=3), use="gate")
    )


def test_white_noise_is_predicted_as_well_as_it_is() -> None:
    problem = problem_of(record(end=24.0))
    at = horizons(problem)
    errors = errors_held_out(problem, fitted(problem, at), at, OPTIONS)
    assert errors.shape == (2, 2, at.count, 1)
    assert errors[:, 0].mean() == pytest.approx(1.0, abs=0.15)
    assert errors[:, 1].mean() == pytest.approx(1.0, abs=0.25), "thirds have to extrapolate"


def test_a_start_that_is_forgotten_is_not_told_by_later_rows() -> None:
    text = DIAGRAM.replace("value: 0.3, unit: 1/s, fit: [0, 2]", "value: 3, unit: 1/s, fit: [0, 9]")
    problem = problem_of(record(end=24.0, damping=4.0), text=text)
    at = horizons(problem)
    errors = errors_held_out(problem, fitted(problem, at), at, OPTIONS)
    assert errors.max() < 3.0


def test_unseen_blocks_are_predicted_worse_than_fitted_ones(dry: TraceProblem) -> None:
    at = horizons(dry)
    model = fitted(dry, at, added(dry, "viscous_drift", c=0.01))
    inside = errors_in_sample(model, at).mean()
    assert errors_held_out(dry, model, at, OPTIONS)[:, 1, : at.fitted].mean() > inside


def test_the_true_effect_predicts_what_the_declared_model_does_not(dry: TraceProblem) -> None:
    at = horizons(dry)
    before = errors_held_out(dry, fitted(dry, at), at, OPTIONS)
    after = errors_held_out(dry, fitted(dry, at, added(dry, "coulomb", level=0.3)), at, OPTIONS)
    assert before.shape[2] > at.fitted, "the series that judges has blocks, too"
    assert before[-1].mean() > 50 * after[-1].mean()
    assert before[-1, :, at.fitted :].mean() > 50 * after[-1, :, at.fitted :].mean()


def test_one_step_from_the_whole_fit_is_as_good_as_a_refit(dry: TraceProblem) -> None:
    at = horizons(dry)
    model = fitted(dry, at)
    quick = errors_held_out(dry, model, at, OPTIONS)[:, 0]
    # the same scattered blocks as the second family, which is refitted
    swapped = replace(at, folds=(at.folds[0], at.folds[0]))
    refitted = errors_held_out(dry, model, swapped, OPTIONS)[:, 1]
    assert quick == pytest.approx(refitted, rel=0.05)


def test_a_term_at_zero_takes_no_number() -> None:
    problem = problem_of(record(coulomb, damping=0.0, end=24.0))
    at = horizons(problem)
    model = fitted(problem, at, added(problem, "coulomb", level=0.3))
    free = len(model.trials[0].windows.values)
    assert model.numbers == free - len(model.vanished)
    assert NOISE > 0 and set(model.vanished) <= {"c"}
