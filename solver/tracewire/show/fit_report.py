"""The report of a fit: what was fitted to what, what came out, how sure it is, how to repeat it."""

from __future__ import annotations

import math
import platform
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from tracewire.fit import Fit, Profile, diagnose
from tracewire.library import SENSOR_TERMS
from tracewire.residual import Measured, Sensor
from tracewire.show.comparison_figures import plot_comparisons
from tracewire.show.diagnostic_figures import plot_diagnostics, plot_profiles
from tracewire.show.diagram_picture import diagram_figure
from tracewire.show.document import Figure, Report, Section
from tracewire.show.fit_tables import (
    comparison_table,
    fit_table,
    fit_text,
    identifiability_words,
    remark_words,
    residual_words,
    sentence,
    starts_table,
    tied_table,
    unfinished_words,
)
from tracewire.show.limits import FIT
from tracewire.show.parameter_figures import plot_convergence, plot_correlation, plot_parameters
from tracewire.show.table import Table, shown

ERRORS = (
    "The standard error says how much a value would scatter if the same experiment were repeated "
    "with new noise; the 95 % interval would hold the true value in 95 of 100 such experiments, "
    "if the diagram is right."
)
LEFT = (
    "If the diagram is right, what is left is noise: as large as that of the sensor, white (no "
    "sample tells of the next), and independent of the inputs. Where it is not, something is "
    "missing in the diagram, and the intervals, which suppose that it is right, are too small."
)
PROFILED = (
    "A value is held at some distance from its best, all others are fitted again, and the fit "
    "worsens by as much as drawn. Where that stays below the dotted level the data allow the value "
    "(95 %). Unlike the standard error this sees that the fit may worsen more to one side."
)
GLOSSARY = (
    "criterion: what the fit makes small, the sum over series and signals of mean(residual²)/2; "
    "residuals count in σ where σ is declared, in SI elsewhere.",
    "residual: measured minus simulated; rmse is the root of its mean square.",
    "σ: the standard deviation of the noise of a sensor. An error of 1 σ is as good as the data "
    "allow; much more, and the diagram lacks something; much less, and σ is declared too large.",
    "correlation: how the errors of two values hang together, from -1 to 1. Near 1 or -1 the data "
    "know a combination of the two much better than each alone.",
    "not determined: the simulated signals look the same when this value changes together with "
    "others, or the data do not depend on it at all.",
    "train: series that the fit saw. validate: series that it did not see, the honest test.",
)


def fit_report(fit: Fit, profiles: Sequence[Profile] = ()) -> Report:
    """The report of a fit, with those profile likelihoods that were computed."""
    sections = (
        Section("The diagram", figures=(diagram_figure(fit.model.diagram),)),
        _result(fit),
        _determined(fit),
        _compared(fit),
        _left(fit),
        *([_profiled(profiles)] if profiles else []),
        _search(fit),
        _data(fit),
        _repeat(fit),
        Section("What the words mean", points=GLOSSARY),
    )
    return Report(f"Fit of {fit.model.flat.title}", sections)


def _result(fit: Fit) -> Section:
    series: dict[str, list[str]] = {}
    for m in fit.measured:
        series.setdefault(m.use, []).append(m.name)
    used = "; ".join(f"{use}: {', '.join(names)}" for use, names in series.items())
    fitted = f"{len(fit.values)} values" if fit.values else "Only the start values"
    what = (
        f"{fitted} of the diagram {fit.model.diagram.file} were fitted to measured series ({used})."
    )
    ended = () if fit.exitflag == 1 else (ENDINGS.get(fit.exitflag, ENDINGS[0]),)
    tables = tuple(t for t in (fit_table(fit), tied_table(fit), starts_table(fit)) if t.rows)
    figures = (
        Figure("parameters.png", "Fitted values and their 95 % intervals",
               partial(plot_parameters, fit)),
    ) if fit.values else ()  # fmt: skip
    words = (
        what,
        fit_text(fit),
        *unfinished_words(fit),
        *ended,
        *([ERRORS] if fit.values else []),
    )
    return Section("Result", words, tables, figures=figures, points=remark_words(fit))


