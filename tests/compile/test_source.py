"""The functions of the back end in Python: their text, and their values where Python would raise.

That machine code gives the same bits is tested in test_machine.py.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Sequence

import pytest
from compile.calls import Point, point_at, values
from compile.formulas import JUMPING, near
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from library.values import value
from solve.models import one
from tracewire.compile import Model, compile
from tracewire.diagram import read_text
from tracewire.formula import parse


def written(text: str, record: Sequence[str] = ()) -> Model:
    """The model of a diagram text whose functions are in Python."""
    return compile(read_text(text), record, backend="python")


def settled(model: Model, t: float, x: Sequence[float]) -> Point:
    """A point with its own modes."""
    at = point_at(model, t, x)
    assert at is not None
    return at


@given(formula=JUMPING, x=st.floats(-3, 3), y=st.floats(-3, 3), t=st.floats(0, 3))
@settings(max_examples=300, deadline=None)
def test_written_functions_are_the_formulas(formula: str, x: float, y: float, t: float) -> None:
    model = written(
        f"""
blocks:
  x: {{type: integrator, of: f}}
  y: {{type: integrator, of: f}}
  f: {{type: expression, formula: "{formula}"}}
""",
        record=("f",),
    )
    at = point_at(model, t, [x, y])
    assume(at is not None)
    assert at is not None
    exact = value(parse(formula), {"x": x, "y": y, "t": t})
    assert near(values(model, "outputs", at)[-1], exact, 1e-12)
    assert near(values(model, "rhs", at)[0], exact, 1e-12)


def test_both_versions_of_the_functions_share_their_constants() -> None:
    """At x = 0 the plain version divides by zero, so the careful one answers."""
    text = one("(2*pi)**0.5*k + 3/(k - 2) + (k/x if x >= 1 else 0*k + 1/(x + 5))")
    model = written(text.replace("blocks:", "parameters: {k: 4}\nblocks:"))
    fixed = 4 * math.sqrt(2 * math.pi) + 1.5
    high, low = settled(model, 0.0, [8.0]), settled(model, 0.0, [0.0])
    assert values(model, "rhs", high)[0] == pytest.approx(fixed + 0.5)
    assert values(model, "rhs", low)[0] == pytest.approx(fixed + 0.2)
    torn = Point(0.0, [0.0], high.m, high.p, high.k)
    assert values(model, "rhs", torn)[0] == math.inf


def test_an_unused_branch_may_be_undefined() -> None:
    more = '  other: {type: expression, formula: "1/x + (1/x)**2 if x >= 0.5 else 7"}'
    model = written(one("0", 0.0, more), record=("other",))
    assert values(model, "outputs", settled(model, 0.0, [0.0]))[-1] == 7.0


@pytest.mark.parametrize(
    ("formula", "result"),
    [
        ("1/x", math.inf),
        ("-1/(x*x)", -math.inf),
        ("x/x", math.nan),
        ("log(x)", -math.inf),
        ("log(x - 1)", math.nan),
        ("exp(1000 + x)", math.inf),
        ("sqrt(x - 1)", math.nan),
        ("(x - 1)**0.3", math.nan),
        ("sin(1/x)", math.nan),
    ],
)
def test_where_python_raises_the_functions_do_not(formula: str, result: float) -> None:
    model = written(one("0", 0.0, f'  y: {{type: expression, formula: "{formula}"}}'), ("y",))
    found = values(model, "outputs", settled(model, 0.0, [0.0]))[-1]
    assert found == pytest.approx(result, nan_ok=True)


def test_the_source_is_readable_python() -> None:
    source = written(one("-3*abs(x)")).source
    assert "def rhs(t, x, m, c, k):" in source
    assert "x[0]" in source
    ast.parse(source)


def test_what_reads_only_parameters_is_computed_once() -> None:
    text = one("-x*sqrt(k)/(1 + k)").replace("blocks:", "parameters: {k: 4}\nblocks:")
    source = written(text).source
    assert source.count("sqrt") == 1
    assert "sqrt" in source.split("def rhs")[0]


def test_the_jacobian_is_exact() -> None:
    model = written(
        """
parameters: {k: 3}
blocks:
  x: {type: integrator, of: f}
  y: {type: integrator, of: g}
  f: {type: expression, formula: x*y + t**2}
  g: {type: expression, formula: "k*sin(x) if x >= 0 else y"}
"""
    )
    at = settled(model, 0.5, [1.0, 2.0])
    expected = [2.0, 1.0, 1.0, 3 * math.cos(1.0), 0.0, 0.0]
    assert values(model, "jacobian", at) == pytest.approx(expected)
