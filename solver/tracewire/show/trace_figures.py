"""Figures of a trace: residuals within windows, free runs, candidates, the restoring torque."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tracewire.array_types import Vector
from tracewire.fit import Comparison
from tracewire.show.comparison_figures import plot_comparisons
from tracewire.show.limits import TRACE
from tracewire.show.style import (
    AFTER,
    BEFORE,
    MEASURED,
    QUIET,
    UNCOUNTED,
    USES,
    align_ylabels,
    cut,
    fit_time,
    panels,
    save,
    shortened,
    styled,
    with_gaps,
)
from tracewire.show.trace_steps import compares
from tracewire.trace import CandidateScore, Curve, Found, users_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot_residuals(found: Found, path: Path) -> Path:
    """Residuals in units of the noise within windows, before and after, with the windows' edges.

    Both are on one linear scale. Where that after is much smaller, it is drawn once more below,
    enlarged.
    """
    chosen = [c for c in found.curves if len(c.windowed_before) == len(c.t)]
    title = shortened("Residual within windows", len(chosen), TRACE.most_curves, "signals")
    chosen = chosen[: TRACE.most_curves]
    with styled():
        changed = bool(found.effects)
        drawn = [
            (curve, alone)
            for curve in chosen
            for alone in ((False, True) if changed and _unlike(curve) else (False,))
        ]
        heights = [1.4 if alone else 1.9 for _, alone in drawn]
        figure, axes = panels(heights, title, sharex=False)
        for panel, (curve, alone) in zip(axes, drawn, strict=True):
            _draw_residual(panel, curve, changed, alone)
        axes[-1].set_xlabel("t [s]")
        align_ylabels(axes)
        return save(figure, path)


def plot_free_runs(found: Found, path: Path) -> Path:
    """Measured against simulated in free runs of every series, first what played no part.

    The residuals before and after stand on one scale, in the unit of the user's files.
    """
    order = {"validate": 0, "gate": 1, "train": 2}
    compared = [
        Comparison(
            c.series, c.use, c.signal, found.units.get(c.signal, ""), c.t, c.measured, c.before,
            c.after, np.isfinite(c.measured), sigma=found.sigma.get(c.signal),
            users_unit=users_unit(found, c.signal),
        )
        for c in sorted(found.curves, key=lambda c: order.get(c.use, 3))
    ]  # fmt: skip
    return plot_comparisons(path, compared, "Free runs")


def plot_candidates(found: Found, path: Path) -> Path:
    """What each effect promised and gave, beside the part that declared parameters imitate."""
    steps = [(n, s) for n, s in enumerate(found.steps, start=1) if s.tried]
    refitted = [(n, s) for n, s in steps if any(math.isfinite(row.gain) for row in s.tried)]
    steps = refitted or steps[:1]  # where nothing stands out, nothing is seen
    heights = [0.75 + 0.27 * min(len(step.tried), TRACE.most_candidates) for _, step in steps]
    with styled():
        from matplotlib.figure import Figure

        figure = Figure(figsize=(9.0, sum(heights) + 0.6), layout="constrained")
        grid = figure.subplots(
            len(steps), 2, squeeze=False, width_ratios=[2.4, 1], height_ratios=heights
        )
        for (left, right), (number, step) in zip(grid, steps, strict=True):
            _draw_candidates(left, right, step.tried[: TRACE.most_candidates])
            if compares(step):
                left.set_xlabel("gain of prediction on held-out blocks")
                right.set_visible(False)  # no part of a model is masked
            text = f"step {number}: {step.words}"
            left.set_title(cut(text, 100), loc="left", fontsize=9.5)
        _explain_candidates(grid[0, 0])
        searched = [n for n, (_, step) in enumerate(steps) if not compares(step)]
        if searched:
            grid[searched[-1], 0].set_xlabel("gain: half the fall of BIC")
            grid[searched[-1], 1].set_xlabel("masked [%]")
        return save(figure, path)


def _unlike(curve: Curve) -> bool:
    """Whether the residual after would be flat on the scale of the one before."""
    before, after = (
        float(np.nanmax(np.abs(x), initial=0.0))
        for x in (curve.windowed_before, curve.windowed_after)
    )
    return before > TRACE.unlike * max(after, 1.0)


def _draw_residual(panel: Axes, curve: Curve, changed: bool, alone: bool) -> None:
    """Draw the residual within windows; `alone`: that after, without the one before."""
    before, after = curve.windowed_before, curve.windowed_after
    for begin, end, use in curve.spans or ((float(curve.t[0]), float(curve.t[-1]), curve.use),):
        color = USES.get(use, UNCOUNTED)
        panel.axvspan(begin, end, color=color, alpha=0.45, linewidth=0, zorder=0)
    for edge in curve.edges:
        panel.axvline(edge, color="white", linewidth=1.3, zorder=0.5)
    panel.axhspan(-2, 2, color="white", alpha=0.75, linewidth=0, zorder=0.3)
    if changed:
        if not alone:
            panel.plot(*with_gaps(curve.t, before), color=BEFORE, linewidth=0.9, label="before")
        panel.plot(*with_gaps(curve.t, after), color=AFTER, linewidth=0.8, label="after")
    else:
        panel.plot(*with_gaps(curve.t, after), color=AFTER, linewidth=0.8, label="declared model")
    panel.axhline(0.0, color=QUIET, linewidth=0.7)
    for level in (-2, 2):
        label = "±2 σ" if level > 0 else None
        panel.axhline(level, color=MEASURED, linewidth=0.7, linestyle=":", zorder=3, label=label)
    panel.set_ylabel("residual [σ]")
    words = f"rms {_rms(before):.3g} σ before, {_rms(after):.3g} σ after"
    told = words if changed else f"rms {_rms(after):.3g} σ"
    title = f"{curve.use}: {cut(curve.series, 40)}, {cut(curve.signal)}: {told}"
    panel.set_title("the residual after, enlarged" if alone else title, loc="left", fontsize=9.5)
    fit_time(panel, curve.t)
    panel.grid(False, axis="x")
    panel.legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=3, borderpad=0)


def _draw_candidates(left: Axes, right: Axes, rows: Sequence[CandidateScore]) -> None:
    places = np.arange(len(rows))[::-1]
    for at, row in zip(places, rows, strict=True):
        accepted = "accepted" in row.remark or "passed" in row.remark
        if math.isfinite(row.gain):
            left.barh(at, row.gain, height=0.6, color=AFTER if accepted else "#9DB8CC")
        if math.isfinite(row.promised):
            left.plot([row.promised] * 2, [at - 0.38, at + 0.38], color=BEFORE, linewidth=2.2)
        if math.isfinite(row.masked):
            right.barh(at, 100 * row.masked, height=0.6, color=QUIET)
    left.set_yticks(places, [cut(row.effects, 44) for row in rows])
    left.axvline(0, color=QUIET, linewidth=0.7)
    right.set_yticks(places, [""] * len(rows))
    right.set_xlim(0, 100)
    for panel in (left, right):
        panel.set_ylim(-0.6, len(rows) - 0.4)
        panel.grid(False, axis="y")
        panel.tick_params(axis="y", length=0)


def _explain_candidates(panel: Axes) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles = [
        Line2D([], [], color=BEFORE, linewidth=2.2, label="promised by the screen"),
        Patch(color=AFTER, label="refitted, passed the gate"),
        Patch(color="#9DB8CC", label="refitted"),
    ]
    panel.legend(handles=handles, loc="lower right", fontsize=8)


def _rms(values: Vector) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else math.nan
