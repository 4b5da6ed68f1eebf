"""`tracewire blocks`: the blocks that a diagram may use, and the libraries that are installed."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.options import AsJson, Debug, Libraries
from tracewire.cli.output import check_target, note, print_json, print_text, working
from tracewire.cli.reporting import ReportFile
from tracewire.errors import BlockError, OptionError

if TYPE_CHECKING:
    from tracewire.diagram import Diagram
    from tracewire.library import Library, Package


def blocks(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="[NAME]",
            help="A block, or its name in Simulink, Modelica or Xcos; or an installed library.",
            show_default=False,
        ),
    ] = None,
    effects: Annotated[
        bool, typer.Option("--effects", help="List the effects that a trace tries instead.")
    ] = False,
    report: ReportFile = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """List the blocks of tracewire or of an installed library, or describe one block.

    What is told of a block is its ports, parameters, formulas and source. A report has that of
    all blocks, and the pictures of the subsystems of a library.

    \b
    Examples:
      tracewire blocks
      tracewire blocks --effects
      tracewire blocks dry_friction
      tracewire blocks INTEGRAL_m
      tracewire blocks tracewire --report blocks.html
    """
    check_target(report, (".md", ".html"), "report")
    if effects:
        _tell_effects(name, report, library or (), as_json)
        return
    found = _found(name, library or ())
    written = {} if report is None else {"written": [_write(report, found)]}
    if as_json:
        print_json(_json(found) | written)
    else:
        print_text(_text(found) if report is None else f"written: {report}")


def _tell_effects(
    name: str | None, report: str | None, libraries: Sequence[str], as_json: bool
) -> None:
    """Print the effects that a trace tries. Raises OptionError: what goes not with these."""
    from tracewire.library import effect_rows, effect_table, load_library

    if name is not None or report is not None:
        what = f"--effects lists all effects, and {name or f'--report {report}'} is of blocks"
        raise OptionError.one(what, hint="Give one of the two.")
    known = load_library(libraries)
    keys = ("place", "effect", "what")
    if as_json:
        rows = [dict(zip(keys, row, strict=True)) for row in effect_rows(known)]
        print_json({"effects": rows})
    else:
        print_text(effect_table(known))


@dataclass(frozen=True)
class _Found:
    """What is told: the blocks of a library, or `block` alone.

    `package` is the installed library that was named, `subsystems` are the names of those in its
    files; without one `others` are the libraries that can be named.
    """

    library: Library
    block: str = ""
    package: Package | None = None
    subsystems: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    others: Sequence[Package] = ()

    @property
    def title(self) -> str:
        return "" if self.package is None else f"library {self.package.name} of {self.package}"


def _found(name: str | None, libraries: Sequence[str]) -> _Found:
    """What a name on the command line means. Raises BlockError: a library is wrong or missing."""
    from tracewire.library import (
        OWN,
        Library,
        find_package,
        find_synonym,
        installed_packages,
        load_library,
        package_blocks,
        sensor_effect,
    )

    known = load_library(libraries)
    packages = [find_package(OWN), *installed_packages()]
    if name is None:
        return _Found(known, others=packages)
    library, dot, _ = name.partition(".")
    if name in known or (not dot and name not in {package.name for package in packages}):
        found = name in known or sensor_effect(name) or find_synonym(name, [*known])
        if not found:
            _refuse_of_others(name)
        return _Found(known, name)
    package = find_package(library)
    inside = known if library == OWN else Library(*package_blocks(package))
    if dot:
        return _Found(inside, name)
    from tracewire.diagram import package_subsystems

    return _Found(inside, "", package, package_subsystems(package))


def _refuse_of_others(name: str) -> None:
    """Say which installed library has a block or subsystem of this name. Raises BlockError."""
    from tracewire.diagram import who_has

    if name == "effects":
        hint = "'tracewire blocks --effects' lists the effects that a trace tries."
        raise BlockError.one("'effects' is no block", hint=hint)
    if hint := who_has(name):
        raise BlockError.one(f"'{name}' is no block of tracewire", hint=hint)


def _json(found: _Found) -> dict[str, object]:
    """What was found, for programs."""
    from tracewire.library import describe_json

    if found.block:
        return describe_json(found.library, found.block)
    blocks = [describe_json(found.library, block) for block in found.library]
    return {"blocks": blocks, **_more_json(found)}


def _text(found: _Found) -> str:
    """What was found, to be read."""
    from tracewire.library import describe, palette

    if found.block:
        return describe(found.library, found.block)
    parts = (found.title, palette(found.library), _more_text(found))
    return "\n\n".join(part for part in parts if part)


def _more_json(found: _Found) -> dict[str, object]:
    def told(package: Package) -> dict[str, object]:
        names = {"library": package.name, "distribution": package.distribution}
        return {**names, "version": package.version}

    if found.package is None:
        return {"libraries": [told(package) for package in found.others]}
    return {**told(found.package), "subsystems": found.subsystems}


def _more_text(found: _Found) -> str:
    """The subsystems of the library that was named; without one the libraries there are, and the
    effects that a trace tries."""
    if found.package is None:
        libraries = {package.name: str(package) for package in found.others}
        listed = _listed("libraries: 'tracewire blocks NAME' lists one", libraries)
        return f"{_effects_text(found.library)}\n\n{listed}"
    named = found.subsystems.items()
    rows = {f"include: {found.package.name}:{file}": ", ".join(names) for file, names in named}
    return _listed("subsystems", rows)


def _effects_text(library: Library) -> str:
    """The names of the effects that a trace tries, by the kind of place."""
    from tracewire.library import effect_rows

    names: dict[str, list[str]] = {}
    for place, effect, _ in effect_rows(library):
        names.setdefault(place, []).append(effect)
    rows = {place: ", ".join(some) for place, some in names.items()}
    return _listed("effects that a trace tries; --effects says what each is", rows)


def _listed(head: str, rows: Mapping[str, str]) -> str:
    """Names and what they are, one on a line; '' where there are none."""
    width = max(map(len, rows), default=0)
    lines = [f"  {name:<{width}}  {what}" for name, what in rows.items()]
    return "\n".join([head, *lines]) if lines else ""


def _write(report: str, found: _Found) -> str:
    """Write the page of what was found; the path of it."""
    from tracewire.library import Library, describe_json, sensor_effect
    from tracewire.show import library_report

    library, title = found.library, found.title or "The blocks of tracewire"
    if found.block not in library and sensor_effect(found.block):
        what = f"'{found.block}' is an effect of a sensor, and a report is of blocks"
        raise OptionError.one(what, hint="Leave --report out, or give --json.")
    if found.block:
        title = str(describe_json(library, found.block)["name"])  # by its name here
        library = Library({title: library[title]}, library.families)
    with working(f"writing {report}"):
        page = library_report(title, library, _read_subsystems(found))
        return str(page.write(report, note))


def _read_subsystems(found: _Found) -> dict[tuple[str, str], Diagram]:
    """The subsystems of a package by what a diagram includes and the name there."""
    from tracewire.diagram import read_text

    read: dict[tuple[str, str], Diagram] = {}
    for file, names in found.subsystems.items():
        wanted = f"{found.package and found.package.name}:{file}"
        diagram = read_text(f"include: {json.dumps(wanted)}\nblocks: {{}}")
        read |= {(wanted, name): diagram.subsystems[name] for name in names}
    return read
