"""Runs of one model take turns with its arrays: none sees what another has left there."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from solve.models import BALL, made
from tracewire.compile import Model
from tracewire.errors import SimulationError
from tracewire.solve import Limits, Run, simulate, workspace
from tracewire.solve.limits import MEMORY


def same(one: Run, other: Run) -> bool:
    return (
        all(np.array_equal(one[name], other[name]) for name in one.signals)
        and one.events == other.events
        and one.final == other.final
        and one.start == other.start
    )


def thrown(model: Model, h: float, **options: object) -> Run:
    return simulate(model, start={"x": h}, **options)  # type: ignore[arg-type]


@pytest.fixture
def model() -> Model:
    return made(BALL)


def test_a_run_is_as_that_of_a_fresh_model_and_stays_so(model: Model) -> None:
    expected = {h: thrown(made(BALL), h) for h in (1.0, 2.0)}
    runs = [(h, thrown(model, h)) for h in (1.0, 2.0, 1.0, 2.0, 1.0)]
    for h, run in runs:  # events are made when they are first read, which is now
        assert same(run, expected[h])


def test_a_run_inside_of_another_has_its_own_arrays(model: Model) -> None:
    expected = thrown(made(BALL), 1.0)
    thrown(model, 1.0)
    inner: list[Run] = []
    outer = thrown(model, 1.0, progress=lambda part, left: inner.append(thrown(model, 2.0)))
    assert same(outer, expected)
    assert all(same(run, thrown(made(BALL), 2.0)) for run in inner)


def test_a_run_that_failed_leaves_nothing(model: Model) -> None:
    expected = thrown(made(BALL), 1.0)
    thrown(model, 1.0)
    with pytest.raises(SimulationError):
        thrown(model, 2.0, limits=Limits(events=1))
    assert same(thrown(model, 1.0), expected)


def test_runs_in_threads_have_their_own_arrays(model: Model) -> None:
    heights = [1.0, 2.0] * 8
    expected = {h: thrown(made(BALL), h) for h in set(heights)}
    with ThreadPoolExecutor(4) as pool:
        runs = list(pool.map(lambda h: thrown(model, h), heights))
    assert all(same(run, expected[h]) for h, run in zip(heights, runs, strict=True))


def test_other_parameters_reach_those_that_follow_them() -> None:
    text = """
span: [0, 1]
parameters: {a: 1, b: 2*a, c: b + 1}
blocks:
  x: {type: integrator, of: rate, start: 0}
  rate: {type: constant, value: c}
"""
    model = made(text)
    given = ({}, {"a": 2.0}, {"a": 3.0}, {"b": 1.0}, {"a": 3.0, "b": 1.0}, {"c": 9.0}, {})
    found = [simulate(model, parameters=values).final["x"] for values in given]
    assert found == pytest.approx([3.0, 5.0, 7.0, 2.0, 2.0, 9.0, 3.0])


def test_of_many_models_those_that_ran_first_give_their_arrays_up() -> None:
    models = [made(BALL) for _ in range(MEMORY.models + 3)]
    finals = [thrown(model, 1.0).final for model in models]
    holding = [bool(workspace._kept(model)) for model in models]
    assert holding == [False] * 3 + [True] * MEMORY.models
    assert thrown(models[0], 1.0).final == finals[0], "it makes new ones"
