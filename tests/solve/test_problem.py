"""An initial value problem is checked once, and its numbers are what a run uses."""

from __future__ import annotations

import gc
import weakref
from typing import Any

import numpy as np
import pytest
from solve.models import BALL, OSCILLATOR, made
from tracewire.errors import OptionError, SimulationError
from tracewire.solve import initial_value_problem, simulate
from tracewire.solve.once_per_model import once_per_model

FOLLOWS = """
span: [0, 2*T]
every: T/10
parameters: {T: 1.0, k: 3.0, k2: 2*k}
inputs: {u: {default: k2}}
require: [k > 0]
blocks:
  x: {type: integrator, of: rate, start: k2}
  rate: {type: expression, formula: "u - k*x"}
"""


def test_the_numbers_of_a_problem_follow_from_the_arguments() -> None:
    problem = initial_value_problem(made(FOLLOWS), parameters={"k": 5.0}, rtol=1e-8)
    assert problem.parameters == {"T": 1.0, "k": 5.0, "k2": 10.0}
    assert problem.start.tolist() == [10.0]
    assert problem.span == (0.0, 2.0)
    assert problem.times == pytest.approx(np.linspace(0, 2, 21), abs=1e-15)
    assert problem.tolerance.rtol == 1e-8


def test_other_values_give_the_problem_that_one_begins_with_them() -> None:
    model = made(FOLLOWS)
    given: dict[str, Any] = {"parameters": {"T": 2.0}, "start": {"x": 0.5}, "method": "dop853"}
    changed = initial_value_problem(model, ["k"], **given).with_values({"k": 4.0, "start.x": 0.25})
    given |= {"parameters": {"T": 2.0, "k": 4.0}, "start": {"x": 0.25}}
    fresh = initial_value_problem(model, ["k"], **given)
    assert changed.parameters == fresh.parameters
    assert changed.start.tolist() == [0.25]
    for name in ("times", "constants", "tables"):
        assert getattr(changed, name).tolist() == getattr(fresh, name).tolist()
    assert changed.moving.rates.tolist() == fresh.moving.rates.tolist()
    assert changed.given == fresh.given


def test_other_values_leave_the_problem_as_it_is() -> None:
    problem = initial_value_problem(made(FOLLOWS), parameters={"k": 5.0})
    problem.with_values({"k": 1.0, "T": 9.0}, span=(0.0, 1.0))
    assert problem.parameters["k"] == 5.0
    assert problem.span == (0.0, 2.0)
    assert problem.with_values({}).parameters == problem.parameters


def test_other_values_are_checked_as_the_first_ones() -> None:
    problem = initial_value_problem(made(FOLLOWS))
    with pytest.raises(SimulationError, match="the parameters do not meet 'k > 0': k = -1"):
        problem.with_values({"k": -1.0})
    with pytest.raises(OptionError, match="the span from 0 to -2 s is empty"):
        problem.with_values({"T": -1.0})
    with pytest.raises(OptionError, match="the start of 'x' is nan"):
        problem.with_values({"start.x": np.nan})
    with pytest.raises(OptionError, match="unknown state 'y'; there are: x"):
        problem.with_values({"start.y": 1.0})
    with pytest.raises(OptionError, match="unknown parameter or start 'x'; there are: T, k, k2, s"):
        problem.with_values({"x": 1.0})


def test_an_option_that_does_not_exist_is_refused() -> None:
    with pytest.raises(
        OptionError, match=r"unknown option 'spam'; there are: .*Did you mean 'span'"
    ):
        initial_value_problem(made(BALL), spam=(0, 1))  # type: ignore[call-arg]


def test_a_problem_that_is_not_sampled_does_not_look_at_the_time_between_samples() -> None:
    model = made(FOLLOWS)
    with pytest.raises(OptionError, match=r"an output every 0\.1 s has one sample only"):
        initial_value_problem(model, span=(0.0, 0.05))
    problem = initial_value_problem(model, sampled=False, span=(0.0, 0.05))
    assert len(problem.times) == 0
    assert len(problem.with_values({"k": 4.0}).times) == 0


def test_default_times_are_those_of_one_run_alone() -> None:
    model = made(BALL)
    first = initial_value_problem(model)
    first.times[:] = 0.0
    assert initial_value_problem(model).times[-1] == 12.0


@pytest.mark.parametrize("text", [BALL, OSCILLATOR, FOLLOWS])
def test_what_is_made_once_per_model_is_forgotten_with_it(text: str) -> None:
    made_for: list[int] = []

    @once_per_model
    def count(model: object) -> list[int]:
        made_for.append(id(model))
        return made_for

    model = made(text)
    simulate(model, sensitivities=list(model.parameters))
    assert count(model) is count(model)
    assert len(made_for) == 1
    gone = weakref.ref(model)
    del model
    gc.collect()
    assert gone() is None
