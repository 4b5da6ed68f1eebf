from __future__ import annotations

import pytest
from compile.formulas import NAMES, SMOOTH, near, worked_out
from hypothesis import given, settings
from hypothesis import strategies as st
from solve.models import made
from tracewire.compile.differentiate import differentiate, linear_in_t, substitute
from tracewire.compile.lower import lower
from tracewire.compile.lowered import Lowered
from tracewire.compile.tape import Tape

STEP = 1e-5
ONE = ("sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log")
ONE = (*ONE, "sqrt", "neg")
TWO = ("+", "-", "*", "/", "**", "atan2")
POINT = st.floats(-2, 2)


def lowered(formula: str) -> Lowered:
    """The tape of one formula over the states x and y and the time."""
    return lower(
        made(
            f"""
blocks:
  x: {{type: integrator, of: f}}
  y: {{type: integrator, of: f}}
  f: {{type: expression, formula: "{formula}"}}
"""
        ).flat
    )


@pytest.mark.parametrize("name", NAMES)
@given(formula=SMOOTH, point=st.tuples(POINT, POINT, POINT))
@settings(max_examples=60, deadline=None)
def test_derivatives_are_those_of_finite_differences(
    name: str, formula: str, point: tuple[float, float, float]
) -> None:
    low = lowered(formula)
    leaves = [low.entries[n] for n in NAMES]
    seed = low.entries[name]
    [rate] = differentiate(low.tape, [low.entries["f"]], {seed: low.tape.constant(1.0)})
    values = dict(zip(leaves, point, strict=True))

    def at(change: float) -> float:
        moved = values | {seed: values[seed] + change}
        return worked_out(low.tape, [low.entries["f"]], moved)[0]

    [exact] = worked_out(low.tape, [rate], values)
    # the Richardson value of two central differences: error of order STEP**4
    wide, narrow = ((at(s) - at(-s)) / (2 * s) for s in (100 * STEP, 50 * STEP))
    estimate = (4 * narrow - wide) / 3
    curved = abs(narrow - wide)
    assert near(exact, estimate, 1e-6 + curved * 1e-1 + 1e-7 * abs(at(0.0)))


@pytest.mark.parametrize("op", [*ONE, *TWO])
def test_every_operation_has_its_derivative(op: str) -> None:
    tape, at = Tape(), 0.4
    x = tape.push("state", payload=0)
    other = tape.push("+", tape.push("*", x, x), tape.constant(0.3))
    operands = (x, other) if op in TWO else (other,)
    root = tape.push(op, *operands)
    [rate] = differentiate(tape, [root], {x: tape.constant(1.0)})
    [exact] = worked_out(tape, [rate], {x: at})
    high, low = (worked_out(tape, [root], {x: at + s})[0] for s in (STEP, -STEP))
    assert exact == pytest.approx((high - low) / (2 * STEP), rel=1e-8)


def test_modes_are_constants_of_a_derivative() -> None:
    low = lowered("abs(x) + floor(x)*x")
    tape, x = low.tape, low.entries["x"]
    [rate] = differentiate(tape, [low.entries["f"]], {x: tape.constant(1.0)})
    leaves = {mode.leaf: 1.0 if mode.kind == "sign" else 3.0 for mode in low.modes}
    assert worked_out(tape, [rate], leaves | {x: 3.7}) == [1.0 + 3.0]


def test_a_guard_is_timed_where_it_is_a_line_in_t() -> None:
    low = lowered("3*x + 2*t")
    tape, t, x = low.tape, low.entries["t"], low.entries["x"]
    line = tape.push("-", tape.push("*", tape.constant(4.0), t), tape.constant(3.0))
    found = linear_in_t(tape, line, t)
    assert found is not None
    assert [tape.value(entry) for entry in found] == [4.0, -3.0]
    assert linear_in_t(tape, tape.push("*", t, t), t) is None
    assert linear_in_t(tape, tape.push("+", line, x), t) is None
    assert substitute(tape, line, {t: tape.constant(2.0)}) == tape.constant(5.0)
