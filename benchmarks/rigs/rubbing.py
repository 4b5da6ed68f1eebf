"""Records of what rubs: a stage on rollers, a block on a belt, the slide of a lathe, a sledge."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import Record, append, correlated, rounded
from benchmarks.rigs.waves import sines, tabulated


def rollers() -> Record:
    """A stage on crossed rollers, two multisines; hidden: they give way, then roll."""
    random = np.random.default_rng(8989)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, size in enumerate((0.21, 0.16), 1):
        append(columns, rollers_run(random, run, size))
    names = ("run", "t_ms", "coil_mA", "x_um")
    return Record(names, ("%d", "%.0f", "%.2f", "%.1f"), columns)


def rollers_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 3.5 s at 1 kHz; leaf springs that harden by a little."""
    m, k, c, factor, level, gives, harder = 0.85, 9200.0, 9.0, 11.5, 0.11, 1.4e-5, 1.2e10
    interval, samples, steps = 1e-3, 3500, 4
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 32) * half
    table = sines(random, np.arange(1.4, 34.0, 1.1), size / factor, times)
    table = table * np.minimum(1, 0.2 + times)
    amperes = tabulated(table, half)

    def field(t: float, y: State) -> list[float]:
        x, v, z = y
        push = factor * amperes(t) - k * x - harder * x**3 - c * v - level * z
        return [v, push / m, (v - abs(v) * z) / gives]

    y = march(field, [1.1e-5, 0.0, 0.35], interval, samples, steps)
    shunt = table[: 2 * steps * samples : 2 * steps] * 1e3 + random.normal(size=samples) * 0.05
    read = y[:, 0] * 1e6 + correlated(random, samples, interval, 0.02, 0.12)
    read = read + random.normal(size=samples) * 0.16
    return [[run] * samples, np.arange(samples), shunt, rounded(read, 0.1)]


def block() -> Record:
    """A block on a belt, held by a spring, at four speeds; hidden: it rubs more near rest."""
    random = np.random.default_rng(9090)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, (belt, start) in enumerate(
        ((0.024, 0.0), (0.110, 0.008), (0.046, 0.030), (0.033, 0.022)), 1
    ):
        append(columns, block_run(random, run, belt, start))
    return Record(("run", "t_s", "x_mm"), ("%d", "%.2f", "%.2f"), columns, ";", True)


def block_run(random: np.random.Generator, run: int, belt: float, start: float) -> list[Any]:
    """The columns of 16 s at 100 Hz; the belt has a seam and rubs unevenly on its way round."""
    m, k, c, dry, more, speed, seam, way = 1.35, 118.0, 1.1, 2.3, 0.95, 0.042, 0.015, 1.24
    interval, samples = 0.01, 1600
    at = random.uniform(0, 2 * math.pi)

    def field(t: float, y: State) -> list[float]:
        v = y[1] + belt
        return [v, (-k * y[0] - c * v) / m]

    def levels(t: float, y: State) -> tuple[float, float]:
        uneven = seam * math.sin(2 * math.pi * (belt * t - y[0]) / way + at)
        level = (dry + more * math.exp(-((y[1] / speed) ** 2)) + uneven) / m
        return level, level

    y = march_dry(field, levels, 1, [start, -belt], interval, samples, 10)
    read = y[:, 0] * 1e3 + correlated(random, samples, interval, 0.05, 0.03)
    read = read + random.normal(size=samples) * 0.06
    return [[run] * samples, np.arange(samples) * interval, rounded(read, 0.05)]


def slide() -> Record:
    """The slide of a lathe, two runs; hidden: bristles that bend, slip, and slip easier fast."""
    random = np.random.default_rng(9898)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, slide_run(random, run))
    names = ("run", "t_s", "force_N", "x_um")
    return Record(names, ("%d", "%.3f", "%.1f", "%.0f"), columns)


