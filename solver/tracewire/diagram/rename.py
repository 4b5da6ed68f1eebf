"""Another name for a part of a diagram, at each place of the text that reads it."""

from __future__ import annotations

from dataclasses import replace

from tracewire.diagram.choose import is_chosen
from tracewire.diagram.diagram import Diagram
from tracewire.diagram.grammar import DIRECTIONS, OF_A_BLOCK, SHAPES
from tracewire.diagram.quantity_names import EVENT_KINDS
from tracewire.diagram.rename_places import PATH, Names, Part, use_of
from tracewire.diagram.rewrite import reread
from tracewire.diagram.source_map import SourceMap, elsewhere
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.diagram.text_edits import TextEdit
from tracewire.errors import Location, OptionError, TracewireError, unknown
from tracewire.formula import is_name, name_hint, to_text


def renamed(diagram: Diagram, old: str, new: str) -> Diagram:
    """The diagram in which a block, input, parameter, output or subsystem has another name.

    old: its name, or its path where it stands in a subsystem: `bearing.slip`, by the subsystem or
    by a block of it. new: the name alone. Each place of the file that reads it follows: wires,
    formulas, records, presets, measured series, scenes, all bodies of a subsystem, and the blocks
    of a row, which have the name of its line. Of a block and a subsystem with one name it is the
    block that is meant. Raises OptionError: there is no such part, the new name is taken or cannot
    be one, or the part stands in a file that is included or extended, or is named there.
    """
    source_map = SourceMap(diagram)
    part = _find(source_map, old)
    _refuse_ambiguous(source_map, part, new)
    _check(source_map, part, new)
    found = reread(diagram, _changes(source_map, part, new))
    # there and back must be the same text: else a place was taken that means something else
    again = SourceMap(found)
    path = ".".join([*part.path.split(".")[:-1], new]) if part.is_type else part.path
    back = replace(part, path=path, place=again.definitions[path][0].place, name=new)
    if reread(found, _changes(again, back, part.name)).text != diagram.text:
        what = f"'{old}' stands at places that cannot be renamed by program"
        raise OptionError.one(what, diagram.place, hint="Choose another new name.")
    return found


def _find(source_map: SourceMap, path: str) -> Part:
    where, _, name = path.rpartition(".")
    inside = _inside(source_map, where)
    defined = next(p for p, (d, _) in source_map.definitions.items() if d.place == inside.place)
    known = _parts(source_map, defined)
    if name in known:
        _refuse_elsewhere(source_map, defined, name)
        return Part(defined, inside.place, name)
    if name in inside.subsystems:
        own = inside.subsystems[name]
        if (own.place, own.variant) not in source_map.nodes:
            raise elsewhere(own)
        _refuse_elsewhere(source_map, defined, name)
        return Part(f"{defined}.{name}".lstrip("."), own.place, name, is_type=True)
    known += inside.subsystems
    raise OptionError(
        [unknown("name", path, known if not where else [f"{where}.{n}" for n in known])]
    )


def _refuse_elsewhere(source_map: SourceMap, path: str, name: str) -> None:
    """Refuse a part that another file defines, or changes."""
    for inside, entries in source_map.bodies[path]:
        parameter = inside.parameters.get(name)
        if parameter is not None and parameter.place.file in source_map.included:
            what = f"'{name}' stands in a file that is included"
            raise OptionError.one(what, inside.place, hint="Rename it there.")
        place = _key(entries, name)
        if place is not None and place.file != str(source_map.top.file):
            raise _of_base(name, place)
    base: Node | None = source_map.base
    for inner in path.split(".") if path else ():
        subsystems = base.values.get("subsystems") if isinstance(base, Entries) else None
        base = subsystems.values.get(inner) if isinstance(subsystems, Entries) else None
    place = _key(base, name) if isinstance(base, Entries) else None
    if place is not None:
        raise _of_base(name, place)


def _of_base(name: str, place: Location) -> TracewireError:
    what = f"'{name}' stands in a diagram that this one extends"
    return OptionError.one(what, place, hint="Rename it there, and then here by hand.")


