"""Records of structures: a store below a wing, a bolted beam, a damper, a plate on a shaker."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import Record, append, correlated, rounded
from benchmarks.rigs.waves import sines, tabulated

TONES = ((7.0, 1.1), (10.5, 0.9), (13.0, 1.2), (16.0, 0.8), (19.5, 1.0), (26.0, 1.2))
"""Of the plate: the frequencies [Hz] and the amplitudes [V] of its runs."""


def store() -> Record:
    """A store below a wing on a shaker, two multisines; hidden: a mount that hits and rubs."""
    random = np.random.default_rng(4747)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run, size in enumerate((62.0, 74.0), 1):
        append(columns, store_run(random, run, size))
    names = ("run", "t_ms", "F_N", "wing_m_s2", "store_m_s2")
    return Record(names, ("%d", "%.1f", "%.2f", "%.3f", "%.3f"), columns)


def store_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 8 s; means of 1.25 ms, as the converter of the accelerometers takes them."""
    wing, hung, k1, c1, k2, c2 = 34.0, 11.5, 1.6e5, 95.0, 1.05e5, 70.0
    stop, gap, dry, harder = 7.5e4, 1.0e-3, 8.5, 2.0e7
    interval, samples, fine, steps = 0.0025, 3200, 4, 1
    half = interval / fine / steps / 2
    times = np.arange(2 * steps * fine * (samples + 2)) * half
    push = sines(random, np.arange(2, 32, 0.5), size, times) * np.minimum(1, times / 0.3)
    force, total = tabulated(push, half), wing + hung

    def field(t: float, y: State) -> list[float]:
        middle, speed, apart, rate = y
        x1, v1 = middle - hung / total * apart, speed - hung / total * rate
        beyond = max(0.0, apart - gap) - max(0.0, -apart - gap)
        mount = -k2 * apart - harder * apart**3 - c2 * rate - stop * beyond
        outside = force(t) - k1 * x1 - c1 * v1
        return [speed, outside / total, rate, mount / hung - (outside - mount) / wing]

    level = dry * (1 / wing + 1 / hung)
    start = [0.0, 0.0, 0.0, 0.0]
    y = march_dry(field, (level, level), 3, start, interval / fine, (samples + 1) * fine, steps)
    rates = [y[:, 1] - hung / total * y[:, 3], y[:, 1] + wing / total * y[:, 3]]
    at = np.arange(1, samples + 1) * fine
    wide = interval / 2
    read = [(v[at + fine // 4] - v[at - fine // 4]) / wide for v in rates]
    return [
        [run] * samples,
        np.arange(samples) * interval * 1e3,
        push[2 * steps * at] + random.normal(size=samples) * 0.5,
        *(a + random.normal(size=samples) * 0.05 for a in read),
    ]


def bolted() -> Record:
    """A bolted beam, hit with a hammer four times; hidden: its joint slips a little, and softly."""
    random = np.random.default_rng(4848)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, hit in enumerate((0.125, -0.088, 0.105, 0.14), 1):
        append(columns, bolted_run(random, run, hit))
    return Record(("run", "t_ms", "v_mm_s"), ("%d", "%.1f", "%.2f"), columns)


def bolted_run(random: np.random.Generator, run: int, hit: float) -> list[Any]:
    """The columns of 0.7 s after a hit; the second bending mode rings in, the laser speckles."""
    m, k, c, level, bend = 1.35, 4.4e5, 2.4, 3.6, 1.4e-4
    interval, samples, steps = 5e-4, 1400, 8

    def field(t: float, y: State) -> list[float]:
        x, v, z = y
        slip = (1 - z) ** 2 if v >= 0 else (1 + z) ** 2
        return [v, -(k * x + c * v + level * z) / m, v / bend * slip]

    y = march(field, [0, hit, 0], interval, samples, steps)
    t = np.arange(samples) * interval
    second = 0.35 * np.exp(-t / 0.15) * np.sin(2 * math.pi * 266 * t + random.uniform(0, 6))
    speckle = correlated(random, samples, interval, 1e-3, 0.15)
    read = y[:, 1] * 1e3 + second + speckle + random.normal(size=samples) * 0.35
    return [[run] * samples, t * 1e3, rounded(read, 0.05)]


def damper() -> Record:
    """A damper with a magnetic fluid on a test bench, two runs; hidden: how it yields."""
    random = np.random.default_rng(5353)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run, size in enumerate((7.0, 8.5), 1):
        append(columns, damper_run(random, run, size))
    names = ("run", "t_s", "x_mm", "v_mm_s", "F_N")
    return Record(names, ("%d", "%.3f", "%.3f", "%.1f", "%.1f"), columns, ";", True)


def damper_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 15 s; the fluid thins as it warms up, the amplifier of the cell is slow."""
    k, c, level, bend, gas, slow, thins = 900.0, 1650.0, 62.0, 1.3e-3, 38.0, 0.0015, 6e-4
    interval, samples, steps = 0.005, 3000, 6
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    tones = np.arange(0.4, 4.4, 0.2)
    phases = random.uniform(0, 2 * math.pi, len(tones))
    begun = 1 - np.exp(-((times / 0.5) ** 2))
    way = np.zeros(len(times))
    for tone, phase in zip(tones, phases, strict=True):
        way += size * 1e-3 * math.sqrt(2 / len(tones)) * np.sin(2 * math.pi * tone * times + phase)
    way = way * begun
    speed = np.gradient(way, half)
    x, v = tabulated(way, half), tabulated(speed, half)

    def field(t: float, y: State) -> list[float]:
        z, shown = y
        rate = v(t)
        force = gas - k * x(t) - c * (1 - thins * t) * rate - level * z
        return [
            (rate - 0.5 * abs(rate) * z * abs(z) - 0.5 * rate * z * z) / bend,
            (force - shown) / slow,
        ]

    y = march(field, [0, gas], interval, samples, steps)
    at = slice(0, 2 * steps * samples, 2 * steps)
    return [
        [run] * samples,
        np.arange(samples) * interval,
        way[at] * 1e3 + random.normal(size=samples) * 0.01,
        speed[at] * 1e3 + random.normal(size=samples) * 0.8,
        rounded(y[:, 1] + random.normal(size=samples) * 1.2, 0.1),
    ]


def plate() -> Record:
    """A plate on a shaker, six tones one by one; hidden: an amplifier with a third harmonic."""
    random = np.random.default_rng(5555)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, (tone, size) in enumerate(TONES, 1):
        append(columns, plate_run(random, run, tone, size))
    names = ("run", "t_ms", "u_V", "x_um")
    return Record(names, ("%d", "%d", "%.4f", "%.2f"), columns)


def plate_run(random: np.random.Generator, run: int, tone: float, size: float) -> list[Any]:
    """The columns of 0.8 s once it has settled; the spring hardens, a second harmonic besides."""
    m, k, c, factor, share, phase, second, harder = 0.42, 1.6e4, 5.5, 9.0, 0.055, 0.7, 0.0004, 2.5e6
    interval, samples, steps, before = 0.001, 800, 4, 1200
    start = random.uniform(0, 2 * math.pi)

    def volts(t: float) -> float:
        turn = 2 * math.pi * tone * (t - before * interval) + start
        more = share * math.sin(3 * turn + phase) + second * math.sin(2 * turn)
        return size * (math.sin(turn) + more)

    def field(t: float, y: State) -> list[float]:
        return [y[1], (factor * volts(t) - k * y[0] - harder * y[0] ** 3 - c * y[1]) / m]

    y = march(field, [0, 0], interval, before + samples, steps)[before:]
    t = np.arange(samples) * interval
    shown = size * np.sin(2 * math.pi * tone * t + start) + random.normal(size=samples) * 0.002
    read = y[:, 0] * 1e6 + correlated(random, samples, interval, 0.01, 0.6)
    read = read + random.normal(size=samples) * 1.5
    return [[run] * samples, np.arange(samples), shown, rounded(read, 0.25)]
