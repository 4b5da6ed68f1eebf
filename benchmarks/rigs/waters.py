"""Records of vessels with water: a ball on a spring, a bed of sand and four tanks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import Record, append, correlated, rounded
from benchmarks.rigs.waves import sines, tabulated


def ball() -> Record:
    """A ball on a spring in water, two runs; hidden: water that moves along, and drag."""
    random = np.random.default_rng(9292)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, size in enumerate((9.0, 7.0), 1):
        append(columns, ball_run(random, run, size))
    names = ("run", "t_s", "hook_mm", "ball_mm")
    return Record(names, ("%d", "%.4f", "%.2f", "%.2f"), columns)


def ball_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 30 s at 60 frames a second; the water remembers a little, frames tremble."""
    m, water, k, c, drag, memory, keeps = 0.362, 0.094, 24.0, 0.07, 0.92, 0.012, 0.12
    interval, samples, steps = 1 / 60, 1800, 6
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 32) * half
    table = sines(random, np.arange(0.2, 2.7, 0.11), size * 1e-3, times) * np.minimum(1, times / 2)
    hook = tabulated(table, half)

    def field(t: float, y: State) -> list[float]:
        x, v, old = y
        push = k * (hook(t) - x) - c * v - drag * v * abs(v) - memory * (v - old)
        return [v, push / (m + water), (v - old) / keeps]

    y = march(field, [3e-3, 0.0, 0.0], interval, samples, steps)
    late = random.normal(size=samples) * 6e-4
    read = (y[:, 0] + y[:, 1] * late) * 1e3 + correlated(random, samples, interval, 0.1, 0.08)
    read = read + random.normal(size=samples) * 0.15
    moved = table[: 2 * steps * samples : 2 * steps] * 1e3 + random.normal(size=samples) * 0.01
    return [[run] * samples, np.arange(samples) * interval, moved, rounded(read, 0.2)]


def sand() -> Record:
    """Water through a bed of sand, two runs; hidden: a bed that gets blocked."""
    random = np.random.default_rng(9595)
    columns: list[list[Any]] = [[] for _ in range(4)]
    flows = ((8.0, 3.5, 10.5, 6.0, 2.5, 9.5, 5.0, 11.0), (4.0, 10.0, 7.0, 2.0, 8.5, 11.0, 4.5, 7.5))
    for run, litres in enumerate(flows, 1):
        append(columns, sand_run(random, run, litres))
    names = ("run", "t_min", "inflow_l_min", "level_mm")
    return Record(names, ("%d", "%.4f", "%.2f", "%.0f"), columns, ";", True)


def sand_run(random: np.random.Generator, run: int, litres: Sequence[float]) -> list[Any]:
    """The columns of 48 min at 2 s, fresh from its wash; fast water is a little slowed."""
    area, seeps, blocks, slow, choked = 0.0314, 2.3e-4, 0.19, 9000.0, 0.008
    interval, samples, held = 2.0, 1440, 180
    most = blocks / (1 - math.exp(-interval * samples / slow))

    inflow = 0.0

    def turn(sample: int, y: State) -> None:
        nonlocal inflow
        inflow = litres[min(sample, samples - 1) // held] / 6e4

    def field(t: float, y: State) -> list[float]:
        bed = seeps * (1 - most * (1 - math.exp(-t / slow))) * (1 - choked * y[0] / 0.6)
        return [(inflow - bed * y[0]) / area]

    y = march(field, [litres[-1] / 6e4 / seeps], interval, samples, 8, turn)
    noise = correlated(random, samples, interval, 9.0, 1.0) + random.normal(size=samples) * 1.5
    told = np.repeat(litres, held)
    return [
        [run] * samples,
        np.arange(samples) * interval / 60,
        told,
        rounded(y[:, 0] * 1e3 + noise, 1),
    ]


def four() -> Record:
    """Four tanks with two pumps and two valves, two runs; hidden: nothing."""
    random = np.random.default_rng(10404)
    columns: list[list[Any]] = [[] for _ in range(8)]
    for run in (1, 2):
        append(columns, four_run(random, run))
    names = ("run", "t_s", "pump1_V", "pump2_V", "h1_cm", "h2_cm", "h3_cm", "h4_cm")
    return Record(names, ("%d", "%.0f", "%.2f", "%.2f", *["%.2f"] * 4), columns)


def four_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 50 min at 3 s; a pump that bends and a hose that drips, below the noise."""
    areas, holes = (28.0, 32.0, 28.0, 32.0), (0.071, 0.057, 0.071, 0.057)
    gains, valves, bends, drips = (3.33, 3.35), (0.66, 0.61), 2.5e-3, 1.1e-2
    interval, samples = 3.0, 1000
    told = [np.repeat(random.uniform(2.2, 4.0, 15), 70)[:samples] for _ in range(2)]
    told[1] = np.roll(told[1], 31)
    told = [rounded(volts, 0.05) for volts in told]
    flow = [0.0, 0.0]

    def turn(sample: int, y: State) -> None:
        for i in (0, 1):
            volts = float(told[i][min(sample, samples - 1)])
            flow[i] = gains[i] * volts * (1 - bends * (volts - 3))

    def field(t: float, y: State) -> list[float]:
        out = [a * math.sqrt(2 * 981 * max(h, 0)) for a, h in zip(holes, y, strict=True)]
        net = (
            valves[0] * flow[0] + out[2] - out[0],
            valves[1] * flow[1] + out[3] - out[1] - drips * y[1],
            (1 - valves[1]) * flow[1] - out[2],
            (1 - valves[0]) * flow[0] - out[3],
        )
        return [q / area for q, area in zip(net, areas, strict=True)]

    y = march(field, [11.0, 12.0, 1.9, 1.6], interval, samples, 8, turn)
    shown = []
    for h in y.T:
        waves = correlated(random, samples, interval, 8.0, 0.03)
        shown.append(rounded(h + waves + random.normal(size=samples) * 0.05, 0.05))
    return [[run] * samples, np.arange(samples) * interval, *told, *shown]
