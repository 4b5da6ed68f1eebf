"""`report`: a run, a fit or a trace as a document with figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from tracewire.arguments import checked
from tracewire.fit import Fit, Profile
from tracewire.residual import Measured
from tracewire.show.diagram_picture import diagram_figure
from tracewire.show.document import Figure, Report, Section
from tracewire.show.event_rows import is_tick
from tracewire.show.figures import plot_run
from tracewire.show.fit_report import fit_report
from tracewire.show.limits import WORD
from tracewire.show.summary import event_counts, events_table, run_table
from tracewire.show.table import Table, shown
from tracewire.show.trace_report import trace_report
from tracewire.solve import Run
from tracewire.trace import Found

NUMERIC = frozenset({1})


@checked
def report(
    subject: Run | Fit | Found,
    profiles: Sequence[Profile] = (),
    measured: Measured | None = None,
) -> Report:
    """The report of a run, a fit or a trace; `report(...).write("report.html")` writes it.

    `profiles` are profile likelihoods of the fit, where they were computed. `measured` is a series
    whose samples the figure of a run shows, too.
    """
    if isinstance(subject, Run):
        return _of_run(subject, measured)
    return fit_report(subject, profiles) if isinstance(subject, Fit) else trace_report(subject)


def _of_run(run: Run, measured: Measured | None) -> Report:
    kinds = ", ".join(f"{count} {kind}" for kind, count in event_counts(run).items()) or "none"
    text = f"From {run.t[0]:g} to {run.t[-1]:g} s, {len(run.t)} samples. Events: {kinds}."
    caption = "The recorded signals" + (f", and the series {measured.name}" if measured else "")
    figure = Figure("run.png", caption, lambda path: plot_run(run, path, measured))
    signals = replace(run_table(run), title="recorded signals")
    sections = [Section("The run", (text, *run.warnings), (signals,), figures=(figure,))]
    if run.model is not None:
        sections.insert(0, Section("The diagram", figures=(diagram_figure(run.model.diagram),)))
    if run.parameters:
        sections.append(Section("The values", tables=(_values_table(run),)))
    if run.events:
        sections.append(_events(run))
    return Report(run.title or "A run", tuple(sections))


def _events(run: Run) -> Section:
    """The first events, without the ticks of clocks where there are others."""
    told = [event for event in run.events if not is_tick(run, event)] or list(run.events)
    ticks = len(run.events) - len(told)
    texts = []
    if len(told) > WORD.most_events:
        texts.append(f"The first {WORD.most_events} of {len(told)}.")
    if ticks:
        texts.append(f"{ticks} ticks of the clocks of sampled blocks are left out.")
    table = replace(events_table(run, told[: WORD.most_events]), title="")
    return Section("The events", (" ".join(texts),) if texts else (), (table,))


def _values_table(run: Run) -> Table:
    """The values that a run was made with, parameters in the units of the file, starts in SI."""
    known = run.model.flat.parameters if run.model is not None else {}
    units = run.model.flat.units if run.model is not None else run.units
    rows = []
    for name, value in run.parameters.items():
        unit, factor = known[name].users_unit if name in known else ("", 1.0)
        rows.append((name, shown(value / factor), unit))
    rows += [(f"start of {n}", shown(value), units.get(n, "")) for n, value in run.start.items()]
    return Table("parameters and start", ("name", "value", "unit"), tuple(rows), NUMERIC)
