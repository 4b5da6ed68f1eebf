"""Records of what is driven: a car that coasts, a cylinder, a cart with a cable, a gimbal motor."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import DEGREE, Record, append, correlated, rounded

KILOMETRES_PER_HOUR = 1 / 3.6
"""In m/s."""
BAR = 1e5
"""In Pa."""


def car() -> Record:
    """A car that coasts three times down one road; hidden: the tyres, the same as a slope is."""
    random = np.random.default_rng(1111)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, (first, samples) in enumerate([(112, 960), (96, 880), (104, 920)], 1):
        append(columns, car_run(random, run, first, samples))
    return Record(("run", "t_s", "v_kmh"), ("%d", "%.1f", "%.1f"), columns)


def car_run(random: np.random.Generator, run: int, first: float, samples: int) -> list[Any]:
    """The columns of one run of the car from `first` km/h on, against gusts of wind."""
    m, drag, tyres, interval = 1465.0, 0.396, 151.0, 0.1
    gusts = correlated(random, samples + 1, interval, 7.0, 0.25)

    def field(t: float, y: State) -> list[float]:
        k = min(samples - 1, int(t / interval))
        wind = gusts[k] + (gusts[k + 1] - gusts[k]) * (t / interval - k)
        return [(-drag * (y[0] + wind) ** 2 - tyres) / m]

    y = march(field, [first * KILOMETRES_PER_HOUR], interval, samples, 2)
    read = y[:, 0] / KILOMETRES_PER_HOUR + random.normal(size=samples) * 0.06
    return [[run] * samples, np.arange(samples) * interval, rounded(read, 0.1)]


def cylinder() -> Record:
    """A cylinder against a spring, two multisines of 20 s; hidden: friction under pressure."""
    random = np.random.default_rng(1313)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, cylinder_run(random, run))
    return Record(("run", "t_s", "dp_bar", "x_mm"), ("%d", "%.2f", "%.4f", "%.3f"), columns)


def cylinder_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of one run: the seal follows the pressure with a small part of it late."""
    m, k, c, area = 8.0, 6000.0, 60.0, 8.04e-4
    dry, share, late, creep = 9.0, 0.12, 0.05, 0.4
    interval, samples, steps = 0.01, 2000, 8
    tones = np.arange(0.15, 2.4, 0.15)
    phases = random.uniform(0, 2 * math.pi, len(tones))
    amplitude = 1.5 * BAR * math.sqrt(2 / len(tones)) * (1 + 0.15 * (run == 2))
    half = interval / steps / 2  # a step of the method looks at its middle, too
    times = np.arange(2 * steps * samples + 16) * half
    waves = np.sin(2 * math.pi * np.outer(times, tones) + phases)
    pressure = amplitude * waves.sum(axis=1) * np.minimum(1, times / 0.5)

    def push(t: float) -> float:
        at = t / half  # a reversal may end a step anywhere
        i = int(at)
        return area * float(pressure[i] + (pressure[i + 1] - pressure[i]) * (at - i))

    def field(t: float, y: State) -> list[float]:
        force = push(t)
        return [y[1], (force - k * y[0] - c * y[1]) / m, (abs(force) - y[2]) / creep]

    def levels(t: float, y: State) -> tuple[float, float]:
        level = (dry + share * abs(push(t)) + late * y[2]) / m
        return level, level

    y = march_dry(field, levels, 1, [0, 0, 0], interval, samples, steps)
    slow = correlated(random, samples, interval, 0.2, 0.02)
    return [
        [run] * samples,
        np.arange(samples) * interval,
        pressure[:: 2 * steps][:samples] / BAR + random.normal(size=samples) * 0.004,
        y[:, 0] * 1e3 + slow + random.normal(size=samples) * 0.04,
    ]


def cart() -> Record:
    """A cart on a rail under a controller, two runs; hidden: a cable's spring and dry friction."""
    random = np.random.default_rng(1414)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, cart_run(random, run))
    return Record(("run", "t_ms", "u_V", "x_mm"), ("%d", "%d", "%.4f", "%.2f"), columns)


def cart_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of one run; the rail brakes a little more at one end than at the other."""
    M, factor, brake, cable, level = 0.9, 1.7, 5.5, 1.8, 0.42
    interval, samples = 0.01, 1500
    reference = np.repeat(random.uniform(-0.32, 0.32, 14), 110)[:samples]
    reference[:30] = 0
    before, voltage, log = 0.0, 0.0, []

    def control(sample: int, y: State) -> None:
        nonlocal before, voltage
        x = round(y[0] / 1e-4) * 1e-4
        asked = 16 * (reference[sample] - x) - 1.5 * (x - before) / interval
        voltage = round(max(-6.0, min(6.0, asked)) / 0.005) * 0.005
        before = x
        log.append(voltage)

    def field(t: float, y: State) -> list[float]:
        rail = brake * (1 + 0.1 * y[0] / 0.3) * y[1]
        return [y[1], (factor * voltage - rail - cable * y[0]) / M]

    y = march_dry(field, (level / M, level / M), 1, [0, 0], interval, samples, 10, control)
    return [
        [run] * samples,
        np.arange(samples) * 10,
        log,
        rounded(y[:, 0] * 1e3 + random.normal(size=samples) * 0.03, 0.1),
    ]


def gimbal() -> Record:
    """A gimbal motor of 6 s under a slow speed controller; hidden: magnets, 12 on a turn."""
    random = np.random.default_rng(1515)
    J, kt, R, grease, dry, magnets, teeth = 4.5e-5, 0.06, 1.5, 6.0e-5, 1.6e-3, 2.6e-3, 12
    interval, samples = 0.001, 6000
    levels = (3.0, 5.5, -2.5, -5.0, 4.0, 7.0, -3.5, 2.0, 6.0, -6.5, -2.0, 4.5)
    reference = np.repeat(np.array(levels), 500)
    before, rate, integral, voltage = 0.0, 0.0, 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, integral, voltage
        angle = round(y[0] / DEGREE / 0.02) * 0.02 * DEGREE
        rate += 0.1 * ((angle - before) / interval - rate)
        before = angle
        error = reference[sample] - rate
        integral += 0.8 * error * interval
        voltage = round(max(-2.0, min(2.0, 0.03 * error + integral)) / 0.001) * 0.001
        log.append(voltage)

    def field(t: float, y: State) -> list[float]:
        uneven = 1 + 0.1 * math.sin(y[0] + 0.4)  # the rotor is not quite in the middle
        pull = magnets * uneven * math.sin(teeth * y[0] + 0.7)
        return [y[1], (kt / R * (voltage - kt * y[1]) - grease * y[1] + pull) / J]

    y = march_dry(field, (dry / J, dry / J), 1, [0, 0], interval, samples, 6, control)
    angle = rounded(y[:, 0] / DEGREE + random.normal(size=samples) * 0.01, 0.02)
    columns = (np.arange(samples) * interval, log, angle)
    return Record(("t", "u_V", "angle_deg"), ("%.3f", "%.3f", "%.2f"), columns, ";")
