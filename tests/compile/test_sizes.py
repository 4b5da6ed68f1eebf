"""The sizes of entries and the pace of guards, against their definitions."""

from __future__ import annotations

import math

import pytest
from solve.models import made
from tracewire.compile.sizes import sizes
from tracewire.compile.tape import Tape


def size_of(formula: str, x: float, y: float = 0.0) -> float:
    """The size of a guard that reads x and y."""
    model = made(
        f"""
span: [0, 1]
blocks:
  x: {{type: integrator, of: zero, start: {x!r}}}
  y: {{type: integrator, of: zero, start: {y!r}}}
  zero: {{type: constant, value: 0}}
  s: {{type: expression, formula: "sign({formula})"}}
"""
    )
    names = list(model.states)
    states = [x if name == "x" else y for name in names]
    routines = model.routines
    routines.add("sizes", 1, lambda: {0: [*routines.eager["guard_sizes"].roots.values()][-1]})
    both = [*states, *map(abs, states)]
    return routines.evaluate("sizes", 0.0, both, [0.0] * 2 * len(model.modes), [], [])[0]


@pytest.mark.parametrize(
    ("formula", "size"),
    [
        ("x", 3.0),
        ("x - 3", 6.0),
        ("x - 1e6*y", 3.0 + 2e6),
        ("-x*y", 12.0),
        ("x/y - 1.5", 3.0 + 1.5),
        ("sin(x)", 3 * abs(math.cos(3)) + math.sin(3)),
        ("exp(x) - y", 3 * math.exp(3) + math.exp(3) + 2.0),
        ("(x if x > 0 else y) - 3", 5.0),  # all modes are 0
    ],
)
def test_a_size_is_the_sum_of_what_a_value_is_made_of(formula: str, size: float) -> None:
    assert size_of(formula, 3.0, -2.0) == pytest.approx(size)


def test_a_state_at_zero_keeps_the_size_of_what_it_was() -> None:
    tape = Tape()
    x = tape.push("state", payload=0)
    [size] = sizes(tape, [tape.push("*", tape.constant(2.0), x)], 1)
    leaves = [tape.entries[i] for i in tape.needed([size]) if not tape.entries[i].operands]
    assert [(leaf.op, leaf.payload) for leaf in leaves] == [("const", 2.0), ("state", 1)]


@pytest.mark.parametrize(
    ("formula", "has"),
    [
        ("x - 0.5", False),
        ("x*v - t*t", False),
        ("t - 0.5", False),
        ("sin(3*t)", True),
        ("sin(x)", True),
        ("1/x", True),
        ("x**4", False),
        ("x**0.7", True),
    ],
)
def test_only_what_may_turn_by_itself_has_a_pace(formula: str, has: bool) -> None:
    model = made(
        f"""
span: [0, 1]
blocks:
  x: {{type: integrator, of: v, start: 1}}
  v: {{type: integrator, of: x}}
  s: {{type: expression, formula: "sign({formula})"}}
"""
    )
    assert model.routines.has_pace == (has, False)
