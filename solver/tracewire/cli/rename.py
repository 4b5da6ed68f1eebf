"""`tracewire rename`: another name for a part of a diagram, everywhere in its file."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries
from tracewire.cli.output import print_json, print_text


def rename(
    diagram: DiagramPath,
    old: Annotated[
        str,
        typer.Argument(
            metavar="OLD",
            help="A block, input, parameter or subsystem; SUBSYSTEM.NAME for a part of one.",
            show_default=False,
        ),
    ],
    new: Annotated[str, typer.Argument(metavar="NEW", help="Its new name.", show_default=False)],
    output: Annotated[
        str | None,
        typer.Option(
            metavar="FILE", help="Write to this file instead of the diagram's.", show_default=False
        ),
    ] = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Give a signal, a block, a parameter or a subsystem another name at each place of the file.

    It follows wires, formulas, records, presets, measured series and scenes, and leaves comments
    and texts alone. Columns of measured files keep their names. A name that is taken is refused.

    \b
    Examples:
      tracewire rename pendulum.yaml theta angle
      tracewire rename bearing.yaml journal_bearing.slip level
    """
    from tracewire.diagram import difference, read, renamed, write

    before = read(diagram, library or ())
    after = renamed(before, old, new)
    change = difference(before, after)
    written = write(after, output or diagram, overwrite=output is None)
    if as_json:
        print_json({"written": [str(written)], "difference": change})
        return
    print_text(change.rstrip())
    print_text(f"written: {written}")
