"""Which guards are straight in the states, and how much each state counts in them."""

from __future__ import annotations

import pytest
from compile.calls import called
from tracewire.compile import Model, compile
from tracewire.diagram import read_text


def model_of(formula: str) -> Model:
    """A model of two states with one guard: where the formula is zero."""
    return compile(
        read_text(f"""
span: [0, 1]
parameters: {{k: -3, c: 0.5, side: 1}}
blocks:
  x: {{type: integrator, of: v, start: 1}}
  v: {{type: integrator, of: a, start: 0.25}}
  a: {{type: expression, formula: "-x + (1 if {formula} > 0 else 2)"}}
""")
    )


def weights_of(model: Model) -> dict[str, float]:
    """The weights of the states in the guard of a model, by name."""
    values = {"k": -3.0, "c": 0.5, "side": 1.0}
    c = called(
        model.routines.address("prepare"), model.routines.sizes.constants, x=[*values.values()]
    )
    (states,) = model.routines.straight
    assert states is not None
    found = called(
        model.routines.address("guard_weights"), len(states), x=[0.0, 0.0], m=[0.0, 0.0], c=c
    )
    return {model.states[state]: value for state, value in zip(states, found, strict=True)}


@pytest.mark.parametrize(
    ("formula", "weights"),
    [
        ("(x)", {"x": 1.0}),
        ("(0.3 - x)", {"x": 1.0}),
        ("(x - v)", {"x": 1.0, "v": 1.0}),
        ("(x - k*v + 2*x)", {"x": 3.0, "v": 3.0}),
        ("(x/c - c)", {"x": 2.0}),
        ("((x if side > 0.5 else v) - 1)", {"x": 1.0, "v": 0.0}),
    ],
)
def test_a_sum_of_states_is_straight(formula: str, weights: dict[str, float]) -> None:
    assert weights_of(model_of(formula)) == weights


@pytest.mark.parametrize("formula", ["(x*v)", "(x - t)", "sin(x)", "(v + x**2)", "(c/x)"])
def test_what_bends_or_reads_the_time_is_not(formula: str) -> None:
    assert model_of(formula).routines.straight == (None,)
