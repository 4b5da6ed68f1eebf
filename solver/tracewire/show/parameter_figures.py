"""Figures of what was fitted: parameters with intervals, correlation, convergence."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tracewire.errors import OptionError, Problem
from tracewire.fit import Fit
from tracewire.show.limits import FIGURE, FIT
from tracewire.show.style import (
    AFTER,
    BEFORE,
    LINES,
    MARK,
    QUIET,
    cut,
    panels,
    save,
    shortened,
    styled,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PLACES = (
    "value, its 95 % interval (bar) and the value before (hollow),\n"
    "between the bounds where these are given"
)
WIDTHS = "half of the 95 % interval in % of the value\n(left is well known)"

Interval = tuple[float, float]


def plot_parameters(fit: Fit, path: str | Path) -> Path:
    """Draw the fitted parameters: where each lies, and how well the data determine it.

    Left: each value (full mark) with its 95 % interval, and the value before (hollow mark),
    between its bounds, or where these are open on a scale of its own. Right: half of the interval
    in percent of the value. Raises OptionError: no parameters, another ending of the file; OSError.
    """
    names = list(fit.values)
    if not names:
        raise OptionError([Problem("a figure of no parameters cannot be drawn")])
    title = shortened("Parameters", len(names), FIT.most_parameters, "parameters")
    shown = names[: FIT.most_parameters]
    with styled():
        from matplotlib.figure import Figure

        figure = Figure(figsize=(FIGURE.width, 0.32 * len(shown) + 1.5), layout="constrained")
        left, right = figure.subplots(1, 2, sharey=True, width_ratios=[3, 2])
        figure.suptitle(title, fontsize=12, x=0.01, ha="left")
        for row, name in enumerate(shown):
            _draw_place(left, row, fit, name)
            _draw_width(right, row, fit, name)
        left.set_yticks(range(len(shown)), [cut(name) for name in shown])
        left.set_ylim(len(shown) - 0.5, -0.5)
        left.set_xlim(-0.16, 1.16)
        left.set_xticks([])
        left.set_title(PLACES, loc="left", fontsize=9)
        right.set_title(WIDTHS, loc="left", fontsize=9)
        right.set_xscale("log")
        _limit_percent(right, fit, shown)
        for panel in (left, right):
            panel.grid(False)
            panel.tick_params(axis="y", length=0)
            panel.spines["left"].set_visible(False)
        left.spines["bottom"].set_visible(False)
        return save(figure, path)


def _draw_place(panel: Axes, row: int, fit: Fit, name: str) -> None:
    value, began, bounds = fit.values[name], fit.began[name], fit.bounds[name]
    interval = fit.intervals.get(name, (math.nan, math.nan))
    known = all(map(math.isfinite, interval))
    closed = all(map(math.isfinite, bounds)) and bounds[0] < bounds[1]
    low, high = bounds if closed else _hull(value, began, interval if known else None)

    def at(x: float) -> float:
        return (x - low) / (high - low)

    panel.plot([0, 1], [row, row], color="#D5D5D5", linewidth=1.2, zorder=1,
               linestyle="-" if closed else ":")  # fmt: skip
    if closed:
        panel.plot([0, 1], [row, row], "|", color=QUIET, markersize=7, zorder=1)
        for x, end, side in ((-0.03, low, "right"), (1.03, high, "left")):
            panel.text(x, row, f"{end:.3g}", fontsize=7.5, color=QUIET, ha=side, va="center")
    if known:
        ends = [at(interval[0]), at(interval[1])]
        inside = np.clip(ends, 0.0, 1.0)
        panel.plot(inside, [row, row], color=AFTER, linewidth=5, alpha=0.45, zorder=2,
                   solid_capstyle="butt")  # fmt: skip
        for beyond, x, mark in ((ends[0] < 0, 0.0, "<"), (ends[1] > 1, 1.0, ">")):
            if beyond:  # the interval goes on where the scale ends
                panel.plot([x], [row], mark, color=AFTER, markersize=6, zorder=2)
    panel.plot([at(began)], [row], "o", markerfacecolor="white", markeredgecolor=BEFORE,
               markeredgewidth=1.4, markersize=6.5, zorder=3)  # fmt: skip
    panel.plot([at(value)], [row], "o", color=AFTER if known else MARK, markersize=4.5, zorder=4)


def _hull(value: float, began: float, interval: Interval | None) -> Interval:
    """A scale that holds the value, the one before, and the interval if it is not much wider."""
    points = [value, began]
    extent = abs(value - began) or abs(value) or 1.0
    if interval is not None:
        points += [max(interval[0], value - 3 * extent), min(interval[1], value + 3 * extent)]
    low, high = min(points), max(points)
    margin = 0.1 * (high - low) or 0.5 * extent
    return low - margin, high + margin


def _draw_width(panel: Axes, row: int, fit: Fit, name: str) -> None:
    percent = _percent(fit, name)
    if percent is None:
        panel.text(0.02, row, unknown_width(fit, name), transform=panel.get_yaxis_transform(),
                   color=MARK, fontsize=9, va="center")  # fmt: skip
        return
    panel.plot([1e-12, percent], [row, row], color="#D5D5D5", linewidth=1.2, zorder=1)
    panel.plot([percent], [row], "o", color=AFTER, markersize=4.5, zorder=2)
    text = f"{percent:.0f} %" if percent >= 100 else f"{percent:.2g} %"
    panel.annotate(text, (percent, row), xytext=(6, 0), textcoords="offset points",
                   fontsize=8, va="center", color="#444444")  # fmt: skip


def unknown_width(fit: Fit, name: str) -> str:
    """Why a value has no interval, in a word or three."""
    if name in fit.uncertainty.unmoved:
        return "no effect on the data"
    return "at its bound" if name in fit.uncertainty.at_bounds else "not determined"


def _percent(fit: Fit, name: str) -> float | None:
    """Half of the interval in percent of the value; None where either is not known."""
    low, high = fit.intervals.get(name, (math.nan, math.nan))
    half, value = (high - low) / 2, abs(fit.values[name])
    return 100 * half / value if math.isfinite(half) and value > 0 else None


def _limit_percent(panel: Axes, fit: Fit, names: list[str]) -> None:
    from matplotlib.ticker import LogLocator

    found = [p for name in names if (p := _percent(fit, name)) is not None and p > 0]
    low, high = (min(found), max(found)) if found else (0.1, 10.0)
    panel.set_xlim(low / 3, max(high, 3 * low) * 6)
    panel.xaxis.set_major_locator(LogLocator(numticks=4))
    panel.xaxis.set_major_formatter(lambda x, _: f"{x:g} %")
    panel.minorticks_off()
    panel.xaxis.set_visible(bool(found))
    panel.spines["bottom"].set_visible(bool(found))


def plot_correlation(fit: Fit, path: str | Path) -> Path:
    """Draw the correlation of the fitted values as a map with numbers; grey is not known.

    Raises OptionError: fewer than two parameters, another ending of the file; OSError.
    """
    found = fit.uncertainty
    if len(found.names) < 2:
        hint = "Free a second parameter."
        raise OptionError([Problem("a correlation needs two parameters", hint=hint)])
    names = [cut(name, 18) for name in found.names[: FIT.most_parameters]]
    count = len(names)
    matrix = np.array(found.correlation)[:count, :count]
    side = float(np.clip(0.5 * count + 2.0, 4.0, FIGURE.width))
    with styled():
        from matplotlib import colormaps
        from matplotlib.figure import Figure

        figure = Figure(figsize=(side + 0.8, side), layout="constrained")
        panel = figure.subplots()
        np.fill_diagonal(matrix, np.where(np.isnan(np.diag(matrix)), np.nan, 0.0))  # says nothing
        colors = colormaps["RdBu_r"].with_extremes(bad="#DDDDDD")
        image = panel.imshow(np.ma.masked_invalid(matrix), cmap=colors, vmin=-1, vmax=1)
        _write_numbers(panel, matrix)
        panel.set_xticks(range(count), names, rotation=50, ha="right", rotation_mode="anchor")
        panel.set_yticks(range(count), names)
        panel.tick_params(length=0)
        panel.grid(False)
        for spine in panel.spines.values():
            spine.set_visible(False)
        figure.colorbar(image, shrink=0.7, ticks=[-1, -0.5, 0, 0.5, 1])
        title = shortened("Correlation", len(found.names), FIT.most_parameters, "parameters")
        figure.suptitle(title, fontsize=12, x=0.01, ha="left")
        return save(figure, path)


def _write_numbers(panel: Axes, matrix: NDArray[np.float64]) -> None:
    count = len(matrix)
    for row in range(count):
        for column in range(count):
            value = float(matrix[row, column])
            if not math.isfinite(value):
                text = "–"
            elif count > FIT.most_numbers or row == column:
                continue
            elif abs(value) >= FIT.strong:  # 1.00 would say that it is a tie
                text = f"{value:.4f}".replace("0.", ".")
            else:
                text = f"{value:.2f}".replace("0.", ".")
            color = "white" if abs(value) > 0.6 else "#333333"
            text = text.replace("-", "−")
            panel.text(column, row, text, ha="center", va="center", color=color,
                       fontsize=7.5 if count > 9 else 8.5)  # fmt: skip


def plot_convergence(fit: Fit, path: str | Path) -> Path:
    """Draw the best criterion, and how far each value was from its last, over the evaluations.

    Raises OptionError: the fit kept no history, another ending of the file; OSError.
    """
    if not fit.history:
        raise OptionError([Problem("the fit has no history of its search to draw")])
    count = np.array([entry.evaluations for entry in fit.history], dtype=float)
    best = np.array([entry.criterion for entry in fit.history])
    title = shortened("Convergence", len(fit.values), FIT.most_paths, "parameters")
    end = max(float(fit.evaluations), float(count[-1]))
    with styled():
        figure, axes = panels([2.2, 2.8] if fit.values else [2.2], title)
        upper = axes[0]
        upper.step([*count, end], [*best, best[-1]], where="post", color=AFTER)
        upper.plot(count, best, ".", color=AFTER, markersize=4)
        if (best > 0).all():
            upper.set_yscale("log")
            upper.yaxis.set_major_formatter(lambda x, _: f"{x:g}")
            few = best.max() < 30 * best.min()
            upper.yaxis.set_minor_formatter(lambda x, _: _minor(x) if few else "")
        upper.set_ylabel("best criterion")
        for panel in axes[1:]:
            _draw_values(panel, [entry.values for entry in fit.history], count, end)
        axes[-1].set_xlabel("evaluations of the criterion")
        axes[-1].set_xlim(0, end or 1.0)
        figure.align_ylabels(axes)
        return save(figure, path)


def _minor(x: float) -> str:
    """The text of a tick between the decades: of 2 and 5 only."""
    text = f"{x:g}"
    return text if text.lstrip("0.")[:1] in ("2", "5") else ""


def _draw_values(
    panel: Axes,
    history: list[Mapping[str, float]],
    count: NDArray[np.float64],
    end: float,
) -> None:
    names = list(history[-1])
    most = 24 if len(names) <= 14 else 18
    styles = ("-", "--", "-.", ":")
    for n, name in enumerate(names[: FIT.most_paths]):
        values = np.array([entry[name] for entry in history])
        # a value that ends near zero, such as an offset, is measured by the largest it had
        size = abs(values[-1])
        largest = float(np.abs(values).max())
        size = size if size > 1e-3 * largest else largest
        percent = 100 * (values - values[-1]) / (size or 1.0)
        panel.step([*count, end], [*percent, percent[-1]], where="post",
                   color=LINES[n % len(LINES)], linewidth=1.1,
                   linestyle=styles[n // len(LINES) % len(styles)],
                   label=cut(name, most))  # fmt: skip
    panel.axhline(0, color=QUIET, linewidth=0.7)
    panel.set_yscale("symlog", linthresh=1.0)
    panel.yaxis.set_major_formatter(lambda x, _: f"{x:g} %")
    panel.set_ylabel("off the last value")
    panel.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8, handlelength=2.6,
                 ncols=1 if len(names) <= 14 else 2)  # fmt: skip
