"""Records of servos: a belt drive, a geared motor that creeps, and the arm of a robot."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march_dry
from benchmarks.rigs.record import DEGREE, TURNS_PER_MINUTE, Record, append, correlated, rounded

RAMP = 80
"""Samples in which the set angle of the arm goes from one to the next."""


def belt() -> Record:
    """A motor with a pulley under a speed controller, twice 4 s; hidden: the load behind a belt."""
    random = np.random.default_rng(2424)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, belt_run(random, run))
    return Record(("run", "t_ms", "torque_mNm", "n_rpm"), ("%d", "%d", "%.1f", "%.1f"), columns)


def belt_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of one run; the belt gets stiffer as it is pulled."""
    motor, load, k, d, drag, dry = 3.1e-4, 5.2e-4, 10.4, 0.006, 9e-4, 0.021
    stiffer, interval, samples = 12.0, 0.001, 4000
    reference = belt_speeds(random, interval, samples)
    torque, integral = 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal torque, integral
        read = y[1] + random.normal() * 1.5 * TURNS_PER_MINUTE
        error = reference[sample] * TURNS_PER_MINUTE - read
        integral += 0.5 * error * interval
        torque = round(max(-0.6, min(0.6, 0.03 * error + integral)) / 1e-4) * 1e-4
        log.append(torque)

    def field(t: float, y: State) -> list[float]:
        _, wm, twist, wl = y
        pull = k * twist * (1 + stiffer * twist * twist) + d * (wm - wl)
        return [wm, (torque - drag * wm - pull) / motor, wm - wl, pull / load]

    start = [0.0, 0.0, 0.0, 0.0]
    y = march_dry(field, (dry / motor, dry / motor), 1, start, interval, samples, 5, control)
    slow = correlated(random, samples, interval, 0.003, 1.0)
    read = y[:, 1] / TURNS_PER_MINUTE + slow + random.normal(size=samples) * 1.2
    return [[run] * samples, np.arange(samples), np.array(log) * 1e3, rounded(read, 0.5)]


def belt_speeds(random: np.random.Generator, interval: float, samples: int) -> list[float]:
    """In rpm: steps, and a sine from 4 to 30 Hz on them."""
    levels = np.repeat(random.uniform(-500, 500, 12), 350)[:samples]
    t = np.arange(samples) * interval
    T = samples * interval
    return list(levels + 25 * np.sin(2 * math.pi * (4 * t + 26 * t * t / (2 * T))))


def creeper() -> Record:
    """A geared motor of 24 s, slowly to and fro; hidden: friction that is higher near rest."""
    J, K, loss, dry, more, speed, teeth = 2.1e-4, 0.024, 0.0030, 6.2e-3, 4.4e-3, 0.9, 0.04e-3
    interval, samples = 0.005, 4800
    t = np.arange(samples) * interval
    swing = 2.4 * np.sin(2 * math.pi * t / 3.1) + 1.5 * np.sin(2 * math.pi * t / 1.37 + 1)
    reference = swing * (0.45 + 0.55 * np.sin(2 * math.pi * t / 11) ** 2)
    before, rate, integral, voltage = 0.0, 0.0, 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, integral, voltage
        angle = math.floor(y[0] / DEGREE / 0.09) * 0.09 * DEGREE
        rate += 0.25 * ((angle - before) / interval - rate)
        before = angle
        error = reference[sample] - rate
        integral += 1.2 * error * interval
        voltage = round(max(-6.0, min(6.0, 0.12 * error + integral)) / 0.005) * 0.005
        log.append(voltage)

    def field(t: float, y: State) -> list[float]:
        return [y[1], (K * voltage - loss * y[1] + teeth * math.sin(7 * y[0] + 0.5)) / J]

    def levels(t: float, y: State) -> tuple[float, float]:
        level = (dry + more * math.exp(-((y[1] / speed) ** 2))) / J
        return level, level

    y = march_dry(field, levels, 1, [0, 0], interval, samples, 12, control)
    angle = np.floor(y[:, 0] / DEGREE / 0.09) * 0.09 + 0.045
    columns = (t, np.array(log) * 1e3, angle)
    return Record(("t_s", "u_mV", "angle_deg"), ("%.3f", "%.0f", "%.3f"), columns)


def arm() -> Record:
    """The arm of a robot, two runs; hidden: a limit of the amplifier, a hose like a spring."""
    random = np.random.default_rng(2929)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, arm_run(random, run))
    names = ("run", "t_s", "i_set_A", "q_deg")
    return Record(names, ("%d", "%.3f", "%.3f", "%.3f"), columns)


def arm_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 8 s under a controller of 500 Hz; the gear's wheels are not quite round."""
    J, K, weight, loss, dry, hose, limit, gear = 0.088, 1.85, 2.20, 0.30, 0.32, 0.85, 2.3, 0.016
    interval, samples = 0.002, 4000
    steps = np.repeat(random.uniform(-105, 105, 12), 370)[:samples] * DEGREE
    reference = np.convolve(np.concatenate([np.zeros(RAMP - 1), steps]), np.ones(RAMP), "valid")
    reference /= RAMP
    before, current = 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, current
        angle = round(y[0] / DEGREE / 0.018) * 0.018 * DEGREE
        rate = (angle - before) / interval
        before = angle
        current = round((7.0 * (reference[sample] - angle) - 0.7 * rate) / 0.002) * 0.002
        log.append(current)

    def field(t: float, y: State) -> list[float]:
        given = max(-limit, min(limit, current))
        load = weight * math.sin(y[0]) + hose * y[0] + loss * y[1]
        return [y[1], (K * given - load + gear * math.sin(21 * y[0] + 1)) / J]

    y = march_dry(field, (dry / J, dry / J), 1, [0, 0], interval, samples, 8, control)
    read = y[:, 0] / DEGREE + random.normal(size=samples) * 0.006
    return [[run] * samples, np.arange(samples) * interval, log, rounded(read, 0.018)]
