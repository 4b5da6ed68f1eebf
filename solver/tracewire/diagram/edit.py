"""Edits of a diagram: changes of its text that keep comments and layout, each read anew.

An edit returns a new diagram with the same file and another text, and raises DiagramError where
that text is no diagram any more. OptionError says that what should be edited does not exist.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable
from dataclasses import replace

from tracewire.diagram.diagram import BlockUse, Diagram, Wire
from tracewire.diagram.override import localise
from tracewire.diagram.rewrite import reread
from tracewire.diagram.source_map import SourceMap
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.diagram.text_edits import entry_after, item_last, replace_node
from tracewire.errors import DiagramError, OptionError


def add_addend(
    diagram: Diagram,
    sum_name: str,
    block_name: str,
    block_line: str,
    negative: bool = False,
    element: tuple[int, int] | None = None,
    comment: str = "",
) -> Diagram:
    """The diagram with a new block, on a line behind the sum's, and its output in the sum.

    sum_name: the sum by its definition: `torque` at the top, `bearing.total` for the sum `total` in
    the definition of the subsystem `bearing`.
    block_line: what stands behind the name, such as `{type: viscous, rate: omega, c: 0}`.
    negative: the sum takes the output away. element: the number of the element that it is added to,
    and how many there are, of a sum of vectors: a gain makes a vector of it. comment: what is said
    behind the line.
    """
    diagram, inside, blocks, name = _own_sum(diagram, sum_name)
    port, node = _addends(inside.blocks[name], inside, blocks)
    line = block_line.strip().removeprefix(f"{block_name}:").strip()
    text = diagram.text
    added, more = block_name, []
    if element is not None:
        added = f"{block_name}_alone"
        shares = ", ".join(str(int(n == element[0])) for n in range(element[1]))
        gain = f"{{type: gain, of: {block_name}, k: [{shares}]}}"
        more = [entry_after(text, blocks, name, added, gain)]
    wire = f"-{added}" if negative else added
    if isinstance(node, Items):
        wired = item_last(text, node, wire)
    else:
        assert isinstance(node, Scalar)
        wired = replace_node(node, f"[{text[node.start : node.end]}, {wire}]")
    # what is put at one place stands in the text in the reverse order
    new = reread(
        diagram, [*more, entry_after(text, blocks, name, block_name, line, comment), wired]
    )
    _expect(new, sum_name, port, [*_signals(inside.blocks[name], port), added])
    return new


def difference(old: Diagram, new: Diagram) -> str:
    """The lines in which the texts of two diagrams differ, as a unified diff; '' where none."""
    lines = difflib.unified_diff(
        old.text.splitlines(keepends=True),
        new.text.splitlines(keepends=True),
        str(old.file),
        str(new.file),
        n=1,
    )
    unended = "\n\\ No newline at end of file\n"  # as `diff` says it, so that a patch applies
    return "".join(line if line.endswith("\n") else f"{line}{unended}" for line in lines)


def _addends(use: BlockUse, inside: Diagram, blocks: Entries) -> tuple[str, Node]:
    """The input of a sum that takes several wires, and its node."""
    port = many_port(use, inside)
    return port, blocks.inside(use.name).values[port]


def many_port(use: BlockUse, inside: Diagram) -> str:
    """The input of a sum that takes several wires. Raises OptionError: it is no sum."""
    known = inside.library[use.type].inputs if use.type in inside.library else ()
    many = [port.name for port in known if port.many]
    if not many or use.subsystem is not None:
        what = f"block '{use.name}' is a {use.type}, and has no input for several signals"
        raise OptionError.one(what, use.place, hint="Name a sum.")
    return many[0]


def with_addend(diagram: Diagram, sum_name: str, wire: Wire) -> Diagram:
    """The diagram with one more wire in a sum; its text stays as it is."""
    old = diagram.blocks[sum_name]
    port = many_port(old, diagram)
    wired = replace(old, inputs={**old.inputs, port: (*old.inputs[port], wire)})
    return replace(diagram, blocks={**diagram.blocks, sum_name: wired})


def with_bodies(diagram: Diagram, edit: Callable[[Diagram], Diagram]) -> Diagram:
    """The diagram with each subsystem edited that it defines or that one of its blocks is."""
    blocks = {
        name: use if use.subsystem is None else replace(use, subsystem=edit(use.subsystem))
        for name, use in diagram.blocks.items()
    }
    subsystems = {name: edit(inside) for name, inside in diagram.subsystems.items()}
    return replace(diagram, blocks=blocks, subsystems=subsystems)


def _own_sum(diagram: Diagram, sum_name: str) -> tuple[Diagram, Diagram, Entries, str]:
    """The diagram with the inputs of a sum in its own text, and where the sum stands."""
    source_map = SourceMap(diagram)
    inside, blocks, name = source_map.block(sum_name)
    _, node = _addends(inside.blocks[name], inside, blocks)
    diagram = localise(diagram, source_map, [node])
    return diagram, *SourceMap(diagram).block(sum_name)


def _signals(use: BlockUse, port: str) -> list[str]:
    return [wire.signal for wire in use.inputs[port]]


def _expect(diagram: Diagram, sum_name: str, port: str, signals: list[str]) -> None:
    """Make sure that an edit did what it should, however the text was laid out."""
    inside, _, name = SourceMap(diagram).block(sum_name)
    use = inside.blocks[name]
    if _signals(use, port) != signals:
        what = "the list of addends is laid out in a way that cannot be edited by program"
        raise DiagramError.one(what, use.place, hint="Write it like [a, b].")
