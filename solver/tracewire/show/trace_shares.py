"""How much of the error the named effects explain, in each held-out block of time."""

from __future__ import annotations

from itertools import groupby
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from tracewire.show.limits import TRACE
from tracewire.show.style import AFTER, BAND, BEFORE, QUIET, cut, plain_log, save, styled
from tracewire.show.trace_words import excess_words
from tracewire.trace import Explained, Found, HeldOut

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FLOOR = "#009E73"


def plot_held_out(found: Found, path: Path) -> Path:
    """The error of each held-out block at each horizon: declared, with the effects, the floor.

    Above it is the share of the excess that the effects explain, with its 95 % interval.
    """
    from matplotlib.figure import Figure

    bar = found.explained is not None
    heights = [*([0.55] if bar else []), *([2.4] * len(found.held_out))]
    with styled():
        figure = Figure(figsize=(9.0, sum(heights) + 0.9), layout="constrained")
        grid = figure.subplots(len(heights), 1, squeeze=False, height_ratios=heights)[:, 0]
        if found.explained is not None:
            _draw_share(grid[0], found.explained, excess_words(found))
        for panel, held in zip(grid[int(bar) :], found.held_out, strict=True):
            _draw_blocks(panel, held)
        lines, labels = grid[-1].get_legend_handles_labels()
        figure.legend(lines, labels, loc="outside lower center", ncols=4)
        return save(figure, path)


def _draw_share(panel: Axes, explained: Explained, words: str) -> None:
    share = float(np.clip(explained.share, 0, 1))
    panel.barh(0, 1, height=0.7, color=BAND)
    panel.barh(0, share, height=0.7, color=AFTER)
    below, above = max(explained.share - explained.low, 0), max(explained.high - explained.share, 0)
    panel.errorbar([explained.share], [0], xerr=[[below], [above]], color="black", capsize=4)
    panel.set_xlim(min(0.0, explained.low), max(1.0, explained.high))
    panel.xaxis.set_major_formatter(lambda x, _: f"{100 * x:.0f} %")
    panel.set_yticks([])
    panel.grid(False)
    panel.spines["left"].set_visible(False)
    panel.set_title(fill(f"explained: {words}", TRACE.title_width), loc="left")


def _draw_blocks(panel: Axes, held: HeldOut) -> None:
    at = np.arange(len(held.begin))
    errors = (held.declared, held.best, held.floor)
    declared, best, floor = (np.maximum(x, TRACE.least_error) for x in errors)
    panel.vlines(at, best, declared, color=QUIET, linewidth=0.8, alpha=0.6, zorder=1)
    panel.plot(at, declared, color=BEFORE, marker="s", markersize=4.5, linestyle="",
               label="declared model")  # fmt: skip
    panel.plot(at, best, color=AFTER, marker="o", markersize=4.5, linestyle="",
               label="with the effects")  # fmt: skip
    if len(floor):
        panel.plot(at, floor, color=FLOOR, marker="_", markersize=9, markeredgewidth=2,
                   linestyle="", label="floor: the best smooth map")  # fmt: skip
    panel.axhline(1.0, color=QUIET, linestyle=":", linewidth=1.0, label="noise (1 σ)")
    every = np.concatenate([held.declared, held.best, held.floor, [1.0]])
    every = every[np.isfinite(every) & (every > 0)]
    low, high = max(0.8 * float(every.min()), TRACE.least_error), 1.25 * float(every.max())
    high *= (high / low) ** 0.15  # room for the names of the series
    panel.set_yscale("log")
    panel.set_ylim(low, high)
    plain_log(panel.yaxis, low, high)
    panel.set_xlim(-0.7, len(at) - 0.3)
    panel.set_ylabel("error [σ]")
    begin = 0
    names = [(name, len(list(group))) for name, group in groupby(held.series)]
    few = at[:: max(1, -(-len(at) // 9))]
    panel.set_xticks(few, [f"{held.begin[n]:g} s" for n in few])
    for name, count in names:
        if begin:
            panel.axvline(begin - 0.5, color=QUIET, linewidth=0.8)
        if len(names) <= TRACE.named_series:
            panel.text(begin - 0.4, 0.97, cut(name, 16), transform=panel.get_xaxis_transform(),
                       va="top", fontsize=8, color="#555555")  # fmt: skip
        begin += count
    panel.grid(False, axis="x")
    panel.set_title(f"predicted over {held.horizon:.3g} s, in blocks of time that no fit saw",
                    loc="left", fontsize=9.5)  # fmt: skip
