"""`tracewire draw`: the picture of a diagram."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries
from tracewire.cli.output import check_target, print_json, print_problems, print_text, working
from tracewire.errors import DiagramError, TracewireError

ENDINGS = (".svg", ".png", ".mmd")


def draw(
    diagram: DiagramPath,
    output: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help="Write the picture to .svg, .png or .mmd (Mermaid); NAME.svg in this folder "
            "unless given.",
            show_default=False,
        ),
    ] = None,
    depth: Annotated[int, typer.Option(metavar="N", help="Open so many levels of subsystems.")] = 0,
    names: Annotated[
        bool, typer.Option("--names", help="The name of each signal on its wire.")
    ] = False,
    units: Annotated[
        bool, typer.Option("--units", help="The unit of each signal on its wire.")
    ] = False,
    measured: Annotated[
        bool, typer.Option("--measured", help="The names of measured signals in blue.")
    ] = False,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Draw a diagram: blocks from left to right, feedback from right to left.

    A tooltip in the SVG tells the parameters of each block. A diagram with mistakes is drawn as far
    as it can be read, with the mistakes in red; the exit code is 2 then.

    \b
    Examples:
      tracewire draw pendulum.yaml
      tracewire draw pendulum.yaml --depth 1 --units --output pendulum.png
      tracewire draw pendulum.yaml --output pendulum.mmd
    """
    target = output or f"{Path(diagram).stem}.svg"
    check_target(target, ENDINGS, "picture")
    with working(f"drawing {diagram}"):
        from tracewire.elk import start

        start()
        from tracewire.compile import compile, unit_problems
        from tracewire.diagram import read_readable
        from tracewire.draw import draw as picture_of

        read, problems = read_readable(diagram, library or ())
        if not problems:
            try:
                problems = tuple(unit_problems(compile(read).flat))
            except TracewireError as error:
                problems = tuple(error.problems)
        picture = picture_of(
            read, depth, names=names, units=units, measured=measured, problems=problems
        )
        picture.write(target)
    if as_json:
        shown = {node.id: node.type for node in picture.graph.nodes}
        print_json({"written": [target], "blocks": shown, "problems": [str(p) for p in problems]})
    else:
        print_text(f"written: {target}")
    if problems:
        print_problems(problems)
        raise typer.Exit(DiagramError.exit_code)
