"""The body of one diagram while it is read: its names and references, readers of plain nodes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Literal

from tracewire.diagram.diagram import Shown
from tracewire.diagram.grammar import OF_A_BLOCK
from tracewire.diagram.problems import Problems, clip
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.errors import FormulaError, Location
from tracewire.formula import Unit, is_name, name_hint, number_hint, read_unit

Sees = Literal["parameter", "signal", "either"]


@dataclass(frozen=True)
class Reference:
    """A name that a formula or a wire uses, and what it may be."""

    name: str
    sees: Sees
    place: Location


@dataclass(eq=False)
class Body:
    """One diagram or subsystem while it is read.

    `path` is the path of its definition, empty at the top of a file.
    """

    problems: Problems
    path: str = ""
    references: list[Reference] = field(default_factory=list)
    resets: list[tuple[str, Location]] = field(default_factory=list)
    # names that stand alone as `when`: events of blocks, or signals; and places of `crosses`
    happenings: list[tuple[Reference, Location | None]] = field(default_factory=list)
    defined: dict[str, tuple[str, Location]] = field(default_factory=dict)

    def place(self, node: Node, block: str = "") -> Location:
        """The place of a node, with the path of the block it belongs to."""
        where = ".".join(part for part in (self.path, block) if part)
        return replace(node.place, block=where)

    def define(self, kind: str, key: Scalar) -> None:
        """Note a name of this diagram, and whether it is a name and stands alone."""
        name, place = key.text, self.place(key)
        if not is_name(name):
            what = f"'{clip(name)}' cannot be the name of {kind}"
            hint = name_hint(name)
            if name.isidentifier() and not name.isascii() and kind in ("a block", "an input"):
                hint += f" 'label: {name}' is its name in figures."
            self.problems.add(what, place, (), hint)
        elif self.path and name in OF_A_BLOCK and kind in ("an input", "a parameter"):
            what = f"'{name}' cannot be the name of {kind} of a subsystem"
            self.problems.add(what, place, (), f"'{name}:' means something else on every block.")
        elif name in self.defined:
            other, where = self.defined[name]
            there = f"line {where.line}" if where.file == place.file else str(where)
            what = f"two definitions of '{name}': {kind} here, and {other} in {there}"
            hint = "Parameters, blocks and inputs share their names: rename one."
            self.problems.add(what, place, (), hint)
        self.defined.setdefault(name, (kind, place))

    def entries(self, node: Node, what: str, example: str, block: str = "") -> Entries | None:
        """The node as a mapping, or None with a problem noted."""
        if isinstance(node, Entries):
            return node
        hint = f"Write it like {example}"
        self.problems.add(f"{what} must be a mapping", self.place(node, block), (), hint)
        return None

    def check_keys(
        self, entries: Entries, allowed: Iterable[str], kind: str, block: str = "", hint: str = ""
    ) -> None:
        """Note the keys that do not exist."""
        known = tuple(allowed)
        for name, key, _ in entries:
            if name not in known:
                self.problems.unknown(kind, name, known, self.place(key, block), hint)

    def required(self, entries: Entries, key: str, what: str, block: str = "") -> Node | None:
        """The value of a key that must be given."""
        node = entries.values.get(key)
        if node is None:
            hint = f"Write {key}: ..."
            self.problems.add(f"{what} needs '{key}'", self.place(entries, block), (), hint)
        return node

    def text(self, node: Node, what: str, block: str = "") -> str | None:
        """The node as a text, or None with a problem noted."""
        if isinstance(node, Scalar):
            return node.text.strip()
        self.problems.add(f"{what} must be a text", self.place(node, block))
        return None

    def number(self, node: Node, what: str, block: str = "") -> float | None:
        """The node as a finite number, or None with a problem noted."""
        value = node.number if isinstance(node, Scalar) else None
        if value is None:
            text = node.text if isinstance(node, Scalar) else ""
            said, hint = f", not '{clip(text)}'" if text else "", number_hint(text)
            self.problems.add(f"{what} must be a number{said}", self.place(node, block), (), hint)
        return value

    def unit(self, node: Node, block: str = "") -> Unit:
        """The unit that a node names; the number 1 where it names none."""
        text = self.text(node, "a unit", block)
        try:
            return read_unit(text or "", self.place(node, block))
        except FormulaError as error:
            self.problems.take(error)
            return Unit("", 1.0)

    def shown(self, entries: Entries, block: str = "") -> tuple[str, Shown]:
        """The SI unit of a signal, and how it is shown: in the given unit, with its label."""
        given = entries.values
        unit, text = Unit("", 1.0), ""
        if "unit" in given:
            unit = self.unit(given["unit"], block)
            text = "" if unit.factor == 1.0 else self.text(given["unit"], "a unit", block) or ""
        label = self.text(given["label"], "a label", block) if "label" in given else ""
        return unit.text, Shown(clip(label or ""), text, unit.factor)

    def scalars(self, node: Node, what: str) -> list[Scalar]:
        """The texts of a list of them; a single text is a list of one."""
        if isinstance(node, Scalar):
            return [node]
        if isinstance(node, Items):
            found = [item for item in node.items if isinstance(item, Scalar)]
            for item in node.items:
                if not isinstance(item, Scalar):
                    self.problems.add(f"an entry of {what} must be a name", self.place(item))
            return found
        hint = "Write it like [a, b]."
        self.problems.add(f"{what} must be a list of names", self.place(node), (), hint)
        return []
