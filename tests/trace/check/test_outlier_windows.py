"""Windows that are far from all others do not lead a declared fit astray."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from oracles.oscillator import STIFFNESS, problem_of, record
from tracewire.residual import Measured, Segment
from tracewire.residual.windows import Section, cut_windows
from tracewire.trace.check.outlier_windows import fit_without_outliers
from tracewire.trace.trials.trial import TraceProblem, Trial

LENGTH = 25
WRONG = (100, 200, 300)
"""Samples from which on a window's worth of data is of something else."""


def kicked(law: Callable[[float, float], float] | None = None) -> Measured:
    """A record with three stretches that no oscillator gives, a thousand times the noise."""
    m = record(law)
    x = m.values["x"].copy()
    for first in WRONG:
        x[first : first + LENGTH] += np.sign(np.sin(3.0 * np.arange(LENGTH)))
    return replace(m, values={"x": x})


def begun(problem: TraceProblem, measured: Measured) -> tuple[list[Segment], Trial]:
    segments = cut_windows(
        problem.declared, Section(measured, 0, len(measured.t)), LENGTH, problem.states
    )
    return segments, problem.fit((), segments, LENGTH, {"k": 60.0}, steps=1)


def test_a_fit_is_led_by_the_windows_that_are_alike() -> None:
    m = kicked(lambda x, v: -0.3 * v * abs(v))
    problem = problem_of(m)
    segments, first = begun(problem, m)
    found = fit_without_outliers(problem, first, segments, 5)
    left_out = [
        s for s in segments if not any(s.rows[0] == k.rows[0] for k in found.windows.segments)
    ]
    assert 3 <= len(left_out) <= 6
    assert all(min(abs(int(s.rows[0]) - first) for first in WRONG) <= LENGTH for s in left_out)
    assert found.reduced_chi2 < first.reduced_chi2 / 100
    assert found.values["k"] == pytest.approx(STIFFNESS, rel=0.02)


def test_what_shows_in_a_few_windows_alone_is_not_left_out() -> None:
    m = kicked()
    problem = problem_of(m)
    segments, first = begun(problem, m)
    found = fit_without_outliers(problem, first, segments, 5)
    assert len(found.windows.segments) == len(segments)
    assert found.reduced_chi2 > 1000


def test_windows_that_are_all_alike_stay() -> None:
    m = record(lambda x, v: -0.3 * v * abs(v))
    problem = problem_of(m)
    segments, first = begun(problem, m)
    assert fit_without_outliers(problem, first, segments, 5) is first


def test_a_fit_that_cannot_reach_its_target_ends_early() -> None:
    m = record(lambda x, v: -30.0 * np.sign(x) * (abs(x) > 0.5))
    problem = problem_of(m)
    length, start = 60, {"k": 6.0, "c": 1.9}
    segments = cut_windows(problem.declared, Section(m, 0, len(m.t)), length, problem.states)
    free = problem.fit((), segments, length, start)
    ended = problem.fit((), segments, length, start, target=free.rss / 100)
    reached = problem.fit((), segments, length, start, target=2 * free.rss)
    assert free.converged and not ended.converged
    assert ended.windows.criterion.runs < free.windows.criterion.runs
    assert reached.rss == free.rss
