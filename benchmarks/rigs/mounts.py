"""Records of what hangs on springs: a geophone, a rheometer, a resin that cures, a tuning fork."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import Record, append, correlated, rounded
from benchmarks.rigs.waves import sines, tabulated


def geophone() -> Record:
    """A geophone on a shaker, two multisines; hidden: rubber stops on both sides of its coil."""
    random = np.random.default_rng(3333)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, size in enumerate((1.25, 1.45), 1):
        append(columns, geophone_run(random, run, size))
    names = ("run", "t_ms", "base_mm_s2", "x_mm")
    return Record(names, ("%d", "%d", "%.1f", "%.4f"), columns)


def geophone_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 8 s; one stop sits 0.02 mm farther, the springs harden, the LVDT is bent."""
    m, k, c, rubber, upper, lower = 0.020, 50.5, 0.42, 45.0, 0.50e-3, 0.51e-3
    harder, bent = 6.0e4, 0.4
    interval, samples, steps = 0.002, 4000, 6
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    table = sines(random, np.arange(1, 24, 0.5), size, times) * np.minimum(1, times / 0.4)
    base = tabulated(table, half)

    def field(t: float, y: State) -> list[float]:
        x, v = y
        stop = rubber * (max(0.0, x - upper) - max(0.0, -x - lower))
        return [v, -base(t) - (k * x + harder * x**3 + c * v + stop) / m]

    y = march(field, [0, 0], interval, samples, steps)
    read = y[:, 0] * (1 + bent * y[:, 0]) * 1e3 + correlated(random, samples, interval, 0.02, 0.001)
    return [
        [run] * samples,
        np.arange(samples) * 2,
        (table[:: 2 * steps][:samples] + random.normal(size=samples) * 0.01) * 1e3,
        rounded(read + random.normal(size=samples) * 0.003, 0.0005),
    ]


def rheometer() -> Record:
    """A torsional rheometer, two multisines; hidden: the inertia of the clamp on its tool."""
    random = np.random.default_rng(3737)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, size in enumerate((230.0, 290.0), 1):
        append(columns, rheometer_run(random, run, size))
    names = ("run", "t_s", "torque_uNm", "twist_mrad")
    return Record(names, ("%d", "%.2f", "%.1f", "%.3f"), columns, ";")


def rheometer_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 20 s; the torque is held for 10 ms, the sample thins out, the wire creeps."""
    tool, clamp, k, c, thins, creep, late = 4.2e-5, 0.45e-5, 0.0125, 7.0e-5, 0.006, 2.5e-5, 0.8
    interval, samples = 0.01, 2000
    t = np.arange(samples) * interval
    table = sines(random, np.arange(0.3, 8.0, 0.35), size, t) * np.minimum(1, t / 0.5)
    torque = rounded(table, 0.5) * 1e-6
    now = 0.0

    def hold(sample: int, y: State) -> None:
        nonlocal now
        now = float(torque[sample])

    def field(t: float, y: State) -> list[float]:
        q, w, crept = y
        loss = c * w / (1 + thins * abs(w))
        return [w, (now - k * q - creep * (q - crept) - loss) / (tool + clamp), (q - crept) / late]

    y = march(field, [0, 0, 0], interval, samples, 8, hold)
    slow = correlated(random, samples, interval, 0.1, 0.02)
    read = y[:, 0] * 1e3 + slow + random.normal(size=samples) * 0.05
    return [[run] * samples, t, torque * 1e6, rounded(read, 0.01)]


def cure() -> Record:
    """A mass on a resin that cures under chirps, 50 s; hidden: a spring that gets stiffer."""
    random = np.random.default_rng(4141)
    m, k, c, growth, slower = 0.45, 3000.0, 4.6, 7.2, 900.0
    interval, samples, steps = 0.005, 10000, 6
    sweep, first, last, size = 5.0, 8.0, 20.0, 0.42

    def force(t: float) -> float:
        since = t % sweep
        turns = first * since + (last - first) * since * since / (2 * sweep)
        ends = min(1.0, since / 0.2, (sweep - since) / 0.2)
        return size * math.sin(2 * math.pi * turns) * ends

    def field(t: float, y: State) -> list[float]:
        spring = k + growth * slower * (1 - math.exp(-t / slower))  # the cure gets slower
        return [y[1], (force(t) - spring * y[0] - c * y[1]) / m]

    y = march(field, [0, 0], interval, samples, steps)
    t = np.arange(samples) * interval
    read = y[:, 0] * 1e6 + correlated(random, samples, interval, 0.03, 0.8)
    columns = (
        t,
        np.array([force(s) for s in t]) * 1e3 + random.normal(size=samples) * 1.0,
        rounded(read + random.normal(size=samples) * 2.0, 0.5),
    )
    return Record(("t_s", "F_mN", "x_um"), ("%.3f", "%.1f", "%.1f"), columns)


def fork() -> Record:
    """A tuning fork with a magnet that brakes it, hit three times; hidden: nothing."""
    random = np.random.default_rng(4040)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, hit in enumerate((0.31, -0.24, 0.36), 1):
        append(columns, fork_run(random, run, hit))
    return Record(("run", "t_ms", "x_um"), ("%d", "%.1f", "%.0f"), columns)


def fork_run(random: np.random.Generator, run: int, hit: float) -> list[Any]:
    """The columns of 0.5 s after a hit; the magnet brakes less beside it, and 50 Hz hums in."""
    interval, samples, steps = 2e-4, 2500, 12
    w2, c, less = (2 * math.pi * 438.6) ** 2, 7.4, 1.5e6

    def field(t: float, y: State) -> list[float]:
        return [y[1], -w2 * y[0] - c * (1 - less * y[0] ** 2) * y[1]]

    y = march(field, [0, hit], interval, samples, steps)
    t = np.arange(samples) * interval
    hum = 0.25 * np.sin(2 * math.pi * 50 * t + random.uniform(0, 6))
    read = y[:, 0] * 1e6 + hum + random.normal(size=samples) * 1.2
    return [[run] * samples, t * 1e3, rounded(read, 1.0)]
