"""Formulas along samples: the same as the compiled run of them, and as number by number."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from tracewire.errors import FormulaError
from tracewire.formula import evaluate, parse
from tracewire.formula.arrays import evaluate_along

FORMULAS = (
    "a + b*2 - a/4", "-a**2", "sqrt(abs(a)) if a < 0 else log(1 + a)", "sign(a)*max(a, b, 0.5)",
    "mod(a, 0.7) + floor(b)", "min(a, b)", "dry(a, 2, 3)", "sin(a) + atan2(a, 2)*cosh(b/9)",
    "1 if a > 0 and not b >= 1 else (2 if a <= b or b < 0 else 3)", "tanh(a/(b if b > 0 else 1))",
)  # fmt: skip


@pytest.mark.parametrize("text", FORMULAS)
@example(values=[(-3.5, 0.0)])  # -3.5/0.7 is rounded to -5
@given(values=st.lists(st.tuples(st.floats(-9, 9), st.floats(-9, 9)), min_size=1, max_size=9))
def test_samples_are_what_each_number_is(text: str, values: list[tuple[float, float]]) -> None:
    formula, (a, b) = parse(text), np.array(values).T
    found = evaluate_along(formula, {"a": a, "b": b}, len(a))
    expected = [evaluate(formula, {"a": x, "b": y}) for x, y in values]
    assert found == pytest.approx(expected, rel=1e-12, abs=1e-12)


def test_numbers_alone_are_the_same_at_each_sample() -> None:
    assert evaluate_along(parse("2*k"), {"k": 1.5}, 3).tolist() == [3.0, 3.0, 3.0]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("k*a", "'k*a' cannot be evaluated along samples: no 'k'"),
        ("is_held(a)", "no 'is_held'"),
        ("1/a", "'1/a' is not finite at each sample"),
    ],
)
def test_what_has_no_value_is_said(text: str, message: str) -> None:
    with pytest.raises(FormulaError) as caught:
        evaluate_along(parse(text), {"a": np.zeros(2)}, 2)
    assert message in str(caught.value)
