"""Block declarations: what a block is, and how a folder of block files becomes a library."""

from tracewire.library.declare import (
    Block,
    Effect,
    Event,
    Input,
    Mode,
    Output,
    Parameter,
    State,
    Transition,
)
from tracewire.library.describe import describe, describe_json, palette
from tracewire.library.load import Library, load_library

__all__ = [
    "Block",
    "Effect",
    "Event",
    "Input",
    "Library",
    "Mode",
    "Output",
    "Parameter",
    "State",
    "Transition",
    "describe",
    "describe_json",
    "load_library",
    "palette",
]
