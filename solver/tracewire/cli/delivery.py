"""What becomes of a trace: it is printed, saved and applied before any figure is drawn."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.output import Cut, check_target, flush, print_json, print_parts, print_text
from tracewire.cli.reporting import (
    Apply,
    Output,
    PatchFile,
    ReportFile,
    TableFile,
    WriteAttempts,
    check_targets,
    patch_of,
    store,
    with_table,
    write_report,
    write_table,
)

if TYPE_CHECKING:
    from tracewire.compile import Model
    from tracewire.diagram import Diagram
    from tracewire.trace import Found


@dataclass(frozen=True)
class Targets:
    """The files that a trace is to write; None: that one is not wanted."""

    report: ReportFile = None
    save: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help="Save the result to this .json, for `tracewire report FILE` and tw.load(FILE).",
        ),
    ] = None
    apply: Apply = False
    approximation: Annotated[
        bool,
        typer.Option(
            "--approximation",
            help="Write what only approximates, too, where the verdict is `unexplained`.",
        ),
    ] = False
    output: Output = None
    patch: PatchFile = None
    table: TableFile = None

    def check(self) -> None:
        """Refuse, before the work, files that could not be written after it. Raises OptionError."""
        check_targets(self.report, self.output, self.patch, self.table)
        check_target(self.save, (".json",), "saved trace")


def deliver(found: Found, model: Model, own: Diagram, targets: Targets, as_json: bool) -> None:
    """Print a trace, save it, write the edited diagram, and only then draw the report.

    `own` is the diagram as its file has it. A file that cannot be written does not keep the others
    from being written. Raises TracewireError for those, after all is done, and Cut where the trace
    was interrupted.
    """
    attempt = WriteAttempts()
    if not as_json:
        from tracewire.show import present

        print_parts(present(found).parts)
        flush()
    attempt(lambda: _save(found, targets.save))
    attempt(lambda: _edit(found, model, own, targets, quiet=as_json))
    if as_json:
        planned = [*attempt.written, *([targets.report] if targets.report else [])]
        data = found.json() | {"written": planned}
        print_json(data | attempt.not_written)
    else:
        for path in attempt.written:
            print_text(f"written: {path}")
    flush()
    attempt(lambda: write_report(found, targets.report))
    if not as_json and targets.report in attempt.written:
        print_text(f"written: {targets.report}")
    attempt.finish(as_json)
    if found.interrupted:
        raise Cut


def _save(found: Found, path: str | None) -> list[str]:
    from tracewire.trace import save

    return [] if path is None else [str(save(found, path))]


def _edit(found: Found, model: Model, own: Diagram, targets: Targets, *, quiet: bool) -> list[str]:
    """Write the table and the edited diagram, and print the change unless `quiet`."""
    from tracewire.diagram import with_series_of

    output, table = targets.output, targets.table
    written = write_table(found, table)
    empirical = None
    if table is not None and written:
        home = own.file if output is None or output.endswith(".patch") else Path(output)
        empirical = with_table(model, found, table, home.parent)

    def edited() -> Diagram:
        chosen = [str(effect) for effect in found.effects] if targets.approximation else None
        new = empirical or found.apply(effects=chosen)
        if model.diagram.measured == own.measured:  # no files took the place of the own series
            return new
        return with_series_of(new, own, Path(output) if output else None)

    change = "" if quiet else patch_of(own, edited())
    if change:
        print_text(f"the change of the diagram:\n{change.rstrip()}")
    elif found.effects and not quiet:
        print_text("the diagram stays as it is: --approximation writes what only approximates")
    return written + store(own, edited, targets.apply, output, targets.patch)
