"""Lines of a spectrum: the periods in time that a residual shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tracewire.array_types import Vector
from tracewire.residual import Windows
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.signal_scales import Trajectory
from tracewire.trace.thresholds import CandidateOptions


def with_lines(
    candidates: Sequence[Candidate],
    windows: Windows,
    runs: Sequence[Trajectory],
    options: CandidateOptions,
) -> list[Candidate]:
    """The candidates, those of a period in time with the lines of the residual before their grid.

    A wave that multiplies a signal of the `runs` has the periods to be scanned: those beside the
    sums and differences of a line of the residual and one of the signal, and those of the grid.
    """
    if not any(candidate.lines for candidate in candidates):
        return list(candidates)
    periods = line_periods(windows, options)
    found = []
    for candidate in candidates:
        for shape in candidate.lines:
            low, high = candidate.limits[shape]
            grid = candidate.shapes[shape]
            if shape in candidate.modulated:
                signals = [(run.t, run.signals[candidate.modulated[shape]]) for run in runs]
                beside = modulating_periods(periods, signals, options)
                inside = [period for period in beside if low <= period <= high]
                if inside:  # else the grid stays as a whole, by which chance is judged
                    own = sorted({*inside, *grid}, reverse=True)
                    candidate = replace(candidate, scan_grid={shape: tuple(own)})
            else:
                own = [period for period in periods if low <= period <= high]
                shapes = {**candidate.shapes, shape: (*own, *grid)}
                candidate = replace(candidate, shapes=shapes)
        found.append(candidate)
    return found


def modulating_periods(
    periods: Sequence[float], signals: Sequence[tuple[Vector, Vector]], options: CandidateOptions
) -> list[float]:
    """The periods in s near to those of a wave that shifts the lines of signals to those of
    `periods`: a product of two sines has their sum and their difference in its spectrum.

    signals: times (N,) in s and values (N,) of each series.
    """
    length = max(float(t[-1] - t[0]) for t, _ in signals)
    near = np.arange(-options.line_around, options.line_around + 1e-9, 1 / options.line_finer)
    own = {line for t, values in signals for line in lines_of(t, values, options)}
    shifted = {f for p in periods for line in own for f in (1 / p + line, abs(1 / p - line))}
    return [1 / f for s in sorted(shifted) for f in (s + near / length).tolist() if f * length >= 1]


def lines_of(t: Vector, values: Vector, options: CandidateOptions) -> list[float]:
    """The frequencies in Hz of the highest lines in the spectrum of a signal."""
    interval = float(np.median(np.diff(t)))
    if not options.line_near <= (t[-1] - t[0]) / interval <= options.line_sparse * len(t):
        return []
    even = np.arange(t[0], t[-1], interval)
    moving = np.interp(even, t, values - np.mean(values)) * np.hanning(len(even))
    count = options.line_finer * len(even)
    power = np.abs(np.fft.rfft(moving, count)) ** 2
    inner = power[1:-1]
    peak = (inner >= power[:-2]) & (inner > power[2:])
    peak &= inner > options.modulated_least * np.max(power)
    lines = 1 + np.flatnonzero(peak)
    best = lines[np.argsort(-power[lines], kind="stable")][: options.modulated_lines]
    return [_top(power, n) / (count * interval) for n in best.tolist()]


def line_periods(windows: Windows, options: CandidateOptions) -> list[float]:
    """The periods in s of the highest lines in the spectrum of the residual, the highest first.

    The power of all signals and series is added up, without what the starts of windows imitate and
    without phases, which are those of each series. A line is a peak that stands so far above the
    median power on both sides that white noise hardly has one: power is exponential there.
    """
    power, step = _spectrum(windows, options)
    if not len(power):
        return []
    usual = _usual(power, options.line_finer * options.line_near) / np.log(2)
    least = np.log(len(power) / options.line_finer / options.line_chance)
    inner = power[1:-1]
    peak = (inner >= power[:-2]) & (inner > power[2:]) & (inner > least * usual[1:-1])
    lines = 1 + np.flatnonzero(peak)
    best = lines[np.argsort(-power[lines], kind="stable")][: options.wave_peaks]
    return [1 / (step * _top(power, n)) for n in best.tolist()]


def _usual(power: Vector, near: int) -> Vector:
    """The median power beside each place, on the side where it is higher: the starts of windows
    leave little power below their frequency."""
    from scipy.ndimage import median_filter

    sides = (
        median_filter(power, near, origin=at, mode="nearest")
        for at in (-(near // 2), (near - 1) // 2)
    )
    return np.asarray(np.maximum(*sides))


def _spectrum(windows: Windows, options: CandidateOptions) -> tuple[Vector, float]:
    """The power of the residual at multiples of a frequency, and that frequency in Hz; up to the
    highest that all series resolve."""
    series: dict[str, list[int]] = {}
    segments = windows.criterion.segments
    for n, segment in enumerate(segments):
        series.setdefault(segment.measured.name, []).append(n)
    times = [segments[own[0]].measured.t for own in series.values()]
    interval = min(float(np.median(np.diff(t))) for t in times)
    longest = max(float(t[-1] - t[0]) for t in times)
    if longest / interval > options.line_sparse * sum(len(t) for t in times):
        return np.zeros(0), 0.0
    count = options.line_finer * int(longest / interval + 1)
    power = np.zeros(count // 2 + 1)
    for t, own in zip(times, series.values(), strict=True):
        power += _power(windows, own, t, interval, count)
    slowest = max(float(np.median(np.diff(t))) for t in times)
    highest = int(count * interval / (2 * slowest))
    return power[: highest + 1], 1 / (count * interval)


def _power(
    windows: Windows, numbers: Sequence[int], t: Vector, interval: float, count: int
) -> Vector:
    """The power of some windows of one series, tapered over all of it by a Hann window."""
    begin, length = float(t[0]), max(float(t[-1] - t[0]), interval)
    signals = len(windows.linearisations[numbers[0]].residual.T)
    even = np.zeros((count, signals))
    for n in numbers:
        near, own = windows.linearisations[n], windows.criterion.segments[n].t
        taper = np.sin(np.pi * (own - begin) / length) ** 2
        rows = np.round((own - begin) / interval).astype(int)
        left = near.projection.project_out(near.residual.ravel()).reshape(near.residual.shape)
        even[rows] = taper[:, None] * left
    return np.asarray(np.sum(np.abs(np.fft.rfft(even, axis=0)) ** 2, axis=1))


def _top(power: Vector, n: int) -> float:
    """Where the parabola through a peak and its neighbours is highest, in places of the array."""
    before, at, after = np.log(np.maximum(power[n - 1 : n + 2], 1e-300))
    bend = before - 2 * at + after
    return n + (0.5 * float((before - after) / bend) if bend < 0 else 0.0)
