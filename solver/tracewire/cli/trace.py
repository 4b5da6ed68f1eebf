"""`tracewire trace`: from the residual of a diagram to the effect that it lacks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries, load_model
from tracewire.cli.output import Cut, note, print_json, print_table, print_text, working
from tracewire.cli.progress import stages
from tracewire.cli.reporting import (
    Apply,
    Output,
    PatchFile,
    ReportFile,
    TableFile,
    check_home,
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


Train = Annotated[
    list[str] | None,
    typer.Option(metavar="FILE ...", help="Series to fit to, instead of those of the diagram."),
]
Gate = Annotated[
    list[str] | None,
    typer.Option(metavar="FILE ...", help="Series that decide whether an effect is accepted."),
]
Validate = Annotated[
    list[str] | None,
    typer.Option(metavar="FILE ...", help="Series that play no part before the final check."),
]


def trace(
    diagram: DiagramPath,
    train: Train = None,
    gate: Gate = None,
    validate: Validate = None,
    report: ReportFile = None,
    apply: Apply = False,
    output: Output = None,
    patch: PatchFile = None,
    table: TableFile = None,
    rtol: Annotated[float, typer.Option(help="The relative tolerance of runs.")] = 1e-6,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Fit a diagram, find what it lacks, and check that on data that played no part.

    The verdict is `null` (nothing is missing), `effect` (named, with its place and coefficient) or
    `unexplained`. The exit code is 0 for each of them. Ctrl-C ends a trace with what it has found
    by then, which is told as ever, with exit code 130.

    \b
    Examples:
      tracewire trace pendulum.yaml
      tracewire trace pendulum.yaml --report trace.html
      tracewire trace pendulum.yaml --apply
      tracewire trace pendulum.yaml --output with_friction.yaml --json
      tracewire trace pendulum.yaml --train a.csv b.csv --gate c.csv --validate d.csv

    Files that are named here take the place of all series of the diagram, whose columns they have.
    Without series in the diagram, columns are found by their names: t or time, signals, inputs.
    """
    from tracewire.diagram import with_series_of
    from tracewire.trace import trace as trace_model

    check_targets(report, output, patch, table)
    model = load_model(diagram, library)
    own = model.diagram
    check_home(own, output)
    model = _with_files(model, {"train": train, "gate": gate, "validate": validate})
    with working("tracing") as tell:

        def show(text: str) -> None:
            tell(text)
            note(text)

        found = trace_model(model, rtol=rtol, progress=stages(show))
    written = write_report(found, report)

    tables = write_table(found, table)
    empirical = None
    if table is not None and tables:
        home = own.file if output is None or output.endswith(".patch") else Path(output)
        empirical = with_table(model, found, table, home.parent)

    def edited() -> Diagram:
        new = empirical or found.apply()
        return with_series_of(new, own, Path(output) if output else None)

    written += tables + store(own, edited, apply, output, patch)
    if as_json:
        print_json(found.as_json() | {"written": written})
    else:
        _print(found, patch_of(own, edited()), written)
    if found.interrupted:
        raise Cut


def _print(found: Found, change: str, written: list[str]) -> None:
    """The short answer, the same in plain words, the steps, tables, and the change."""
    from tracewire.show.trace_tables import trace_tables
    from tracewire.show.trace_text import answer_lines, step_lines

    print_text("\n".join(answer_lines(found)))
    print_text(f"\n{found.paragraph}\n")
    print_text("\n".join(step_lines(found)))
    for table in trace_tables(found):
        print_table(table)
    for text in found.words:
        print_text(f"note: {text}")
    if change:
        print_text(f"the change of the diagram:\n{change.rstrip()}")
    for path in written:
        print_text(f"written: {path}")


def _with_files(model: Model, files: dict[str, list[str] | None]) -> Model:
    """The model with files as its measured series, where any are given."""
    given = {use: paths for use, paths in files.items() if paths}
    if not given:
        return model
    from tracewire.compile import compile
    from tracewire.fit import series_from_files

    diagram, remarks = series_from_files(model, given)
    for remark in remarks:
        note(f"remark: {remark}")
    return compile(diagram)
