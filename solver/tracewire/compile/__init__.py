"""From a diagram to a model: flat equations, one tape, and functions written from the tape."""

from tracewire.compile.constants import OF_THE_PAST
from tracewire.compile.dimensions import unit_problems
from tracewire.compile.flat import (
    Flat,
    FlatBlock,
    FlatEvent,
    FlatMemory,
    FlatParameter,
    FlatState,
    FlatTransition,
)
from tracewire.compile.lowered import Mode, Reset, Transition
from tracewire.compile.model import Model, compile
from tracewire.compile.name_clashes import find_name_clashes
from tracewire.compile.remarks import remarks_of
from tracewire.compile.rest import AtRest, at_rest
from tracewire.compile.statements import statement_problems

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
    "unit_problems",
]
