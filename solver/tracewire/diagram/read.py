"""From the text of a diagram file to a checked diagram."""

from __future__ import annotations

from collections.abc import Iterable
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
from tracewire.diagram.read_expect import read_expect
from tracewire.diagram.read_scene import read_scene
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
from tracewire.diagram.strict import Entries, Node, Scalar, compose
from tracewire.diagram.uses import read_blocks
from tracewire.errors import DiagramError, Place, Problem
from tracewire.formula import is_name, name_hint
from tracewire.library import Block, Library, find_instead, find_synonym, load_library

MOST_LEVELS = 30
MOST_BLOCKS = 100_000
INSIDE = (
    *("title", "inputs", "outputs", "parameters", "blocks", "subsystems", "events", "effect"),
)
TOP = (
    *("title", "span", "every", "record", "inputs", "parameters", "blocks", "subsystems"),
    *("include", "events", "require", "presets", "measured", "max_step", "scene", "libraries"),
    "expect",
)
INCLUDED = ("title", "libraries", "include", "subsystems")


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
    """Where a diagram stands: its file, its path there, and the subsystems that it defines."""

    file: Path
    text: str
    path: str = ""
    parent: _Scope | None = None
    definitions: dict[str, _Definition] = field(default_factory=dict)


@dataclass(eq=False)
class _Definition:
    """A subsystem that is read when it is first needed."""

    name: str
    key: Scalar
    node: Node
    scope: _Scope
    is_read: bool = False
    diagram: Diagram | None = None


