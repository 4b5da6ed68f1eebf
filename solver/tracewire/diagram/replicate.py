"""`replicate`: one line of `blocks` that stands for many blocks in a row, written out as nodes."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace

from tracewire.diagram.body import Body
from tracewire.diagram.grammar import ROW
from tracewire.diagram.limits import LIMITS
from tracewire.diagram.problems import clip
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.formula import is_name

NEIGHBOURS = ("previous", "next", "first", "last")
WORDS = (*NEIGHBOURS, "index")
WORD = re.compile(rf"(?<![\w.])(?:(?:{'|'.join(NEIGHBOURS)})(?!\w)|index(?![\w.]))", re.ASCII)
OF_A_LINE = ("type", "unit", "label", "variant", "replicate")
"""Keys of a block's line whose values name no signals; an input may have any other name."""
WITHIN = ("unit", "file", "column")
"""The same of what stands under a key of a block's line."""
TEXTS = {
    "measured": ("title", "unit", "file", "column"),
    "expect": ("unit", "name", "says", "what", "source", "erratum", "note", "diagram"),
    "scene": ("color",),
}
"""The same of other sections."""
READERS = ("outputs", "blocks", "events", "presets", "record", "measured", "scene", "expect")
"""Sections in which `NAME.first`, `NAME.last` and `NAME.all` stand for blocks of a row."""


@dataclass(frozen=True)
class Replica(Entries):
    """The line of one block of a row; `row` is the name of the line that they all come from."""

    row: str = ""


def counts_of(entries: Entries) -> dict[str, Scalar]:
    """The names that the counts of a diagram's rows are given by, each with its node."""
    found = {}
    for _, _, line in _rows(entries):
        count = _count_node(line.values["replicate"])
        if isinstance(count, Scalar) and is_name(count.text):
            found[count.text] = count
    return found


def numbers_of(entries: Entries) -> dict[str, float]:
    """The parameters of a diagram that are plain numbers."""
    given = entries.values.get("parameters")
    found = {}
    for name, _, node in given if isinstance(given, Entries) else ():
        value = node.values.get("value") if isinstance(node, Entries) else node
        number = value.number if isinstance(value, Scalar) else None
        if number is not None:
            found[name] = number
    return found


def replicate_rows(entries: Entries, numbers: Mapping[str, float], body: Body) -> Entries:
    """The sections of a diagram with its rows written out: `chain` becomes `chain_1`, `chain_2`...

    numbers: the parameters that are plain numbers, which a count may name.
    """
    rows = {name: (key, line) for name, key, line in _rows(entries)}
    blocks = entries.values.get("blocks")
    if not rows or not isinstance(blocks, Entries):
        return entries
    _refuse_words(entries, rows, body)
    keys: dict[str, Scalar] = {}
    values: dict[str, Node] = {}
    lengths: dict[str, int] = {}
    for name, key, line in blocks:
        if name not in rows or not isinstance(line, Entries):
            keys[name], values[name] = key, line
            continue
        count = _count(name, line, numbers, body)
        if count is None:
            continue
        lengths[name] = count
        for index in range(1, count + 1):
            one = f"{name}_{index}"
            if one in blocks.keys:
                what = f"two definitions of '{one}': a block here, and one of the row '{name}'"
                body.problems.add(what, body.place(blocks.keys[one]), (), "Rename one.")
            keys[one] = replace(key, text=one)
            values[one] = _replica(name, line, index, count, body)
    sections = {**entries.values, "blocks": replace(blocks, keys=keys, values=values)}
    rows_outside = _Rows(lengths)
    found = {
        name: rows_outside.section(name, node) if name in READERS and lengths else node
        for name, node in sections.items()
    }
    return replace(entries, values=found)


def _rows(entries: Entries) -> Iterator[tuple[str, Scalar, Entries]]:
    blocks = entries.values.get("blocks")
    for name, key, line in blocks if isinstance(blocks, Entries) else ():
        if isinstance(line, Entries) and "replicate" in line.keys:
            yield name, key, line


def _refuse_words(entries: Entries, rows: Mapping[str, object], body: Body) -> None:
    """Names of the diagram that mean something else in a row."""
    for section in ("inputs", "parameters", "blocks"):
        node = entries.values.get(section)
        for name, key, _ in node if isinstance(node, Entries) else ():
            if name in WORDS:
                what = f"'{name}' means a part of a row in '{next(iter(rows))}', and is a name here"
                body.problems.add(what, body.place(key), (), "Rename it.")


def _count_node(node: Node) -> Node | None:
    return node.values.get("count") if isinstance(node, Entries) else node


