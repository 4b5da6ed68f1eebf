"""A formula and its text are the same thing."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tracewire.formula import Call, Expression, Name, Number, parse, to_text, two_digits
from tracewire.formula.functions import FUNCTIONS

NUMBERS = st.floats(allow_nan=False, allow_infinity=False).map(Number)
NAMES = st.sampled_from(["x", "phi1_dot", "bearing.torque", "t", "pi"]).map(Name)
PLAIN = [name for name, one in FUNCTIONS.items() if not one.reads]
BY_NAME = [name for name, one in FUNCTIONS.items() if one.reads]
Draw = st.DrawFn


@st.composite
def formulas(draw: Draw, depth: int = 4) -> Expression:
    """A formula as the parser builds it: a condition stands only inside a choice."""
    if depth == 0 or draw(st.booleans()):
        return draw(NUMBERS | NAMES)
    terms = formulas(depth - 1)
    kind = draw(st.sampled_from(["operator", "sign", "choice", "function", "by name", "element"]))
    if kind == "operator":
        sign = draw(st.sampled_from(["+", "-", "*", "/", "**"]))
        return Call(sign, (draw(terms), draw(terms)))
    if kind == "sign":
        term = draw(terms)
        return Number(-term.value) if isinstance(term, Number) else Call("neg", (term,))
    if kind == "choice":
        return Call("if", (draw(conditions(depth - 1)), draw(terms), draw(terms)))
    if kind == "by name":
        name = draw(st.sampled_from(BY_NAME))
        before = [draw(terms) for _ in range(FUNCTIONS[name].least - 1)]
        return Call(name, (*before, Name("of")))
    if kind == "element":
        index = st.integers(0, 99).map(lambda number: Number(float(number)))
        return Call("[]", (draw(NAMES), *draw(st.lists(index, min_size=1, max_size=2))))
    name = draw(st.sampled_from(PLAIN))
    least, most = FUNCTIONS[name].least, FUNCTIONS[name].most or 4
    return Call(name, tuple(draw(st.lists(terms, min_size=least, max_size=most))))


@st.composite
def conditions(draw: Draw, depth: int) -> Expression:
    kind = draw(st.sampled_from(["relation", "not", "and", "or"])) if depth > 0 else "relation"
    if kind == "relation":
        sign = draw(st.sampled_from(["<", "<=", ">", ">="]))
        return Call(sign, (draw(formulas(depth)), draw(formulas(depth))))
    if kind == "not":
        return Call("not", (draw(conditions(depth - 1)),))
    inner = st.lists(conditions(depth - 1), min_size=2, max_size=3)
    return Call(kind, tuple(draw(inner)))


@given(formulas())
def test_the_text_of_a_formula_reads_back_as_the_formula(formula: Expression) -> None:
    assert parse(to_text(formula)) == formula


@pytest.mark.parametrize(
    "text",
    [
        "1/J",
        "-k*x**3",
        "a - (b - c)",
        "a/(b*c)",
        "(a + b)*c",
        "(-2)**x",
        "(-0)**x",
        "2**-x",
        "-(x + 1)",
        "a - -2",
        "1e-10*x",
        "c_l if rate >= 0 else c_r",
        "(1 if a > 0 else 2) if b > 0 else 3",
        "1 if a > 0 else 2 if b > 0 else 3",
        "1 if not (a > 0 or b > 0) and c > 0 else 2",
        "max(0, min(x, 1))",
    ],
)
def test_text_has_no_more_brackets_than_a_person_writes(text: str) -> None:
    assert to_text(parse(text)) == text


def test_brackets_that_say_nothing_are_left_out() -> None:
    assert to_text(parse("((a)*(b)) + (c**(2.0))")) == "a*b + c**2"


@pytest.mark.parametrize(
    ("value", "text"),
    [(264.0, "260"), (1449.0, "1400"), (0.00316, "0.0032"), (-12.6, "-13"), (3e-7, "3e-07")],
)
def test_two_digits_are_written_out(value: float, text: str) -> None:
    assert two_digits(value) == text
