"""The law of a missing effect: what the data need at a place over its coordinate and its rate."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.errors import OptionError
from tracewire.show.limits import TRACE
from tracewire.show.style import (
    AFTER,
    BEFORE,
    MEASURED,
    cut,
    plain_numbers,
    save,
    styled,
    with_unit,
)
from tracewire.trace import Force, Found, Means, unit_at, users_unit

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def has_law(found: Found) -> bool:
    """Whether an effect was added to a sum, so that there is a force to be drawn."""
    return any(effect.block and "drive." not in effect.place for effect in found.effects)


def plot_law(found: Found, path: Path) -> Path:
    """The law over the one variable on which it depends most, before and after."""
    from matplotlib.figure import Figure

    chosen = _chosen(found)
    with styled():
        figure = Figure(figsize=(8.0, 3.6 * len(chosen) + 0.6), layout="constrained")
        grid = figure.subplots(len(chosen), 1, squeeze=False)
        for (panel,), force in zip(grid, chosen, strict=True):
            _draw(panel, force, depends_on(force), found)
            panel.set_ylabel(_label(force, found))
        _explain(figure, grid.flat)
        return save(figure, path)


def plot_forces(found: Found, path: Path) -> Path:
    """What is needed at each place over its coordinate and over its rate, with the law on top."""
    from matplotlib.figure import Figure

    chosen = _chosen(found)
    with styled():
        figure = Figure(figsize=(9.0, 3.2 * len(chosen) + 0.7), layout="constrained")
        grid = figure.subplots(len(chosen), 2, squeeze=False, sharey="row")
        for panels, force in zip(grid, chosen, strict=True):
            limits = [_draw(panel, force, over, found) for over, panel in enumerate(panels)]
            panels[0].set_ylim(min(low for low, _ in limits), max(high for _, high in limits))
            panels[0].set_ylabel(_label(force, found))
        _explain(figure, grid.flat)
        return save(figure, path)


def _explain(figure: Figure, panels: Iterable[Axes]) -> None:
    """One legend of what all panels have."""
    entries: dict[str, Artist] = {}
    for panel in panels:
        for line, label in zip(*panel.get_legend_handles_labels(), strict=True):
            entries.setdefault(str(label), line)
    figure.legend(
        list(entries.values()), list(entries), loc="outside upper right", ncols=2, markerscale=1.2
    )


def _chosen(found: Found) -> tuple[Force, ...]:
    chosen = [force for force in found.forces if len(force.needed)]
    if not chosen:
        raise OptionError.one("no place of a sum has got an effect")
    return tuple(chosen[: TRACE.most_forces])


def _label(force: Force, found: Found) -> str:
    return with_unit(f"needed at {cut(force.place)}", unit_at(found, force.place))


def _draw(panel: Axes, force: Force, over: int, found: Found) -> tuple[float, float]:
    """Draw a force over q (0) or v (1), in the unit in which the user has that; the limits that
    hold the law and the means."""
    name = force.names[over]
    unit, factor = users_unit(found, name)
    values = along(force, over) / factor
    there = means_over(force, over)
    middles, means, errors = there.at / factor, there.mean, there.error
    panel.axhline(0.0, color=BEFORE, linewidth=1.2, linestyle="--", zorder=2,
                  label="before: not in the diagram")  # fmt: skip
    panel.errorbar(middles, means, 2 * errors, color=MEASURED, linestyle="", marker="o",
                   markersize=4.5, markerfacecolor="white", zorder=4,
                   label="needed: mean, ±2 standard errors")  # fmt: skip
    sure = is_sure(there)
    shown = [*means[sure], *(means - errors)[sure], *(means + errors)[sure], *force.fitted, 0.0]
    low, high = float(np.nanmin(shown)), float(np.nanmax(shown))
    every = max(1, math.ceil(len(values) / TRACE.most_dots))
    if float(np.nanstd(force.needed - force.fitted)) < TRACE.noisy * (high - low):
        size = float(np.clip(70 / np.sqrt(max(len(values) / every, 1)), 1.5, 5))
        panel.plot(values[::every], force.needed[::every], color=MEASURED, alpha=0.25,
                   linestyle="", marker=".", markersize=size, rasterized=True, zorder=1,
                   label="needed at each sample")  # fmt: skip
    if np.any(force.fitted):
        order = np.argsort(values, kind="stable")
        line = is_function(values, force.fitted)
        look = {"linewidth": 1.8} if line else {"linestyle": "", "marker": ".", "markersize": 2.5}
        panel.plot(values[order][::every], force.fitted[order][::every], color=AFTER, zorder=3,
                   label="after: the fitted law", **look)  # fmt: skip
    plain_numbers(panel.yaxis)
    panel.set_xlabel(with_unit(name, unit))
    margin = 0.1 * (high - low or 1.0)
    panel.set_ylim(low - margin, high + margin)
    return low - margin, high + margin


def depends_on(force: Force) -> int:
    """The variable on which a law depends most: 0 is the coordinate, 1 the rate."""
    return 0 if _held_by(force.q, force) > _held_by(force.v, force) else 1


def along(force: Force, over: int) -> Vector:
    """The samples of the coordinate (0) or of the rate (1)."""
    return force.v if over else force.q


def means_over(force: Force, over: int) -> Means:
    """What is needed in bins of a variable: as the trace has fitted it, else of the samples."""
    return force.means[over] if force.means else binned(along(force, over), force.needed)


def is_sure(means: Means) -> NDArray[np.bool_]:
    """Which means have an error like that of most: where there are few data, they are far off."""
    return np.asarray(means.error <= TRACE.far * np.median(means.error))


def binned(values: Vector, needed: Vector) -> Means:
    """Middles of bins with equally many samples, the mean there and its standard error.

    What is needed has spikes where windows begin and end: the outermost twentieth on either side
    is taken as far as the rest reaches.
    """
    known = np.isfinite(values) & np.isfinite(needed)
    order = np.argsort(values[known], kind="stable")
    parts = np.array_split(order, min(TRACE.bins, max(len(order) // TRACE.least_in_bin, 1)))
    ends = np.quantile(needed[known], [TRACE.spikes, 1 - TRACE.spikes])
    x, y = values[known], np.clip(needed[known], *ends)
    middles = np.array([np.median(x[part]) for part in parts])
    means = np.array([np.mean(y[part]) for part in parts])
    errors = np.array([np.std(y[part]) / math.sqrt(len(part)) for part in parts])
    return Means(middles, means, errors)


def is_function(values: Vector, law: Vector) -> bool:
    """Whether a law is a function of one variable, jumps included."""
    whole = float(np.ptp(law))
    spreads = np.array([float(np.std(part)) for part in _fine(values, law)])
    return bool(np.mean(spreads <= TRACE.tight * whole) >= TRACE.mostly)


def _held_by(values: Vector, force: Force) -> float:
    """The part of the law's variance that a function of one variable holds: 0 to 1."""
    law = force.fitted
    whole = float(np.sum((law - np.mean(law)) ** 2))
    if not np.ptp(values) > 0:
        return 0.0
    if whole <= 1e-18 * float(np.sum(law**2)):
        return 1.0
    return (
        1 - float(sum(np.sum((part - np.mean(part)) ** 2) for part in _fine(values, law))) / whole
    )


def _fine(values: Vector, law: Vector) -> list[Vector]:
    """The law in narrow bins of a variable."""
    order = np.argsort(values, kind="stable")
    return np.array_split(law[order], min(TRACE.fine, max(len(law) // TRACE.least_in_bin, 1)))
