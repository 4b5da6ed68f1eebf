"""The screen on records with a known effect: what it promises, and what it proposes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from oracles.oscillator import candidates_of, problem_of, record, trial_of
from tracewire.trace.candidates.places import find_places
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.screening import Screen, screen_candidates
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.trials.placed_effect import PlacedEffect

OPTIONS = TraceOptions()

NAMES = (
    "bias @ force", "coulomb @ force", "quad_drag @ force", "cubic_stiffness @ force",
    "viscous @ force", "sensor_offset @ sensor.x", "sensor_quad @ sensor.x",
)  # fmt: skip


def screen_of(law: Callable[[float, float], float] | None = None) -> Screen:
    problem = problem_of(record(law))
    trial = trial_of(problem, length=40)
    candidates = candidates_of(problem)
    linearisation = TorqueLinearisation(
        trial.diagram, trial.windows, find_places(problem.declared), 1e-6, OPTIONS
    )
    return screen_candidates(linearisation, trial, [candidates[name] for name in NAMES])


def best(screen: Screen) -> list[str]:
    return [str(row.candidate) for row in screen.best()]


def test_a_small_effect_is_first_and_its_coefficient_nearly_known() -> None:
    screen = screen_of(lambda x, v: -0.1 * np.tanh(v / 1e-3))
    first = screen.best()[0]
    assert str(first.candidate) == "coulomb @ force"
    assert first.gain > 20
    assert screen.p_value() < 1e-6
    assert first.values["level"] == pytest.approx(0.7 * 0.1, rel=0.25), "a refit begins below it"


def test_on_noise_nothing_stands_out() -> None:
    assert screen_of().p_value() > 0.01


def test_what_a_declared_parameter_imitates_is_masked() -> None:
    screen = screen_of(lambda x, v: -0.1 * v)
    rows = {str(row.candidate): row for row in screen.rows}
    assert rows["viscous @ force"].absorbed_fraction == pytest.approx(1.0, abs=1e-3)
    assert rows["viscous @ force"].gain <= 0
    assert rows["bias @ force"].absorbed_fraction < 0.5


def test_an_effect_with_the_wrong_sign_is_not_possible() -> None:
    screen = screen_of(lambda x, v: 0.1 * np.tanh(v / 1e-3))
    assert "coulomb @ force" not in best(screen)


def test_a_refit_of_the_wrong_sign_begins_within_the_bounds_of_the_block() -> None:
    """The share of a drive that goes in steps is at most 1, whatever a screen asks for."""
    row = screen_of().best()[0]
    name, limits = row.candidate.parameter, row.candidate.limits
    bounded = replace(row.candidate, limits={**limits, name: (0.0, 1.0)})
    asked = replace(row, candidate=bounded, values={**row.values, name: -1e5})
    assert asked.placed_effect.coefficient == 1.0


def test_each_candidate_is_told_once_by_its_best_variant() -> None:
    screen = screen_of(lambda x, v: -0.1 * np.tanh(v / 1e-3))
    names = best(screen)
    assert len(set(names)) == len(names)
    widths = [row for row in screen.rows if str(row.candidate) == "coulomb @ force"]
    assert len(widths) > 1
    assert screen.best()[0].gain == max(row.gain for row in widths)


def test_two_effects_promise_more_together_than_each_alone() -> None:
    screen = screen_of(lambda x, v: -0.1 * np.tanh(v / 1e-3) + 0.4)
    pair = screen.pairs()[0]
    assert {str(row.candidate) for row in pair.rows} >= {"coulomb @ force"}
    assert {str(row.candidate) for row in pair.rows} & {"bias @ force", "sensor_offset @ sensor.x"}
    assert pair.gain > screen.best()[0].gain
    assert [type(row.placed_effect) for row in pair.rows] == [PlacedEffect, PlacedEffect]


def test_the_best_at_each_number_of_numbers_are_known() -> None:
    screen = screen_of(lambda x, v: -0.1 * np.tanh(v / 1e-3) + 0.4)
    found = screen.by_count(2)
    assert list(found) == sorted(found)
    assert all(len(same) <= 2 for same in found.values())
    assert all(p.count == count for count, same in found.items() for p in same)
    assert all(len(p.rows) == 1 for p in found[1]), "a pair takes two numbers at least"
    best = max((p for p in screen.pairs() if p.count == 2), key=lambda p: p.gain)
    assert found[2][0].gain >= best.gain


def test_a_free_phase_is_fitted_by_sine_and_cosine_together() -> None:
    problem = problem_of(record())
    waves = [c for name, c in candidates_of(problem).items() if name.startswith("harmonic @ force")]
    trial = trial_of(problem, length=40)
    linearisation = TorqueLinearisation(
        trial.diagram, trial.windows, find_places(problem.declared), 1e-6, OPTIONS
    )
    found = screen_candidates(linearisation, trial, waves)
    assert found.rows
    assert all(len(row.columns) == 2 for row in found.rows)
    for row in found.rows[:5]:
        _, (sine, cosine) = found.columns.score(row.columns)
        assert row.values["phase"] == pytest.approx(np.arctan2(cosine, sine))
        assert row.values["amplitude"] == pytest.approx(0.7 * np.hypot(sine, cosine))


def test_a_slim_screen_keeps_all_but_the_other_variants() -> None:
    """Best and visible effects, pairs, and what tells effects apart, in less memory."""
    screen = screen_of(lambda x, v: -0.1 * np.tanh(v / 1e-3) + 0.4)
    slim = screen.best_rows_only()
    assert slim.columns.matrix.shape[1] < screen.columns.matrix.shape[1]
    for whole, part in ((screen.best(), slim.best()), (screen.pairs(), slim.pairs())):
        assert [row.gain for row in part] == pytest.approx([row.gain for row in whole])
    assert list(slim.observable()) == list(screen.observable())
    one, other = (slim.best()[n] for n in (0, 1))
    told = {str(row.candidate): row.columns for row in screen.best()}
    assert slim.columns.canonical_correlation(one.columns, other.columns) == pytest.approx(
        screen.columns.canonical_correlation(told[str(one.candidate)], told[str(other.candidate)])
    )
