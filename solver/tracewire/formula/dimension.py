"""Dimensions: a unit of the SI as powers of its base units."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache

from tracewire.formula.unit_rules import Term, times

# The powers of base units. An angle has none: rad is 1.
# fmt: off
POWERS: dict[str, Term] = {
    "1": {}, "rad": {}, "sr": {}, "m": {"m": 1}, "kg": {"kg": 1}, "s": {"s": 1}, "A": {"A": 1},
    "K": {"K": 1}, "mol": {"mol": 1}, "cd": {"cd": 1}, "Hz": {"s": -1},
    "N": {"kg": 1, "m": 1, "s": -2}, "Pa": {"kg": 1, "m": -1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2}, "W": {"kg": 1, "m": 2, "s": -3}, "C": {"A": 1, "s": 1},
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1}, "F": {"kg": -1, "m": -2, "s": 4, "A": 2},
    "Ohm": {"kg": 1, "m": 2, "s": -3, "A": -2}, "ohm": {"kg": 1, "m": 2, "s": -3, "A": -2},
    "S": {"kg": -1, "m": -2, "s": 3, "A": 2},
    "Wb": {"kg": 1, "m": 2, "s": -2, "A": -1}, "T": {"kg": 1, "s": -2, "A": -1},
    "H": {"kg": 1, "m": 2, "s": -2, "A": -2},
}
# fmt: on
SHOWN = ("N", "N m", "N/m", "N s/m", "N m s", "Pa", "W", "V", "Ohm", "H", "F", "C", "T", "Wb")
"""Derived units by which a dimension is told."""
DERIVED = ("N", "W", "V", "ohm", "Pa", "H", "F", "S")
"""Units of which a product may have one in place of kg; of those that are as short the first."""
HEAT = ("K", "mol")
"""Beside these energy is in J: without them it may be a torque."""
PART = re.compile(
    r"\s*([*/])?\s*(\()?\s*([A-Za-z]+|1)\s*(?:(?:\^|\*\*)\s*([+-]?\d+(?:\.\d+)?))?\s*(\))?"
)
"""A sign, what opens, a unit, its power, what closes."""


@lru_cache(maxsize=1024)
def dimension_of(text: str) -> Term | None:
    """The dimension of a coherent SI unit such as `N m s/rad`; None for '' and for other texts."""
    found = powers_of(text)
    return None if found is None else {n: power for n, power in found.items() if n != "rad"}


def powers_of(text: str) -> Term | None:
    """The dimension of a coherent SI unit, with its power of rad; None for '' and other texts."""
    at, end, found = 0, len(text.rstrip()), Term()
    outer = 0  # the sign before an open parenthesis; 0 where none is open
    while at < end:
        part = PART.match(text, at)
        if part is None or part[3] not in POWERS or (part[2] and outer):
            return None
        sign = -1 if part[1] == "/" else 1
        if part[2]:
            outer, sign = sign, 1
        base: Term = {"rad": 1.0} if part[3] == "rad" else POWERS[part[3]]
        found = times(found, base, float(part[4] or 1) * sign * (outer or 1))
        if part[5]:
            if not outer:
                return None
            outer = 0
        at = part.end()
    return found if end and not outer else None


def dimension_text(dimension: Mapping[str, float]) -> str:
    """A unit of this dimension: `N m`, `m/s^2`, or `1`, which is a number or an angle."""
    for text in SHOWN:
        if dimension_of(text) == dimension:
            return text
    return shortest_text(dimension)


def shortest_text(powers: Mapping[str, float]) -> str:
    """The shortest product for powers of base units: `V/s`, `N m/rad`, `kg/m^3`."""
    one = dict(powers)
    derived = (*DERIVED, "J") if any(name in one for name in HEAT) else DERIVED
    ways = [one]
    for name in derived:
        for power in (1.0, -1.0):
            rest = times(one, POWERS[name], -power)
            ways += [{name: power, **rest}] if "kg" in one and "kg" not in rest else []
    best = min(ways, key=_length)
    over = [_power(name, power) for name, power in best.items() if power > 0]
    under = [_power(name, -power) for name, power in best.items() if power < 0]
    return "/".join([" ".join(over) or "1", *under])


def _length(way: Mapping[str, float]) -> tuple[float, int, bool]:
    """What a product is long by: its powers, what it is divided by, and a 1 above the line."""
    under = sum(power < 0 for power in way.values())
    return sum(map(abs, way.values())), under, under == len(way)


def _power(name: str, power: float) -> str:
    return name if power == 1 else f"{name}^{power:g}"
