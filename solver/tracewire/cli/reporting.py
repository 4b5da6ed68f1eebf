"""What `fit` and `trace` write: a report, and the edited diagram."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.output import check_target, working, writing

if TYPE_CHECKING:
    from tracewire.diagram import Diagram
    from tracewire.fit import Fit, Profile
    from tracewire.trace import Found

ReportFile = Annotated[
    str | None,
    typer.Option(
        metavar="FILE", help="Write a report to .html (one file) or .md (its figures beside it)."
    ),
]
Apply = Annotated[bool, typer.Option("--apply", help="Edit the diagram's file; comments are kept.")]
Output = Annotated[
    str | None,
    typer.Option(
        metavar="FILE", help="Write the edited diagram to this .yaml, or the change to this .patch."
    ),
]


def check_targets(report: str | None, output: str | None) -> None:
    """Refuse, before the work, files that could not be written after it."""
    check_target(report, (".md", ".html"), "report")
    check_target(output, (".yaml", ".yml", ".patch"), "edited diagram")


def check_home(diagram: Diagram, output: str | None) -> None:
    """Refuse, before the work, a folder from which the diagram's relative files are not found."""
    if output is not None and not output.endswith(".patch"):
        from tracewire.diagram import read_text

        read_text(diagram.text, Path(output), library=diagram.library)


def write_report(
    subject: Fit | Found, path: str | None, profiles: Sequence[Profile] = ()
) -> list[str]:
    """Write a report where one is asked for; the paths that were written."""
    if path is None:
        return []
    with working("drawing"):
        from tracewire.show import report

        report(subject, profiles).write(path)
    return [path]


def store(
    diagram: Diagram, edited: Callable[[], Diagram], apply: bool, output: str | None
) -> list[str]:
    """Write an edited diagram, or its patch, as asked; the paths that were written."""
    if output is None and not apply:
        return []
    from tracewire.diagram import difference

    new = edited()
    written = []
    if output is not None and output.endswith(".patch"):
        with writing(output):
            Path(output).write_text(difference(diagram, new), encoding="utf-8")
        written.append(output)
    elif output is not None:
        written.append(str(new.write(output, overwrite=True)))
    if apply:
        written.append(str(new.write(diagram.file, overwrite=True)))
    return written
