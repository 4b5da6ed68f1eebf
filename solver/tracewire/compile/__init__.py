"""From a diagram to a model: flat equations, one tape, and functions written from the tape."""

from tracewire.compile.flat import Flat, FlatBlock, FlatEvent, FlatParameter, FlatState
from tracewire.compile.lower import Mode
from tracewire.compile.model import Model, compile
from tracewire.compile.source import Function

__all__ = [
    "Flat",
    "FlatBlock",
    "FlatEvent",
    "FlatParameter",
    "FlatState",
    "Function",
    "Mode",
    "Model",
    "compile",
]
