"""Figures of sections: bifurcation diagrams and attractors."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tracewire.analyse import Bifurcation, Branch, PoincareSection
from tracewire.array_types import Array
from tracewire.errors import OptionError, Problem
from tracewire.show.limits import FIGURE
from tracewire.show.plane_figures import check_names, square
from tracewire.show.style import LINES, QUIET, panels, save, styled, with_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BAND = "#F6E7D8"
ARROWS = {"up": "values going up →", "down": "← values going down", "apart": "each from the start"}


def plot_bifurcation(found: Bifurcation, path: str | Path, states: Sequence[str] = ()) -> Path:
    """Draw a bifurcation diagram: one panel for each branch and state, the points over the values.

    The first state unless `states` are named. Ranges of irregular motion are shaded, with their
    ends written above. Raises OptionError: no such state, too many panels; OSError.
    """
    names = list(states) or list(found.states[:1])
    check_names(names, found.states, "state")
    count = len(names) * len(found.branches)
    if not 1 <= count <= FIGURE.branch_panels:
        what = f"{count} panels make no figure"
        hint = f"Name 1 to {FIGURE.branch_panels // max(len(found.branches), 1)} states."
        raise OptionError([Problem(what, hint=hint)])
    with styled():
        tall = 3.6 if count == 1 else 2.7 if count == 2 else 2.0
        figure, below = panels([tall] * count, found.title)
        rows = [(branch, name) for branch in found.branches for name in names]
        for panel, (branch, name) in zip(below, rows, strict=True):
            _draw_branch(panel, found, branch, name, name == names[0])
        for panel in below[:-1]:
            panel.tick_params(labelbottom=False)
        below[-1].set_xlabel(with_unit(found.parameter, found.unit))
        return save(figure, path)


def _draw_branch(panel: Axes, found: Bifurcation, branch: Branch, name: str, titled: bool) -> None:
    values, column = branch.values, found.states.index(name)
    points = _turned(branch.points[:, :, column], found.modulo.get(name))
    half = 0.5 * float(np.min(np.diff(values))) if len(values) > 1 else 0.0
    for low, high in branch.bands:
        panel.axvspan(low - half, high + half, color=BAND, linewidth=0, zorder=0)
    across = np.repeat(values, points.shape[1])
    many = points.size
    panel.plot(
        across,
        points.ravel(),
        linestyle="",
        marker=",",
        color="#1F3B57",
        alpha=1.0 if many < 20_000 else 0.5,
        rasterized=True,
    )
    regular = ~branch.irregular & (branch.clusters > 0)
    # of a periodic motion all points are in a few places, which one pixel each hardly shows
    panel.plot(
        np.repeat(values[regular], points.shape[1]),
        points[regular].ravel(),
        linestyle="",
        marker=".",
        markersize=2.0 if len(values) < 300 else 1.2,
        color=LINES[0],
        rasterized=True,
    )
    panel.set_ylabel(with_unit(name, found.units.get(name, "")))
    if titled:
        widest = sorted(branch.bands, key=lambda band: band[0] - band[1])[: FIGURE.most_bands]
        bands = ", ".join(
            f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
            for low, high in sorted(widest)
        )
        more = " ..." if len(branch.bands) > FIGURE.most_bands else ""
        told = f"irregular (shaded): {bands}{more}" if bands else "no irregular motion"
        panel.set_title(
            f"{ARROWS[branch.direction]}     {told}", loc="left", fontsize=9, color="#555555"
        )
    if len(values) > 1:
        panel.set_xlim(float(values.min()) - half, float(values.max()) + half)


def plot_section(found: PoincareSection, path: str | Path, x: str = "", y: str = "") -> Path:
    """Draw the points of a section in the plane of two states, the first two unless given.

    Raises OptionError: no such state; OSError.
    """
    check_names([name for name in (x, y) if name], found.states, "state")
    if not found.states:
        raise OptionError([Problem("a model without states has no section to draw")])
    across = x or found.states[0]
    up = y or found.states[min(1, len(found.states) - 1)]
    count = len(found.t)
    with styled():
        figure, panel = square(found.title)
        panel.plot(
            _turned(found[across], found.modulo.get(across)),
            _turned(found[up], found.modulo.get(up)),
            linestyle="",
            marker=".",
            markersize=float(np.clip(120 / np.sqrt(count), 0.8, 7)),
            markeredgewidth=0,
            color=LINES[0],
            rasterized=count > 5000,
        )
        panel.set_xlabel(with_unit(across, found.units.get(across, "")))
        panel.set_ylabel(with_unit(up, found.units.get(up, "")))
        kind = "irregular" if found.irregular else f"{found.clusters} places"
        panel.set_title(f"{count} points, {kind}", loc="left", fontsize=9, color=QUIET)
        return save(figure, path)


def _turned(values: Array, turn: float | None) -> Array:
    """The values within half a turn from zero, where they turn."""
    return values if turn is None else values - turn * np.round(values / turn)
