"""Libraries that are installed as packages: they are found by name, and read when asked for.

A distribution with the entry point `NAME = "package"` in the group `tracewire.blocks` is the
library `NAME`. Its folder has block files, as a folder of `--library`, and YAML files of
subsystems. Nothing is imported to find it, and of what is found only block files are run.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from tracewire.errors import BlockError, Location, Problem, unknown
from tracewire.files import working_folder
from tracewire.formula import is_name, name_hint
from tracewire.library.declare import Block
from tracewire.library.load import block_files, load_files
from tracewire.shipped import shipped

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP = "tracewire.blocks"
OWN = "tracewire"
"""The name of what comes with tracewire: its files of subsystems are `tracewire:FILE`."""
SUBSYSTEMS = (".yaml", ".yml")


@dataclass(frozen=True)
class Package:
    """An installed library: its name in diagrams, its distribution and version, its package."""

    name: str
    distribution: str
    version: str
    module: str = ""
    beside: Path = Path()

    def __str__(self) -> str:
        return f"{self.distribution} {self.version}"


def installed_packages() -> list[Package]:
    """The libraries of all installed distributions, by name. Nothing of them is run.

    `python -m` and notebooks have the working folder on the path of Python: what lies there is not
    installed.
    """
    here = working_folder()
    found = (p for p in _scanned(tuple(sys.path)) if p.beside != here)
    return sorted(found, key=lambda p: (p.name, p.distribution))


def find_package(name: str, place: Location = Location()) -> Package:
    """The installed library of a name; `place` is where it is named.

    Raises BlockError: it is not installed, two distributions have it, it cannot be a name.
    """
    if name == OWN:
        # the package stands above its subpackages: they do not import it, but it is there
        version = str(sys.modules[OWN].__version__)
        return Package(OWN, OWN, version, beside=shipped("blocks"))
    found = [package for package in installed_packages() if package.name == name]
    if not found:  # it may have been installed since this program started
        _scanned.cache_clear()
        found = [package for package in installed_packages() if package.name == name]
    if not found:
        raise BlockError([_missing(name, place)])
    if not is_name(name):
        what = f"'{name}' cannot be the name of a library, and {found[0]} declares it"
        raise BlockError([Problem(what, place, (), name_hint(name))])
    if len(found) > 1:
        what = f"two distributions have a library '{name}': {' and '.join(map(str, found))}"
        hint = f"Uninstall one: pip uninstall {found[-1].distribution}."
        raise BlockError([Problem(what, place, (), hint)])
    return found[0]


def folder_of(package: Package, place: Location = Location()) -> Path:
    """The folder with the files of an installed library. Raises BlockError: there is none."""
    if package.name == OWN:
        return package.beside.resolve()
    parts = package.module.split(".")
    if all(part.isidentifier() for part in parts):
        roots = [package.beside / parts[0]]
        if not roots[0].is_dir():  # an editable install has its files elsewhere
            roots = _roots(parts[0])
        for root in roots:
            folder = root.joinpath(*parts[1:])
            if folder.is_dir():
                return folder.resolve()
    what = f"the library '{package.name}' of {package} has no folder '{package.module}'"
    hint = f"Its entry point must name a package of it: {package.name} = '{package.name}_blocks'."
    raise BlockError([Problem(what, place, (), hint)])


def package_blocks(
    package: Package, place: Location = Location()
) -> tuple[dict[str, Block], dict[str, str]]:
    """The blocks of an installed library by their names in diagrams, and the family of each.

    A block `magnet` of the library `mylab` is `mylab.magnet`. This runs the block files.
    Raises BlockError: a file that cannot be read, a declaration that is wrong.
    """
    blocks, families = load_files(block_files(folder_of(package, place)))
    named = {name: f"{package.name}.{name}" for name in blocks}
    return (
        {named[name]: _named(block, named) for name, block in blocks.items()},
        {named[name]: family for name, family in families.items()},
    )


def package_file(package: Package, name: str, place: Location = Location()) -> Path:
    """A file of an installed library by its path there. Raises BlockError: it leads outside."""
    folder = folder_of(package, place)
    try:
        file = (folder / name).resolve()
        inside = file.is_relative_to(folder)
    except (OSError, ValueError, RuntimeError):  # a path that no file can have
        inside = False
    if not inside:
        what = f"'{package.name}:{name}' leads out of the library '{package.name}'"
        exists = subsystem_files(package)
        raise BlockError([Problem(what, place, exists, "Name a file of the library.")])
    return file


def subsystem_files(package: Package) -> tuple[str, ...]:
    """The YAML files of an installed library, as paths in it. Raises BlockError."""
    folder = folder_of(package)
    found = (file for file in folder.rglob("*") if file.suffix in SUBSYSTEMS)
    return tuple(sorted(file.relative_to(folder).as_posix() for file in found))


def packages_with(block: str) -> list[str]:
    """The installed libraries that declare a block of this name, found without running them."""
    found = []
    for package in installed_packages():
        try:
            files = block_files(folder_of(package))
        except BlockError:
            continue
        if any(block in _declared(file, file.stat().st_mtime_ns) for file in files):
            found.append(package.name)
    return list(dict.fromkeys(found))


@lru_cache(maxsize=8)
def _scanned(path: tuple[str, ...]) -> tuple[Package, ...]:
    """What the distributions on the path of Python declare; `path` says when to look again."""
    from importlib.metadata import entry_points  # imported where a diagram asks for a library

    return tuple(map(_package, entry_points(group=GROUP)))


def _package(point: EntryPoint) -> Package:
    distribution = point.dist
    assert distribution is not None, "an entry point that was found belongs to a distribution"
    beside = Path(str(distribution.locate_file(""))).resolve()
    said = distribution.metadata
    known = {key: said[key] for key in ("Name", "Version") if key in said}
    name, version = known.get("Name", "?"), known.get("Version", "?")  # a file may be damaged
    return Package(point.name, name, version, point.value, beside)


def _roots(module: str) -> list[Path]:
    """Where Python would import a package from; nothing is imported."""
    try:
        spec = find_spec(module)
    except (ImportError, ValueError):
        return []
    return [Path(root) for root in (spec and spec.submodule_search_locations) or ()]


def _missing(name: str, place: Location) -> Problem:
    problem = unknown("library", name, sorted({package.name for package in installed_packages()}))
    what = f"the library '{name}' is not installed"
    hint = (
        f"Install the package that has it: {sys.executable} -m pip install PACKAGE. "
        f"A folder of blocks is named with --library, and its types have no '{name}.' in front."
    )
    meant = problem.hint.partition("?")[0] + "? " if problem.hint else ""
    return Problem(what, place, problem.exists, meant + hint)


def _named(block: Block, named: Mapping[str, str]) -> Block:
    """The block with the names in diagrams of the effects that it imitates."""
    if block.effect is None:
        return block
    alias = tuple(named.get(name, name) for name in block.effect.alias)
    return replace(block, effect=replace(block.effect, alias=alias))


@lru_cache(maxsize=1024)
def _declared(file: Path, changed: int) -> frozenset[str]:
    """The names in the declarations of a block file, as they are written there."""
    try:
        tree = ast.parse(file.read_text(encoding="utf-8"))
    except (OSError, ValueError, SyntaxError):
        return frozenset()
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    given = [
        value
        for call in calls
        if isinstance(call.func, ast.Name | ast.Attribute)
        and (call.func.id if isinstance(call.func, ast.Name) else call.func.attr) == "Block"
        for value in (*call.args[:1], *(k.value for k in call.keywords if k.arg == "name"))
    ]
    return frozenset(str(value.value) for value in given if isinstance(value, ast.Constant))
