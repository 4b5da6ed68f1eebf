"""`tracewire run`: simulate a diagram."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.cases import cases_of
from tracewire.cli.one_run import evenly
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
from tracewire.cli.reporting import ReportFile, write_report
from tracewire.cli.series import SeriesName, read_series
from tracewire.cli.values import parameter_values_of, start_values_of, units_of
from tracewire.errors import OptionError, Problem
from tracewire.files import writing

if TYPE_CHECKING:
    from tracewire.solve import Interrupted, Run

OUTPUTS = (".csv", ".npz")
FIGURES = (".png", ".svg", ".pdf")

FINER = 10
"""Times as many samples are drawn as are written."""


def run(
    diagram: DiagramPath,
    preset: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME", help="A preset of the diagram. Repeatable: a run for each of them."
        ),
    ] = None,
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
    over: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUES",
            help="A run for each of these values of a parameter, or of start.STATE, in one table "
            "and figure: 'k=1,2,5' or 'k=FROM:TO:COUNT'. Repeatable.",
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
    unit: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SIGNAL=UNIT",
            help="The unit of a signal in table and figure; files are in SI. Repeatable.",
            show_default=False,
        ),
    ] = None,
    series: SeriesName = "",
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
    report: ReportFile = None,
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
      tracewire run pendulum.yaml --series run_1 --report run.html
      tracewire run pendulum.yaml --over c=0.1,0.2,0.5 --unit phi=deg --figure damping.png

    Ctrl-C keeps the run up to there: in the file of --output, or in DIAGRAM.interrupted.npz in this
    folder.
    """
    if samples and not as_json:
        what = "--samples prints samples as JSON only"
        hint = "Add --json, or write them to a file with --output samples.csv."
        raise OptionError([Problem(what, hint=hint)])
    check_target(output, OUTPUTS, "output")
    check_target(figure, FIGURES, "figure")
    check_target(report, (".md", ".html"), "report")
    model = load_model(diagram, library, record)
    parameters = parameter_values_of(model, values or ())
    starts = start_values_of(model, start or ())
    units = units_of(model, unit or ())
    cases = cases_of(model, over or (), preset or ())
    if len(cases) > 1 and (output or samples or events or report):
        what = "--output, --report, --samples and --events are those of one run"
        what += ", and here are several"
        hint = "Leave them out, or run each case by itself."
        raise OptionError([Problem(what, hint=hint)])
    if every is not None:
        from tracewire.formula import Number

        model = replace(model, flat=replace(model.flat, every=Number(every)))
    from tracewire.solve import (
        DEFAULT_SAMPLES,
        Interrupted,
        Options,
        parameter_values,
        simulate,
        with_options,
    )

    given, measured = read_series(model, series)
    given = with_options(
        given,
        Options(
            parameters=parameters, start=starts, span=span, method=method, rtol=rtol, atol=atol
        ),
    )
    # a figure of a quick swing needs more points than a table of it
    finer = (figure or report) is not None and model.flat.every is None
    runs = {}
    for case in cases:
        what = f"simulating {diagram}" + (f" with {case.name}" if case.name else "")
        with working(what) as show:
            own = Options(parameters=case.parameters, start=case.start, preset=case.preset)
            options = with_options(given, own)
            if finer:
                values_of_case = options.get("parameters") or {}
                known = parameter_values(model, values_of_case, options.get("preset", ""))
                steps = FINER * (DEFAULT_SAMPLES - 1)
                options["times"] = evenly(model, known, options.get("span"), steps)
            try:
                result = simulate(model, **options, progress=telling(what, show))
            except Interrupted as error:
                raise _kept(error, output or f"{Path(diagram).stem}.interrupted.npz") from error
        runs[case.name] = result.in_units(units)
        _tell_warnings(case.name, result)
    from tracewire.show import summary

    result = next(iter(runs.values()))
    if output is not None:
        with writing(output):
            (_thinned(result) if finer else result).save(output)
    if figure is not None:
        with working(f"drawing {figure}"), writing(figure):
            from tracewire.show import plot_run, plot_runs

            if len(runs) > 1:
                plot_runs(runs, figure, measured)
            else:
                plot_run(result, figure, measured)
    write_report(result, report, measured=measured)
    written = [path for path in (output, figure, report) if path is not None]

    if finer:
        runs = {name: _thinned(one) for name, one in runs.items()}
    told = {name: summary.run_data(one, samples) for name, one in runs.items()}
    if as_json:
        print_json(
            (told[cases[0].name] if len(cases) == 1 else {"runs": told}) | {"written": written}
        )
        return
    if len(runs) > 1:
        from tracewire.show.several_runs import runs_table

        print_table(runs_table(runs))
    else:
        result = runs[cases[0].name]
        print_table(summary.run_table(result))
        if events:
            print_table(summary.events_table(result))
        print_text(summary.run_text(result))
    for path in written:
        print_text(f"written: {path}")
    own_conditions = series or preset or values or start or over
    if (figure or report) and model.diagram.measured and not own_conditions:
        names = ", ".join(model.diagram.measured)
        print_text(f"without measured data; --series runs as one of these and draws it: {names}")


def _tell_warnings(case: str, result: Run) -> None:
    """What is odd about a run, on stderr."""
    from tracewire.show import summary

    for remark in (*result.warnings, *summary.runaway_remarks(result)):
        note(f"warning: {case}: {remark}" if case else f"warning: {remark}")


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


def _thinned(result: Run) -> Run:
    """The run with the samples that it has without a figure: every tenth, and the last one."""
    kept = [*range(0, len(result.t) - 1, FINER), len(result.t) - 1]
    signals = {name: values[kept] for name, values in result.signals.items()}
    return replace(result, t=result.t[kept], signals=signals)