class _Reader:
    def __init__(self, library: Library, problems: Problems) -> None:
        self.packages, self.problems = Packages(library, problems), problems
        self.stack: list[_Definition] = []
        self.including: list[Path] = []
        self.included: dict[Path, dict[str, _Definition]] = {}
        self.sizes: dict[int, int] = {}

    @property
    def library(self) -> Library:
        return self.packages.library

    def top(self, text: str, file: Path) -> Diagram | None:
        root = compose(text, file, self.problems)
        body = Body(self.problems, file.parent)
        entries = body.entries(root, "a diagram", "'blocks: {column: {type: gain, ...}}'")
        if entries is None:
            return None
        hint = ""
        if "outputs" in entries.keys:
            hint = "It belongs to a subsystem; 'record' names what is kept of a run."
        elif "effect" in entries.keys:
            hint = "It belongs to a subsystem, which a trace may then add to the diagram."
        body.check_keys(entries, TOP, "section", hint=hint)
        body.required(entries, "blocks", "a diagram")
        scope = _Scope(file, text)
        self.including = [_resolved(file)]
        if "libraries" in entries.values:
            self.packages.read(entries.values["libraries"], body)
        scope.definitions = self.define(entries, scope) | self.include(entries, scope, body)
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
        if "expect" in given:
            diagram = replace(diagram, expect=read_expect(given["expect"], body, diagram))
        return diagram

    def common(
        self, entries: Entries, body: Body, scope: _Scope, name: str, place: Place
    ) -> Diagram:
        """The sections that every diagram may have."""
        given = entries.values

        def find(type_name: str, at: Place) -> Block | Diagram | None:
            return self.find(type_name, scope, at)

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
        )

    def finish(self, diagram: Diagram, body: Body) -> None:
        """Check a diagram of which everything has been read."""
        check_names(diagram, body)
        check_parameters(diagram.parameters, self.problems)
        self.sizes[id(diagram)] = sum(
            1 + (self.sizes[id(use.subsystem)] if use.subsystem else 0)
            for use in diagram.blocks.values()
        )

    def find(self, type_name: str, scope: _Scope, place: Place) -> Block | Diagram | None:
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
        return self.diagram(definition)

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

    def diagram(self, definition: _Definition) -> Diagram | None:
        """The diagram of a subsystem; None where it is none, or is just being read."""
        if definition.is_read or definition in self.stack:
            return definition.diagram
        self.stack.append(definition)
        outer = definition.scope
        path = f"{outer.path}.{definition.name}" if outer.path else definition.name
        body = Body(self.problems, outer.file.parent, path)
        example = "{inputs: [u], outputs: {y: k}, blocks: {...}}"
        what = f"subsystem '{clip(definition.name)}'"
        entries = body.entries(definition.node, what, example)
        if entries is not None:
            misplaced = any(key in TOP and key not in INSIDE for key in entries.keys)
            hint = "Some sections belong to the top of the file only." if misplaced else ""
            body.check_keys(entries, INSIDE, "section of a subsystem", hint=hint)
            scope = _Scope(outer.file, outer.text, path, outer)
            scope.definitions = self.define(entries, scope)
            place = body.place(definition.key)
            diagram = self.common(entries, body, scope, definition.name, place)
            if "effect" in entries.values:
                effect = read_effect(entries.values["effect"], body, diagram)
                diagram = replace(diagram, effect=effect)
            self.finish(diagram, body)
            definition.diagram = diagram
        definition.is_read = True
        self.stack.pop()
        return definition.diagram

    def define(self, entries: Entries, scope: _Scope) -> dict[str, _Definition]:
        """The subsystems that stand in a diagram."""
        found: dict[str, _Definition] = {}
        node = entries.values.get("subsystems")
        if node is None:
            return found
        body = Body(self.problems, scope.file.parent, scope.path)
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

    def include(self, entries: Entries, scope: _Scope, body: Body) -> dict[str, _Definition]:
        """The subsystems of the files that a file includes, but not of those that they include."""
        found: dict[str, _Definition] = {}
        node = entries.values.get("include")
        own = entries.values.get("subsystems")
        there = own.keys if isinstance(own, Entries) else {}
        for name in body.scalars(node, "'include'") if node is not None else ():
            place = body.place(name)
            file = self.packages.file(name.text, body.folder, place)
            for key, definition in self.included_file(file, place).items() if file else ():
                other = found.get(key)
                if key in there or (other is not None and other is not definition):
                    first = there[key].place if other is None else other.key.place
                    what = f"two definitions of '{key}': one in '{name.text}', the other in {first}"
                    self.problems.add(what, place, (), "Rename one.")
                found[key] = definition
        return {key: definition for key, definition in found.items() if key not in there}

    def included_file(self, file: Path, place: Place) -> dict[str, _Definition]:
        resolved = _resolved(file)
        if resolved in self.including:
            chain = [path.name for path in self.including[self.including.index(resolved) :]]
            what = f"files include each other: {' -> '.join([*chain, file.name])}"
            self.problems.add(what, place, (), "Move what both need into a file of its own.")
            return {}
        if len(self.including) > MOST_LEVELS:
            what = f"files include each other more than {MOST_LEVELS} levels deep"
            self.problems.add(what, place)
            return {}
        if resolved not in self.included:
            self.included[resolved] = {}
            self.including.append(resolved)
            try:
                self.included[resolved] = self.definitions_of(file, place)
            except DiagramError as error:
                if error.problems is not self.problems.found:
                    self.problems.take(error)
            self.including.pop()
        return self.included[resolved]

    def definitions_of(self, file: Path, place: Place) -> dict[str, _Definition]:
        text = load(file, place)
        body = Body(self.problems, file.parent)
        root = compose(text, file, self.problems)
        entries = body.entries(root, "an included file", "'subsystems: {bearing: {...}}'")
        if entries is None:
            return {}
        hint = "A file that is included holds subsystems only."
        body.check_keys(entries, INCLUDED, "section of an included file", hint=hint)
        if "libraries" in entries.values:
            self.packages.read(entries.values["libraries"], body)
        scope = _Scope(file, text)
        own = self.define(entries, scope)
        scope.definitions = own | self.include(entries, scope, body)
        return own


def _resolved(file: Path) -> Path:
    try:
        return file.resolve()
    except (OSError, ValueError, RuntimeError):  # a path that no file can have
        return file
