"""Where everything goes: a graph is handed to ELK, and comes back with coordinates."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

from tracewire.draw.font import text_width
from tracewire.draw.graph import Connection, Graph, Node, Port
from tracewire.draw.limits import LAYOUT, LETTER, SHAPE
from tracewire.elk import lay_out

Point = tuple[float, float]

OPTIONS = {
    "elk.algorithm": "layered",
    "elk.direction": "RIGHT",
    "elk.edgeRouting": "ORTHOGONAL",
    "elk.json.shapeCoords": "ROOT",
    "elk.json.edgeCoords": "ROOT",
    "elk.randomSeed": "1",
    "elk.padding": "[top=12,left=12,bottom=12,right=12]",
    "elk.spacing.nodeNode": "18",
    "elk.spacing.edgeNode": "14",
    "elk.spacing.edgeEdge": "10",
    "elk.spacing.labelNode": "3",
    "elk.spacing.labelPortHorizontal": "3",
    "elk.spacing.labelPortVertical": "2",
    "elk.spacing.componentComponent": "30",
    "elk.layered.spacing.nodeNodeBetweenLayers": "26",
    "elk.layered.spacing.edgeNodeBetweenLayers": "12",
    "elk.layered.spacing.edgeEdgeBetweenLayers": "9",
    "elk.layered.thoroughness": "1",
}
"""ELK's own names; https://eclipse.dev/elk/reference/options.html tells each."""
STRAIGHT = {"elk.layered.priority.straightness": "10"}
COMPACT = {
    "elk.layered.thoroughness": "3",
    "elk.layered.nodePlacement.strategy": "NETWORK_SIMPLEX",
    "elk.layered.considerModelOrder.strategy": "NODES_AND_EDGES",
}
"""Half as high, with straighter lines and nearer to the order of the file; it takes a time
that grows with the square of the wires."""


@dataclass(frozen=True)
class Rectangle:
    """A place in the picture in px, y downwards."""

    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class Layout:
    """Where a graph's parts are, by their ids.

    nodes, names (the labels below nodes) and labels (on wires, by port) are rectangles, ports
    points, wires lines of points from source to target, dots the points where wires part.
    """

    width: float
    height: float
    nodes: dict[str, Rectangle]
    names: dict[str, Rectangle]
    labels: dict[str, tuple[str, Rectangle]]
    ports: dict[str, Point]
    wires: dict[str, tuple[Point, ...]]
    dots: tuple[Point, ...]


def layout_of(graph: Graph, like: Layout | None = None) -> Layout:
    """The layout of a graph: left to right, wires at right angles, the same each time.

    like: the layout of a similar graph; blocks that are in both keep their order from top to
    bottom. Feedback shall stand below: where it does not, a picture that is like no other is laid
    out upside down, too.
    """
    few = sum(1 for _ in all_wires(graph)) <= LAYOUT.most_compact
    if like is None:
        return _own(graph, few)
    root = _root(graph, few, upside_down=False)
    _keep_order(root, like, {node.id for node in all_nodes(graph) if node.flipped})
    asked = _read(lay_out(root), graph)
    kept = _order_kept(asked, like)
    if few and kept < LAYOUT.enough_kept:  # the order that was asked for may turn feedback upwards
        own = _own(graph, few)
        if _order_kept(own, like) > kept:
            return own
    return asked


def _own(graph: Graph, few: bool) -> Layout:
    """The layout of a graph that is like no other one, with its feedback below where it can be."""
    layout = _read(lay_out(_root(graph, few, upside_down=False)), graph)
    if few and _feedback_height(graph, layout) > 0:
        other = mirrored(_read(lay_out(_root(graph, few, upside_down=True)), graph))
        if _feedback_height(graph, other) <= 0:
            return other
    return layout


def _order_kept(layout: Layout, like: Layout) -> float:
    """The share of pairs of blocks that stand above each other as in another layout."""

    def middles(one: Layout) -> dict[str, float]:
        return {id: place.y + place.height / 2 for id, place in one.nodes.items()}

    before, now = middles(like), middles(layout)
    pairs = [
        (before[one] - before[other], now[one] - now[other])
        for one, other in combinations([id for id in before if id in now], 2)
    ]
    apart = [(old, new) for old, new in pairs if abs(old) > LAYOUT.level]
    return sum(old * new > 0 for old, new in apart) / len(apart) if apart else 1.0


