"""`tracewire paper a`: what the paper states, and what its diagrams do."""

from __future__ import annotations

from tracewire.cli.output import check_target, note, print_json, print_table, print_text, working
from tracewire.cli.progress import stages


def write_report(paper: str, report: str | None, full: bool, as_json: bool) -> None:
    """Measure all statements of a paper; print them, and write them to .html or .md."""
    report = report or f"paper_{paper}.html"
    check_target(report, (".md", ".html"), "report")
    with working(f"paper {paper}") as show:
        from tracewire.paper.document import data_of, report_of, summary, verdicts_table
        from tracewire.paper.reproduction import reproduce

        found = reproduce(paper, full=full, progress=stages(show))
    with working("drawing the figures"):
        report_of(found).write(report, note)
    if as_json:
        print_json({**data_of(found), "written": [report]})
        return
    print_table(verdicts_table(found.rows, f"paper {paper}", short=True))
    for table in found.tables:
        print_table(table)
    for row in found.rows:
        if row.verdict != "agrees":
            print_text(f"{row.statement.name}: {row.verdict}. {row.why}")
    print_text(summary(found))
    print_text(f"written: {report}")
