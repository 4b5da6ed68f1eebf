"""`draw`: the picture of a diagram, and the files that it becomes."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from tracewire.arguments import checked
from tracewire.diagram import Diagram
from tracewire.draw.build import DrawOptions, graph_of
from tracewire.draw.graph import Graph
from tracewire.draw.layout import Layout, layout_of
from tracewire.draw.mermaid import mermaid_of
from tracewire.draw.needed import Needed
from tracewire.draw.png import png_of
from tracewire.draw.separate import separate_wires
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


@checked
def draw(
    diagram: Diagram,
    depth: int = 0,
    *,
    names: bool = False,
    units: bool = False,
    measured: bool = False,
    effects: Collection[str] = (),
    sensors: Collection[str] = (),
    needed: Mapping[str, Needed] | None = None,
    problems: Sequence[Problem] = (),
    like: Drawing | None = None,
) -> Drawing:
    """The picture of a diagram, laid out from left to right with feedback drawn backwards.

    depth: how many levels of subsystems are open. names, units: the name and the unit of each
    signal on its wire. measured: the names of blocks with a sensor in blue, and the sensors that
    have terms. effects: blocks in green, and `sensors` the measured signals whose sensors are.
    needed: what data need at a block, as a plot below it; the block is amber where no effect gives
    it. problems: what is wrong with the diagram, in red at its place. like: a picture of a similar
    diagram, whose blocks keep their order from top to bottom. The same diagram gives the same
    picture. Raises OptionError: a depth below 0.
    """
    if depth < 0:
        what = f"the depth of a picture cannot be {depth}"
        raise OptionError.one(what, hint="0 draws subsystems as boxes; 1 opens one level of them.")
    options = DrawOptions(depth, names, units, measured, effects, sensors, needed or {})
    graph = graph_of(diagram, options, problems)
    layout = separate_wires(graph, layout_of(graph, None if like is None else like.layout))
    return Drawing(graph, layout, svg_of(graph, layout))
