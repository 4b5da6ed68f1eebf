"""`unit_list`: the units that a reader is told of, from the tables by which they are read."""

from __future__ import annotations

from tracewire.formula.common_units import COMMON
from tracewire.formula.units import SYMBOLS

FURTHER = {
    "m": "in ft",
    "rad": "mrad turn arcmin arcsec",
    "s": "day",
    "kg": "lb",
    "N": "kgf lbf",
    "N m": "Nm mNm",
    "Pa": "psi",
    "J": "eV",
    "C": "mC uC nC pC",
    "mol": "mmol umol",
    "mol/m^3": "mol/L mmol/L",
    "Ohm": "kOhm MOhm",
    "T": "mT",
    "1": "ppm",
}
"""Of each SI unit some of those that the unit library reads; it reads many more."""
HOME = {"": "1", "1/s": "Hz", "ohm": "Ohm"}
"""Texts of SI units that stand with another one."""
PREFIXES = "f p n u m c d h k M G T"
"""Of SI, as they stand before a symbol."""


def unit_list() -> dict[str, tuple[str, ...]]:
    """All symbols of SI, and below each, and below products of them, the units of its quantity."""
    found = {base: [base] for base in ("1", *SYMBOLS)}
    for name, (text, _) in COMMON.items():
        base = HOME.get(text, text)
        found.setdefault(base, [base]).append(name)
    for base, names in FURTHER.items():
        found.setdefault(base, [base]).extend(names.split())
    return {base: tuple(names) for base, names in found.items()}
