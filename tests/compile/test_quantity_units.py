"""The unit of a quantity: the user's where the quantity keeps it, else that of its dimension."""

from __future__ import annotations

from math import pi

import pytest
from tracewire.compile import compile, unit_of_quantity
from tracewire.diagram import read_text
from tracewire.formula import parse_quantity

CART = """\
parameters: {k: {value: 2, unit: N/m}, m: {value: 3, unit: kg}, gap: {value: 4, unit: mm}}
subsystems:
  cart:
    inputs: [force]
    outputs: {x: x}
    parameters: {m: {value: 1, unit: kg}}
    blocks:
      x: {type: integrator, of: v, unit: mm}
      v: {type: integrator, of: a}
      a: {type: gain, of: force, k: 1/m}
blocks:
  error: {type: expression, formula: gap - C.x, unit: mm}
  C: {type: cart, force: spring}
  spring: {type: expression, formula: -k*C.x}
  phi: {type: integrator, of: omega, unit: deg}
  omega: {type: constant, value: 1}
"""


@pytest.mark.parametrize(
    ("quantity", "unit", "factor"),
    [
        ("rms(error)", "mm", 1e-3),
        ("max(abs(C.x - error))", "mm", 1e-3),
        ("max(C.x) - min(error)", "mm", 1e-3),
        ("at(error, 1)", "mm", 1e-3),
        ("max(phi)", "deg", pi / 180),
        ("max(sin(phi))", "", 1.0),
        ("max(error*error)", "m^2", 1.0),
        ("max(error)/max(C.x)", "", 1.0),
        ("integral(spring)", "N s", 1.0),
        ("max(spring)", "N", 1.0),
        ("end(C.v)", "m/s", 1.0),
        ("frequency(C.x)", "Hz", 1.0),
        ("growth_rate(C.x)", "1/s", 1.0),
        ("time(error > 0.001)", "s", 1.0),
        ("count(impact)", "", 1.0),
        ("fraction(phi > 1)", "", 1.0),
    ],
)
def test_a_quantity_has_the_unit_of_what_it_keeps(quantity: str, unit: str, factor: float) -> None:
    found = unit_of_quantity(compile(read_text(CART)), parse_quantity(quantity))
    assert found == (unit, pytest.approx(factor))


def test_a_quantity_of_plain_numbers_has_no_unit() -> None:
    blocks = "{x: {type: integrator, of: y}, y: {type: cos, of: z}, z: {type: constant, value: 1}}"
    model = compile(read_text(f"blocks: {blocks}"))
    assert model.flat.units["x"] == ""
    for quantity, unit in (("max(x)", ""), ("growth_rate(x)", "1/s"), ("period(x)", "s")):
        assert unit_of_quantity(model, parse_quantity(quantity)) == (unit, 1.0)
