"""Records of what is shaken: a loudspeaker, a wheel with its damper and ropes as isolators."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import Record, append, correlated, rounded
from benchmarks.rigs.waves import sines, tabulated


def loudspeaker() -> Record:
    """A woofer, two multisines at 8 kHz; hidden: a suspension that hardens, more on one side."""
    random = np.random.default_rng(2222)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, size in enumerate((1.0, 1.15), 1):
        append(columns, loudspeaker_run(random, run, size))
    return Record(("run", "t_ms", "i_mA", "x_mm"), ("%d", "%.3f", "%.1f", "%.4f"), columns)


def loudspeaker_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of one run of 0.5 s; the coil leaves its magnet a little, the surround creeps."""
    m, k, c, factor, sided, harder = 0.0182, 1900.0, 1.5, 6.2, 6.0e4, 2.6e7
    leaves, creep, late = 900.0, 30.0, 0.02
    interval, samples, steps = 1.25e-4, 4000, 2
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    table = sines(random, np.arange(12, 220, 4.0), 0.5 * size, times) * np.minimum(1, times / 0.02)
    current = tabulated(table, half)

    def field(t: float, y: State) -> list[float]:
        x = y[0]
        pull = factor * (1 - leaves * x * x) * current(t)
        spring = k * x + sided * x * x + harder * x**3 + creep * (x - y[2])
        return [y[1], (pull - spring - c * y[1]) / m, (x - y[2]) / late]

    y = march(field, [0, 0, 0], interval, samples, steps)
    slow = correlated(random, samples, interval, 5e-4, 0.002)
    return [
        [run] * samples,
        np.arange(samples) * interval * 1e3,
        table[:: 2 * steps][:samples] * 1e3 + random.normal(size=samples) * 2.0,
        y[:, 0] * 1e3 + slow + random.normal(size=samples) * 0.003,
    ]


def wheel() -> Record:
    """A wheel on a post and a body above it, two roads; hidden: a damper harder in rebound."""
    random = np.random.default_rng(2323)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run, size in enumerate((5.5, 6.5), 1):
        append(columns, wheel_run(random, run, size))
    names = ("run", "t_s", "post_mm", "body_mm", "travel_mm")
    return Record(names, ("%d", "%.3f", "%.3f", "%.2f", "%.2f"), columns, ";")


def wheel_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of one run of 15 s; the damper sits in rubber, and its force comes a bit late."""
    body, axle, spring, tyre = 312.0, 41.0, 18900.0, 188e3
    mean, more, rubber = 1450.0, 560.0, 0.0025
    interval, samples, steps = 0.005, 3000, 10
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    road = np.zeros(len(times))
    for low, high, share in [(0.5, 2.0, 1.0), (2.0, 6.0, 0.35), (6.0, 16.0, 0.16)]:
        road += sines(random, np.arange(low, high, 0.1), share * size * 1e-3, times)
    road *= np.minimum(1, times / 0.5)
    post = tabulated(road, half)

    def field(t: float, y: State) -> list[float]:
        up, vb, low, va, force = y
        rate = vb - va
        pull = -spring * (up - low) - force
        return [
            vb,
            pull / body,
            va,
            (-pull - tyre * (low - post(t))) / axle,
            (mean * rate + more * abs(rate) - force) / rubber,
        ]

    y = march(field, [0, 0, 0, 0, 0], interval, samples, steps)
    slow = correlated(random, samples, interval, 0.03, 0.06)
    travel = (y[:, 0] - y[:, 2]) * 1e3 + slow + random.normal(size=samples) * 0.05
    return [
        [run] * samples,
        np.arange(samples) * interval,
        road[:: 2 * steps][:samples] * 1e3 + random.normal(size=samples) * 0.01,
        y[:, 0] * 1e3 + random.normal(size=samples) * 0.1,
        rounded(travel, 0.05),
    ]


def isolator() -> Record:
    """A mass on wire ropes under a shaker, two multisines; hidden: the hysteresis of the ropes."""
    random = np.random.default_rng(2626)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, size in enumerate((38.0, 46.0), 1):
        append(columns, isolator_run(random, run, size))
    return Record(("run", "t_ms", "F_N", "x_mm"), ("%d", "%d", "%.2f", "%.3f"), columns)


def isolator_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of one run of 8 s; ropes that are pulled straight get stiffer by a little."""
    m, k, c, level, bend, straight = 11.4, 13500.0, 35.0, 42.0, 0.7e-3, 9.0e6
    interval, samples, steps = 0.002, 4000, 4
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    table = sines(random, np.arange(0.5, 14, 0.5), size, times) * np.minimum(1, times / 0.3)
    force = tabulated(table, half)

    def field(t: float, y: State) -> list[float]:
        x, v, z = y
        pull = force(t) - k * x - straight * x**3 - c * v - level * z
        return [v, pull / m, (v - 0.5 * abs(v) * z * abs(z) - 0.5 * v * z * z) / bend]

    y = march(field, [0, 0, 0], interval, samples, steps)
    slow = correlated(random, samples, interval, 0.02, 0.004)
    return [
        [run] * samples,
        np.arange(samples) * 2,
        table[:: 2 * steps][:samples] + random.normal(size=samples) * 0.3,
        y[:, 0] * 1e3 + slow + random.normal(size=samples) * 0.006,
    ]
