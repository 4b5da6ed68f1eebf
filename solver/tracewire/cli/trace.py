"""`tracewire trace`: from the residual of a diagram to the effect that it lacks."""

from __future__ import annotations

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


def trace(
    diagram: DiagramPath,
    report: ReportFile = None,
    apply: Apply = False,
    output: Output = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Fit a diagram, find what it lacks, and check that on data that played no part.

    The verdict is `null` (nothing is missing), `effect` (named, with its place and coefficient) or
    `unexplained`. The exit code is 0 for each of them.

    \b
    Examples:
      tracewire trace pendulum.yaml
      tracewire trace pendulum.yaml --report trace.html
      tracewire trace pendulum.yaml --apply
      tracewire trace pendulum.yaml --output with_friction.yaml --json
    """
    from tracewire.trace import trace as trace_model

    check_targets(report, output)
    model = load_model(diagram, library)
    check_home(model.diagram, output)
    with working("tracing") as tell:

        def progress(text: str) -> None:
            tell(text)
            note(text)

        found = trace_model(model, progress=progress)
    written = write_report(found, report)
    written += store(model.diagram, found.apply, apply, output)
    if as_json:
        print_json(found.as_json() | {"written": written})
        return
    from tracewire.show.report import effects_table, moved_table, ranking_table, trace_text

    print_text(f"verdict: {found.verdict}")
    for text in trace_text(found):
        print_text(text)
    if found.effects:
        print_table(effects_table(found))
        print_table(moved_table(found))
    if found.ranking:
        print_table(ranking_table(found))
    if found.patch:
        print_text(found.patch)
    for path in written:
        print_text(f"written: {path}")
