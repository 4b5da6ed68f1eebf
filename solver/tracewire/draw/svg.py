"""The picture of a laid-out graph as SVG: a group for each block, with its full name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from html import escape

from tracewire.draw.font import FAMILY, shorten, text_width
from tracewire.draw.graph import Connection, Graph, Node, Plot
from tracewire.draw.layout import Layout, Point, Rectangle, all_nodes, all_wires
from tracewire.draw.limits import LETTER, SHAPE
from tracewire.draw.outlines import arrow, number, outline, path, rim

COLOURS = {
    "": ("#ffffff", "#3b4a5a"),
    "frame": ("#f6f8fa", "#9aa7b4"),
    "tag": ("#eef4fa", "#3b6ea5"),
    "subsystem": ("#fdf8ec", "#8a6d1f"),
    "effect": ("#e6f4ea", "#1a7f37"),
    "bar": ("#3b4a5a", "#3b4a5a"),
    "needed": ("#fff6e0", "#b45309"),
    "wrong": ("#fdecea", "#c62828"),
}
"""The fill and the line of each kind of block."""
STYLE = f"""
.tracewire text{{font-family:"{FAMILY}",Verdana,sans-serif;\
font-size:{LETTER.size:g}px;fill:#1f2933}}
.tracewire .small{{font-size:{LETTER.small:g}px;fill:#52606d}}
.tracewire .title{{font-size:{LETTER.title:g}px}}
.tracewire .wire path{{fill:none;stroke:#3b4a5a;stroke-width:1.1}}
.tracewire .wire .head{{fill:#3b4a5a;stroke:none}}
.tracewire .wire.effect path{{stroke:#1a7f37}}
.tracewire .wire.effect .head{{fill:#1a7f37}}
.tracewire .wire.wrong path{{stroke:#c62828;stroke-dasharray:4 3}}
.tracewire .wire.wrong .head{{fill:#c62828}}
.tracewire .dot{{fill:#3b4a5a}}
.tracewire .outline{{stroke-width:1.2}}
.tracewire .curve{{fill:none;stroke:#0b63a5;stroke-width:1.6;stroke-linejoin:round}}
.tracewire .axis{{fill:none;stroke:#c3cad2;stroke-width:.8}}
.tracewire .axis.ink{{stroke:#1f2933}}
.tracewire .mistake{{fill:#c62828}}
.tracewire .measured{{fill:#0b63a5}}
.tracewire .need{{fill:#3b4a5a}}
.tracewire .law{{fill:none;stroke:#b45309;stroke-width:1.6;stroke-linejoin:round}}
.tracewire .law.effect{{stroke:#1a7f37}}
.tracewire .event{{fill:none;stroke:#b45309;stroke-width:1.3}}
"""


def svg_of(graph: Graph, layout: Layout) -> str:
    """The picture as a text of SVG; every text of the diagram is escaped in it."""
    notes = [("small", f"⚡ {note}") for note in graph.notes]
    notes += [("small mistake", f"✗ {mistake}") for mistake in graph.mistakes]
    width = max(layout.width, SHAPE.least_width, *(_note_width(text) for _, text in notes), 0)
    height = layout.height + SHAPE.note_line * len(notes) + (6 if notes else 0)
    box = f"0 0 {number(width + 2 * SHAPE.margin)} {number(height + 2 * SHAPE.margin)}"
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" class="tracewire" viewBox="{box}" '
        f'width="{number(width + 2 * SHAPE.margin)}" height="{number(height + 2 * SHAPE.margin)}">',
        f"<title>{_text(graph.title)}</title>",
        f"<style>{STYLE}</style>",
        f'<g transform="translate({number(SHAPE.margin)} {number(SHAPE.margin)})">',
    ]
    frames = [node for node in all_nodes(graph) if node.nodes]
    lines += [line for node in frames for line in _block(node, layout)]
    owners = {port.id: node for node in all_nodes(graph) for port in node.ports}
    # what an effect shares with other wires was there before it
    wires = sorted(all_wires(graph), key=lambda wire: _wire_mark(owners, wire) != "effect")
    lines += [_wire(owners, wire, layout) for wire in wires]
    lines += [
        f'<circle class="dot" cx="{number(x)}" cy="{number(y)}" r="2.4"/>' for x, y in layout.dots
    ]
    lines += [line for node in all_nodes(graph) if not node.nodes for line in _block(node, layout)]
    for text, place in layout.labels.values():
        lines.append(_write(text, place.x, place.y + LETTER.small, "small"))
    for row, (kind, text) in enumerate(notes):
        y = layout.height + SHAPE.note_line * (row + 1)
        lines.append(_write(shorten(text, LETTER.most_note, LETTER.small), 12, y, kind))
    return "\n".join([*lines, "</g>", "</svg>"]) + "\n"


def _note_width(text: str) -> float:
    return min(text_width(text, LETTER.small), LETTER.most_note) + 24


def _text(text: str) -> str:
    """Text for XML, which has no control characters."""
    return escape("".join(c if c.isprintable() or c in "\n\t" else "�" for c in text), quote=False)


def _attribute(text: str) -> str:
    return f'"{escape("".join(c if c.isprintable() else "�" for c in text))}"'


def _write(text: str, x: float, y: float, kind: str = "", anchor: str = "") -> str:
    named = f' class="{kind}"' if kind else ""
    placed = f' text-anchor="{anchor}"' if anchor else ""
    return f'<text x="{number(x)}" y="{number(y)}"{named}{placed}>{_text(text)}</text>'


def _wire(nodes: Mapping[str, Node], wire: Connection, layout: Layout) -> str:
    line = list(layout.wires[wire.id])
    line[0] = _to_rim(nodes[wire.source], line[0], layout)
    line[-1] = _to_rim(nodes[wire.target], line[-1], layout)
    kind = f"wire {_wire_mark(nodes, wire)}".strip()
    reached = nodes[wire.target]
    inwards = (line[-1][0] > line[-2][0]) != reached.flipped  # of a frame
    head = arrow(line) if not reached.nodes or inwards else ""
    return (
        f'<g class="{kind}" data-signal={_attribute(wire.signal)}>'
        f'<path d="{path(line)}"/>{head}</g>'
    )


def _wire_mark(nodes: Mapping[str, Node], wire: Connection) -> str:
    """The mark of a wire: its own, or that of an effect at one of its ends."""
    ends = (nodes[wire.source].mark, nodes[wire.target].mark)
    return wire.mark or ("effect" if "effect" in ends else "")


def _to_rim(node: Node, point: Point, layout: Layout) -> Point:
    return rim(node.look.outline, layout.nodes[node.id], point, node.flipped)


def _block(node: Node, layout: Layout) -> Iterator[str]:
    """The group of a block: its tooltip, outline, what is inside of it, and its name below."""
    place = layout.nodes[node.id]
    look = node.look
    fill, stroke = COLOURS[node.mark or _kind(node)]
    classes = " ".join(part for part in ("block", node.mark, "measured" * node.measured) if part)
    yield (
        f'<g class="{classes}" data-block={_attribute(node.id)} data-type={_attribute(node.type)}>'
    )
    yield f"<title>{_text(chr(10).join(node.details))}</title>"
    shape = outline(look.outline, place, node.flipped)
    yield f'<path class="outline" d="{shape}" fill="{fill}" stroke="{stroke}"/>'
    yield from _inside(node, place)
    for port in node.ports:
        if port.text:
            x, y = layout.ports[port.id]
            west = (port.side == "west") != node.flipped
            anchor = "start" if west else "end"
            up = -4 if node.nodes else 3  # in a frame its wire goes on
            yield _write(port.text, x + (5 if west else -5), y + up, "small", anchor)
    if node.id in layout.names:
        name = layout.names[node.id]
        kind = "measured" if node.measured else ""
        yield _write(node.name, name.x + name.width / 2, name.y + LETTER.size, kind, "middle")
        if node.plot is not None:
            yield from _plot(node.plot, node.mark, name)
    if node.has_event:
        x, y = place.x + place.width - 7, place.y - 4
        flash = path([(x + 3, y - 6), (x - 1, y), (x + 3, y), (x - 1, y + 6)])
        yield f'<path class="event" d="{flash}"/>'
    yield "</g>"


def _plot(plot: Plot, mark: str, below: Rectangle) -> Iterator[str]:
    """The plot of what is needed, and its words, at the foot of what stands below a block."""
    wide, high = SHAPE.plot
    x, y = below.x + below.width / 2, below.y + LETTER.size * LETTER.line_height + high / 2
    half = (wide / 2 - 4, high / 2 - 5)
    yield f'<path class="axis" d="{path([(x - wide / 2, y), (x + wide / 2, y)])}"/>'
    if plot.zero is not None:
        at = x + plot.zero * half[0]
        yield f'<path class="axis" d="{path([(at, y - high / 2 + 2), (at, y + high / 2 - 2)])}"/>'
    for a, b in plot.dots:
        place = f'cx="{number(x + a * half[0])}" cy="{number(y - b * half[1])}"'
        yield f'<circle class="need" {place} r="1.6"/>'
    kind = "law" if mark == "needed" else "law effect"
    for line in plot.lines:
        drawn = path([(x + a * half[0], y - b * half[1]) for a, b in line])
        yield f'<path class="{kind}" d="{drawn}"/>'
    yield _write(plot.words, x, below.y + below.height - 3, "small", "middle")


def _kind(node: Node) -> str:
    if node.nodes:
        return "frame"
    if node.look.outline in ("tag", "bar"):
        return node.look.outline
    return "subsystem" if node.is_subsystem else ""


def _inside(node: Node, place: Rectangle) -> Iterator[str]:
    """The text or the curve of a block."""
    look = node.look
    x, y = place.x + place.width / 2, place.y + place.height / 2
    if node.nodes:
        yield _write(look.lines[0], place.x + 10, place.y + 16)
    elif look.fraction:
        yield _write(look.lines[0], x, y - 4, "", "middle")
        half = max(6.0, *(text_width(line) / 2 + 2 for line in look.lines))
        bar = path([(x - half, y), (x + half, y)])
        yield f'<path class="axis ink" d="{bar}"/>'
        yield _write(look.lines[1], x, y + 12, "", "middle")
    elif look.curve:
        west, east = node.labels
        x += (east - west) / 2 if node.flipped else (west - east) / 2
        wide, high = (place.width - west - east) / 2 - 6, place.height / 2 - 7
        if look.axes:
            yield f'<path class="axis" d="{path([(x - wide, y), (x + wide, y)])}"/>'
            yield f'<path class="axis" d="{path([(x, y - high), (x, y + high)])}"/>'
        for line in look.curve:
            drawn = path([(x + wide * a, y - high * b) for a, b in line])
            yield f'<path class="curve" d="{drawn}"/>'
    else:
        west, east = node.labels
        x += (east - west) / 2 if node.flipped else (west - east) / 2
        if look.outline == "triangle":
            x += place.width * (0.13 if node.flipped else -0.13)
        for n, text in enumerate(look.lines):
            yield _write(text, x, y + 4 + 14 * (n - (len(look.lines) - 1) / 2), "", "middle")
