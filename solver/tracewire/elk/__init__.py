"""The Eclipse Layout Kernel (elkjs), run by QuickJS: a graph in JSON gets its coordinates."""

from tracewire.elk.engine import lay_out, start

__all__ = ["lay_out", "start"]
