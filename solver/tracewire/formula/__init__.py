"""The formula language: a small, checked subset of Python expressions.

A formula is arithmetic (`+ - * / **`), comparisons (`< <= > >=`), `and / or / not`, the choice
`a if c else b`, and the functions of `FUNCTIONS`. Nothing else parses, and text, depth and size are
bounded, so a formula from a stranger can do nothing but arithmetic. It is never given to `eval`.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from tracewire.formula.dimension import dimension_of, dimension_text
from tracewire.formula.evaluation import evaluate
from tracewire.formula.expression import (
    DELAYS,
    Call,
    Expression,
    Name,
    Number,
    calls_in,
    has_delay,
    names_of,
    read_at_once,
    rename,
)
from tracewire.formula.functions import CONSTANTS, FUNCTIONS, OPERATIONS
from tracewire.formula.order import evaluation_order
from tracewire.formula.parser import (
    is_condition,
    is_name,
    name_hint,
    number_hint,
    parse,
    parse_condition,
    parse_quantity,
)
from tracewire.formula.quantities import QUANTITIES, Quantity
from tracewire.formula.text import number_text, to_text
from tracewire.formula.unit_rules import Term, times, unit_term
from tracewire.formula.units import Unit, has_offset, quantity_hint, read_unit, same_quantity

if TYPE_CHECKING:
    from tracewire.formula.arrays import ALONG, evaluate_along

__all__ = [
    "ALONG",
    "CONSTANTS",
    "DELAYS",
    "FUNCTIONS",
    "OPERATIONS",
    "QUANTITIES",
    "Call",
    "Expression",
    "Name",
    "Number",
    "Quantity",
    "Term",
    "Unit",
    "calls_in",
    "dimension_of",
    "dimension_text",
    "evaluate",
    "evaluate_along",
    "evaluation_order",
    "has_delay",
    "has_offset",
    "is_condition",
    "is_name",
    "name_hint",
    "names_of",
    "number_hint",
    "number_text",
    "parse",
    "parse_condition",
    "parse_quantity",
    "quantity_hint",
    "read_at_once",
    "read_unit",
    "rename",
    "same_quantity",
    "times",
    "to_text",
    "unit_term",
]


def __getattr__(name: str) -> object:
    """The names that need numpy, which a look at blocks or units does without."""
    if name in ("ALONG", "evaluate_along"):
        return getattr(import_module("tracewire.formula.arrays"), name)
    raise AttributeError(f"module 'tracewire.formula' has no attribute '{name}'")