def _root(graph: Graph, few: bool, upside_down: bool) -> dict[str, Any]:
    """The graph in ELK's JSON."""
    options = OPTIONS | (COMPACT if few else {})
    if any(node.nodes for node in graph.nodes):
        options["elk.hierarchyHandling"] = "INCLUDE_CHILDREN"
    labels = _labels(graph.wires) | {
        port: text for node in _all(graph.nodes) for port, text in _labels(node.wires).items()
    }
    return {
        "id": "",
        "layoutOptions": options,
        "children": [_child(node, labels, upside_down) for node in graph.nodes],
        "edges": _edges(graph.nodes, graph.wires),
    }


def _keep_order(part: dict[str, Any], like: Layout, flipped: Collection[str]) -> None:
    """Ask ELK to leave the blocks in the order from top to bottom that they have in a layout.

    A new block in a feedback (`flipped`) stands below those.
    """
    for child in part.get("children", ()):
        id = child["id"].removeprefix("node ")
        place = like.nodes.get(id)
        middle = like.height if place is None else place.y + place.height / 2
        if place is not None or id in flipped:
            child["layoutOptions"]["elk.position"] = f"(0,{middle:.1f})"
        _keep_order(child, like, flipped)
    if "children" in part:
        part["layoutOptions"]["elk.layered.crossingMinimization.semiInteractive"] = "true"


def _feedback_height(graph: Graph, layout: Layout) -> float:
    """How far the feedback stands above the other blocks on the average, in px."""

    def middle(flipped: bool) -> float:
        places = [layout.nodes[node.id] for node in graph.nodes if node.flipped == flipped]
        return sum(p.y + p.height / 2 for p in places) / len(places) if places else 0.0

    return middle(False) - middle(True) if any(node.flipped for node in graph.nodes) else 0.0


def _all(nodes: Sequence[Node]) -> Iterator[Node]:
    """The nodes and those inside of them."""
    for node in nodes:
        yield node
        yield from _all(node.nodes)


def all_nodes(graph: Graph) -> Iterator[Node]:
    """Every node of a graph, those of open subsystems behind them."""
    return _all(graph.nodes)


def all_wires(graph: Graph) -> Iterator[Connection]:
    """Every wire of a graph."""
    yield from graph.wires
    for node in _all(graph.nodes):
        yield from node.wires


def _labels(wires: Sequence[Connection]) -> dict[str, str]:
    """What stands on the wires that leave a port, once for all of them."""
    return {wire.source: wire.label for wire in wires if wire.label}


def _label(text: str, size: float) -> dict[str, Any]:
    return {"text": text, "width": text_width(text, size), "height": size * LETTER.line_height}


def _below(node: Node) -> list[dict[str, Any]]:
    """What stands below a block: its name, and its plot with the words of that."""
    name = _label(node.name, LETTER.size)
    if node.plot is None:
        return [name] if node.name else []
    words = _label(node.plot.words, LETTER.small)
    wide, high = SHAPE.plot
    width = max(name["width"], words["width"], wide)
    return [{"text": node.name, "width": width, "height": name["height"] + high + words["height"]}]


def _child(node: Node, labels: dict[str, str], upside_down: bool) -> dict[str, Any]:
    options = {
        "elk.portConstraints": "FIXED_ORDER" if node.ordered else "FIXED_SIDE",
        "elk.nodeLabels.placement": f"OUTSIDE V_{'TOP' if upside_down else 'BOTTOM'} H_CENTER",
        "elk.portLabels.placement": "OUTSIDE NEXT_TO_PORT_IF_POSSIBLE",
        "elk.portAlignment.default": "CENTER",
        "elk.spacing.portPort": "18",
    }
    child: dict[str, Any] = {
        "id": f"node {node.id}",
        "width": node.look.width,
        "height": node.look.height,
        "layoutOptions": options,
        "labels": _below(node),
        "ports": [_port(node, port, n, labels, upside_down) for n, port in enumerate(node.ports)],
    }
    if node.nodes:
        child["children"] = [_child(inner, labels, upside_down) for inner in node.nodes]
        child["edges"] = _edges(node.nodes, node.wires, node.flipped)
        top, bottom = (16, 30) if upside_down else (30, 16)
        widths = node.labels[::-1] if node.flipped else node.labels
        left, right = (max(width + 18, 34) for width in widths)
        options["elk.padding"] = f"[top={top},left={left},bottom={bottom},right={right}]"
        options["elk.nodeSize.constraints"] = "PORTS MINIMUM_SIZE"
        options["elk.nodeSize.minimum"] = f"({node.look.width},{node.look.height})"
        del child["width"], child["height"]
    return child


