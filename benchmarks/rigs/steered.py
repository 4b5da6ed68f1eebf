"""Records of what a hand steers: a car in a slalom and a model boat."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import DEGREE, Record, append, correlated, rounded
from benchmarks.rigs.waves import sines, tabulated


def slalom() -> Record:
    """A car in a slalom at three speeds; hidden: a steering gear of another ratio."""
    random = np.random.default_rng(9393)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run, speed in enumerate((12.4, 22.1, 17.3), 1):
        append(columns, slalom_run(random, run, speed))
    names = ("run", "t_s", "wheel_deg", "yaw_deg_s", "side_m_s2")
    return Record(names, ("%d", "%.2f", "%.1f", "%.2f", "%.3f"), columns)


def slalom_run(random: np.random.Generator, run: int, speed: float) -> list[Any]:
    """The columns of 20 s at 100 Hz, begun in a bend; tyres that give way a little at the front."""
    m, inertia, a, b, front, rear = 1320.0, 1980.0, 1.12, 1.48, 7.6e4, 9.4e4
    ratio, gives = 17.8, 0.9
    interval, samples, steps = 0.01, 2000, 4
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 32) * half
    size = 2.6 * ratio / DEGREE / (speed**2 / (2.6 + 0.0028 * speed**2))
    sway = np.sin(2 * math.pi * (0.34 * times + 0.12 * np.sin(0.4 * times)) + run)
    table = size * (0.75 * sway + sines(random, np.arange(0.15, 1.9, 0.13), 0.35, times))
    wheel = tabulated(table, half)

    def forces(t: float, y: State) -> tuple[float, float]:
        slip = (y[0] + a * y[1]) / speed - wheel(t) * DEGREE / ratio
        return -front * slip * (1 - gives * slip * slip), -rear * (y[0] - b * y[1]) / speed

    def field(t: float, y: State) -> list[float]:
        ahead, behind = forces(t, y)
        return [(ahead + behind) / m - speed * y[1], (a * ahead - b * behind) / inertia]

    y = march(field, [-0.2, 0.08], interval, samples, steps)
    t = np.arange(samples) * interval
    pushed = np.array([sum(forces(at, row)) / m for at, row in zip(t, y, strict=True)])
    yaw = y[:, 1] / DEGREE + correlated(random, samples, interval, 0.1, 0.06)
    yaw = yaw + random.normal(size=samples) * 0.09
    side = pushed + correlated(random, samples, interval, 0.03, 0.05)
    side = side + random.normal(size=samples) * 0.04
    shown = rounded(table[: 2 * steps * samples : 2 * steps], 0.1)
    return [[run] * samples, t, shown, rounded(yaw, 0.05), rounded(side, 0.01)]


def boat() -> Record:
    """A model boat along a string, by hand, three runs; hidden: a dead zone, and drag."""
    random = np.random.default_rng(10000)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2, 3):
        append(columns, boat_run(random, run))
    names = ("run", "t_s", "stick_pct", "x_mm")
    return Record(names, ("%d", "%.2f", "%.0f", "%.0f"), columns, ";")


def boat_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 60 s at 25 Hz, filmed from above; water that drifts, and a soft edge."""
    m, factor, c, drag, zone, soft, drifts = 2.4, 0.029, 0.9, 5.2, 9.0, 0.3, 6e-4
    interval, samples, fine = 0.04, 1500, 4
    t = np.arange(samples) * interval
    hand = sines(random, np.arange(0.04, 0.7, 0.045), 34.0, t)
    nudges = random.uniform(-30, 30, 25)
    rests = np.repeat(random.uniform(size=25) < 0.3, 60)
    stick = np.where(rests, 0.0, hand + np.repeat(nudges, 60))
    stick = np.clip(np.round(np.convolve(stick, np.ones(7) / 7, "same")), -100, 100)
    at = random.uniform(0, 2 * math.pi)
    force = 0.0

    def hold(sample: int, y: State) -> None:
        nonlocal force
        told = float(stick[min(samples - 1, sample // fine)])
        over = soft * float(np.logaddexp(0, (abs(told) - zone) / soft))
        force = factor * math.copysign(over, told)

    def field(s: float, y: State) -> list[float]:
        v = y[1] - drifts * math.sin(2 * math.pi * s / 45 + at)
        return [y[1], (force - c * v - drag * v * abs(v)) / m]

    y = march(field, [0.0, 0.05], interval / fine, samples * fine, 2, hold)[::fine]
    read = y[:, 0] * 1e3 + correlated(random, samples, interval, 0.5, 1.2)
    read = read + random.normal(size=samples) * 1.6
    return [[run] * samples, t, stick, rounded(read, 2)]
