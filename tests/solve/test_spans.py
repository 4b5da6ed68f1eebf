"""Runs over many spans: each is, to the last bit, what a run alone is."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from solve.models import BALL, OSCILLATOR, made
from tracewire.compile import Model
from tracewire.errors import OptionError, SimulationError
from tracewire.solve import (
    Integrator,
    Limits,
    Span,
    SpanRuns,
    initial_value_problem,
    simulate,
    simulate_spans,
)

DRIVEN = """
span: [0, 10]
inputs: {u: {default: 0}}
parameters: {k: 2, c: 0.1, level: 0.2, begin: 0.5}
record: [x, v, a]
blocks:
  x: {type: integrator, of: v, start: begin}
  v: {type: integrator, of: a}
  friction: {type: coulomb, rate: v, level: level}
  spring: {type: expression, formula: -k*x - c*v}
  a: {type: sum, of: [u, spring, friction]}
"""
LAGGED = """
span: [0, 10]
parameters: {tau: 0.3}
record: [x, memory]
blocks:
  x: {type: integrator, of: one}
  one: {type: constant, value: 1}
  change: {type: expression, formula: (x - memory)/tau}
  memory: {type: integrator, of: change, start: 0.25}
"""
T = np.linspace(0.0, 10.0, 201)
INPUTS = {"u": (T, np.sin(3 * T))}
ASKED = ["k", "level", "begin", "start.x", "start.v"]


def cut(edges: list[float], starts: list[dict[str, float]]) -> list[Span]:
    times = [T[(a <= T) & (b >= T)] for a, b in pairwise(edges)]
    return [
        Span(float(t[0]), float(t[-1]), t, start) for t, start in zip(times, starts, strict=True)
    ]


def check(model: Model, spans: list[Span], together: SpanRuns, **options: Any) -> None:
    """Each span is as a run alone."""
    for number, span in enumerate(spans):
        rows = slice(together.rows[number], together.rows[number + 1])
        alone = simulate(
            model, span=(span.begin, span.end), times=span.times, start=span.start, **options
        )
        for name in model.recorded:
            assert np.array_equal(together[name][rows], alone[name])
        answers = together.sensitivities.array[:, :, rows]
        assert np.array_equal(answers, alone.sensitivities.array)
        assert together.final[number].tolist() == list(alone.final.values())
        assert together.steps[number] == alone.statistics.steps
        assert together.warnings.get(number, ()) == alone.warnings
    assert not together.errors


@settings(max_examples=15, deadline=None)
@given(
    edges=st.lists(st.integers(1, 9), min_size=1, max_size=5, unique=True).map(sorted),
    starts=st.lists(
        st.dictionaries(st.sampled_from(["x", "v"]), st.floats(-1, 1)), min_size=6, max_size=6
    ),
    asked=st.lists(st.sampled_from(ASKED), unique=True),
)
def test_spans_are_as_runs_alone(
    edges: list[int], starts: list[dict[str, float]], asked: list[str]
) -> None:
    model = DRIVEN_MODEL
    spans = cut([0.0, *map(float, edges), 10.0], starts[: len(edges) + 1])
    for _ in range(2):  # the second time in arrays that were used
        together = simulate_spans(model, spans, inputs=INPUTS, sensitivities=asked)
        check(model, spans, together, inputs=INPUTS, sensitivities=asked)


DRIVEN_MODEL = made(DRIVEN)


def test_a_run_alone_in_between_changes_nothing() -> None:
    spans = cut([0.0, 5.0, 10.0], [{}, {"x": 0.1, "v": 0.0}])
    simulate(DRIVEN_MODEL, inputs=INPUTS, sensitivities=["k"])
    together = simulate_spans(DRIVEN_MODEL, spans, inputs=INPUTS, sensitivities=["k"])
    check(DRIVEN_MODEL, spans, together, inputs=INPUTS, sensitivities=["k"])


def test_runs_in_used_arrays_are_as_the_first_and_leave_these_alone() -> None:
    model, asked = made(LAGGED), ["tau"]
    one = [Span(float(T[a]), float(T[a + 80]), T[a : a + 81], {"x": 1.0}) for a in (0, 80)]
    two = [replace(span, start={"memory": 0.5}, follows=a > 0) for a, span in enumerate(one)]
    ways = [one, two, [replace(span, start={}) for span in two]]
    alone = [simulate_spans(made(LAGGED), spans, sensitivities=asked) for spans in ways]
    found = [simulate_spans(model, spans, sensitivities=asked) for spans in (*ways, *ways)]
    for runs, first in zip(found, [*alone, *alone], strict=True):
        assert np.array_equal(runs["memory"], first["memory"])
        assert np.array_equal(runs.sensitivities.array, first.sensitivities.array)
        assert np.array_equal(runs.final, first.final)
        assert np.array_equal(runs.final_slopes, first.final_slopes)
        assert np.array_equal(runs.steps, first.steps)


def test_a_run_without_samples_is_as_ever_after_spans() -> None:
    def end() -> float:
        problem = initial_value_problem(model, sampled=False, span=(0.0, 5.0), inputs=INPUTS)
        integrator = Integrator(problem)
        integrator.go_to()
        assert integrator.run.t.size == 0
        return float(integrator.x[0])

    model = made(DRIVEN)
    before = end()
    simulate_spans(model, cut([0.0, 5.0, 10.0], [{}, {"x": 0.1, "v": 0.0}]), inputs=INPUTS)
    assert end() == before


def test_what_a_run_warns_of_its_span_warns_of() -> None:
    model = made(BALL)
    spans = [Span(0.0, 12.0, T, {"x": 1.0}), Span(0.0, 1.0, T[:20], {"x": 0.0, "v": -1.0})]
    together = simulate_spans(model, spans, sensitivities=["restitution"])
    assert sorted(together.warnings) == [0, 1]
    check(model, spans, together, sensitivities=["restitution"])


def test_many_events_and_steps_are_no_more_than_in_a_run_alone() -> None:
    model = made(OSCILLATOR)
    spans = [Span(0.0, 30.0, T, {"x": 0.01 * n, "v": 1.0}) for n in range(40)]
    check(model, spans, simulate_spans(model, spans, rtol=1e-9), rtol=1e-9)


def test_what_is_not_set_goes_on_from_the_span_before() -> None:
    model = made(LAGGED)
    asked = ["tau", "start.x"]
    whole = simulate(model, times=T, rtol=1e-9, sensitivities=asked)
    spans = [
        Span(float(T[a]), float(T[b]), T[a : b + 1], {"x": float(T[a])}, follows=a > 0)
        for a, b in ((0, 80), (80, 120), (120, 200))
    ]
    together = simulate_spans(model, spans, rtol=1e-9, sensitivities=asked)
    inner = together.rows[1:-1]
    assert np.delete(together["memory"], inner) == pytest.approx(whole["memory"], abs=1e-8)
    moved = np.delete(together.sensitivities["tau"]["memory"], inner)
    assert moved == pytest.approx(whole.sensitivities["tau"]["memory"], abs=1e-6)
    assert together.sensitivities["start.x"]["memory"][together.rows[1]] == 0.0, "another start"
    alone = simulate_spans(model, [spans[1]])  # there is none before it
    assert alone["memory"][0] == 0.25


def test_a_span_that_fails_does_not_end_the_others() -> None:
    model = made(
        """
