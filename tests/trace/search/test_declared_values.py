"""Effects that are screened at the declared values, where the fit has taken these far away."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from oracles.oscillator import problem_of, record, search_of
from tracewire.errors import FitError
from tracewire.trace.search.search import Search, moved_values

LEVEL, DECAY, DRAG = 1.2, 1.0, 0.1  # m/s^2, s/m, 1/m
TEXT = """\
span: [0, 12]
parameters:
  k: {value: 24, unit: 1/s^2, fit: [5, 80]}
  level: {value: 1.0, unit: m/s^2, fit: [0, 5]}
  decay: {value: 0.9, unit: s/m, fit: [0, 20]}
blocks:
  x: {type: integrator, of: v, start: 1, unit: m}
  v: {type: integrator, of: force, unit: m/s}
  spring: {type: gain, of: x, k: -k}
  plate: {type: expression, formula: -level*tanh(v/0.01)*exp(-decay*abs(v))}
  force: {type: sum, of: [spring, plate]}
measured:
  swing: {file: swing.csv, time: t, signals: {x: x}, start: {x: free, v: free}}
"""


def friction(x: float, v: float) -> float:
    """A friction that falls with the rate, which is declared, and a drag, which is not."""
    return -LEVEL * math.tanh(v / 0.01) * math.exp(-DECAY * abs(v)) - DRAG * v * abs(v)


@pytest.fixture(scope="module")
def search() -> Search:
    uses = ["train", "train", "gate", "validate"]
    series = [
        record(friction, name=f"s{n}", damping=0.0, seed=n, end=6, use=use)
        for n, use in enumerate(uses)
    ]
    return search_of(problem_of(*series, text=TEXT))


def test_an_effect_that_a_parameter_made_up_for_is_found_at_the_declared_values(
    search: Search,
) -> None:
    declared = search.fit_declared()
    assert declared.values["decay"] < 0.1 * DECAY, "the friction does not fall any more"
    found = search.add_effect_at_declared_values(declared)
    assert found is not None
    (drag,) = found.effects
    assert str(drag) == "quad_drag @ force"
    assert drag.coefficient == pytest.approx(DRAG, rel=0.05)
    assert abs(found.values["decay"] - DECAY) < 4 * found.standard_errors["decay"] < 0.5 * DECAY
    proposals = [one.proposal for one in search.steps[-1].refits]
    assert all(p.values == {"k": 24.0, "level": 1.0, "decay": 0.9} for p in proposals)


def test_the_search_looks_there_where_nothing_passes_at_the_fitted_values(search: Search) -> None:
    class Blind(Search):
        """A search that sees nothing beside the declared fit."""

        def add_effect(self, now: Any) -> Any:
            return None

    blind = Blind(search.problem, search.data_split, search.places, search.shortest, {}, print, [])
    blind.run(blind.fit_declared())
    assert blind.best is not None
    assert [str(effect) for effect in blind.best.effects] == ["quad_drag @ force"]
    assert blind.best.reduced_chi2 < 1.2


def test_where_no_value_has_moved_far_nothing_is_looked_for(search: Search) -> None:
    options = replace(search.options, moved=math.inf)
    near = replace(search, problem=replace(search.problem, options=options))
    assert near.add_effect_at_declared_values(near.fit_declared()) is None


def test_where_the_model_does_not_run_at_the_declared_values_nothing_is_looked_for(
    search: Search,
) -> None:
    class Stopped(Search):
        """A search whose model does not run with its places open."""

        def screen(self, trial: Any) -> Any:
            raise FitError.one("the run stopped at t = 1 s")

    own = Stopped(search.problem, search.data_split, search.places, search.shortest, {}, print, [])
    assert own.add_effect_at_declared_values(own.fit_declared()) is None


def test_the_values_that_have_moved(search: Search) -> None:
    declared = search.problem.declared
    given = {"k": 24.0, "level": 1.0, "decay": 0.9}
    assert moved_values(declared, {**given, "decay": 0.5}, 0.3) == given
    assert moved_values(declared, {**given, "decay": 0.7}, 0.3) == {}
    assert moved_values(declared, {"decay": 0.1, "quad_drag.c": 0.1}, 0.3) == {"decay": 0.9}
