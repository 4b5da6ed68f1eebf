"""The places of a text that name a part of a diagram, each with what stands there afterwards."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

from tracewire.diagram.choose import NUMBER, is_chosen
from tracewire.diagram.diagram import BlockUse, Diagram
from tracewire.diagram.grammar import OF_A_BLOCK, OF_KINDS, REFERENCE, SHAPES, fitting, parts_of
from tracewire.diagram.replicate import NEIGHBOURS
from tracewire.diagram.shapes import Formula, Mapped, Named, Record, Shape, Text
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.errors import Location

ENDS = ("first", "last", "all")
"""What stands behind the name of a row, and is none of its blocks' outputs."""
PATH = re.compile(r"(?<![\w.\\])[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*", re.ASCII)


@dataclass(frozen=True)
class Part:
    """What gets another name: a part or an output of a diagram, or a subsystem (`is_type`).

    `path` is that of the definition in which it stands, or of the subsystem; `place` is where that
    is defined.
    """

    path: str
    place: Location
    name: str
    is_type: bool = False


def defined_at(inside: Diagram) -> Location:
    """Where a diagram is defined: that of the bodies where a parameter chooses one."""
    if is_chosen(inside):
        body = next(iter(inside.blocks.values())).subsystem
        assert body is not None
        return body.place
    return inside.place


def use_of(inside: Diagram, name: str) -> BlockUse | None:
    """The block of a name; for that of a row its first one."""
    use = inside.blocks.get(name)
    if use is None:
        first = inside.blocks.get(f"{name}_1")
        use = first if first is not None and first.row == name else None
    return use


@dataclass(frozen=True)
class Names:
    """The scalars of one body of a diagram that name the part, each with its new text.

    `top` is the diagram whose text it is. `row`: the name of the line with `replicate` in which one
    looks.
    """

    part: Part
    new: str
    inside: Diagram
    top: Diagram
    row: str = ""

    def of(self, node: Node, shape: Shape) -> Iterator[tuple[Scalar, str]]:
        """Those of a node of a shape."""
        found = fitting(shape, node)
        if isinstance(node, Scalar):
            if isinstance(found, Formula) or (isinstance(found, Text) and _is_path(found.names)):
                yield from self.path(node)
            return
        if found == Record(REFERENCE) and isinstance(node, Entries) and "diagram" in node.values:
            return  # its names are those of another diagram
        for key, value, of in parts_of(found, node) if found is not None else ():
            if key is not None and of == Named("subsystem"):  # its inside is another diagram
                own = self.inside.subsystems.get(key.text)
                if self.part.is_type and own is not None and own.place == self.part.place:
                    yield key, self.replaced(key)
                continue
            if key is not None and isinstance(found, Mapped) and _is_path(found.names):
                yield from self.path(key)
            if key is not None and of == Named("block"):
                use = use_of(self.inside, key.text)
                assert use is not None
                yield from replace(self, row=use.row).block(use, value)
            else:
                yield from self.of(value, of)

    def block(self, use: BlockUse, line: Node) -> Iterator[tuple[Scalar, str]]:
        """The line of a block: its type, its wires and its settings."""
        assert isinstance(line, Entries)
        inside = use.subsystem
        is_use = inside is not None and defined_at(inside) == self.part.place
        own = {} if inside else {p.name: p for p in self.inside.library[use.type].parameters}
        for name, key, value in line:
            if name == "type":
                if self.part.is_type and is_use and isinstance(value, Scalar):
                    yield value, self.replaced(value)
            elif name == "replicate":
                yield from self.row_of(use, value)
            elif name == NUMBER:
                if inside is not None and is_chosen(inside) and isinstance(value, Scalar):
                    yield from self.path(value)
            elif name in OF_A_BLOCK:
                yield from self.of(value, OF_A_BLOCK[name].shape)
            elif name in own:
                yield from self.of(value, SHAPES[OF_KINDS[own[name].kind]])
            elif inside is not None and name in inside.parameters:
                yield from self.of(value, SHAPES["fitted value"])
            else:
                yield from self.of(value, SHAPES["wires"])
            given = is_use and not self.part.is_type and name == self.part.name
            if given and name not in OF_A_BLOCK:
                yield key, self.replaced(key)

    def row_of(self, use: BlockUse, node: Node) -> Iterator[tuple[Scalar, str]]:
        """What stands under `replicate`: a count, and what the ends have in place of the line."""
        if isinstance(node, Scalar):
            yield from self.path(node)
        for name, _, value in node if isinstance(node, Entries) else ():
            if name != "count":
                yield from self.block(use, value)
            elif isinstance(value, Scalar):
                yield from self.path(value)

    def removed(self, node: Node | None) -> Iterator[tuple[Scalar, str]]:
        """What a variant takes away: a name, or a path with or without a section in front."""
        for item in node.items if isinstance(node, Items) else (node,):
            if isinstance(item, Scalar) and not self.part.is_type:
                names = item.text.split(".")
                if names[names[0] in ("blocks", "parameters") and len(names) > 1] == self.part.name:
                    yield item, self.replaced(item)

    def replaced(self, scalar: Scalar) -> str:
        """A scalar that is the old name, as the new one."""
        return self.raw(scalar).replace(self.part.name, self.new)

    def raw(self, scalar: Scalar) -> str:
        """A scalar as it stands in the text; one of another file as it is read."""
        if scalar.place.file != str(self.top.file):
            return scalar.text
        return self.top.text[scalar.start : scalar.end]

    def path(self, scalar: Scalar) -> Iterator[tuple[Scalar, str]]:
        """A scalar whose names are paths that begin in this diagram."""
        if self.part.is_type:
            return
        raw = self.raw(scalar)
        head = raw.find("\n") if scalar.style in ("|", ">") else 0  # a comment may stand there
        text = raw[:head] + PATH.sub(lambda found: self.through(found.group()), raw[head:])
        if text != raw:
            yield scalar, text

    def through(self, path: str) -> str:
        """A path followed through the blocks that it names."""
        names, inside, n = path.split("."), self.inside, 0
        while n < len(names):
            name = names[n]
            if n == 0 and self.row and name in NEIGHBOURS:
                use = use_of(inside, self.row)
            else:
                use = use_of(inside, name)
                line = use.row if use is not None and use.row else name
                if line == self.part.name and defined_at(inside) == self.part.place:
                    names[n] = self.new + name.removeprefix(line)
                is_row = use is not None and use.name != name
                if is_row and n + 1 < len(names) and names[n + 1] in ENDS:
                    n += 1
            if use is None or use.subsystem is None:
                break
            inside, n = use.subsystem, n + 1
        return ".".join(names)


def _is_path(names: str) -> bool:
    return names not in ("", "unit", "preset")
