"""How small an effect the data would show."""

from __future__ import annotations

import numpy as np
import pytest
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.places import Place
from tracewire.trace.experiment.power import detection_limits
from tracewire.trace.screen.screening import Screen, ScreenRow
from tracewire.trace.trials.statistics import CandidateColumns

RANDOM = np.random.default_rng(2)
N = 400


def screen(
    matrix: np.ndarray,
    groups: list[tuple[str, tuple[int, ...]]],
    masked: float,
    sigmas: float = 1.0,
    fraction: float = 1.0,
) -> Screen:
    place = Place("torque", "sum", "torque")
    rows = tuple(
        ScreenRow(
            Candidate(name, place, name, {}, f"{name}.level", 0),
            {},
            indices,
            0.0,
            0.0,
            {},
            0.0,
            True,
        )
        for name, indices in groups
    )
    hidden = np.full(matrix.shape[1], masked)
    residual = RANDOM.standard_normal(N)
    residual *= sigmas * np.sqrt(N) / np.linalg.norm(residual)
    columns = CandidateColumns(residual, matrix, hidden, fraction, N)
    return Screen(columns, rows, np.arange(N))


def test_the_smallest_coefficient_is_five_standard_errors() -> None:
    column = 3 * RANDOM.standard_normal((N, 1))
    (power,) = detection_limits(screen(column, [("bias", (0,))], 0.5))
    error = np.sqrt(np.linalg.inv(column.T @ column)[0, 0])
    assert power.smallest == pytest.approx(5 * error)
    assert (power.name, power.place, power.coefficient) == ("bias", "torque", "bias.level")


def test_what_is_left_above_the_noise_hides_more_and_the_more_the_slower_it_is() -> None:
    column = 3 * RANDOM.standard_normal((N, 1))
    limits = [
        detection_limits(screen(column, [("bias", (0,))], 0.5, sigmas, fraction))[0].smallest
        for sigmas, fraction in ((0.5, 1.0), (1.0, 1.0), (4.0, 1.0), (4.0, 0.25))
    ]
    assert limits == pytest.approx([limits[0] * factor for factor in (1, 1, 4, 8)])


def test_the_shape_that_shows_best_counts_and_the_phase_that_shows_least() -> None:
    matrix = RANDOM.standard_normal((N, 3)) * np.array([1.0, 4.0, 2.0])
    (shapes,) = detection_limits(screen(matrix, [("stribeck", (0,)), ("stribeck", (1,))], 0.0))
    assert shapes.smallest == pytest.approx(5 / np.linalg.norm(matrix[:, 1]))
    (phases,) = detection_limits(screen(matrix, [("harmonic", (1, 2))], 0.0))
    errors = np.linalg.inv(matrix[:, 1:].T @ matrix[:, 1:])
    assert phases.smallest == pytest.approx(5 * np.sqrt(np.linalg.eigvalsh(errors)[-1]))


def test_what_free_parameters_imitate_shows_at_no_size() -> None:
    assert detection_limits(screen(np.ones((N, 1)), [("viscous", (0,))], 1.0)) == ()
