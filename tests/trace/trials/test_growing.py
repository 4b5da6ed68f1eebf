"""Fits of long runs that are followed from their begin."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from oracles.oscillator import problem_of, record, trial_of
from tracewire.residual import is_out_of_step
from tracewire.residual.windows import Section, cut_windows
from tracewire.trace.trials.growing import follow_further


def test_a_run_over_gaps_is_followed_from_short_windows_to_its_end() -> None:
    """Between its four pieces it swings twelve times: a fit of all at once ends in the next
    minimum, where a number of swings is wrong."""
    swing = record(end=60.0, damping=0.01)
    kept = np.concatenate([np.arange(first, first + 60) for first in (0, 600, 1200, 1900)])
    pieces = replace(swing, t=swing.t[kept], values={"x": swing.values["x"][kept]})
    problem = problem_of(pieces)
    short = trial_of(problem, length=30)
    whole = cut_windows(problem.declared, Section(pieces, 0, 240), 240, problem.states)
    astray = problem.fit((), whole, 240, {})
    assert is_out_of_step(astray.windows, 0.15) and not is_out_of_step(short.windows, 0.15)
    found = follow_further(problem, short, astray, whole)
    assert found.values == pytest.approx({"k": 25.0, "c": 0.01}, rel=1e-2)
    assert found.reduced_chi2 == pytest.approx(1.0, abs=0.25)
    assert found.length == astray.length and len(found.windows.segments) == 1


def test_what_is_no_better_is_left() -> None:
    swing = record(end=12.0)
    problem = problem_of(swing)
    whole = cut_windows(problem.declared, Section(swing, 0, 400), 400, problem.states)
    right = trial_of(problem, length=400)
    found = follow_further(problem, trial_of(problem, length=60), right, whole)
    assert found.rss <= right.rss and found.values == pytest.approx(right.values, rel=1e-3)
