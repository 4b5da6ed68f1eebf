"""From the text of a diagram file to a checked diagram."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from tracewire.diagram.body import Body
from tracewire.diagram.check import check_names
from tracewire.diagram.diagram import Diagram
from tracewire.diagram.files import load
from tracewire.diagram.loops import check_parameters
from tracewire.diagram.measured import read_measured
from tracewire.diagram.packages import Packages, who_has
from tracewire.diagram.problems import Problems, clip
from tracewire.diagram.read_effect import read_effect
from tracewire.diagram.read_scene import read_scene
from tracewire.diagram.replicate import counts_of, numbers_of, replicated
from tracewire.diagram.sections import (
    read_events,
    read_inputs,
    read_outputs,
    read_parameters,
    read_title,
)
from tracewire.diagram.settings import (
    read_every,
    read_max_step,
    read_presets,
    read_record,
    read_require,
    read_span,
)
from tracewire.diagram.sources import MOST_LEVELS, TOP, Included, Sources
from tracewire.diagram.strict import Entries, Node, Scalar
from tracewire.diagram.uses import read_blocks
from tracewire.errors import DiagramError, Place, Problem
from tracewire.formula import is_name, name_hint
from tracewire.library import Block, Library, find_instead, find_synonym, load_library

MOST_BLOCKS = 100_000
INSIDE = (
    *("title", "inputs", "outputs", "parameters", "blocks", "subsystems", "events", "effect"),
)


def read(path: str | Path, libraries: Iterable[str | Path] = ()) -> Diagram:
    """The checked diagram of a YAML file.

    libraries: files and folders of block declarations, beside the shipped ones; they are Python and
    run when they are read.

    Raises DiagramError with everything that is wrong in the file and in those that it includes, by
    line; BlockError where a library is wrong.
    """
    library = load_library(libraries)
    file = Path(path)
    return read_text(load(file), file, library=library)


def read_text(
    text: str,
    file: Path = Path("<text>"),
    libraries: Iterable[str | Path] = (),
    library: Library | None = None,
) -> Diagram:
    """The checked diagram of a text, as `read` does it.

    file: the name for messages, and the place from which relative files are looked for.
    library: the blocks, where they are at hand already.
    """
    problems = Problems()
    known = load_library(libraries) if library is None else library
    diagram = _readable(text, file, known, problems)
    problems.raise_found(str(file))
    if diagram is None:
        raise AssertionError("a diagram that cannot be read has problems")
    return diagram


def read_readable(
    path: str | Path, libraries: Iterable[str | Path] = ()
) -> tuple[Diagram, tuple[Problem, ...]]:
    """A diagram as far as it can be read, and what `read` would raise: for a picture of mistakes.

    Raises DiagramError where nothing can be read; BlockError where a library is wrong.
    """
    library = load_library(libraries)
    file = Path(path)
    return read_readable_text(load(file), file, library)


def read_readable_text(
    text: str, file: Path, library: Library
) -> tuple[Diagram, tuple[Problem, ...]]:
    """A text as far as it can be read, and what `read_text` would raise.

    Raises DiagramError where nothing can be read.
    """
    problems = Problems()
    diagram = _readable(text, file, library, problems)
    try:
        problems.raise_found(str(file))
    except DiagramError as error:
        if diagram is None or not diagram.blocks:
            raise
        return diagram, tuple(error.problems)
    assert diagram is not None
    return diagram, ()


def _readable(text: str, file: Path, library: Library, problems: Problems) -> Diagram | None:
    """What can be read of a text; what is wrong with it is noted."""
    try:
        return _Reader(library, problems).top(text, file)
    except DiagramError as error:  # the text cannot be read any further
        if error.problems is not problems.found:
            problems.take(error)
        return None


@dataclass(eq=False)
class _Scope:
    """Where a diagram stands: its file, its path there, and the subsystems that it defines.

    `numbers` are its parameters that are plain numbers, `counts` those that say how many blocks
    there are.
    """

    file: Path
    text: str
    path: str = ""
    parent: _Scope | None = None
    definitions: dict[str, _Definition] = field(default_factory=dict)
    numbers: Mapping[str, float] = field(default_factory=dict)
    counts: Collection[str] = ()


@dataclass(eq=False)
class _Definition:
    """A subsystem that is read when it is first needed, once for each set of counts."""

    name: str
    key: Scalar
    node: Node
    scope: _Scope
    diagrams: dict[tuple[tuple[str, float], ...], Diagram | None] = field(default_factory=dict)


class _Reader:
    def __init__(self, library: Library, problems: Problems) -> None:
        self.packages, self.problems = Packages(library, problems), problems
        self.sources = Sources(self.packages)
        self.stack: list[_Definition] = []
        self.included: dict[Path, dict[str, _Definition]] = {}
        self.sizes: dict[int, int] = {}

    @property
    def library(self) -> Library:
        return self.packages.library

    def top(self, text: str, file: Path) -> Diagram | None:
        entries = self.sources.tree(text, file)
        if entries is None:
            return None
        body = Body(self.problems)
        body.required(entries, "blocks", "a diagram")
        scope = _Scope(file, text, numbers=numbers_of(entries), counts=counts_of(entries))
        scope.definitions = self.define(entries, scope) | self.include(entries, scope)
        entries = replicated(entries, scope.numbers, body)
        base = self.common(entries, body, scope, file.stem, Place(str(file), 1, 1))
        diagram = self.with_settings(base, entries, body)
        self.finish(diagram, body)
        if self.sizes[id(diagram)] > MOST_BLOCKS:
            what = f"the diagram has {self.sizes[id(diagram)]} blocks with those of its subsystems"
            hint = f"At most {MOST_BLOCKS} can be compiled."
            self.problems.add(what, Place(str(file)), (), hint)
        return diagram

    def with_settings(self, diagram: Diagram, entries: Entries, body: Body) -> Diagram:
        """The diagram with the sections of the top, each of which needs those before it."""
        given = entries.values
        if "span" in given:
            diagram = replace(diagram, span=read_span(given["span"], body))
        if "every" in given:
            diagram = replace(diagram, every=read_every(given["every"], body))
        if "max_step" in given:
            diagram = replace(diagram, max_step=read_max_step(given["max_step"], body))
        if "record" in given:
            diagram = replace(diagram, record=read_record(given["record"], body, diagram))
        if "require" in given:
            diagram = replace(diagram, require=read_require(given["require"], body))
        if "presets" in given:
            diagram = replace(diagram, presets=read_presets(given["presets"], body, diagram))
        if "measured" in given:
            diagram = replace(diagram, measured=read_measured(given["measured"], body, diagram))
        if "scene" in given:
            diagram = replace(diagram, scene=read_scene(given["scene"], body))
        return diagram

    def common(
        self, entries: Entries, body: Body, scope: _Scope, name: str, place: Place
    ) -> Diagram:
        """The sections that every diagram may have."""
        given = entries.values

        def find(type_name: str, at: Place, line: Entries) -> Block | Diagram | None:
            return self.find(type_name, scope, at, line)

        inputs = read_inputs(given["inputs"], body) if "inputs" in given else {}
        parameters = read_parameters(given["parameters"], body) if "parameters" in given else {}
        blocks = read_blocks(given["blocks"], body, find) if "blocks" in given else {}
        subsystems = {
            name: diagram
            for name, definition in scope.definitions.items()
            if (diagram := self.diagram(definition)) is not None
        }
        return Diagram(
            name=name,
            file=scope.file,
            text=scope.text,
            library=self.library,
            title=read_title(given["title"], body) if "title" in given else "",
            inputs=inputs,
            outputs=read_outputs(given["outputs"], body) if "outputs" in given else {},
            parameters=parameters,
            blocks=blocks,
            subsystems=subsystems,
            events=read_events(given["events"], body) if "events" in given else (),
            place=place,
            counts={name: scope.numbers[name] for name in scope.counts if name in scope.numbers},
        )

    def finish(self, diagram: Diagram, body: Body) -> None:
        """Check a diagram of which everything has been read."""
        check_names(diagram, body)
        check_parameters(diagram.parameters, self.problems)
        for name in diagram.counts:
            if diagram.parameters[name].fit is not None:
                what = f"'{name}' says how many blocks there are, and a fit cannot change it"
                self.problems.add(what, diagram.parameters[name].place, (), "Take 'fit' away.")
        self.sizes[id(diagram)] = sum(
            1 + (self.sizes[id(use.subsystem)] if use.subsystem else 0)
            for use in diagram.blocks.values()
        )

    def find(
        self, type_name: str, scope: _Scope, place: Place, line: Entries
    ) -> Block | Diagram | None:
        """The block or subsystem of a type, the nearest first; None with a problem noted."""
        visible: dict[str, _Definition] = {}
        around: _Scope | None = scope
        while around is not None:
            visible = around.definitions | visible
            around = around.parent
        definition = visible.get(type_name)
        if definition is None and not self.packages.has(type_name, place):
            return None
        if definition is None and type_name in self.library:
            return self.library[type_name]
        if definition is None:
            self.unknown_type(type_name, visible, place)
            return None
        if definition in self.stack:
            chain = [open_.name for open_ in self.stack[self.stack.index(definition) :]]
            what = f"subsystem '{type_name}' contains itself: {' -> '.join([*chain, type_name])}"
            self.problems.add(what, place, (), "A subsystem cannot be a part of itself.")
            return None
        if len(self.stack) == MOST_LEVELS:
            what = f"subsystems stand inside each other more than {MOST_LEVELS} levels deep"
            self.problems.add(what, place)
            return None
        return self.diagram(definition, self.counts(definition, line, scope))

    def counts(self, definition: _Definition, line: Entries, scope: _Scope) -> dict[str, float]:
        """The counts that a line gives to the subsystem that it uses."""
        found: dict[str, float] = {}
        if not isinstance(definition.node, Entries):
            return found
        usual = numbers_of(definition.node)
        for name in counts_of(definition.node).keys() & line.keys.keys():
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

    def unknown_type(self, type_name: str, visible: Iterable[str], place: Place) -> None:
        """Note a type that is neither block nor subsystem; a name of another tool is explained."""
        if self.packages.unknown(type_name, place) or self.problems.skips():
            return
        found = find_synonym(type_name, [*self.library])
        hint = found[1] if found is not None else find_instead(type_name) or who_has(type_name)
        if hint:
            self.problems.add(f"unknown block type '{clip(type_name)}'", place, (), hint)
        else:
            self.problems.unknown("block type", type_name, [*visible, *self.library], place)

    def diagram(
        self, definition: _Definition, counts: Mapping[str, float] | None = None
    ) -> Diagram | None:
        """The diagram of a subsystem; None where it is none, or is just being read."""
        given = counts or {}
        key = tuple(sorted(given.items()))
        if key in definition.diagrams or definition in self.stack:
            return definition.diagrams.get(key)
        self.stack.append(definition)
        outer = definition.scope
        path = f"{outer.path}.{definition.name}" if outer.path else definition.name
        body = Body(self.problems, path)
        example = "{inputs: [u], outputs: {y: k}, blocks: {...}}"
        what = f"subsystem '{clip(definition.name)}'"
        entries = body.entries(definition.node, what, example)
        diagram = None
        if entries is not None:
            misplaced = any(key in TOP and key not in INSIDE for key in entries.keys)
            hint = "Some sections belong to the top of the file only." if misplaced else ""
            body.check_keys(entries, INSIDE, "section of a subsystem", hint=hint)
            numbers = {**numbers_of(entries), **given}
            counted = counts_of(entries)
            scope = _Scope(outer.file, outer.text, path, outer, numbers=numbers, counts=counted)
            scope.definitions = self.define(entries, scope)
            entries = replicated(entries, numbers, body)
            place = body.place(definition.key)
            diagram = self.common(entries, body, scope, definition.name, place)
            if "effect" in entries.values:
                effect = read_effect(entries.values["effect"], body, diagram)
                diagram = replace(diagram, effect=effect)
            self.finish(diagram, body)
        definition.diagrams[key] = diagram
        self.stack.pop()
        return diagram

    def define(self, entries: Entries, scope: _Scope) -> dict[str, _Definition]:
        """The subsystems that stand in a diagram."""
        found: dict[str, _Definition] = {}
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
            found[name] = _Definition(name, key, inside, scope)
        return found

    def include(self, entries: Entries, scope: _Scope) -> dict[str, _Definition]:
        """The subsystems of the files that a file includes, but not of those that they include."""
        found: dict[str, _Definition] = {}
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

    def definitions_of(self, included: Included) -> dict[str, _Definition]:
        """The subsystems of an included file."""
        if included.file not in self.included:
            scope = _Scope(included.file, included.text)
            own = self.included[included.file] = self.define(included.entries, scope)
            scope.definitions = own | self.include(included.entries, scope)
        return self.included[included.file]
