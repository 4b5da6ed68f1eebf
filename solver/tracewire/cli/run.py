"""`tracewire run`: simulate a diagram."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries, load_model
from tracewire.cli.output import (
    check_target,
    note,
    print_json,
    print_table,
    print_text,
    telling,
    working,
)
from tracewire.cli.values import parameter_values_of, start_values_of
from tracewire.errors import OptionError, Problem, unknown
from tracewire.files import writing

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from tracewire.compile import Model
    from tracewire.solve import Interrupted

OUTPUTS = (".csv", ".npz")
FIGURES = (".png", ".svg", ".pdf")

_Inputs = dict[str, tuple["ArrayLike", "ArrayLike"]]
_Series = tuple[_Inputs, dict[str, float], str, tuple[float, float] | None, dict[str, float]]


def run(
    diagram: DiagramPath,
    preset: Annotated[str, typer.Option(help="A preset of the diagram.", metavar="NAME")] = "",
    values: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="NAME=VALUE",
            help="A parameter, as in k=2.5 or 'phi=13.6 deg'; a number without unit is in the unit "
            "that the diagram's file gives it. Repeatable.",
            show_default=False,
        ),
    ] = None,
    start: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE",
            help="The start value of a state; without unit in SI. Repeatable.",
            show_default=False,
        ),
    ] = None,
    span: Annotated[
        tuple[float, float] | None, typer.Option(metavar="FROM TO", help="From and to, in s.")
    ] = None,
    every: Annotated[
        float | None, typer.Option(metavar="DT", help="The time between samples, in s.")
    ] = None,
    record: Annotated[
        list[str] | None,
        typer.Option(metavar="SIGNAL", help="A further signal to record. Repeatable."),
    ] = None,
    series: Annotated[
        str,
        typer.Option(
            metavar="NAME", help="Run as this measured series: its inputs, start, values and time."
        ),
    ] = "",
    method: Annotated[
        str, typer.Option(help="auto, dormand_prince, dop853, rosenbrock or rk4.")
    ] = "auto",
    rtol: Annotated[float, typer.Option(help="The relative tolerance.")] = 1e-6,
    atol: Annotated[
        float | None, typer.Option(help="The absolute tolerance; rtol/1000 unless given.")
    ] = None,
    events: Annotated[bool, typer.Option("--events", help="Print the log of events.")] = False,
    output: Annotated[
        str | None, typer.Option(metavar="FILE", help="Write the samples to .csv or .npz.")
    ] = None,
    figure: Annotated[
        str | None, typer.Option(metavar="FILE", help="Draw the run to .png, .svg or .pdf.")
    ] = None,
    samples: Annotated[
        bool, typer.Option("--samples", help="With --json: print the samples, too.")
    ] = False,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Simulate a diagram and print how each recorded signal went.

    \b
    Examples:
      tracewire run pendulum.yaml --preset as_printed --span 0 4
      tracewire run pendulum.yaml --set "phi=13.6 deg" --figure swing.png

    Ctrl-C keeps the run up to there: in the file of --output, or in DIAGRAM.interrupted.npz in this
    folder.
    """
    if samples and not as_json:
        what = "--samples prints samples as JSON only"
        hint = "Add --json, or write them to a file with --output samples.csv."
        raise OptionError([Problem(what, hint=hint)])
    check_target(output, OUTPUTS, "output")
    check_target(figure, FIGURES, "figure")
    model = load_model(diagram, library, record)
    parameters = parameter_values_of(model, values or ())
    starts = start_values_of(model, start or ())
    if every is not None:
        from tracewire.formula import Number

        model = replace(model, flat=replace(model.flat, every=Number(every)))
    with working(f"simulating {diagram}") as show:
        from tracewire.solve import Interrupted, simulate

        inputs, series_start, series_preset, series_span, own = _series(model, series)
        try:
            result = simulate(
                model,
                parameters=own | parameters,
                start=series_start | starts,
                span=span or series_span,
                method=method,
                rtol=rtol,
                atol=atol,
                preset=preset or series_preset,
                inputs=inputs,
                progress=telling(f"simulating {diagram}", show),
            )
        except Interrupted as error:
            raise _kept(error, output or f"{Path(diagram).stem}.interrupted.npz") from error
    for warning in result.warnings:
        note(f"warning: {warning}")
    if output is not None:
        with writing(output):
            result.save(output)
    if figure is not None:
        with working(f"drawing {figure}"), writing(figure):
            from tracewire.show import plot_run

            plot_run(result, figure)
    written = [path for path in (output, figure) if path is not None]
    from tracewire.show import summary

    if as_json:
        print_json(summary.run_data(result, samples) | {"written": written})
        return
    print_table(summary.run_table(result))
    if events:
        print_table(summary.events_table(result))
    print_text(summary.run_text(result))
    for path in written:
        print_text(f"written: {path}")


def _kept(error: Interrupted, path: str) -> Interrupted:
    """Save what there is of an interrupted run; the error says where."""
    if error.run is None:
        return error
    with writing(path):
        error.run.save(path)
    what = error.problems[0].what
    some = f"{len(error.run.t)} samples and {len(error.run.events)} events"
    left_out = " (events go into .npz only)" if path.endswith(".csv") else ""
    hint = f"The run up to there is in '{path}': {some}{left_out}."
    return type(error)([Problem(what, hint=hint)], error.run)


def _series(model: Model, name: str) -> _Series:
    """What a run takes from a measured series; nothing where no series is named."""
    if not name:
        return {}, {}, "", None, {}
    if name not in model.diagram.measured:
        raise OptionError([unknown("measured series", name, model.diagram.measured)])
    from tracewire.residual import load_measured

    # of a series with several windows the first
    measured = next(found for found in load_measured(model) if found.series == name)
    start = {state: value for state, value in measured.start.items() if value is not None}
    # a series with start values begins at its first sample, one without at the diagram's start
    span = (float(measured.t[0]), float(measured.t[-1])) if measured.start else None
    return dict(measured.inputs), start, measured.preset, span, dict(measured.parameters)
