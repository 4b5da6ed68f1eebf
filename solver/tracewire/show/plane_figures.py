"""Figures of what lies in a plane: portraits, polar orbits, periodic orbits, sections."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tracewire.analyse import PeriodicOrbit
from tracewire.array_types import Vector
from tracewire.errors import OptionError, Problem, unknown
from tracewire.show.limits import FIGURE
from tracewire.show.sticking import held_intervals
from tracewire.show.style import LINES, MARK, QUIET, save, styled, with_unit
from tracewire.solve import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def plot_portrait(run: Run, x: str, y: str, path: str | Path, since: float = -np.inf) -> Path:
    """Draw one recorded signal of a run over another; the start is a ring.

    The state and its rate are a phase portrait, a rate and its friction the friction law. What a
    friction that sticks holds has a colour of its own. Samples before the time `since` in s are
    left out. Raises OptionError: a signal that is not recorded, another ending of the file;
    OSError.
    """
    chosen = _since(run, since)
    with styled():
        figure, panel = square(run.title)
        many = len(run.t[chosen]) > FIGURE.many_points
        across, up = run.as_shown(x)[chosen], run.as_shown(y)[chosen]
        _draw_path(panel, across, up, many)
        sticks = _sticks(run, x, y)[chosen]
        if np.any(sticks[:-1] & sticks[1:]):  # one sample is no line
            panel.plot(
                np.where(sticks, across, np.nan),
                np.where(sticks, up, np.nan),
                color=LINES[1],
                linewidth=1.8,
                rasterized=many,
                label="sticks",
            )
            panel.legend(loc="lower right", bbox_to_anchor=(1, 0.98), borderpad=0)
        mark_start(panel, across[0], up[0])
        panel.set_xlabel(with_unit(run.look(x).label, run.look(x).unit))
        panel.set_ylabel(with_unit(run.look(y).label, run.look(y).unit))
        return save(figure, path)


def plot_polar(run: Run, radius: str, angle: str, path: str | Path, since: float = -np.inf) -> Path:
    """Draw the path of a body at a distance and an angle from the downward vertical, both recorded.

    x = r sin(angle), y = -r cos(angle), at one scale, the pivot at the centre; the start is a ring.
    Raises OptionError as `plot_portrait`.
    """
    chosen = _since(run, since)
    r, phi = run.as_shown(radius)[chosen], run[angle][chosen]
    with styled():
        figure, panel = square(run.title)
        across, up = r * np.sin(phi), -r * np.cos(phi)
        _draw_path(panel, across, up, len(r) > FIGURE.many_points)
        mark_start(panel, across[0], up[0])
        panel.plot(0, 0, marker="+", color=MARK, markersize=9)
        panel.set_aspect("equal", adjustable="datalim")
        far, turned = run.look(radius), run.look(angle).label
        panel.set_xlabel(with_unit(f"{far.label} sin {turned}", far.unit))
        panel.set_ylabel(with_unit(f"−{far.label} cos {turned}", far.unit))
        return save(figure, path)


def plot_orbit(orbit: PeriodicOrbit, path: str | Path, x: str = "", y: str = "") -> Path:
    """Draw a periodic orbit in the plane of two states, with its multipliers in the unit circle.

    The first two states unless given. Raises OptionError, OSError.
    """
    names = orbit.states
    wrong = [unknown("state", name, names) for name in (x, y) if name and name not in names]
    if wrong:
        raise OptionError(wrong)
    if not names:
        raise OptionError([Problem("a model without states has no orbit to draw")])
    across = names.index(x) if x else 0
    up = names.index(y) if y else min(1, len(names) - 1)
    with styled():
        from matplotlib.figure import Figure

        figure = Figure(figsize=(9.0, 4.6), layout="constrained")
        left, right = figure.subplots(1, 2, width_ratios=[1.25, 1])
        left.plot(orbit.motion[:, across], orbit.motion[:, up], color=LINES[0])
        mark_start(left, orbit.x[across], orbit.x[up])
        left.set_xlabel(with_unit(names[across], orbit.units.get(names[across], "")))
        left.set_ylabel(with_unit(names[up], orbit.units.get(names[up], "")))
        if orbit.title:
            figure.suptitle(orbit.title, fontsize=12, x=0.01, ha="left")
        left.set_title(f"period {orbit.period:.6g} s, {orbit.floquet.verdict}", loc="left")
        draw_multipliers(right, orbit.floquet.multipliers)
        return save(figure, path)


def draw_multipliers(panel: Axes, multipliers: NDArray[np.complex128]) -> None:
    """Draw multipliers in the complex plane with the unit circle; those outside are red."""
    turn = np.linspace(0, 2 * np.pi, 200)
    panel.plot(np.cos(turn), np.sin(turn), color=QUIET, linewidth=0.8)
    size = np.abs(multipliers)
    for chosen, color in ((size <= 1.0 + 1e-4, LINES[0]), (size > 1.0 + 1e-4, MARK)):
        panel.plot(
            multipliers[chosen].real, multipliers[chosen].imag, "o", color=color, markersize=5
        )
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_xlabel("Re")
    panel.set_ylabel("Im")
    panel.set_title("Floquet multipliers", loc="left")


def square(title: str) -> tuple[Figure, Axes]:
    """A figure with one square panel."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(FIGURE.plane_side, FIGURE.plane_side), layout="constrained")
    panel = figure.subplots()
    if title:
        figure.suptitle(title, fontsize=12, x=0.01, ha="left")
    return figure, panel


def mark_start(panel: Axes, x: float, y: float) -> None:
    """A ring where something begins."""
    panel.plot(x, y, "o", markerfacecolor="none", markeredgecolor=MARK, markersize=7)


def _draw_path(panel: Axes, x: Vector, y: Vector, rasterized: bool) -> None:
    """A line through all points. Of a longer one Matplotlib leaves a gap where it parts it."""
    for begin in range(0, max(len(x) - 1, 1), FIGURE.many_points):
        piece = slice(begin, begin + FIGURE.many_points + 1)
        panel.plot(x[piece], y[piece], color=LINES[0], linewidth=0.9, rasterized=rasterized)


def _sticks(run: Run, *names: str) -> NDArray[np.bool_]:
    """Whether a friction holds one of these signals, at each sample (N,)."""
    held = held_intervals(run)
    found = np.zeros(len(run.t), dtype=bool)
    for begin, end in (interval for name in names for interval in held.get(name, ())):
        found |= (run.t >= begin) & (run.t < end)
    return found


def _since(run: Run, since: float) -> NDArray[np.bool_]:
    chosen: NDArray[np.bool_] = run.t >= since
    if not chosen.any():
        what = f"there is no sample from {since:g} s on"
        raise OptionError([Problem(what, hint="Give an earlier time, or a longer span.")])
    return chosen


def check_names(names: Sequence[str], known: Sequence[str], kind: str) -> None:
    """Refuse names that are not there. Raises OptionError."""
    wrong = [unknown(kind, name, known) for name in names if name not in known]
    if wrong:
        raise OptionError(wrong)
