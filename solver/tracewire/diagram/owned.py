"""A block whose subsystem an included file defines gets a definition of its own, to be changed.

That definition extends the one of the file, which stays as it is:

    include: parts.yaml
    subsystems:
      own_cart:
        extends: cart
        blocks:
          force: {of: [spring, u, drag]}
    blocks:
      body: {type: own_cart}
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

from tracewire.diagram.diagram import BlockUse, Diagram
from tracewire.diagram.edit import with_bodies
from tracewire.diagram.problems import Problems
from tracewire.diagram.rewrite import reread
from tracewire.diagram.source_map import SourceMap
from tracewire.diagram.strict import Entries, Node, compose
from tracewire.diagram.text_edits import TextEdit, end_of, entry_last, lines_last, replace_node
from tracewire.diagram.yaml_text import inline
from tracewire.errors import Location, OptionError, unknown


def patch_own(diagram: Diagram, path: str, sum_path: str) -> tuple[Diagram, str]:
    """The diagram in whose text a block has a definition of its own, and the sum by that.

    path: the block (`body`, or `frame.body`); sum_path: the sum in the definition of the file
    (`cart.force`). A block that has a definition of its own keeps it. Raises OptionError: the line
    of the block stands in another file, or there is no such block.
    """
    inside, use = _found(diagram, path)
    sum_name = sum_path.rpartition(".")[2]
    assert use.subsystem is not None
    if use.subsystem.file == diagram.file:
        return diagram, f"{use.type}.{sum_name}"
    name = _free(diagram, use.type)
    where = "" if inside is diagram else f"{inside.name}."
    _, blocks, _ = SourceMap(diagram).block(f"{where}{use.name}")
    kind = blocks.inside(use.name).values["type"]
    if kind.place.file != str(diagram.file):
        what = f"the line of '{path}' stands in another file"
        raise OptionError.one(what, use.place, hint="Edit that file.")
    typed = replace_node(kind, name)
    short = f"{{extends: {use.type}}}"
    with_base = reread(diagram, [_defined(diagram, name, short, [f"extends: {use.type}"]), typed])
    _, its_blocks, _ = SourceMap(with_base).block(f"{name}.{sum_name}")
    wires = f"{sum_name}: {{of: {_listed(its_blocks.inside(sum_name).values['of'])}}}"
    short = f"{{extends: {use.type}, blocks: {{{wires}}}}}"
    lines = [f"extends: {use.type}", "blocks:", f"  {wires}"]
    return reread(diagram, [_defined(diagram, name, short, lines), typed]), f"{name}.{sum_name}"


def apply_own(diagram: Diagram, path: str, sum_path: str) -> tuple[Diagram, str]:
    """The same in the objects of the diagram; its text stays as it is."""
    _, use = _found(diagram, path)
    sum_name = sum_path.rpartition(".")[2]
    assert use.subsystem is not None
    if use.subsystem.file == diagram.file:
        return diagram, f"{use.type}.{sum_name}"
    name = _free(diagram, use.type)
    place = Location(str(diagram.file), block=name)
    own = replace(
        use.subsystem, name=name, file=diagram.file, text=diagram.text, place=place, sources=()
    )
    diagram = _with_use(diagram, use, replace(use, type=name, subsystem=own))
    return replace(diagram, subsystems={**diagram.subsystems, name: own}), f"{name}.{sum_name}"


def _found(diagram: Diagram, path: str) -> tuple[Diagram, BlockUse]:
    """The diagram that a block stands in, and the block."""
    inside = diagram
    *around, name = path.split(".")
    for part in around:
        use = inside.blocks.get(part)
        if use is None or use.subsystem is None:
            raise OptionError([unknown("block", part, inside.blocks)])
        inside = use.subsystem
    use = inside.blocks.get(name)
    if use is None or use.subsystem is None:
        known = [key for key, other in inside.blocks.items() if other.subsystem is not None]
        raise OptionError([unknown("block that is a subsystem", name, known)])
    return inside, use


def _with_use(diagram: Diagram, old: BlockUse, new: BlockUse) -> Diagram:
    """The diagram with another block in the place of one, in each body that has its line."""
    diagram = with_bodies(diagram, lambda inside: _with_use(inside, old, new))
    blocks = {
        name: new if (use.place, use.name) == (old.place, old.name) else use
        for name, use in diagram.blocks.items()
    }
    return replace(diagram, blocks=blocks)


def _free(diagram: Diagram, type_name: str) -> str:
    taken = {*diagram.library, *_definitions(diagram)}
    name = f"own_{type_name}"
    number = 2
    while name in taken:
        name, number = f"own_{type_name}_{number}", number + 1
    return name


def _definitions(diagram: Diagram) -> Iterator[str]:
    for name, inside in diagram.subsystems.items():
        yield name
        yield from _definitions(inside)


def _defined(diagram: Diagram, name: str, short: str, lines: list[str]) -> TextEdit:
    """A new definition at the end of the subsystems in the text, as lines or in braces."""
    text = diagram.text
    root = compose(text, diagram.file, Problems())
    assert isinstance(root, Entries)
    ending = "\r\n" if "\r\n" in text else "\n"
    known = root.values.get("subsystems")
    if root.flow:
        value = short if isinstance(known, Entries) else f"{{{name}: {short}}}"
        into = known if isinstance(known, Entries) else root
        return entry_last(text, into, name if into is known else "subsystems", value)
    if not isinstance(known, Entries):
        return lines_last(text, ["subsystems:", f"  {name}:", *(f"    {line}" for line in lines)])
    if known.flow:
        return entry_last(text, known, name, short)
    last = list(known.keys)[-1]
    key = known.keys[last]
    indent = " " * (key.place.column - 1)
    at = text.find("\n", end_of(known.values[last])) + 1 or len(text)
    begin = "" if text.endswith("\n", 0, at) else ending
    added = [f"{indent}{name}:", *(f"{indent}  {line}" for line in lines)]
    return TextEdit(at, at, begin + "".join(f"{line}{ending}" for line in added))


def _listed(node: Node) -> str:
    wires = inline(node)
    return wires if re.match(r"\s*\[", wires) else f"[{wires}]"
