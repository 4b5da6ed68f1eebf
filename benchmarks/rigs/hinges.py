"""Records of what turns on an axle: a swing door, a pendulum at a plate and a bicycle's wheel."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import DEGREE, Record, append, correlated, rounded


def door() -> Record:
    """A swing door of a kitchen, pushed four times; hidden: two valves that are set unlike."""
    random = np.random.default_rng(7070)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, first in enumerate((64.0, -58.0, 47.0, -69.0), 1):
        append(columns, door_run(random, run, first))
    return Record(("run", "t_ms", "rate_deg_s"), ("%d", "%d", "%.3f"), columns)


def door_run(random: np.random.Generator, run: int, first: float) -> list[Any]:
    """The columns of 12 s at 100 Hz, until it rests; the air brakes its leaf a little."""
    w2, c, other, rub, air = 5.6, 0.62, 0.045, 0.11, 0.0015
    interval, samples = 0.01, 1200

    def field(t: float, y: State) -> list[float]:
        q, w = y
        return [w, -w2 * q - c * w - other * abs(w) - air * w * abs(w)]

    y = march_dry(field, (rub, rub), 1, [first * DEGREE, 0.0], interval, samples, 4)
    read = y[:, 1] / DEGREE + correlated(random, samples, interval, 1.5, 0.15)
    read = read + random.normal(size=samples) * 0.35
    return [[run] * samples, np.arange(samples) * 10, rounded(read, 0.061)]


def plate() -> Record:
    """A pendulum that strikes a rubber plate, let go three times; hidden: the plate."""
    random = np.random.default_rng(7777)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, first in enumerate((12.6, 14.4, 13.4), 1):
        append(columns, plate_run(random, run, first))
    return Record(("run", "t_ms", "angle_deg"), ("%d", "%d", "%.2f"), columns)


def plate_run(random: np.random.Generator, run: int, first: float) -> list[Any]:
    """The columns of 14 s at 250 Hz; the plate is soft skin first, and its frame gives way."""
    w2, c, wall, k, speed, skin = 17.8, 0.05, -0.19, 1.2e4, 4.5, 4e-4
    interval, samples = 0.004, 3500

    def field(t: float, y: State) -> list[float]:
        q, w = y
        deep = max(0.0, wall - q)
        push = k * deep**1.5 * max(0.0, 1 - w / speed) * deep / (deep + skin)
        return [w, push - w2 * math.sin(q) - c * w]

    y = march(field, [first * DEGREE, 0], interval, samples, 20)
    read = y[:, 0] / DEGREE + correlated(random, samples, interval, 0.03, 0.02)
    read = read + random.normal(size=samples) * 0.03
    return [[run] * samples, np.arange(samples) * 4, rounded(read, 0.09)]


def bicycle() -> Record:
    """A bicycle's wheel that runs out three times; hidden: a valve that pulls it round."""
    random = np.random.default_rng(7878)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, (first, samples) in enumerate(((11.5, 2900), (-9.5, 2500), (8.0, 2200)), 1):
        append(columns, bicycle_run(random, run, first, samples))
    return Record(("run", "t_s", "angle_deg"), ("%d", "%.3f", "%.2f"), columns, ";")


def bicycle_run(random: np.random.Generator, run: int, first: float, samples: int) -> list[Any]:
    """The columns at 50 Hz until it rests; a magnet that is not centred, grease that is uneven."""
    c, drag, rub, pull, eccentric = 0.012, 0.0035, 0.13, 0.045, 0.02
    interval = 0.02
    uneven = correlated(random, samples + 1, interval, 4.0, 0.0001)

    def field(t: float, y: State) -> list[float]:
        q, w = y
        return [w, -c * w - drag * w * abs(w) + pull * math.sin(q + 2.2)]

    def levels(t: float, y: State) -> tuple[float, float]:
        level = rub + float(uneven[min(samples, int(t / interval))])
        return level, level

    y = march_dry(field, levels, 1, [random.uniform(0, 6), first], interval, samples, 4)
    late = random.normal(size=samples) * 2e-4  # the clock of the small computer
    angle = (y[:, 0] + y[:, 1] * late) / DEGREE
    angle = angle + eccentric * np.sin(angle * DEGREE + 0.7) + random.normal(size=samples) * 0.06
    return [[run] * samples, np.arange(samples) * interval, rounded(angle, 360 / 4096)]