def _count(row: str, line: Entries, numbers: Mapping[str, float], body: Body) -> int | None:
    """How many blocks there are in a row; None with a problem noted."""
    given = line.values["replicate"]
    if isinstance(given, Entries):
        body.check_keys(given, ROW, "key of 'replicate'", row)
        if body.required(given, "count", "'replicate'", row) is None:
            return None
    node = _count_node(given)
    number = node.number if isinstance(node, Scalar) else None
    if isinstance(node, Scalar) and node.text in numbers:
        number = numbers[node.text]
    assert node is not None
    if number is not None and number.is_integer() and 1 <= number <= LIMITS.most_copies:
        return int(number)
    shown = clip(node.text) if isinstance(node, Scalar) else "this"
    said = f"{shown} = {number:g}" if number is not None and shown in numbers else shown
    what = f"the count of a row must be a whole number from 1 to {LIMITS.most_copies}, not {said}"
    hint = "Write a number, or a parameter of this diagram that has one."
    body.problems.add(what, body.place(node, row), (), hint)
    return None


def _replica(row: str, line: Entries, index: int, count: int, body: Body) -> Replica:
    given = line.values["replicate"]
    keys = {name: key for name, key in line.keys.items() if name != "replicate"}
    values = {name: line.values[name] for name in keys}
    for end, at in (("first", 1), ("last", count)):
        changes = given.values.get(end) if isinstance(given, Entries) else None
        if changes is None or index != at:
            continue
        entries = body.entries(changes, f"'{end}' of a row", "{left: wall}", row)
        if entries is not None:
            keys |= entries.keys
            values |= entries.values
    names = {"first": f"{row}_1", "last": f"{row}_{count}", "index": str(index)}
    names |= {"previous": f"{row}_{index - 1}"} if index > 1 else {}
    names |= {"next": f"{row}_{index + 1}"} if index < count else {}

    def written(node: Node, key: str) -> Node:
        if isinstance(node, Items):
            return replace(node, items=tuple(written(item, key) for item in node.items))
        if isinstance(node, Entries):
            inner = {name: written(part, f"{key}.{name}") for name, _, part in node}
            return replace(node, values=inner)
        above, _, last = key.rpartition(".")
        if last in (WITHIN if above else OF_A_LINE):
            return node
        for word in WORD.findall(node.text):
            if word not in names:
                end = "first" if word == "previous" else "last"
                what = f"'{key}' reads '{word}', and the {end} block of the row has none"
                hint = f"Write replicate: {{count: ..., {end}: {{{key}: ...}}}}."
                body.problems.add(what, body.place(node, row), (), hint)
        text = WORD.sub(lambda found: names.get(found[0], f"{row}_{index}"), node.text)
        return node if text == node.text else replace(node, text=text)

    found = {name: written(node, name) for name, node in values.items()}
    return Replica(keys, found, line.place, line.start, line.end, line.flow, row)


class _Rows:
    """The rows of a diagram by their lengths, as other parts of it name their blocks."""

    def __init__(self, lengths: Mapping[str, int]) -> None:
        self.lengths = lengths
        names = "|".join(map(re.escape, lengths))
        self.end = re.compile(rf"(?<![\w.])({names})\.(first|last)(?!\w)", re.ASCII)
        self.all = re.compile(rf"(-?)\s*({names})\.all(\.[\w.]+)?", re.ASCII)

    def section(self, name: str, node: Node) -> Node:
        """A section with the names of single blocks in place of `chain.last` and `chain.all`."""
        if name != "blocks" or not isinstance(node, Entries):
            return self.written_out(node, TEXTS.get(name, ()))
        lines = {block: self.line(line) for block, _, line in node}
        return replace(node, values=lines)

    def line(self, line: Node) -> Node:
        """The line of a block."""
        if not isinstance(line, Entries):
            return line
        values = {
            key: node if key in OF_A_LINE else self.written_out(node, WITHIN)
            for key, _, node in line
        }
        return replace(line, values=values)

    def written_out(self, node: Node, texts: Collection[str], key: str = "") -> Node:
        """A node of a section; under the keys `texts` stand texts."""
        if isinstance(node, Items):
            return replace(node, items=tuple(self.items(node, texts, key)))
        if isinstance(node, Entries):
            keys = {self.one(name): replace(k, text=self.one(name)) for name, k, _ in node}
            values = {self.one(name): self.written_out(n, texts, name) for name, _, n in node}
            return replace(node, keys=keys, values=values)
        return node if key in texts else replace(node, text=self.one(node.text))

    def one(self, text: str) -> str:
        if "." not in text:
            return text
        return self.end.sub(lambda found: f"{found[1]}_{self.number(found)}", text)

    def number(self, found: re.Match[str]) -> int:
        return 1 if found[2] == "first" else self.lengths[found[1]]

    def items(self, node: Items, texts: Collection[str], key: str) -> Iterator[Node]:
        for item in node.items:
            whole = self.all.fullmatch(item.text.strip()) if isinstance(item, Scalar) else None
            if whole is None or not isinstance(item, Scalar):
                yield self.written_out(item, texts, key)
                continue
            sign, name, rest = whole[1], whole[2], whole[3] or ""
            for index in range(1, self.lengths[name] + 1):
                yield replace(item, text=f"{sign}{name}_{index}{rest}")
