"""Maps of a trace: where and on what, what is missing, what is alike, what would separate it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tracewire.array_types import Matrix
from tracewire.show.limits import MAP
from tracewire.show.style import (
    AFTER,
    BAND,
    BEFORE,
    MARK,
    QUIET,
    cut,
    plain_numbers,
    save,
    styled,
    with_unit,
)
from tracewire.show.trace_experiments import setting_unit
from tracewire.show.trace_words import percent
from tracewire.trace import Dependence, Experiment, Found, Missing, signal_of, unit_at, users_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

SHARES, ALIKE, SEPARATION = "Blues", "Purples", "cividis"
SLANTED: dict[str, Any] = {"rotation": 35, "ha": "right", "rotation_mode": "anchor"}


def plot_where(found: Found, path: Path) -> Path:
    """The share of the excess that a smooth force explains, by place and variables."""
    best = found.missing
    return _plot_shares(found.dependences, path, (best.place, best.variables) if best else None)


def plot_remainder_where(found: Found, path: Path) -> Path:
    """The share of what is left that a smooth force explains, by place and variables."""
    return _plot_shares(found.remainder_depends, path)


def _plot_shares(
    dependences: Sequence[Dependence], path: Path, best: tuple[str, tuple[str, ...]] | None = None
) -> Path:
    places = list(dict.fromkeys(d.place for d in dependences))
    sets = list(dict.fromkeys(d.variables for d in dependences))
    shares = np.full((len(places), len(sets)), np.nan)
    for d in dependences:
        shares[places.index(d.place), sets.index(d.variables)] = d.share
    with styled():
        figure, panel = _square(2.4 + 0.85 * len(sets), 1.6 + 0.5 * len(places))
        shown = np.clip(shares, 0, 1)
        picture = panel.imshow(shown, cmap=SHARES, vmin=0, vmax=1, aspect="auto")
        for (row, column), share in np.ndenumerate(shares):
            if np.isfinite(share):
                text = percent(max(share, 0))
                color = "white" if share > MAP.dark else "#333333"
                panel.text(column, row, text, ha="center", va="center", color=color)
        if best is not None and best[1] in sets and best[0] in places:
            _outline(panel, (sets.index(best[1]), places.index(best[0])))
        labels = [cut(", ".join(names), 18) for names in sets]
        if max(map(len, labels)) > MAP.short:
            panel.set_xticks(range(len(sets)), labels, **SLANTED)
        else:
            panel.set_xticks(range(len(sets)), labels)
        panel.set_yticks(range(len(places)), [cut(place) for place in places])
        panel.set_title("Share of the excess that a smooth function of these explains", loc="left")
        _bare(panel)
        figure.colorbar(picture, ax=panel, fraction=0.05, pad=0.02, format=lambda x, _: percent(x))
        return save(figure, path)


def plot_missing(found: Found, path: Path) -> Path:
    """The torque that is missing, over the one or two variables on which it depends, in the units
    in which the user has these."""
    missing = found.missing
    assert missing is not None
    variables = [_variable(found, missing, number) for number in range(len(missing.variables))]
    factors = [factor for _, factor in variables]
    missing = replace(
        missing, grid=tuple(x / factor for x, factor in zip(missing.grid, factors, strict=True))
    )
    with styled():
        figure, panel = _square(7.0, 4.0)
        unit = unit_at(found, missing.place)
        label = with_unit(f"missing at {missing.place}", unit)
        if len(missing.variables) == 1:
            _draw_line(panel, missing)
            panel.set_ylabel(label)
        else:
            _draw_map(figure, panel, missing, label)
            panel.set_ylabel(variables[1][0])
        panel.set_xlabel(variables[0][0])
        panel.locator_params(axis="x", nbins=MAP.most_ticks)
        return save(figure, path)


def _variable(found: Found, missing: Missing, number: int) -> tuple[str, float]:
    """A variable of the map by the user's name and unit, with the factor of that to SI."""
    name = signal_of(found, missing.place, missing.variables[number])
    unit, factor = ("s", 1.0) if name == "t" else users_unit(found, name)
    return with_unit(name, unit), factor


