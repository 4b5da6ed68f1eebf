"""Records of what a motor moves: a slider for a camera, a table on a worm and a model train."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march_dry
from benchmarks.rigs.record import TURNS_PER_MINUTE, Record, append, correlated, rounded
from benchmarks.rigs.waves import sines


def slider() -> Record:
    """A slider for a camera, two runs; hidden: a bridge that does nothing at small duties."""
    random = np.random.default_rng(8282)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, slider_run(random, run))
    return Record(("run", "t_ms", "duty_pct", "x_mm"), ("%d", "%d", "%d", "%.1f"), columns)


def slider_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 24 s at 100 Hz; edges that are soft, and a rail that rubs unevenly by 1 %."""
    m, factor, c, dry, zone, soft, uneven = 2.3, 0.34, 11.0, 2.2, 6.0, 0.15, 0.012
    interval, samples = 0.01, 2400
    t = np.arange(samples) * interval
    steps = np.repeat(random.uniform(-0.16, 0.16, 16), 150)[:samples]
    goal = steps + sines(random, np.arange(0.2, 1.6, 0.2), 0.012, t)
    goal = goal * np.minimum(1, t)
    before, rate, force = 0.0, 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, force
        x = round(y[0] / 4e-4) * 4e-4
        rate += 0.3 * ((x - before) / interval - rate)
        before = x
        asked = 420 * (goal[min(sample, samples - 1)] - x) - 34 * rate
        duty = float(round(max(-70.0, min(70.0, asked))))
        log.append(duty)
        over = soft * float(np.logaddexp(0, (abs(duty) - zone) / soft))
        force = factor * math.copysign(over, duty)

    def field(t: float, y: State) -> list[float]:
        return [y[1], (force - c * y[1]) / m]

    def levels(t: float, y: State) -> tuple[float, float]:
        level = (dry + uneven * math.sin(37 * y[0] + 1.0)) / m
        return level, level

    y = march_dry(field, levels, 1, [0.0, 0.0], interval, samples, 5, control)
    read = y[:, 0] * 1e3 + correlated(random, samples, interval, 0.1, 0.06)
    read = read + random.normal(size=samples) * 0.05
    return [[run] * samples, np.arange(samples) * 10, log, rounded(read, 0.4)]


def worm() -> Record:
    """A table on a worm, two runs; hidden: a collar that rubs as it is pressed."""
    random = np.random.default_rng(8787)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, worm_run(random, run))
    return Record(
        ("run", "t_s", "torque_mNm", "speed_rpm"), ("%d", "%.3f", "%.2f", "%.0f"), columns
    )


def worm_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 16 s at 250 Hz; oil that thins by 2 %, a worm that runs out a little."""
    inertia, c, dry, share, hangs, thins, out = 4.6e-4, 9e-4, 0.018, 0.03, 0.011, 0.02, 1e-4
    interval, samples = 0.004, 4000
    t = np.arange(samples + 1) * interval
    goal = sines(random, np.arange(0.15, 2.2, 0.17), 3.4, t) * np.minimum(1, t)
    before, rate, torque = 0.0, 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, torque
        angle = round(y[0] * 2000 / (2 * math.pi)) * 2 * math.pi / 2000
        rate += 0.35 * ((angle - before) / interval - rate)
        before = angle
        at = min(sample, samples - 1)
        wanted = (goal[at + 1] - goal[at]) / interval
        asked = 0.35 * (goal[at] - angle) + 0.022 * (wanted - rate)
        torque = round(max(-0.4, min(0.4, asked)) / 5e-4) * 5e-4
        log.append(torque)

    def field(t: float, y: State) -> list[float]:
        oil = c * (1 - thins * (1 - math.exp(-t / 6)))
        return [y[1], (torque - hangs - oil * y[1] + out * math.sin(y[0])) / inertia]

    def levels(t: float, y: State) -> tuple[float, float]:
        level = (dry + share * abs(torque)) / inertia
        return level, level

    y = march_dry(field, levels, 1, [0.0, 0.0], interval, samples, 4, control)
    read = y[:, 1] / TURNS_PER_MINUTE + correlated(random, samples, interval, 0.02, 1.2)
    read = read + random.normal(size=samples) * 2.5
    return [[run] * samples, t[:samples], np.array(log) * 1e3, rounded(read, 1)]


def train() -> Record:
    """A model train to and fro, two runs; hidden: nothing."""
    random = np.random.default_rng(8888)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, train_run(random, run))
    return Record(("run", "t_s", "rail_V", "v_mm_s"), ("%d", "%.2f", "%.2f", "%.0f"), columns, ";")


def train_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 60 s at 20 Hz; a floor that is not level and rails with a dirty spot."""
    m, factor, c, dry, more, speed = 0.62, 0.155, 1.35, 0.30, 0.12, 0.06
    leans, dirty = 0.0006, 0.0008
    interval, samples = 0.05, 1200
    t = np.arange(samples) * interval
    told = np.repeat(random.uniform(-9, 9, 40), 40)[:samples]
    told = told + sines(random, np.arange(0.1, 0.9, 0.1), 1.1, t)
    told = rounded(np.where(np.abs(told) < 1.2, 0.0, told), 0.05)
    volts = 0.0

    def hold(sample: int, y: State) -> None:
        nonlocal volts
        volts = float(told[min(sample, samples - 1)])

    def field(t: float, y: State) -> list[float]:
        return [y[1], (factor * volts - c * y[1] + leans * math.sin(2 * y[0])) / m]

    def levels(t: float, y: State) -> tuple[float, float]:
        level = (dry + more * math.exp(-((y[1] / speed) ** 2)) + dirty * math.cos(3 * y[0])) / m
        return level, level

    y = march_dry(field, levels, 1, [0.0, 0.0], interval, samples, 12, hold)
    moves = np.abs(y[:, 1]) > 1e-6
    noise = correlated(random, samples, interval, 0.15, 2.5) + random.normal(size=samples) * 4.0
    return [[run] * samples, t, told, rounded(y[:, 1] * 1e3 + noise * moves, 2)]
