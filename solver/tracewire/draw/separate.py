"""Wires of two signals that a layout has put on each other are moved apart.

ELK places the upright parts of wires between two columns of blocks. Now and then it places two of
them on the same line, and a reader takes the two signals for one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from tracewire.draw.graph import Connection, Graph, Node
from tracewire.draw.layout import Layout, Point, Rectangle, all_nodes
from tracewire.draw.limits import WIRES

Line = tuple[Point, ...]


@dataclass(frozen=True)
class _Upright:
    """The part of a wire at `x` from its point number `at` to the next one."""

    wire: Connection
    at: int
    x: float
    low: float
    high: float


def separate_wires(graph: Graph, layout: Layout) -> Layout:
    """The layout with no two signals on one upright line, where there is room beside it."""
    levels = [(graph.wires, graph.nodes), *((node.wires, node.nodes) for node in all_nodes(graph))]
    wires = [wire for inside, _ in levels for wire in inside]
    blocks = {wire.id: nodes for inside, nodes in levels for wire in inside}
    for parts in _in_line(_trunks(wires, layout.wires)):
        if _is_free(parts, wires, layout.wires, WIRES.together):
            continue
        for step in WIRES.steps:
            moved = _moved(parts, step, layout)
            if moved is not None and _has_room(parts, wires, blocks, moved):
                layout = moved
                break
    return layout


def _uprights(wire: Connection, line: Line) -> Iterator[_Upright]:
    """The upright parts of a wire but for its ends, which are held by ports."""
    for at in range(1, len(line) - 2):
        (x, y), (other_x, other_y) = line[at], line[at + 1]
        if x == other_x:
            yield _Upright(wire, at, x, min(y, other_y), max(y, other_y))


def _trunks(wires: Sequence[Connection], lines: Mapping[str, Line]) -> list[list[_Upright]]:
    """Upright parts that one signal has on one line: where its wires part, they stay together."""
    found: dict[tuple[str, float], list[_Upright]] = {}
    for wire in wires:
        for part in _uprights(wire, lines[wire.id]):
            found.setdefault((wire.source, part.x), []).append(part)
    return [found[key] for key in sorted(found)]


def _in_line(trunks: Sequence[list[_Upright]]) -> list[list[_Upright]]:
    """Those on whose line another signal stands, too, be it above or below them."""
    in_order = sorted(trunks, key=lambda parts: parts[0].x)
    found = []
    for n, parts in enumerate(in_order):
        for other in in_order[n + 1 :]:
            if other[0].x - parts[0].x > WIRES.together:
                break
            if other[0].wire.source != parts[0].wire.source:
                found += [parts, other]
    return found


def _is_free(
    parts: Sequence[_Upright], wires: Sequence[Connection], lines: Mapping[str, Line], gap: float
) -> bool:
    """Whether no other signal runs along these parts and the level ones beside them.

    gap: up to which distance in px another one is seen as on them.
    """
    own = [pair for part in parts for pair in _beside(lines[part.wire.id], part.at)]
    return not any(
        _lie_together(one, other, gap)
        for wire in wires
        if wire.source != parts[0].wire.source
        for other in pairwise(lines[wire.id])
        for one in own
    )


def _beside(line: Line, at: int) -> list[tuple[Point, Point]]:
    """A part of a wire with those before and behind it."""
    return list(pairwise(line[at - 1 : at + 3]))


def _lie_together(one: tuple[Point, Point], other: tuple[Point, Point], gap: float) -> bool:
    """Whether two parts run side by side within a distance in px."""
    for across in (0, 1):
        along = 1 - across
        if one[0][across] != one[1][across] or other[0][across] != other[1][across]:
            continue
        if abs(one[0][across] - other[0][across]) > gap:
            continue
        first, second = sorted(p[along] for p in one), sorted(p[along] for p in other)
        if min(first[1], second[1]) - max(first[0], second[0]) > WIRES.together:
            return True
    return False


def _moved(parts: Sequence[_Upright], step: float, layout: Layout) -> Layout | None:
    """The layout with these parts and their dots moved sideways, if no wire turns back by that."""
    lines = dict(layout.wires)
    x = parts[0].x + step
    for part in parts:
        line = list(lines[part.wire.id])
        before, behind = line[part.at - 1][0], line[part.at + 2][0]
        for end in (before, behind):
            if (part.x - end) * (x - end) <= 0 or abs(x - end) < WIRES.least_gap:
                return None
        line[part.at] = (x, line[part.at][1])
        line[part.at + 1] = (x, line[part.at + 1][1])
        lines[part.wire.id] = tuple(line)

    def is_on_parts(dot: Point) -> bool:
        return dot[0] == parts[0].x and any(part.low <= dot[1] <= part.high for part in parts)

    dots = tuple((x, dot[1]) if is_on_parts(dot) else dot for dot in layout.dots)
    return replace(layout, wires=lines, dots=dots)


def _has_room(
    parts: Sequence[_Upright],
    wires: Sequence[Connection],
    blocks: Mapping[str, Sequence[Node]],
    moved: Layout,
) -> bool:
    """Whether moved parts lie on no other signal and run through no block or name."""
    places = [
        place
        for node in blocks[parts[0].wire.id]
        for place in (moved.nodes[node.id], moved.names.get(node.id))
        if place is not None
    ]
    return _is_free(parts, wires, moved.wires, WIRES.least_gap) and not any(
        _runs_through(pair, place)
        for part in parts
        for pair in _beside(moved.wires[part.wire.id], part.at)
        for place in places
    )


def _runs_through(part: tuple[Point, Point], place: Rectangle) -> bool:
    (x0, y0), (x1, y1) = part
    return (
        max(x0, x1) > place.x
        and min(x0, x1) < place.x + place.width
        and max(y0, y1) > place.y
        and min(y0, y1) < place.y + place.height
    )
