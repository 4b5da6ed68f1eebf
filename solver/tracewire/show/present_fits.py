"""How fits show themselves."""

from __future__ import annotations

from pathlib import Path

from tracewire.fit import Fit, Profile
from tracewire.show.diagnostic_figures import plot_profiles
from tracewire.show.fit_report import plot_fitted
from tracewire.show.fit_tables import fit_tables, fit_text, fit_words
from tracewire.show.limits import WORD
from tracewire.show.notebook import pictures_by
from tracewire.show.presentation import Part, Presentation
from tracewire.show.table import Table, shown


def _in_a_line(fit: Fit) -> str:
    values = [f"{name} = {shown(value)}" for name, value in fit.values.items()]
    some = ", ".join(values[: WORD.most_names]) + (", ..." if len(values) > WORD.most_names else "")
    return f"{fit.model.flat.title or 'a fit'}, {some}, by {fit.method}"


def _parts(fit: Fit) -> tuple[Part, ...]:
    return (fit_text(fit), *fit_tables(fit), *fit_words(fit))


def _data(found: Fit) -> dict[str, object]:
    return {
        "method": found.method,
        "values": found.values,
        "before": found.began,
        "errors": found.errors,
        "intervals": found.intervals,
        "correlation": found.uncertainty.correlation,
        "not_determined": found.uncertainty.directions,
        "at_bounds": found.uncertainty.at_bounds,
        "unmoved": found.uncertainty.unmoved,
        "words": found.uncertainty.words,
        "remarks": found.remarks,
        "starts": found.starts,
        "criterion_before": found.criterion_before,
        "criterion": found.criterion,
        "evaluations": found.evaluations,
        "iterations": found.iterations,
        "exitflag": found.exitflag,
        "message": found.message,
        "unfinished": found.unfinished,
        "seconds": found.seconds,
        "seed": found.seed,
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


def _profile_in_a_line(found: Profile) -> str:
    low, high = found.interval
    return f"{found.name} from {shown(low)} to {shown(high)} at 95 %"


def _profile_parts(found: Profile) -> tuple[Part, ...]:
    rows = tuple((shown(v), f"{r:.3g}") for v, r in zip(found.values, found.rise, strict=True))
    header = (found.name, "rise of -2 log L")
    return (Table("profile likelihood", header, rows, frozenset({0, 1})), found.words)


def _profile_data(found: Profile) -> dict[str, object]:
    names = ("name", "values", "rise", "others", "interval", "level", "words")
    return {name: getattr(found, name) for name in names}


def _plot_profile(found: Profile, path: Path) -> Path:
    return plot_profiles([found], path)


PRESENTATIONS = {
    Fit: Presentation(_in_a_line, _parts, _data, plot_fitted, pictures_by(plot_fitted)),
    Profile: Presentation(_profile_in_a_line, _profile_parts, _profile_data, _plot_profile),
}
