"""Figures of single runs: over time, phase portraits, polar orbits, spectra, contacts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tracewire.analyse import spectrum
from tracewire.array_types import Vector
from tracewire.paper.setting import Task, label, symbol
from tracewire.show.style import LINES, MARK, fit_time, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

SIDE = 5.4
COLUMNS = 4
STYLES = ("-", "--")
HIGHEST = 1.5  # Hz


def over_time(task: Task) -> Figure:
    """Signals over time, one panel below the other; what is compared is in one."""
    run = task.run()
    rows = task.figure.panels
    figure, axes = panels([3.0 if len(rows) == 1 else 2.0] * len(rows))
    for panel, names in zip(axes, rows, strict=True):
        for name, color, style in zip(names, LINES, STYLES, strict=False):
            shown = task.figure.names.get(name, symbol(name))
            panel.plot(run.t, run[name], style, color=color, label=shown)
        panel.set_ylabel(label(names[0], run))
        if len(names) > 1:
            panel.legend(loc="upper right", ncols=len(names))
    axes[-1].set_xlabel("$t$ [s]")
    fit_time(axes[-1], run.t)
    figure.align_ylabels(axes)
    return figure


def phase_portrait(task: Task) -> Figure:
    """One signal over another; a ring where it begins."""
    from matplotlib.figure import Figure

    run = task.run()
    (name,), across = task.figure.panels[0], task.figure.across
    figure = Figure(figsize=(SIDE, SIDE), layout="constrained")
    panel = figure.subplots()
    panel.plot(run[across], run[name], color=LINES[0], linewidth=0.8)
    panel.plot(run[across][0], run[name][0], "o", mfc="none", color=MARK, markersize=6)
    panel.set_xlabel(label(across, run))
    panel.set_ylabel(label(name, run))
    return figure


def polar_orbit(task: Task) -> Figure:
    """A length over an angle from the downward vertical, one panel for each part."""
    from matplotlib.figure import Figure

    parts = list(task.figure.presets)
    if task.amount == "quick":
        parts = parts[:2]
    columns = min(len(parts), COLUMNS)
    rows = -(-len(parts) // columns)
    size = SIDE if len(parts) == 1 else 2.3
    figure = Figure(figsize=(size * columns, size * rows), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False, subplot_kw={"projection": "polar"})
    for panel, part in zip(grid.ravel(), parts, strict=True):
        _draw_orbit(panel, task, part, single=len(parts) == 1)
    return figure


def _draw_orbit(panel: PolarAxes, task: Task, part: str, single: bool) -> None:
    run = task.run(part)
    (name,), across = task.figure.panels[0], task.figure.across
    panel.set_theta_zero_location("S")  # down is down
    r = np.abs(run[name])
    angle = np.where(run[name] < 0, run[across] + np.pi, run[across])  # beyond the centre
    panel.plot(angle, r, color=LINES[0], linewidth=1.0 if single else 0.7)
    panel.plot(angle[0], r[0], "o", mfc="none", color=MARK, markersize=5)
    panel.set_rlim(0.0, 1.05 * float(np.max(r)))
    panel.set_rlabel_position(200)
    panel.spines["polar"].set_visible(single)
    if single:
        panel.set_title(f"{label(name, run)} over {label(across, run)}", fontsize=9.5)
        return
    panel.set_title(part, fontsize=9, pad=2)
    panel.set_xticklabels([])
    panel.tick_params(labelsize=6)
    step = 0.5 if panel.get_rmax() < 2 else 1.0
    panel.set_rgrids(np.arange(step, panel.get_rmax(), step).tolist())


def lines_of(task: Task) -> Figure:
    """The amplitude spectra of signals, with their largest lines."""
    run = task.run()
    names = task.figure.panels[0]
    figure, (panel,) = panels([3.4])
    found = [spectrum(run, name, lines=2) for name in names]
    for one, color, style in zip(found, LINES, STYLES, strict=False):
        panel.plot(one.frequency, one.amplitude, style, color=color, label=symbol(one.signal))
    for line in found[0].lines:
        panel.plot(line.frequency, line.amplitude, "o", color=MARK, markersize=3.5)
        panel.annotate(
            f"{line.frequency:.3f} Hz",
            (line.frequency, line.amplitude),
            xytext=(6, -4),
            textcoords="offset points",
            fontsize=9,
            color=MARK,
        )
    panel.set_xlim(0.0, HIGHEST)
    panel.set_ylim(bottom=0.0)
    panel.set_xlabel("frequency [Hz]")
    panel.set_ylabel(f"amplitude [{found[0].unit}]")
    panel.legend(loc="upper right")
    return figure


def contacts(task: Task) -> Figure:
    """How deep bodies are in their barriers, Eq 4 of paper A: zero outside."""
    run = task.run()
    names = [name for row in task.figure.panels for name in row]
    figure, axes = panels([2.0] * len(names))
    for panel, name, color in zip(axes, names, LINES, strict=False):
        depth = beyond(run[name], run.parameters[f"{name}_s"])
        panel.plot(run.t, np.degrees(depth), color=color)
        panel.set_ylabel(rf"{symbol(name)[:-1]}^d$ [deg]")
    axes[-1].set_xlabel("$t$ [s]")
    fit_time(axes[-1], run.t)
    figure.align_ylabels(axes)
    return figure


def beyond(angle: Vector, limit: float) -> Vector:
    """sign(angle) (|angle| - limit) where that is positive, else zero."""
    return np.asarray(np.sign(angle) * np.maximum(np.abs(angle) - limit, 0.0))
