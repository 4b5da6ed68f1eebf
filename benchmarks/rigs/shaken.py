"""Records of what floats or is shaken: a buoy, a machine on ring springs and a model of a tower."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import Record, append, correlated, rounded
from benchmarks.rigs.waves import sines, tabulated


def buoy() -> Record:
    """A buoy in still water, let go three times; hidden: the drag of the eddies at its edge."""
    random = np.random.default_rng(6969)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, first in enumerate((-78.0, -52.0, -66.0), 1):
        append(columns, buoy_run(random, run, first))
    return Record(("run", "t_s", "z_mm"), ("%d", "%.2f", "%.2f"), columns, ";", True)


def buoy_run(random: np.random.Generator, run: int, first: float) -> list[Any]:
    """The columns of 14 s at 50 Hz; the hull leans out, the waves that it made act on it late."""
    w2, c, drag, leans, waves, late, zero = 20.4, 0.24, 0.75, 0.12, 0.03, 0.5, 3.2
    interval, samples = 0.02, 700

    def field(t: float, y: State) -> list[float]:
        z, v, radiated = y
        lift = w2 * z * (1 - leans * z)
        return [
            v,
            -lift - c * v - drag * v * abs(v) - waves * radiated,
            (v - radiated) / late,
        ]

    y = march(field, [first * 1e-3, 0, 0], interval, samples, 6)
    ripples = correlated(random, samples, interval, 0.25, 0.35)
    read = y[:, 0] * 1e3 + zero + ripples + random.normal(size=samples) * 0.2
    return [[run] * samples, np.arange(samples) * interval, rounded(read, 0.25)]


def ring_springs() -> Record:
    """A machine on ring springs, two multisines; hidden: rings that rub as they are pressed."""
    random = np.random.default_rng(7676)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, size in enumerate((760.0, 900.0), 1):
        append(columns, ring_springs_run(random, run, size))
    names = ("run", "t_ms", "F_kN", "x_mm")
    return Record(names, ("%d", "%d", "%.4f", "%.3f"), columns)


def ring_springs_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 8 s at 1 kHz; the rings harden, the grease creeps a little."""
    m, k, c, dry, slope, harder = 85.0, 4.1e5, 950.0, 22.0, 1.5e4, 6.0e6
    interval, samples, steps = 0.001, 8000, 4
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    table = sines(random, np.arange(2, 22, 0.625), size, times) * np.minimum(1, times / 0.3)
    force = tabulated(table, half)

    def field(t: float, y: State) -> list[float]:
        return [y[1], (force(t) - k * y[0] - harder * y[0] ** 3 - c * y[1]) / m]

    def levels(t: float, y: State) -> tuple[float, float]:
        level = (dry + slope * abs(y[0])) / m
        return level, level

    y = march_dry(field, levels, 1, [0, 0], interval, samples, steps)
    slow = correlated(random, samples, interval, 0.05, 0.015)
    cell = table[: 2 * steps * samples : 2 * steps] + random.normal(size=samples) * 4.0
    read = y[:, 0] * 1e3 + slow + random.normal(size=samples) * 0.03
    return [[run] * samples, np.arange(samples), cell * 1e-3, rounded(read, 0.005)]


def tower() -> Record:
    """A model of a tower with a damper of tuned mass, two earthquakes; hidden: nothing."""
    random = np.random.default_rng(8080)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run, size in enumerate((0.42, 0.55), 1):
        append(columns, tower_run(random, run, size))
    names = ("run", "t_ms", "base_g", "top_mm", "damper_mm")
    return Record(names, ("%d", "%d", "%.5f", "%.3f", "%.2f"), columns, ";")


def tower_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 30 s at 200 Hz, all behind the same filter of 40 Hz; columns that harden."""
    w2, c, share, w2_damper, c_damper, harder, worn = 118.0, 0.22, 0.045, 106.0, 1.9, 0.4, 0.05
    interval, samples, steps = 0.005, 6000, 4
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    table = sines(random, np.arange(0.4, 9.0, 0.13), size, times)
    table = table * np.minimum(1, times / 2) * np.exp(-np.maximum(0, times - 12) / 7)
    base = tabulated(table, half)
    corner = 2 * math.pi * 40

    def field(t: float, y: State) -> list[float]:
        x, v, z, r = y[:4]  # of the top, and of the damper against it
        link = w2_damper * z + c_damper * r * (1 + worn * abs(z))
        top = -base(t) - w2 * x * (1 + harder * x * x) - c * v + share * link
        rates = [v, top, r, -base(t) - top - link]
        for i, shown in ((4, base(t)), (6, x), (8, z)):
            rates += [y[i + 1], corner * corner * (shown - y[i]) - 1.414 * corner * y[i + 1]]
        return rates

    y = march(field, [0.0] * 10, interval, samples, steps)
    accelerometer = y[:, 4] / 9.80665 + random.normal(size=samples) * 4e-4
    top = y[:, 6] * 1e3 + correlated(random, samples, interval, 0.4, 0.03)
    damper = y[:, 8] * 1e3 + random.normal(size=samples) * 0.12
    return [
        [run] * samples,
        np.arange(samples) * 5,
        rounded(accelerometer, 2.5e-4),
        rounded(top + random.normal(size=samples) * 0.05, 0.01),
        rounded(damper, 0.05),
    ]