def _port(
    node: Node, port: Port, number: int, labels: dict[str, str], upside_down: bool
) -> dict[str, Any]:
    west = (port.side == "west") != node.flipped
    # ELK counts clockwise from the top left: down on the right side, up on the left one
    index = len(node.ports) - number if west != upside_down else number
    found: dict[str, Any] = {
        "id": f"port {port.id}",
        "width": 0,
        "height": 0,
        "layoutOptions": {
            "elk.port.side": "WEST" if west else "EAST",
            "elk.port.index": str(index),
        },
    }
    if port.id in labels:
        found["labels"] = [_label(labels[port.id], LETTER.small)]
    return found


def _edges(
    nodes: Sequence[Node], wires: Sequence[Connection], leftwards: bool = False
) -> list[dict[str, Any]]:
    """The wires for ELK: one that goes from right to left is handed over the other way round.

    leftwards: they are those of a frame whose way forward goes from right to left.
    """
    back = {port.id for node in nodes if node.flipped != leftwards for port in node.ports}
    found = []
    for wire in wires:
        ends = [f"port {wire.source}", f"port {wire.target}"]
        against = wire.back or wire.source in back or wire.target in back
        if against != leftwards:
            ends.reverse()
        straight = STRAIGHT if wire.main and not wire.back else {}
        found.append(
            {
                "id": f"wire {wire.id}",
                "sources": ends[:1],
                "targets": ends[1:],
                "layoutOptions": straight,
            }
        )
    return found


def _read(placed: dict[str, Any], graph: Graph) -> Layout:
    nodes: dict[str, Rectangle] = {}
    names: dict[str, Rectangle] = {}
    labels: dict[str, tuple[str, Rectangle]] = {}
    ports: dict[str, Point] = {}
    wires: dict[str, tuple[Point, ...]] = {}
    dots: set[Point] = set()

    def visit(part: dict[str, Any]) -> None:
        for child in part.get("children", ()):
            id = child["id"].removeprefix("node ")
            nodes[id] = _rectangle(child)
            for label in child.get("labels", ()):
                names[id] = _rectangle(label)
            for port in child.get("ports", ()):
                own = port["id"].removeprefix("port ")
                ports[own] = (port["x"], port["y"])
                for label in port.get("labels", ()):
                    labels[own] = (label["text"], _rectangle(label))
            visit(child)
        for edge in part.get("edges", ()):
            (section,) = edge["sections"]
            points = [section["startPoint"], *section.get("bendPoints", ()), section["endPoint"]]
            line = [(p["x"], p["y"]) for p in points]
            wires[edge["id"].removeprefix("wire ")] = _upright(line)
            dots.update((p["x"], p["y"]) for p in edge.get("junctionPoints", ()))

    visit(placed)
    for wire in all_wires(graph):
        line = wires[wire.id]
        if math.dist(line[-1], ports[wire.source]) < math.dist(line[0], ports[wire.source]):
            wires[wire.id] = line[::-1]
    return Layout(
        placed["width"], placed["height"], nodes, names, labels, ports, wires, tuple(sorted(dots))
    )


def mirrored(layout: Layout) -> Layout:
    """The layout upside down; every part keeps its size."""

    def turned(place: Rectangle) -> Rectangle:
        return replace(place, y=layout.height - place.y - place.height)

    def point(at: Point) -> Point:
        return at[0], layout.height - at[1]

    return replace(
        layout,
        nodes={id: turned(place) for id, place in layout.nodes.items()},
        names={id: turned(place) for id, place in layout.names.items()},
        labels={id: (text, turned(place)) for id, (text, place) in layout.labels.items()},
        ports={id: point(at) for id, at in layout.ports.items()},
        wires={id: tuple(map(point, line)) for id, line in layout.wires.items()},
        dots=tuple(map(point, layout.dots)),
    )


def _upright(line: Sequence[Point]) -> tuple[Point, ...]:
    """The line with right angles only: beside ports of frames ELK is off by parts of a pixel."""
    found = [line[0]]
    for x, y in line[1:]:
        before_x, before_y = found[-1]
        if before_x != x and before_y != y:
            middle = (before_x + x) / 2
            found += [(middle, before_y), (middle, y)]
        found.append((x, y))
    return tuple(found)


def _rectangle(part: dict[str, Any]) -> Rectangle:
    return Rectangle(part["x"], part["y"], part["width"], part["height"])
