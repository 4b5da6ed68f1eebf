"""The layout of a diagram file: its blanks, quotes and the order of its sections, nothing else."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from tracewire.diagram.grammar import TOP
from tracewire.diagram.limits import LAYOUT
from tracewire.diagram.problems import Problems
from tracewire.diagram.strict import NUMBER, Entries, Items, Node, Scalar, compose
from tracewire.errors import DiagramError, Location

MARK = "\ufeff"
BARE = re.compile(r"-?(?:[^\W\d]|[/.]\w)(?:[\w./*^+-]|-(?!\s))*")
"""What needs no quotes, the wire with a minus among it."""
OTHER_MEANING = re.compile("(?:y|n|yes|no|on|off|true|false|null|none)", re.IGNORECASE)
"""Words that other readers of YAML do not take for texts; their quotes stay."""
GAP = re.compile(r"\n|#[^\n]*|^---|[{}\[\],:-]|\S", re.MULTILINE)
HEADER = re.compile(r"[|>][+-]?([1-9]?)[+-]?")


def lay_out(text: str, file: Path = Path("<text>")) -> str:
    """The text of a diagram in its canonical layout.

    Levels are indented by two blanks, there is one blank behind a colon or comma, lines have no
    blanks at their end, and no two empty lines follow each other. Quotes are double, and only where
    they are needed. Sections stand in the order of the table in docs/diagrams.md. Lines stay lines,
    and comments stay where they are, those behind a value in their column. What the text means
    stays the same. Raises DiagramError: the text is no YAML of a diagram.
    """
    ending = "\r\n" if "\r\n" in text else "\n"
    mark = MARK if text.startswith(MARK) else ""
    plain = text.removeprefix(MARK).replace("\r\n", "\n")
    root = _composed(plain, file)
    found = _in_order(_Printer(plain, root).printed(), file)
    if not _same(root, _composed(found, file), top=True):
        what = "the text is laid out in a way that cannot be changed by program"
        raise DiagramError.one(
            what, Location(str(file)), hint="It stays as it is. Please report it."
        )
    return mark + found.replace("\n", ending)


def _composed(text: str, file: Path) -> Node:
    problems = Problems()
    root = compose(text, file, problems)
    problems.raise_found(str(file))
    return root


@dataclass(frozen=True)
class _Token:
    """A scalar, a sign, a comment or a line break, and the column in which it stood."""

    kind: str
    text: str
    column: int
    scalar: Scalar | None = None


class _Printer:
    """Writes the nodes of a text in their order, with the comments and line breaks between them."""

    def __init__(self, text: str, root: Node) -> None:
        self.text, self.root = text, root
        self.tokens = list(self.scan())
        self.at = 0
        self.lines: list[str] = []
        self.line = ""
        self.kept = False  # whether the next line stays, if it is empty, too
        self.tight = False  # whether the next token follows without a blank
        self.levels: list[tuple[int, int]] = []  # (column before, column now) of what is open
        self.last = self.levels

    def printed(self) -> str:
        self.node(self.root, 0)
        self.between(0, 0)
        self.end_line()
        while self.lines and not self.lines[-1]:
            self.lines.pop()
        return "\n".join(self.lines) + "\n"

    # --- from the text to tokens ------------------------------------------------------------------

    def scan(self) -> Iterator[_Token]:
        at = 0
        for scalar in _scalars(self.root):
            yield from self.gap(at, scalar.start)
            at = self.end(scalar)
            column = self.column(scalar.start)
            yield _Token("scalar", self.text[scalar.start : at], column, scalar)
        yield from self.gap(at, len(self.text))

    def end(self, scalar: Scalar) -> int:
        """Where a scalar ends: a text block ends before its empty lines, unless it keeps them."""
        raw = self.text[scalar.start : scalar.end]
        if scalar.style not in ("|", ">"):
            return scalar.end
        if "+" in raw.partition("\n")[0].partition("#")[0]:
            return scalar.start + len(raw.removesuffix("\n"))
        return scalar.start + len(raw.rstrip())

    def gap(self, start: int, end: int) -> Iterator[_Token]:
        for found in GAP.finditer(self.text, start, end):
            sign, column = found.group(), self.column(found.start())
            if sign == "\n":
                yield _Token("break", sign, column)
            elif sign.startswith("#") or sign == "---":
                yield _Token("comment", sign.rstrip(), column)
            elif sign in "{}[],:-":
                yield _Token("sign", sign, column)
            else:
                line = self.text.count("\n", 0, found.start()) + 1
                place = Location(self.root.place.file, line, column + 1)
                what = f"'{sign}' cannot be laid out by program"
                raise DiagramError.one(what, place, hint="Write 'name: value'.")

    def column(self, at: int) -> int:
        return at - (self.text.rfind("\n", 0, at) + 1)

    # --- from tokens to lines ---------------------------------------------------------------------

    def end_line(self) -> None:
        line = self.line.rstrip()
        if line or self.kept or (self.lines and self.lines[-1]):
            self.lines.append(line)
        self.line, self.kept = "", False

    def between(self, indent: int, column: int) -> None:
        """The line breaks and comments before the next token, which stands at this column."""
        while self.at < len(self.tokens) and self.tokens[self.at].kind in ("break", "comment"):
            token = self.tokens[self.at]
            self.at += 1
            if token.kind == "break":
                self.end_line()
            elif self.line:
                width = max(token.column, len(self.line) + LAYOUT.before_comment)
                self.line = self.line.ljust(width) + token.text
            else:
                self.line = " " * self.beside(token.column, column, indent) + token.text

    def beside(self, own: int, column: int, indent: int) -> int:
        """The indent of a comment on a line of its own: that of the level at which it stood."""
        levels = [*self.last, *self.levels, (column, indent)]
        return max((level for level in levels if level[0] <= own), default=(0, indent))[1]

    def put(self, indent: int, sign: str = "") -> bool:
        """Write the next token; where it is to be a sign and is not, nothing."""
        ahead = self.at
        while self.tokens[ahead].kind in ("break", "comment"):
            ahead += 1
        token = self.tokens[ahead]
        if sign and (token.kind, token.text) != ("sign", sign):
            return False
        self.between(indent, token.column)
        self.at = ahead + 1
        if not self.line:
            self.line = " " * indent
        elif not (self.tight or sign in tuple(":,]}")):
            self.line += " "
        self.tight = sign in tuple("[{")
        self.last = [*self.levels]
        self.write(token, indent)
        return True

    def write(self, token: _Token, indent: int) -> None:
        scalar = token.scalar
        first, *others = token.text.split("\n")
        if scalar is None or not others:
            self.line += token.text if scalar is None else _quoted(scalar, token.text)
            return
        self.line += first.rstrip()
        if scalar.style in ("|", ">"):
            indent, shift = self.shift(first, others, indent)
            others = [line[shift:] if line.strip() else "" for line in others]
        else:
            others = [line.strip() for line in others]
        for line in others:
            self.lines.append(self.line)
            self.line = " " * indent + line if line else ""
        self.kept = not others[-1]  # a text block that keeps its empty lines

    def shift(self, header: str, lines: list[str], indent: int) -> tuple[int, int]:
        """The indent of the lines of a text block, and how many blanks they lose."""
        found = HEADER.match(header)
        if found and found[1]:  # it tells its indent, from that of the mapping around it
            column, now = self.levels[-1] if self.levels else (0, 0)
            return now + int(found[1]), column + int(found[1])
        full = next((line for line in lines if line.strip()), "")
        return indent, len(full) - len(full.lstrip())

    # --- the nodes --------------------------------------------------------------------------------

    def node(self, node: Node, indent: int) -> None:
        if isinstance(node, Scalar):
            self.put(indent)
        elif node.flow:
            self.flow(node, indent)
        elif isinstance(node, Entries):
            self.levels.append((self.column(node.start), indent))
            for _, _, value in node:
                self.put(indent)
                self.put(indent, ":")
                self.node(value, indent + LAYOUT.indent)
            self.levels.pop()
        else:
            self.levels.append((self.column(node.start), indent))
            for item in node.items:
                self.put(indent, "-")
                self.node(item, indent + LAYOUT.indent)
            self.levels.pop()

    def flow(self, node: Items | Entries, indent: int) -> None:
        """A list or mapping in brackets; of a pair in a list they may be left out."""
        opening, closing = ("{", "}") if isinstance(node, Entries) else ("[", "]")
        inner = indent if self.line else indent + LAYOUT.indent
        opened = self.put(indent, opening)
        if isinstance(node, Entries):
            for _, _, value in node:
                self.put(inner)
                self.put(inner, ":")
                self.node(value, inner + LAYOUT.indent)
                if opened:
                    self.put(inner, ",")
        else:
            for item in node.items:
                self.node(item, inner)
                self.put(inner, ",")
        if opened:
            self.put(inner - LAYOUT.indent, closing)


def _scalars(node: Node) -> Iterator[Scalar]:
    """The scalars of a text in their order."""
    if isinstance(node, Scalar):
        yield node
    elif isinstance(node, Items):
        for item in node.items:
            yield from _scalars(item)
    else:
        for _, key, value in node:
            yield key
            yield from _scalars(value)


def _quoted(scalar: Scalar, raw: str) -> str:
    """The text of a scalar on one line, with quotes where it needs some."""
    if scalar.style not in ("'", '"'):
        return raw
    text = scalar.text
    if BARE.fullmatch(text) and not OTHER_MEANING.fullmatch(text) and not NUMBER.fullmatch(text):
        return text
    as_it_is = scalar.style == '"' or not text.isprintable() or set('"\\') & set(text)
    return raw if as_it_is else json.dumps(text, ensure_ascii=False)


def _in_order(text: str, file: Path) -> str:
    """The text with its sections in their order, each with the comments right above it."""
    root = _composed(text, file)
    order = list(TOP)
    if not isinstance(root, Entries) or root.flow or not set(root.keys) <= set(order):
        return text
    if list(root.keys) == sorted(root.keys, key=order.index):
        return text
    lines = text.splitlines(keepends=True)
    tail: list[str] = []
    while lines and (lines[-1].startswith("#") or not lines[-1].strip()):
        tail.insert(0, lines.pop())
    begins = []
    for n, key in enumerate(root.keys.values()):
        at = key.place.line - 1
        while n and at > 0 and (lines[at - 1].startswith("#") or not lines[at - 1].strip()):
            at -= 1
        begins.append(at)
    ends = [*begins[1:], len(lines)]
    parts = {
        name: lines[begin:end] for name, begin, end in zip(root.keys, begins, ends, strict=True)
    }
    head = lines[: root.keys[next(iter(root.keys))].place.line - 1]
    first = next(iter(parts))
    parts[first] = parts[first][len(head) - begins[0] :]
    found = [*head, *(line for name in order if name in parts for line in parts[name]), *tail]
    return re.sub(r"\n{3,}", "\n\n", "".join(found))


def _same(one: Node, other: Node, top: bool = False) -> bool:
    """Whether two texts mean the same: sections may stand in another order."""
    if isinstance(one, Scalar) and isinstance(other, Scalar):
        return (one.text, one.number) == (other.text, other.number)
    if isinstance(one, Items) and isinstance(other, Items):
        return len(one.items) == len(other.items) and all(map(_same, one.items, other.items))
    if not isinstance(one, Entries) or not isinstance(other, Entries):
        return False
    keys: Mapping[str, Scalar] = one.keys
    known = set(keys) == set(other.keys) if top else list(keys) == list(other.keys)
    return known and all(_same(one.values[name], other.values[name]) for name in keys)
