"""`draw`: the picture of a diagram, and the files that it becomes."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

from tracewire.diagram import Diagram
from tracewire.draw.build import DrawOptions, graph_of
from tracewire.draw.graph import Graph
from tracewire.draw.layout import Layout, layout_of
from tracewire.draw.mermaid import mermaid_of
from tracewire.draw.png import png_of
from tracewire.draw.svg import svg_of
from tracewire.errors import OptionError, Problem, unknown
from tracewire.files import write_file, writing


@dataclass(frozen=True)
class Drawing:
    """The picture of a diagram: its graph, where everything is, and the picture as SVG."""

    graph: Graph
    layout: Layout
    svg: str

    @property
    def mermaid(self) -> str:
        """The picture as a text of Mermaid, which has a layout of its own."""
        return mermaid_of(self.graph)

    @property
    def png(self) -> bytes:
        """The picture as PNG, with two pixels for each of SVG."""
        return png_of(self.svg, max(self.layout.width, self.layout.height))

    def write(self, path: str | Path) -> Path:
        """Write the picture as .svg, .png or .mmd (Mermaid), and return its path.

        Raises OptionError: another ending, a file that cannot be written.
        """
        path = Path(path)
        if path.suffix not in ENDINGS:
            what = f"'{path}': {unknown('file ending', path.suffix, ENDINGS).what}"
            raise OptionError([Problem(what, hint=f"End it in {', '.join(ENDINGS)}.")])
        with writing(path):
            return write_file(path, ENDINGS[path.suffix](self))

    def _repr_svg_(self) -> str:
        """How a notebook shows it."""
        return self.svg


ENDINGS: dict[str, Callable[[Drawing], str | bytes]] = {
    ".svg": lambda drawing: drawing.svg,
    ".png": lambda drawing: drawing.png,
    ".mmd": lambda drawing: drawing.mermaid,
}
"""What a picture becomes by the ending of its file."""


def draw(
    diagram: Diagram,
    depth: int = 0,
    *,
    names: bool = False,
    units: bool = False,
    measured: bool = False,
    effects: Collection[str] = (),
    problems: Sequence[Problem] = (),
) -> Drawing:
    """The picture of a diagram, laid out from left to right with feedback drawn backwards.

    depth: how many levels of subsystems are open. names, units: the name and the unit of each
    signal on its wire. measured: the names of blocks with a sensor in blue. effects: blocks in
    green. problems: what is wrong with the diagram, in red at its place. The same diagram gives the
    same picture. Raises OptionError: a depth below 0.
    """
    if depth < 0:
        what = f"the depth of a picture cannot be {depth}"
        raise OptionError.one(what, hint="0 draws subsystems as boxes; 1 opens one level of them.")
    options = DrawOptions(depth, names, units, measured, effects)
    graph = graph_of(diagram, options, problems)
    layout = layout_of(graph)
    return Drawing(graph, layout, svg_of(graph, layout))
