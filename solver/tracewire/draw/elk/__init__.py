"""The Eclipse Layout Kernel (elkjs), run by QuickJS: a graph in JSON gets its coordinates."""

from tracewire.draw.elk.engine import lay_out

__all__ = ["lay_out"]
