"""`tracewire blocks`: the blocks that a diagram may use."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.options import AsJson, Debug, Libraries
from tracewire.cli.output import print_json, print_text


def blocks(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="[NAME]",
            help="A block, or its name in Simulink, Modelica or Xcos.",
            show_default=False,
        ),
    ] = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """List the blocks, or describe one: ports, parameters, formulas, source.

    \b
    Examples:
      tracewire blocks
      tracewire blocks dry_friction
      tracewire blocks INTEGRAL_m
    """
    from tracewire.library import describe, describe_json, load_library, palette

    found = load_library(library or ())
    if as_json and name is None:
        print_json({"blocks": [describe_json(found, block) for block in found]})
    elif as_json and name is not None:
        print_json(describe_json(found, name))
    else:
        print_text(palette(found) if name is None else describe(found, name))
