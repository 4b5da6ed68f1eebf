"""`tracewire trace`: from the residual of a diagram to the effect that it lacks."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.delivery import Targets, deliver
from tracewire.cli.executors import ExecutorAddress, executor_at
from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries, load_model
from tracewire.cli.output import note, working
from tracewire.cli.progress import stages
from tracewire.cli.reporting import check_home
from tracewire.options import options_of

if TYPE_CHECKING:
    from tracewire.compile import Model
    from tracewire.trace import TraceOptions


@dataclass(frozen=True)
class SeriesFiles:
    """Files in place of the measured series of the diagram."""

    train: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE ...", help="Series to fit to, instead of those of the diagram."),
    ] = None
    gate: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE ...", help="Series that decide whether an effect is accepted."),
    ] = None
    validate: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE ...", help="Series that play no part before the final check."),
    ] = None


@dataclass(frozen=True)
class Asked:
    """What a trace is asked for: fields of `tracewire.trace.TraceOptions`, whose defaults hold."""

    only: Annotated[
        list[str] | None,
        typer.Option(
            metavar="PLACE ...",
            help="Try effects only at these places: a sum, `drive.NAME` or `sensor.SIGNAL`.",
            show_default=False,
        ),
    ] = None
    without: Annotated[
        list[str] | None,
        typer.Option(
            metavar="EFFECT ...",
            help="Do not try these effects: `coulomb`, or at one place `'coulomb @ force'`.",
            show_default=False,
        ),
    ] = None
    effects: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            help="How many effects are added at most; without it 3.",
            show_default=False,
        ),
    ] = None
    horizon: Annotated[
        float | None,
        typer.Option(
            metavar="SECONDS",
            help="How far models must predict: the longer of the two horizons on which they are "
            "compared. Without it: five periods of the slowest motion.",
            show_default=False,
        ),
    ] = None
    budget: Annotated[
        float | None,
        typer.Option(
            metavar="SECONDS",
            help="End the search after this time with what it has found by then.",
            show_default=False,
        ),
    ] = None

    @property
    def options(self) -> TraceOptions:
        """These, as `trace` takes them."""
        from tracewire.trace import TraceOptions

        every = {field.name: getattr(self, field.name) for field in fields(self)}
        given = {name: value for name, value in every.items() if value is not None}
        return options_of(TraceOptions, given, "a trace")


def trace(
    diagram: DiagramPath,
    *,
    files: SeriesFiles,
    asked: Asked,
    targets: Targets,
    rtol: Annotated[float, typer.Option(help="The relative tolerance of runs.")] = 1e-6,
    executor: ExecutorAddress = "",
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
    from tracewire.trace import check_options
    from tracewire.trace import trace as trace_model

    targets.check()
    options = asked.options
    model = load_model(diagram, library)
    own = model.diagram
    check_home(own, targets.output, targets.apply)
    model = _with_files(model, {use: getattr(files, use) for use in ("train", "gate", "validate")})
    check_options(options, model)
    with executor_at(executor) as pool, working("tracing") as tell:

        def show(text: str) -> None:
            tell(text)
            note(text)

        found = trace_model(model, options=options, rtol=rtol, executor=pool, progress=stages(show))
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
