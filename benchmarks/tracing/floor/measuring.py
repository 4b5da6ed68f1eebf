"""How a record came about: noise, encoder, filter, interpolation, jitter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import butter, filtfilt, lfilter

from benchmarks.tracing.floor.rig import Rig, recorded_drive, states
from benchmarks.tracing.floor.windows import Array
from benchmarks.tracing.make import Series

FINAL = 1e-9  # relative tolerance of the runs that are recorded
LATER = 0.5  # of a record: how long it continues
JITTER = 0.25  # of the sampling interval, where the times are recorded
HIDDEN_JITTER = 0.03  # the same, where they are not
TIMES_THE_FLOOR = (0.7, 12.0)  # what the truth leaves, over the noise
RATIO = (100.0, 20000.0)  # of the signal to the noise
COARSE = (10, 5, 4, 3, 2)  # samples from one, by interpolation
LEAST_PERIOD = 14  # true samples of a period, before interpolation


@dataclass(frozen=True)
class Instrument:
    """What measures all series of a case: relative noise, its colour, and the mark's numbers."""

    noise: float  # rms, in units of the signal's standard deviation
    colour: float  # of the noise: AR(1) coefficient, or cut-off over half the sampling rate
    factor: int  # samples from one, by interpolation
    cut: float  # of the filter, in 1/s
    stamped: bool  # whether jittered times are recorded


@dataclass(frozen=True, eq=False)
class Recorded:
    """One record: times [s] (N,) as the file has them, columns by channel (N,), the drive (N,)."""

    t: Array
    columns: dict[str, Array]
    u: Array


@dataclass(frozen=True, eq=False)
class Clean:
    """The same without noise and marks, on the nominal grid: true states (N, 2), what the sensors
    show (N,), and the drive at ten points a sample."""

    t: Array
    states: Array
    shown: dict[str, Array]
    fine: Array
    u: Array


def instrument(rig: Rig, left: float, period: float, rng: np.random.Generator) -> Instrument:
    """The instrument; `left` is the rms of the floor in the record, in units of the signal."""
    low, high = np.log(TIMES_THE_FLOOR)
    noise = left / float(np.exp(rng.uniform(low, high)))
    every = rig.scenario.every
    factor = next((k for k in COARSE if period / (k * every) >= LEAST_PERIOD), 2)
    coloured = rng.uniform(0.6, 0.97) if rig.scenario.noise == "ar1" else rng.uniform(0.08, 0.3)
    return Instrument(
        float(np.clip(noise, 1 / RATIO[1], 1 / RATIO[0])),
        float(coloured),
        factor if rig.scenario.mark == "interpolated" else 1,
        float(min(rng.uniform(10, 25) / period, 0.4 / every)),
        bool(rng.random() < 0.6),
    )


def clean(rig: Rig, series: Series) -> Clean:
    """The true motion of a series; one that continues another begins where that ends."""
    every = rig.scenario.every
    count = round(rig.scenario.seconds / every)
    begin = 10 * count if series.use == "validate" and rig.scenario.continued else 0
    end = begin + 10 * (count if not begin else round(LATER * count))
    whole = np.arange(end + 1, dtype=np.float64) * (every / 10)
    rows, shown = (x[begin:] for x in states(rig, series, whole, rtol=FINAL))
    fine = whole[begin:]
    names = (rig.plant.coordinates[0], *(rig.plant.rates[:1] if rig.scenario.rates else ()))
    seen = dict(zip(names, (shown[::10], rows[::10, 1]), strict=False))
    return Clean(fine[::10], rows[::10, :2], seen, fine, recorded_drive(rig, series, fine, rows))


def record(
    rig: Rig,
    series: Series,
    tool: Instrument,
    truth: Clean,
    spreads: dict[str, float],
    rng: np.random.Generator,
) -> Recorded:
    """What the instrument writes down of a series; `spreads` are the signals' deviations."""
    t, mark = truth.t, rig.scenario.mark
    true = t
    if mark == "jitter":
        part = JITTER if tool.stamped else HIDDEN_JITTER
        true = t + part * rig.scenario.every * rng.uniform(-1, 1, len(t))
        true[[0, -1]] = t[[0, -1]]
        t = true if tool.stamped else t
    kept = np.arange(0, len(t), tool.factor)
    columns = {}
    for name, shown in truth.shown.items():
        y = CubicSpline(truth.t, shown)(true) if mark == "jitter" else shown
        y = y[kept]
        sigma = tool.noise * spreads[name]
        noise = sigma * _noise(rig, tool, len(y), rng)
        if mark == "quantised":  # noise and rounding together make sigma
            step = 0.9 * np.sqrt(12) * sigma
            y = step * np.round((y + 0.43 * noise) / step)
        else:
            y = y + noise
        columns[name] = y
    u = np.interp(true, truth.fine, truth.u)[kept]
    if tool.factor > 1:
        inside = t <= t[kept[-1]]
        columns = {n: CubicSpline(t[kept], y)(t[inside]) for n, y in columns.items()}
        u = CubicSpline(t[kept], u)(t[inside])
        t = t[inside]
    if mark == "filtered":
        b, a = butter(3, tool.cut * 2 * rig.scenario.every)
        columns = {name: filtfilt(b, a, y) for name, y in columns.items()}
    return Recorded(t, columns, u)


def _noise(rig: Rig, tool: Instrument, count: int, rng: np.random.Generator) -> Array:
    """Noise of variance 1."""
    white = rng.standard_normal(count + 500)
    if rig.scenario.noise == "ar1":
        a = tool.colour
        return np.asarray(lfilter([np.sqrt(1 - a**2)], [1, -a], white)[500:])
    if rig.scenario.noise == "lowpass":
        slow = lfilter(*butter(2, tool.colour), white)[500:]
        return np.asarray(slow / np.std(slow))
    return white[500:]
