"""`tracewire data`: sets of real measurements, with the diagrams that are traced on them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tracewire.cli.options import AsJson, Debug
from tracewire.cli.output import note, print_json, print_table, print_text
from tracewire.cli.verb_group import VerbGroup

data = typer.Typer(
    help="Bring sets of real measurements, with the diagrams that are traced on them.",
    cls=VerbGroup,
    rich_markup_mode=None,
)


@data.command("list")
def list_(as_json: AsJson = False, debug: Debug = False) -> None:
    """List the sets: what they are, where they come from, their licence.

    \b
    Example:
      tracewire data list
    """
    from tracewire.data.index import SETS
    from tracewire.show import Table

    if as_json:
        sets = {
            name: {
                "title": found.title,
                "licence": found.licence,
                "files": [
                    {"address": found.address(file), "sha256": file.sha256} for file in found.files
                ],
                "made": list(found.made),
            }
            for name, found in SETS.items()
        }
        print_json({"sets": sets})
        return
    rows = tuple(
        (name, found.title, f"github.com/{found.repository}", found.licence)
        for name, found in SETS.items()
    )
    print_table(Table("", ("name", "what it is", "from", "licence"), rows))
    print_text("`tracewire data get NAME` brings a set, and the diagrams that read it.")


@data.command("get")
def get(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="A set of `data list`.", show_default=False)
    ],
    to: Annotated[
        str, typer.Option("--to", metavar="DIR", help="The folder in which NAME/ is made.")
    ] = ".",
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Bring a set into a folder of its name: diagrams, a page about it, and data/.

    The files come from their owners' repository at one commit, and are refused unless their SHA-256
    is the known one.

    \b
    Examples:
      tracewire data get multiarm_pendulum
      tracewire data get mr_damper --to measurements
    """
    from tracewire.data.sets import get_set

    home = get_set(name, to, note)
    diagrams = sorted(str(path) for path in Path(home).glob("*.yaml"))
    if as_json:
        print_json({"folder": str(home), "diagrams": diagrams})
        return
    print_text(f"{name} is in {home}/; next, for example:")
    for path in diagrams:
        print_text(f"  tracewire trace {path}")
