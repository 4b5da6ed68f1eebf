"""`tracewire trace`: from the residual of a diagram to the effect that it lacks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries, load_model
from tracewire.cli.output import check_target, note, working
from tracewire.cli.progress import stages
from tracewire.cli.reporting import (
    Apply,
    Output,
    PatchFile,
    ReportFile,
    TableFile,
    check_home,
    check_targets,
)

if TYPE_CHECKING:
    from tracewire.compile import Model

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


Only = Annotated[
    list[str] | None,
    typer.Option(
        metavar="PLACE ...",
        help="Try effects only at these places: a sum, `drive.NAME` or `sensor.SIGNAL`.",
        show_default=False,
    ),
]
Without = Annotated[
    list[str] | None,
    typer.Option(
        metavar="EFFECT ...",
        help="Do not try these effects: `coulomb`, or at one place `'coulomb @ force'`.",
        show_default=False,
    ),
]
Effects = Annotated[
    int | None,
    typer.Option(
        metavar="N", help="How many effects are added at most; without it 3.", show_default=False
    ),
]
Horizon = Annotated[
    float | None,
    typer.Option(
        metavar="SECONDS",
        help="How far models must predict: the longer of the two horizons on which they are "
        "compared. Without it: five periods of the slowest motion.",
        show_default=False,
    ),
]
Budget = Annotated[
    float | None,
    typer.Option(
        metavar="SECONDS",
        help="End the search after this time with what it has found by then.",
        show_default=False,
    ),
]
Save = Annotated[
    str | None,
    typer.Option(
        metavar="FILE",
        help="Save the result to this .json, for `tracewire report FILE` and tw.load(FILE).",
    ),
]


def trace(
    diagram: DiagramPath,
    train: Train = None,
    gate: Gate = None,
    validate: Validate = None,
    only: Only = None,
    without: Without = None,
    effects: Effects = None,
    horizon: Horizon = None,
    budget: Budget = None,
    report: ReportFile = None,
    save: Save = None,
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
    `unexplained`. The exit code is 0 for each of them. Ctrl-C prints and writes the best result so
    far, with exit code 130. The result is printed, saved and applied before the report is drawn.

    \b
    Examples:
      tracewire trace pendulum.yaml
      tracewire trace pendulum.yaml --report trace.html --save trace.json
      tracewire trace pendulum.yaml --apply
      tracewire trace pendulum.yaml --output with_friction.yaml --json
      tracewire trace cart.yaml --only force drive.F --without cogging --effects 2 --budget 60
      tracewire trace pendulum.yaml --train a.csv b.csv --gate c.csv --validate d.csv

    Files that are named here take the place of all series of the diagram, whose columns they have.
    Without series in the diagram, columns are found by their names: t or time, signals, inputs.
    """
    from tracewire.cli.delivery import Targets, deliver
    from tracewire.trace import TraceOptions, check_options
    from tracewire.trace import trace as trace_model

    check_targets(report, output, patch, table)
    check_target(save, (".json",), "saved trace")
    asked: dict[str, Any] = {"effects": effects, "horizon": horizon, "budget": budget}
    given = {name: value for name, value in asked.items() if value is not None}
    options = TraceOptions(only=tuple(only or ()), without=tuple(without or ()), **given)
    model = load_model(diagram, library)
    own = model.diagram
    check_home(own, output)
    model = _with_files(model, {"train": train, "gate": gate, "validate": validate})
    check_options(options, model)
    with working("tracing") as tell:

        def show(text: str) -> None:
            tell(text)
            note(text)

        found = trace_model(model, options=options, rtol=rtol, progress=stages(show))
    targets = Targets(report, save, apply, output, patch, table)
    deliver(found, model, own, targets, as_json)


def _with_files(model: Model, files: dict[str, list[str] | None]) -> Model:
    """The model with files as its measured series, where any are given."""
    given = {use: paths for use, paths in files.items() if paths}
    if not given:
        return model
    from tracewire.compile import compile
    from tracewire.residual import series_from_files

    diagram, remarks = series_from_files(model, given)
    for remark in remarks:
        note(f"remark: {remark}")
    return compile(diagram)
