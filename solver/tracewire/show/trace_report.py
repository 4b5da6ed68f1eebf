"""The report of a trace: what is missing, how it was found, what that predicts, what is open."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from tracewire.show.diagram_picture import traced_figure
from tracewire.show.document import Figure, Report, Section
from tracewire.show.fit_tables import sentence
from tracewire.show.trace_experiments import experiment_words
from tracewire.show.trace_figures import plot_candidates, plot_free_runs, plot_residuals
from tracewire.show.trace_law import has_law, plot_forces, plot_law
from tracewire.show.trace_maps import (
    drawable,
    plot_confusable,
    plot_experiments,
    plot_missing,
    plot_remainder_where,
    plot_where,
)
from tracewire.show.trace_shares import plot_held_out
from tracewire.show.trace_steps import compares, decided_words
from tracewire.show.trace_summary import details_of, headline_of
from tracewire.show.trace_tables import (
    compared_table,
    effects_table,
    errors_table,
    experiments_table,
    moved_table,
    power_table,
    remainder_table,
    remainder_where_table,
    ties_table,
    tried_table,
    where_table,
)
from tracewire.show.trace_text import answer_lines, remarks_of, step_lines
from tracewire.show.trace_untried import untried
from tracewire.show.trace_words import both_of, stood_in
from tracewire.trace import Found

ERRORS = (
    "A free run is one run over the whole series, so small errors add up. A windowed error is that "
    "of many short runs, each from a fitted start. Only series of the use `validate` played no "
    "part in the fit and in the choice of effects: they are the honest test. σ is the noise of the "
    "sensor, as declared or as estimated from the data."
)
EFFECTS = (
    "The interval holds the value with 95 % probability if the noise is white. 'masked' is the "
    "part of the effect that the declared parameters imitate when they are fitted. 'gain' is half "
    "the fall of BIC, a measure of the fit that charges for each further number; 5 is strong. It "
    "is that of the step that found the effect, and is left out where the effect was found beside "
    "one that is not named in the end."
)
SHARES = (
    "Held-out blocks of time were predicted by models that were fitted without them. The excess "
    "error is what the declared model leaves above the floor, which is the error of the best "
    "smooth function of position, rate and direction. The explained share is the part of the "
    "excess that the effects take away: 100 % reaches the floor, 0 % is no better than without "
    "them."
)
REMAINDER = (
    "This is what the diagram with its effects still misses on held-out blocks of time, each of "
    "which was predicted by a model that was fitted without it. The errors of free runs over whole "
    "series are below. The floor is what a smooth function of position, rate and direction would "
    "leave."
)
STEPS = (
    "In each step the screen estimates, from one linearisation, the gain of every effect of the "
    "library at every place of the diagram. A place is a sum of forces, a drive or a sensor. The "
    "best effects are put into the diagram and all free parameters are fitted again. An effect is "
    "accepted only if it reduces the error on windows that the fit did not see: the gate. "
    "A step that compares models decides in the end: it fits them to longer windows, and takes the "
    "one of fewest numbers that predicts held-out blocks of time as well as the best. Its gain is "
    "another one than that of the steps before."
)
MOVED = (
    "A declared parameter that moves by more than two standard errors had absorbed part of the "
    "missing effect: without the effect its value is biased."
)
TIES = (
    "The map shows how alike the outputs of two effects are on these data. The likeness is their "
    "correlation in the screen: 1 is the same. A pair that is outlined is no tie where a refit on "
    "longer windows tells the two apart. Of a tie only another experiment can tell which it is."
)
TOGETHER = (
    "The effects that are named together may be alike, too: they are named because both together "
    "predict held-out blocks better than each of them alone."
)
POWER = (
    "A coefficient of this size is five standard errors: these data would have shown it. A "
    "smaller one may be there unseen."
)
WHERE = (
    "At each place a smooth function of each set of variables was fitted to the residual, and "
    "tested on parts of the data that it was not fitted to. A large share says where something is "
    "missing, and on what it depends. The outline marks the smallest set of variables that is "
    "nearly the best. q, v and a are the coordinate, rate and acceleration at the place, u is the "
    "drive, y the measured signal."
)
MISSING = (
    "This curve is empirical: it says what these data need, and not why. It says nothing where "
    "there are no samples. `tracewire trace ... --table FILE.csv` writes it for a `table` block."
)
GLOSSARY = (
    "s2: squared residual per degree of freedom in units of the noise; 1 is at the noise.",
    "gain: half the fall of BIC, a measure of the fit that charges for each further parameter; 5 "
    "is strong, 0 is nothing.",
    "gain of prediction: the mean fall of the logarithm of the error on held-out blocks, times the "
    "number of blocks; 0 is the declared model.",
    "weight: the share of an effect among those that were tried beside it, from their BIC.",
    "masked: the part of an effect's signature that the declared parameters imitate when they are "
    "fitted; at 100 % it could not be seen at all.",
    "likeness: how alike the signatures of two effects are, once all that is fitted is taken out "
    "of them; 1 is the same.",
    "excess: what the squared residual has above that of noise alone.",
)


def trace_report(found: Found) -> Report:
    """The report of a trace: the answer first, then how sure it is, then the way to it."""
    sections = (
        _answer(found),
        _effects(found),
        _shares(found),
        _remainder(found),
        _where(found),
        Section("In words", points=(*details_of(found), *map(sentence, remarks_of(found)))),
        _errors(found),
        _open(found),
        _way(found),
        _change(found),
        Section("What the words mean", points=GLOSSARY),
    )
    title = f"Trace of {found.original.title or found.original.file.name}"
    return Report(title, tuple(section for section in sections if section is not None))


def _answer(found: Found) -> Section:
    figures: tuple[Figure, ...] = (traced_figure(found),)
    figures += _figure(
        has_law(found), found, plot_law, "law.png",
        "The force that the data need, and the law that was found",
    )  # fmt: skip
    missing = found.missing
    figures += _figure(
        missing is not None and len(missing.grid) in (1, 2), found, plot_missing, "missing.png",
        "What is missing, as a smooth function of what it depends on",
    )  # fmt: skip
    # an unexplained residual is told by the headline, in the same words
    verdict = (
        f"VERDICT {found.verdict}" if found.verdict == "unexplained" else answer_lines(found)[0]
    )
    return Section("What was found", (headline_of(found), verdict), figures=figures)


def _shares(found: Found) -> Section | None:
    figures = _figure(
        bool(found.held_out), found, plot_held_out, "shares.png",
        "The error of each held-out block: declared model, with the effects, and the floor",
    )  # fmt: skip
    return (
        Section("How much of the error is explained", (SHARES,), figures=figures)
        if figures
        else None
    )


def _remainder(found: Found) -> Section | None:
    tables = tuple(t for t in (remainder_table(found), remainder_where_table(found)) if t.rows)
    figures = _figure(
        bool(found.remainder_depends), found, plot_remainder_where, "remainder.png",
        "Where the rest is, and on what it depends",
    )  # fmt: skip
    return Section("What is left", (REMAINDER,), tables, figures=figures) if tables else None


def _errors(found: Found) -> Section | None:
    if not found.errors and not found.curves:
        return None
    windowed = any(len(c.windowed_before) == len(c.t) for c in found.curves)
    figures = (
        *_figure(bool(found.curves), found, plot_free_runs, "free_runs.png",
                 "Free runs before and after, against the measurement; the band is ±2 σ"),
        *_figure(windowed, found, plot_residuals, "residuals.png",
                 "The residual within windows in units of the noise, on linear scales; a white "
                 "line is where a window begins, the dotted lines are ±2 σ"),
    )  # fmt: skip
    return Section("How well it predicts", (ERRORS,), (errors_table(found),), figures=figures)


def _effects(found: Found) -> Section | None:
    tables = tuple(t for t in (effects_table(found), moved_table(found)) if t.rows)
    figures = _figure(
        has_law(found), found, plot_forces, "forces.png",
        "What the data need at a place over its coordinate and its rate, and the fitted law",
    )  # fmt: skip
    if not tables and not figures:
        return None
    words = (EFFECTS, MOVED) if any(map(stood_in, found.moved)) else (EFFECTS,)
    return Section("The effects", words if found.effects else (), tables, figures=figures)


def _where(found: Found) -> Section | None:
    if not found.dependences:
        return None
    figures = _figure(True, found, plot_where, "where.png", "Where, and on what")
    drawn = found.missing is not None and len(found.missing.grid) in (1, 2)
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
    left = untried(found) & {f"{p.name} @ {p.place}" for p in found.power}
    were = "was" if len(left) == 1 else "were"
    words = [TIES] if figures or any(e.ties for e in found.effects) else []
    if len(found.effects) > 1 and any(map(compares, found.steps)):
        words += [TOGETHER]
    words += [POWER] if found.power else []
    words += [f"Not among them: {both_of(sorted(left))}, which {were} not tried."] if left else []
    points = tuple(experiment_words(found, e) for e in found.experiments)
    return Section("What these data leave open", tuple(words), tables, "", figures, points)


def _way(found: Found) -> Section:
    table = tried_table(found)
    figures = _figure(
        bool(table.rows), found, plot_candidates, "candidates.png",
        "What each effect promised and gave, and how much of it the declared parameters imitate",
    )  # fmt: skip
    tables = tuple(t for t in (table, compared_table(found)) if t.rows)
    words = tuple(text for text in (STEPS, decided_words(found)) if text)
    return Section("How it was found", words, tables, "\n".join(step_lines(found)), figures)


def _change(found: Found) -> Section | None:
    if not found.patch:
        return None
    return Section("The change of the diagram", code=found.patch)


def _figure(
    wanted: bool, found: Found, draw: Callable[[Found, Path], Path], name: str, caption: str
) -> tuple[Figure, ...]:
    return (Figure(name, caption, partial(draw, found)),) if wanted else ()
