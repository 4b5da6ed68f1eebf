"""A strict subset of YAML as nodes that know their place.

What a diagram needs of YAML is mappings, lists and text. Refused are duplicate and empty keys, keys
without a value, anchors and aliases (which can unfold to any size), merge keys, tags, and a second
document. A plain scalar that matches `NUMBER` is a number (`1e-3` is one, unlike in YAML 1.1);
every other scalar is text: `yes`, `on`, `null` and dates have no meaning of their own, nor has
`010`. `.nan` and `.inf` are refused.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import yaml
from yaml.reader import Reader

from tracewire.diagram.limits import LIMITS
from tracewire.diagram.problems import Problems, clip
from tracewire.errors import DiagramError, Location

TOO_DEEP = f"nested deeper than {LIMITS.most_nesting} levels"
FLATTER = "Use subsystems, or files of them with 'include'."
NUMBER = re.compile(r"[+-]?(?:(?:0|[1-9]\d*)(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?")
NOT_FINITE = re.compile(r"([+-]?)\.(inf|nan)", re.IGNORECASE)
STRANGE_BREAK = re.compile("\r(?!\n)|[\x85\u2028\u2029]")
PARSER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # only its events are used
ELEMENT = re.compile(r"\w\[\d")
BROKEN = "Check indentation, colons, quotes and brackets here and in the line above."


@dataclass(frozen=True)
class Scalar:
    """A text or number; `text[start:end]` of the file holds it with its quotes."""

    text: str
    place: Location
    start: int
    end: int
    style: str = ""  # empty where it is plain, else the quote or the sign of a text block

    @property
    def number(self) -> float | None:
        """The number that a plain scalar is, or None."""
        if self.style or not NUMBER.fullmatch(self.text):
            return None
        value = float(self.text)
        return value if math.isfinite(value) else None

    @property
    def path(self) -> Path:
        """The file that it names, from the folder of the file in which it stands."""
        return Path(self.place.file).parent / self.text.strip()


@dataclass(frozen=True)
class Items:
    """A list. `flow`: it stands in brackets; without them `end` is where the next node begins."""

    items: tuple[Node, ...]
    place: Location
    start: int
    end: int
    flow: bool


@dataclass(frozen=True)
class Entries:
    """A mapping: the node of each key and of its value. `flow` and `end` as in a list."""

    keys: dict[str, Scalar]
    values: dict[str, Node]
    place: Location
    start: int
    end: int
    flow: bool

    def __iter__(self) -> Iterator[tuple[str, Scalar, Node]]:
        return ((name, key, self.values[name]) for name, key in self.keys.items())

    def inside(self, *names: str) -> Entries:
        """The mapping to which these keys lead: they are there, as the text was read before."""
        found: Node = self
        for name in names:
            assert isinstance(found, Entries)
            found = found.values[name]
        assert isinstance(found, Entries)
        return found


Node = Scalar | Items | Entries


def compose(text: str, file: Path, problems: Problems) -> Node:
    """The root node of a YAML text.

    What can be read over is noted in `problems`. Raises DiagramError where it cannot: not YAML, no
    content, nested too deeply, a second document.
    """
    mark = 1 if text.startswith("\ufeff") else 0  # the parser does not count a byte order mark
    _check_characters(text, str(file), mark)
    try:
        return _Composer(str(file), mark, problems).compose(text[mark:])
    except yaml.MarkedYAMLError as error:
        spot = error.problem_mark or error.context_mark
        place = Location(str(file), spot.line + 1, spot.column + 1) if spot else Location(str(file))
        said = " ".join(part for part in (error.context, error.problem) if part)
        tab = "cannot start any token" in said and "\t" in text.splitlines()[place.line - 1]
        if tab:
            what = "a tab stands where YAML needs blanks"
            hint = "Indent with blanks, never with tabs."
            raise DiagramError.one(what, place, hint=hint) from None
        if "nesting depth" in said:  # the parser's own limit, of PyYAML 6.0.4 on
            raise DiagramError.one(TOO_DEEP, place, hint=FLATTER) from None
        hint = BROKEN
        if spot and any(map(ELEMENT.search, text.splitlines()[place.line - 1 : place.line])):
            hint = f'{BROKEN} An element of a vector needs quotes between brackets: {{of: "q[1]"}}.'
        elif "mapping values are not" in said and "{" not in text.splitlines()[place.line - 1]:
            hint = 'A text with a colon needs quotes, such as title: "Run 2: short".'
        elif spot and text[spot.index + mark :].startswith("- "):
            hint = "A minus stands at its name, without a blank: [a, -b]."
        raise DiagramError.one(f"this is not YAML: {said}", place, hint=hint) from None
    except yaml.YAMLError as error:
        what = f"this is not YAML: {clip(str(error))}"
        raise DiagramError.one(what, Location(str(file)), hint=BROKEN) from None


def _check_characters(text: str, file: str, mark: int) -> None:
    for pattern, what in (
        (Reader.NON_PRINTABLE, "is no character of a text file"),
        (STRANGE_BREAK, "ends a line in YAML, but not in an editor"),
    ):
        found = pattern.search(text, mark)
        if found:
            at = found.start()
            line, column = text.count("\n", 0, at) + 1, at - text.rfind("\n", 0, at)
            what = f"the character U+{ord(found.group()):04X} {what}"
            raise DiagramError.one(what, Location(file, line, column), hint="Remove it.")


@dataclass
class _Open:
    """A list or mapping whose end has not come yet; None stands for a node that was refused.

    `values` counts the entries of a list, those of lists in it instead of the lists.
    """

    event: yaml.CollectionStartEvent
    nodes: list[Node | None] = field(default_factory=list)
    values: int = 0


class _Composer:
    """Builds nodes from the events of the YAML parser, without recursion."""

    def __init__(self, file: str, mark: int, problems: Problems) -> None:
        self.file, self.mark, self.problems = file, mark, problems
        self.root: Node | None = None
        self.open: list[_Open] = []
        self.told_anchor = False

    def compose(self, text: str) -> Node:
        documents = 0
        for event in yaml.parse(text, Loader=PARSER):
            if isinstance(event, yaml.DocumentStartEvent):
                documents += 1
                if documents > 1:
                    hint = "Remove the line '---', or use a file for each."
                    raise self.stopped("a second document begins here", event, hint)
            elif isinstance(event, yaml.NodeEvent):
                self.refuse_anchor_and_tag(event)
                self.node(event)
            elif isinstance(event, yaml.CollectionEndEvent):
                self.close(event)
        empty = isinstance(self.root, Scalar) and not self.root.text
        if self.root is None or empty:
            if self.problems.found:
                self.problems.raise_found(self.file)
            hint = "A diagram has at least 'blocks:'."
            raise DiagramError.one("the file is empty", Location(self.file), hint=hint)
        return self.root

    def place(self, event: yaml.Event) -> Location:
        start = event.start_mark
        return (
            Location(self.file, start.line + 1, start.column + 1) if start else Location(self.file)
        )

    def span(self, first: yaml.Event, last: yaml.Event) -> tuple[int, int]:
        """Where the text of a node begins and ends; the parser gives each of its events marks."""
        marks = (first.start_mark, last.end_mark)
        start, end = (mark.index + self.mark if mark else 0 for mark in marks)
        return start, end

    def stopped(self, what: str, event: yaml.Event, hint: str) -> DiagramError:
        self.problems.add(what, self.place(event), (), hint)
        return DiagramError(self.problems.found)

    def refuse_anchor_and_tag(self, event: yaml.NodeEvent) -> None:
        if event.anchor is not None and not self.told_anchor:
            self.told_anchor = True  # one is enough: where there is an anchor there are aliases
            what = f"the anchor or alias '{clip(event.anchor)}' is not allowed in a diagram"
            hint = "Name a value under 'parameters', or a part under 'subsystems'."
            self.problems.add(what, self.place(event), (), hint)
        tag = getattr(event, "tag", None)
        if tag is not None:
            what = f"the tag '{clip(tag)}' is not allowed in a diagram"
            self.problems.add(what, self.place(event), (), "Remove it; put quotes around a '!'.")

    def node(self, event: yaml.NodeEvent) -> None:
        if isinstance(event, yaml.ScalarEvent):
            start, end = self.span(event, event)
            self.put(Scalar(event.value, self.place(event), start, end, event.style or ""))
        elif isinstance(event, yaml.CollectionStartEvent):
            if len(self.open) == LIMITS.most_nesting:
                raise self.stopped(TOO_DEEP, event, FLATTER)
            self.open.append(_Open(event))
        else:  # an alias: what it stands for is not read, so the rest would only mislead
            raise DiagramError(self.problems.found)

    def close(self, event: yaml.CollectionEndEvent) -> None:
        frame = self.open.pop()
        place = self.place(frame.event)
        start, end = self.span(frame.event, event)
        flow = bool(frame.event.flow_style)
        if isinstance(frame.event, yaml.MappingStartEvent):
            keys, values = self.pairs(frame.nodes)
            self.put(Entries(keys, values, place, start, end, flow))
        else:
            items = [node for node in frame.nodes if node is not None]
            for node in items:
                if _is_empty(node):
                    self.problems.add("an entry of this list is empty", node.place)
            kept = [self.finite(node) for node in items if not _is_empty(node)]
            if flow:
                kept = self.join_entries(kept)
            self.put(Items(tuple(kept), place, start, end, flow), frame.values)

    def put(self, node: Node | None, values: int = 1) -> None:
        if not self.open:
            self.root = node
            return
        frame = self.open[-1]
        frame.nodes.append(node)
        frame.values += values
        if isinstance(frame.event, yaml.SequenceStartEvent) and frame.values > LIMITS.most_entries:
            hint = "Put data into a file, with `measured:` or a `table` block; shorten a vector."
            what = f"this list has more than {LIMITS.most_entries} values"
            raise self.stopped(what, frame.event, hint)

    def pairs(self, nodes: list[Node | None]) -> tuple[dict[str, Scalar], dict[str, Node]]:
        keys: dict[str, Scalar] = {}
        values: dict[str, Node] = {}
        pairs = list(zip(nodes[::2], nodes[1::2], strict=True))
        joined = 0
        for n, (key, value) in enumerate(pairs):
            if n < joined:
                continue
            if isinstance(key, Scalar) and value is not None and _is_empty(value):
                joined = n + self.join_value(pairs[n:], keys, values)
                if n < joined:
                    continue
            if key is None or not self.is_key(key, keys) or not isinstance(key, Scalar):
                continue
            if value is None:
                continue
            if _is_empty(value):
                hint = "Write a value behind the colon, or remove the line."
                name, colon, rest = key.text.partition(":")
                if colon and name and rest:
                    hint = f"A blank stands behind a colon: {clip(name)}: {clip(rest)}."
                self.problems.add(f"'{key.text}' has no value", key.place, (), hint)
                continue
            keys[key.text], values[key.text] = key, self.finite(value, key.text)
        return keys, values

    def finite(self, node: Node, name: str = "") -> Node:
        """The node; one that is no finite number is noted, and 1 in its place."""
        if not isinstance(node, Scalar) or node.style or not NOT_FINITE.fullmatch(node.text):
            return node
        what = f"'{name}' is {node.text}" if name else f"an entry of this list is {node.text}"
        hint = f"Write a number for '{name}'." if name else "Write a number; a bound of a fit may"
        hint += "" if name else " be inf or -inf."
        self.problems.add(f"{what}, and a value is a finite number", node.place, (), hint)
        return replace(node, text="1")  # so that nothing more is told of it

    def join_value(
        self,
        rest: Sequence[tuple[Node | None, Node | None]],
        keys: dict[str, Scalar],
        values: dict[str, Node],
    ) -> int:
        """How many entries without a value are the rest of the value before them, cut at commas:
        they are noted and joined to it."""
        name = next(reversed(keys), "")
        before, key = values.get(name), rest[0][0]
        if not isinstance(before, Scalar) or before.style:
            return 0
        if not isinstance(key, Scalar) or key.style:
            return 0
        more = (k for k, value in rest if value is not None and _is_empty(value))
        whole, parts = _joined(before, more)
        hint = f'Write {name}: "{whole}".'
        if not parts and before.number is not None and key.number is not None:
            whole, parts = f"{before.text}.{key.text}", 1
            hint = f"Write {name}: {whole}: a point stands before the decimals."
        if parts:
            what = f"between braces a comma ends the value of '{name}'"
            self.problems.add(what, before.place, (), hint)
            values[name] = replace(before, text=whole)
        return parts

    def join_entries(self, items: Sequence[Node]) -> list[Node]:
        """The entries of a list in brackets; formulas that commas have cut are noted and joined."""
        found: list[Node] = []
        joined = 0
        for n, item in enumerate(items):
            if n < joined:
                continue
            whole, parts = _joined(item, items[n + 1 :])
            if parts and isinstance(item, Scalar):
                what, hint = "between brackets a comma ends an entry", f'Write "{whole}".'
                self.problems.add(what, item.place, (), hint)
                item, joined = replace(item, text=whole), n + 1 + parts
            found.append(item)
        return found

    def is_key(self, key: Node, keys: dict[str, Scalar]) -> bool:
        what, hint = "", ""
        if not isinstance(key, Scalar):
            what = "a key must be a name, not a list or mapping"
            hint = "Is a quote missing, or a blank behind a colon?"
        elif key.number is not None:
            what, hint = f"a key must be a name, not the number {clip(key.text)}", ""
        elif not key.text.strip():
            what = "a key is empty"
        elif key.text == "<<":
            what, hint = "merge keys (<<) are not allowed in a diagram", "Write the entries out."
        elif len(key.text) > LIMITS.longest_key:
            what = f"the key '{clip(key.text)}' is longer than {LIMITS.longest_key} characters"
        elif key.text in keys:
            first = keys[key.text].place
            what = f"two definitions of '{clip(key.text)}': it stands in line {first.line} already"
            hint = "Remove or rename one."
        if what:
            self.problems.add(what, key.place, (), hint)
        return not what


def _joined(first: Node, others: Iterable[Node | None]) -> tuple[str, int]:
    """A formula whose commas have cut it, up to its last bracket, and how many of the others are
    parts of it; ("", 0) where it is none."""
    whole = first.text if isinstance(first, Scalar) and not first.style else ""
    if whole.count("(") <= whole.count(")"):
        return "", 0
    for parts, node in enumerate(others, start=1):
        if not isinstance(node, Scalar) or node.style:
            break
        whole = f"{whole}, {node.text}"
        if whole.count("(") == whole.count(")"):
            return whole, parts
    return "", 0


def _is_empty(node: Node) -> bool:
    return isinstance(node, Scalar) and node.text in ("", "~") and not node.style
