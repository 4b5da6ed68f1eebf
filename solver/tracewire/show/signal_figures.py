"""Figures of one signal: spectra, scalograms, growth; of exponents and invariants over time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tracewire.analyse import Drift, GrowthRate, Lyapunov, Scalogram, Spectrum
from tracewire.errors import OptionError, Problem
from tracewire.show.limits import FIGURE
from tracewire.show.style import (
    LINES,
    MARK,
    QUIET,
    fit_time,
    panels,
    plain_log,
    save,
    styled,
    with_unit,
)


def plot_spectrum(found: Spectrum, path: str | Path, high: float | None = None) -> Path:
    """Draw an amplitude spectrum, logarithmic, with its largest lines named.

    Up to `high` in Hz, or to where nothing above a hundred-thousandth is left. Raises OptionError,
    OSError.
    """
    found = found.as_shown
    top = float(found.amplitude.max(initial=0.0))
    if not top > 0:
        what = f"the spectrum of '{found.signal}' is zero"
        raise OptionError([Problem(what, hint="Draw a signal that moves.")])
    seen = np.flatnonzero(found.amplitude > 10 * FIGURE.floor * top)
    end = high or 1.15 * float(found.frequency[seen[-1]]) or float(found.frequency[-1])
    end = min(end, float(found.frequency[-1]))
    with styled():
        figure, (panel,) = panels([3.8], found.title)
        chosen = found.frequency <= end
        panel.semilogy(
            found.frequency[chosen],
            np.maximum(found.amplitude[chosen], FIGURE.floor * top),
            color=LINES[0],
            linewidth=0.9,
        )
        named: list[float] = []
        for line in found.lines:
            near = any(abs(line.frequency - other) < 0.08 * end for other in named)
            if line.frequency > end or near or len(named) == FIGURE.most_labels:
                continue
            named.append(line.frequency)
            panel.plot(line.frequency, line.amplitude, "o", color=MARK, markersize=3.5)
            panel.annotate(
                f"{line.frequency:.4g} Hz",
                (line.frequency, line.amplitude),
                xytext=(4, 4),
                textcoords="offset points",
                fontsize=8.5,
                color=MARK,
            )
        panel.set_xlim(0, end)
        panel.set_ylim(FIGURE.floor * top, 4 * top)
        plain_log(panel.yaxis, FIGURE.floor * top, 4 * top)
        panel.set_xlabel("frequency [Hz]")
        panel.set_ylabel(with_unit(f"amplitude of {found.signal}", found.unit))
        return save(figure, path)


def plot_scalogram(found: Scalogram, path: str | Path) -> Path:
    """Draw the amplitudes over time and frequency, pale where the ends of the signal reach.

    The line is the ridge. Raises OptionError, OSError.
    """
    found = found.as_shown
    with styled():
        figure, (panel,) = panels([4.4], found.title)
        every = max(1, len(found.t) // FIGURE.scalogram_pixels)
        mesh = panel.pcolormesh(
            found.t[::every],
            found.frequency,
            found.amplitude[:, ::every],
            cmap="viridis",
            shading="nearest",
            rasterized=True,
        )
        bar = figure.colorbar(mesh, ax=panel, pad=0.01)
        bar.set_label(with_unit(f"amplitude of {found.signal}", found.unit))
        panel.set_yscale("log")
        panel.grid(False)
        first, last = float(found.t[0]), float(found.t[-1])
        edge = np.minimum(found.edge, 0.5 * (last - first))
        for outer, side in ((first, first + edge), (last, last - edge)):
            panel.fill_betweenx(
                found.frequency, outer, side, color="white", alpha=0.45, linewidth=0
            )
        panel.plot(found.t, found.ridge, color="white", linewidth=0.9, alpha=0.9)
        low, high = float(found.frequency[0]), float(found.frequency[-1])
        panel.set_ylim(low, high)
        plain_log(panel.yaxis, low, high)
        fit_time(panel, found.t)
        panel.set_xlabel("t [s]")
        panel.set_ylabel("frequency [Hz]")
        return save(figure, path)


def plot_growth(found: GrowthRate, path: str | Path) -> Path:
    """Draw the points of an envelope, logarithmic, with the line whose slope is the rate."""
    found = found.as_shown
    with styled():
        figure, (panel,) = panels([3.4])
        panel.semilogy(found.t, found.size, ".", color=LINES[0], label="envelope")
        line = np.exp(found.level + found.rate * found.t)
        told = f"exp({found.rate:.5g} t), ± {found.error:.1g} /s"
        panel.semilogy(found.t, line, color=MARK, linewidth=1.0, label=told)
        plain_log(panel.yaxis, float(found.size.min()), float(found.size.max()))
        panel.set_xlabel("t [s]")
        panel.set_ylabel(with_unit(f"size of {found.signal}", found.unit))
        panel.legend(loc="best")
        return save(figure, path)


def plot_lyapunov(found: Lyapunov, path: str | Path, title: str = "") -> Path:
    """Draw the running estimates of Lyapunov exponents, with the last one and its error."""
    count = found.running.shape[1]
    with styled():
        figure, (panel,) = panels([4.0], title)
        shown = found.t > 0.02 * found.t[-1]  # before that the estimate is wild
        for k in range(count):
            value, error = float(found.exponents[k]), float(found.errors[k])
            if not np.isfinite(value):
                continue
            color = LINES[k % len(LINES)]
            panel.plot(found.t[shown], found.running[shown, k], color=color, linewidth=1.0)
            panel.axhspan(value - error, value + error, color=color, alpha=0.12, linewidth=0)
            panel.annotate(
                f"{value:.4g} ± {error:.1g}",
                (1.0, value),
                xycoords=("axes fraction", "data"),
                xytext=(6, 0),
                textcoords="offset points",
                va="center",
                fontsize=8.5,
                color=color,
            )
        panel.axhline(0.0, color=QUIET, linewidth=0.8)
        panel.set_xlim(0, float(found.t[-1]))
        panel.set_xlabel("t [s]")
        panel.set_ylabel("Lyapunov exponents [1/s]")
        if found.divergence is not None:
            panel.set_title(
                f"sum {found.total:.5g} 1/s, mean divergence {found.divergence:.5g} 1/s",
                loc="left",
                fontsize=9,
                color="#555555",
            )
        return save(figure, path)


def plot_invariants(found: Sequence[Drift], path: str | Path, title: str = "") -> Path:
    """Draw the drift of invariants over time, one panel each, as a part of their scale."""
    if not found:
        raise OptionError([Problem("no invariant is there to draw", hint="Name one.")])
    with styled():
        figure, below = panels([2.0] * len(found), title)
        for panel, drift in zip(below, (one.as_shown for one in found), strict=True):
            panel.plot(drift.t, drift.values / (drift.scale or 1.0), color=LINES[0], linewidth=0.9)
            panel.set_ylabel(f"drift of {drift.name}")
            told = f"largest {drift.relative:.2g} of {drift.scale:.4g} {drift.unit}".rstrip()
            panel.set_title(told, loc="left", fontsize=9, color="#555555")
            fit_time(panel, drift.t)
        below[-1].set_xlabel("t [s]")
        return save(figure, path)
