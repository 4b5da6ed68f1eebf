"""`report`: a run, a fit or a trace as a document with figures."""

from __future__ import annotations

import math
from collections import Counter
from functools import partial
from pathlib import Path

from tracewire.fit import Comparison, Fit
from tracewire.show.document import Figure, Report, Section
from tracewire.show.figures import plot_run
from tracewire.show.fit_figures import plot_fit, plot_residual
from tracewire.show.summary import Table, shown
from tracewire.solve import Run
from tracewire.trace import Found

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


def report(subject: Run | Fit | Found) -> Report:
    """The report of a run, a fit or a trace; `report(...).write("report.html")` writes it."""
    if isinstance(subject, Run):
        return _of_run(subject)
    return _of_fit(subject) if isinstance(subject, Fit) else _of_trace(subject)


def _of_run(run: Run) -> Report:
    kinds = Counter(event.kind for event in run.events)
    events = ", ".join(f"{count} {kind}" for kind, count in kinds.items()) or "none"
    text = f"From {run.t[0]:g} to {run.t[-1]:g} s, {len(run.t)} samples. Events: {events}."
    figure = Figure("run.png", run.title, lambda path: plot_run(run, path))
    return Report(run.title, (Section("Run", (text, *run.warnings), figures=(figure,)),))


def fit_table(fit: Fit) -> Table:
    """Fitted parameters and offsets with standard errors, in SI."""
    flat = fit.model.flat
    rows = []
    for name, value in fit.values.items():
        error = fit.errors[name]
        known = "not determined" if math.isnan(error) else shown(error)
        if name in flat.parameters:
            unit = flat.parameters[name].unit
        else:
            unit = flat.units.get(name.removeprefix("offset."), "")
        remark = "at its bound" if _at_bound(value, fit.bounds[name]) else ""
        rows.append((name, shown(fit.began[name]), shown(value), known, unit, remark))
    header = ("parameter", "before", "after", "standard error", "unit", "")
    return Table("fitted parameters", header, tuple(rows), frozenset({1, 2, 3}))


def _at_bound(value: float, bounds: tuple[float, float]) -> bool:
    low, high = bounds
    near = 1e-6 * (high - low) if math.isfinite(high - low) else 1e-9 * abs(value)
    return value - low <= near or high - value <= near


def comparison_table(fit: Fit) -> Table:
    """Root mean square errors before and after, by series and signal, in SI."""
    rows = tuple(
        (c.series, c.use, c.signal, c.unit, shown(c.rmse_before), shown(c.rmse_after))
        for c in fit.comparisons
    )
    header = ("series", "use", "signal", "unit", "rmse before", "rmse after")
    return Table("measured against simulated", header, rows, frozenset({4, 5}))


def starts_table(fit: Fit) -> Table:
    """Fitted start values by series and state, in SI."""
    units = {state.name: state.unit for state in fit.model.flat.states}
    rows = tuple(
        (series, state, shown(value), units[state])
        for series, starts in fit.starts.items()
        for state, value in starts.items()
    )
    return Table("fitted start values", ("series", "state", "start", "unit"), rows, frozenset({2}))


def fit_tables(fit: Fit) -> tuple[Table, ...]:
    """The tables of a fit, without those that are empty."""
    tables = (fit_table(fit), starts_table(fit), comparison_table(fit))
    return tuple(table for table in tables if table.rows)


def fit_text(fit: Fit) -> str:
    """What the fit did, in one paragraph."""
    ratio = fit.criterion_before / fit.criterion if fit.criterion > 0 else math.inf
    message = " ".join(fit.message.split()).rstrip(".")
    return (
        f"{fit.method}: the criterion fell from {fit.criterion_before:.4g} to {fit.criterion:.4g}, "
        f"{ratio:.4g}-fold, in {fit.evaluations} evaluations and {fit.seconds:.1f} s: {message}."
    )


def plot_fitted(fit: Fit, path: Path) -> Path:
    """Measured against simulated before and after, a panel for each signal and series."""
    series = [(_titled(c), c.t, c.measured, c.before, c.after) for c in fit.comparisons]
    return plot_fit(path, series, [c.unit for c in fit.comparisons], fit.model.flat.title)


def _titled(compared: Comparison) -> str:
    use = "" if compared.use == "train" else f" ({compared.use})"
    return f"{compared.series}{use}: {compared.signal}"


def _of_fit(fit: Fit) -> Report:
    figure = Figure("fit.png", "Measured against simulated", partial(plot_fitted, fit))
    tables = fit_tables(fit)
    section = Section("Fit", (fit_text(fit), *_fit_words(fit)), tables, figures=(figure,))
    return Report(f"Fit of {fit.model.flat.title}", (section,))


def _fit_words(fit: Fit) -> tuple[str, ...]:
    """What a reader of the tables of a fit must know."""
    words = [
        "The criterion is the sum of mean(residual²)/2 over the signals of the series for "
        "training; other series are compared only. Values are in SI; a standard error takes the "
        "residuals for independent."
    ]
    if any(math.isnan(error) for error in fit.errors.values()):
        words.append(
            "Not determined: the data look the same when such parameters change together. Fix one "
            "of them, or measure another signal."
        )
    return tuple(words)


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