def plot_confusable(found: Found, path: Path) -> Path:
    """How alike effects are on these data: 1 cannot be told apart by them."""
    names, matrix = found.confusable
    names, matrix = names[: MAP.most_alike], matrix[: MAP.most_alike, : MAP.most_alike]
    size = len(names)
    with styled():
        figure, panel = _square(3.6 + 0.5 * size, 2.6 + 0.42 * size)
        # what matters is how far from 1 it is: 0.9 and 0.99 differ as 0.99 and 0.999
        nines = -np.log10(np.maximum(1 - np.abs(matrix), 10.0**-MAP.most_nines))
        picture = panel.imshow(nines, cmap=ALIKE, vmin=0, vmax=MAP.most_nines, aspect="auto")
        dark = MAP.dark * MAP.most_nines
        for (row, column), value in np.ndenumerate(np.abs(matrix)):
            if row != column and np.isfinite(value):
                text = f"{value:.3f}"[1:] if value < 0.9995 else "1"
                tied = value > MAP.tied
                panel.text(column, row, text, ha="center", va="center", fontsize=8,
                           color="white" if nines[row, column] > dark else "#333333",
                           fontweight="bold" if tied else "normal")  # fmt: skip
                if tied:
                    _outline(panel, (column, row))
        labels = [cut(name, 34) for name in names]
        panel.set_yticks(range(size), labels)
        panel.set_xticks(range(size), labels, **SLANTED)
        panel.set_title(f"outlined: above {MAP.tied}", loc="left", fontsize=9)
        _bare(panel)
        bar = figure.colorbar(picture, ax=panel, fraction=0.05, pad=0.02)
        ticks = (0.0, 0.5, 0.9, 0.97, 0.99, 0.999)
        bar.set_ticks(
            [-np.log10(1 - tick) for tick in ticks], labels=[f"{tick:g}" for tick in ticks]
        )
        return save(figure, path)


def plot_experiments(found: Found, path: Path) -> Path:
    """The separation of two effects over the settings of an experiment; a star marks the best."""
    from matplotlib.figure import Figure

    chosen = [e for e in found.experiments if drawable(e)][: MAP.most_experiments]
    with styled():
        figure = Figure(figsize=(7.5, 3.6 * len(chosen) + 0.3), layout="constrained")
        grid = figure.subplots(len(chosen), 1, squeeze=False)
        for (panel,), experiment in zip(grid, chosen, strict=True):
            _draw_experiment(figure, panel, experiment, found)
        return save(figure, path)


def drawable(experiment: Experiment) -> bool:
    """Whether there is a setting that varied, and an experiment that tells the two apart."""
    return experiment.separation > MAP.alike_everywhere and bool(_settings(experiment))


def _rows(experiment: Experiment) -> list[Mapping[str, float]]:
    """What was searched of the kind of the best: releases, or sines on one drive."""
    wanted = {*experiment.settings, "separation"}
    return [row for row in experiment.map if {"separation"} < row.keys() <= wanted]


def _settings(experiment: Experiment) -> list[str]:
    """At most two settings that vary in a search, those with most values first.

    States that are released together are one setting.
    """
    rows = _rows(experiment)
    shared = [n for n in experiment.settings if rows and all(n in row for row in rows)]
    counts = {n: len({row[n] for row in rows}) for n in shared}
    names = sorted((n for n in counts if counts[n] > 1), key=lambda n: -counts[n])[:2]
    pairs = {tuple(row[n] for n in names) for row in rows}
    return names[:1] if len(names) > 1 and len(pairs) == counts[names[0]] else names


def _setting_label(name: str, found: Found) -> str:
    return with_unit(name, setting_unit(found, name))


