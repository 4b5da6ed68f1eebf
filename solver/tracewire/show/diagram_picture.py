"""The picture with which a report opens: the diagram, and in colour what a trace added to it."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from tracewire.diagram import Diagram
from tracewire.draw import draw
from tracewire.show.document import Figure

PLAIN = "The blocks and wires of the diagram; blue names are measured"
COLOURED = f"{PLAIN}, and green is what the trace added"


def diagram_figure(diagram: Diagram, effects: Collection[str] = ()) -> Figure:
    """The figure that shows a diagram; `effects` are the blocks that are drawn in colour."""

    def plot(path: Path) -> Path:
        return draw(diagram, measured=True, effects=effects).write(path)

    caption = COLOURED if effects else PLAIN
    return Figure("diagram.svg", caption, plot)
