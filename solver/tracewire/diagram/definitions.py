"""The subsystems that a diagram can use: where they are defined, and which body a line chooses."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from tracewire.diagram.body import Body
from tracewire.diagram.choose import side_by_side
from tracewire.diagram.diagram import Diagram
from tracewire.diagram.extend import variants_of, with_variant
from tracewire.diagram.grammar import INSIDE, TOP, VARIANT
from tracewire.diagram.packages import who_has
from tracewire.diagram.problems import Problems, clip
from tracewire.diagram.replicate import counts_of, numbers_of
from tracewire.diagram.sources import Included, Sources
from tracewire.diagram.strict import Entries, Node, Scalar
from tracewire.errors import Location
from tracewire.formula import is_name, name_hint
from tracewire.library import Library, find_instead, find_synonym


@dataclass(eq=False)
class Scope:
    """Where a diagram stands: its file, its path there, and the subsystems that it defines.

    `numbers` are its parameters that are plain numbers, `counts` those that say how many blocks
    there are.
    """

    file: Path
    text: str
    path: str = ""
    parent: Scope | None = None
    definitions: dict[str, Definition] = field(default_factory=dict)
    numbers: Mapping[str, float] = field(default_factory=dict)
    counts: Collection[str] = ()


@dataclass(eq=False)
class Definition:
    """A subsystem that is read when it is first needed, once for each variant and set of counts."""

    name: str
    key: Scalar
    node: Node
    scope: Scope
    diagrams: dict[object, Diagram | None] = field(default_factory=dict)

    @property
    def path(self) -> str:
        """The path of the definition, from the top of its file on."""
        return f"{self.scope.path}.{self.name}" if self.scope.path else self.name

    @property
    def variants(self) -> tuple[str, ...]:
        """The names of its bodies, where it has several."""
        return variants_of(self.node) if isinstance(self.node, Entries) else ()


@dataclass(frozen=True)
class Choice:
    """What a line chooses of the subsystem that it uses; '' is the first variant.

    `number` is the parameter of the line's diagram that has the number of the variant, if one has.
    """

    variant: str = ""
    number: str = ""
    counts: Mapping[str, float] = field(default_factory=dict)


USUAL = Choice()


@dataclass(eq=False)
class Definitions:
    """The definitions of the files of one diagram. Problems are noted."""

    sources: Sources
    of_file: dict[Path, dict[str, Definition]] = field(default_factory=dict)

    @property
    def library(self) -> Library:
        """The blocks that there are."""
        return self.sources.packages.library

    @property
    def problems(self) -> Problems:
        """What is wrong in the files."""
        return self.sources.problems

    def define(self, entries: Entries, scope: Scope) -> dict[str, Definition]:
        """The subsystems that stand in a diagram."""
        found: dict[str, Definition] = {}
        node = entries.values.get("subsystems")
        if node is None:
            return found
        body = Body(self.problems, scope.path)
        example = "{bearing: {inputs: [rate], ...}}"
        for name, key, inside in body.entries(node, "'subsystems'", example) or ():
            place = body.place(key)
            if not is_name(name):
                what = f"'{clip(name)}' cannot be the name of a subsystem"
                self.problems.add(what, place, (), name_hint(name))
            elif name in self.library:
                what = f"two definitions of '{name}': a subsystem here, and a block of the library"
                self.problems.add(what, place, (), "Rename the subsystem.")
            found[name] = Definition(name, key, inside, scope)
        return found

    def include(self, entries: Entries, scope: Scope) -> dict[str, Definition]:
        """The subsystems of the files that a file includes, but not of those that they include."""
        found: dict[str, Definition] = {}
        own = entries.values.get("subsystems")
        there = own.keys if isinstance(own, Entries) else {}
        for name, included in self.sources.included(entries):
            place = replace(name.place, block=scope.path)
            for key, definition in self.definitions_of(included).items():
                other = found.get(key)
                if key in there or (other is not None and other is not definition):
                    first = there[key].place if other is None else other.key.place
                    what = f"two definitions of '{key}': one in '{name.text}', the other in {first}"
                    self.problems.add(what, place, (), "Rename one.")
                found[key] = definition
        return {key: definition for key, definition in found.items() if key not in there}

    def definitions_of(self, included: Included) -> dict[str, Definition]:
        """The subsystems of an included file."""
        if included.file not in self.of_file:
            scope = Scope(included.file, included.text)
            own = self.of_file[included.file] = self.define(included.entries, scope)
            scope.definitions = own | self.include(included.entries, scope)
        return self.of_file[included.file]

    def entries(self, definition: Definition, choice: Choice, body: Body) -> Entries | None:
        """The sections of a definition, with the body that is chosen."""
        example = "{inputs: [u], outputs: {y: k}, blocks: {...}}"
        entries = body.entries(definition.node, f"subsystem '{clip(definition.name)}'", example)
        if entries is None:
            return None
        misplaced = any(key in TOP and key not in INSIDE for key in entries.keys)
        hint = "Some sections belong to the top of the file only." if misplaced else ""
        body.check_keys(entries, INSIDE, "section of a subsystem", hint=hint)
        if "variants" not in entries.keys:
            return entries
        given = body.entries(entries.values["variants"], "'variants'", "{dry: {blocks: {...}}}")
        for name, _, node in given or ():
            changes = body.entries(node, f"variant '{clip(name)}'", "{blocks: {...}}")
            if changes is not None:
                hint = "All variants have the inputs and outputs of the subsystem."
                ports = {"inputs", "outputs"} & changes.keys.keys()
                what = "section of a variant"
                body.check_keys(changes, VARIANT, what, hint=hint if ports else "")
        if choice.number:
            return side_by_side(definition.name, entries)
        usual = next(iter(definition.variants), "")
        variant = choice.variant or usual
        return with_variant(entries, variant, self.problems) if variant else entries

    def choice(
        self, definition: Definition, line: Entries, scope: Scope, place: Location
    ) -> Choice | None:
        """What a line chooses of a subsystem; None with a problem noted."""
        variant = self._variant(definition, line, scope, place)
        if variant is None:
            return None
        number = variant if variant not in definition.variants else ""
        bodies = definition.variants if number else (variant,)
        counts: dict[str, float] = {}
        for body in bodies:
            counts |= self._counts(definition, line, scope, body)
        return Choice("" if number else variant, number, counts)

    def _variant(
        self, definition: Definition, line: Entries, scope: Scope, place: Location
    ) -> str | None:
        """The variant that a line names, or the parameter that has the number of one.

        '' where it names none, None where there is no such.
        """
        node = line.values.get("variant")
        if node is None or not isinstance(definition.node, Entries):
            return ""
        known = definition.variants
        name = Body(self.problems).text(node, "'variant'")
        at = replace(node.place, block=place.block)
        if name in known and name in scope.numbers:
            what = f"'{name}' is a variant of '{definition.name}' and a parameter here"
            self.problems.add(what, at, (), "Rename the parameter.")
        elif name is None or name in known or (known and name in scope.numbers):
            return name
        elif known:
            hint = "Or name a parameter of this diagram that has the number of one, from 1."
            self.problems.unknown(f"variant of '{definition.name}'", name, known, at, hint)
        else:
            what = f"the subsystem '{definition.name}' has no variants"
            self.problems.add(what, at, (), "Take 'variant' away.")
        return None

    def _counts(
        self, definition: Definition, line: Entries, scope: Scope, variant: str
    ) -> dict[str, float]:
        """The counts that a line gives to the subsystem that it uses."""
        found: dict[str, float] = {}
        if not isinstance(definition.node, Entries):
            return found
        entries = definition.node
        if variants := definition.variants:
            entries = with_variant(entries, variant or variants[0], Problems())
        usual = numbers_of(entries)
        declared = entries.values.get("parameters")
        known = declared.keys if isinstance(declared, Entries) else {}
        for name in counts_of(entries).keys() & line.keys.keys() & known.keys():
            node = line.values[name]
            number = node.number if isinstance(node, Scalar) else None
            if isinstance(node, Scalar) and node.text in scope.numbers:
                number = scope.numbers[node.text]
            if number is None:
                what = (
                    f"'{name}' is the count of a row, and must be a number or a parameter with one"
                )
                self.problems.add(what, node.place, (), "Write it without 'value' and formulas.")
            elif number != usual.get(name):
                found[name] = number
        return found

    def unknown_type(self, type_name: str, visible: Iterable[str], place: Location) -> None:
        """Note a type that is neither block nor subsystem; a name of another tool is explained."""
        if self.sources.packages.unknown(type_name, place) or self.problems.skips():
            return
        found = find_synonym(type_name, [*self.library])
        hint = found[1] if found is not None else find_instead(type_name) or who_has(type_name)
        if hint:
            self.problems.add(f"unknown block type '{clip(type_name)}'", place, (), hint)
        else:
            names = [*visible, *self.library]
            own = "Blocks of your own come with --library FILE."
            self.problems.unknown("block type", type_name, names, place, otherwise=own)
