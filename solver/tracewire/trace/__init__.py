"""From a diagram and measured series to the effect that the diagram lacks."""

from tracewire.trace.found import Found, FoundEffect
from tracewire.trace.trace import trace

__all__ = ["Found", "FoundEffect", "trace"]
