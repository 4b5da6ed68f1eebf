"""Installed libraries that a diagram names: by `libraries`, `mylab.magnet`, `mylab:rig.yaml`."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path
from shlex import quote

from tracewire.diagram.body import Body
from tracewire.diagram.files import load_text
from tracewire.diagram.problems import Problems, clip
from tracewire.diagram.strict import Entries, Items, Node, Scalar, compose
from tracewire.errors import BlockError, DiagramError, Location
from tracewire.formula import is_name, name_hint
from tracewire.library import (
    OWN,
    Library,
    Package,
    find_package,
    folder_of,
    installed_packages,
    package_blocks,
    package_file,
    packages_with,
    subsystem_files,
)

IN_A_PACKAGE = re.compile(r"(\w{2,}):(.*)", re.DOTALL)
"""A file of a library. One letter in front of a colon is a drive of Windows."""


class Packages:
    """The installed libraries of a diagram while it is read; one is read when it is first named.

    `library` has the blocks that were given, and those of the packages that were named so far.
    """

    def __init__(self, library: Library, problems: Problems) -> None:
        self.library, self.problems = library, problems
        self._found: dict[str, Package | None] = {}
        self._loaded: dict[str, bool] = {}  # and whether that went well
        self._folders: list[Path] = []

    def read(self, node: Node, body: Body) -> None:
        """`libraries`: names, or a mapping of them to conditions on the version."""
        given: list[tuple[Scalar, Node | None]]
        if isinstance(node, Items | Scalar):
            given = [(name, None) for name in body.scalars(node, "'libraries'")]
        else:
            given = [(key, value) for _, key, value in node]
        for name, wanted in given:
            place = body.place(name)
            if not is_name(name.text):
                what = f"'{clip(name.text)}' cannot be the name of a library"
                self.problems.add(what, place, (), name_hint(name.text))
            elif self.load(name.text, place) and wanted is not None:
                text = body.text(wanted, "the condition on a version")
                if text is not None:
                    self._check_version(name.text, text, body.place(wanted))

    def load(self, name: str, place: Location) -> bool:
        """Whether the blocks of an installed library are there; what is wrong is noted once."""
        if name not in self._loaded:
            self._loaded[name] = True
            if any(known.startswith(f"{name}.") for known in self.library):
                return True  # the blocks of a diagram that is read again
            package = self._find(name, place)
            if package is None or package.name == OWN:  # whose blocks have no name in front
                self._loaded[name] = package is not None
                return self._loaded[name]
            try:
                self.library = self.library.extended(*package_blocks(package, place))
            except BlockError as error:
                self.problems.take(error)
                self._loaded[name] = False
        return self._loaded[name]

    def has(self, type_name: str, place: Location) -> bool:
        """Whether the library is there that a type such as `mylab.magnet` names, if it does."""
        name = _library_in(type_name)
        return not name or self.load(name, place)

    def unknown(self, type_name: str, place: Location) -> bool:
        """Note that a library does not have a type; False where the type names no library."""
        name = _library_in(type_name)
        if name:
            there = [known for known in self.library if known.startswith(f"{name}.")]
            hint = f"'tracewire blocks {name}' lists what the library has."
            if name == OWN:
                hint = "The types of tracewire have no name in front."
            self.problems.unknown("block type", type_name, there, place, hint)
        return bool(name)

    def file(self, text: str, folder: Path, place: Location) -> Path | None:
        """The file that `include` names in a diagram of `folder`; None with a problem noted."""
        found = IN_A_PACKAGE.fullmatch(text)
        if found:
            package = self._find(found[1], place)
            try:
                if package is not None:
                    self._folders.append(folder_of(package, place))
                    return package_file(package, found[2], place)
            except BlockError as error:
                self.problems.take(error)
            return None
        file = folder / text
        if any(_is_in(folder, root) and not _is_in(file, root) for root in self._folders):
            what = f"'{clip(text)}' leads out of the library that names it"
            self.problems.add(what, place, (), "A file of a library includes files of libraries.")
            return None
        return file

    def _find(self, name: str, place: Location) -> Package | None:
        """An installed library; None where there is none, which is noted once."""
        if name not in self._found:
            self._found[name] = None
            try:
                self._found[name] = find_package(name, place)
            except BlockError as error:
                self.problems.take(error)
        return self._found[name]

    def _check_version(self, name: str, wanted: str, place: Location) -> None:
        from packaging.specifiers import InvalidSpecifier, SpecifierSet
        from packaging.version import InvalidVersion

        package = self._find(name, place)
        if package is None:
            return
        try:
            if SpecifierSet(wanted).contains(package.version, prereleases=True):
                return
        except InvalidSpecifier:
            what = f"'{clip(wanted)}' is no condition on the version of a library"
            self.problems.add(what, place, (), 'Write it like ">=1.2" or ">=1.2, <2".')
            return
        except InvalidVersion:
            pass
        what = f"the diagram needs the library '{name}' {wanted}, and {package} is installed"
        hint = f"Install another version: pip install {quote(package.distribution + wanted)}."
        self.problems.add(what, place, (), hint)


def who_has(type_name: str) -> str:
    """Which installed libraries have a block or subsystem of a name, as a hint; else nothing."""
    hints = [
        f"The installed library '{name}' has it: write type: {name}.{type_name}."
        for name in packages_with(type_name)
    ]
    for package in (find_package(OWN), *installed_packages()):
        for file, names in package_subsystems(package).items():
            if type_name in names:
                what = f"The library '{package.name}' has a subsystem '{type_name}'"
                hints.append(f"{what}: write include: {package.name}:{file}.")
    return " ".join(dict.fromkeys(hints))


def package_subsystems(package: Package) -> dict[str, tuple[str, ...]]:
    """The names of the subsystems in the files of an installed library that can be included."""
    found: dict[str, tuple[str, ...]] = {}
    try:
        folder = folder_of(package)
        files = subsystem_files(package)
    except BlockError:
        return found
    for file in files:
        names = _names_in(folder / file, (folder / file).stat().st_mtime_ns)
        if names:
            found[file] = names
    return found


@lru_cache(maxsize=1024)
def _names_in(file: Path, changed: int) -> tuple[str, ...]:
    """The subsystems of a file that can be included; `changed` is its time, to read it once."""
    try:
        root = compose(load_text(file), file, Problems())
    except DiagramError:
        return ()
    if not isinstance(root, Entries) or "blocks" in root.values:  # a diagram is not included
        return ()
    inside = root.values.get("subsystems")
    return tuple(inside.keys) if isinstance(inside, Entries) else ()


def _library_in(type_name: str) -> str:
    name, dot, _ = type_name.partition(".")
    return name if dot and is_name(name) else ""


def _is_in(path: Path, folder: Path) -> bool:
    try:
        return path.resolve().is_relative_to(folder)
    except (OSError, ValueError, RuntimeError):  # a path that no file can have
        return False
