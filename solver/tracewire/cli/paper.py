"""`tracewire paper`: reports and figures of the papers whose systems are shipped, their table."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.options import AsJson, Debug
from tracewire.cli.paper_figures import write_figure, write_figures, write_table
from tracewire.cli.paper_report import write_report
from tracewire.errors import OptionError, Problem


def paper(
    paper: Annotated[
        str, typer.Argument(metavar="PAPER", help="a, b or c.", show_default=False)
    ] = "",
    figure: Annotated[
        str | None, typer.Option(metavar="N", help="Draw this figure of the paper.")
    ] = None,
    figures: Annotated[bool, typer.Option("--figures", help="Draw all figures.")] = False,
    full: Annotated[
        bool, typer.Option("--full", help="As finely as the paper; some take minutes.")
    ] = False,
    output: Annotated[
        str | None,
        typer.Option(
            metavar="PATH",
            help="The .png or .svg of a figure (both, named after it, unless given); "
            "the folder of all figures.",
        ),
    ] = None,
    table: Annotated[
        bool, typer.Option("--table", help="Write the page of all systems, with its pictures.")
    ] = False,
    report: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help="The report, .html (one file) or .md (its figures beside it); "
            "paper_a.html and so on unless given.",
        ),
    ] = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Reproduce a paper: measure what it states on its diagrams, or draw its figures.

    \b
    Examples:
      tracewire paper c
      tracewire paper c --figure 33
      tracewire paper b --figure 6 --full --output bifurcation.svg
      tracewire paper c --figures --output figures
    """
    if table:
        write_table(output)
    elif figures:
        write_figures(paper, output, full, as_json)
    elif figure is not None:
        write_figure(paper, figure, output, full, as_json)
    elif paper:
        write_report(paper, report, full, as_json)
    else:
        hint = "Name a paper: `tracewire paper c`, with --figure N or --figures for its figures."
        raise OptionError([Problem("nothing is asked for", hint=hint)])
