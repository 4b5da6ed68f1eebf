"""How long a formula may be, so that a wrong or hostile one is refused rather than waited for."""

from __future__ import annotations

from typing import Final


class FormulaLimits:
    """Of formulas and units. The numbers are judgements, far above what people write."""

    most_characters: Final[int] = 4000
    """Of a formula."""
    most_parts: Final[int] = 1000
    """Of a formula: names, numbers, operations."""
    most_nesting: Final[int] = 60
    """Of its parts in each other."""
    unit_characters: Final[int] = 60
    """Of a unit."""
    largest_power: Final[float] = 100.0
    """Of a unit."""


LIMITS = FormulaLimits()
