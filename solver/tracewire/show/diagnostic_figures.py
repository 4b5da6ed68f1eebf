"""Figures of what a fit leaves over, and of how it worsens away from its best."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tracewire.array_types import Vector
from tracewire.errors import OptionError, Problem
from tracewire.fit import Diagnosis, Fit, Profile, diagnose
from tracewire.fit.limits import DIAGNOSIS
from tracewire.formula import two_digits
from tracewire.show.limits import FIGURE, FIT
from tracewire.show.style import (
    AFTER,
    BAND,
    LINES,
    MARK,
    MEASURED,
    QUIET,
    USES,
    cut,
    dots,
    fit_time,
    plain_numbers,
    save,
    shortened,
    styled,
    with_unit,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot_diagnostics(fit: Fit, path: str | Path, found: Sequence[Diagnosis] | None = None) -> Path:
    """Draw what is left of each measured signal of each series, a row each.

    Residual over time with +-2 of the noise; its autocorrelation with the band in which white noise
    stays; its histogram beside the normal density of the same root mean square; where the series
    has inputs its correlation with their past. `found` is what `diagnose` says, where it is known.
    Raises OptionError: no signal with enough samples,
    another ending of the file; OSError.
    """
    found = diagnose(fit) if found is None else found
    if not found:
        what = "no measured signal has enough samples for a diagnosis of its residual"
        raise OptionError([Problem(what)])
    title = shortened("What is left after the fit", len(found), FIT.most_residuals, "signals")
    shown = found[: FIT.most_residuals]
    inputs = {m.name: m.inputs for m in fit.measured}
    driven = any(inputs[d.series] for d in shown)
    columns = 4 if driven else 3
    with styled():
        from matplotlib.figure import Figure

        size = (FIGURE.width + driven, 2.0 * len(shown) + 0.8)
        figure = Figure(figsize=size, layout="constrained")
        figure.suptitle(f"{title}; bands: ±2 of the noise, and where white noise would stay",
                        fontsize=12, x=0.01, ha="left")  # fmt: skip
        grid = figure.subplots(
            len(shown), columns, squeeze=False, width_ratios=[2.2, 1.4, 1.0, 1.4][:columns]
        )
        for row, one in zip(grid, shown, strict=True):
            t = _times(fit, one)
            _draw_time(row[0], one, t)
            _draw_autocorrelation(row[1], one)
            _draw_histogram(row[2], one)
            if driven:
                known = {n: np.interp(t, *xy) for n, xy in inputs[one.series].items()}
                _draw_cross_correlation(row[3], one, known)
        grid[-1, 0].set_xlabel("t [s]")
        grid[-1, 1].set_xlabel("lag [s]")
        grid[-1, 2].set_xlabel("residual / rms")
        return save(figure, path)


def _times(fit: Fit, one: Diagnosis) -> Vector:
    """The times of the residual's samples."""
    (own,) = (c for c in fit.comparisons if (c.series, c.signal) == (one.series, one.signal))
    return np.asarray(own.t[own.counts & np.isfinite(own.after)])


def _draw_time(panel: Axes, one: Diagnosis, t: Vector) -> None:
    unit, factor = one.users_unit
    noise = one.noise / factor
    panel.axhspan(-2 * noise, 2 * noise, color=BAND, linewidth=0, zorder=0.2)
    points = dots(len(t)) | {"color": AFTER, "rasterized": len(t) > FIT.residual_points}
    panel.plot(t, one.residual / factor, **points)
    panel.axhline(0.0, color=QUIET, linewidth=0.7)
    panel.set_ylabel(with_unit("residual", unit or one.unit).replace(" ", "\n", 1))
    fit_time(panel, t)
    panel.text(
        0.0,
        1.05,
        f" {one.use}: {cut(one.series)}, {cut(one.signal)} ",
        transform=panel.transAxes,
        fontsize=9,
        bbox={"facecolor": USES.get(one.use, "#EEEEEE"), "edgecolor": "none", "pad": 2.0},
    )
    plain_numbers(panel.yaxis)


def _draw_autocorrelation(panel: Axes, one: Diagnosis) -> None:
    panel.axhspan(-one.band, one.band, color=BAND, linewidth=0, zorder=0.2)
    lags = one.lags[1:] * one.step
    color = AFTER if one.is_white else MARK
    panel.vlines(lags, 0.0, one.correlation[1:], color=color, linewidth=2.0)
    panel.axhline(0.0, color=QUIET, linewidth=0.7)
    largest = float(np.abs(one.correlation[1:]).max(initial=0.0))
    edge = max(1.15 * largest, 2 * one.band)
    panel.set_ylim(-edge if one.correlation.min() < -one.band else -0.35 * edge, edge)
    panel.set_xlim(0.0, float(lags[-1]) + one.step)
    panel.set_ylabel("autocorrelation")
    plain_numbers(panel.xaxis, panel.yaxis)
    word = "white" if one.is_white else f"correlated over {two_digits(one.memory)} s"
    if one.is_white and one.whiteness < DIAGNOSIS.doubt:
        word = "correlated, too little to matter"
    panel.set_title(word, loc="left", fontsize=8.5, color=color, pad=5)


