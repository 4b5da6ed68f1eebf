"""Subsystems that a trace may look into: those whose text one block alone is made from."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from tracewire.diagram import BlockUse, Diagram, find_signal
from tracewire.errors import Location


def extensible_subsystems(diagram: Diagram) -> dict[str, BlockUse]:
    """The blocks whose subsystems may get an effect, by their path, at any depth.

    An effect is added to the text of a definition. So that has to be in the diagram's own text or
    in one that it extends, no other block may be made from it, and no other definition may have
    its name. What an included file defines stays as it is: the block gets a definition that extends
    it (`AddBlock.own`). A body that a parameter chooses has no block of its own in the text.
    """
    return {path: use for path, use, why in _subsystems(diagram) if not why}


def is_included(diagram: Diagram, use: BlockUse) -> bool:
    """Whether an included file defines the subsystem that a block is."""
    return use.subsystem is not None and use.subsystem.file != diagram.file


def closed_subsystems(diagram: Diagram) -> dict[str, str]:
    """Why subsystems with sums are not looked into, by the path of a block or a row of blocks."""
    return {
        path: why
        for path, use, why in _subsystems(diagram)
        if why and any(inside.type == "sum" for inside in _blocks(use))
    }


def rows_of_sums(diagram: Diagram) -> list[str]:
    """The rows of sums where an effect could be added otherwise, by their paths."""
    found: dict[str, None] = {}
    for path in ("", *extensible_subsystems(diagram)):
        for use in diagram_at(diagram, path).blocks.values():
            if use.row and use.type == "sum":
                found.setdefault(f"{path}.{use.row}" if path else use.row)
    return [*found]


def _subsystems(diagram: Diagram) -> Iterator[tuple[str, BlockUse, str]]:
    """The blocks that are subsystems, and why one gets no effect ('' where it may). What is inside
    of one that gets none for all of it is left out; a row stands once, by its name."""
    uses = Counter(_used(diagram))
    names = Counter(name for name, _ in {*_defined(diagram)})

    def of(inside: Diagram, path: str) -> Iterator[tuple[str, BlockUse, str]]:
        for name, use in inside.blocks.items():
            sub = use.subsystem
            if sub is None:
                continue
            if use.row:
                yield path + use.row, use, "it is a row of blocks"
            elif inside.file != diagram.file:
                yield path + name, use, f"it stands inside a subsystem of {inside.file.name}"
            elif sub.variants and not sub.variant:
                yield path + name, use, "a parameter chooses its body"
            elif sub.file != diagram.file:
                yield path + name, use, _not_extended(diagram, use, sub)
                yield from of(sub, f"{path}{name}.")
            elif uses[sub.place] > 1:
                yield path + name, use, f"several blocks are made from '{sub.name}'"
            else:
                unclear = f"several definitions are called '{sub.name}'"
                yield path + name, use, "" if names[sub.name] == 1 else unclear
                yield from of(sub, f"{path}{name}.")

    return of(diagram, "")


def _not_extended(diagram: Diagram, use: BlockUse, sub: Diagram) -> str:
    """Why a block cannot get a definition that extends that of an included file; '' if it can."""
    if use.place.file != str(diagram.file):
        return f"its line stands in {Path(use.place.file).name}"
    if sub.variants:
        return f"its definition stands in {sub.file.name}, and has variants"
    visible = diagram.subsystems
    needed = [one for one in sub.blocks.values() if one.subsystem is not None]
    hidden = [one.type for one in needed if one.type not in {*sub.subsystems, *visible}]
    if use.type not in visible or hidden:
        seen = (hidden or [use.type])[0]
        return f"the diagram does not include the file that defines '{seen}'"
    return ""


def _blocks(use: BlockUse) -> Iterator[BlockUse]:
    """The blocks inside of a block, at any depth."""
    if use.subsystem is not None:
        for inside in use.subsystem.blocks.values():
            yield inside
            yield from _blocks(inside)


def _used(diagram: Diagram) -> Iterator[Location]:
    for use in diagram.blocks.values():
        if use.subsystem is not None:
            yield use.subsystem.place
            yield from _used(use.subsystem)


def _defined(diagram: Diagram) -> Iterator[tuple[str, Location]]:
    for inside in diagram.subsystems.values():
        yield inside.name, inside.place
        yield from _defined(inside)


def diagram_at(diagram: Diagram, within: str) -> Diagram:
    """The diagram in which a place stands, by the path of the block that its subsystem is."""
    for name in within.split(".") if within else ():
        inside = diagram.blocks[name].subsystem
        assert inside is not None
        diagram = inside
    return diagram


def local_name(diagram: Diagram, within: str, name: str) -> str:
    """A signal of the flat equations as a block inside a subsystem names it; '' where it cannot.

    within: the path of the block that the subsystem is, '' for the diagram itself.
    """
    if not within or name in ("", "t"):
        return name
    head, _, rest = within.partition(".")
    use = diagram.blocks[head]
    assert use.subsystem is not None
    own = name.removeprefix(f"{head}.")
    if own == name:
        own = _port(diagram, use, name)
    if rest or not own:
        return local_name(use.subsystem, rest, own)
    return own if find_signal(use.subsystem, own) == own else ""


def _port(diagram: Diagram, use: BlockUse, name: str) -> str:
    """The input of a block that carries a signal of the diagram around it; '' where none does."""
    for port, wires in use.inputs.items():
        for wire in wires:
            if find_signal(diagram, wire.signal) == name and not (wire.negative or wire.index):
                return port
    return ""
