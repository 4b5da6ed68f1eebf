"""`tracewire run`: simulate a diagram."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from tracewire.cli.cases import cases_of, failure_of
from tracewire.cli.limits import LIMITS
from tracewire.cli.options import DiagramPath, load_model, read_series
from tracewire.cli.output import note, print_json, print_table, print_text, telling, working
from tracewire.cli.records import Sampling
from tracewire.cli.reporting import write_report
from tracewire.cli.run_records import Accuracy, RunGiven, RunTarget
from tracewire.cli.values import units_of
from tracewire.errors import Problem, TracewireError
from tracewire.files import writing

if TYPE_CHECKING:
    from tracewire.compile import Model
    from tracewire.residual import Measured
    from tracewire.solve import Interrupted, Options, Run


def run(
    diagram: DiagramPath,
    *,
    given: RunGiven,
    sampling: Sampling,
    accuracy: Accuracy,
    target: RunTarget,
) -> None:
    """Simulate a diagram and print how each recorded signal went.

    \b
    Examples:
      tracewire run pendulum.yaml --preset as_printed --span 0 4
      tracewire run pendulum.yaml --set "phi=13.6 deg" --figure swing.png
      tracewire run pendulum.yaml --series run_1 --report run.html
      tracewire run pendulum.yaml --over c=0.1,0.2,0.5 --unit phi=deg --figure damping.png

    Ctrl-C keeps the run up to there: in the file of --output, or in DIAGRAM.interrupted.npz in this
    folder. Of several runs those that fail are named, and the others are shown.
    """
    target.check()
    model = load_model(diagram, given.library, given.record)
    from tracewire.solve import Interrupted, Options

    units = units_of(model, target.unit or ())
    conditions, measured = read_series(model, given.series)
    more = Options(span=sampling.span, every=sampling.every) | accuracy.options
    cases = cases_of(model, given, conditions, more)
    if len(cases) > 1:
        target.check_several()
    # a figure of a quick swing needs more points than a table of it
    is_spaced = sampling.every is not None or model.flat.every is not None
    finer = bool(target.figure or target.report) and not is_spaced
    lost = target.output or f"{Path(diagram).stem}.interrupted.npz"
    runs: dict[str, Run] = {}
    failed: dict[str, TracewireError] = {}
    for case in cases:
        what = f"simulating {diagram}" + (f" with {case.name}" if case.name else "")
        try:
            run_of_case = _simulated(model, case.options, finer, what, lost)
        except Interrupted:
            raise
        except TracewireError as error:
            failed[case.name] = error
            continue
        runs[case.name] = run_of_case.in_units(units)
        _tell_warnings(case.name, run_of_case)
    if not runs:
        raise failure_of(failed)
    several = len(cases) > 1
    _write(runs, target, measured, finer, several)
    _tell(runs, failed, target, finer, several)
    if (target.figure or target.report) and model.diagram.measured and not given.is_own:
        names = ", ".join(model.diagram.measured)
        if not target.as_json:
            print_text(
                f"without measured data; --series runs as one of these and draws it: {names}"
            )


def _simulated(model: Model, options: Options, finer: bool, what: str, lost: str) -> Run:
    """The run, with ten times the samples where it is `finer`; what there is of one that the user
    stops goes into the file `lost`."""
    with working(what) as show:
        from tracewire.solve import (
            DEFAULT_SAMPLES,
            Interrupted,
            even_times,
            parameter_values,
            simulate,
        )

        if finer:
            preset = options.get("preset", "")
            known = parameter_values(model, options.get("parameters") or {}, preset)
            steps = LIMITS.finer * (DEFAULT_SAMPLES - 1)
            options["times"] = even_times(model, known, options.get("span"), steps)
        try:
            return simulate(model, **options, progress=telling(what, show))
        except Interrupted as error:
            raise _kept(error, lost) from error


def _write(
    runs: Mapping[str, Run],
    target: RunTarget,
    measured: Measured | None,
    finer: bool,
    several: bool,
) -> None:
    """Write the files that are asked for."""
    result = next(iter(runs.values()))
    if target.output is not None:
        with writing(target.output):
            (_thinned(result) if finer else result).save(target.output)
    if target.figure is not None:
        with working(f"drawing {target.figure}"), writing(target.figure):
            from tracewire.show import plot_run, plot_runs

            if several:
                plot_runs(runs, target.figure, measured)
            else:
                plot_run(result, target.figure, measured)
    write_report(result, target.report, measured=measured)


def _tell(
    runs: Mapping[str, Run],
    failed: Mapping[str, TracewireError],
    target: RunTarget,
    finer: bool,
    several: bool,
) -> None:
    """Print the runs, and of several those that failed."""
    from tracewire.show import summary

    shown = {name: _thinned(one) for name, one in runs.items()} if finer else runs
    result = next(iter(shown.values()))
    if target.as_json:
        told = {name: summary.run_data(one, target.samples) for name, one in shown.items()}
        wrong = {name: str(error) for name, error in failed.items()}
        data = {"runs": told, "failed": wrong} if several else next(iter(told.values()))
        print_json(data | {"written": target.written})
        return
    if several:
        from tracewire.show.several_runs import runs_table

        print_table(runs_table(shown))
        for name, error in failed.items():
            print_text(f"the run with {name} failed: {error}")
    else:
        print_table(summary.run_table(result))
        if target.events:
            print_table(summary.events_table(result))
        print_text(summary.run_text(result))
    for path in target.written:
        print_text(f"written: {path}")


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
    kept = [*range(0, len(result.t) - 1, LIMITS.finer), len(result.t) - 1]
    signals = {name: values[kept] for name, values in result.signals.items()}
    return replace(result, t=result.t[kept], signals=signals)
