"""Parts of a diagram that stand in a file which it extends, brought into its own text for an edit.

So an edit of a diagram changes no other file: what it changes is a change of what is extended.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from tracewire.diagram.diagram import Diagram
from tracewire.diagram.problems import Problems
from tracewire.diagram.rewrite import reread
from tracewire.diagram.source_map import SourceMap
from tracewire.diagram.strict import Entries, Items, Node, compose
from tracewire.diagram.text_edits import (
    TextEdit,
    apply_edits,
    entry_last,
    item_last,
    lines_last,
    replace_node,
)
from tracewire.diagram.yaml_text import inline, mapping_text, quote
from tracewire.errors import OptionError


def localise(diagram: Diagram, source_map: SourceMap, nodes: Iterable[Node]) -> Diagram:
    """The diagram with a copy of these parts in its own text; itself where they stand there.

    Raises OptionError: a part stands in a file that the diagram includes.
    """
    foreign = [node for node in nodes if not source_map.is_own(node)]
    if not foreign:
        return diagram
    for node in foreign:
        _refuse_included(source_map, node)
    parts: dict[tuple[str, ...], str] = {}
    for node in foreign:
        *around, name = path = source_map.path(node)
        parts[path] = inline(source_map.root.inside(*around).values[name])
    return with_parts(diagram, parts)


def with_parts(diagram: Diagram, parts: Mapping[tuple[str, ...], str]) -> Diagram:
    """The diagram with other values in its own text, by the names that lead to each."""
    if not parts:
        return diagram
    text = diagram.text
    for path, value in parts.items():
        root = compose(text, diagram.file, Problems())
        assert isinstance(root, Entries)
        text = apply_edits(text, [_with_part(text, root, path, value)])
    return reread(diagram, [TextEdit(0, len(diagram.text), text)])


def without_part(diagram: Diagram, path: str) -> Diagram:
    """The diagram that takes a part away from what it extends: `blocks.drag`."""
    root = SourceMap(diagram).own
    given = root.values.get("remove")
    if isinstance(given, Items):
        return reread(diagram, [item_last(diagram.text, given, path)])
    names = path if given is None else f"{inline(given)}, {path}"
    return with_parts(diagram, {("remove",): f"[{names}]"})


def _with_part(text: str, root: Entries, path: tuple[str, ...], value: str) -> TextEdit:
    node, rest = root, list(path)
    while len(rest) > 1 and isinstance(inner := node.values.get(rest[0]), Entries):
        node, rest = inner, rest[1:]
    name, *deeper = rest
    if name in node.keys and not deeper:
        return replace_node(node.values[name], value)
    section = node is root and not node.flow and len(deeper) > 0
    for key in reversed(deeper[1:] if section else deeper):
        value = mapping_text({key: value})
    if not section:
        if node is root and not node.flow:
            return lines_last(text, [f"{name}: {value}"])
        return entry_last(text, node, quote(name), value)
    return lines_last(text, [f"{name}:", f"  {quote(deeper[0])}: {value}"])


def _refuse_included(source_map: SourceMap, node: Node) -> None:
    path = source_map.path(node)
    # a subsystem that stands in the tree is one of the diagram's own, which may extend it
    if node.place.file in source_map.included and path[0] != "subsystems":
        what = f"'{'.'.join(path[1:])}' is defined in a file that is included"
        hint = "Edit that file, or move it into the diagram's own."
        raise OptionError.one(what, node.place, hint=hint)
