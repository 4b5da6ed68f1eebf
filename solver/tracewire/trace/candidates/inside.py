"""Subsystems that a trace may look into: those whose text one block alone is made from."""

from __future__ import annotations

from collections import Counter

from tracewire.diagram import BlockUse, Diagram, find_signal


def opened(diagram: Diagram) -> dict[str, BlockUse]:
    """The blocks at the top whose subsystems may get an effect, by name.

    An effect is added to the text of a definition. So that has to be in the diagram's own text or
    in one that it extends, and no other block may be made from it.
    """
    uses = Counter(_definitions(diagram))
    return {
        name: use
        for name, use in diagram.blocks.items()
        if use.subsystem is not None
        and not use.row
        and use.subsystem.file == diagram.file
        and uses[use.subsystem.place] == 1
    }


def _definitions(diagram: Diagram) -> list[object]:
    inside = [use.subsystem for use in diagram.blocks.values() if use.subsystem is not None]
    return [place for sub in inside for place in (sub.place, *_definitions(sub))]


def local_name(diagram: Diagram, within: str, name: str) -> str:
    """A signal of the flat equations as a block inside a subsystem names it; '' where it cannot.

    within: the block that the subsystem is, '' for the diagram itself.
    """
    if not within or name in ("", "t"):
        return name
    use = diagram.blocks[within]
    assert use.subsystem is not None
    own = name.removeprefix(f"{within}.")
    if own != name:
        return own if find_signal(use.subsystem, own) == own else ""
    for port, wires in use.inputs.items():
        for wire in wires:
            if find_signal(diagram, wire.signal) == name and not (wire.negative or wire.index):
                return port
    return ""
