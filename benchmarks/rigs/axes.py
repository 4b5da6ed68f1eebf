"""Records of axes under controllers: a hoist, a levitated globe, a seesaw with rotors, a stage."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import DEGREE, Record, append, correlated, rounded
from benchmarks.rigs.waves import sines

CUT = 150
"""Samples of the levitator that the oscilloscope keeps at a time."""


def hoist() -> Record:
    """A hoist of a mine, two rides; hidden: the weight of its ropes, a guide that is worn."""
    random = np.random.default_rng(3434)
    columns: list[list[Any]] = [[] for _ in range(4)]
    stops = [(-10.5, 6.0, -3.0, 10.0, -8.0), (9.0, -5.0, 3.5, -11.0, 7.0)]
    for run, heights in enumerate(stops, 1):
        append(columns, hoist_run(random, run, heights))
    names = ("run", "t_s", "torque_Nm", "height_mm")
    return Record(names, ("%d", "%.2f", "%.1f", "%d"), columns)


def hoist_run(random: np.random.Generator, run: int, heights: tuple[float, ...]) -> list[Any]:
    """The columns of 64 s between stops at heights in m; the torque follows its log in 5 ms."""
    m, radius, drag, dry, ropes, worn, pitch, phase = (
        2600.0,
        0.32,
        85.0,
        310.0,
        47.0,
        260.0,
        9.0,
        0.6,
    )
    uneven, late, interval, samples = 640.0, 0.005, 0.02, 3200
    seconds = np.linspace(0, 64, len(heights))
    t = np.arange(samples) * interval
    reference = np.zeros(samples)
    for (a, x), (b, z) in pairwise(zip(seconds, heights, strict=True)):
        share = np.clip((t - a - 0.8) / (b - a - 1.6), 0, 1)
        reference += (z - x) * share**3 * (10 - 15 * share + 6 * share**2)
    reference += heights[0]
    torque, integral, before = -uneven * radius, 0.0, heights[0]
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal torque, integral, before
        x = round(y[0] / 1e-3) * 1e-3
        rate, before = (x - before) / interval, x
        error = reference[sample] - x
        wanted = (reference[min(sample + 1, samples - 1)] - reference[sample]) / interval
        integral += 3500 * error * interval
        force = 9000 * (wanted - rate) + 7000 * error + integral - uneven
        torque = round(max(-2500.0, min(2500.0, force * radius)) / 0.5) * 0.5
        log.append(torque)

    def field(t: float, y: State) -> list[float]:
        x, v, given = y
        return [v, (given / radius + uneven + ropes * x - drag * v) / m, (torque - given) / late]

    def levels(t: float, y: State) -> tuple[float, float]:
        level = dry + worn * (1 + math.cos(2 * math.pi * y[0] / pitch + phase)) / 2
        return level / m, level / m

    start = [heights[0], 0.0, torque]
    y = march_dry(field, levels, 1, start, interval, samples, 10, control)
    read = y[:, 0] * 1e3 + random.normal(size=samples) * 0.3
    return [[run] * samples, t, log, rounded(read, 1.0)]


def levitator() -> Record:
    """A globe below a magnet, eight cuts of 3 s; hidden: a shunt that shows too little current."""
    random = np.random.default_rng(3535)
    m, gravity, C, pole, c, more, lag = 0.120, 9.81, 1.73e-3, 0.006, 0.10, 0.07, 2e-4
    interval, samples = 0.001, 3000
    t = np.arange(samples) * interval
    waves = sines(random, np.arange(0.6, 6, 0.55), 1.6e-3, t) * np.minimum(1, t / 0.2)
    reference = 0.040 + waves + np.repeat(random.uniform(-2e-3, 2e-3, 10), 300)
    before, integral, current = 0.040, 0.0, 1.1
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, integral, current
        x = y[0] + random.normal() * 5e-6
        rate, before = (x - before) / interval, x
        error = x - reference[sample]  # the globe is too low
        integral += 120 * error * interval
        current = round(max(0.0, min(3.0, 1.1 + 75 * error + 1.7 * rate + integral)) / 5e-4) * 5e-4
        log.append(current)

    def field(t: float, y: State) -> list[float]:
        x, v, i = y
        pull = C * i * i / (x + pole) ** 2 * (1 - 0.002 * i * i)  # the iron saturates a little
        return [v, gravity - (pull + c * v) / m, ((1 + more) * current - i) / lag]

    y = march(field, [0.040, 0, 1.1 * (1 + more)], interval, samples, 10, control)
    read = y[:, 0] * 1e3 + correlated(random, samples, interval, 0.01, 0.002)
    read = read + random.normal(size=samples) * 0.006
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, first in enumerate(range(100, 2900, 350), 1):
        cut = slice(first, first + CUT)
        current_mA = np.array(log[cut]) * 1e3
        append(columns, [[run] * CUT, range(CUT), current_mA, rounded(read[cut], 0.001)])
    return Record(("run", "t_ms", "i_mA", "gap_mm"), ("%d", "%d", "%.1f", "%.3f"), columns)


def rotors() -> Record:
    """A seesaw with two rotors, 40 s; hidden: rotors that follow late and are not alike."""
    random = np.random.default_rng(4242)
    J, K, c, weight, late, unlike, more = 0.021, 0.0040, 0.006, 0.16, 0.070, 0.011, 0.0004
    interval, samples = 0.01, 4000
    wanted = np.repeat(random.uniform(-17, 17, 25), 160)[:samples] * DEGREE
    wash = correlated(random, samples, interval, 0.15, 8e-5)
    before, rate, duty, gust = 0.0, 0.0, 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, duty, gust
        gust = float(wash[sample])
        angle = y[0] + random.normal() * 0.04 * DEGREE
        rate += 0.4 * ((angle - before) / interval - rate)
        before = angle
        pushed = 105 * (wanted[sample] - angle) - 24 * rate
        duty = round(max(-35.0, min(35.0, pushed)) / 0.1) * 0.1
        log.append(duty)

    def field(t: float, y: State) -> list[float]:
        q, w, given = y
        thrust = K * given * (1 + more * abs(given)) + unlike + gust
        return [w, (thrust - weight * math.sin(q) - c * w) / J, (duty - given) / late]

    y = march(field, [0, 0, 0], interval, samples, 5, control)
    read = y[:, 0] / DEGREE + correlated(random, samples, interval, 0.05, 0.015)
    read = read + random.normal(size=samples) * 0.04
    t = np.arange(samples) * interval
    return Record(
        ("t_s", "u_pct", "tilt_deg"), ("%.2f", "%.1f", "%.2f"), (t, log, rounded(read, 0.01))
    )


def ripple() -> Record:
    """A linear motor with force ripple, two runs of 5 s; hidden: nothing."""
    random = np.random.default_rng(4444)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, ripple_run(random, run))
    return Record(("run", "t_ms", "i_mA", "x_um"), ("%d", "%d", "%.0f", "%.0f"), columns, ";")


def ripple_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of one run; the ripple has a weak second wave, the guide a weak seal."""
    m, K, c, dry, wave, pitch, second, seal = 3.2, 21.0, 9.0, 3.4, 2.1, 0.030, 0.004, 0.0015
    interval, samples = 0.002, 2500
    t = np.arange(samples) * interval
    reference = 0.055 * np.sin(2 * math.pi * (0.35 + 0.06 * run) * t)
    reference += sines(random, np.arange(0.5, 3.6, 0.3), 0.012, t)
    reference *= np.minimum(1, t / 0.5)
    before, rate, integral, current = 0.0, 0.0, 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, integral, current
        x = round(y[0] / 1e-6) * 1e-6
        rate += 0.5 * ((x - before) / interval - rate)
        before = x
        error = reference[sample] - x
        integral += 900 * error * interval
        current = round(max(-8.0, min(8.0, 130 * error - 6 * rate + integral)) / 0.002) * 0.002
        log.append(current)

    def field(t: float, y: State) -> list[float]:
        at = 2 * math.pi * y[0] / pitch
        teeth = wave * (math.sin(at + 0.8) + second * math.sin(2 * at))
        return [y[1], (K * current - c * y[1] + teeth) / m]

    def levels(t: float, y: State) -> tuple[float, float]:
        level = dry * (1 + seal * math.exp(-((y[1] / 0.02) ** 2))) / m
        return level, level

    y = march_dry(field, levels, 1, [0, 0], interval, samples, 8, control)
    read = y[:, 0] * 1e6 + 0.8 * np.sin(2 * math.pi * y[:, 0] / 20e-6)  # of the scale's lines
    read = (
        read + correlated(random, samples, interval, 0.02, 2.0) + random.normal(size=samples) * 3.0
    )
    return [[run] * samples, np.arange(samples) * 2, np.array(log) * 1e3, rounded(read, 1.0)]
