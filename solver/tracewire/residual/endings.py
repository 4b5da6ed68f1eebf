"""Units at the ends of names, as in `theta_deg` and `omega_rad_s`."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tracewire.errors import FormulaError
from tracewire.formula import same_quantity

BASES = (
    *("rad", "mrad", "deg", "m", "cm", "mm", "um", "km", "N", "mN", "kN", "Nm", "mNm", "V", "mV"),
    *("A", "mA", "s", "ms", "us", "Hz", "kg", "g", "Pa", "kPa", "bar", "W", "K", "nm"),
)
SUFFIX = re.compile(rf"({'|'.join(BASES)})(?:(_per_s|_s|ps)(?:\^|_)?(2?))?")
OTHERS = {"dps": "deg/s", "rpm": "rpm", "kmh": "km/h", "kph": "km/h"}


def endings(name: str) -> Iterator[tuple[str, str]]:
    """A name cut before a unit at its end, and the unit: `theta` and `deg` of `theta_deg`."""
    for at in range(len(name) - 1, 0, -1):
        if name[at] != "_":
            continue
        rest = name[at + 1 :]
        found = SUFFIX.fullmatch(rest)
        if rest in OTHERS:
            yield name[:at], OTHERS[rest]
        elif found is not None:
            per = f"/s^{found[3]}" if found[3] else "/s" if found[2] else ""
            yield name[:at], found[1] + per


def alike(unit: str, other: str) -> bool:
    """Whether two units measure the same quantity; an unknown one may measure any."""
    try:
        return not other or same_quantity(unit, other)
    except FormulaError:
        return True
