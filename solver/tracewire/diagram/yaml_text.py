"""Nodes and values as YAML text, laid out as a person writes a diagram."""

from __future__ import annotations

import json
from collections.abc import Mapping

from tracewire.diagram.grammar import INSIDE, TOP
from tracewire.diagram.limits import LAYOUT
from tracewire.diagram.strict import NUMBER, Entries, Items, Node, Scalar

INDICATORS = "-?:,[]{}#&*!|>'\"%@`"
OPENED = ("parameters", "inputs", "blocks", "subsystems", "presets", "measured", "events", "scene")
"""Sections that have a line for each entry, however short they are."""


def quote(text: str) -> str:
    """A text as YAML has it, anywhere: plain where it can be, else in quotes."""
    plain = _is_plain(text) and not NUMBER.fullmatch(text)
    return text if plain else json.dumps(text, ensure_ascii=False)


def _is_plain(text: str, flow: bool = True) -> bool:
    if not text or text != text.strip() or not text.isprintable():
        return False
    second = text[1:2].strip()
    if text[0] in INDICATORS and not (text[0] == "-" and second and second not in INDICATORS):
        return False
    inside = flow and any(mark in text for mark in ",[]{}:?")
    return not inside and ": " not in text and " #" not in text and not text.endswith(":")


def mapping_text(parts: Mapping[str, str]) -> str:
    """`{key: value, ...}` of values that are YAML."""
    return "{" + ", ".join(f"{quote(key)}: {value}" for key, value in parts.items()) + "}"


def inline(node: Node) -> str:
    """A node on one line, as it may stand between braces."""
    if isinstance(node, Entries):
        return mapping_text({key: inline(part) for key, _, part in node})
    if isinstance(node, Items):
        return "[" + ", ".join(inline(item) for item in node.items) + "]"
    return _scalar(node, flow=True)


def _scalar(node: Scalar, flow: bool) -> str:
    if node.style in ("|", ">") or (not node.style and not _is_plain(node.text, flow)):
        return json.dumps(node.text, ensure_ascii=False)
    if node.style == "'":
        return "'" + node.text.replace("'", "''") + "'"
    return json.dumps(node.text, ensure_ascii=False) if node.style else node.text


def document(sections: Mapping[str, Node]) -> str:
    """A whole diagram: a line for each entry of a section, more lines where one gets too long."""
    return "".join(f"{line}\n" for line in _sections(sections, 0))


def _sections(sections: Mapping[str, Node], indent: int) -> list[str]:
    order = INSIDE if indent else TOP
    names = [*(name for name in order if name in sections), *(sections.keys() - {*order})]
    found = []
    for name in names:
        node, begin = sections[name], f"{' ' * indent}{quote(name)}:"
        if name not in ("subsystems", "variants") or not isinstance(node, Entries):
            found += _entry(begin, node, indent, name in OPENED)
            continue
        found.append(begin)
        for part, _, body in node:
            if isinstance(body, Entries) and body.keys:
                found += [
                    f"{' ' * (indent + 2)}{quote(part)}:",
                    *_sections(body.values, indent + 4),
                ]
            else:
                found += _entry(f"{' ' * (indent + 2)}{quote(part)}:", body, indent + 2, False)
    return found


def _lines(parts: Mapping[str, Node], indent: int) -> list[str]:
    found = []
    for name, node in parts.items():
        found += _entry(f"{' ' * indent}{quote(name)}:", node, indent, False)
    return found


def _entry(begin: str, node: Node, indent: int, is_opened: bool) -> list[str]:
    """The lines of an entry, behind its name."""
    if isinstance(node, Scalar):
        return [f"{begin} {_scalar(node, flow=False)}"]
    line = f"{begin} {inline(node)}"
    empty = not (node.items if isinstance(node, Items) else node.keys)
    if isinstance(node, Items) and all(isinstance(item, Scalar) for item in node.items):
        is_opened = False
    if empty or (len(line) <= LAYOUT.width and not is_opened):
        return [line]
    if isinstance(node, Entries):
        return [begin, *_lines(node.values, indent + 2)]
    items = (line for item in node.items for line in _item(item, indent + 2))
    return [begin, *items]


def _item(node: Node, indent: int) -> list[str]:
    """The lines of an entry of a list."""
    line = f"{' ' * indent}- {inline(node)}"
    if len(line) <= LAYOUT.width or not isinstance(node, Entries):
        return [line]
    first, *others = _lines(node.values, indent + 2)
    return [f"{' ' * indent}- {first.lstrip()}", *others]
