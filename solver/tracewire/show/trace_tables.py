"""A trace in tables: effects, ties, errors, steps, what moved, what would have been seen."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tracewire.show.limits import WORD
from tracewire.show.table import Table, shown
from tracewire.show.trace_experiments import settings_words
from tracewire.show.trace_steps import compares, own_gain
from tracewire.show.trace_untried import common_powers
from tracewire.show.trace_words import percent, remainder_numbers, stood_in, to_its_interval
from tracewire.trace import (
    CandidateScore,
    Dependence,
    Found,
    coefficient_of,
    signal_of,
    users_unit,
    users_unit_of,
    users_unit_of_power,
)


def trace_tables(found: Found) -> tuple[Table, ...]:
    """The tables of a trace that a terminal shows, without those that are empty.

    A report has what is left out: what the lines before them say, effects that were only screened,
    and how small an effect would have been seen where one was found.
    """
    tables = (
        ties_table(found),
        errors_table(found),
        moved_table(found),
        where_table(found, WORD.most_where),
        *([power_table(found, WORD.most_powers)] if found.verdict == "null" else []),
    )
    return tuple(table for table in tables if table.rows)


def effects_table(found: Found) -> Table:
    """The parameters of the effects that were found, of a sensor in the unit of its column and
    else in SI, with 95 % intervals."""
    rows = []
    for effect in found.effects:
        first = effect.name, effect.place
        last = percent(effect.masked), _number(own_gain(found, effect), ".4g")
        for name, value in effect.params.items():
            unit, factor = users_unit_of(found, effect, name)
            low, high = (end / factor for end in effect.intervals.get(name, (math.nan, math.nan)))
            known = math.isfinite(low) and math.isfinite(high)
            shown_value, *ends = to_its_interval(value / factor, low, high)
            interval = " to ".join(ends) if known else ""
            rows.append((*first, name, shown_value, interval, unit, *last))
            first, last = ("", ""), ("", "")
    header = ("effect", "place", "parameter", "value", "95 % interval", "unit", "masked",
              "gain")  # fmt: skip
    title = "effects that were found" if found.verdict == "effect" else "best approximations"
    return Table(title, header, tuple(rows), frozenset({3, 4, 6, 7}))


def remainder_table(found: Found) -> Table:
    """What is left of each signal on held-out blocks, in its unit, in sigma, as a share."""
    rows = tuple(
        (left.signal, size, unit, _number(left.in_sigma, ".3g"), percent(left.share), floor)
        for left in found.remainder
        for size, floor, unit in [remainder_numbers(found, left)]
    )
    header = ("signal", "rms left", "unit", "in σ", "share of the rms before", "floor")
    return Table("what is left on held-out blocks", header, rows, frozenset({1, 3, 4, 5}))


def ties_table(found: Found) -> Table:
    """What these data cannot tell from an effect, with how alike the two are on the data."""
    rows = tuple(
        (str(effect), str(tie), _number(tie.likeness, ".3f"),
         f"{len(tie.params) - len(effect.params):+d}" if tie.params else "",
         ", ".join(f"{name} = {value:.4g}" for name, value in tie.params.items()),
         _number(tie.rise, "+.3g"))
        for effect in found.effects
        for tie in effect.ties
    )  # fmt: skip
    header = ("effect", "cannot be told from", "likeness", "fitted numbers more or fewer",
              "its parameters, refitted", "BIC")  # fmt: skip
    return Table("ties", header, rows, frozenset({2, 3, 5}))


def errors_table(found: Found) -> Table:
    """Root mean square errors before and after, by kind, series and signal, in the unit of the
    user's files and in sigma."""
    kinds = sorted(found.errors, key=lambda e: (e.kind != "free run", e.use != "validate"))
    rows = tuple(
        (e.kind, e.use, e.series, e.signal, unit, _number(e.before / factor, ".4g"),
         _number(e.after / factor, ".4g"), _in_sigma(e.before, e.sigma),
         _in_sigma(e.after, e.sigma))
        for e in kinds
        for unit, factor in [users_unit(found, e.signal)]
    )  # fmt: skip
    header = ("kind", "use", "series", "signal", "unit", "rmse before", "rmse after",
              "before in σ", "after in σ")  # fmt: skip
    return Table("errors", header, rows, frozenset({5, 6, 7, 8}))


