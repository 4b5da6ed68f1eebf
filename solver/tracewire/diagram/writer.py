"""A diagram's text as a file, and as one text that needs no other."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from tracewire.arguments import checked
from tracewire.diagram.body import Body
from tracewire.diagram.diagram import Diagram
from tracewire.diagram.edit_series import path_text, text_from
from tracewire.diagram.files import absent_series
from tracewire.diagram.modeline import moved_modeline
from tracewire.diagram.packages import Packages
from tracewire.diagram.problems import Problems
from tracewire.diagram.reader import read_text
from tracewire.diagram.replicate import numbers_of, replicate_rows
from tracewire.diagram.sources import Sources
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.diagram.yaml_text import document
from tracewire.errors import DiagramError, Location, OptionError
from tracewire.files import write_file


@checked
def write(diagram: Diagram, path: str | Path, overwrite: bool = False) -> Path:
    """Write the diagram's text to a file, and return its path. In another folder measured files,
    and the schema that its first line names to an editor, get the path from there.

    Raises OptionError where another file is there already and `overwrite` is not said, or the file
    cannot be written; DiagramError where diagrams that it includes or extends are not found there.
    """
    target = Path(path)
    try:
        own = target.exists() and diagram.file.exists() and target.samefile(diagram.file)
        if target.exists() and not own and not overwrite:
            hint = "Choose another name, or say that it may be overwritten."
            raise OptionError.one("there is a file of this name", Location(str(target)), hint=hint)
        text = text_at(diagram, target)
        write_file(target, moved_modeline(text, diagram.file, target))
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        what = f"the file cannot be written: {reason}"
        raise OptionError.one(what, Location(str(target)), hint="Check its folder.") from None
    return target


def text_at(diagram: Diagram, target: Path) -> str:
    """The text of a diagram as another file has it. Raises DiagramError: a file that the diagram
    names is not found from there."""
    if target.resolve().parent == diagram.file.resolve().parent:
        return diagram.text
    text = text_from(diagram, target.parent)
    there = absent_series(diagram)
    moved = read_text(text, target, library=diagram.library)
    if lost := [p for name, p in absent_series(moved).items() if name not in there]:
        raise DiagramError(lost)
    return text


def write_out(diagram: Diagram) -> str:
    """The text of a diagram with what it extends, includes and replicates written out, as YAML.

    Rows inside subsystems keep `replicate`, since each use may give a count of its own. Comments
    are left out. Raises OptionError: two files that it includes have subsystems of one
    name, each for itself; DiagramError: a file cannot be read any more.
    """
    sources = Sources(Packages(diagram.library, Problems()))
    root = sources.tree(diagram.text, diagram.file)
    assert root is not None
    root = replicate_rows(root, numbers_of(root), Body(sources.problems))
    subsystems = _all_subsystems(sources, root)
    values = {name: node for name, _, node in root if name not in ("include", "subsystems")}
    if subsystems:
        inner = {name: key for name, (key, _) in subsystems.items()}
        nodes = {name: node for name, (_, node) in subsystems.items()}
        values["subsystems"] = Entries(inner, nodes, root.place, 0, 0, False)
    folder, file = diagram.file.parent, root.place.file
    return document({name: _from(node, folder, file) for name, node in values.items()})


def _all_subsystems(sources: Sources, entries: Entries) -> dict[str, tuple[Scalar, Node]]:
    """The subsystems of a file and of those that it includes, by their names."""
    own = entries.values.get("subsystems")
    found = {} if not isinstance(own, Entries) else {name: (key, node) for name, key, node in own}
    for _, included in sources.included(entries):
        for name, (key, node) in _all_subsystems(sources, included.entries).items():
            if name in found and found[name][1] is not node:
                what = f"two subsystems have the name '{name}', and cannot stand in one text"
                raise OptionError.one(what, key.place, hint="Rename one.")
            found[name] = key, node
    return found


def _from(node: Node, folder: Path, file: str) -> Node:
    """A node with the files that it names as seen from a folder, where it is of another file."""
    if isinstance(node, Items):
        return replace(node, items=tuple(_from(item, folder, file) for item in node.items))
    if not isinstance(node, Entries):
        return node
    values = {name: _from(part, folder, file) for name, _, part in node}
    for key in ("file", "diagram"):
        named = values.get(key)
        if isinstance(named, Scalar) and named.place.file != file:
            values[key] = replace(named, text=path_text(named.path, folder), style='"')
    return replace(node, values=values)
