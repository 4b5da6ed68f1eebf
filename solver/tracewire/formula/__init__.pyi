from .arrays import ALONG, evaluate_along
from .dimension import dimension_of, dimension_text
from .evaluation import evaluate
from .expression import (
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
from .functions import CONSTANTS, FUNCTIONS, OPERATIONS
from .order import evaluation_order
from .parser import (
    is_condition,
    is_name,
    name_hint,
    number_hint,
    parse,
    parse_condition,
    parse_quantity,
)
from .quantities import QUANTITIES, Quantity
from .text import number_text, to_text, two_digits
from .unit_names import PREFIXES, unit_list
from .unit_rules import Term, times, unit_term
from .units import Unit, has_offset, quantity_hint, read_unit, same_quantity

__all__ = [
    "ALONG",
    "CONSTANTS",
    "DELAYS",
    "FUNCTIONS",
    "OPERATIONS",
    "PREFIXES",
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
    "two_digits",
    "unit_list",
    "unit_term",
]
