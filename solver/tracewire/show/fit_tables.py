"""A fit in tables and sentences: what was found, how sure that is, and what is left over."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tracewire.fit import Comparison, Diagnosis, Fit, diagnose
from tracewire.library import SENSOR_TERMS
from tracewire.show.comparison_figures import root_mean_square
from tracewire.show.parameter_figures import unknown_width
from tracewire.show.table import Table, shown

UNKNOWN = "not determined"
LOCAL = ("least_squares", "fminsearch")
"""Methods that go to the nearest minimum."""


def fit_tables(fit: Fit) -> tuple[Table, ...]:
    """The tables of a fit, without those that are empty."""
    tables = (fit_table(fit), tied_table(fit), starts_table(fit), comparison_table(fit))
    return tuple(table for table in tables if table.rows)


def fit_table(fit: Fit) -> Table:
    """Fitted parameters, and numbers of sensors, in the units of the file, with standard errors
    and 95 % intervals."""
    rows = []
    for name in fit.values:
        unit, factor = unit_of(fit, name)
        value, error = fit.values[name] / factor, fit.errors.get(name, math.nan) / factor
        low, high = (end / factor for end in fit.intervals.get(name, (math.nan, math.nan)))
        interval = UNKNOWN
        if math.isfinite(low) and math.isfinite(high):
            interval = f"{round_by_error(low, error, 3)} to {round_by_error(high, error, 3)}"
        rows.append(
            (
                name,
                shown(fit.began[name] / factor),
                round_by_error(value, error),
                f"{error:.3g}" if math.isfinite(error) else "–",
                interval,
                unit,
                _remark(fit, name),
            )
        )
    header = ("parameter", "before", "after", "standard error", "95 % interval", "unit", "remark")
    return Table("fitted parameters", header, tuple(rows), frozenset({1, 2, 3, 4}))


def round_by_error(value: float, error: float, least: int = 6) -> str:
    """A number with as many digits as its standard error leaves meaning, at least `least`."""
    digits = least
    if value != 0 and math.isfinite(error) and error > 0:
        needed = math.floor(math.log10(abs(value))) - math.floor(math.log10(error)) + 2
        digits = max(digits, min(needed, 12))
    return f"{value:.{digits}g}"


def unit_of(fit: Fit, name: str) -> tuple[str, float]:
    """The unit of a fitted value with its factor to SI: of a parameter that of the file, of what a
    sensor does to its signal that of the signal's column."""
    flat = fit.model.flat
    if name in flat.parameters:
        return flat.parameters[name].users_unit
    kind, _, signal = name.partition(".")
    if kind not in SENSOR_TERMS:
        return "", 1.0
    term = SENSOR_TERMS[kind]
    unit, factor = fit.model.users_unit(signal)
    return term.unit_of(unit), term.factor(factor)


def _remark(fit: Fit, name: str) -> str:
    found = fit.uncertainty
    if name in found.at_bounds:
        return "at its bound"
    if name in found.unmoved:
        return unknown_width(fit, name)
    if math.isfinite(fit.errors.get(name, math.nan)):
        return ""
    own = {other for d in found.directions if name in d.names for other in d.names} - {name}
    few = [
        other
        for other in fit.values
        if other in own and not math.isfinite(fit.errors.get(other, math.nan))
    ]
    more = f" and {len(few) - 3} more" if len(few) > 3 else ""
    return f"only together with {', '.join(few[:3])}{more}" if few else ""


def tied_table(fit: Fit) -> Table:
    """Parameters that are not free themselves, but follow from fitted ones by their formulas.

    Those of a subsystem that only take the value of one outside are left out.
    """
    from tracewire.formula import Name, to_text
    from tracewire.solve import parameter_values

    flat = fit.model.flat
    own = {name for name in fit.values if name in flat.parameters}
    before = parameter_values(fit.model, {name: fit.began[name] for name in own})
    after = parameter_values(fit.model, {name: fit.values[name] for name in own})
    rows = tuple(
        (name, to_text(flat.parameters[name].formula), shown(before[name] / factor),
         shown(value / factor), unit)
        for name, value in after.items()
        for unit, factor in [flat.parameters[name].users_unit]
        if name not in own
        and value != before[name]
        and not ("." in name and isinstance(flat.parameters[name].formula, Name))
    )  # fmt: skip
    header = ("parameter", "formula", "before", "after", "unit")
    return Table("parameters that follow from these", header, rows, frozenset({2, 3}))


