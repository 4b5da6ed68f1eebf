"""How long a formula may be, so that a wrong or hostile one is refused rather than waited for."""

from __future__ import annotations

from typing import NamedTuple


class FormulaLimits(NamedTuple):
    """Of formulas and units. The numbers are judgements, far above what people write."""

    most_characters: int = 4000
    """Of a formula."""
    most_parts: int = 1000
    """Of a formula: names, numbers, operations."""
    most_nesting: int = 60
    """Of its parts in each other."""
    unit_characters: int = 60
    """Of a unit."""
    largest_power: float = 100.0
    """Of a unit."""


LIMITS = FormulaLimits()
