"""`plot_runs`: several runs of a diagram in one figure, a line for each."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from tracewire.errors import OptionError, Problem
from tracewire.show.limits import FIGURE
from tracewire.show.style import LINES, dots, fit_time, panels, save, shortened, styled, with_unit
from tracewire.show.summary import extremes, with_label
from tracewire.show.table import Table, shown

if TYPE_CHECKING:
    from tracewire.residual import Measured
    from tracewire.solve import Run


def plot_runs(runs: Mapping[str, Run], path: str | Path, measured: Measured | None = None) -> Path:
    """Draw runs, by what they are called, to a .png, .svg or .pdf file.

    One panel for each recorded signal over t in s, one line for each run; the samples of a measured
    series are dots. Raises OptionError: nothing recorded, another ending of the file; OSError.
    """
    names = list(dict.fromkeys(name for run in runs.values() for name in run.signals))
    if not names:
        hint = "Name signals under `record:` of the diagram."
        raise OptionError([Problem("the runs have no recorded signals to draw", hint=hint)])
    first = next(iter(runs.values()))
    drawn = names[: FIGURE.most_panels]
    tall = 2.4 if len(drawn) <= 3 else 1.6
    with styled():
        figure, axes = panels(
            [tall] * len(drawn), shortened(first.title, len(names), FIGURE.most_panels, "panels")
        )
        for panel, name in zip(axes, drawn, strict=True):
            if measured is not None and name in measured.values:
                values = measured.values[name] / first.look(name).factor
                look = dots(len(measured.t)) | {"zorder": 1}
                panel.plot(measured.t, values, label="measured", **look)
            for (case, run), color in zip(runs.items(), _colors(len(runs)), strict=True):
                if name in run.signals:
                    panel.plot(run.t, run.as_shown(name), color=color, label=case)
            panel.set_ylabel(with_unit(first.look(name).label, first.look(name).unit))
        axes[0].legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=4, borderpad=0)
        for panel in axes[:-1]:
            panel.tick_params(labelbottom=False)
        axes[-1].set_xlabel("t [s]")
        fit_time(axes[-1], max((run.t for run in runs.values()), key=lambda t: float(t[-1])))
        figure.align_ylabels(axes)
        return save(figure, path)


def runs_table(runs: Mapping[str, Run]) -> Table:
    """Recorded signals of several runs: start, end, least and greatest sample, signal by signal."""
    first = next(iter(runs.values()))
    rows = tuple(
        (
            with_label(run, name),
            run.look(name).unit,
            case,
            *map(shown, extremes(run.as_shown(name))),
        )
        for name in first.signals
        for case, run in runs.items()
    )
    header = ("signal", "unit", "run", "start", "end", "min", "max")
    return Table(first.title, header, rows, frozenset({3, 4, 5, 6}))


def _colors(count: int) -> list[object]:
    """Colours for lines: those of all figures, or a scale from dark to light for more of them."""
    if count <= len(LINES):
        return list(LINES[:count])
    from matplotlib import colormaps

    scale = colormaps["viridis"]
    return [scale(0.9 * n / (count - 1)) for n in range(count)]
