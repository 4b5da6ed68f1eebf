"""The table of operators and functions: what one record says must agree with the rest of it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tracewire.formula import FUNCTIONS, OPERATIONS, Call, Name, evaluate, names_of, parse
from tracewire.formula.arrays import evaluate_along

POINTS = (0.2, 0.45, 0.9)  # in the domain of each function


@pytest.mark.parametrize("name", [n for n, one in FUNCTIONS.items() if one.slope])
@pytest.mark.parametrize("u", POINTS)
def test_a_slope_is_the_derivative_of_the_value(name: str, u: float) -> None:
    value = FUNCTIONS[name].value
    assert value is not None
    h = 1e-5
    slope = evaluate(parse(FUNCTIONS[name].slope), {"u": u, "f": value(u)})
    assert slope == pytest.approx((value(u + h) - value(u - h)) / (2 * h), rel=1e-8)


def test_a_slope_reads_the_argument_and_the_value_alone() -> None:
    read = {name for one in FUNCTIONS.values() if one.slope for name in names_of(parse(one.slope))}
    assert read == {"u", "f"}


@pytest.mark.parametrize("name", [n for n, one in OPERATIONS.items() if one.numpy])
def test_numpy_has_the_same_along_samples(name: str) -> None:
    for count in {OPERATIONS[name].least, OPERATIONS[name].most or 3}:
        formula = Call(name, tuple(Name(letter) for letter in "abc"[:count]))
        values = {letter: np.roll(POINTS, k) for k, letter in enumerate("abc")}
        each = [
            evaluate(formula, {letter: float(v[i]) for letter, v in values.items()})
            for i in range(len(POINTS))
        ]
        along = evaluate_along(formula, values, len(POINTS))
        np.testing.assert_allclose(along, each, rtol=1e-15)


def test_what_machine_code_computes_has_a_value_of_numbers() -> None:
    computed = {
        name: one.value
        for name, one in OPERATIONS.items()
        if one.library or one.intrinsic or one.instruction
    }
    assert {"sin", "sqrt", "+"} < computed.keys()
    assert [name for name, value in computed.items() if value is None] == []


def test_a_function_of_the_c_library_has_the_bits_of_python_s() -> None:
    given = {name: getattr(math, one.library) for name, one in OPERATIONS.items() if one.library}
    assert given == {name: OPERATIONS[name].value for name in given}


def test_what_reads_a_port_or_a_table_says_what_to_write_instead() -> None:
    assert {name for name, one in FUNCTIONS.items() if one.reads} < {
        name for name, one in FUNCTIONS.items() if one.instead
    }
