"""The readers of a signal given another one: in a diagram, and in its text."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import TypeGuard

from tracewire.diagram.diagram import BlockUse, Diagram, Event, Wire
from tracewire.diagram.edit import add_addend
from tracewire.diagram.names import find_signal
from tracewire.diagram.override import localise
from tracewire.diagram.rewrite import reread
from tracewire.diagram.source_map import SourceMap
from tracewire.diagram.strict import Entries, Items, Node
from tracewire.diagram.text_edits import TextEdit, entry_after, entry_last
from tracewire.errors import DiagramError, OptionError, unknown
from tracewire.formula import Call, Expression, Name, Number, names_of, rename

NAME = re.compile(r"(?<![\w.])[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*", re.ASCII)


def rewired(diagram: Diagram, old: str, new: str) -> Diagram:
    """The diagram in which all blocks and events that read the signal `old` read `new`.

    Effects that act on a drive go on reading what they read. The text stays as it is, and so does
    what is recorded and measured.
    """

    def name(read: str) -> str:
        return new if find_signal(diagram, read) == old else read

    def formula(given: Expression) -> Expression:
        return rename(given, lambda read: Name(name(read)))

    def block(use: BlockUse) -> BlockUse:
        if _acts_on_drive(diagram, use):
            return use
        inputs = {
            port: tuple(replace(wire, signal=name(wire.signal)) for wire in wires)
            for port, wires in use.inputs.items()
        }
        settings = {
            key: formula(given) if _is_formula(given) else given
            for key, given in use.settings.items()
        }
        return replace(use, inputs=inputs, settings=settings)

    def event(known: Event) -> Event:
        when = None if known.when is None else formula(known.when)
        changes = {state: formula(given) for state, given in known.set.items()}
        return replace(known, when=when, set=changes)

    return replace(
        diagram,
        blocks={key: block(use) for key, use in diagram.blocks.items()},
        events=tuple(event(known) for known in diagram.events),
    )


def add_to_drive(
    diagram: Diagram, drive: str, block_name: str, block_line: str, comment: str = ""
) -> Diagram:
    """The diagram with a new block, whose output is added to a drive before all that reads it.

    drive: a named input, or the block of a source. block_line: what stands behind the name, such as
    `{type: drive_gain, of: u, k: 0}`; it may read the drive itself. Where only one sum reads the
    drive the output goes there, with the sign that the drive has; else into a sum `DRIVE_seen`,
    which the readers get in its place. What is recorded and measured stays the drive. Raises
    OptionError: nothing reads the drive; DiagramError: a reader cannot be edited by program.
    """
    readers, events = readers_of(diagram, drive)
    sole = sole_wire(diagram, drive, readers, events)
    if sole is not None:
        name = readers[0].name
        return add_addend(
            diagram, name, block_name, block_line, negative=sole.negative, comment=comment
        )
    anchor = drive if drive in diagram.blocks else readers[0].name if readers else ""
    seen = seen_name(diagram, drive)
    diagram, blocks, section = _own_readers(diagram, readers, events)
    line = f"{{type: sum, of: [{drive}]}}"
    text = diagram.text
    if anchor and blocks.keys[anchor].place.file == str(diagram.file):
        changes = [entry_after(text, blocks, anchor, seen, line)]
    else:
        changes = [entry_last(text, blocks, seen, line)]
    for use in readers:
        entries = blocks.inside(use.name)
        formulas = (key for key, given in use.settings.items() if _is_formula(given))
        for key in (*use.inputs, *formulas):
            changes += _tokens(diagram, entries.values[key], drive, seen)
    for entry in section.items if isinstance(section, Items) else ():
        for key in ("when", "set"):
            if isinstance(entry, Entries) and key in entry.values:
                changes += _tokens(diagram, entry.values[key], drive, seen)
    new = reread(diagram, changes)
    for name, wanted in rewired(diagram, drive, seen).blocks.items():
        use = new.blocks[name]
        if _wiring(use) != _wiring(wanted):
            what = f"what '{name}' reads is laid out in a way that cannot be edited by program"
            raise DiagramError.one(what, use.place, hint="Write each wire and formula on one line.")
    return add_addend(new, seen, block_name, block_line, comment=comment)


def readers_of(diagram: Diagram, drive: str) -> tuple[list[BlockUse], list[Event]]:
    """The blocks and events that read a drive, without effects at it. Raises OptionError: none."""
    readers = [use for use in diagram.blocks.values() if _reads(diagram, use, drive)]
    events = [event for event in diagram.events if _event_reads(diagram, event, drive)]
    readers = [use for use in readers if not _acts_on_drive(diagram, use)]
    if not readers and not events:
        known = [name for name in (*diagram.inputs, *diagram.blocks) if name != drive]
        raise OptionError([unknown("drive that something reads", drive, known)])
    return readers, events


def sole_wire(
    diagram: Diagram, drive: str, readers: Sequence[BlockUse], events: Sequence[Event]
) -> Wire | None:
    """The wire of a drive to the one sum that reads it; None where there are other readers."""
    if len(readers) != 1 or events or readers[0].type != "sum":
        return None
    (wires,) = readers[0].inputs.values()
    own = [wire for wire in wires if find_signal(diagram, wire.signal) == drive]
    return own[0] if len(own) == 1 and not own[0].index else None


def seen_name(diagram: Diagram, drive: str) -> str:
    """A free name for what the readers of a drive see."""
    seen = f"{drive}_seen"
    while seen in {*diagram.inputs, *diagram.blocks, *diagram.parameters}:
        seen += "_"
    return seen


def _own_readers(
    diagram: Diagram, readers: list[BlockUse], events: list[Event]
) -> tuple[Diagram, Entries, Node | None]:
    """The diagram with the lines of these blocks in its own text, its blocks, and its events."""
    source_map = SourceMap(diagram)
    blocks = source_map.root.inside("blocks")
    for event in events:
        if event.place.file != str(diagram.file):
            what = "an event that reads the drive stands in another file, which is extended"
            raise OptionError.one(what, event.place, hint="Edit that file.")
    lines = [blocks.values[use.name] for use in readers]
    parts = [part for line in lines if isinstance(line, Entries) for part in line.values.values()]
    diagram = localise(diagram, source_map, parts)
    root = SourceMap(diagram).root
    return diagram, root.inside("blocks"), root.values.get("events") if events else None


def _acts_on_drive(diagram: Diagram, use: BlockUse) -> bool:
    """Whether a block is an effect at a drive: it goes on reading the drive itself."""
    known = diagram.library[use.type].effect if use.subsystem is None else use.subsystem.effect
    return known is not None and known.place == "drive"


def _reads(diagram: Diagram, use: BlockUse, signal: str) -> bool:
    wires = [wire.signal for wires in use.inputs.values() for wire in wires]
    formulas = [given for given in use.settings.values() if _is_formula(given)]
    names = [*wires, *(name for given in formulas for name in names_of(given))]
    return any(find_signal(diagram, name) == signal for name in names)


def _event_reads(diagram: Diagram, event: Event, signal: str) -> bool:
    formulas = [*event.set.values(), *([] if event.when is None else [event.when])]
    names = (name for formula in formulas for name in names_of(formula))
    return any(find_signal(diagram, name) == signal for name in names)


def _is_formula(given: object) -> TypeGuard[Expression]:
    return isinstance(given, Name | Number | Call)


def _wiring(use: BlockUse) -> tuple[object, ...]:
    """What a block reads, without the places of the text."""
    wires = {
        port: [(wire.signal, wire.negative, wire.index) for wire in wires]
        for port, wires in use.inputs.items()
    }
    return wires, {key: given for key, given in use.settings.items() if _is_formula(given)}


def _tokens(diagram: Diagram, node: Node, old: str, new: str) -> list[TextEdit]:
    """Changes of each name of the signal `old` in the texts of a node."""
    if isinstance(node, Items):
        return [change for item in node.items for change in _tokens(diagram, item, old, new)]
    if isinstance(node, Entries):
        parts = node.values.values()
        return [change for part in parts for change in _tokens(diagram, part, old, new)]
    return [
        TextEdit(node.start + found.start(), node.start + found.end(), new)
        for found in NAME.finditer(diagram.text[node.start : node.end])
        if find_signal(diagram, found[0]) == old
    ]
