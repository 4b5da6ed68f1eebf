"""Records of what a shaker pushes: a trolley with a bowl of water and the spring of a relay."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import Record, append, correlated, rounded
from benchmarks.rigs.waves import sines, tabulated


def bowl() -> Record:
    """A trolley with a bowl of water, two multisines; hidden: water that sways in it."""
    random = np.random.default_rng(8484)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, size in enumerate((3.4, 3.0), 1):
        append(columns, bowl_run(random, run, size))
    names = ("run", "t_s", "force_N", "x_mm")
    return Record(names, ("%d", "%.2f", "%.3f", "%.2f"), columns, ";", True)


def bowl_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 30 s at 50 Hz, both behind a filter of 12 Hz; a second wave of the water."""
    m, k, c = 7.4, 265.0, 11.0
    water, w2, loss, ripple, w2_ripple, loss_ripple = 0.045, 128.0, 0.55, 0.0015, 480.0, 1.4
    interval, samples, steps = 0.02, 1500, 5
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 32) * half
    table = sines(random, np.arange(0.3, 3.4, 0.1), size, times) * np.minimum(1, times)
    force = tabulated(table, half)
    corner = 2 * math.pi * 12

    def field(t: float, y: State) -> list[float]:
        x, v, s, u, p, r = y[:6]  # s and p: how far the waves are ahead of the trolley
        sway, run_up = w2 * s + loss * u, w2_ripple * p + loss_ripple * r
        a = (force(t) - k * x - c * v + water * sway + ripple * run_up) / m
        rates = [v, a, u, -a - sway, r, -a - run_up]
        for i, shown in ((6, force(t)), (8, x)):
            rates += [y[i + 1], corner * corner * (shown - y[i]) - 1.414 * corner * y[i + 1]]
        return rates

    y = march(field, [0.0] * 10, interval, samples, steps)
    cell = y[:, 6] + random.normal(size=samples) * 0.012
    read = y[:, 8] * 1e3 + correlated(random, samples, interval, 0.2, 0.06)
    read = read + random.normal(size=samples) * 0.12
    return [[run] * samples, np.arange(samples) * interval, cell, rounded(read, 0.05)]


def relay() -> Record:
    """The spring of a relay with its armature, two multisines; hidden: the contact it meets."""
    random = np.random.default_rng(8686)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, size in enumerate((0.115, 0.130), 1):
        append(columns, relay_run(random, run, size))
    names = ("run", "t_ms", "coil_mA", "x_um")
    return Record(names, ("%d", "%.1f", "%.2f", "%.0f"), columns)


def relay_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 1.6 s at 2.5 kHz; the contact begins softly and rubs as it is bent."""
    m, k, c, factor, gap, stiff, soft, rubs = 0.0042, 255.0, 0.16, 1.6, 3.4e-4, 9.0, 6e-6, 0.001
    interval, samples, steps = 4e-4, 4000, 4
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 32) * half
    table = sines(random, np.arange(4.0, 72.0, 2.5), size / factor, times)
    table = table * np.minimum(1, times / 0.1)
    amperes = tabulated(table, half)

    def field(t: float, y: State) -> list[float]:
        x, v = y
        deep = soft * float(np.logaddexp(0, (x - gap) / soft))
        push = stiff * deep + rubs * v * (1.0 if x > gap else 0.0)
        return [v, (factor * amperes(t) - k * x - c * v - push) / m]

    y = march(field, [0.0, 0.0], interval, samples, steps)
    shunt = table[: 2 * steps * samples : 2 * steps] * 1e3 + random.normal(size=samples) * 0.15
    read = y[:, 0] * 1e6 + correlated(random, samples, interval, 0.004, 1.2)
    read = read + random.normal(size=samples) * 2.0
    return [[run] * samples, np.arange(samples) * 0.4, shunt, rounded(read, 1)]
