"""What is wrong with the geometry of a picture, in words; nothing where all is well."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations, pairwise, product

from tracewire.draw import Drawing
from tracewire.draw.graph import Connection, Node
from tracewire.draw.layout import Layout, Point, Rectangle, all_wires

ROUNDING = 0.01  # px


def faults(drawing: Drawing) -> list[str]:
    """Blocks that overlap, wires that run through blocks or past their ports or on others, skew
    wires."""
    graph, layout = drawing.graph, drawing.layout
    found = [*_overlaps(graph.nodes, layout), *_wires(graph.nodes, graph.wires, layout)]
    found += _shared(list(all_wires(graph)), layout)
    todo = list(graph.nodes)
    while todo:
        node = todo.pop()
        found += _overlaps(node.nodes, layout)
        found += _wires(node.nodes, node.wires, layout)
        found += [
            f"what stands on the wire of {port} overlaps {node.id}"
            for port, (_, place) in layout.labels.items()
            if not node.nodes and _overlap(place, layout.nodes[node.id])
        ]
        found += [
            f"{inner.id} is not inside of {node.id}"
            for inner in node.nodes
            if not _holds(layout.nodes[node.id], layout.nodes[inner.id])
        ]
        found += [
            f"port {port.id} is not at the side of its block"
            for port in node.ports
            if not _at_side(layout.nodes[node.id], layout.ports[port.id])
        ]
        todo += node.nodes
    return found


def _overlaps(nodes: Sequence[Node], layout: Layout) -> Iterator[str]:
    for one, other in combinations(nodes, 2):
        for a in (layout.nodes[one.id], layout.names.get(one.id)):
            for b in (layout.nodes[other.id], layout.names.get(other.id)):
                if a is not None and b is not None and _overlap(a, b):
                    yield f"{one.id} overlaps {other.id}"


def _wires(nodes: Sequence[Node], wires: Sequence[Connection], layout: Layout) -> Iterator[str]:
    for wire in wires:
        line = layout.wires[wire.id]
        if not _near(line[0], layout.ports[wire.source]):
            yield f"wire {wire.id} does not begin at {wire.source}"
        if not _near(line[-1], layout.ports[wire.target]):
            yield f"wire {wire.id} does not end at {wire.target}"
        for (x0, y0), (x1, y1) in pairwise(line):
            if min(abs(x1 - x0), abs(y1 - y0)) > ROUNDING:
                yield f"wire {wire.id} is skew"
            part = Rectangle(min(x0, x1), min(y0, y1), abs(x1 - x0), abs(y1 - y0))
            for node in nodes:
                if _overlap(part, layout.nodes[node.id]):
                    yield f"wire {wire.id} runs through {node.id}"
                name = layout.names.get(node.id)
                if name is not None and _overlap(part, name):
                    yield f"wire {wire.id} runs through the name of {node.id}"


def _shared(wires: Sequence[Connection], layout: Layout) -> Iterator[str]:
    """Wires of two signals that lie on each other for more than a crossing."""
    parts = {
        wire.id: [(p, q, p[1] == q[1]) for p, q in pairwise(layout.wires[wire.id])]
        for wire in wires
    }
    for one, other in combinations(wires, 2):
        if one.source == other.source:
            continue
        for (p, q, level), (r, s, same) in product(parts[one.id], parts[other.id]):
            along, across = (0, 1) if level else (1, 0)
            if level != same or abs(p[across] - r[across]) > 0.5:
                continue
            ends = sorted((p[along], q[along])), sorted((r[along], s[along]))
            if min(ends[0][1], ends[1][1]) - max(ends[0][0], ends[1][0]) > 1:
                yield f"wire {one.id} lies on wire {other.id}"


def _near(one: Point, other: Point) -> bool:
    return abs(one[0] - other[0]) < ROUNDING and abs(one[1] - other[1]) < ROUNDING


def _overlap(a: Rectangle, b: Rectangle) -> bool:
    """Whether a rectangle, or a line, has more than its side in common with a rectangle."""
    return (
        a.x + a.width > b.x + ROUNDING
        and b.x + b.width > a.x + ROUNDING
        and a.y + a.height > b.y + ROUNDING
        and b.y + b.height > a.y + ROUNDING
    )


def _holds(outer: Rectangle, inner: Rectangle) -> bool:
    return (
        outer.x < inner.x
        and outer.y < inner.y
        and inner.x + inner.width < outer.x + outer.width
        and inner.y + inner.height < outer.y + outer.height
    )


def _at_side(block: Rectangle, port: Point) -> bool:
    x, y = port
    on_side = min(abs(x - block.x), abs(x - block.x - block.width)) < ROUNDING
    return on_side and block.y - ROUNDING <= y <= block.y + block.height + ROUNDING
