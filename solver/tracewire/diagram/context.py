"""Where a cursor stands in the text of a diagram that is being written, and may be no YAML yet."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Literal

WORD = re.compile(r"[A-Za-z_][\w.]*$", re.ASCII)
TEXTS = r"""  "[^"]*"? | '[^']*'?  """
KEY = re.compile(
    rf"""( {TEXTS} | [^\s\-\#{{}}\[\],"'] [^:\#{{}}\[\],]*? | -[^\s:{{}}\[\],]+ ) \s*:(?:\s+|$)""",
    re.VERBOSE,
)
"""A key at the begin of a line."""
FLOW = re.compile(
    rf"""[{{}}\[\],] | :(?=[\s{{}}\[\],"']|$) | {TEXTS} | (?<=\s)\#.* | [^\s{{}}\[\],:"']+ | .""",
    re.VERBOSE,
)
"""The signs, texts and comments of a line."""


@dataclass
class Level:
    """A mapping or list that is open at the cursor.

    indent: the column of its keys or dashes; -1 in brackets. key: the key whose value is being
    written; empty where a key is. given: the keys before, with the texts that they have.
    """

    kind: Literal["mapping", "list"]
    indent: int = -1
    key: str = ""
    given: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Context:
    """The levels around the cursor, and the word before it; None of them in a comment or text."""

    levels: tuple[Level, ...]
    word: str


def context_of(before: str) -> Context | None:
    """The context at the end of a text; None where nothing can be proposed."""
    lines = before.split("\n")
    scanner = _Scanner()
    for number, line in enumerate(lines):
        scanner.line(line, last=number == len(lines) - 1)
    if scanner.silent:
        return None
    word = WORD.search(lines[-1])
    return Context(tuple(scanner.levels), word.group() if word else "")


class _Scanner:
    def __init__(self) -> None:
        self.levels: list[Level] = []
        self.silent = False  # in a comment, or in a text block
        self.block: int | None = None  # the indent of the key of a text block
        self.scalar = ""

    def line(self, line: str, last: bool) -> None:
        body = line.lstrip(" ")
        indent = len(line) - len(body)
        if self.block is not None and (not body or indent > self.block):
            self.silent = last
            return
        self.block = None
        if self.levels and self.levels[-1].indent < 0:
            self.flow(line, last)
            return
        if body.startswith("#") or not (body or last):
            self.silent = last
            return
        self.leave(indent, body.startswith("- ") or body == "-")
        while body.startswith("- ") or body == "-":
            if not self.levels or (self.levels[-1].kind, self.levels[-1].indent) != (
                "list",
                indent,
            ):
                self.levels.append(Level("list", indent))
            rest = body[1:].lstrip(" ")
            indent += len(body) - len(rest)
            body = rest
        found = KEY.match(body)
        if found is None:
            if body[:1] not in ("{", "[") and self.is_key(indent):
                self.at(indent)
            self.flow(body, last)
            return
        level = self.at(indent)
        level.key = found.group(1).strip("\"'")
        rest = body[found.end() :]
        level.given[level.key] = rest.partition(" #")[0].strip()
        if rest[:1] in ("|", ">"):
            self.block, self.silent = indent, last
        else:
            self.flow(rest, last)

    def leave(self, indent: int, is_item: bool) -> None:
        """Close the levels that a line with this indent does not belong to."""
        while self.levels:
            top = self.levels[-1]
            same = top.indent == indent and top.kind == "list" and not is_item
            if top.indent <= indent and not same:
                return
            self.levels.pop()

    def is_key(self, indent: int) -> bool:
        """Whether what begins here may become a key: of an open mapping, or of a new one."""
        top = self.levels[-1] if self.levels else None
        return top is None or top.indent == indent or top.kind == "list" or bool(top.key)

    def at(self, indent: int) -> Level:
        """The mapping with this indent, at a new key."""
        top = self.levels[-1] if self.levels else None
        if top is None or (top.kind, top.indent) != ("mapping", indent):
            self.levels.append(Level("mapping", indent))
        self.levels[-1].key = ""
        return self.levels[-1]

    def flow(self, text: str, last: bool) -> None:
        """The rest of a line: a scalar, or brackets that may go on in the next line."""
        for found in FLOW.finditer(text):
            sign = found.group()
            if sign in ("{", "["):
                self.levels.append(Level("mapping" if sign == "{" else "list"))
            elif self.levels and self.levels[-1].indent < 0:
                self.inside(sign)
            if sign.startswith("#"):
                self.silent = last

    def inside(self, sign: str) -> None:
        """A sign or a scalar in brackets."""
        top = self.levels[-1]
        if sign in ("}", "]"):
            self.levels.pop()
        elif sign == ",":
            top.key = ""
        elif sign == ":" and top.kind == "mapping" and not top.key:
            top.key = self.scalar.strip("\"'")
            top.given[top.key] = ""
        elif sign.strip() and not sign.startswith("#"):
            self.scalar = sign
            if top.key:
                top.given[top.key] += sign