def starts_table(fit: Fit) -> Table:
    """Fitted start values by series and state, of a measured one in the unit of its column."""
    rows = tuple(
        (series, state, shown(value / factor), unit)
        for series, starts in fit.starts.items()
        for state, value in starts.items()
        for unit, factor in [fit.model.users_unit(state)]
    )
    return Table("fitted start values", ("series", "state", "start", "unit"), rows, frozenset({2}))


def comparison_table(fit: Fit) -> Table:
    """Root mean square errors before and after, by series and signal, in the user's unit and in
    sigma."""
    known = any(c.sigma for c in fit.comparisons)
    header = ("series", "use", "signal", "samples", "unit", "rmse before", "rmse after")
    rows = tuple(_compared(c.as_shown, known) for c in fit.comparisons)
    more = ("before in σ", "after in σ") if known else ()
    numeric = frozenset({3, *range(5, len(header) + len(more))})
    return Table("measured against simulated", (*header, *more), rows, numeric)


def _compared(compared: Comparison, in_sigma: bool) -> tuple[str, ...]:
    errors = [
        root_mean_square(residual, compared.counts)
        for residual in (compared.residual_before, compared.residual_after)
    ]
    sigma = compared.sigma
    cells = [_error(error) for error in errors]
    if in_sigma:
        cells += [
            f"{error / sigma:.3g}" if sigma and math.isfinite(error) else "" for error in errors
        ]
    samples = str(int(compared.counts.sum()))
    return compared.series, compared.use, compared.signal, samples, compared.unit, *cells


def _error(value: float) -> str:
    return f"{value:.4g}" if math.isfinite(value) else "no run"


def fit_text(fit: Fit) -> str:
    """What the fit did, in one paragraph."""
    before, after = fit.criterion_before, fit.criterion
    message = " ".join(fit.message.split()).rstrip(".")
    change = f"fell from {before:.4g} to {after:.4g}"
    if after >= before:
        change = f"stayed at {after:.4g}: nothing better was found"
    elif after > 0:
        change += f", {before / after:.4g}-fold,"
    return (
        f"{fit.method}: the criterion {change} in {fit.evaluations} evaluations and "
        f"{fit.seconds:.1f} s: {message}."
    )


def fit_words(fit: Fit) -> tuple[str, ...]:
    """What a reader of the tables must know, a paragraph each: whether the search came to its end,
    what the data do not determine, what is left in the residual, and what was odd.
    """
    return (
        *unfinished_words(fit),
        *identifiability_words(fit),
        *residual_words(fit, diagnose(fit)),
        *remark_words(fit),
    )


def unfinished_words(fit: Fit) -> tuple[str, ...]:
    """That the search ended before a minimum."""
    if not fit.unfinished:
        return ()
    return (
        f"{fit.unfinished}. Until it reaches one, no residual tells that something is missing.",
    )


def identifiability_words(fit: Fit) -> tuple[str, ...]:
    """What the data do not determine."""
    return tuple(map(sentence, fit.uncertainty.words))


def _with_use(series: str, use: str) -> str:
    """A series with its use; the name of a window has it already."""
    return series if series.endswith(f"({use})") else f"{series} ({use})"


def residual_words(fit: Fit, found: Sequence[Diagnosis]) -> tuple[str, ...]:
    """What the residual after the fit is like, by series and signal."""
    words = [sentence(f"{_with_use(d.series, d.use)}, {d.signal}: {d.words}") for d in found]
    if any(d.is_missing for d in found) and any(
        error > 0 for error in fit.uncertainty.errors.values()
    ):
        words.append(
            "The standard errors take what is missing for noise: a value may be much nearer to the"
            " truth than they say, or farther from it."
        )
    # a body that sticks or hits a stop once more: no slope shows the way to such a motion
    jumps = any(not mode.timed for mode in fit.model.modes)
    if (
        fit.method in LOCAL
        and fit.model.states
        and any(d.is_missing and (d.is_out_of_step or jumps) for d in found)
    ):
        words.append(
            f"Or {fit.method} has ended in a minimum that is not the lowest: it takes the nearest. "
            f"Fit once more with --method {'multiple_shooting' if jumps else 'growing_windows'}; "
            "where that leaves as much, trace."
        )
    return tuple(words)


def remark_words(fit: Fit) -> tuple[str, ...]:
    """What was odd about the fit or its data."""
    odd = [f"{m.name}: {text}" for m in fit.measured for text in m.remarks]
    return tuple(map(sentence, dict.fromkeys([*fit.remarks, *odd])))


def sentence(text: str) -> str:
    """A text with a full stop; its first letter stays, which may be that of a name."""
    return text if text.endswith((".", "!", "?")) else f"{text}."
