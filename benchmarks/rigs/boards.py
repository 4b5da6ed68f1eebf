"""Records of boards on a desk: two heaters side by side, a filter behind a converter, and a hot
plate."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import Record, append, correlated, rounded
from benchmarks.rigs.waves import sines


def heaters() -> Record:
    """A board with two heaters, two runs; hidden: each of them warms the other."""
    random = np.random.default_rng(9191)
    columns: list[list[Any]] = [[] for _ in range(6)]
    for run in (1, 2):
        append(columns, heaters_run(random, run))
    names = ("run", "t_s", "heater1_pct", "heater2_pct", "T1_C", "T2_C")
    return Record(names, ("%d", "%.1f", "%.0f", "%.0f", "%.2f", "%.2f"), columns)


def heaters_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 40 min at 1.5 s; hot parts lose a little more, converters of 0.32 K."""
    C1, C2, h1, h2, across = 5.4, 6.1, 0.031, 0.026, 0.0062
    one, two, glows, room = 0.0152, 0.0098, 3.5e-6, 22.4
    interval, samples = 1.5, 1600
    powers = []
    for levels in (random.uniform(0, 90, 9), random.uniform(0, 100, 8)):
        powers.append(np.round(np.repeat(levels, math.ceil(samples / len(levels)))[:samples]))
    heat = [0.0, 0.0]

    def switch(sample: int, y: State) -> None:
        for i in (0, 1):
            heat[i] = float(powers[i][min(sample, samples - 1)])

    def field(t: float, y: State) -> list[float]:
        p, q = y
        passed = across * (q - p)
        return [
            (one * heat[0] - h1 * p - glows * p * p + passed) / C1,
            (two * heat[1] - h2 * q - glows * q * q - passed) / C2,
        ]

    y = march(field, [0.0, 0.0] if run == 1 else [9.0, 6.5], interval, samples, 6, switch)
    shown = []
    for rise in y.T:
        noise = correlated(random, samples, interval, 12.0, 0.08)
        noise = noise + random.normal(size=samples) * 0.12
        shown.append(rounded(room + rise + noise, 0.32))
    return [[run] * samples, np.arange(samples) * interval, *powers, *shown]


def converter() -> Record:
    """A filter behind a converter made of resistors, two runs; hidden: its steps."""
    random = np.random.default_rng(10202)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, size in enumerate((1.05, 0.85), 1):
        append(columns, converter_run(random, run, size))
    names = ("run", "t_ms", "told_V", "out_V")
    return Record(names, ("%d", "%.2f", "%.4f", "%.4f"), columns)


def converter_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 0.16 s at 20 kHz, held; unequal resistors bend it by 4 % of a step."""
    L, R, C, step, bends = 0.022, 96.0, 1.1e-6, 0.25, 0.003
    interval, samples = 5e-5, 3200
    told = sines(random, np.arange(25.0, 1100.0, 43.0), size, np.arange(samples) * interval)
    told = rounded(told + 0.15, 1e-4)
    volts = 0.0

    def hold(sample: int, y: State) -> None:
        nonlocal volts
        wanted = float(told[min(sample, samples - 1)])
        volts = math.floor(wanted / step + 0.5) * step
        volts += bends * math.sin(1.3 * volts)

    def field(t: float, y: State) -> list[float]:
        q, i = y
        return [i, (volts - R * i - q / C) / L]

    y = march(field, [0.0, 0.0], interval, samples, 6, hold)
    read = y[:, 0] / C + correlated(random, samples, interval, 3e-4, 0.0015)
    read = read + random.normal(size=samples) * 0.002
    return [[run] * samples, np.arange(samples) * interval * 1e3, told, rounded(read, 0.0024)]


def plate() -> Record:
    """A hot plate that is switched, two runs; hidden: a slab of steel on it, behind a thin gap."""
    random = np.random.default_rng(10505)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, plate_run(random, run))
    return Record(("run", "t_s", "power_pct", "T_C"), ("%d", "%.0f", "%.0f", "%.2f"), columns)


def plate_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 50 min at 2 s; a hot plate loses a little more, a sensor of 0.25 K."""
    C, slab, h, gap, full, glows, room = 310.0, 520.0, 1.15, 2.4, 2.1, 4e-4, 21.6
    interval, samples = 2.0, 1500
    levels = random.uniform(0, 100, 8 if run == 1 else 6)
    powers = np.round(np.repeat(levels, math.ceil(samples / len(levels)))[:samples])
    heat = 0.0

    def switch(sample: int, y: State) -> None:
        nonlocal heat
        heat = full * float(powers[min(sample, samples - 1)])

    def field(t: float, y: State) -> list[float]:
        p, q = y
        passed = gap * (p - q)
        return [(heat - h * p - glows * p * p - passed) / C, passed / slab]

    y = march(field, [0.0, 0.0] if run == 1 else [31.0, 24.0], interval, samples, 6, switch)
    noise = correlated(random, samples, interval, 15.0, 0.05) + random.normal(size=samples) * 0.1
    shown = rounded(room + y[:, 0] + noise, 0.25)
    return [[run] * samples, np.arange(samples) * interval, powers, shown]
