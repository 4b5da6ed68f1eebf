"""The picture of a graph as Mermaid, a text that many sites and editors draw."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tracewire.draw.graph import Connection, Graph, Node, Outline
from tracewire.draw.layout import all_nodes

BRACKETS: dict[Outline, tuple[str, str]] = {
    "circle": ("((", "))"),
    "pill": ("([", "])"),
    "triangle": ("[/", "/]"),
    "tag": (">", "]"),
}
CLASSES = {
    "wrong": "fill:#fdecea,stroke:#c62828",
    "effect": "fill:#e6f4ea,stroke:#1a7f37",
    "needed": "fill:#fff6e0,stroke:#b45309",
}


def mermaid_of(graph: Graph) -> str:
    """The graph as a flowchart from left to right; an open subsystem is a subgraph."""
    names = {node.id: f"n{number}" for number, node in enumerate(all_nodes(graph))}
    ends: dict[str, str] = {}  # a port of an open subsystem is a small node of its own
    texts: dict[str, str] = {}
    for node in all_nodes(graph):
        for number, port in enumerate(node.ports):
            ends[port.id] = names[node.id] + (f"p{number}" if node.nodes else "")
            texts[port.id] = "" if node.nodes else port.text
    lines = ["flowchart LR", f"  %% {_quoted(graph.title)}", *_level(graph.nodes, names, "  ")]
    wires = [*graph.wires, *(wire for node in all_nodes(graph) for wire in node.wires)]
    lines += [_wire(wire, ends, texts) for wire in wires]
    for mark, style in CLASSES.items():
        marked = [names[node.id] for node in all_nodes(graph) if node.mark == mark]
        if marked:
            lines += [f"  classDef {mark} {style}", f"  class {','.join(marked)} {mark}"]
    return "\n".join(lines) + "\n"


def _level(nodes: Sequence[Node], names: dict[str, str], indent: str) -> Iterator[str]:
    for node in nodes:
        own = names[node.id]
        if not node.nodes:
            first, last = BRACKETS.get(node.look.outline, ("[", "]"))
            yield f'{indent}{own}{first}"{_content(node)}"{last}'
            continue
        yield f'{indent}subgraph {own}["{_quoted(node.name)}"]'
        for number, port in enumerate(node.ports):
            yield f'{indent}  {own}p{number}(["{_quoted(port.text)}"])'
        yield from _level(node.nodes, names, f"{indent}  ")
        yield f"{indent}end"


def _content(node: Node) -> str:
    """What a block says: its formula or its type, and its name."""
    look = node.look
    inside = "/".join(look.lines) or node.type.replace("_", " ")
    return "<br>".join(_quoted(text) for text in (inside, node.name) if text)


def _wire(wire: Connection, ends: dict[str, str], texts: dict[str, str]) -> str:
    words = " ".join(text for text in (wire.label, texts.get(wire.target, "")) if text)
    label = f'|"{_quoted(words)}"|' if words else ""
    return f"  {ends[wire.source]} -->{label} {ends[wire.target]}"


def _quoted(text: str) -> str:
    """Text that is never a command: what is no letter, digit or space is written as a number."""
    return "".join(c if c.isalnum() or c in " _.," else f"#{ord(c)};" for c in text)
