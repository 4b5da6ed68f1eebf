"""Figures over parameters: stability charts, sweeps."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tracewire.analyse import StabilityChart, Sweep
from tracewire.errors import OptionError, Problem
from tracewire.show.limits import FIGURE
from tracewire.show.style import LINES, cut, panels, save, styled, with_unit

if TYPE_CHECKING:
    from matplotlib.colors import Colormap

STABLE_SHADE = "#F3F6FA"


def plot_chart(chart: StabilityChart, path: str | Path) -> Path:
    """Draw where a motion is unstable over two parameters, and how fast deviations grow there.

    Blank is stable; the line is the edge. Points that failed are grey. Raises OptionError, OSError.
    """
    if chart.radius.shape[0] < 2 or chart.radius.shape[1] < 2:
        what = f"a chart of {chart.radius.shape[1]} x {chart.radius.shape[0]} points is no picture"
        raise OptionError([Problem(what, hint="Give two values of each parameter at least.")])
    with styled():
        from matplotlib.figure import Figure

        figure = Figure(figsize=(FIGURE.width * 0.85, 5.2), layout="constrained")
        panel = figure.subplots()
        panel.grid(False)
        panel.set_facecolor("#D9D9D9")
        growth = np.where(chart.unstable, chart.exponent, np.nan)
        calm = np.where(np.isfinite(chart.radius) & ~chart.unstable, 0.0, np.nan)
        panel.pcolormesh(chart.x, chart.y, calm, cmap=_one(STABLE_SHADE), rasterized=True)
        if np.isfinite(growth).any():
            mesh = panel.pcolormesh(
                chart.x, chart.y, growth, cmap="YlOrRd", vmin=0.0, rasterized=True
            )
            bar = figure.colorbar(mesh, ax=panel, pad=0.02)
            bar.set_label("growth of deviations [1/s]")
            bar.outline.set_visible(False)
        if chart.unstable.any() and not chart.unstable.all():
            margin = np.ma.masked_invalid(chart.margin)  # what failed says nothing of the edge
            panel.contour(chart.x, chart.y, margin, levels=[0.0], colors="#333333", linewidths=0.9)
        panel.set_xlabel(with_unit(chart.x_name, chart.units.get(chart.x_name, "")))
        panel.set_ylabel(with_unit(chart.y_name, chart.units.get(chart.y_name, "")))
        panel.set_title("unstable where coloured", loc="left", fontsize=9, color="#555555")
        if chart.title:
            figure.suptitle(chart.title, fontsize=12, x=0.01, ha="left")
        return save(figure, path)


def plot_sweep(sweep: Sweep, path: str | Path) -> Path:
    """Draw the outputs of a sweep over one parameter as lines, over two as maps.

    Raises OptionError: more than two parameters, another ending of the file; OSError.
    """
    axes = [name for name, values in sweep.grid.items() if len(values) > 1]
    if len(axes) not in (1, 2):
        what = f"a sweep over {len(axes)} parameters is no picture"
        raise OptionError([Problem(what, hint="Sweep one or two, or use --output.")])
    names = list(sweep.values)
    with styled():
        if len(axes) == 1:
            figure, below = panels([2.4] * len(names), sweep.title)
            for panel, name in zip(below, names, strict=True):
                values = sweep.grid[axes[0]]
                shown = sweep.as_shown(name)
                panel.plot(values, shown.ravel(), ".-", color=LINES[0], markersize=4)
                panel.set_ylabel(with_unit(cut(name), sweep.unit(name)))
                if not np.any(np.mod(shown[np.isfinite(shown)], 1)):  # such as counts
                    panel.locator_params(axis="y", integer=True)
            below[-1].set_xlabel(_axis(sweep, axes[0]))
            return save(figure, path)
        figure, below = panels([3.6] * len(names), sweep.title)
        for panel, name in zip(below, names, strict=True):
            shape = [len(sweep.grid[axis]) for axis in axes]
            mesh = panel.pcolormesh(
                sweep.grid[axes[0]], sweep.grid[axes[1]], sweep.as_shown(name).reshape(shape).T,
                rasterized=True,
            )  # fmt: skip
            panel.grid(False)
            told = with_unit(cut(name), sweep.unit(name))
            figure.colorbar(mesh, ax=panel, pad=0.01).set_label(told)
            panel.set_ylabel(_axis(sweep, axes[1]))
        below[-1].set_xlabel(_axis(sweep, axes[0]))
        return save(figure, path)


def _axis(sweep: Sweep, name: str) -> str:
    return with_unit(name, sweep.units.get(name, ""))


def _one(colour: str) -> Colormap:
    from matplotlib.colors import ListedColormap

    return ListedColormap([colour])
