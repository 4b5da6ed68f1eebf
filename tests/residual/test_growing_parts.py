"""Long windows that begin a little wrong and lose track of their data."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import (
    Criterion,
    Measured,
    Section,
    Windows,
    cut_windows,
    evaluate_windows,
    fit_initial_states,
    follow_growing_parts,
    is_out_of_step,
)
from tracewire.solve import simulate

PENDULUM = """\
span: [0, 100]
blocks:
  q: {type: integrator, of: v, start: 2.6}
  v: {type: integrator, of: force}
  force: {type: expression, formula: -9 * sin(q)}
"""
SIGMA, PART = 1e-3, 0.15


def begun_at(amplitude: float) -> Windows:
    """One window over 30 swings of a pendulum from 2.6 rad, from a start at another amplitude."""
    model = compile(read_text(PENDULUM, Path("pendulum.yaml")), record=["q"])
    t = np.linspace(0, 100, 2001)
    noise = SIGMA * np.random.default_rng(5).standard_normal(len(t))
    measured = Measured(
        "run", "train", t, {"q": simulate(model, times=t, rtol=1e-10)["q"] + noise},
        start={"q": None, "v": None},
    )  # fmt: skip
    (whole,) = cut_windows(model, Section(measured, 0, len(t)), len(t), ("q", "v"))
    segment = replace(whole, start={"q": amplitude, "v": 0.0})
    criterion = Criterion(model, [segment], [], {}, 1e-8, {"q": SIGMA}, weighting="sum")
    return evaluate_windows(criterion)


def test_a_start_out_of_step_is_found_along_growing_parts() -> None:
    astray = fit_initial_states(begun_at(2.5))
    assert is_out_of_step(astray, PART)
    found = follow_growing_parts(astray, PART)
    assert not is_out_of_step(found, PART)
    assert found.rss / 2001 == pytest.approx(1, abs=0.1)
    assert found.starts[0]["q"] == pytest.approx(2.6, abs=1e-3)


def test_a_window_in_step_stays_as_it_is() -> None:
    right = fit_initial_states(begun_at(2.6))
    assert follow_growing_parts(right, PART).starts == right.starts


def test_a_model_that_follows_no_part_gets_no_other_start() -> None:
    begun = begun_at(2.5)
    (segment,) = begun.criterion.segments
    other = replace(segment.measured, values={"q": np.random.default_rng(6).normal(0, 1, 2001)})
    criterion = begun.criterion.on_segments([replace(segment, measured=other)])
    wrong = fit_initial_states(evaluate_windows(criterion))
    assert follow_growing_parts(wrong, PART).starts == wrong.starts


def test_a_start_that_leaves_far_more_than_the_model_does_elsewhere_is_found() -> None:
    """It is in step with the signal, and many times the noise away from it."""
    astray = fit_initial_states(begun_at(2.5))
    assert follow_growing_parts(astray, part=2.0).starts == astray.starts
    found = follow_growing_parts(astray, part=2.0, far=30.0)
    assert found.rss / 2001 == pytest.approx(1, abs=0.1)
