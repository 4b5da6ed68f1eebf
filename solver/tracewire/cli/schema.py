"""`tracewire schema`: what an editor needs to complete and check diagrams."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from tracewire.cli.options import AsJson, Debug, Libraries
from tracewire.cli.output import print_json, print_text
from tracewire.errors import OptionError

USUAL = ".tracewire/schema.json"


def schema(
    diagrams: Annotated[
        list[str] | None,
        typer.Argument(metavar="[DIAGRAM...]", help="For --modeline.", show_default=False),
    ] = None,
    output: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help=f"Write the schema to this file; with --modeline {USUAL} unless given.",
            show_default=False,
        ),
    ] = None,
    modeline: Annotated[
        bool,
        typer.Option("--modeline", help="Name the schema in the first line of these diagrams."),
    ] = False,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Write a JSON Schema of diagrams, by which editors complete, explain and check them.

    It has all keys, and all blocks with their inputs and parameters. An editor that reads it is
    VS Code with the extension YAML (redhat.vscode-yaml). What names mean it cannot know: that is
    what `tracewire check` tells.

    \b
    Examples:
      tracewire schema --modeline pendulum.yaml cart.yaml
      tracewire schema --output schema.json
      tracewire schema --library my_blocks.py --output schema.json
    """
    from tracewire.diagram import load_text, schema_of, with_modeline
    from tracewire.files import write_file, writing
    from tracewire.library import load_library

    if bool(diagrams) != modeline:
        what = "diagrams and --modeline belong together"
        raise OptionError.one(what, hint="Write: tracewire schema --modeline pendulum.yaml")
    made = schema_of(load_library(library or ()))
    target = Path(output or USUAL) if output or modeline else None
    if target is None:
        print_json(made)
        return
    files = {Path(name): load_text(Path(name)) for name in diagrams or ()}
    texts = {file: with_modeline(text, file, target) for file, text in files.items()}
    write_schema(made, target, output is None)
    written = [str(target)]
    for file, text in texts.items():
        if text != files[file]:
            with writing(file):
                write_file(file, text)
            written.append(str(file))
    if as_json:
        print_json({"written": written})
    else:
        for name in written:
            print_text(f"written: {name}")


def write_schema(made: dict[str, Any], target: Path, folder: bool) -> None:
    """Write a schema to a file, and make its folder where that is asked for. Raises OptionError."""
    from tracewire.diagram import schema_text
    from tracewire.files import write_file, writing

    with writing(target):
        if folder:
            target.parent.mkdir(exist_ok=True)
        write_file(target, schema_text(made))