ENDINGS = {
    0: "A limit ended the search before it converged: these are the best values so far, a longer "
    "search may find better ones, and their errors are those of the point where it stopped.",
    -1: "The search was stopped before it converged: these are the best values so far.",
}


def _determined(fit: Fit) -> Section:
    found = fit.uncertainty
    open_ones = [name for name in fit.values if not math.isfinite(fit.errors.get(name, math.nan))]
    if open_ones:
        first = (
            f"{len(open_ones)} of {len(fit.values)} values have no interval: "
            f"{', '.join(open_ones)}. The words below say why, and what can be done."
        )
    else:
        first = "The data determine every fitted value." if fit.values else "No value is free."
    colored = [f"{signal} of {series}" for (series, signal), n in found.orders.items() if n > 0]
    words = [first]
    if colored:
        words.append(
            f"The residual of {', '.join(colored)} is correlated in time; the standard errors take "
            "that into account, so they are larger than those of white noise."
        )
    pairs = _alike(fit)
    if pairs:
        words.append(
            f"Strongly correlated: {'; '.join(pairs)}. The data know a combination of such values "
            "better than each alone."
        )
    known = len(fit.values) - len(open_ones)
    figure = Figure("correlation.png", "Correlation of the errors", partial(plot_correlation, fit))
    return Section(
        "What the data determine",
        tuple(words),
        points=identifiability_words(fit),
        figures=(figure,) if known > 1 else (),
    )


def _alike(fit: Fit) -> list[str]:
    """The pairs of values whose errors hang together most."""
    names, matrix = fit.uncertainty.names, fit.uncertainty.correlation
    pairs = [
        (float(matrix[i, j]), names[j], names[i])
        for i in range(len(names))
        for j in range(i)
        if abs(matrix[i, j]) > FIT.correlated
    ]
    pairs.sort(key=lambda pair: -abs(pair[0]))
    told = [f"{one} and {other} ({value:.4g})" for value, one, other in pairs[: FIT.most_pairs]]
    more = len(pairs) - FIT.most_pairs
    return told + ([f"{more} more pairs"] if more > 0 else [])


def _compared(fit: Fit) -> Section:
    validated = any(c.use != "train" for c in fit.comparisons)
    words = (
        "Samples before the one from which a series counts are pale; the errors leave them out."
        if any(not c.counts.all() for c in fit.comparisons)
        else "",
        "" if validated else
        "Every series was used for the fit: none tests it. Mark one with use: validate.",
    )  # fmt: skip
    figure = Figure("fit.png", "Measured against simulated", partial(plot_fitted, fit))
    return Section(
        "Measured against simulated",
        tuple(word for word in words if word),
        (comparison_table(fit),),
        figures=(figure,) if fit.comparisons else (),
    )


def plot_fitted(fit: Fit, path: Path) -> Path:
    """Measured against simulated before and after, a panel for each signal and series."""
    return plot_comparisons(path, fit.comparisons, fit.model.flat.title)


def _left(fit: Fit) -> Section:
    found = diagnose(fit)
    words = residual_words(fit, found)
    if not words:
        few = "No signal has enough samples that count to tell whether its residual is noise."
        return Section("What is left", (few,))
    figure = Figure("residual.png", "The residual after the fit",
                    partial(plot_diagnostics, fit, found=found))  # fmt: skip
    return Section("What is left", (LEFT,), points=words, figures=(figure,))


def _profiled(profiles: Sequence[Profile]) -> Section:
    figure = Figure("profiles.png", "Profile likelihood", partial(plot_profiles, profiles))
    points = tuple(sentence(one.words) for one in profiles)
    return Section("Profile likelihood", (PROFILED,), points=points, figures=(figure,))


def _search(fit: Fit) -> Section:
    text = (
        f"{fit.iterations} iterations and {fit.evaluations} evaluations of the criterion; one with "
        "sensitivities counts as one plus the number of free values."
    )
    figure = Figure(
        "convergence.png", "The best criterion and its values", partial(plot_convergence, fit)
    )
    return Section("How the search went", (text,), figures=(figure,) if fit.history else ())


