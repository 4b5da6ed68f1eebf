"""The language that parses, the message for everything that does not, and where it points."""

from __future__ import annotations

from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tracewire.errors import FormulaError, Location
from tracewire.formula import Call, Name, Number, is_name, names_of, parse, rename, to_text
from tracewire.formula.functions import FUNCTIONS

X, Y, ZERO = Name("x"), Name("y"), Number(0.0)


@pytest.mark.parametrize(
    ("text", "formula"),
    [
        ("1e-3", Number(0.001)),
        ("-2", Number(-2.0)),
        (" x ", X),
        ("+x", X),
        ("bearing.torque", Name("bearing.torque")),
        ("x - y - 1", Call("-", (Call("-", (X, Y)), Number(1.0)))),
        ("-x**2", Call("neg", (Call("**", (X, Number(2.0))),))),
        ("2**x**y", Call("**", (Number(2.0), Call("**", (X, Y))))),
        ("x if y >= 0 else 0", Call("if", (Call(">=", (Y, ZERO)), X, ZERO))),
        ("x if 0 < y <= 1 else 0", parse("x if 0 < y and y <= 1 else 0")),
        ("x if not y < 0 else 0", Call("if", (Call("not", (Call("<", (Y, ZERO)),)), X, ZERO))),
        ("min(x, y, 0)", Call("min", (X, Y, ZERO))),
        ("interp(x, points)", Call("interp", (X, Name("points")))),
    ],
)
def test_a_formula_is_read_with_the_usual_precedence(text: str, formula: object) -> None:
    assert parse(text) == formula


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "there is no text"),
        ("   ", "there is no text"),
        ("x +", "it does not parse"),
        ("x if y >= 0", "it does not parse (expected 'else' after 'if' expression)"),
        ("x\ny", "it must stand on one line of text"),
        ("x\ry", "it must stand on one line of text"),
        ("x\x00", "it must stand on one line of text"),
        ("x # why", "a formula holds no comment"),
        ("x" * 4001, "it has 4001 characters, at most 4000 are allowed"),
        ("(" * 150 + "sin(" * 61 + "x" + ")" * 211, "it does not parse"),
        ("-" * 61 + "x", "it is nested deeper than 60. Use several blocks."),
        ("sin(" * 61 + "x" + ")" * 61, "it is nested deeper than 60"),
        ("min(" + "x, " * 1000 + "x)", "it has more than 1000 parts. Use several blocks."),
        ("True", "True is not a number"),
        ("None", "None is not a number"),
        ("'x'", "'x' is not a number"),
        ("b'x'", "b'x' is not a number"),
        ("1j", "1j is not a number"),
        ("...", "Ellipsis is not a number"),
        ("1e999", "the number is too large for double precision"),
        ("1" * 400, "the number is too large for double precision"),
        ("sin + 1", "sin is a function. Write sin(...)."),
        ("stage.sin", "sin is a function"),
        ("__import__", "'__import__' cannot be a name"),
        ("x.__class__", "'__class__' cannot be a name"),
        ("été", "'été' cannot be a name. Use the letters a to z"),
        ("(x + y).z", "a dot may only join names"),
        ("[x, 1]", "a list is not part of the formula language. A formula knows + - * / **"),
        ("x[-1]", "an index is a whole number from 0 on. Write q[0] for the first element"),
        ("x[1.5]", "an index is a whole number from 0 on"),
        ("x[True]", "an index is a whole number from 0 on"),
        ("x[0:2]", "an index is a whole number from 0 on"),
        ("x[y + 1]", "an index is a whole number from 0 on"),
        ("sin(x)[0]", "an index stands behind a name"),
        ("x[0][1]", "an index stands behind a name"),
        ("(x, y)", "a tuple is not part of the formula language"),
        ("lambda: x", "a lambda is not part of the formula language"),
        ("[x for x in y]", "a listcomp is not part of the formula language"),
        ("{x: y}", "a dict is not part of the formula language"),
        ("f'{x}'", "a joinedstr is not part of the formula language"),
        ("(x := 1)", "a namedexpr is not part of the formula language"),
        ("x ^ 2", "an operator is not part of the formula language. Write ** for a power."),
        ("x % 2", "an operator is not part of the formula language. Write mod(a, b)."),
        ("x // 2", "an operator is not part of the formula language. Write floor(a/b)."),
        ("x > 0 && y > 0", "'&&' is not part of the formula language. Write and."),
        ("x > 0 || y > 0", "'||' is not part of the formula language. Write or."),
        ("x > 0 ? 1 : 2", "'?' is not part of the formula language. Write a if c else b for"),
        ("1 if !(x > 0) else 2", "'!' is not part of the formula language. Write not."),
        ("y = 2*x", "'=' is not part of the formula language. A formula is what stands on the ri"),
        ("x' + x", "a prime is not part of the formula language. The rate of a state is what it"),
        ("2x", "it does not parse. A product needs a sign: 2*x."),
        ("3(x + 1)", "only named functions can be called"),
        ("-k*x + 2pi", "a product needs a sign. Write 2*pi."),
        ("0.5 N/m", "a number in a formula has no unit. Write it as a value: {value: 0.5, unit"),
        ("x @ y", "an operator is not part of the formula language. A formula knows"),
        ("~x", "the sign '~' is not part of the formula language"),
        ("x >= 0", "a comparison is not a number. Write 'a if c else b'."),
        ("-(x >= 0)", "a comparison is not a number"),
        ("2*(x >= 0)", "a comparison is not a number"),
        ("(x > 0) > y", "a comparison is not a number"),
        ("sin(x > 0)", "a comparison is not a number"),
        ("(x > 0) if y > 0 else 1", "a comparison is not a number"),
        ("1 if y > 0 else (x > 0)", "a comparison is not a number"),
        ("x and y", "a condition must be a comparison, such as x >= 0"),
        ("1 if x else 2", "a condition must be a comparison, such as x >= 0"),
        ("1 if not x else 2", "a condition must be a comparison"),
        ("1 if x == 0 else 2", "only < <= > >= compare signals. Signals are real numbers"),
        ("1 if x != 0 else 2", "only < <= > >= compare signals"),
        ("1 if x is y else 2", "only < <= > >= compare signals"),
        ("1 if x in y else 2", "only < <= > >= compare signals"),
        ("x.conjugate()", "only named functions can be called"),
        ("sin(x)(y)", "only named functions can be called"),
        ("sine(x)", "unknown function 'sine'. Did you mean 'sin'?"),
        ("eval(x)", "unknown function 'eval'"),
        ("__import__(x)", "unknown function '__import__'"),
        ("sin(u=x)", "arguments of sin are given by position"),
        ("min(*x)", "arguments of min are given by position"),
        ("sin()", "sin takes 1 argument, 0 given"),
        ("atan2(x)", "atan2 takes 2 arguments, 1 given"),
        ("min(x)", "min takes at least 2 arguments, 1 given"),
        ("sum(x + y)", "sum reads a port by its name"),
        ("product(2)", "product reads a port by its name"),
        ("interp(x, 2*y)", "interp reads a table of points by its name"),
    ],
)
def test_what_is_outside_the_language_is_refused_with_a_reason(text: str, message: str) -> None:
    with pytest.raises(FormulaError) as caught:
        parse(text)
    assert message in str(caught.value)
    assert len(caught.value.problems) == 1


