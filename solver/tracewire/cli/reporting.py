"""What `run`, `fit` and `trace` write: a report, and the edited diagram."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.output import check_target, note, print_problems, working
from tracewire.errors import FitError, OptionError, Problem, TracewireError
from tracewire.files import write_file, writing

if TYPE_CHECKING:
    from tracewire.compile import Model
    from tracewire.diagram import Diagram
    from tracewire.fit import Fit, Profile
    from tracewire.residual import Measured
    from tracewire.solve import Run
    from tracewire.trace import Found

ReportFile = Annotated[
    str | None,
    typer.Option(
        metavar="FILE", help="Write a report to .html (one file) or .md (its figures beside it)."
    ),
]
Apply = Annotated[bool, typer.Option("--apply", help="Edit the diagram's file; comments are kept.")]
PatchFile = Annotated[
    str | None,
    typer.Option(
        "--patch",
        metavar="FILE",
        help="Write the change of the diagram, for `git apply` or `patch -p1` in this folder.",
    ),
]
TableFile = Annotated[
    str | None,
    typer.Option(
        "--table",
        metavar="FILE",
        help="Write what is missing, where nothing explains it, to this .csv for a `table` block; "
        "an edited diagram then has that block.",
    ),
]
Output = Annotated[
    str | None,
    typer.Option(
        metavar="FILE", help="Write the edited diagram to this .yaml, or the change to this .patch."
    ),
]


class WriteAttempts:
    """Writes the files of a result one by one: one that fails does not keep the others from it."""

    def __init__(self) -> None:
        self.written: list[str] = []
        self.failed: list[TracewireError] = []

    def __call__(self, step: Callable[[], list[str]]) -> None:
        """Take a step, which gives the paths that it wrote; what goes wrong is kept for the end."""
        try:
            self.written += step()
        except TracewireError as error:
            self.failed.append(error)
        except Exception as error:  # the result is there: what comes after cannot undo it
            what = f"internal error ({error!r})"
            hint = "Please report it; --debug shows the traceback."
            problem = FitError.one(what, hint=hint)
            problem.__cause__ = error
            self.failed.append(problem)

    @property
    def problems(self) -> list[Problem]:
        """What went wrong so far."""
        return [problem for error in self.failed for problem in error.problems]

    @property
    def not_written(self) -> dict[str, list[str]]:
        """What went wrong so far, for JSON."""
        wrong = [problem.what for problem in self.problems]
        return {"not_written": wrong} if wrong else {}

    def finish(self, as_json: bool) -> None:
        """Raise what went wrong as one error; after JSON tell it on stderr alone."""
        if not self.failed:
            return
        if not as_json:
            raise type(self.failed[0])(self.problems) from self.failed[0].__cause__
        print_problems(self.problems)
        raise typer.Exit(self.failed[0].exit_code)


def check_targets(
    report: str | None, output: str | None, patch: str | None = None, table: str | None = None
) -> None:
    """Refuse, before the work, files that could not be written after it."""
    check_target(report, (".md", ".html"), "report")
    check_target(output, (".yaml", ".yml", ".patch"), "edited diagram")
    check_target(patch, (".patch", ".diff"), "patch")
    check_target(table, (".csv",), "table")


def check_home(diagram: Diagram, output: str | None, apply: bool) -> None:
    """Refuse, before the work, a folder from which files of the diagram are not found, and a change
    of a diagram that has no file. Raises OptionError."""
    from tracewire.diagram import STDIN

    if apply and diagram.file == STDIN:
        what = "--apply changes the file of the diagram, and this one comes from stdin"
        raise OptionError.one(what, hint="Write it to another file: --output new.yaml.")
    if output is not None and not output.endswith(".patch"):
        from tracewire.diagram import text_at

        text_at(diagram, Path(output))


def write_report(
    subject: Run | Fit | Found,
    path: str | None,
    profiles: Sequence[Profile] = (),
    measured: Measured | None = None,
) -> list[str]:
    """Write a report where one is asked for; the paths that were written.

    A figure that cannot be drawn is told on stderr, and the report says so where it would be.
    """
    if path is None:
        return []
    with working("drawing"):
        from tracewire.show import report

        report(subject, profiles, measured).write(path, note)
    return [path]


def write_table(found: Found, path: str | None) -> list[str]:
    """Write what is missing as a table where that is asked for; the paths that were written."""
    if path is None:
        return []
    if found.missing is None:
        note(f"nothing is missing that a table could hold: '{path}' was not written")
        return []
    from tracewire.trace.missing.table import missing_table

    try:
        text = missing_table(found.missing)
    except OptionError as error:
        note(f"'{path}' was not written: {error.problems[0]}")
        return []
    with writing(path):
        write_file(path, text)
    return [path]


def with_table(model: Model, found: Found, path: str, folder: Path) -> Diagram | None:
    """The diagram, fitted as it is, with a `table` block that reads what is missing from a file.

    `folder` is that of the diagram that will name the file. None, and a note, where a block cannot
    do that.
    """
    from tracewire.diagram import SetValues, patch
    from tracewire.trace.candidates.places import find_places
    from tracewire.trace.missing.table import table_block

    missing = found.missing
    assert missing is not None
    places = {place.name: place for place in find_places(model)}
    file = Path(os.path.relpath(path, folder)).as_posix()
    try:
        table = table_block(found.original, places[missing.place], missing, file)
        return patch(found.original, [SetValues(found.declared), table])
    except OptionError as error:
        note(f"the diagram gets no table: {error.problems[0]}")
        return None


def patch_of(old: Diagram, new: Diagram) -> str:
    """The change of a diagram as a patch of its file, named from the current folder on."""
    from tracewire.diagram import difference

    lines = difference(old, new).splitlines(keepends=True)
    if not lines:
        return ""
    path = os.path.relpath(old.file)
    name = old.file.name if path.startswith("..") else Path(path).as_posix()
    return "".join((f"--- a/{name}\n", f"+++ b/{name}\n", *lines[2:]))


def store(
    diagram: Diagram,
    edited: Callable[[], Diagram],
    apply: bool,
    output: str | None,
    patch: str | None = None,
) -> list[str]:
    """Write an edited diagram, or its patch, as asked; the paths that were written."""
    from tracewire.diagram import write

    if output is None and patch is None and not apply:
        return []
    new = edited()
    if output is not None and not output.endswith(".patch"):
        written = [str(write(new, output, overwrite=True))]
        patches = [patch]
    else:
        written = []
        patches = [output, patch]
    for path in patches:
        if path is not None:
            with writing(path):
                write_file(path, patch_of(diagram, new))
            written.append(path)
    if apply:
        written.append(str(write(new, diagram.file, overwrite=True)))
    return written