def _draw_histogram(panel: Axes, one: Diagnosis) -> None:
    panel.set_visible(one.size > 0)
    if one.size > 0:
        low, high = -FIT.histogram, FIT.histogram
        relative = np.clip(one.residual / one.size, low, high)
        bins = int(np.clip(2 * len(relative) ** (1 / 3), 7, 41))
        panel.hist(relative, bins=bins, range=(low, high), density=True, color=AFTER, alpha=0.5)
        x = np.linspace(low, high, 181)
        panel.plot(x, np.exp(-(x**2) / 2) / math.sqrt(2 * math.pi), color=MEASURED, linewidth=1.1)
    panel.set_yticks([])
    panel.set_xticks([-3, 0, 3])
    panel.spines["left"].set_visible(False)
    word = f", {two_digits(100 * one.outliers)} % outliers" if one.outliers > 0 else ""
    panel.set_title(f"histogram{word}", loc="left", fontsize=8.5, color="#555555", pad=5)


def _draw_cross_correlation(panel: Axes, one: Diagnosis, inputs: dict[str, Vector]) -> None:
    from scipy.signal import correlate

    if not inputs:
        panel.set_visible(False)
        return
    count = len(one.residual)
    x = one.residual - one.residual.mean()
    panel.axhspan(-one.band, one.band, color=BAND, linewidth=0, zorder=0.2)
    words = []
    for n, (name, values) in enumerate(inputs.items()):
        y = values - values.mean()
        size = float(np.linalg.norm(x) * np.linalg.norm(y))
        if size > 0:
            cross = correlate(x, y)[count - 1 :][: len(one.lags)] / size
            panel.plot(one.lags * one.step, cross, color=LINES[n % len(LINES)], label=cut(name, 14))
        if one.independence.get(name, 1.0) < DIAGNOSIS.doubt:
            words.append(cut(name, 14))
    panel.axhline(0.0, color=QUIET, linewidth=0.7)
    low, high = panel.get_ylim()
    edge = max(-low, high, 2 * one.band)
    panel.set_ylim(-edge, (1.4 if len(inputs) > 1 else 1.0) * edge)  # room for a legend
    if len(inputs) > 1:
        panel.legend(fontsize=7.5, loc="upper right", borderpad=0)
    alone = f"with {cut(next(iter(inputs)))}" if len(inputs) == 1 else "with the inputs"
    title = f"depends on {', '.join(words)}" if words else alone
    panel.set_ylabel("correlation")
    panel.set_xlabel("input earlier by [s]", fontsize=8.5)
    plain_numbers(panel.xaxis)
    panel.set_title(title, loc="left", fontsize=8.5, color=MARK if words else "#555555", pad=5)


def plot_profiles(profiles: Sequence[Profile], path: str | Path) -> Path:
    """Draw profile likelihoods: the rise of -2 log likelihood over each held value, in SI.

    The dotted line is the 95 % level, the shade the interval in which the rise stays below it.
    Raises OptionError: no profile, another ending of the file; OSError.
    """
    if not profiles:
        what, hint = (
            "a figure of no profile cannot be drawn",
            "Compute one with profile(fit, name).",
        )
        raise OptionError([Problem(what, hint=hint)])
    title = shortened("Profile likelihood", len(profiles), FIT.most_profiles, "values")
    shown = profiles[: FIT.most_profiles]
    columns = min(len(shown), 3)
    rows = -(-len(shown) // columns)
    with styled():
        from matplotlib.figure import Figure

        figure = Figure(figsize=(FIGURE.width if columns > 1 else 5.5, 2.6 * rows + 0.6),
                        layout="constrained")  # fmt: skip
        figure.suptitle(title, fontsize=12, x=0.01, ha="left")
        grid = figure.subplots(rows, columns, squeeze=False)
        for panel, one in zip(grid.ravel(), shown, strict=False):
            _draw_profile(panel, one)
        for panel in grid.ravel()[len(shown) :]:
            panel.set_visible(False)
        for panel in grid[:, 0]:
            panel.set_ylabel("rise of -2 log L")
        return save(figure, path)


def _draw_profile(panel: Axes, one: Profile) -> None:
    low, high = (
        end if math.isfinite(end) else edge
        for end, edge in zip(one.interval, (one.values[0], one.values[-1]), strict=True)
    )
    panel.axvspan(low, high, color=BAND, linewidth=0, zorder=0)
    panel.axhline(one.level, color=MEASURED, linewidth=0.9, linestyle=":")
    panel.plot(one.values, one.rise, "o-", color=AFTER, markersize=3)
    nearest = np.flatnonzero(np.abs(one.rise) == np.abs(one.rise).min())
    best = one.values[nearest[len(nearest) // 2]]
    panel.plot([best], [0.0], "o", color=MARK, markersize=4.5, zorder=4)
    panel.set_ylim(min(-0.04 * one.level, 1.1 * float(one.rise.min())), 2.2 * one.level)
    plain_numbers(panel.xaxis)
    known = [math.isfinite(end) for end in one.interval]
    if all(known):
        word = f"95 %: {low:.4g} to {high:.4g}"
    else:
        sides = [side for side, ok in zip(("below", "above"), known, strict=True) if not ok]
        word = f"not determined from {' and '.join(sides)}"
    panel.set_title(f"{cut(one.name)}\n{word}", loc="left", fontsize=9,
                    color="#222222" if all(known) else MARK)  # fmt: skip
