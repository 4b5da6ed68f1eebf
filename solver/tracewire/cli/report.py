"""`tracewire report`: a saved trace once more, as text, data or a document."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.options import AsJson, Debug, Libraries
from tracewire.cli.output import check_target, print_json, print_parts, print_text
from tracewire.cli.reporting import ReportFile, write_report


def report(
    saved: Annotated[
        str,
        typer.Argument(
            metavar="SAVED", help="A file of `tracewire trace --save`.", show_default=False
        ),
    ],
    report: ReportFile = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Print a saved trace again, or write its report, without tracing again.

    \b
    Examples:
      tracewire report trace.json
      tracewire report trace.json --report trace.html
    """
    from tracewire.show import present
    from tracewire.trace import load

    check_target(report, (".md", ".html"), "report")
    found = load(saved, library or ())
    if as_json:
        print_json(found.json() | {"written": [report] if report else []})
    elif report is None:
        print_parts(present(found).parts)
    for path in write_report(found, report):
        if not as_json:
            print_text(f"written: {path}")
