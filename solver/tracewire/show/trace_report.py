"""The report of a trace: what is missing, how it was found, what that predicts, what is open."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from tracewire.show.document import Figure, Report, Section
from tracewire.show.fit_tables import sentence
from tracewire.show.trace_figures import (
    plot_candidates,
    plot_forces,
    plot_free_runs,
    plot_residuals,
)
from tracewire.show.trace_maps import (
    drawable,
    plot_confusable,
    plot_experiments,
    plot_missing,
    plot_where,
)
from tracewire.show.trace_tables import (
    effects_table,
    errors_table,
    experiments_table,
    moved_table,
    power_table,
    ties_table,
    tried_table,
    where_table,
)
from tracewire.show.trace_text import answer_lines, step_lines
from tracewire.trace import Found
from tracewire.trace.telling import stood_in

ERRORS = (
    "A windowed error is that of many short runs, each from a fitted start; a free run is one run "
    "over the whole series, so that small errors add up. Only series of the use validate played no "
    "part in the fit and in the choice of effects: they are the honest test. σ is the noise of the "
    "sensor, as estimated from the data: an error of 1 σ is as good as the data allow."
)
STEPS = (
    "In each step every effect of the library is tried at every place of the diagram. The screen "
    "promises a gain for each; the best are put into the diagram and all free parameters are "
    "fitted again. The gate compares on windows that the fit did not see, and accepts or refuses."
)
MOVED = (
    "A parameter that moves by more than two standard errors had stood in for what was missing: "
    "its value before said less about the part that it is named after."
)
TIES = (
    "Effects whose signatures on these data are nearly the same cannot be told apart by any "
    "analysis of them; only another experiment can."
)
POWER = (
    "An effect with a coefficient of this size or more would have stood out by five standard "
    "errors at least; of smaller ones these data say nothing."
)
WHERE = (
    "A smooth function of each set of variables was fitted at each place to what is above the "
    "noise and tested on parts of the data that it was not fitted to. A large share says where "
    "something is missing and on what it depends; the smallest set of variables that is nearly the "
    "best is outlined."
)
MISSING = (
    "This curve is empirical: it says what these data ask for, not why, and nothing outside of "
    "where there are samples. `tracewire trace ... --table FILE.csv` writes it for a `table` block."
)
GLOSSARY = (
    "s2: squared residual per degree of freedom in units of the noise; 1 is at the noise.",
    "gain: half the fall of BIC, a measure of the fit that charges for each further parameter; 5 "
    "is strong, 0 is nothing.",
    "weight: the share of an effect among those that were tried beside it, from their BIC.",
    "masked: the part of an effect's signature that the declared parameters imitate when they are "
    "fitted; at 100 % it could not be seen at all.",
    "likeness: how alike the signatures of two effects are, once all that is fitted is taken out "
    "of them; 1 is the same.",
    "excess: what the squared residual has above that of noise alone.",
)


def trace_report(found: Found) -> Report:
    """The report of a trace."""
    sections = (
        _answer(found),
        _where(found),
        _errors(found),
        _effects(found),
        _open(found),
        _way(found),
        _change(found),
        Section("What the words mean", points=GLOSSARY),
    )
    title = f"Trace of {found.original.title or found.original.file.name}"
    return Report(title, tuple(section for section in sections if section is not None))


def _answer(found: Found) -> Section:
    return Section(
        "What was found",
        (found.paragraph,) if found.paragraph else (),
        points=(*(line.strip() for line in answer_lines(found)), *map(sentence, found.words)),
    )


def _errors(found: Found) -> Section | None:
    if not found.errors and not found.curves:
        return None
    windowed = any(len(c.windowed_before) == len(c.t) for c in found.curves)
    figures = (
        *_figure(bool(found.curves), found, plot_free_runs, "free_runs.png",
                 "Free runs before and after, against the measurement"),
        *_figure(windowed, found, plot_residuals, "residuals.png",
                 "The residual within windows in units of the noise; a white line is where a "
                 "window begins"),
    )  # fmt: skip
    return Section("How well it predicts", (ERRORS,), (errors_table(found),), figures=figures)


def _effects(found: Found) -> Section | None:
    tables = tuple(t for t in (effects_table(found), moved_table(found)) if t.rows)
    figures = _figure(
        bool(found.forces), found, plot_forces, "forces.png",
        "What the data need at a place over its coordinate and rate, and the fitted effects",
    )  # fmt: skip
    if not tables and not figures:
        return None
    words = (MOVED,) if any(map(stood_in, found.moved)) else ()
    return Section("The effects", words, tables, figures=figures)


def _where(found: Found) -> Section | None:
    if not found.dependences:
        return None
    missing = found.missing
    drawn = missing is not None and len(missing.grid) in (1, 2)
    figures = (
        *_figure(True, found, plot_where, "where.png", "Where, and on what"),
        *_figure(drawn, found, plot_missing, "missing.png", "What is missing"),
    )
    words = (WHERE, MISSING) if drawn else (WHERE,)
    return Section("Where, and on what it depends", words, (where_table(found),), "", figures)


def _open(found: Found) -> Section | None:
    tables = tuple(
        t for t in (ties_table(found), experiments_table(found), power_table(found)) if t.rows
    )
    figures = (
        *_figure(len(found.confusable[0]) > 1, found, plot_confusable, "confusable.png",
                 "Likeness of effects on these data"),
        *_figure(any(map(drawable, found.experiments)), found, plot_experiments, "experiments.png",
                 "Experiments that would separate effects; a star marks the best"),
    )  # fmt: skip
    if not tables and not figures:
        return None
    words = [TIES] if figures or any(e.ties for e in found.effects) else []
    words += [POWER] if found.power else []
    points = tuple(sentence(e.words) for e in found.experiments)
    return Section("What these data leave open", tuple(words), tables, "", figures, points)


def _way(found: Found) -> Section:
    table = tried_table(found)
    figures = _figure(
        bool(table.rows), found, plot_candidates, "candidates.png",
        "What each effect promised and gave, and how much of it the declared parameters imitate",
    )  # fmt: skip
    tables = (table,) if table.rows else ()
    return Section("How it was found", (STEPS,), tables, "\n".join(step_lines(found)), figures)


def _change(found: Found) -> Section | None:
    if not found.patch:
        return None
    return Section("The change of the diagram", code=found.patch)


def _figure(
    wanted: bool, found: Found, draw: Callable[[Found, Path], Path], name: str, caption: str
) -> tuple[Figure, ...]:
    return (Figure(f"trace_{name}", caption, partial(draw, found)),) if wanted else ()
