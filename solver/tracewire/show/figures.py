"""`plot_run`: a run at a glance, the recorded signals over time and what happened to them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tracewire.errors import OptionError, Problem
from tracewire.show.style import (
    LINES,
    MARK,
    QUIET,
    STICK,
    dots,
    fit_time,
    panels,
    save,
    styled,
    with_unit,
)
from tracewire.show.summary import stick_intervals
from tracewire.solve import Event, Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from tracewire.residual import Measured

MOST_LINES = 4
MOST_PANELS = 16
MOST_ROWS = 8
SCALE_APART = 20.0
"""Signals whose ranges differ by more than this would hide each other in one panel."""

Interval = tuple[float, float]


def plot_run(run: Run, path: str | Path, measured: Measured | None = None) -> Path:
    """Draw a run to a .png, .svg or .pdf file, with the samples of a measured series as dots.

    Recorded signals over t in s, one panel for each, or for several of one unit and like range.
    Under them one row for each block that had events: a bar while it sticks, a tick at each reset,
    impact or crossing. Raises OptionError: nothing recorded, another ending of the file; OSError.
    """
    groups = group_signals(run)
    if not groups:
        hint = "Name signals under `record:` of the diagram."
        raise OptionError([Problem("the run has no recorded signals to draw", hint=hint)])
    shown = groups[:MOST_PANELS]
    rows = _event_rows(run)
    title = run.title
    if len(shown) < len(groups):
        title += f" (the first {len(shown)} of {len(groups)} panels)"
    tall = 2.4 if len(shown) <= 3 else 1.6
    heights = [tall] * len(shown) + ([0.22 * len(rows) + 0.12] if rows else [])
    with styled():
        figure, axes = panels(heights, title)
        sticks = stick_intervals(run)
        for panel, names in zip(axes, shown, strict=False):
            _draw_signals(panel, run, names, measured)
            for interval in _union([i for intervals in sticks.values() for i in intervals]):
                panel.axvspan(*interval, color=STICK, alpha=0.35, linewidth=0, zorder=0)
        if rows:
            _draw_events(axes[-1], run, rows, sticks)
        for panel in axes[:-1]:
            panel.tick_params(labelbottom=False)
        axes[-1].set_xlabel("t [s]")
        fit_time(axes[-1], run.t)
        figure.align_ylabels(axes)
        return save(figure, path)


def group_signals(run: Run) -> list[list[str]]:
    """The recorded signals in panels: those of one unit and of like range stand together."""
    groups: list[list[str]] = []
    ranges: list[float] = []
    for name, values in run.signals.items():
        extent = float(np.ptp(values)) if len(values) else 0.0
        unit = run.look(name).unit
        for n, group in enumerate(groups):
            alike = run.look(group[0]).unit == unit != ""
            near = max(extent, ranges[n]) <= SCALE_APART * min(extent, ranges[n])
            if alike and near and len(group) < MOST_LINES:
                group.append(name)
                break
        else:
            groups.append([name])
            ranges.append(extent)
    return groups


def _draw_signals(panel: Axes, run: Run, names: Sequence[str], measured: Measured | None) -> None:
    dotted = [name for name in names if measured is not None and name in measured.values]
    for number, name in enumerate(dotted):
        assert measured is not None
        label = "_" if number else "measured"
        look = dots(len(measured.t)) | {"zorder": 1}
        panel.plot(measured.t, measured.values[name] / run.look(name).factor, label=label, **look)
    for name, color in zip(names, LINES, strict=False):
        panel.plot(run.t, run.as_shown(name), color=color, label=run.look(name).label)
    unit = run.look(names[0]).unit
    one = with_unit(run.look(names[0]).label, unit)
    panel.set_ylabel(one if len(names) == 1 else f"[{unit}]")
    if len(names) > 1 or dotted:
        # above the panel, where it covers no line
        panel.legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=5, borderpad=0)


def _event_rows(run: Run) -> list[str]:
    """The blocks that had events, in the order of the first, and one row for all that are left."""
    names = list(dict.fromkeys(event.block for event in run.events))
    if len(names) <= MOST_ROWS:
        return names
    return [*names[: MOST_ROWS - 1], f"{len(names) - MOST_ROWS + 1} others"]


def _draw_events(
    panel: Axes, run: Run, rows: Sequence[str], sticks: Mapping[str, Sequence[Interval]]
) -> None:
    position = {name: n for n, name in enumerate(rows)}
    last = len(rows) - 1
    for block, intervals in sticks.items():
        spans = [(begin, end - begin) for begin, end in intervals]
        panel.broken_barh(
            spans,
            (position.get(block, last) - 0.3, 0.6),
            color=STICK,
            edgecolor=QUIET,
            linewidth=0.4,
        )
    for kinds, color, half in (
        (("crossing", "scheduled"), QUIET, 0.2),
        (("impact", "reset", "rest"), MARK, 0.38),
    ):
        marks = [event for event in run.events if event.kind in kinds]
        at = np.array([position.get(event.block, last) for event in marks], dtype=float)
        panel.vlines([e.time for e in marks], at - half, at + half, color=color, linewidth=0.9)
    panel.set_yticks(range(len(rows)), rows)
    panel.set_ylim(last + 0.6, -0.6)
    panel.grid(False)
    panel.spines["left"].set_visible(False)
    panel.tick_params(axis="y", length=0)
    panel.set_title(_legend(run.events), fontsize=8.5, color="#555555", loc="left", pad=3)


def _legend(events: Sequence[Event]) -> str:
    kinds = {event.kind for event in events}
    parts = []
    if kinds & {"stick", "slip"}:
        parts.append("bar: sticks")
    if strong := [k for k in ("impact", "reset", "rest") if k in kinds]:
        parts.append(f"red: {', '.join(strong)}")
    if weak := [k for k in ("crossing", "scheduled") if k in kinds]:
        parts.append(f"grey: {', '.join(weak)}")
    return "events   " + "    ".join(parts)


def _union(intervals: Sequence[Interval]) -> list[Interval]:
    """The intervals, with those that overlap joined."""
    joined: list[Interval] = []
    for begin, end in sorted(intervals):
        if joined and begin <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        else:
            joined.append((begin, end))
    return joined
