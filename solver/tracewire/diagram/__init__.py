"""Diagrams: from a YAML file to a checked description, and edits of its text."""

from tracewire.diagram.diagram import (
    Array,
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
from tracewire.diagram.loops import cycles, shown_cycle
from tracewire.diagram.names import (
    element_name,
    find_parameter,
    find_recorded,
    find_signal,
    find_state,
    signals,
    split_index,
    state_names,
    states,
)
from tracewire.diagram.read import read, read_text

__all__ = [
    "Array",
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
    "cycles",
    "difference",
    "element_name",
    "find_parameter",
    "find_recorded",
    "find_signal",
    "find_state",
    "read",
    "read_text",
    "remove_addend",
    "set_values",
    "shown_cycle",
    "signals",
    "split_index",
    "state_names",
    "states",
]
