"""`plot_comparisons`: measured against simulated, with the residual under it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.errors import OptionError, Problem
from tracewire.fit import Comparison
from tracewire.show.limits import FIGURE, FIT, WORD
from tracewire.show.style import (
    AFTER,
    BAND,
    BEFORE,
    MEASURED,
    QUIET,
    UNCOUNTED,
    USES,
    align_ylabels,
    cut,
    dots,
    fit_time,
    panels,
    plain_numbers,
    save,
    shortened,
    styled,
    with_gaps,
    with_unit,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


ENLARGED = "the residual after, enlarged"


def plot_comparisons(path: str | Path, comparisons: Sequence[Comparison], title: str = "") -> Path:
    """Draw each measured signal of each series, the model before and after, and the residual, in
    the unit in which the user has the signal.

    Samples that do not count are pale and their time is shaded; a signal that is compared modulo a
    period is drawn on the branch of the measurement. The strip below is measured - simulated before
    and after the fit on one linear scale, with +-2 sigma where sigma is known; where the residual
    after the fit is much smaller, another strip shows it alone, enlarged.
    Raises OptionError: no comparison, another ending of the file; OSError.
    """
    if not comparisons:
        what = "a figure of no measured signal cannot be drawn"
        raise OptionError([Problem(what, hint="Compare at least one series.")])
    title = shortened(title, len(comparisons), FIT.most_comparisons, "signals")
    chosen = [compared.as_shown for compared in comparisons[: FIT.most_comparisons]]
    with styled():
        heights = [[2.3, 1.0, *([1.0] if differ_much(c) else [])] for c in chosen]
        figure, axes = panels([h for each in heights for h in each], title, sharex=False)
        left = iter(axes)
        for compared, own in zip(chosen, heights, strict=True):
            draw_comparison(next(left), next(left), compared)
            if len(own) > 2:
                _draw_enlarged(next(left), compared)
        axes[-1].set_xlabel("t [s]")
        align_ylabels(axes)
        return save(figure, path)


def differ_much(compared: Comparison) -> bool:
    """Whether the residual after the fit would be flat on the scale of the one before."""
    before, after = compared.residual_before, compared.residual_after
    old, new = (root_mean_square(x, compared.counts) for x in (before, after))
    return bool(np.isfinite(old) and old > FIT.far * new > 0)


def draw_comparison(upper: Axes, lower: Axes, compared: Comparison, now: str = "after") -> None:
    """Draw one comparison into a panel and the strip under it; `now` names the fitted model."""
    t, counts = compared.t, compared.counts
    left_before, left_after = compared.residual_before, compared.residual_after
    before, after = compared.measured - left_before, compared.measured - left_after
    points = dots(len(t)) | {"rasterized": len(t) > FIGURE.many_points}
    upper.plot(t[counts], compared.measured[counts], label="measured", **points)
    if not counts.all():
        upper.plot(t[~counts], compared.measured[~counts], **points | {"alpha": 0.2})
    # the dashes above the line: both are seen where they agree
    many = len(t) > FIGURE.many_points
    old, new = (with_gaps(t, _unjoined(y, compared.period)) for y in (before, after))
    upper.plot(*old, "--", color=BEFORE, linewidth=1.1, zorder=3, label="before", rasterized=many)
    upper.plot(*new, color=AFTER, label=now, rasterized=many)
    limit(upper, (compared.measured, after), before)
    upper.set_ylabel(with_unit(cut(compared.signal), compared.unit))
    upper.tick_params(labelbottom=False)
    _draw_strip(lower, compared, left_before, left_after, many)
    _write_titles(upper, lower, compared, now)
    for panel in (upper, lower):
        for k, (begin, end) in enumerate(_uncounted(t, counts)):
            label = "does not count" if k == 0 and panel is upper else None
            panel.axvspan(begin, end, color=UNCOUNTED, linewidth=0, zorder=0, label=label)
        fit_time(panel, t)
        plain_numbers(panel.yaxis)
    upper.legend(
        loc="lower right",
        bbox_to_anchor=(1, 0.98),
        ncols=4,
        borderpad=0,
        markerscale=6 / points["markersize"],
    )


def limit(panel: Axes, shown: Sequence[Vector], far: Vector) -> None:
    """Limits of y that hold `shown`, and `far` as long as it does not make these flat."""
    near = np.concatenate([values[np.isfinite(values)] for values in shown])
    far = far[np.isfinite(far)]
    if not len(near):
        return
    low, high = float(near.min()), float(near.max())
    size = max(abs(low), abs(high))
    span = high - low if high - low > FIT.resolved * size else size or 1.0
    if len(far):
        low = max(min(low, float(far.min())), low - FIT.far / 2 * span)
        high = min(max(high, float(far.max())), high + FIT.far / 2 * span)
    margin = 0.05 * max(high - low, span)
    panel.set_ylim(low - margin, high + margin)


def root_mean_square(values: Vector, counts: NDArray[np.bool_]) -> float:
    """Root mean square of the samples that count; NaN where there are none."""
    chosen = values[counts]
    largest = float(np.abs(chosen).max(initial=0.0))
    if largest == 0 or not np.isfinite(largest):
        return largest if len(chosen) else float("nan")
    return largest * float(np.sqrt(np.mean((chosen / largest) ** 2)))  # no square overflows


def _draw_strip(
    panel: Axes, compared: Comparison, before: Vector, after: Vector, many: bool
) -> None:
    _draw_noise(panel, compared.sigma)
    for residual, color, width in ((before, BEFORE, 0.7), (after, AFTER, 0.8)):
        curve = with_gaps(compared.t, residual)
        panel.plot(*curve, color=color, linewidth=width, rasterized=many)
    shown = [_counted(after, compared), _edges(compared.sigma)]
    if differ_much(compared):
        shown.append(_counted(before, compared))
    limit(panel, shown, before)
    panel.set_ylabel(with_unit("residual", compared.unit).replace(" ", "\n", 1))


def _draw_enlarged(panel: Axes, compared: Comparison) -> None:
    """Draw the residual after the fit alone, with a scale of its own."""
    after = compared.residual_after
    _draw_noise(panel, compared.sigma)
    many = len(after) > FIGURE.many_points
    panel.plot(*with_gaps(compared.t, after), color=AFTER, linewidth=0.8, rasterized=many)
    limit(panel, (_counted(after, compared), _edges(compared.sigma)), np.array([]))
    panel.set_ylabel(with_unit("after", compared.unit).replace(" ", "\n", 1))
    panel.set_title(ENLARGED, fontsize=8.5, color="#555555", loc="left", pad=3)
    fit_time(panel, compared.t)
    plain_numbers(panel.yaxis)


def _draw_noise(panel: Axes, sigma: float | None) -> None:
    """Draw zero, and the band of +-2 sigma with its name."""
    panel.axhline(0.0, color=QUIET, linewidth=0.7)
    if sigma is None:
        return
    panel.axhspan(-2 * sigma, 2 * sigma, color=BAND, linewidth=0, zorder=0.2, label="±2 σ")
    for edge in (-2 * sigma, 2 * sigma):
        panel.axhline(edge, color=MEASURED, linewidth=0.7, linestyle=":", zorder=3)
    panel.legend(loc="lower right", bbox_to_anchor=(1, 0.98), borderpad=0, handlelength=1.2)


def _edges(sigma: float | None) -> Vector:
    """What a strip shows at least."""
    return np.array([0.0] if sigma is None else [-2.5 * sigma, 2.5 * sigma])


def _counted(values: Vector, compared: Comparison) -> Vector:
    return values[compared.counts] if compared.counts.any() else values


def _write_titles(upper: Axes, lower: Axes, compared: Comparison, now: str) -> None:
    upper.text(
        0.0,
        1.03,
        f" {compared.use}: {cut(compared.series, 40)} ",
        transform=upper.transAxes,
        fontsize=9,
        bbox={"facecolor": USES.get(compared.use, "#EEEEEE"), "edgecolor": "none", "pad": 2.0},
    )
    before = root_mean_square(compared.residual_before, compared.counts)
    after = root_mean_square(compared.residual_after, compared.counts)
    if compared.sigma and after < WORD.nothing * compared.sigma:
        after = 0.0
    unit = f" {compared.unit}" if compared.unit else ""
    words = [
        f"{when}: " + (f"{value:.3g}{unit}" if np.isfinite(value) else "no run")
        for when, value in (("before", before), (now, after))
    ]
    text = f"rms of the residual {', '.join(words)}"
    if compared.sigma and np.isfinite(after):
        text += f" = {after / compared.sigma:.3g} σ"
    lower.set_title(text, fontsize=8.5, color="#555555", loc="left", pad=3)


def _unjoined(values: Vector, period: float) -> Vector:
    """A signal modulo a period without the lines from one end of the period to the other."""
    if period <= 0 or len(values) < 2:
        return values
    jumps = np.flatnonzero(np.abs(np.diff(values)) > period / 2)
    values = values.copy()
    values[jumps] = np.nan
    return values


def _uncounted(t: Vector, counts: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """The stretches of time (s) whose samples do not count; single samples among others are none.

    A stretch ends half-way to the next sample that counts.
    """
    edges = np.flatnonzero(np.diff(counts.astype(int)))
    middle = ((t[edges] + t[edges + 1]) / 2).tolist()
    borders = [float(t[0]), *middle, float(t[-1])]
    states = [bool(counts[0]), *counts[edges + 1].tolist()]
    lengths = np.diff([0, *(edges + 1), len(t)])
    return [
        (begin, end)
        for begin, end, counted, length in zip(borders, borders[1:], states, lengths, strict=False)
        if not counted and length > 1
    ]
