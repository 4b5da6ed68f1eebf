"""Effective sample sizes, scores and chances on made-up numbers."""

from __future__ import annotations

import numpy as np
import pytest
from tracewire.trace.trials.statistics import (
    CandidateColumns,
    bic,
    effective_fraction,
    errors_behind,
)


def test_white_residuals_count_fully_and_slow_ones_by_their_half_waves() -> None:
    white = np.random.default_rng(7).normal(size=(5000, 1))
    assert effective_fraction([white]) == pytest.approx(1.0, abs=0.05)
    t = np.arange(0, 100, 0.01)
    wave = np.sin(2 * np.pi * t)[:, None]
    assert effective_fraction([wave]) * len(t) == pytest.approx(2 * 2 * 100, rel=0.05)


def test_the_step_from_one_window_to_the_next_is_no_correlation() -> None:
    rng = np.random.default_rng(8)
    levels = [np.full((2, 1), value) for value in rng.normal(size=50)]
    assert effective_fraction(levels) < 0.8, "inside a window the two samples are the same"
    assert effective_fraction([level[:1] for level in levels]) == 1.0


def test_bic_prefers_the_smaller_model_where_the_larger_gains_nothing() -> None:
    assert bic(100.0, 100, 1.0, 2) < bic(100.0, 100, 1.0, 3)
    assert bic(50.0, 100, 1.0, 3) < bic(100.0, 100, 1.0, 2)


def test_a_fall_counts_less_where_fewer_residuals_are_independent() -> None:
    fall = bic(100.0, 1000, 1.0, 2) - bic(90.0, 1000, 1.0, 2)
    assert bic(100.0, 1000, 0.1, 2) - bic(90.0, 1000, 0.1, 2) == pytest.approx(fall / 10)


def test_a_model_is_behind_by_half_the_root_of_what_it_leaves_more_in_white_noise() -> None:
    rng = np.random.default_rng(9)
    law = 0.2 * np.sin(np.linspace(0, 300, 2000))[:, None]
    behind = []
    for _ in range(50):
        noise = rng.normal(size=(2000, 1))
        behind.append(errors_behind([noise[:900], noise[900:]], [noise + law], 20))
    assert np.median(behind) == pytest.approx(np.sum(law**2) ** 0.5 / 2, rel=0.25)


def test_what_one_block_of_time_says_against_a_model_is_not_sure() -> None:
    best = np.ones((1000, 1))
    other = best.copy()
    other[300:350] = 20.0
    assert errors_behind([best], [other], 10) == pytest.approx(1.0, abs=0.1)


N = 2000
TRUE, OTHER, ALIAS, ABSORBED = range(4)


def made() -> CandidateColumns:
    """Four columns: of the effect, another, one just like it, one that the unknowns imitate."""
    rng = np.random.default_rng(9)
    matrix = rng.normal(size=(N, 4))
    matrix[:, ALIAS] = matrix[:, TRUE] + 1e-3 * rng.normal(size=N)
    residual = -0.5 * matrix[:, TRUE] + rng.normal(size=N)
    return CandidateColumns(residual, matrix, np.array([0.0, 0.0, 0.0, 1.0]), 1.0, N)


def test_the_score_finds_the_column_and_its_coefficient() -> None:
    tested = made()
    fall, values = tested.score([TRUE])
    assert values[0] == pytest.approx(0.5, abs=0.1)
    assert tested.gain(fall, 1) > 100 > 5 > tested.gain(tested.score([OTHER])[0], 1)


def test_what_the_unknowns_imitate_has_no_score() -> None:
    fall, values = made().score([ABSORBED])
    assert (fall, values.tolist()) == (0.0, [0.0])


def test_the_gain_is_half_the_fall_of_bic() -> None:
    tested = made()
    fall, _ = tested.score([TRUE])
    expected = bic(tested.rss, N, 1.0, 2) - bic(tested.rss - fall, N, 1.0, 3)
    assert tested.gain(fall, 1) == pytest.approx(expected / 2)


def test_columns_that_the_data_cannot_tell_apart_are_alike() -> None:
    tested = made()
    assert tested.canonical_correlation([TRUE], [ALIAS]) > 0.999
    assert tested.canonical_correlation([TRUE], [OTHER]) < 0.1
    assert tested.canonical_correlation([TRUE, OTHER], [OTHER]) == pytest.approx(1.0), (
        "one spans the other"
    )


def chance_of(seed: int, effect: float = 0.0, signs: tuple[int, ...] = (0,) * 20) -> float:
    rng = np.random.default_rng(seed)
    matrix = rng.normal(size=(500, 20))
    columns = CandidateColumns(
        rng.normal(size=500) - effect * matrix[:, 3], matrix, np.zeros(20), 1.0, 500
    )
    groups = [(n,) for n in range(20)]
    best = max(columns.score(group)[0] for group in groups)
    return columns.p_value(groups, signs, best)


def test_the_best_of_many_columns_on_noise_is_no_surprise() -> None:
    chances = [chance_of(seed) for seed in range(40)]
    assert np.mean(np.array(chances) < 0.1) < 0.25
    assert 0.3 < np.mean(chances) < 0.7, "spread evenly, as probabilities are"


def test_an_effect_is_not_left_to_chance() -> None:
    assert chance_of(1, effect=0.4) < 1e-6


def test_a_column_whose_sign_is_known_has_half_the_chance() -> None:
    free, known = chance_of(3), chance_of(3, signs=(1,) * 20)
    assert 0.3 * free < known < 0.8 * free
