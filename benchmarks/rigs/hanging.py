"""Records of what hangs: a double pendulum, the crab of a crane and an arm with a pendulum."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march_dry
from benchmarks.rigs.record import DEGREE, Record, append, correlated, rounded
from benchmarks.rigs.waves import sines

GRAVITY = 9.81
"""In m/s^2."""


def double() -> Record:
    """A double pendulum, let go three times; hidden: a dry joint in its middle."""
    random = np.random.default_rng(9999)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, starts in enumerate(((24.0, -32.0), (-9.0, 41.0), (20.0, 26.0)), 1):
        append(columns, double_run(random, run, starts))
    names = ("run", "t_ms", "upper_deg", "lower_deg")
    return Record(names, ("%d", "%d", "%.1f", "%.1f"), columns)


def double_run(random: np.random.Generator, run: int, starts: tuple[float, float]) -> list[Any]:
    """The columns of 18 s at 100 Hz, begun in motion; the air brakes the lower rod.

    The states are the upper angle, the bend, its rate, and the momentum of both rods, which the
    torque of the joint between them does not change.
    """
    A, B, D, G1, G2, c1, c2 = 0.01792, 0.00295, 0.00528, 0.8525, 0.2158, 1.6e-3, 2.2e-4
    dry, air = 1.5e-3, 2.0e-5
    interval, samples, before = 0.01, 1800, 37

    def parts(y: State) -> tuple[float, float, float]:
        """The inertia of both rods, that of the lower one in it, and the rate of the upper one."""
        near = D * math.cos(y[1])
        H, N = A + B + 2 * near, B + near
        return H, N, (y[3] - N * y[2]) / H

    def field(t: float, y: State) -> list[float]:
        q, b, r = y[:3]
        H, N, w = parts(y)
        s = D * math.sin(b)
        drag = air * (w + r) * abs(w + r)
        low = -G2 * math.sin(q + b) - drag
        both = -G1 * math.sin(q) + low - c1 * w
        turned = both + 2 * s * r * w + s * r * r
        elbow = low - s * w * w - c2 * r
        return [w, r, (elbow - N * turned / H) / (B - N * N / H), both]

    def levels(t: float, y: State) -> tuple[float, float]:
        H, N, _ = parts(y)
        level = dry / (B - N * N / H)
        return level, level

    start = [starts[0] * DEGREE, (starts[1] - starts[0]) * DEGREE, 0.0, 0.0]
    y = march_dry(field, levels, 2, start, interval, samples + before, 8)[before:]
    shown = []
    for q in (y[:, 0], y[:, 0] + y[:, 1]):
        noise = correlated(random, samples, interval, 0.1, 0.05) + random.normal(size=samples) * 0.1
        shown.append(rounded(q / DEGREE + noise, 0.1))
    return [[run] * samples, np.arange(samples) * 10, *shown]


def crab() -> Record:
    """The crab of a crane with its load, two runs; hidden: the motor acts after a dead time."""
    random = np.random.default_rng(9494)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run in (1, 2):
        append(columns, crab_run(random, run))
    names = ("run", "t_s", "told_V", "crab_mm", "load_deg")
    return Record(names, ("%d", "%.2f", "%.2f", "%.1f", "%.2f"), columns, ";", True)


def crab_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 25 s at 100 Hz; told 50 times a second over a bus, a rail that is not level.

    The last state is the rate of the load along its arc, which the friction of the rail does not
    change.
    """
    M, m, rope, factor, c, dry, swings = 6.4, 1.9, 0.82, 3.1, 9.5, 2.6, 0.03
    late, leans = 57, 0.01
    samples, fine = 2500, 10
    t = np.arange(samples) * 0.01
    goal = np.repeat(random.uniform(-0.35, 0.35, 9), 280)[:samples]
    goal = goal + sines(random, np.arange(0.2, 1.4, 0.2), 0.03, t) * np.minimum(1, t)
    before, rate, told = 0.0, 0.0, 0.0
    waits = [0.0] * late
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, told
        if sample % 20 == 0:
            x = round(y[0] / 1e-4) * 1e-4
            rate += 0.5 * ((x - before) / 0.02 - rate)
            before = x
            angle = round(y[2] / DEGREE / 0.05) * 0.05 * DEGREE + random.normal() * 1e-3
            off = goal[min(sample // fine, samples - 1)] - x
            asked = 21.0 * off - 9.0 * rate + 10.0 * angle
            told = round(max(-9.0, min(9.0, asked)) / 0.05) * 0.05
        if sample % fine == 0:
            log.append(told)
        waits.append(told)

    def field(s: float, y: State) -> list[float]:
        _, v, q, arc = y
        w = (arc - math.cos(q) * v) / rope
        force = factor * waits[-late - 1] - c * v + leans * math.sin(2.1 * y[0])
        force += m * rope * w * w * math.sin(q)
        force += m * math.cos(q) * (GRAVITY * math.sin(q) + swings * w)
        fall = -GRAVITY * math.sin(q) - swings * w - math.sin(q) * w * v
        return [v, force / (M + m * math.sin(q) ** 2), w, fall]

    def levels(s: float, y: State) -> tuple[float, float]:
        level = dry / (M + m * math.sin(y[2]) ** 2)
        return level, level

    start = [0.02, 0.0, 2.5 * DEGREE, 0.0]
    y = march_dry(field, levels, 1, start, 1e-3, samples * fine, 1, control)[::fine]
    crab = y[:, 0] * 1e3 + random.normal(size=samples) * 0.08
    noise = correlated(random, samples, 0.01, 0.15, 0.04) + random.normal(size=samples) * 0.06
    load = rounded(y[:, 2] / DEGREE + noise, 0.05)
    return [[run] * samples, t, log, rounded(crab, 0.1), load]


def arm() -> Record:
    """An arm with a pendulum that hangs from its end, two runs; hidden: nothing."""
    random = np.random.default_rng(10303)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run in (1, 2):
        append(columns, arm_run(random, run))
    names = ("run", "t_s", "u_V", "arm_deg", "pendulum_deg")
    return Record(names, ("%d", "%.3f", "%.2f", "%.2f", "%.2f"), columns)


def arm_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 14 s at 200 Hz under a controller; a stiff cable and unequal brushes.

    The last state is the momentum of the pendulum over its inertia, which the friction of the arm
    does not change.
    """
    J, P, G, W, factor, c1, c2, dry = 0.0042, 0.0021, 0.0024, 0.124, 0.031, 6.5e-3, 8e-5, 4.0e-3
    cable, brushes = 1.5e-6, 2.0e-7
    interval, samples = 0.005, 2800
    t = np.arange(samples) * interval
    goal = np.repeat(random.uniform(-1.1, 1.1, 10), 310)[:samples]
    goal = goal + sines(random, np.arange(0.2, 2.6, 0.3), 0.15, t) * np.minimum(1, t)
    step = 2 * math.pi / 4096
    before, rate, volts = 0.0, 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, volts
        angle = round(y[0] / step) * step
        rate += 0.4 * ((angle - before) / interval - rate)
        before = angle
        asked = 7.5 * (goal[min(sample, samples - 1)] - angle) - 0.35 * rate
        volts = round(max(-10.0, min(10.0, asked)) / 0.02) * 0.02
        log.append(volts)

    def inertia(q: float) -> float:
        return J + P * math.sin(q) ** 2 - (G * math.cos(q)) ** 2 / P

    def field(s: float, y: State) -> list[float]:
        a, v, q, momentum = y
        sine, cosine = math.sin(q), math.cos(q)
        w = momentum - G / P * cosine * v
        fall = -W * sine - c2 * w
        torque = factor * volts - c1 * v - cable * a - brushes * v * v
        torque += -2 * P * sine * cosine * v * w + G * sine * w * w
        torque -= G * cosine / P * (P * sine * cosine * v * v + fall)
        rise = P * sine * cosine * v * v - G * sine * v * w + fall
        return [v, torque / inertia(q), w, rise / P]

    def levels(s: float, y: State) -> tuple[float, float]:
        level = dry / inertia(y[2])
        return level, level

    y = march_dry(field, levels, 1, [0.0, 0.0, 0.1, 0.0], interval, samples, 5, control)
    shown = []
    for q in (y[:, 0], y[:, 2]):
        trembles = correlated(random, samples, interval, 0.1, 0.03)
        noise = trembles + random.normal(size=samples) * 0.03
        shown.append(rounded((q / DEGREE + noise), 360 / 4096))
    return [[run] * samples, t, log, *shown]
