"""Block declarations: what a block is, and how a folder of block files becomes a library."""

from tracewire.library.declare import Block, Effect, Input, Output, Parameter, State
from tracewire.library.describe import describe, describe_json, palette
from tracewire.library.load import Library, load_library

__all__ = [
    "Block",
    "Effect",
    "Input",
    "Library",
    "Output",
    "Parameter",
    "State",
    "describe",
    "describe_json",
    "load_library",
    "palette",
]
