from .constants import OF_THE_PAST
from .dimensions import unit_problems
from .flat import Flat, FlatBlock, FlatEvent, FlatMemory, FlatParameter, FlatState, FlatTransition
from .lowered import Mode, Reset, Transition
from .model import Model, compile
from .name_clashes import find_name_clashes
from .quantity_units import unit_of_quantity
from .remarks import remarks_of
from .rest import AtRest, at_rest
from .statements import statement_problems

__all__ = [
    "OF_THE_PAST",
    "AtRest",
    "Flat",
    "FlatBlock",
    "FlatEvent",
    "FlatMemory",
    "FlatParameter",
    "FlatState",
    "FlatTransition",
    "Mode",
    "Model",
    "Reset",
    "Transition",
    "at_rest",
    "compile",
    "find_name_clashes",
    "remarks_of",
    "statement_problems",
    "unit_of_quantity",
    "unit_problems",
]
