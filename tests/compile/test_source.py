from __future__ import annotations

import math

import numpy as np
import pytest
from compile.formulas import JUMPING, near
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from library.values import value
from solve.models import made, one
from tracewire.compile import Model
from tracewire.formula import parse
from tracewire.solve.flow import Flow
from tracewire.solve.schedule import Schedule
from tracewire.solve.settle import settle


def at_rest(model: Model, t: float, x: list[float]) -> Flow:
    """A flow whose modes belong to this point."""
    flow = Flow(model, np.array([p.formula.value for p in model.flat.parameters.values()]), [])
    Schedule(flow).begin(t)
    settle(flow, t, np.array(x))
    return flow


@given(formula=JUMPING, x=st.floats(-3, 3), y=st.floats(-3, 3), t=st.floats(0, 3))
@settings(max_examples=300, deadline=None)
def test_written_functions_are_the_formulas(formula: str, x: float, y: float, t: float) -> None:
    model = made(
        f"""
blocks:
  x: {{type: integrator, of: f}}
  y: {{type: integrator, of: f}}
  f: {{type: expression, formula: "{formula}"}}
""",
        record=("f",),
    )
    flow = Flow(model, np.empty(0), [])
    Schedule(flow).begin(t)
    point = np.array([x, y])
    guards = flow.guards(t, point)
    assume(all(abs(g) > 1e-9 and abs(g - round(g)) > 1e-9 for g in guards))
    settle(flow, t, point)
    assume(all(abs(g) > 1e-9 and abs(g - round(g)) > 1e-9 for g in flow.guards(t, point)))
    exact = value(parse(formula), {"x": x, "y": y, "t": t})
    assert near(flow.call("outputs", t, point)[-1], exact, 1e-12)
    assert near(flow.rates(t, point)[0], exact, 1e-12)


def test_both_versions_of_the_functions_share_their_constants() -> None:
    text = one("(2*pi)**0.5*k + 3/(k - 2) + (k/x if x >= 1 else 0*k + 1/(x + 5))")
    flow = at_rest(made(text.replace("blocks:", "parameters: {k: 4}\nblocks:")), 0.0, [2.0])
    fixed = 4 * math.sqrt(2 * math.pi) + 1.5
    assert flow.rates(0.0, np.array([8.0]))[0] == pytest.approx(fixed + 0.5)
    assert not math.isfinite(flow.rates(0.0, np.array([0.0]))[0])
    settle(flow, 0.0, np.array([0.0]))
    assert flow.rates(0.0, np.array([0.0]))[0] == pytest.approx(fixed + 0.2)


def test_an_unused_branch_may_be_undefined() -> None:
    more = '  other: {type: expression, formula: "1/x + (1/x)**2 if x >= 0.5 else 7"}'
    model = made(one("0", 0.0, more), record=("other",))
    flow = at_rest(model, 0.0, [0.0])
    assert flow.call("outputs", 0.0, np.array([0.0]))[-1] == 7.0


@pytest.mark.parametrize(
    ("formula", "result"),
    [
        ("1/x", math.nan),
        ("-1/(x*x)", -math.inf),
        ("log(x)", math.nan),
        ("exp(1000 + x)", math.inf),
        ("sqrt(x - 1)", math.nan),
        ("(x - 1)**0.3", math.nan),
    ],
)
def test_where_python_raises_the_functions_do_not(formula: str, result: float) -> None:
    flow = at_rest(
        made(one("0", 0.0, f'  y: {{type: expression, formula: "{formula}"}}'), ("y",)), 0.0, [0.0]
    )
    value = flow.call("outputs", 0.0, np.array([0.0]))[-1]
    assert not math.isfinite(value)
    if not math.isnan(result) and formula != "-1/(x*x)":
        assert value == result


def test_the_source_is_readable_python() -> None:
    source = made(one("-3*abs(x)")).source
    assert "def rhs(t, x, m, c, k):" in source
    assert "x[0]" in source
    compile(source, "model", "exec")


def test_what_reads_only_parameters_is_computed_once() -> None:
    text = one("-x*sqrt(k)/(1 + k)").replace("blocks:", "parameters: {k: 4}\nblocks:")
    source = made(text).source
    assert source.count("sqrt") == 1
    assert "sqrt" in source.split("def rhs")[0]


def test_the_jacobian_is_exact() -> None:
    model = made(
        """
parameters: {k: 3}
blocks:
  x: {type: integrator, of: f}
  y: {type: integrator, of: g}
  f: {type: expression, formula: x*y + t**2}
  g: {type: expression, formula: "k*sin(x) if x >= 0 else y"}
"""
    )
    flow = at_rest(model, 0.5, [1.0, 2.0])
    jacobian, time_rates = flow.jacobian(0.5, np.array([1.0, 2.0]))
    assert jacobian == pytest.approx(np.array([[2.0, 1.0], [3 * math.cos(1.0), 0.0]]))
    assert time_rates == pytest.approx([1.0, 0.0])
