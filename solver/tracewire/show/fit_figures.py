"""Figures of a fit and of a trace, drawn from plain arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracewire.errors import OptionError, Problem
from tracewire.show.limits import FIT
from tracewire.show.style import (
    AFTER,
    BEFORE,
    QUIET,
    USES,
    align_ylabels,
    dots,
    fit_time,
    panels,
    save,
    shortened,
    styled,
    with_unit,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


Vector = NDArray[np.float64]


def plot_fit(
    path: str | Path,
    series: Sequence[tuple[str, ArrayLike, ArrayLike, ArrayLike, ArrayLike]],
    unit: str | Sequence[str] = "",
    title: str = "",
) -> Path:
    """Draw measured points, the model before and after a fit, and the residuals under them.

    `series` holds (name, t, measured, before, after), each array (N,), t in s; `unit` is that of
    all of them, or a list with one for each. The residual is measured - model, in the same unit.
    Raises OptionError: no series, arrays of different lengths, another ending of the file; OSError.
    """
    units = [unit] * len(series) if isinstance(unit, str) else list(unit)
    table = [(row[0], _columns(row[0], row[1:])) for row in series]
    if not table or len(units) != len(table):
        what = f"a figure of {len(table)} series with {len(units)} units cannot be drawn"
        raise OptionError(
            [Problem(what, hint="Give at least one series, and one unit or one each.")]
        )
    title = shortened(title, len(table), FIT.most_series, "series")
    table = table[: FIT.most_series]
    with styled():
        figure, axes = panels([2.3, 1.0] * len(table), title, sharex=False)
        for n, ((name, columns), shown) in enumerate(zip(table, units, strict=False)):
            t, measured, before, after = columns
            upper, lower = axes[2 * n], axes[2 * n + 1]
            points = dots(len(t))
            upper.plot(t, measured, label="measured", **points)
            # the dashes above the line: both are seen where they agree
            upper.plot(t, before, "--", color=BEFORE, linewidth=1.1, zorder=3, label="before")
            upper.plot(t, after, color=AFTER, label="after")
            upper.set_ylabel(with_unit(name, shown))
            upper.legend(
                loc="lower right",
                bbox_to_anchor=(1, 0.98),
                ncols=3,
                borderpad=0,
                markerscale=6 / points["markersize"],
            )
            upper.tick_params(labelbottom=False)
            lower.plot(t, measured - before, color=BEFORE, linewidth=0.9)
            lower.plot(t, measured - after, color=AFTER, linewidth=0.9)
            lower.axhline(0.0, color=QUIET, linewidth=0.7)
            lower.set_ylabel(with_unit("residual", shown))
            lower.set_title(
                f"rms of the residual: {_rms(measured - before):.3g} before, "
                f"{_rms(measured - after):.3g} after" + (f" [{shown}]" if shown else ""),
                fontsize=8.5, color="#555555", loc="left", pad=3,
            )  # fmt: skip
            fit_time(upper, t)
            fit_time(lower, t)
        axes[-1].set_xlabel("t [s]")
        align_ylabels(axes)
        return save(figure, path)


def plot_residual(
    path: str | Path,
    series: Sequence[tuple[str, ArrayLike, ArrayLike, ArrayLike]],
    windows: Mapping[str, Sequence[tuple[float, float, str]]] | None = None,
    unit: str = "σ",
    title: str = "",
    band: float | None = None,
) -> Path:
    """Draw the residual of each series before and after effects were added.

    `series` holds (name, t, before, after), each array (N,), t in s. `windows` maps the name of a
    series to (begin, end, use), with use train, gate or validate, which is shaded. `band` draws
    lines at ± that residual, such as 2 for two σ of the noise. Raises OptionError: no series,
    arrays of different lengths, another ending of the file; OSError.
    """
    table = [(row[0], _columns(row[0], row[1:])) for row in series]
    if not table:
        what = "a figure of no series cannot be drawn"
        raise OptionError([Problem(what, hint="Give at least one series.")])
    title = shortened(title, len(table), FIT.most_series, "series")
    table = table[: FIT.most_series]
    found = windows or {}
    with styled():
        figure, axes = panels([1.9] * len(table), title, sharex=False)
        for panel, (name, (t, before, after)) in zip(axes, table, strict=True):
            for begin, end, use in found.get(name, ()):
                panel.axvspan(begin, end, color=USES.get(use, "#EEEEEE"), linewidth=0, zorder=0)
                panel.axvline(begin, color="white", linewidth=1.0, zorder=0.5)
            panel.plot(t, before, color=BEFORE, linewidth=0.9, label="before")
            panel.plot(t, after, color=AFTER, linewidth=0.9, label="after")
            panel.axhline(0.0, color=QUIET, linewidth=0.7)
            if band is not None:
                for level in (-band, band):
                    panel.axhline(level, color=QUIET, linewidth=0.8, linestyle=":")
            panel.set_ylabel(with_unit("residual", unit))
            panel.set_title(f"{name}: rms {_rms(before):.3g} before, {_rms(after):.3g} after",
                            loc="left", fontsize=9.5)  # fmt: skip
            fit_time(panel, t)
            used = list(dict.fromkeys(use for _, _, use in found.get(name, ())))
            _legend(panel, used)
        axes[-1].set_xlabel("t [s]")
        align_ylabels(axes)
        return save(figure, path)


def _legend(panel: Axes, uses: Sequence[str]) -> None:
    from matplotlib.patches import Patch

    lines, labels = panel.get_legend_handles_labels()
    handles = [*lines]
    handles += [Patch(color=USES.get(use, "#EEEEEE"), label=use) for use in uses]
    panel.legend(
        handles,
        [*labels, *uses],
        loc="lower right",
        bbox_to_anchor=(1, 0.98),
        ncols=len(handles),
        borderpad=0,
    )


def _columns(name: str, arrays: Sequence[ArrayLike]) -> list[Vector]:
    columns = [np.asarray(array, dtype=float).ravel() for array in arrays]
    lengths = {len(column) for column in columns}
    if len(lengths) != 1 or lengths == {0}:
        shown = ", ".join(str(len(column)) for column in columns)
        what = f"the arrays of the series '{name}' have {shown} values"
        raise OptionError([Problem(what, hint="Give the same number of values, at least one.")])
    return columns


def _rms(values: Vector) -> float:
    return float(np.sqrt(np.mean(values**2)))
