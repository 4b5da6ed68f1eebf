"""The files of a diagram as one tree: its own, those that it extends, those that it includes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

from tracewire.diagram.body import Body
from tracewire.diagram.derived import with_bases
from tracewire.diagram.extend import merge, without
from tracewire.diagram.files import load_text
from tracewire.diagram.grammar import INCLUDED, TOP
from tracewire.diagram.limits import LIMITS
from tracewire.diagram.packages import Packages
from tracewire.diagram.problems import Problems
from tracewire.diagram.strict import Entries, Node, Scalar, compose
from tracewire.errors import DiagramError, Location

BROUGHT = ("parameters", "presets")
"""Sections of an included file that become a part of the diagram."""


@dataclass(frozen=True)
class Included:
    """A file that another one includes."""

    file: Path
    text: str
    entries: Entries


@dataclass(eq=False)
class Sources:
    """The files of one diagram while it is read; each is read once. Problems are noted."""

    packages: Packages
    files: dict[Path, Included | None] = field(default_factory=dict)
    including: list[Path] = field(default_factory=list)
    extending: list[Path] = field(default_factory=list)
    extended: list[Path] = field(default_factory=list)

    @property
    def others(self) -> tuple[Path, ...]:
        """The files that were read beside that of the diagram itself."""
        included = (found.file for found in self.files.values() if found is not None)
        return (*self.extended, *included)

    @property
    def problems(self) -> Problems:
        """What is wrong in the files."""
        return self.packages.problems

    def tree(self, text: str, file: Path) -> Entries | None:
        """The sections of a diagram, with what it extends and the parameters that it includes.

        Each node keeps its place in its own file. None: the text is no mapping. Raises
        DiagramError: a file is not YAML, or one that is extended cannot be read.
        """
        root = compose(text, file, self.problems)
        body = Body(self.problems)
        entries = body.entries(root, "a diagram", "'blocks: {column: {type: gain, ...}}'")
        if entries is None:
            return None
        hint = ""
        if "outputs" in entries.keys:
            hint = "It belongs to a subsystem; 'record' names what is kept of a run."
        elif "effect" in entries.keys:
            hint = "It belongs to a subsystem, which a trace may then add to the diagram."
        elif not {"start", "initial"}.isdisjoint(entries.keys):
            hint = "A start value stands at its block: x: {type: integrator, of: v, start: 1}."
        body.check_keys(entries, TOP, "section", hint=hint)
        if "libraries" in entries.values:
            self.packages.read(entries.values["libraries"], body)
        self.including = [resolved(file)]
        own = self._with_included(entries, body)
        removed = own.values.get("remove")
        names = [] if removed is None else body.scalars(removed, "'remove'")
        extends = own.values.get("extends")
        if extends is not None:
            base = self._base(extends, file, body)
            if base is None:
                return None
            return self._derived(merge(without(base, names, self.problems), _changes(own)))
        if removed is not None:
            what = "'remove' takes parts of another diagram away, and this one extends none"
            hint = "Write extends: FILE, or take the parts away here."
            self.problems.add(what, own.keys["remove"].place, (), hint)
        return self._derived(_changes(own))

    def _derived(self, entries: Entries) -> Entries:
        """The sections of a file, its subsystems with what they extend of the included files."""
        bases: dict[str, Node] = {}
        for _, included in self.included(entries):
            there = included.entries.values.get("subsystems")
            bases |= there.values if isinstance(there, Entries) else {}
        return with_bases(entries, bases, self.problems)

    def _base(self, node: Node, file: Path, body: Body) -> Entries | None:
        place = node.place
        if not isinstance(node, Scalar):
            hint = "Write extends: base.yaml; parts of several files come by 'include'."
            self.problems.add("'extends' names one file", place, (), hint)
            return None
        target = node.path
        self.extending.append(resolved(file))
        if (known := resolved(target)) in self.extending:
            chain = [path.name for path in self.extending[self.extending.index(known) :]]
            what = f"diagrams extend each other: {' -> '.join([*chain, target.name])}"
            raise DiagramError.one(what, place, hint="Move what both need into a third file.")
        if len(self.extending) > LIMITS.most_levels:
            what = f"diagrams extend each other more than {LIMITS.most_levels} levels deep"
            raise DiagramError.one(what, place)
        self.extended.append(target)
        found = self.tree(load_text(target, place), target)
        self.extending.pop()
        return found

    def included(self, entries: Entries) -> Iterator[tuple[Scalar, Included]]:
        """The files that a file includes, those that can be read, with the nodes that name them."""
        node = entries.values.get("include")
        for name in Body(self.problems).scalars(node, "'include'") if node is not None else ():
            target = self._named(name)
            found = None if target is None else self.files.get(resolved(target))
            if found is not None:
                yield name, found

    def _named(self, name: Scalar) -> Path | None:
        """The file that `include` names; None with a problem noted."""
        return self.packages.file(name.text, Path(name.place.file).parent, name.place)

    def all_included(self, entries: Entries) -> set[str]:
        """The paths of the files that a file includes, and of those that they include."""
        found: set[str] = set()
        for _, included in self.included(entries):
            found |= {str(included.file)} | self.all_included(included.entries)
        return found

    def _with_included(self, entries: Entries, body: Body) -> Entries:
        """The sections of a file with the parameters and presets of those that it includes."""
        node = entries.values.get("include")
        for name in body.scalars(node, "'include'") if node is not None else ():
            target = self._named(name)
            included = None if target is None else self._included(target, name.place)
            for section in BROUGHT if included is not None else ():
                assert included is not None
                entries = self._brought(section, entries, included.entries, name)
        return entries

    def _brought(self, section: str, entries: Entries, other: Entries, name: Scalar) -> Entries:
        """The sections of a file with one of an included file."""
        new, own = other.values.get(section), entries.values.get(section)
        if not isinstance(new, Entries):
            if new is not None:
                Body(self.problems).entries(new, f"'{section}'", "{k: 2.5}")
            return entries
        if not isinstance(own, Entries):
            keys = {section: other.keys[section], **entries.keys}
            return replace(entries, keys=keys, values={section: new, **entries.values})
        for key in new.keys.keys() & own.keys.keys():
            if own.values[key] is not new.values[key]:
                first = own.keys[key].place
                what = f"two definitions of '{key}': one in '{name.text}', the other in {first}"
                self.problems.add(what, name.place, (), "Rename one.")
        both = replace(own, keys=new.keys | own.keys, values=new.values | own.values)
        return replace(entries, values={**entries.values, section: both})

    def _included(self, file: Path, place: Location) -> Included | None:
        known = resolved(file)
        if known in self.including:
            chain = [path.name for path in self.including[self.including.index(known) :]]
            what = f"files include each other: {' -> '.join([*chain, file.name])}"
            self.problems.add(what, place, (), "Move what both need into a file of its own.")
            return None
        if len(self.including) > LIMITS.most_levels:
            what = f"files include each other more than {LIMITS.most_levels} levels deep"
            self.problems.add(what, place)
            return None
        if known not in self.files:
            self.including.append(known)
            self.files[known] = None
            try:
                self.files[known] = self._read_included(file, place)
            except DiagramError as error:
                if error.problems is not self.problems.found:
                    self.problems.take(error)
            self.including.pop()
        return self.files[known]

    def _read_included(self, file: Path, place: Location) -> Included | None:
        text = load_text(file, place)
        body = Body(self.problems)
        root = compose(text, file, self.problems)
        entries = body.entries(root, "an included file", "'subsystems: {bearing: {...}}'")
        if entries is None:
            return None
        hint = "A file with other sections can be extended: extends: FILE."
        body.check_keys(entries, INCLUDED, "section of an included file", hint=hint)
        if "libraries" in entries.values:
            self.packages.read(entries.values["libraries"], body)
        return Included(file, text, self._derived(self._with_included(entries, body)))


def _changes(entries: Entries) -> Entries:
    """The sections of a file without those that say what it changes."""
    keys = {name: key for name, key in entries.keys.items() if name not in ("extends", "remove")}
    return replace(entries, keys=keys, values={name: entries.values[name] for name in keys})


def resolved(file: Path) -> Path:
    """The file itself, whatever its path looks like."""
    try:
        return file.resolve()
    except (OSError, ValueError, RuntimeError):  # a path that no file can have
        return file
