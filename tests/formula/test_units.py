"""Units: the factor to SI, what is shown, and the texts that are no units."""

from __future__ import annotations

import math
import sys
from subprocess import run

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tracewire.errors import FormulaError, Location
from tracewire.formula import PREFIXES, Unit, quantity_hint, read_unit, same_quantity, unit_list
from tracewire.formula.common_units import COMMON
from tracewire.formula.dimension import powers_of
from tracewire.formula.units import COHERENT, SYMBOLS, _convert


@pytest.mark.parametrize(
    ("text", "shown", "factor"),
    [
        ("", "", 1.0),
        ("1", "", 1.0),
        ("kg m^2", "kg m^2", 1.0),
        ("N m s/rad", "N m s/rad", 1.0),
        ("kg*m**2", "kg*m**2", 1.0),
        ("1/s", "1/s", 1.0),
        ("Hz", "Hz", 1.0),
        ("N/(m s)", "N/(m s)", 1.0),
        ("deg", "rad", math.pi / 180),
        ("°", "rad", math.pi / 180),
        ("deg/s", "rad/s", math.pi / 180),
        ("mm", "m", 1e-3),
        ("µm", "m", 1e-6),
        ("g", "kg", 1e-3),
        ("g cm^2", "kg m^2", 1e-7),
        ("rpm", "rad/s", 2 * math.pi / 60),
        ("rev", "rad", 2 * math.pi),
        ("rev/min", "rad/s", 2 * math.pi / 60),
        ("min", "s", 60.0),
        ("%", "", 0.01),
        ("pct", "", 0.01),
        ("mcd", "cd", 1e-3),
        ("kHz", "1/s", 1e3),
        ("kOhm", "ohm", 1e3),
        ("V/kOhm", "A", 1e-3),
        ("gravity", "m/s^2", 9.80665),
    ],
)
def test_a_unit_has_its_factor_to_si(text: str, shown: str, factor: float) -> None:
    unit = read_unit(text)
    assert unit.text == shown
    assert unit.factor == pytest.approx(factor, rel=1e-14)


@given(
    st.lists(
        st.tuples(st.sampled_from(SYMBOLS), st.sampled_from(["", "^2", "**3", "^-1"])),
        min_size=1,
        max_size=4,
    ),
    st.sampled_from([" ", "*", "/", " / "]),
)
def test_coherent_units_have_the_factor_1_of_the_unit_library(
    parts: list[tuple[str, str]], between: str
) -> None:
    text = between.join(symbol + power for symbol, power in parts)
    assert COHERENT.fullmatch(text)
    assert read_unit(text) == Unit(text, 1.0)
    assert _convert(text.replace("Ohm", "ohm")).factor == pytest.approx(1.0, rel=1e-14)


@pytest.mark.parametrize(
    "text",
    [
        "foo",
        "m +",
        "m + s",
        "2 m",
        "m^",
        "m)(",
        "dB",
        "nan",
        "9**9**9**9",
        "m^2^9^9",
        "mm^9999",
        "__import__('os')",
        "m." * 29,
        "s" * 59 + "!",
        "m" * 61,
    ],
)
def test_what_is_no_unit_is_refused(text: str) -> None:
    with pytest.raises(FormulaError) as caught:
        read_unit(text, Location("a.yaml", 2, 5))
    message = f"a.yaml:2:5: '{text[:60]}' is not a unit. Write it like 'kg m^2'"
    assert str(caught.value).startswith(message)


@given(st.text(alphabet="kgmsNrad12^*/() .-%°e+", max_size=62))
def test_any_text_is_a_unit_or_a_formula_error(text: str) -> None:
    try:
        unit = read_unit(text)
    except FormulaError:
        return
    assert math.isfinite(unit.factor)
    assert unit.factor > 0


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("mN m", "kg m^2/s^2", True),
        ("deg", "rad", True),
        ("deg", "", True),
        ("rpm", "1/s", True),
        ("N m", "N", False),
        ("rad", "rad/s", False),
        ("", "m", False),
    ],
)
def test_units_of_one_quantity(one: str, other: str, same: bool) -> None:
    assert same_quantity(one, other) is same
    assert same_quantity(other, one) is same


def test_a_quantity_needs_a_unit() -> None:
    with pytest.raises(FormulaError, match="'parsnips' is not a unit"):
        same_quantity("m", "parsnips")


def test_all_units_that_are_told_of_are_read_and_stand_with_their_like() -> None:
    listed = unit_list()
    assert {*SYMBOLS, *COMMON} <= {name for names in listed.values() for name in names}
    for base, names in listed.items():
        assert names[0] == base and read_unit(base).factor == 1.0
        assert [name for name in names if not same_quantity(name, base)] == []
    with pytest.raises(FormulaError):
        read_unit("X")  # what is no symbol, and has none after its prefix


def test_a_symbol_may_have_any_prefix_that_is_told() -> None:
    powers = dict(
        zip(PREFIXES.split(), (-15, -12, -9, -6, -3, -2, -1, 2, 3, 6, 9, 12), strict=True)
    )
    for symbol in {*SYMBOLS} - {"kg", "cd"}:  # mcd is taken for a millionth of a day
        for prefix, power in powers.items():
            assert read_unit(prefix + symbol).factor == pytest.approx(10.0**power), prefix + symbol


def test_common_units_are_those_of_the_unit_library() -> None:
    for text in COMMON:
        own, other = read_unit(text), _convert(text)
        assert (own.factor, own.written) == (other.factor, other.written)
        assert powers_of(own.text) == powers_of(other.text)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("mV", "V"),
        ("kohm", "ohm"),
        ("nF", "F"),
        ("mN m/A", "N m/A"),
        ("mV s/deg", "V s/rad"),
        ("kV/s", "V/s"),
        ("uA", "A"),
        ("kJ/K", "J/K"),
        ("kN m s/deg", "N m s/rad"),
        ("mW/cm^2", "W/m^2"),
        ("g/s", "kg/s"),
        ("mm/s^3", "m/s^3"),
        ("uS", "S"),
    ],
)
def test_a_unit_is_told_by_its_usual_name(text: str, shown: str) -> None:
    assert read_unit(text).text == shown


def test_si_units_and_common_ones_do_not_load_the_unit_library() -> None:
    code = (
        "import sys; from tracewire.library import load_library; from tracewire.formula import *;"
        "load_library(); read_unit('N m s/rad'); read_unit('mm'); sys.exit('pint' in sys.modules)"
    )
    script = f"import sys; sys.path[:0] = {sys.path!r}; {code}"
    assert run([sys.executable, "-c", script], check=False).returncode == 0


@pytest.mark.parametrize(("given", "wanted"), [("g", "m/s^2"), ("mV/g", "V s^2/m")])
def test_a_gram_that_is_meant_for_gravity_is_told(given: str, wanted: str) -> None:
    assert "has the unit 'gravity'" in quantity_hint(given, wanted)
    assert quantity_hint(given, "N", "Give it in N.") == "Give it in N."
    assert quantity_hint("kg", wanted) == ""