def _data(fit: Fit) -> Section:
    header = ("series", "use", "file", "preset", "samples", "from [s]", "to [s]", "counts from [s]",
              "weight")  # fmt: skip
    rows = tuple(
        (m.name, m.use, _beside(m.file, fit), m.preset, str(len(m.t)), shown(float(m.t[0])),
         shown(float(m.t[-1])), shown(m.counts_from) if math.isfinite(m.counts_from) else "",
         shown(m.weight))
        for m in fit.measured
    )  # fmt: skip
    series = Table("series", header, rows, frozenset({4, 5, 6, 7, 8})).without_empty()
    points = [
        f"{m.name}: {sentence(step)}"
        for m in fit.measured
        for step in m.steps or ("nothing was changed since the file was read",)
    ]
    words = "Every step that changed the data since they were read stands here, in its order."
    return Section("The data", (words,), (series, _signals_table(fit)), points=tuple(points))


def _beside(file: str, fit: Fit) -> str:
    """The path of a file as the diagram names it, where it is below the diagram's folder."""
    folder = fit.model.diagram.file.parent
    path = Path(file)
    return str(path.relative_to(folder)) if path.is_relative_to(folder) else file


def _signals_table(fit: Fit) -> Table:
    rows = []
    for m in fit.measured:
        for signal in m.values:
            unit, factor = fit.model.users_unit(signal)
            sigma = m.sigma.get(signal)
            noise = "not declared" if sigma is None else shown(sigma / factor)
            weight = shown(m.weights.get(signal, 1.0))
            rows.append(
                (m.name, signal, unit, noise, _sensor_text(m, signal, unit, factor), weight)
            )
    header = ("series", "signal", "unit", "σ", "how it is compared", "weight")
    return Table("measured signals", header, tuple(rows), frozenset({3, 5}))


def _sensor_text(series: Measured, signal: str, unit: str, factor: float) -> str:
    """What a sensor does to a signal, which the user has in `unit`."""
    sensor, plain = series.sensor(signal), Sensor()
    parts = []
    for kind, term in SENSOR_TERMS.items():
        value = getattr(sensor, kind)
        if kind in sensor.free:
            parts.append(f"{kind} fitted")
        elif value != getattr(plain, kind):
            parts.append(f"{kind} {value / term.factor(factor):g} {term.unit_of(unit)}".rstrip())
    if period := series.periods.get(signal):
        parts.append(f"modulo {period / factor:g} {unit}".rstrip())
    return ", ".join(parts) or "as it is"


def _repeat(fit: Fit) -> Section:
    import scipy

    from tracewire.solve import parameter_values

    version = vars(sys.modules["tracewire"])["__version__"]
    free = [name for name in fit.values if name in fit.model.flat.parameters]
    declared = parameter_values(fit.model, {})
    begun = {name: fit.began[name] for name in free if fit.began[name] != declared[name]}
    begun |= {name: value for name, value in fit.parameters.items() if name not in begun}
    arguments = [
        "model",
        f'method="{fit.method}"',
        f"free={free!r}",
        *([f"parameters={begun!r}"] if begun else []),
        *([f'loss="{fit.loss}"'] if fit.loss != "linear" else []),
        f"seed={fit.seed}",
        f"rtol={fit.rtol!r}",
    ]
    code = (
        "import tracewire as tw\n\n"
        f"model = tw.compile(tw.read({str(fit.model.diagram.file)!r}))\n"
        f"fit = tw.fit(\n    {f',{chr(10)}    '.join(arguments)},\n)\n"
        'tw.report(fit).write("report.html")\n'
    )
    text = (
        f"With the same files this gives the same numbers: tracewire {version}, Python "
        f"{platform.python_version()}, numpy {np.__version__}, scipy {scipy.__version__}. Limits "
        "and options of the search that were given are to be given again."
    )
    return Section("How to repeat it", (text,), code=code)
