"""sinh, cosh, tanh and sech by shared parts: true values, limits, one call for an argument."""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import Decimal, localcontext

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tracewire.compile.hyperbolic import hyperbolic
from tracewire.compile.limits import CODE

MADE = hyperbolic(math.exp)
EVEN = ("cosh", "sech")
EACH = pytest.mark.parametrize("name", ["sinh", "cosh", "tanh", "sech"])


def digits_lost(name: str, u: float) -> Decimal:
    """How far a value is from the true one, in units in its last place."""
    with localcontext() as context:
        context.prec = 700  # of exp(u) - exp(-u) with u = 1e-300 some must be left
        e = Decimal(u).exp()
        odd, even = (e - 1 / e) / 2, (e + 1 / e) / 2
        true = {"sinh": odd, "cosh": even, "tanh": odd / even, "sech": 1 / even}[name]
        off = abs(Decimal(MADE[name](u)) - true)
        return off / Decimal(float(np.spacing(abs(float(true)))))


@EACH
@given(u=st.one_of(st.floats(-709.0, 709.0), st.floats(-3.0, 3.0), st.floats(-0.8, 0.8)))
def test_values_are_within_three_units_in_the_last_place(name: str, u: float) -> None:
    assert digits_lost(name, u) <= 3


@EACH
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_values_join_where_the_far_formula_takes_over(name: str, side: float) -> None:
    near, far = side * CODE.far, side * math.nextafter(CODE.far, math.inf)
    assert MADE[name](far) == pytest.approx(MADE[name](near), rel=1e-14)


@pytest.mark.parametrize(
    ("name", "at_infinity"), [("sinh", math.inf), ("cosh", math.inf), ("tanh", 1.0), ("sech", 0.0)]
)
def test_limits(name: str, at_infinity: float) -> None:
    made: Callable[[float], float] = hyperbolic(lambda u: float(np.exp(u)))[name]
    assert made(math.inf) == at_infinity
    assert made(-math.inf) == (at_infinity if name in EVEN else -at_infinity)
    assert math.isnan(made(math.nan))
    assert math.copysign(1.0, made(-0.0)) == (1.0 if name in EVEN else -1.0)