def slide_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 8 s at 500 Hz under a controller; its screw has a ripple of 0.3 %."""
    m, c, level, bends, peak, speed, ripple = 15.2, 520.0, 38.0, 2.4e-5, 0.2, 0.010, 0.1
    interval, samples, lead = 0.002, 4000, 5e-3
    t = np.arange(samples + 1) * interval
    moves = np.repeat(random.uniform(size=12) < 0.65, 350)[: samples + 1]
    way = np.cumsum(np.convolve(moves, np.ones(60) / 60, "same")) * interval
    goal = sines(random, np.arange(0.2, 2.0, 0.2), 3e-3, way)
    goal = goal - goal[0] + np.repeat(random.uniform(-4e-5, 4e-5, 42), 100)[: samples + 1]
    before, rate, total, force = 0.0, 0.0, 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, total, force
        x = round(y[0] / 1e-6) * 1e-6
        rate += 0.4 * ((x - before) / interval - rate)
        before = x
        off = goal[min(sample, samples)] - x
        total += off * interval
        asked = 9.0e4 * off + 4.0e5 * total - 900 * rate
        force = round(max(-150.0, min(150.0, asked)) / 0.5) * 0.5
        log.append(force)

    def field(s: float, y: State) -> list[float]:
        x, v, z = y
        most = 1 + peak * math.exp(-((v / speed) ** 2))
        push = force - c * v - level * z + ripple * math.sin(2 * math.pi * x / lead)
        return [v, push / m, (v - abs(v) * z / most) / bends]

    y = march(field, [0.0, 0.0, 0.0], interval, samples, 8, control)
    read = y[:, 0] * 1e6 + correlated(random, samples, interval, 0.05, 0.5)
    read = read + random.normal(size=samples) * 0.6
    return [[run] * samples, t[:samples], log, rounded(read, 1)]


def sledge() -> Record:
    """A sledge that a winch pulls through a spring, three runs; hidden: it rubs more near rest."""
    random = np.random.default_rng(1107)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, samples in enumerate((2600, 2200, 2400), 1):
        append(columns, sledge_run(random, run, samples))
    return Record(("run", "t_s", "winch_mm", "sledge_mm"), ("%d", "%.2f", "%.1f", "%.1f"), columns)


def sledge_run(random: np.random.Generator, run: int, samples: int) -> list[Any]:
    """The columns at 100 Hz; the winch changes its speed, stands and turns, and the boards under
    the sledge are not alike."""
    m, k, c, dry, more, speed, boards, board = 2.1, 165.0, 3.5, 2.6, 1.4, 0.016, 0.07, 0.21
    interval, pace = 0.01, 0.035
    speeds = pace * random.choice([-1.2, -0.7, 0.0, 0.5, 0.8, 1.3], size=samples // 250 + 2)
    speeds[0] = pace * (1 if run < 3 else -1)
    winch = np.append(0.0, np.cumsum(np.repeat(speeds, 250)[:samples]) * interval)
    at = random.uniform(0, 2 * math.pi)

    def field(t: float, y: State) -> list[float]:
        sample = min(int(t / interval + 1e-9), samples - 1)
        end = winch[sample] + (winch[sample + 1] - winch[sample]) * (t / interval - sample)
        return [y[1], (k * (end - y[0]) - c * y[1]) / m]

    def levels(t: float, y: State) -> tuple[float, float]:
        uneven = boards * math.sin(2 * math.pi * y[0] / board + at)
        level = (dry + more * math.exp(-((y[1] / speed) ** 2)) + uneven) / m
        return level, level

    y = march_dry(field, levels, 1, [0.0, 0.0], interval, samples, 10)
    read = y[:, 0] * 1e3 + correlated(random, samples, interval, 0.05, 0.05)
    read = read + random.normal(size=samples) * 0.05
    return [
        [run] * samples,
        np.arange(samples) * interval,
        winch[:samples] * 1e3,
        rounded(read, 0.1),
    ]
