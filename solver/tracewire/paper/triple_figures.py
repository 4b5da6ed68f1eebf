"""Figures of paper B: windows of periodic and of irregular motion, sections, exponents."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tracewire.analyse import Plane, bifurcation, lyapunov, section
from tracewire.array_types import Vector
from tracewire.paper.setting import RTOL, Task, label, symbol
from tracewire.show.style import LINES, MARK, QUIET, fit_time, panels
from tracewire.solve import Run, simulate

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ANGLES = ("psi1", "psi2", "psi3")
TURN = dict.fromkeys(ANGLES, 2 * math.pi)
EDGE = Plane(edge="torque")
LOWEST, HIGHEST = 0.3, 0.9  # Hz
SQUARES, BALLS = (0.3, 0.45, 0.6), (0.5, 0.69, 0.81)  # Hz
NEARBY = 1e-3  # rad
SHADE = "#F0F0F0"
WIDE = 9.0


def windows(task: Task) -> Figure:
    """Signals over a window of time, one column for each part; shaded where the torque pushes."""
    from matplotlib.figure import Figure

    parts = list(task.figure.presets)[: task.of(1, 3, 3)]
    rows = task.figure.panels
    figure = Figure(figsize=(WIDE, 1.7 * len(rows) + 0.4), layout="constrained")
    grid = figure.subplots(len(rows), len(parts), squeeze=False, sharex="col")
    assert task.figure.span is not None
    begin, end = task.figure.span
    for number, (column, part) in enumerate(zip(grid.T, parts, strict=True)):
        preset, values = task.chosen(part)
        f = values.get("f") or _frequency(task, preset)
        turns = np.arange(math.ceil(begin * f - 0.5), math.floor(end * f - 0.5) + 1)
        edges = (turns + 0.5) / f
        even = np.arange(begin, end + 0.005, 0.01)
        times = np.unique(np.concatenate([[0.0], even, edges]))
        run = task.run(part, times)
        seen, marked = run.t >= begin, np.isin(run.t, edges)
        for panel, (name,) in zip(column, rows, strict=True):
            for edge in [edges[0] - 1 / f, *edges]:
                panel.axvspan(edge, edge + 0.5 / f, color=SHADE, linewidth=0, zorder=0)
            whole = 2 * math.pi * np.round(run[name][seen].mean() / (2 * math.pi))
            panel.plot(run.t[seen], run[name][seen] - whole, color=LINES[0])
            panel.plot(run.t[marked], run[name][marked] - whole, "o", color=MARK, markersize=3.5)
            panel.set_xlim(begin, end)
            if number == 0:
                panel.set_ylabel(label(name, run))
        column[0].set_title(part, fontsize=9.5)
        column[-1].set_xlabel("$t$ [s]")
    return figure


def _frequency(task: Task, preset: str) -> float:
    """The frequency of the torque in Hz."""
    return float(simulate(task.model, preset=preset, times=[0.0, 0.01]).parameters["f"])


def two_nearby(task: Task) -> Figure:
    """The model from a time on, and from a state beside it: irregular motions part."""
    assert task.figure.span is not None
    begin, end = task.figure.span
    preset, _ = task.chosen("")
    first = simulate(task.model, preset=preset, span=(0.0, begin), rtol=RTOL)
    times = np.linspace(begin, end, 2001)
    runs: list[Run] = []
    for away in (0.0, NEARBY):
        state = {**first.final, "psi1": first.final["psi1"] + away}
        runs.append(
            simulate(
                task.model, preset=preset, span=(begin, end), times=times, start=state, rtol=RTOL
            )
        )
    names = [name for row in task.figure.panels for name in row]
    figure, axes = panels([1.8] * len(names))
    for panel, name in zip(axes, names, strict=True):
        for run, color, style in zip(runs, LINES, ("-", "--"), strict=False):
            shown = "model" if style == "-" else "from 0.001 rad beside"
            panel.plot(run.t, run[name], style, color=color, label=shown)
        panel.set_ylabel(label(name, runs[0]))
    axes[0].legend(loc="lower right", bbox_to_anchor=(1, 0.99), ncols=2, borderpad=0)
    axes[-1].set_xlabel("$t$ [s]")
    fit_time(axes[-1], times)
    figure.align_ylabels(axes)
    return figure


def branches(task: Task) -> Figure:
    """A bifurcation diagram, downward in grey and then upward in black; 800 frequencies when full.

    Squares and balls are the periodic motions of Figs 5 and 7, from the zero state.
    """
    count = task.of(6, 160, 800)
    skip, keep = (20, 10) if task.amount == "quick" else (200, 100)
    (name,), across = task.figure.panels[0], task.figure.across
    found = bifurcation(
        task.model,
        across,
        np.linspace(LOWEST, HIGHEST, count),
        EDGE,
        direction="down_up",
        skip=skip,
        keep=keep,
        modulo=TURN,
        progress=task.progress,
    )
    figure, (panel,) = panels([4.2])
    column = found.states.index(name)
    sizes = (3.6, 2.2) if count < 400 else (1.8, 1.1)
    for branch, color, size in zip(found.branches, ("#A0A0A0", "black"), sizes, strict=True):
        points = turned(branch.points[:, :, column])
        panel.plot(
            np.repeat(branch.values, keep), points.ravel(), linestyle="", marker=".",
            markersize=size, markeredgewidth=0, color=color, rasterized=True,
        )  # fmt: skip
    for marker, frequencies in (("s", SQUARES), ("o", BALLS)):
        for f in frequencies:
            point = section(task.model, EDGE, parameters={across: f}, skip=skip, keep=1)
            panel.plot(f, turned(point[name])[0], marker, mfc="none", color=MARK, markersize=6)
    told = [
        f"{branch.direction}: {', '.join(f'{a:.3f} to {b:.3f}' for a, b in branch.bands) or 'none'}"
        for branch in found.branches
    ]
    step = (HIGHEST - LOWEST) / (count - 1)
    panel.set_title(
        f"{count} frequencies, one each {step:.2g} Hz; irregular {', '.join(told)} Hz",
        loc="left", fontsize=8, color="#555555",
    )  # fmt: skip
    panel.set_xlim(LOWEST - 0.01, HIGHEST + 0.01)
    panel.set_xlabel("$f$ [Hz]")
    panel.set_ylabel(f"{symbol(name)} [rad]")
    return figure


def attractor(task: Task) -> Figure:
    """The points of a section, each angle beside its rate."""
    from matplotlib.figure import Figure

    preset, _ = task.chosen("")
    count = task.of(50, 8000, 30_000)
    skip = task.of(20, 1000, 1000)
    found = section(task.model, EDGE, preset=preset, skip=skip, keep=count, modulo=TURN)
    names = [name for row in task.figure.panels for name in row]
    figure = Figure(figsize=(WIDE, 3.4), layout="constrained")
    for panel, name in zip(figure.subplots(1, len(names)), names, strict=True):
        panel.plot(
            turned(found[name]), found[f"{name}_dot"], linestyle="", marker=".",
            markersize=1.6 if count < 20_000 else 0.9, markeredgewidth=0, color="#1F3B57",
            rasterized=True,
        )  # fmt: skip
        panel.set_xlabel(f"{symbol(name)} [rad]")
        panel.set_ylabel(f"{symbol(f'{name}_dot')} [rad/s]")
    figure.suptitle(
        f"{count} points after {skip} periods", fontsize=9, color="#555555", x=0.01, ha="left"
    )
    return figure


def exponents(task: Task) -> Figure:
    """The running estimates of the Lyapunov exponents, orthogonal every 0.5 s."""
    preset, _ = task.chosen("")
    found = lyapunov(
        task.model,
        float(task.of(50, 4000, 40_000)),
        interval=0.5,
        transient=float(task.of(20, 1000, 10_000)),
        preset=preset,
        progress=task.progress,
    )
    figure, (panel,) = panels([4.0])
    seen = found.t > 0.02 * found.t[-1]  # before that the estimate is wild
    for k, (value, error) in enumerate(zip(found.exponents, found.errors, strict=True)):
        color = LINES[k % len(LINES)]
        panel.plot(found.t[seen], found.running[seen, k], color=color, linewidth=1.0)
        panel.annotate(
            rf"$\lambda_{k + 1} = {value:.3f}$ ± {error:.1g}",
            (1.0, value), xycoords=("axes fraction", "data"), xytext=(6, 0),
            textcoords="offset points", va="center", fontsize=8.5, color=color,
        )  # fmt: skip
    panel.axhline(0.0, color=QUIET, linewidth=0.8)
    panel.set_xlim(0.0, float(found.t[-1]))
    panel.set_xlabel("$t$ [s]")
    panel.set_ylabel(r"$\lambda_i$ [1/s]")
    if found.divergence is not None:
        panel.set_title(
            f"{found.t[-1]:.0f} s; sum ${found.total:.4f}$ 1/s, mean of −tr(M⁻¹C) "
            f"${found.divergence:.4f}$ 1/s",
            loc="left", fontsize=9, color="#555555",
        )  # fmt: skip
    return figure


def turned(angles: Vector) -> Vector:
    """Angles within half a turn from zero."""
    return np.asarray(angles - 2 * math.pi * np.round(angles / (2 * math.pi)))
