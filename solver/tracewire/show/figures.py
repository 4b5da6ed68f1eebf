"""`plot_run`: a run at a glance, the recorded signals over time and what happened to them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tracewire.errors import OptionError, Problem
from tracewire.residual import Measured
from tracewire.show.event_rows import draw_events, event_rows, jump_times
from tracewire.show.limits import FIGURE
from tracewire.show.sticking import held_intervals
from tracewire.show.style import LINES, MARK, dots, fit_time, panels, save, styled, with_unit
from tracewire.solve import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot_run(run: Run, path: str | Path, measured: Measured | None = None) -> Path:
    """Draw a run to a .png, .svg or .pdf file, with the samples of a measured series as dots.

    Recorded signals over t in s, one panel for each, or for several of one unit and like range. A
    panel is shaded while a friction holds one of its signals, and has a thin line where an event
    sets one of its states. Under them one row for each block that had events: a bar while it
    sticks, a tick at each reset, impact or crossing. Raises OptionError: nothing recorded, another
    ending of the file; OSError.
    """
    if measured is not None and not isinstance(measured, Measured):
        hint = "Load all: tracewire.load_measured(model)."
        raise OptionError.one(f"measured is {measured!r}, and not a measured series", hint=hint)
    groups = group_signals(run)
    if not groups:
        hint = "Name signals under `record:` of the diagram."
        raise OptionError([Problem("the run has no recorded signals to draw", hint=hint)])
    shown = groups[: FIGURE.most_panels]
    rows = event_rows(run)
    title = run.title
    if len(shown) < len(groups):
        title += f" (the first {len(shown)} of {len(groups)} panels)"
    tall = 2.4 if len(shown) <= 3 else 1.6
    heights = [tall] * len(shown) + ([0.22 * len(rows) + 0.12] if rows else [])
    with styled():
        figure, axes = panels(heights, title)
        held = held_intervals(run)
        for panel, names in zip(axes, shown, strict=False):
            _draw_signals(panel, run, names, measured)
            for name, color in zip(names, LINES, strict=False):
                for begin, end in held.get(name, ()):
                    panel.axvspan(begin, end, color=color, alpha=0.13, linewidth=0, zorder=0)
            times = jump_times(run, names)
            for time in times if len(times) <= FIGURE.most_strikes else ():
                panel.axvline(time, color=MARK, alpha=0.45, linewidth=0.6, zorder=0.5)
        if rows:
            draw_events(axes[-1], run, rows, shaded=bool(held))
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
            near = max(extent, ranges[n]) <= FIGURE.scale_apart * min(extent, ranges[n])
            if alike and near and len(group) < FIGURE.most_lines:
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
