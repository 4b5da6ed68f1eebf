"""How runs show themselves."""

from __future__ import annotations

from tracewire.show.figures import plot_run
from tracewire.show.limits import WORD
from tracewire.show.notebook import pictures_by
from tracewire.show.presentation import Part, Presentation
from tracewire.show.summary import run_data, run_table, run_text
from tracewire.show.table import Table, shown
from tracewire.solve import Run, Runs


def _run_in_a_line(run: Run) -> str:
    names = list(run.signals)
    some = ", ".join(names[: WORD.most_names]) + (", ..." if len(names) > WORD.most_names else "")
    return (
        f"{run.title or 'a run'}, {run.t[0]:g} to {run.t[-1]:g} s, {len(run.t)} samples of "
        f"{some or 'no signal'}, {len(run.events)} events"
    )


def _run_parts(run: Run) -> tuple[Part, ...]:
    return (run_table(run), run_text(run), *run.warnings)


def _runs_in_a_line(runs: Runs) -> str:
    failed = f", {len(runs.errors)} of them failed" if runs.errors else ""
    return f"{len(runs)} runs over {', '.join(runs.parameters) or 'nothing'}{failed}"


def _runs_table(runs: Runs) -> Table:
    """Each row with its parameters and its final states, in SI."""
    columns = [*runs.parameters.values(), *runs.final.T]
    rows = tuple(
        (str(n), *(shown(float(column[n])) for column in columns))
        for n in range(min(len(runs), WORD.most_rows))
    )
    header = ("row", *runs.parameters, *(f"end of {name}" for name in runs.states))
    more = f" (the first {WORD.most_rows} of {len(runs)})" if len(runs) > WORD.most_rows else ""
    return Table(f"runs, in SI{more}", header, rows, frozenset(range(len(header))))


def _runs_data(runs: Runs) -> dict[str, object]:
    return {
        "parameters": runs.parameters,
        "final": dict(zip(runs.states, runs.final.T, strict=True)),
        "event_counts": runs.event_counts,
        "errors": runs.errors,
    }


PRESENTATIONS = {
    Run: Presentation(_run_in_a_line, _run_parts, run_data, plot_run, pictures_by(plot_run)),
    Runs: Presentation(
        _runs_in_a_line, lambda runs: (_runs_table(runs), *runs.errors.values()), _runs_data
    ),
}
