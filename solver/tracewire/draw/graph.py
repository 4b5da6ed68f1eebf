"""The nouns of a picture before it is laid out: nodes with ports, and the wires between ports."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Side = Literal["west", "east"]
Outline = Literal["box", "triangle", "circle", "pill", "bar", "tag", "frame"]
"""`tag` is an input or output of the diagram, `frame` a subsystem that is open."""
Mark = Literal["", "wrong", "effect", "needed"]
Line = tuple[tuple[float, float], ...]
"""A line through points."""


@dataclass(frozen=True)
class Port:
    """Where wires meet a node. `text` stands inside of the node, beside the port."""

    id: str
    side: Side
    text: str = ""


@dataclass(frozen=True)
class Look:
    """What a block looks like, in pixels: its outline, lines of text and a curve inside of it.

    `curve` has lines in a box from (-1, -1) to (1, 1), y upwards; `axes`: whether the axes of the
    curve are drawn.
    """

    outline: Outline
    width: float
    height: float
    lines: tuple[str, ...] = ()
    curve: tuple[Line, ...] = ()
    axes: bool = False
    fraction: bool = False


@dataclass(frozen=True)
class Plot:
    """A small plot below the name of a block: dots and lines in a box from (-1, -1) to (1, 1), y
    upwards, and the words below it. `zero` is where x is 0; None: outside of the box."""

    dots: Line
    lines: tuple[Line, ...]
    words: str
    zero: float | None


@dataclass(frozen=True)
class Node:
    """A block of the picture. `id` is its full name, `name` what is written below it.

    `details` are the lines of its tooltip. `flipped`: it is drawn from right to left, and so is
    all that is inside of it. An open subsystem has `nodes` and `wires` of its own, in which its own
    ports may end. `labels` are the widths that the texts of its ports take on the side of inputs
    and on that of outputs.
    """

    id: str
    name: str
    type: str
    look: Look
    ports: tuple[Port, ...]
    details: tuple[str, ...] = ()
    flipped: bool = False
    ordered: bool = False
    mark: Mark = ""
    has_event: bool = False
    measured: bool = False
    is_subsystem: bool = False
    labels: tuple[float, float] = (0.0, 0.0)
    plot: Plot | None = None
    nodes: tuple[Node, ...] = ()
    wires: tuple[Connection, ...] = ()


@dataclass(frozen=True)
class Connection:
    """A wire from a port to a port. `signal` is the full name of what it carries.

    `back`: it closes a loop, against the direction of the picture. `main`: it is a part of the way
    forward, from a sum to the integrators, and is drawn straight where that can be.
    """

    id: str
    source: str
    target: str
    signal: str
    label: str = ""
    back: bool = False
    main: bool = False
    mark: Mark = ""


@dataclass(frozen=True)
class Graph:
    """A picture before it is laid out. `notes` are written below it, `mistakes` in red."""

    title: str
    nodes: tuple[Node, ...]
    wires: tuple[Connection, ...]
    notes: tuple[str, ...] = ()
    mistakes: tuple[str, ...] = ()