def test_an_error_shows_the_formula_and_shortens_a_long_one() -> None:
    with pytest.raises(FormulaError, match=r"^formula 'sine\(x\)': unknown"):
        parse("sine(x)")
    with pytest.raises(FormulaError) as caught:
        parse("x" * 5000)
    assert "x..." in str(caught.value)
    assert len(str(caught.value)) < 200


@pytest.mark.parametrize(
    ("text", "column"),
    [("x + sine(y)", 14), ("  x + sine(y)", 16), ("x + # y", 14), ("x + (y", 14), ("1 if x", 10)],
)
def test_an_error_points_at_the_part_of_the_text(text: str, column: int) -> None:
    with pytest.raises(FormulaError) as caught:
        parse(text, Location("a.yaml", 3, 10, "alpha"))
    assert caught.value.problems[0].place == Location("a.yaml", 3, column, "alpha")


def test_a_place_without_a_column_gets_none() -> None:
    with pytest.raises(FormulaError) as caught:
        parse("x + sine(y)", Location("a.py", 3))
    assert caught.value.problems[0].place == Location("a.py", 3)


@given(st.text(max_size=60))
def test_any_text_is_a_formula_or_a_formula_error(text: str) -> None:
    with suppress(FormulaError):
        assert to_text(parse(text))


SIGNS = "( ) [ ] { } , . : ; + - * / ** // % @ ~ ^ < <= > >= == != := -> ! $ ? \\ ' \" "
OTHERS = "if else and or not in is for lambda await yield x y t pi 1 2.5 1e9 1j True"
WORDS = [*FUNCTIONS, *f"{SIGNS}{OTHERS}".split()]


@given(st.lists(st.sampled_from(WORDS), max_size=30).map(" ".join))
def test_any_words_of_the_grammar_are_a_formula_or_a_formula_error(text: str) -> None:
    try:
        formula = parse(text)
    except FormulaError:
        return
    assert all(part in WORDS for name in names_of(formula) for part in name.split("."))


@pytest.mark.parametrize("opening", ["(", "[", "{", "-", "not ", "x.", "sin(", "2**", "x if 1<"])
@pytest.mark.parametrize("many", [100, 700, 1300])
def test_deep_nesting_is_no_recursion_error(opening: str, many: int) -> None:
    try:
        formula = parse(opening * many + "x")
    except FormulaError:
        return
    assert opening == "x."  # a path of names is long and not deep
    assert isinstance(formula, Name)


def test_a_tower_of_powers_is_read_and_not_worked_out() -> None:
    nine = Number(9.0)
    assert parse("9**9**9**9") == Call("**", (nine, Call("**", (nine, Call("**", (nine, nine))))))


@pytest.mark.parametrize("good", ["x", "phi1_dot", "_", "T_s2_l", "start", "low", "sums"])
def test_letters_digits_and_underscores_are_a_name(good: str) -> None:
    assert is_name(good)


@pytest.mark.parametrize(
    "bad", ["", "1x", "a.b", "a b", "é", "t", "pi", "sin", "sum", "if", "lambda", "None", "__x"]
)
def test_words_of_the_language_and_of_python_are_no_names(bad: str) -> None:
    assert not is_name(bad)


def test_names_are_listed_once_in_order() -> None:
    assert names_of(parse("b*a if a > b.c else sin(t) + pi")) == ("a", "b.c", "b", "t", "pi")


def test_rename_replaces_every_name_and_nothing_else() -> None:
    formula = parse("k*x + max(x, 2)")
    renamed = rename(formula, lambda name: Number(3.0) if name == "k" else Name(f"a.{name}"))
    assert renamed == parse("3*a.x + max(a.x, 2)")
