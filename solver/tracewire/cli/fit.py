"""`tracewire fit`: the free parameters of a diagram from its measured series."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries, load_model
from tracewire.cli.output import note, print_json, print_table, print_text, working
from tracewire.cli.reporting import (
    Apply,
    Output,
    ReportFile,
    check_home,
    check_targets,
    store,
    write_report,
)
from tracewire.cli.values import parameter_values_of

if TYPE_CHECKING:
    from tracewire.fit import Fit, Progress

TELL_EVERY = 10.0


def fit(
    diagram: DiagramPath,
    method: Annotated[str, typer.Option(help="fminsearch or least_squares.")] = "fminsearch",
    free: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="A parameter to fit, instead of those with `fit:`."),
    ] = None,
    values: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="A value to begin with. Repeatable."),
    ] = None,
    max_iter: Annotated[
        int | None, typer.Option("--MaxIter", help="fminsearch: the most iterations.")
    ] = None,
    max_fun_evals: Annotated[
        int | None, typer.Option("--MaxFunEvals", help="fminsearch: the most evaluations.")
    ] = None,
    tol_x: Annotated[
        float | None, typer.Option("--TolX", help="fminsearch: size of the simplex.")
    ] = None,
    tol_fun: Annotated[
        float | None, typer.Option("--TolFun", help="fminsearch: spread of the criterion.")
    ] = None,
    report: ReportFile = None,
    apply: Apply = False,
    output: Output = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Fit the free parameters of a diagram to its measured series.

    \b
    Examples:
      tracewire fit pendulum.yaml
      tracewire fit pendulum.yaml --method least_squares --report fit.html
      tracewire fit pendulum.yaml --MaxIter 150 --apply
    """
    from tracewire.diagram import set_values
    from tracewire.fit import fit as fit_model
    from tracewire.fit import optimset

    check_targets(report, output)
    model = load_model(diagram, library)
    check_home(model.diagram, output)
    given = {
        "MaxIter": max_iter,
        "MaxFunEvals": max_fun_evals,
        "TolX": tol_x,
        "TolFun": tol_fun,
    }
    limits = {name: value for name, value in given.items() if value is not None}
    options = optimset(Display="off", **limits) if limits else None
    parameters = parameter_values_of(model, values or [])
    with working("fitting") as tell:
        last = time.perf_counter()

        def progress(now: Progress) -> None:
            nonlocal last
            text = (
                f"fitting: {now.evaluations} evaluations, best criterion {now.best:.6g}, "
                f"at most {now.remaining:.0f} s to go"
            )
            tell(text)
            if time.perf_counter() - last > TELL_EVERY:
                last = time.perf_counter()
                note(text)

        found = fit_model(
            model,
            method=method,
            free=free or None,
            parameters=parameters,
            options=options,
            progress=progress,
        )
    written = write_report(found, report)
    own = {n: v for n, v in found.values.items() if n in model.flat.parameters}
    written += store(model.diagram, lambda: set_values(model.diagram, own), apply, output)
    if as_json:
        print_json(_json(found) | {"written": written})
        return
    from tracewire.show.report import fit_tables, fit_text

    print_text(fit_text(found))
    for table in fit_tables(found):
        print_table(table)
    for path in written:
        print_text(f"written: {path}")


def _json(found: Fit) -> dict[str, object]:
    return {
        "method": found.method,
        "values": found.values,
        "before": found.began,
        "errors": found.errors,
        "starts": found.starts,
        "criterion_before": found.criterion_before,
        "criterion": found.criterion,
        "evaluations": found.evaluations,
        "iterations": found.iterations,
        "exitflag": found.exitflag,
        "message": found.message,
        "seconds": found.seconds,
        "comparisons": [
            {
                "series": c.series,
                "use": c.use,
                "signal": c.signal,
                "unit": c.unit,
                "rmse_before": c.rmse_before,
                "rmse_after": c.rmse_after,
            }
            for c in found.comparisons
        ],
    }
