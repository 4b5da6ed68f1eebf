"""`tracewire new`: a start for a block, a diagram or a library, with comments and a test."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from string import Template
from typing import Annotated

import typer

from tracewire.cli.options import AsJson, Debug
from tracewire.cli.output import print_json, print_text
from tracewire.cli.schema import USUAL, write_schema
from tracewire.cli.verb_group import VerbGroup
from tracewire.errors import OptionError, Problem
from tracewire.files import write_file, writing
from tracewire.formula import is_name, name_hint
from tracewire.library import OWN, load_library

new = typer.Typer(
    help="Write a start for a block, a diagram or a library, with comments and a test that passes.",
    cls=VerbGroup,
    rich_markup_mode=None,
)

TEMPLATES = Path(__file__).parent / "templates"
BLOCK = {"$name.py": "block.py.txt", "test_$name.py": "block_test.py.txt"}
DIAGRAM = {"$name.yaml": "diagram.yaml.txt", "test_$name.py": "diagram_test.py.txt"}
LIBRARY = {
    "$distribution/pyproject.toml": "library/pyproject.toml.txt",
    "$distribution/README.md": "library/README.md.txt",
    "$distribution/$package/__init__.py": "library/init.py.txt",
    "$distribution/$package/springs.py": "block.py.txt",
    "$distribution/$package/masses.yaml": "library/masses.yaml.txt",
    "$distribution/example.yaml": "library/example.yaml.txt",
    "$distribution/tests/test_$name.py": "library/test.py.txt",
}
"""The files of each start, and their templates, which `string.Template` fills in."""

Name = Annotated[
    str, typer.Argument(metavar="NAME", help="Letters, digits and _.", show_default=False)
]
Folder = Annotated[
    str, typer.Option("--to", metavar="DIR", help="The folder in which it is written.")
]


@new.command("block")
def block(name: Name, to: Folder = ".", as_json: AsJson = False, debug: Debug = False) -> None:
    """Write NAME.py, the declaration of a block, and its test. Files that exist stay as they are.

    \b
    Example:
      tracewire new block hard_spring
    """
    _check_name(name, "a block", free=True)
    option = f" --library {name}.py"
    written = _write(BLOCK, Path(to), {"name": name, "type": name, "option": option})
    _tell(written, f"'tracewire blocks {name} --library {written[0]}' shows it.", as_json)


@new.command("diagram")
def diagram(name: Name, to: Folder = ".", as_json: AsJson = False, debug: Debug = False) -> None:
    """Write NAME.yaml, a diagram that runs, and its test. Files that exist stay as they are.

    The diagram names .tracewire/schema.json to editors, which is written, too.

    \b
    Example:
      tracewire new diagram rig
    """
    _check_name(name, "a diagram")
    written = [*_write(DIAGRAM, Path(to), {"name": name}), *_schema(Path(to))]
    _tell(written, f"'tracewire run {written[0]}' runs it.", as_json)


@new.command("library")
def library(name: Name, to: Folder = ".", as_json: AsJson = False, debug: Debug = False) -> None:
    """Write a library that pip installs: blocks, a subsystem, an example and tests.

    It is found by its NAME: `type: NAME.hard_spring`, `include: NAME:masses.yaml`. Files that
    exist stay as they are.

    \b
    Example:
      tracewire new library mylab
    """
    _check_name(name, "a library", free=True)
    if name == OWN or len(name) < 2:
        what = f"'{name}' cannot be the name of a library"
        hint = "tracewire has it." if name == OWN else "Use two letters or more."
        raise OptionError([Problem(what, hint=hint)])
    known = {
        "name": name,
        "distribution": f"{name.replace('_', '-')}-blocks",
        "package": f"{name}_blocks",
        # the package stands above its subpackages: they do not import it, but it is there
        "version": str(sys.modules[OWN].__version__),
    }
    spring = {"name": "hard_spring", "type": f"{name}.hard_spring", "option": ""}
    written = _write(LIBRARY, Path(to), known, {"block.py.txt": spring})
    folder = Path(to) / known["distribution"]
    written += _schema(folder)
    _tell(written, f"'python -m pip install -e {folder}' installs it; see its README.", as_json)


def _check_name(name: str, what: str, free: bool = False) -> None:
    """Refuse what cannot be a name, and where it must be `free` also the name of a block."""
    if not is_name(name):
        raise OptionError.one(f"'{name}' cannot be the name of {what}", hint=name_hint(name))
    if free and name in load_library():
        hint = "Choose another name."
        raise OptionError.one(f"tracewire has a block '{name}' already", hint=hint)


def _write(
    files: Mapping[str, str],
    folder: Path,
    known: Mapping[str, str],
    others: Mapping[str, Mapping[str, str]] | None = None,
) -> list[Path]:
    """Write the files of a start, or none of them; `others` is what single templates are told.

    Raises OptionError: one of them exists, or cannot be written.
    """
    targets = {folder / Template(path).substitute(known): files[path] for path in files}
    there = [str(target) for target in targets if target.exists() or target.is_symlink()]
    if there:
        hint = "Choose another name, or name another folder with --to."
        raise OptionError([Problem(f"'{path}' exists already", hint=hint) for path in there])
    for target, template in targets.items():
        text = Template((TEMPLATES / template).read_text(encoding="utf-8"))
        with writing(target.parent):
            target.parent.mkdir(parents=True, exist_ok=True)
        with writing(target):
            write_file(target, text.substitute((others or {}).get(template, known)))
    return [*targets]


def _schema(folder: Path) -> list[Path]:
    """Write the schema that the diagrams of a start name to an editor, unless there is one."""
    from tracewire.diagram import schema_of

    target = folder / USUAL
    if target.exists():
        return []
    write_schema(schema_of(load_library()), target, folder=True)
    return [target]


def _tell(written: list[Path], then: str, as_json: bool) -> None:
    if as_json:
        print_json({"written": [str(path) for path in written]})
    else:
        print_text("\n".join([*(f"written: {path}" for path in written), then]))
