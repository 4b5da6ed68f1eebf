"""Units: what a user writes behind a value, and the factor that turns it into SI."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from tracewire.errors import FormulaError, Location, Problem
from tracewire.formula.common_units import COMMON
from tracewire.formula.dimension import powers_of, shortest_text
from tracewire.formula.limits import LIMITS

if TYPE_CHECKING:
    from pint import UnitRegistry

OFFSET = re.compile(
    r"(?<![A-Za-z])(deg(ree)?_?|°)(C|F|celsius|fahrenheit)(?![A-Za-z])", re.IGNORECASE
)

SYMBOLS = ("kg", "mol", "cd", "rad", "sr", "Hz", "Pa", "Wb", "Ohm", "m", "s", "A", "K", "N", "J",
    "W", "C", "V", "F", "S", "T", "H")  # fmt: skip
"""The coherent units of SI that have a symbol; none stands behind one that it begins with."""
SYMBOL = rf"(?:{'|'.join(SYMBOLS)})"
POWER = r"(?:\s*(?:\^|\*\*)\s*[+-]?\d{1,2}(?:\.\d{1,2})?)"
COHERENT = re.compile(rf"(?:1|{SYMBOL}{POWER}?)(?:(?:\s*[*/]\s*|\s+){SYMBOL}{POWER}?)*")
"""Products and quotients of coherent SI units: their factor is 1, and they need no unit library."""
TORQUE = re.compile(r"\b([kmuµμn]?N)m\b")
"""`Nm` and `mNm`, as headers of files have it; the unit library takes it for a number of metres."""
OHM = re.compile(r"(?<=[A-Za-zµμ])Ohm\b")
"""`kOhm`: the unit library knows `kohm`, as it knows `ohm`."""
GRAM = re.compile(r"(?<![A-Za-z])g(?![A-Za-z])")
GRAVITY = "'g' is a gram. An acceleration in multiples of that of gravity has the unit 'gravity'."
WELL_FORMED = re.compile(rf"(?:1(?!\d)|[^\W\d]++{POWER}?|[°%]|[()\s]|\){POWER}|[*/](?!\*))+")
"""Units and whole powers only: the unit library works out any number, such as 9**9**9, for ever."""


HEADERS = ("rev = turn", "pct = percent", "mcd = 0.001 candela")
"""Units as headers of files have them; without this `pct` is the carat with a prefix, and `mcd` a
millionth of a day."""


@dataclass(frozen=True)
class Unit:
    """A unit: the text that is shown for SI values, and the factor from the user's unit to SI.

    `deg` has the factor pi/180 and is shown as `rad`; a unit that is SI already has the factor 1
    and keeps the user's text. Hz is 1/s, never 2 pi/s. `written` is the user's text where that is
    not SI.
    """

    text: str
    factor: float
    written: str = ""


@lru_cache(maxsize=1)
def _registry() -> UnitRegistry[Any]:
    import pint  # half a second: only units that are neither SI nor common pay for it

    registry: UnitRegistry[Any] = pint.UnitRegistry(autoconvert_offset_to_baseunit=False)
    for definition in HEADERS:
        registry.define(definition)
    return registry


@lru_cache(maxsize=1024)
def _convert(text: str) -> Unit:
    registry = _registry()
    try:
        unit = registry.parse_units(text)
        quantity = (1.0 * unit).to_base_units()
        if registry.Quantity(0.0, unit).to_base_units().magnitude != 0:
            raise ValueError("a scale with an offset, such as degC, has no factor")
    except Exception as error:  # pint raises its own, tokenizer and arithmetic errors alike
        raise ValueError(type(error).__name__) from None
    factor = float(quantity.magnitude)
    # pint's base of mass is the kilogram and its base of angle is the radian, as ours
    if not math.isfinite(factor) or factor <= 0:
        raise ValueError("factor")
    if factor == 1.0:
        return Unit(text, 1.0)
    shown = f"{quantity.units:~C}"
    powers = powers_of(shown)
    return Unit(shortest_text(powers) if powers else shown, factor, text)


def read_unit(text: str, place: Location = Location()) -> Unit:
    """The unit that `text` names, such as `kg m^2`, `N m s/rad` or `deg`; '' is the number 1.

    Raises FormulaError where the text is no unit.
    """
    if text.strip() in ("", "1"):
        return Unit("", 1.0)
    try:
        if len(text) > LIMITS.unit_characters:
            raise ValueError("length")
        text = OHM.sub("ohm", TORQUE.sub(r"\1 m", text))
        if COHERENT.fullmatch(text.strip()):
            return Unit(text.strip(), 1.0)
        if text.strip() in COMMON:
            quantity, factor = COMMON[text.strip()]
            return Unit(quantity, factor, text.strip() if factor != 1.0 else "")
        if not WELL_FORMED.fullmatch(text):
            raise ValueError("grammar")
        return _convert(text.strip())
    except ValueError:
        hint = "Write it like 'kg m^2', 'N m s/rad', 'deg' or '1/s'."
        if has_offset(text):
            hint = "A temperature is in K: 20 degC are 293.15 K. A difference of 1 degC is 1 K."
        raise FormulaError([Problem(f"'{text[:60]}' is not a unit", place, (), hint)]) from None


def has_offset(text: str) -> bool:
    """Whether a text is a scale of temperature whose zero is not zero, such as degC."""
    return bool(OFFSET.search(text))


def same_quantity(one: str, other: str) -> bool:
    """Whether two units measure the same quantity, such as `mN m` and `kg m^2/s^2`; '' is a number.

    Radians count as numbers. Raises FormulaError where a text is no unit.
    """
    for text in (one, other):
        read_unit(text)
    if one.strip() == other.strip():
        return True
    both = (TORQUE.sub(r"\1 m", text).replace("Ohm", "ohm").strip() or "1" for text in (one, other))
    first, second = (_registry().parse_units(text) for text in both)
    return bool(first.is_compatible_with(second))


def quantity_hint(given: str, wanted: str, otherwise: str = "") -> str:
    """What to do about a unit of another quantity than the one that is wanted."""
    meant = GRAM.sub("gravity", given)
    return GRAVITY if meant != given and same_quantity(meant, wanted) else otherwise
