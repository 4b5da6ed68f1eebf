"""Changes of a text at the marks of its nodes, which leave every other character as it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.errors import DiagramError, Location, TracewireError


@dataclass(frozen=True)
class TextEdit:
    """`text` in place of the characters from `start` to `end`."""

    start: int
    end: int
    text: str


def apply_edits(text: str, changes: Sequence[TextEdit]) -> str:
    """The text with all changes made; they must not overlap."""
    for change in sorted(changes, key=lambda change: change.start, reverse=True):
        text = text[: change.start] + change.text + text[change.end :]
    return text


def end_of(node: Node) -> int:
    """Where the text of a node ends, without blanks and comments behind it."""
    if isinstance(node, Scalar) or node.flow:
        return node.end
    parts = node.items if isinstance(node, Items) else tuple(node.values.values())
    return max(end_of(part) for part in parts if part.place.file == node.place.file)


def replace_node(node: Node, new: str) -> TextEdit:
    """The node's text exchanged; a text block (| or >) is refused."""
    if isinstance(node, Scalar) and node.style in ("|", ">"):
        raise _refused(node)
    return TextEdit(node.start, end_of(node), new)


def entry_after(
    text: str, entries: Entries, after: str, name: str, value: str, comment: str = ""
) -> TextEdit:
    """`name: value` as a new entry behind the entry `after`, laid out as that is; the comment
    stands behind it where it has a line of its own."""
    key, node = entries.keys[after], entries.values[after]
    end = end_of(node)
    if entries.flow:
        return TextEdit(end, end, f", {name}: {value}")
    indent = _indent(text, key)
    width = _width(key, node) if _is_aligned(entries) else 0
    behind = f"   # {comment}" if comment else ""
    return _line_after(text, end, f"{indent}{f'{name}:'.ljust(width - 1)} {value}{behind}")


def _width(key: Scalar, node: Node) -> int:
    """From the begin of a key to that of its value; 0 where this is on another line."""
    return node.start - key.start if node.place.line == key.place.line else 0


def _is_aligned(entries: Entries) -> bool:
    """Whether the values of a mapping stand below each other: some key has blanks behind it."""
    return any(_width(key, node) > len(f"{name}: ") for name, key, node in entries)


def entry_last(text: str, entries: Entries, name: str, value: str) -> TextEdit:
    """`name: value` as the last entry of a mapping, of which others may stand in other files."""
    own = [known for known, key in entries.keys.items() if key.place.file == entries.place.file]
    if not own:
        return TextEdit(entries.start + 1, entries.start + 1, f"{name}: {value}")
    return entry_after(text, entries, own[-1], name, value)


def item_last(text: str, items: Items, value: str) -> TextEdit:
    """`value` as the last item of a list."""
    if not items.items:
        return TextEdit(items.start + 1, items.start + 1, value)
    last = items.items[-1]
    end = end_of(last)
    if items.flow:
        return TextEdit(end, end, f", {value}")
    return _line_after(text, end, text[_line_start(text, last.start) : last.start] + value)


def lines_last(text: str, lines: Sequence[str]) -> TextEdit:
    """Lines at the end of the text."""
    ending = "\r\n" if "\r\n" in text else "\n"
    begin = "" if text.endswith("\n") or not text else ending
    return TextEdit(len(text), len(text), begin + "".join(f"{line}{ending}" for line in lines))


def remove_entry(text: str, entries: Entries, name: str) -> TextEdit:
    """The entry taken out: its lines, or its part of a mapping in braces and a comma beside it."""
    key, node = entries.keys[name], entries.values[name]
    if not entries.flow:
        _indent(text, key)
        return TextEdit(_line_start(text, key.start), _line_end(text, end_of(node)), "")
    parts = [(k.start, end_of(entries.values[n])) for n, k in entries.keys.items()]
    index = list(entries.keys).index(name)
    start, end = parts[index]
    if len(parts) == 1:
        return TextEdit(start, end, "")
    if index > 0 and "#" not in text[parts[index - 1][1] : start]:
        return TextEdit(parts[index - 1][1], end, "")
    if index == 0 and "#" not in text[end : parts[1][0]]:
        return TextEdit(start, parts[1][0], "")
    comma = text.find(",", end, parts[index + 1][0]) if index + 1 < len(parts) else -1
    return TextEdit(start, comma + 1 if comma >= 0 else end, "")


def _line_start(text: str, at: int) -> int:
    return text.rfind("\n", 0, at) + 1


def _line_end(text: str, at: int) -> int:
    """Behind the line break of the line in which `at` stands."""
    found = text.find("\n", at)
    return len(text) if found < 0 else found + 1


def _line_after(text: str, at: int, line: str) -> TextEdit:
    end = _line_end(text, at)
    ending = "\r\n" if "\r\n" in text else "\n"
    if text.endswith("\n", 0, end):
        return TextEdit(end, end, line + ending)
    return TextEdit(end, end, ending + line)


def _indent(text: str, key: Scalar) -> str:
    indent = text[_line_start(text, key.start) : key.start].removeprefix("\ufeff")
    if indent.strip():
        raise _refused(key)
    return indent


def _refused(node: Scalar) -> TracewireError:
    what = "the text is laid out here in a way that cannot be edited by program"
    place = Location(node.place.file, node.place.line, node.place.column)
    return DiagramError.one(what, place, hint="Write 'name: value' on one line.")
