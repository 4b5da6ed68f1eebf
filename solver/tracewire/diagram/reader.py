"""From the text of a diagram file to a checked diagram."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from tracewire.arguments import checked
from tracewire.diagram.body import Body
from tracewire.diagram.check import check_names
from tracewire.diagram.choose import NUMBER, with_number
from tracewire.diagram.definitions import USUAL, Choice, Definition, Definitions, Scope
from tracewire.diagram.diagram import Diagram, Value
from tracewire.diagram.files import load_text
from tracewire.diagram.limits import LIMITS
from tracewire.diagram.loops import check_parameters
from tracewire.diagram.measured import read_measured
from tracewire.diagram.packages import Packages
from tracewire.diagram.problems import Problems
from tracewire.diagram.read_effect import read_effect
from tracewire.diagram.read_expect import read_expect
from tracewire.diagram.read_scene import read_scene
from tracewire.diagram.replicate import counts_of, numbers_of, replicate_rows
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
from tracewire.diagram.sources import Sources
from tracewire.diagram.strict import Entries
from tracewire.diagram.uses import read_blocks
from tracewire.errors import DiagramError, Location, Problem
from tracewire.formula import names_of
from tracewire.library import Block, Library, load_library


@checked
def read(path: str | Path, libraries: Iterable[str | Path] = ()) -> Diagram:
    """The checked diagram of a YAML file.

    libraries: files and folders of block declarations, beside the shipped ones; they are Python and
    run when they are read.

    Raises DiagramError with everything that is wrong in the file and in those that it includes, by
    line; BlockError where a library is wrong.
    """
    library = load_library(libraries)
    file = Path(path)
    return read_text(load_text(file), file, library=library)


@checked
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
    known = load_library(libraries) if library is None else library
    diagram, problems = read_readable_text(text, file, known)
    if problems:
        raise DiagramError(problems)
    return diagram


def read_readable(
    path: str | Path, libraries: Iterable[str | Path] = ()
) -> tuple[Diagram, tuple[Problem, ...]]:
    """A diagram as far as it can be read, and what `read` would raise: for a picture of mistakes.

    Raises DiagramError where nothing can be read; BlockError where a library is wrong.
    """
    library = load_library(libraries)
    file = Path(path)
    return read_readable_text(load_text(file), file, library)


def read_readable_text(
    text: str, file: Path, library: Library
) -> tuple[Diagram, tuple[Problem, ...]]:
    """A text as far as it can be read, and what `read_text` would raise.

    Raises DiagramError where nothing can be read.
    """
    problems, diagram = Problems(), None
    try:
        diagram = _Reader(library, problems).top(text, file)
    except DiagramError as error:  # the text cannot be read any further
        if error.problems is not problems.found:
            problems.take(error)
    found = problems.told(str(file))
    if diagram is None or (found and not diagram.blocks):
        raise DiagramError(found)
    return diagram, found


class _Reader:
    def __init__(self, library: Library, problems: Problems) -> None:
        self.packages, self.problems = Packages(library, problems), problems
        self.sources = Sources(self.packages)
        self.stack: list[Definition] = []
        self.definitions = Definitions(self.sources)
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
        scope = Scope(file, text, numbers=numbers_of(entries), counts=counts_of(entries))
        scope.definitions = self.definitions.define(entries, scope)
        scope.definitions |= self.definitions.include(entries, scope)
        entries = replicate_rows(entries, scope.numbers, body)
        base = self.common(entries, body, scope, file.stem, Location(str(file), 1, 1))
        diagram = self.with_settings(base, entries, body)
        diagram = replace(diagram, sources=self.sources.others)
        self.finish(diagram, body)
        if self.sizes[id(diagram)] > LIMITS.most_blocks:
            what = f"the diagram has {self.sizes[id(diagram)]} blocks with those of its subsystems"
            hint = f"At most {LIMITS.most_blocks} can be compiled."
            self.problems.add(what, Location(str(file)), (), hint)
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
        self, entries: Entries, body: Body, scope: Scope, name: str, place: Location
    ) -> Diagram:
        """The sections that every diagram may have."""
        given = entries.values

        def find(type_name: str, at: Location, line: Entries) -> Block | Diagram | None:
            return self.find(type_name, scope, at, line)

        title = read_title(given["title"], body) if "title" in given else ""
        inputs = read_inputs(given["inputs"], body) if "inputs" in given else {}
        parameters = read_parameters(given["parameters"], body) if "parameters" in given else {}
        blocks = read_blocks(given["blocks"], body, find) if "blocks" in given else {}
        subsystems = {
            name: diagram
            for name, definition in scope.definitions.items()
            if (diagram := self.diagram(definition)) is not None
        }
        for name, diagram in subsystems.items():  # what is wrong in one without a use is told, too
            bodies = {v: self.diagram(scope.definitions[name], Choice(v)) for v in diagram.variants}
            known = {variant: body for variant, body in bodies.items() if body is not None}
            if known:
                subsystems[name] = replace(diagram, bodies=known)
        return Diagram(
            name=name,
            file=scope.file,
            text=scope.text,
            library=self.library,
            title=title,
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
        for use in diagram.blocks.values():
            chosen = use.settings.get(NUMBER) if use.subsystem is not None else None
            for name in names_of(chosen.formula) if isinstance(chosen, Value) else ():
                if name in diagram.parameters and diagram.parameters[name].fit is not None:
                    what = f"'{name}' chooses a variant of '{use.name}', and a fit cannot change it"
                    place = diagram.parameters[name].place
                    self.problems.add(what, place, (), "Take 'fit' away.")
        self.sizes[id(diagram)] = sum(
            1 + (self.sizes[id(use.subsystem)] if use.subsystem else 0)
            for use in diagram.blocks.values()
        )

    def find(
        self, type_name: str, scope: Scope, place: Location, line: Entries
    ) -> Block | Diagram | None:
        """The block or subsystem of a type, the nearest first; None with a problem noted."""
        visible: dict[str, Definition] = {}
        around: Scope | None = scope
        while around is not None:
            visible = around.definitions | visible
            around = around.parent
        definition = visible.get(type_name)
        if definition is None and not self.packages.has(type_name, place):
            return None
        if definition is None and type_name in self.library:
            return self.library[type_name]
        if definition is None:
            self.definitions.unknown_type(type_name, visible, place)
            return None
        if definition in self.stack:
            chain = [open_.name for open_ in self.stack[self.stack.index(definition) :]]
            what = f"subsystem '{type_name}' contains itself: {' -> '.join([*chain, type_name])}"
            self.problems.add(what, place, (), "A subsystem cannot be a part of itself.")
            return None
        if len(self.stack) == LIMITS.most_levels:
            what = f"subsystems stand inside each other more than {LIMITS.most_levels} levels deep"
            self.problems.add(what, place)
            return None
        choice = self.definitions.choice(definition, line, scope, place)
        return None if choice is None else self.diagram(definition, choice)

    def diagram(self, definition: Definition, choice: Choice = USUAL) -> Diagram | None:
        """The diagram of a subsystem; None where it is none, or is just being read."""
        variant = "" if choice.number else choice.variant or next(iter(definition.variants), "")
        key = (variant, *sorted(choice.counts.items()))
        if key in definition.diagrams or definition in self.stack:
            return definition.diagrams.get(key)
        if not choice.number:  # else it has blocks that are its own bodies
            self.stack.append(definition)
        outer, path = definition.scope, definition.path
        body = Body(self.problems, path)
        entries = self.definitions.entries(definition, choice, body)
        diagram = None
        if entries is not None:
            numbers = {**numbers_of(entries), **choice.counts}
            counted = counts_of(entries)
            scope = Scope(outer.file, outer.text, path, outer, numbers=numbers, counts=counted)
            scope.definitions = self.definitions.define(entries, scope)
            entries = replicate_rows(entries, numbers, body)
            at = body.place(entries if choice.number else definition.key)
            diagram = self.common(entries, body, scope, definition.name, at)
            if "effect" in entries.values:
                effect = read_effect(entries.values["effect"], body, diagram)
                diagram = replace(diagram, effect=effect)
            diagram = replace(diagram, variant=variant, variants=definition.variants)
            diagram = with_number(diagram) if choice.number else diagram
            self.finish(diagram, body)
        definition.diagrams[key] = diagram
        if not choice.number:
            self.stack.pop()
        return diagram