def moved_table(found: Found) -> Table:
    """The declared parameters without and with the effects, in the units of the file; what moved
    far is marked. Where there are no effects, as they were fitted."""
    if not found.effects:
        fitted = tuple(
            (m.name, shown(m.after / m.factor), _number(m.error / m.factor, ".2g"), m.users_unit)
            for m in found.moved
        )
        as_fitted = ("parameter", "fitted", "standard error", "unit")
        return Table("declared parameters", as_fitted, fitted, frozenset({1, 2}))
    rows = tuple(
        (m.name, shown(m.before / m.factor), shown(m.after / m.factor),
         _change(m.before, m.after), _number(m.error / m.factor, ".2g"), m.users_unit,
         "had absorbed part of the effect" if stood_in(m) else "")
        for m in found.moved
    )  # fmt: skip
    header = (
        "parameter",
        "without the effects",
        "with them",
        "change",
        "standard error",
        "unit",
        "",
    )
    return Table("declared parameters", header, rows, frozenset({1, 2, 3, 4}))


def tried_table(found: Found) -> Table:
    """What was tried in each step, the best first, also what was not refitted."""
    rows = []
    for number, step in enumerate(found.steps, start=1):
        if not compares(step):
            rows += [_tried(str(number), row) for row in step.tried]
    header = ("step", "effect", "promised", "gain", "weight", "masked", "s2", "")
    return Table("what was tried", header, tuple(rows), frozenset({0, 2, 3, 4, 5, 6}))


def compared_table(found: Found) -> Table:
    """The models that were compared by what they predict, the best first."""
    rows = tuple(
        (str(number), row.effects, _number(row.gain, ".4g"), _number(row.s2, ".4g"), row.remark)
        for number, step in enumerate(found.steps, start=1)
        if compares(step)
        for row in step.tried
    )
    header = ("step", "model", "gain of prediction", "s2", "")
    return Table("models compared by what they predict", header, rows, frozenset({0, 2, 3}))


def power_table(found: Found, most: int = WORD.report_rows) -> Table:
    """The smallest coefficient of each effect that these data would have shown."""
    powers = common_powers(found)
    rows = [
        (p.name, p.place, coefficient_of(p), _number(p.smallest / factor, ".3g"), unit)
        for p in powers[:most]
        for unit, factor in [users_unit_of_power(found, p)]
    ]
    if len(powers) > most:
        rows.append((f"and {len(powers) - most} more", "", "", "", ""))
    header = ("effect", "place", "coefficient", "smallest that these data would show", "unit")
    return Table("what would have been seen", header, tuple(rows), frozenset({3}))


def where_table(found: Found, most: int = WORD.report_rows) -> Table:
    """On what the residual of the declared model depends, at which place, the best first."""
    return _depends(found, "where, and on what", found.dependences, most)


def remainder_where_table(found: Found) -> Table:
    """On what the residual that is left depends, at which place, the best first."""
    title = "what is left: where, and on what"
    return _depends(found, title, found.remainder_depends, WORD.report_rows)


def _depends(found: Found, title: str, dependences: Sequence[Dependence], most: int) -> Table:
    rows = tuple(
        (d.place, ", ".join(signal_of(found, d.place, name) for name in d.variables),
         percent(max(d.share, 0.0)))
        for d in sorted(dependences, key=lambda d: -d.share)[:most]
    )  # fmt: skip
    header = ("place", "depends on", "share of the excess that this explains")
    return Table(title, header, rows, frozenset({2}))


def experiments_table(found: Found) -> Table:
    """The experiments that would separate effects that these data do not."""
    rows = tuple(
        (f"{e.one} or {e.other}",
         settings_words(found, e.settings), _number(e.separation, ".3g"))
        for e in found.experiments
    )  # fmt: skip
    header = ("to tell apart", "experiment", "separation in σ")
    return Table("experiments that would separate them", header, rows, frozenset({2}))


def _tried(step: str, row: CandidateScore) -> tuple[str, ...]:
    return (
        step,
        row.effects,
        _number(row.promised, ".4g"),
        _number(row.gain, ".4g"),
        _number(row.weight, ".2f"),
        percent(row.masked),
        _number(row.s2, ".4g"),
        row.remark,
    )


def _number(value: float, form: str) -> str:
    return format(value, form) if math.isfinite(value) else ""


def _in_sigma(value: float, sigma: float) -> str:
    return _number(value / sigma, ".3g") if sigma > 0 else ""


def _change(before: float, after: float) -> str:
    """The relative change; '' from or through zero, of which it tells nothing."""
    if before * after < 0:
        return ""
    change = after / before - 1 if before else math.nan
    if not abs(change) < 10:
        return ""
    return f"{100 * change:+.0f} %" if abs(change) >= 0.1 else f"{100 * change:+.2g} %"
