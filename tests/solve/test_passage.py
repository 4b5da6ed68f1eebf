"""A passage that stops on its way comes to where a run comes that does not."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from solve.models import BALL, OSCILLATOR, made
from tracewire.errors import OptionError, SimulationError
from tracewire.solve import Passage, simulate

DRIVEN = """
span: [0, 10]
parameters: {f: 0.7, level: 0.2}
blocks:
  x: {type: integrator, of: v, start: 0.5}
  v: {type: integrator, of: a}
  wave: {type: square, amplitude: 1, frequency: f}
  friction: {type: coulomb, rate: v, level: level}
  a: {type: expression, formula: wave + friction - 4*x}
"""
RELAY = """
span: [0, 10]
blocks:
  x: {type: integrator, of: r, start: 0.5}
  switch: {type: relay, of: x, on_at: 1, off_at: 0, on_value: -1, off_value: 1}
  r: {type: expression, formula: "switch"}
"""
MODELS = {
    "ball": made(BALL.replace("0.8}", "0.5}")),
    "oscillator": made(OSCILLATOR),
    "driven": made(DRIVEN),
}
TIGHT: Any = {"rtol": 1e-10, "atol": 1e-12}


@given(
    st.sampled_from(sorted(MODELS)), st.lists(st.floats(0.05, 9.9), max_size=6), st.floats(0.1, 5)
)
@settings(max_examples=30, deadline=None)
def test_stops_change_nothing(name: str, stops: list[float], length: float) -> None:
    """Neither the states nor the deviations; a ball at rest and a body that sticks included."""
    model = MODELS[name]
    passage = Passage(model, length=length, tangents=True, **TIGHT)
    whole = np.eye(len(model.states))
    whole = passage.tangents
    for t in sorted({*stops, 10.0}):
        passage.go_to(t)
        whole = passage.tangents
        assert passage.t == t
    asked = [f"start.{state}" for state in model.states]
    run = simulate(model, span=(0, 10), times=[10.0], sensitivities=asked, **TIGHT)
    assert passage.x == pytest.approx(list(run.final.values()), abs=1e-7)
    for j, state in enumerate(asked):
        slopes = run.sensitivities[state]
        for signal in (s for s in model.states if s in run.signals):
            i = model.states.index(signal)
            assert whole[i, j] == pytest.approx(slopes[signal][0], abs=1e-5)


def test_a_memory_goes_on_over_a_stop() -> None:
    model = made(RELAY)
    passage = Passage(model, length=1.0, **TIGHT)
    seen = []
    for t in np.arange(0.25, 10, 0.25):
        passage.go_to(float(t))
        seen.append(passage.x[0])
    run = simulate(model, times=np.arange(0.25, 10, 0.25), **TIGHT)
    assert seen == pytest.approx(run["x"].tolist(), abs=1e-8)
    assert min(seen[4:]) < 0.3  # it went down below 1, where a relay that begins anew would not be


def test_deviations_that_are_set_go_on_from_there() -> None:
    model = MODELS["driven"]
    passage = Passage(model, length=1.0, parameters={"level": 0.0}, tangents=True, **TIGHT)
    passage.go_to(1.0)
    passage.tangents = 3 * np.eye(2)
    passage.go_to(1.0 + math.pi / 2)  # a quarter turn of cos(2t), twice
    assert passage.tangents == pytest.approx(-3 * np.eye(2), abs=1e-7)


def test_states_inside_of_an_interval() -> None:
    model = MODELS["oscillator"]
    passage = Passage(model, length=1.0, tangents=True, inner=3, **TIGHT)
    for a, b in ((0.0, 1.0), (1.0, 2.5)):
        inner = a + (b - a) * np.array([0.2, 0.7, 1.0])
        passage.go_to(b, inner)
        run = simulate(model, span=(0, 3), times=inner, **TIGHT)
        assert passage.inside[:, 0] == pytest.approx(run["x"], abs=1e-7)
        assert passage.inside[-1] == pytest.approx(passage.x)


def test_a_passage_begins_anew_with_other_parameters() -> None:
    model = MODELS["driven"]
    used = Passage(model, length=1.0, parameters={"level": 0.0}, tangents=True, **TIGHT)
    used.go_to(7.3)
    used.begin_with({"f": 1.1}, begin=0.5, length=2.0)
    used.go_to(4.0)
    fresh = Passage(
        model, length=2.0, begin=0.5, parameters={"level": 0.0, "f": 1.1}, tangents=True, **TIGHT
    )
    fresh.go_to(4.0)
    assert used.x.tolist() == fresh.x.tolist()
    assert used.tangents.tolist() == fresh.tangents.tolist()
    used.begin_at(2.0, np.array([0.1, 0.2]))
    assert (used.t, used.x.tolist()) == (2.0, [0.1, 0.2])
    assert used.tangents.tolist() == np.eye(2).tolist()


def test_the_rates_on_a_slide_are_those_along_it() -> None:
    passage = Passage(MODELS["oscillator"], length=1.0, start={"x": 0.05})
    assert passage.rates().tolist() == [0.0, 0.0]
    assert len(passage.held) == 1
    passage.begin_at(0.0, np.array([1.0, 0.0]))
    assert passage.rates() == pytest.approx([0.0, -0.9])
    assert passage.held == []


def test_what_happened_is_told_for_the_last_interval() -> None:
    passage = Passage(MODELS["ball"], length=1.0)
    passage.go_to(1.0)
    assert passage.kinds == set()
    assert len(passage.log) == 0
    passage.go_to(2.0)
    assert len(passage.log) == 1
    assert passage.steps > 1
    passage.go_to(2.1)
    assert passage.kinds == set()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"length": 0.0}, "an interval of 0 s from t = 0 s has no use"),
        ({"length": 1.0, "begin": math.inf}, "an interval of 1 s from t = inf s"),
        ({"length": 1.0, "method": "rk4"}, "unknown method 'rk4'"),
        ({"length": 1.0, "method": "euler"}, "unknown method 'euler'"),
        ({"length": 1.0, "start": {"y": 1.0}}, "unknown state 'y'"),
        ({"length": 1.0, "parameters": {"y": 1.0}}, "unknown parameter 'y'"),
        ({"length": 1.0, "rtol": 0.0}, "rtol = 0"),
    ],
)
def test_what_does_not_fit_is_refused(options: dict[str, Any], said: str) -> None:
    with pytest.raises(OptionError, match=said):
        Passage(MODELS["ball"], **options)


def test_a_passage_that_cannot_go_on_says_so() -> None:
    blow = made("span: [0, 1]\nblocks:\n  x: {type: integrator, of: r, start: 1}\n"
                "  r: {type: expression, formula: x*x}\n")  # fmt: skip
    passage = Passage(blow, length=1.0)
    with pytest.raises(SimulationError, match="'x'"):
        passage.go_to(2.0)