span: [0, 1]
blocks:
  x: {type: integrator, of: rate, start: 1}
  rate: {type: expression, formula: x**2}
"""
    )
    t = np.linspace(0.0, 0.9, 10)
    spans = [Span(0.0, 0.9, t, {"x": x}) for x in (1.0, 5.0, 0.5)]
    together = simulate_spans(model, spans, limits=Limits(steps=2000))
    assert list(together.errors) == [1]
    with pytest.raises(SimulationError) as error:
        simulate(model, times=t, start={"x": 5.0}, limits=Limits(steps=2000))
    assert str(together.errors[1]) == str(error.value)
    assert together["x"][20:] == pytest.approx(1 / (2 - t), rel=1e-5)


def test_runs_beyond_the_budget_fail() -> None:
    spans = cut([0.0, 2.0, 4.0, 10.0], [{}, {}, {}])
    together = simulate_spans(DRIVEN_MODEL, spans, inputs=INPUTS, budget=30)
    assert list(together.errors) == [1, 2]
    assert "takes more than 30 steps in all" in str(together.errors[2])


def test_starts_that_do_not_fit_are_refused() -> None:
    with pytest.raises(OptionError, match="unknown state 'y'"):
        simulate_spans(DRIVEN_MODEL, [Span(0.0, 1.0, T[:20], {"y": 0.0})])
    with pytest.raises(OptionError, match="the start of 'v' is nan"):
        simulate_spans(DRIVEN_MODEL, [Span(0.0, 1.0, T[:20], {"v": np.nan})])
