"""The account: free runs, errors on each stretch, and intervals."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from oracles.oscillator import NOISE, later, problem_of, record, search_of, trial_of
from tracewire.residual import Measured, Segment
from tracewire.residual.windows import Section, cut_windows
from tracewire.trace.options import TraceOptions
from tracewire.trace.results.comparison import (
    compare_models,
    on_equal_windows,
    parameter_changes,
    rmse,
    with_unseen_phases,
)
from tracewire.trace.trials.free_run import free_run
from tracewire.trace.trials.trial import TraceProblem

OPTIONS = TraceOptions()


def whole(problem: TraceProblem, measured: Measured) -> Segment:
    (segment,) = cut_windows(
        problem.declared, Section(measured, 0, len(measured.t)), len(measured.t), problem.states
    )
    return segment


def test_a_free_run_uses_only_the_first_fifth_for_its_start() -> None:
    m = record()
    problem = problem_of(m)
    trial = trial_of(problem)
    seen = int(OPTIONS.split.first_part * len(m.t))
    before = free_run(problem, trial, whole(problem, m), 20)
    after = free_run(problem, trial, whole(problem, later(m, slice(seen, None), 0.1)), 20)
    np.testing.assert_allclose(after[:seen], before[:seen], atol=1e-9)
    np.testing.assert_allclose(after[seen:], before[seen:] - 0.1 / NOISE, atol=1e-9)
    moved = free_run(problem, trial, whole(problem, later(m, slice(0, seen), 0.1)), 20)
    assert np.max(np.abs(moved[seen:] - before[seen:])) > 1.0, "the first fifth does count"


def test_a_free_run_of_the_truth_is_at_the_noise() -> None:
    m = record()
    problem = problem_of(m)
    residual = free_run(problem, trial_of(problem, length=300), whole(problem, m), 20)
    assert np.mean(residual**2) == pytest.approx(1.0, abs=0.3)


def test_each_stretch_is_compared_by_use_and_told_in_si() -> None:
    series = [record(name=use, use=use, end=6.0, seed=n)
              for n, use in enumerate(("train", "gate", "validate"))]  # fmt: skip
    problem = problem_of(*series)
    search = search_of(problem)
    good = trial_of(problem)
    poor = problem.fit((), good.windows.segments, 60, {}, fixed={"c": 0.0})
    parts = compare_models(search, poor, good)
    assert [part.use for part in parts] == ["train", "gate", "validate"]
    assert rmse(parts, 1) == pytest.approx(NOISE, rel=0.2) and rmse(parts, 0) > 5 * NOISE
    for part in parts:
        windowed, free = part.errors({"x": NOISE}, {"x": "m"})
        assert (windowed.kind, free.kind, free.unit) == ("windowed", "free run", "m")
        assert free.before > free.after
        assert windowed.before < free.before, "short windows hide a wrong damping"
        (curve,) = part.curves({"x": NOISE}, {"x": "m"})
        np.testing.assert_allclose(curve.measured, part.segment.samples()[:, 0])
        shown = np.sqrt(np.mean((curve.after - curve.measured) ** 2))
        assert shown == pytest.approx(free.after)


def test_two_models_are_compared_on_windows_of_one_length() -> None:
    """A damping that is a little wrong loses a long free run, and hardly shows in short windows."""
    problem = problem_of(record())
    fixed = {"c": 0.0}
    long = trial_of(problem, length=400)
    lost = problem.fit((), long.windows.segments, 400, {}, fixed=fixed)
    best = trial_of(problem, length=20)
    there = on_equal_windows(problem, lost, best)
    assert there.length == best.length
    assert [s.begin for s in there.windows.segments] == [s.begin for s in best.windows.segments]
    alone = problem.fit((), best.windows.segments, 20, {}, fixed=fixed)
    assert there.reduced_chi2 == pytest.approx(alone.reduced_chi2, rel=1e-3)
    assert there.reduced_chi2 < 0.1 * lost.reduced_chi2
    assert on_equal_windows(problem, best, best) is best


def test_intervals_cover_the_truth_as_often_as_they_say() -> None:
    exact = record(noise=0.0, end=6.0)
    problem = problem_of(exact)
    segments = trial_of(problem).windows.segments
    rng = np.random.default_rng(4)
    inside = []
    for _ in range(60):
        x = exact.values["x"] + NOISE * rng.standard_normal(len(exact.t))
        noisy = replace(exact, values={"x": x})
        drawn = [replace(segment, measured=noisy) for segment in segments]
        ends = problem.fit((), drawn, 60, {"k": 25.0, "c": 0.2}).intervals(OPTIONS.confidence)
        inside += [ends[n][0] <= value <= ends[n][1] for n, value in (("k", 25.0), ("c", 0.2))]
    assert np.mean(inside) == pytest.approx(0.95, abs=0.06)


def test_a_slow_residual_widens_the_intervals() -> None:
    m = record()
    slow = replace(m, values={"x": m.values["x"] + 2 * NOISE * np.sin(3 * m.t)})
    white, coloured = trial_of(problem_of(m), length=400), trial_of(problem_of(slow), length=400)
    assert coloured.effective_fraction < 0.8 < white.effective_fraction
    errors = white.standard_errors, coloured.standard_errors
    ratio = (
        coloured.reduced_chi2
        / white.reduced_chi2
        * white.effective_fraction
        / coloured.effective_fraction
    ) ** 0.5
    assert errors[1]["k"] / errors[0]["k"] == pytest.approx(ratio, rel=0.1)


def test_what_the_declared_parameters_did_is_told_with_units() -> None:
    problem = problem_of(record(end=6.0))
    declared = trial_of(problem)
    (k, c) = parameter_changes(problem, declared, declared, {"k": 25.5})
    assert (k.name, k.unit, k.before, k.after) == ("k", "1/s^2", declared.values["k"], 25.5)
    assert (c.name, c.after) == ("c", 0.0), "what was dropped is zero"


def test_a_phase_that_is_fitted_to_unseen_data_is_told() -> None:
    class Wave(SimpleNamespace):
        def __str__(self) -> str:
            return "harmonic @ force"

    before: Any
    after: Any
    before = Wave(own_series={"first", "second"})
    after = Wave(own_series={"first", "second", "kept", "again"})
    trial = replace(trial_of(problem_of(record(lambda x, v: 0.0))), effects=(before,))
    search: Any = SimpleNamespace(
        problem=SimpleNamespace(fit_unseen_phases=lambda trial, firsts: (after,)),
        data_split=SimpleNamespace(unseen=()),
        whole_windows=lambda sections: [],
        options=TraceOptions(),
        words=[],
    )
    assert with_unseen_phases(search, trial).effects == (after,)
    assert search.words == [
        "in 'again' and 'kept', which no fit saw, the phase of harmonic @ force is fitted to the "
        "first 20 % alone"
    ]
