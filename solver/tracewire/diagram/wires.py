"""Wires: the signals that inputs and outputs name."""

from __future__ import annotations

import re

from tracewire.diagram.body import Body, Reference
from tracewire.diagram.diagram import Wire
from tracewire.diagram.names import split_index
from tracewire.diagram.problems import clip
from tracewire.diagram.strict import Items, Node, Scalar

SIGNAL = re.compile(r"[^\W\d]\w*(?: \w+)*(?:\.[^\W\d]\w*)*")
"""What is meant as a name, though none may be called so: the definition of it is refused."""


def read_wire(node: Node, body: Body, what: str, block: str = "") -> Wire | None:
    """The wire from the signal that `node` names, which may have a minus in front."""
    place = body.place(node, block)
    if not isinstance(node, Scalar):
        hint = "Connect several signals through a block of type sum."
        body.problems.add(f"{what} takes one signal", place, (), hint)
        return None
    text = node.text.strip()
    negative = text.startswith("-")
    signal, index = split_index(text[1:].strip() if negative else text)
    if node.number is not None:
        hint = "Put the number into a block of type constant, and name that."
        body.problems.add(f"{what} takes a signal, not the number {clip(text)}", place, (), hint)
    elif not SIGNAL.fullmatch(signal):
        hint = "Put the formula into a block of type expression, and name that."
        body.problems.add(f"{what} takes a signal, not '{clip(text)}'", place, (), hint)
    else:
        body.references.append(Reference(signal, "signal", place))
        return Wire(signal, negative, place, index)
    return None


def read_wires(node: Node, body: Body, what: str, many: bool, block: str) -> tuple[Wire, ...]:
    """The wires of an input: one, or where it takes `many`, any number."""
    nodes = node.items if many and isinstance(node, Items) else (node,)
    wires = (read_wire(item, body, what, block) for item in nodes)
    return tuple(wire for wire in wires if wire is not None)