def _key(entries: Entries, name: str) -> Location | None:
    """Where a name is defined in the sections of a diagram, or in a variant; None where not."""
    for section in ("blocks", "parameters", "inputs", "outputs", "subsystems"):
        node = entries.values.get(section)
        if isinstance(node, Entries) and name in node.keys:
            return node.keys[name].place
        for item in node.items if isinstance(node, Items) else ():
            if isinstance(item, Scalar) and item.text == name:
                return item.place
    variants = entries.values.get("variants")
    bodies = variants.values.values() if isinstance(variants, Entries) else ()
    found = (_key(body, name) for body in bodies if isinstance(body, Entries))
    return next((place for place in found if place is not None), None)


def _refuse_ambiguous(source_map: SourceMap, part: Part, new: str) -> None:
    """Refuse names that are words of a statement, or of another diagram that one reads."""
    what = ""
    for statement in source_map.top.expect if not part.is_type else ():
        read = {*PATH.findall(to_text(statement.that))}
        if words := read & {*EVENT_KINDS, *DIRECTIONS} & {part.name, new}:
            what = f"'{min(words)}' is a word of a statement under 'expect', too"
        others = statement.reference is not None and statement.reference.file is not None
        if others and part.name in read:
            what = f"a statement reads '{part.name}' beside another diagram"
    if what:
        raise OptionError.one(what, source_map.top.place, hint="Rename by hand.")


def _inside(source_map: SourceMap, path: str) -> Diagram:
    """The diagram at a path of subsystems, or of blocks that are some."""
    found = source_map.definitions.get(path)
    inside, blocks = source_map.top, path.split(".") if path else []
    for n, name in enumerate(blocks):
        use = use_of(inside, name)
        if use is None or use.subsystem is None:
            if found is not None:
                return found[0]
            if name in inside.subsystems:
                raise elsewhere(inside.subsystems[name])
            known = [use.row or use.name for use in inside.blocks.values() if use.subsystem]
            known += inside.subsystems
            where = ".".join(blocks[: n + 1])
            raise OptionError([unknown("subsystem", where, dict.fromkeys(known))])
        inside = use.subsystem
    if is_chosen(inside):
        inside = next(iter(inside.blocks.values())).subsystem or inside
    if found is not None and found[0].place != inside.place:
        what = f"'{path}' is a block and another subsystem"
        raise OptionError.one(what, inside.place, hint="Rename the block first.")
    if (inside.place, inside.variant) not in source_map.nodes:
        raise elsewhere(inside)
    return inside


def _parts(source_map: SourceMap, path: str) -> list[str]:
    """The names that a diagram and its bodies give: an output may have that of what it carries."""
    found: dict[str, None] = {}
    for inside, _ in source_map.bodies[path]:
        lines = (use.row or use.name for use in inside.blocks.values())
        found |= dict.fromkeys([*lines, *inside.inputs, *inside.parameters, *inside.outputs])
    return [*found]


def _check(source_map: SourceMap, part: Part, new: str) -> None:
    inside, what = source_map.definitions[part.path][0], ""
    if not is_name(new):
        hint = name_hint(new)
        raise OptionError.one(f"'{new}' cannot be the name of a part", inside.place, hint=hint)
    if part.is_type:
        known = {name.rpartition(".")[2] for name in source_map.definitions} | set(inside.library)
        known |= set(source_map.top.subsystems)
        if new in known:
            what = f"there is a block type '{new}' already"
    elif new in _parts(source_map, part.path):
        what = f"there is a part '{new}' already"
    elif new in OF_A_BLOCK and part.path:
        what = f"'{new}:' means something else on every block"
    if what:
        raise OptionError.one(what, inside.place, hint="Choose another name.")


def _changes(source_map: SourceMap, part: Part, new: str) -> list[TextEdit]:
    changes: dict[int, TextEdit] = {}
    for path, bodies in source_map.bodies.items():
        shape = SHAPES["subsystem" if path else "diagram"]
        for inside, entries in bodies:
            names = Names(part, new, inside, source_map.top)
            found = [*names.of(entries, shape)]
            if inside.place == part.place:
                found += names.removed(source_map.removed.get((inside.place, inside.variant)))
            for scalar, text in found:
                if scalar.place.file != str(source_map.top.file):
                    what = f"'{part.name}' is named in a diagram that this one extends"
                    raise OptionError.one(what, scalar.place, hint="Rename by hand.")
                changes[scalar.start] = TextEdit(scalar.start, scalar.end, text)
    return list(changes.values())
