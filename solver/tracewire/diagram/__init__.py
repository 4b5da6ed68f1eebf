"""Diagrams: from a YAML file to a checked description, and edits of its text."""

from tracewire.diagram.diagram import (
    BlockUse,
    Channel,
    Crosses,
    Diagram,
    Event,
    InputPort,
    Points,
    Series,
    Use,
    Value,
    Wire,
)
from tracewire.diagram.edit import (
    add_addend,
    add_offset,
    difference,
    remove_addend,
    set_values,
)
from tracewire.diagram.names import (
    find_parameter,
    find_recorded,
    find_signal,
    find_state,
    signals,
    state_names,
    states,
)
from tracewire.diagram.read import read, read_text

__all__ = [
    "BlockUse",
    "Channel",
    "Crosses",
    "Diagram",
    "Event",
    "InputPort",
    "Points",
    "Series",
    "Use",
    "Value",
    "Wire",
    "add_addend",
    "add_offset",
    "difference",
    "find_parameter",
    "find_recorded",
    "find_signal",
    "find_state",
    "read",
    "read_text",
    "remove_addend",
    "set_values",
    "signals",
    "state_names",
    "states",
]
