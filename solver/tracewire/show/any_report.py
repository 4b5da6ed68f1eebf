"""`report`: a run, a fit or a trace as a document with figures."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from tracewire.fit import Fit, Profile
from tracewire.show.document import Figure, Report, Section
from tracewire.show.figures import plot_run
from tracewire.show.fit_report import fit_report
from tracewire.show.trace_report import trace_report
from tracewire.solve import Run
from tracewire.trace import Found


def report(subject: Run | Fit | Found, profiles: Sequence[Profile] = ()) -> Report:
    """The report of a run, a fit or a trace; `report(...).write("report.html")` writes it.

    `profiles` are profile likelihoods of the fit, where they were computed.
    """
    if isinstance(subject, Run):
        return _of_run(subject)
    return fit_report(subject, profiles) if isinstance(subject, Fit) else trace_report(subject)


def _of_run(run: Run) -> Report:
    kinds = Counter(event.kind for event in run.events)
    events = ", ".join(f"{count} {kind}" for kind, count in kinds.items()) or "none"
    text = f"From {run.t[0]:g} to {run.t[-1]:g} s, {len(run.t)} samples. Events: {events}."
    figure = Figure("run.png", run.title, lambda path: plot_run(run, path))
    return Report(run.title, (Section("Run", (text, *run.warnings), figures=(figure,)),))
