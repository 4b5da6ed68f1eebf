"""`report`: a run, a fit or a trace as a document with figures."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from tracewire.fit import Fit
from tracewire.fit.profile import Profile
from tracewire.show.document import Figure, Report, Section
from tracewire.show.figures import plot_run
from tracewire.show.fit_figures import plot_fit, plot_residual
from tracewire.show.fit_report import fit_report
from tracewire.show.fit_tables import fit_tables, fit_text, fit_words
from tracewire.show.summary import Table, shown
from tracewire.solve import Run
from tracewire.trace import Found

__all__ = [
    "effects_table",
    "fit_tables",
    "fit_text",
    "fit_words",
    "moved_table",
    "plot_held_out",
    "plot_left",
    "ranking_table",
    "report",
    "trace_text",
]

VERDICTS = {
    "effect": "The diagram lacks something, and the data name it.",
    "null": "Nothing is missing beyond the noise of the data.",
    "unexplained": "Something is missing, and no effect of the library explains it.",
}

RANKING = (
    "Each row is the diagram with these effects added, refitted. BIC is relative to the diagram "
    "before them: the lower, the better, and an effect that is not needed raises it. s2 is the "
    "squared residual per degree of freedom in units of the noise: 1 is at the noise. The gate "
    "compares on stretches that the fit did not see."
)


def report(subject: Run | Fit | Found, profiles: Sequence[Profile] = ()) -> Report:
    """The report of a run, a fit or a trace; `report(...).write("report.html")` writes it.

    `profiles` are profile likelihoods of the fit, where they were computed.
    """
    if isinstance(subject, Run):
        return _of_run(subject)
    return fit_report(subject, profiles) if isinstance(subject, Fit) else _of_trace(subject)


def _of_run(run: Run) -> Report:
    kinds = Counter(event.kind for event in run.events)
    events = ", ".join(f"{count} {kind}" for kind, count in kinds.items()) or "none"
    text = f"From {run.t[0]:g} to {run.t[-1]:g} s, {len(run.t)} samples. Events: {events}."
    figure = Figure("run.png", run.title, lambda path: plot_run(run, path))
    return Report(run.title, (Section("Run", (text, *run.warnings), figures=(figure,)),))


def effects_table(found: Found) -> Table:
    """The effects that were found, with their coefficients in SI and their ties."""
    rows = []
    for effect in found.effects:
        values = ", ".join(f"{name} = {shown(value)}" for name, value in effect.params.items())
        rows.append((effect.name, effect.place, values, ", ".join(effect.ties) or "none"))
    header = ("effect", "place", "coefficient", "cannot be told from")
    return Table("effects", header, tuple(rows))


def moved_table(found: Found) -> Table:
    """The declared parameters fitted without and with the effects, in SI: who stood in for whom."""
    units = {name: value.unit for name, value in found.original.parameters.items()}
    rows = tuple(
        (name, shown(value), shown(found.values.get(name, 0.0)), units.get(name, ""))
        for name, value in found.declared.items()
    )
    header = ("parameter", "without the effects", "with them", "unit")
    return Table("declared parameters", header, rows, frozenset({1, 2}))


def ranking_table(found: Found) -> Table:
    """What was refitted: BIC relative to the model before it, mean square residual in sigma."""
    rows = tuple((r.effects, shown(r.bic), shown(r.s2), r.remark) for r in found.ranking)
    return Table("tried", ("effects", "BIC", "s2", ""), rows, frozenset({1, 2}))


def trace_text(found: Found) -> tuple[str, ...]:
    """The verdict in plain words, and the errors on the stretch that played no part."""
    first = [VERDICTS[found.verdict]]
    for effect in found.effects:
        values = ", ".join(f"{name} {shown(value)}" for name, value in effect.params.items())
        first.append(f"At {effect.place}: {effect.name} with {values} (SI).")
    if found.dropped:
        first.append(f"Went to zero: {', '.join(found.dropped)}.")
    error = (
        f"On the stretch that played no part the error goes from {found.rmse_before:.4g} to "
        f"{found.rmse_after:.4g} (root mean square, SI), on the fitted stretches from "
        f"{found.fitted_before:.4g} to {found.fitted_after:.4g}. Per degree of freedom the squared "
        f"residual of the fitted stretches, in units of the noise, goes from "
        f"{found.s2_before:.4g} to {found.s2_after:.4g}; 1 is the noise."
    )
    if found.verdict == "effect" and found.s2_after > 2:
        error += " What remains is still above the noise: these effects are not the whole truth."
    return " ".join(first), error, *(f"{text[0].upper()}{text[1:]}." for text in found.words)


def plot_held_out(found: Found, path: Path) -> Path:
    """Free runs before and after, against the measurement that played no part."""
    series = [
        (f"{h.series}: {h.signal}", h.t, h.measured, h.before, h.after) for h in found.held_out
    ]
    title = "Free runs on the stretch that played no part"
    return plot_fit(path, series, [h.unit for h in found.held_out], title)


def plot_left(found: Found, path: Path) -> Path:
    """The residual in units of the noise on the stretch that played no part."""
    rows = []
    for h in found.held_out:
        sigma = found.sigma[h.signal]
        before, after = (h.measured - h.before) / sigma, (h.measured - h.after) / sigma
        rows.append((f"{h.series}: {h.signal}", h.t, before, after))
    return plot_residual(path, rows, band=2.0, title="Residual in units of the noise")


def _of_trace(found: Found) -> Report:
    title = f"Trace of {found.original.title or found.original.file.name}"
    figures = (
        Figure("held_out.png", "Free runs before and after", partial(plot_held_out, found)),
        Figure("residual.png", "Residual before and after", partial(plot_left, found)),
    )
    tables = (effects_table(found), moved_table(found)) if found.effects else ()
    sections = [Section("Verdict", trace_text(found), tables, figures=figures)]
    if found.ranking:
        sections.append(Section("What was tried", (RANKING,), (ranking_table(found),)))
    if found.patch:
        sections.append(Section("The change of the diagram", code=found.patch))
    return Report(title, tuple(sections))
