"""Records of driven axes: a joint of a robot, a positioning table, two motors on a belt."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import DEGREE, TURNS_PER_MINUTE, Record, append, correlated, rounded
from benchmarks.rigs.waves import sines


def joint() -> Record:
    """A joint of a robot on two trajectories; hidden: its grease gets thinner as it warms up."""
    random = np.random.default_rng(4545)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, joint_run(random, run))
    names = ("run", "t_s", "q_deg", "torque_Nm")
    return Record(names, ("%d", "%.2f", "%.4f", "%.1f"), columns)


def joint_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 40 s at 100 Hz; the gear ripples, and it warms up ever more slowly."""
    J, c, dry, thinner, slower, ripple, teeth = 14.2, 95.0, 38.0, 0.62, 900.0, 0.12, 100
    interval, samples = 0.01, 4000
    t = np.arange(samples) * interval
    reference = sines(random, np.arange(0.08, 0.75, 0.08), 0.34, t)
    reference = (reference - reference[0]) * np.minimum(1, t / 1.5)
    before, rate, torque = 0.0, 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, torque
        angle = y[0] + random.normal() * 2e-5
        rate += 0.5 * ((angle - before) / interval - rate)
        before = angle
        after = reference[min(sample + 1, samples - 1)]
        wanted = (after - reference[sample]) / interval
        asked = 2600 * (reference[sample] - angle) + 330 * (wanted - rate) + c * wanted
        torque = round(max(-400.0, min(400.0, asked)) / 0.1) * 0.1
        log.append(torque)

    def field(t: float, y: State) -> list[float]:
        q, w = y
        oil = c - thinner * slower * (1 - math.exp(-t / slower))
        return [w, (torque - oil * w + ripple * math.sin(teeth * q)) / J]

    y = march_dry(field, (dry / J, dry / J), 1, [0, 0], interval, samples, 6, control)
    read = y[:, 0] / DEGREE + correlated(random, samples, interval, 0.1, 0.002)
    read = read + random.normal(size=samples) * 0.004
    return [[run] * samples, t, rounded(read, 0.0005), log]


def table() -> Record:
    """A positioning table on a screw, two runs; hidden: seals that warm up, a floor not level."""
    random = np.random.default_rng(4949)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, table_run(random, run))
    names = ("run", "t_ms", "u_mV", "x_mm")
    return Record(names, ("%d", "%d", "%.1f", "%.4f"), columns)


def table_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 20 s at 250 Hz; the screw has a pitch error, the amplifier bends a little."""
    m, factor, c, dry, less, tilt, bent = 95.0, 35.2, 215.0, 46.0, 0.75, -8.5, 1e-5
    slower, wave, pitch = 2400.0, 4e-6, 0.010
    interval, samples = 0.004, 5000
    t = np.arange(samples) * interval
    reference = 0.11 * np.sin(2 * math.pi * (0.21 + 0.04 * run) * t)
    reference += sines(random, np.arange(0.3, 1.9, 0.21), 0.012, t)
    reference = (reference - reference[0]) * np.minimum(1, t / 0.8)
    before, rate, volts = 0.0, 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, volts
        x = round(y[0] / 1e-6) * 1e-6
        rate += 0.5 * ((x - before) / interval - rate)
        before = x
        after = reference[min(sample + 1, samples - 1)]
        wanted = (after - reference[sample]) / interval
        asked = 50 * (18 * (reference[sample] - x) + wanted - rate)
        volts = round(max(-10.0, min(10.0, asked)) / 5e-4) * 5e-4
        log.append(volts)

    def field(t: float, y: State) -> list[float]:
        push = factor * volts * (1 - bent * volts * volts)
        return [y[1], (push - c * y[1] + tilt) / m]

    def levels(t: float, y: State) -> tuple[float, float]:
        level = (dry - less * slower * (1 - math.exp(-t / slower))) / m
        return level, level

    y = march_dry(field, levels, 1, [0, 0], interval, samples, 6, control)
    shown = y[:, 0] + wave * np.sin(2 * math.pi * y[:, 0] / pitch)
    read = shown * 1e3 + random.normal(size=samples) * 0.004
    read = read + correlated(random, samples, interval, 0.05, 0.003)
    return [[run] * samples, np.arange(samples) * 4, np.array(log) * 1e3, rounded(read, 0.001)]


def belts() -> Record:
    """Two motors and a pulley on a belt, two runs; hidden: a tachogenerator with a bent scale."""
    random = np.random.default_rng(5050)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, belts_run(random, run))
    return Record(
        ("run", "t_s", "u_V", "n_rpm"), ("%d", "%.2f", "%.3f", "%.1f"), columns, ";", True
    )


def belts_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 30 s at 50 Hz; the belt slips a little, the tachogenerator has a ripple."""
    motors, pulley, k, d, brake, drag = 9.0e-4, 2.2e-4, 0.33, 1.9e-3, 2.4e-3, 2.5e-4
    factor, bent, slip, lag = 0.075, 7.0e-5, 0.002, 0.004
    interval, samples = 0.02, 1500
    longs = random.integers(6, 45, samples)
    volts = np.repeat(random.uniform(-2.6, 2.6, samples), longs)[:samples]
    volts = rounded(volts + 0.35 * np.sign(random.normal(size=samples)), 0.005)
    now = 0.0

    def hold(sample: int, y: State) -> None:
        nonlocal now
        now = float(volts[sample])

    def field(t: float, y: State) -> list[float]:
        twist, w, p, shown = y
        belt = k * twist + d * (w - p)
        return [
            w - p - slip * belt,
            (factor * now - brake * w - belt) / motors,
            (belt - drag * p) / pulley,
            (p - shown) / lag,
        ]

    y = march(field, [0, 0, 0, 0], interval, samples, 16, hold)
    rpm = y[:, 3] / TURNS_PER_MINUTE
    read = rpm * (1 + bent * rpm) + correlated(random, samples, interval, 0.05, 1.5)
    read = read + random.normal(size=samples) * 3.0
    t = np.arange(samples) * interval
    return [[run] * samples, t, volts, rounded(read, 0.5)]
