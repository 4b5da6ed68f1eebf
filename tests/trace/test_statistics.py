"""Effective sample sizes and scores on made-up numbers."""

from __future__ import annotations

import numpy as np
import pytest
from tracewire.trace.statistics import Screen, bic, effective_part

RANDOM = np.random.default_rng(7)


def test_white_residuals_count_fully_and_slow_ones_by_their_half_waves() -> None:
    white = RANDOM.normal(size=(5000, 1))
    assert effective_part([white]) == pytest.approx(1.0, abs=0.05)
    t = np.arange(0, 100, 0.01)
    wave = np.sin(2 * np.pi * t)[:, None]
    assert effective_part([wave]) * len(t) == pytest.approx(2 * 2 * 100, rel=0.05)


def test_bic_prefers_the_smaller_model_where_the_larger_gains_nothing() -> None:
    assert bic(100.0, 100, 1.0, 2) < bic(100.0, 100, 1.0, 3)
    assert bic(50.0, 100, 1.0, 3) < bic(100.0, 100, 1.0, 2)


def screen() -> tuple[Screen, dict[str, np.ndarray]]:
    n = 2000
    known = RANDOM.normal(size=(n, 2))
    columns = {"true": RANDOM.normal(size=n), "other": RANDOM.normal(size=n)}
    columns["alias"] = columns["true"] + 1e-3 * RANDOM.normal(size=n)
    columns["absorbed"] = known @ np.array([1.0, -2.0])
    residual = known @ np.array([0.3, 0.1]) - 0.5 * columns["true"] + RANDOM.normal(size=n)
    return Screen(residual, known, columns, 1.0), columns


def test_the_score_finds_the_column_and_its_coefficient() -> None:
    tested, _ = screen()
    score = tested.score(["true"])
    assert score.values[0] == pytest.approx(0.5, abs=0.1)
    assert score.gain > 100 > 5 > tested.score(["other"]).gain


def test_what_the_unknowns_imitate_has_no_gain() -> None:
    tested, _ = screen()
    score = tested.score(["absorbed"])
    assert score.gain == -np.inf
    assert score.masked[0] == pytest.approx(1.0)


def test_columns_that_the_data_cannot_tell_apart_are_alike() -> None:
    tested, _ = screen()
    assert tested.likeness("true", "alias") > 0.999
    assert tested.likeness("true", "other") < 0.1
