"""Another name for a part of a diagram, at each place of the text that reads it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

from tracewire.diagram.diagram import BlockUse, Diagram
from tracewire.diagram.grammar import (
    DIRECTIONS,
    OF_A_BLOCK,
    OF_KINDS,
    REFERENCE,
    SHAPES,
    fitting,
    parts_of,
)
from tracewire.diagram.outline import Outline, elsewhere
from tracewire.diagram.quantity_names import EVENT_KINDS
from tracewire.diagram.rewrite import reread
from tracewire.diagram.shapes import Formula, Mapped, Named, Record, Shape, Text
from tracewire.diagram.splice import Change
from tracewire.diagram.strict import Entries, Node, Scalar
from tracewire.errors import OptionError, unknown
from tracewire.formula import is_name, name_hint, to_text

PATH = re.compile(r"(?<![\w.\\])[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*", re.ASCII)


@dataclass(frozen=True)
class _Part:
    """What gets another name: a part or an output of a diagram, or a subsystem (`is_type`)."""

    inside: Diagram
    name: str
    is_type: bool = False


def renamed(diagram: Diagram, old: str, new: str) -> Diagram:
    """The diagram in which a block, input, parameter, output or subsystem has another name.

    old: its name, or its path where it stands in a subsystem: `bearing.slip`, by the subsystem or
    by a block of it. new: the name alone. Each place of the file that reads it follows: wires,
    formulas, records, presets, measured series, scenes. Of a block and a subsystem with one name it
    is the block that is meant. Raises OptionError: there is no such part, the new name is taken or
    cannot be one, the part stands in a file that is included, or the diagram extends another or has
    rows or variants.
    """
    outline = Outline(diagram)
    _refuse_composed(outline)
    part = _find(outline, old)
    _refuse_ambiguous(outline, part, new)
    _check(outline, part, new)
    found = reread(diagram, _changes(outline, part, new))
    # there and back must be the same text: else a place was taken that means something else
    again = Outline(found)
    path = next(path for path, (inside, _) in outline.definitions.items() if inside is part.inside)
    if part.is_type:
        path = ".".join([*path.split(".")[:-1], new])
    back = replace(part, inside=again.definitions[path][0], name=new)
    if reread(found, _changes(again, back, part.name)).text != diagram.text:
        what = f"'{old}' stands at places that cannot be renamed by program"
        raise OptionError.one(what, diagram.place, hint="Choose another new name.")
    return found


def _refuse_composed(outline: Outline) -> None:
    """Refuse a text whose names mean parts of other texts, or of several blocks."""
    what, top = "", outline.top
    diagrams = [inside for inside, _ in outline.definitions.values()]
    if "extends" in outline.own.values:
        what = "extends another one"
    elif any(
        use.row for inside, _ in outline.definitions.values() for use in inside.blocks.values()
    ):
        what = "has rows of blocks (replicate)"
    elif any(inside.variants for inside in diagrams):
        what = "has variants"
    if what:
        hint = "Rename by hand; `tracewire check` names each place that is left."
        raise OptionError.one(f"rename takes no diagram that {what}", top.place, hint=hint)


def _find(outline: Outline, path: str) -> _Part:
    where, _, name = path.rpartition(".")
    inside = _inside(outline, where)
    if name in _parts(inside):
        if not _is_own(outline, inside, name):
            what = f"'{name}' stands in a file that is included"
            raise OptionError.one(what, inside.place, hint="Rename it there.")
        return _Part(inside, name)
    if name in inside.subsystems:
        own = inside.subsystems[name]
        if (own.place, own.variant) not in outline.nodes:
            raise elsewhere(own)
        return _Part(own, name, is_type=True)
    known = [*_parts(inside), *inside.subsystems]
    raise OptionError(
        [unknown("name", path, known if not where else [f"{where}.{n}" for n in known])]
    )


def _refuse_ambiguous(outline: Outline, part: _Part, new: str) -> None:
    """Refuse names that are words of a statement, or of another diagram that one reads."""
    what = ""
    for statement in outline.top.expect if not part.is_type else ():
        read = {*PATH.findall(to_text(statement.that))}
        if words := read & {*EVENT_KINDS, *DIRECTIONS} & {part.name, new}:
            what = f"'{min(words)}' is a word of a statement under 'expect', too"
        others = statement.reference is not None and statement.reference.file is not None
        if others and part.name in read:
            what = f"a statement reads '{part.name}' beside another diagram"
    if what:
        raise OptionError.one(what, outline.top.place, hint="Rename by hand.")


def _inside(outline: Outline, path: str) -> Diagram:
    """The diagram at a path of subsystems, or of blocks that are some."""
    found = outline.definitions.get(path)
    inside, blocks = outline.top, path.split(".") if path else []
    for n, name in enumerate(blocks):
        use = inside.blocks.get(name)
        if use is None or use.subsystem is None:
            if found is not None:
                return found[0]
            if name in inside.subsystems:
                raise elsewhere(inside.subsystems[name])
            known = [block.name for block in inside.blocks.values() if block.subsystem is not None]
            known += [name for name in inside.subsystems if name not in known]
            raise OptionError([unknown("subsystem", ".".join(blocks[: n + 1]), known)])
        inside = use.subsystem
    if found is not None and found[0] is not inside:
        what = f"'{path}' is a block and another subsystem"
        raise OptionError.one(what, inside.place, hint="Rename the block first.")
    if (inside.place, inside.variant) not in outline.nodes:
        raise elsewhere(inside)
    return inside


def _is_own(outline: Outline, inside: Diagram, name: str) -> bool:
    """Whether a part is written in the text of the diagram itself."""
    parameter = inside.parameters.get(name)
    return parameter is None or parameter.place.file == str(outline.top.file)


def _parts(inside: Diagram) -> list[str]:
    """The names that a diagram gives: an output may have that of what it carries."""
    return [*inside.blocks, *inside.inputs, *inside.parameters, *inside.outputs]


def _check(outline: Outline, part: _Part, new: str) -> None:
    inside, what = part.inside, ""
    if not is_name(new):
        hint = name_hint(new)
        raise OptionError.one(f"'{new}' cannot be the name of a part", inside.place, hint=hint)
    if part.is_type:
        known = {name.rpartition(".")[2] for name in outline.definitions} | set(inside.library)
        known |= set(outline.top.subsystems)
        if new in known:
            what = f"there is a block type '{new}' already"
    elif new in _parts(inside):
        what = f"there is a part '{new}' already"
    elif new in OF_A_BLOCK and inside is not outline.top:
        what = f"'{new}:' means something else on every block"
    if what:
        raise OptionError.one(what, inside.place, hint="Choose another name.")


def _changes(outline: Outline, part: _Part, new: str) -> list[Change]:
    changes: dict[int, Change] = {}
    for inside, entries in outline.definitions.values():
        shape = SHAPES["diagram" if inside is outline.top else "subsystem"]
        for scalar, text in _Names(part, new, inside, outline.top.text).of(entries, shape):
            changes[scalar.start] = Change(scalar.start, scalar.end, text)
    return list(changes.values())


@dataclass(frozen=True)
class _Names:
    """The scalars of one diagram that name the part, each with its new text."""

    part: _Part
    new: str
    inside: Diagram
    text: str

    def of(self, node: Node, shape: Shape) -> Iterator[tuple[Scalar, str]]:
        found = fitting(shape, node)
        if isinstance(node, Scalar):
            if isinstance(found, Formula) or (isinstance(found, Text) and _is_path(found.names)):
                yield from self.path(node)
            return
        if found == Record(REFERENCE) and isinstance(node, Entries) and "diagram" in node.values:
            return  # its names are those of another diagram
        for key, value, of in parts_of(found, node) if found is not None else ():
            if key is not None and of == Named("subsystem"):  # its inside is another diagram
                if self.part.is_type and self.inside.subsystems.get(key.text) is self.part.inside:
                    yield key, self.replaced(key)
                continue
            if key is not None and isinstance(found, Mapped) and _is_path(found.names):
                yield from self.path(key)
            if key is not None and of == Named("block"):
                yield from self.block(self.inside.blocks[key.text], value)
            else:
                yield from self.of(value, of)

    def block(self, use: BlockUse, line: Node) -> Iterator[tuple[Scalar, str]]:
        """The line of a block: its type, its wires and its settings."""
        assert isinstance(line, Entries)
        is_use = use.subsystem is self.part.inside
        own = {} if use.subsystem else {p.name: p for p in self.inside.library[use.type].parameters}
        for name, key, value in line:
            if name == "type":
                if self.part.is_type and is_use and isinstance(value, Scalar):
                    yield value, self.replaced(value)
            elif name in use.inputs:
                yield from self.of(value, SHAPES["wires"])
            elif name in own:
                yield from self.of(value, SHAPES[OF_KINDS[own[name].kind]])
            elif name in use.settings:
                yield from self.of(value, SHAPES["fitted value"])
            else:
                yield from self.of(value, OF_A_BLOCK[name].shape)
            given = is_use and not self.part.is_type and name == self.part.name
            if given and (name in use.inputs or name in use.settings):
                yield key, self.replaced(key)

    def replaced(self, scalar: Scalar) -> str:
        """A scalar that is the old name, as the new one."""
        return self.text[scalar.start : scalar.end].replace(self.part.name, self.new)

    def path(self, scalar: Scalar) -> Iterator[tuple[Scalar, str]]:
        """A scalar whose names are paths that begin in this diagram."""
        if self.part.is_type:
            return
        raw = self.text[scalar.start : scalar.end]
        head = raw.find("\n") if scalar.style in ("|", ">") else 0  # a comment may stand there
        text = raw[:head] + PATH.sub(lambda found: self.through(found.group()), raw[head:])
        if text != raw:
            yield scalar, text

    def through(self, path: str) -> str:
        """A path followed through the blocks that it names."""
        names, inside = path.split("."), self.inside
        for n, name in enumerate(names):
            if inside is self.part.inside and name == self.part.name:
                names[n] = self.new
            use = inside.blocks.get(name)
            if use is None or use.subsystem is None:
                break
            inside = use.subsystem
        return ".".join(names)


def _is_path(names: str) -> bool:
    return names not in ("", "unit", "preset")