def _draw_experiment(figure: Figure, panel: Axes, experiment: Experiment, found: Found) -> None:
    names = _settings(experiment)
    rows = _rows(experiment)
    separation = np.array([row["separation"] for row in rows])
    first = np.array([row[names[0]] for row in rows])
    best = experiment.settings
    star: dict[str, Any] = {"marker": "*", "markersize": 16, "linestyle": "", "color": MARK,
                            "markeredgecolor": "white", "clip_on": False, "zorder": 5}  # fmt: skip
    if len(names) == 1:
        order = np.argsort(first)
        panel.plot(first[order], separation[order], ".-", color=AFTER)
        panel.plot([best[names[0]]], [experiment.separation], **star)
        panel.axhline(1.0, color=QUIET, linestyle=":", linewidth=0.9)
        panel.set_ylabel("separation [σ]")
        panel.set_ylim(bottom=0)
    else:
        second = np.array([row[names[1]] for row in rows])
        from matplotlib.colors import LogNorm

        top = max(float(np.nanmax(separation)), experiment.separation, 1e-6)
        norm = LogNorm(max(float(np.nanmin(separation)), top / 1e3), top)
        dots = panel.scatter(
            first, second, c=np.maximum(separation, norm.vmin or 0), cmap=SEPARATION, norm=norm,
            s=90, marker="s",
        )  # fmt: skip
        figure.colorbar(dots, ax=panel, label="separation [σ]", format=lambda x, _: f"{x:g}")
        panel.plot([best[names[0]]], [best[names[1]]], **star)
        panel.set_ylabel(_setting_label(names[1], found))
        if _wide(second):
            panel.set_yscale("log")
            _few_numbers(panel.yaxis)
    panel.set_xlabel(_setting_label(names[0], found))
    if _wide(first):
        panel.set_xscale("log")
        _few_numbers(panel.xaxis)
    title = f"{experiment.one} or {experiment.other}: {experiment.separation:.3g} σ at the star"
    panel.set_title(title, loc="left", fontsize=9.5)


def _few_numbers(axis: Axis) -> None:
    """Write 1, 2 and 5 of each decade of a logarithmic axis."""
    from matplotlib.ticker import LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_minor_formatter(NullFormatter())
    plain_numbers(axis)


def _wide(values: Matrix) -> bool:
    """Whether a setting was searched over more than a factor of ten."""
    low = float(np.nanmin(values))
    return low > 0 and float(np.nanmax(values)) > 10 * low


def _draw_line(panel: Axes, missing: Missing) -> None:
    x, torque = missing.grid[0], np.ravel(missing.torque)
    density = np.ravel(missing.density)
    many = density > MAP.few * _usual(density)
    known = np.where(many, torque, np.nan)
    if not many.all():
        panel.plot(x, torque, color=QUIET, linewidth=1.0, linestyle="--", label="few samples")
    panel.plot(x, known, color=AFTER, linewidth=1.8, label="as the data ask for it")
    panel.axhline(0.0, color=QUIET, linewidth=0.7)
    below = panel.twinx()
    below.fill_between(x, density, color=BAND, linewidth=0, zorder=0)
    panel.fill_between([], [], color=BAND, label="samples")
    below.set_ylim(0, 4 * max(float(density.max()), 1e-300))
    below.set_axis_off()
    panel.set_zorder(below.get_zorder() + 1)
    panel.patch.set_visible(False)
    panel.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3)
    panel.set_title(f"{percent(missing.share)} of the excess", loc="left")
    panel.set_xlim(float(x[0]), float(x[-1]))


def _usual(density: Matrix) -> float:
    """The largest density that counts."""
    filled = density[density > 0]
    return min(float(filled.max()), MAP.crowded * float(np.median(filled))) if filled.size else 1.0


def _draw_map(figure: Figure, panel: Axes, missing: Missing, label: str) -> None:
    known = np.where(missing.density > MAP.few * _usual(missing.density), missing.torque, np.nan)
    largest = float(np.nanmax(np.abs(known))) if np.isfinite(known).any() else 1.0
    picture = panel.pcolormesh(
        missing.grid[0], missing.grid[1], known.T, cmap="PuOr", vmin=-largest, vmax=largest,
        shading="nearest",
    )  # fmt: skip
    figure.colorbar(picture, ax=panel, label=label)
    panel.set_title(f"{percent(missing.share)} of the excess; white: few samples", loc="left")
    panel.grid(False)


def _square(width: float, height: float) -> tuple[Figure, Axes]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(min(width, 11.0), min(height, 11.0)), layout="constrained")
    return figure, figure.subplots()


def _outline(panel: Axes, at: tuple[int, int]) -> None:
    from matplotlib.patches import Rectangle

    corner = at[0] - 0.47, at[1] - 0.47
    panel.add_patch(Rectangle(corner, 0.94, 0.94, fill=False, edgecolor=BEFORE, linewidth=2.0))


def _bare(panel: Axes) -> None:
    panel.grid(False)
    panel.tick_params(length=0)
    for side in panel.spines.values():
        side.set_visible(False)
