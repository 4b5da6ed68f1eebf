"""Dimensions of units, beside those of pint."""

from __future__ import annotations

import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tracewire.formula import dimension_of, dimension_text
from tracewire.formula.dimension import POWERS

PINT = pint.UnitRegistry()
BASES = {
    "[length]": "m", "[mass]": "kg", "[time]": "s", "[current]": "A", "[temperature]": "K",
    "[substance]": "mol", "[luminosity]": "cd",
}  # fmt: skip
SYMBOLS = st.sampled_from(sorted(set(POWERS) - {"1"}))
PARTS = st.tuples(SYMBOLS, st.integers(-3, 3).filter(bool), st.sampled_from([" ", "/", "*"]))


@given(st.lists(PARTS, min_size=1, max_size=5))
def test_dimensions_are_those_of_pint(parts: list[tuple[str, int, str]]) -> None:
    text = parts[0][0]
    for symbol, power, sign in parts[1:]:
        text += f"{sign}{symbol}^{power}"
    wanted = PINT.parse_units(text.replace("Ohm", "ohm")).dimensionality
    assert dimension_of(text) == {BASES[name]: power for name, power in wanted.items()}


@given(st.dictionaries(st.sampled_from(sorted(BASES.values())), st.integers(-4, 4).filter(bool)))
def test_the_text_of_a_dimension_is_one_of_its_units(dimension: dict[str, int]) -> None:
    assert dimension_of(dimension_text(dimension)) == dimension


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("kg m^2/s^2", "N m"),
        ("rad/s", "1/s"),
        ("rad", "1"),
        ("m s^-2", "m/s^2"),
        ("N s/m", "N s/m"),
        ("V s/(rad A)", "H"),
        ("N/(m/s)", "N s/m"),
        ("ohm", "Ohm"),
    ],
)
def test_a_dimension_is_told_by_a_unit_of_the_field(text: str, shown: str) -> None:
    dimension = dimension_of(text)
    assert dimension is not None
    assert dimension_text(dimension) == shown


@pytest.mark.parametrize(
    "text", ["", " ", "N/(m", "N/m)", "N/(m (s))", "N/(m)^2", "deg", "furlong", "m^^2"]
)
def test_another_text_has_no_dimension(text: str) -> None:
    assert dimension_of(text) is None
