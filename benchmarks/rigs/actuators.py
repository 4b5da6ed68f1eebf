"""Records of actuators that a program switches or sets: a valve and a thermal chamber."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import Record, append, correlated, rounded


def valve() -> Record:
    """A cylinder behind a valve, two runs under a controller; hidden: the overlap of the valve."""
    random = np.random.default_rng(2727)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, valve_run(random, run))
    return Record(("run", "t_ms", "u_mV", "x_mm"), ("%d", "%d", "%.0f", "%.2f"), columns)


def valve_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of one run of 14 s; the edges of the valve are worn, and not quite sharp."""
    factor, late, overlap, worn = 0.036, 0.030, 0.42, 0.045
    interval, samples = 0.004, 3500
    t = np.arange(samples) * interval
    steps = np.repeat(random.uniform(-45, 45, 12), 300)[:samples]
    waves = 9 * np.sin(2 * math.pi * (0.35 + 0.1 * run) * t) + 4 * np.sin(2 * math.pi * 1.3 * t)
    reference = (steps + waves) * 1e-3 * np.minimum(1, t / 0.4)
    flow = 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal flow
        x = round(y[0] / 1e-5) * 1e-5 + random.normal() * 2e-5
        voltage = round(max(-5.0, min(5.0, 90 * (reference[sample] - x))) / 0.005) * 0.005
        log.append(voltage)
        up, down = (voltage - overlap) / worn, (-voltage - overlap) / worn
        flow = factor * worn * float(np.logaddexp(0, up) - np.logaddexp(0, down))

    def field(t: float, y: State) -> list[float]:
        return [y[1], (flow - y[1]) / late]

    y = march(field, [0, 0], interval, samples, 4, control)
    slow = correlated(random, samples, interval, 0.02, 0.01)
    read = y[:, 0] * 1e3 + slow + random.normal(size=samples) * 0.015
    return [[run] * samples, np.arange(samples) * 4, np.array(log) * 1e3, rounded(read, 0.01)]


def chamber() -> Record:
    """A thermal chamber with a thermostat, two runs of 2 h; hidden: nothing."""
    random = np.random.default_rng(3232)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run, targets in enumerate([(45, 60, 38, 52), (55, 40, 65, 48)], 1):
        append(columns, chamber_run(random, run, targets))
    names = ("run", "t_min", "P_W", "room_C", "air_C")
    return Record(names, ("%d", "%.4f", "%d", "%.1f", "%.2f"), columns, ";", True)


def chamber_run(random: np.random.Generator, run: int, targets: tuple[int, ...]) -> list[Any]:
    """The columns of one run, 30 min each target in degrees C; warm walls lose a little more."""
    air, walls, inner, outer, element = 900.0, 7800.0, 9.5, 2.4, 22.0
    full, band, interval, samples = 400.0, 0.5, 5.0, 1440
    target = np.repeat(np.array(targets), 360)
    room = 21.5 + correlated(random, samples + 1, interval, 900.0, 0.5)
    on, log = False, []

    def thermostat(sample: int, y: State) -> None:
        nonlocal on
        on = y[0] < target[sample] + (band if on else -band)
        log.append(full if on else 0)

    def field(t: float, y: State) -> list[float]:
        k = min(samples - 1, int(t / interval + 1e-9))
        outside = room[k] + (room[k + 1] - room[k]) * (t / interval - k)
        rise = y[1] - outside
        lost = outer * rise * (1 + 0.0008 * (rise - 25))
        exchange = inner * (y[0] - y[1])
        heat = full if on else 0.0
        return [(y[2] - exchange) / air, (exchange - lost) / walls, (heat - y[2]) / element]

    y = march(field, [22, 22, 0], interval, samples, 5, thermostat)
    read = y[:, 0] + correlated(random, samples, interval, 12.0, 0.02)
    return [
        [run] * samples,
        np.arange(samples) * interval / 60,
        log,
        rounded(room[:samples] + random.normal(size=samples) * 0.03, 0.1),
        rounded(read + random.normal(size=samples) * 0.02, 0.01),
    ]
