"""Records from lessons: a pumped pendulum, a glider, a ball in a trough and two pendulums."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import DEGREE, Record, append, correlated, rounded
from benchmarks.rigs.waves import sines


def pumped() -> Record:
    """A pendulum below a crank, 60 s after it was let go; hidden: its pivot goes up and down."""
    random = np.random.default_rng(7171)
    w2, c, lift, hertz, phase, rod = 28.3, 0.03, 0.55, 1.58, 2.1, 0.04
    interval, samples = 0.01, 6000

    def field(t: float, y: State) -> list[float]:
        turn = 2 * math.pi * hertz * t + phase
        crank = lift * (math.sin(turn) + rod * math.sin(2 * turn))  # the rod of a crank is short
        return [y[1], -(w2 + crank) * math.sin(y[0]) - c * y[1]]

    y = march(field, [19 * DEGREE, 0], interval, samples, 4)
    read = y[:, 0] / DEGREE + correlated(random, samples, interval, 0.5, 0.12)
    read = read + random.normal(size=samples) * 0.2
    columns = (np.arange(samples) * interval, rounded(read, 0.352))
    return Record(("t_s", "angle_deg"), ("%.2f", "%.2f"), columns, ";", True)


def glider() -> Record:
    """A glider with a propeller between two springs, two runs; hidden: the current has a limit."""
    random = np.random.default_rng(7373)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, glider_run(random, run))
    return Record(("run", "t_ms", "command_pct", "x_mm"), ("%d", "%d", "%d", "%.1f"), columns)


def glider_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 40 s at 25 Hz, each value a mean of three; the limit is a little soft."""
    m, k, c, factor, late, limit, soft = 0.312, 2.55, 0.14, 4.1e-3, 0.13, 80.0, 2.0
    interval, samples, fine = 0.04, 1000, 3
    t = np.arange(samples) * interval
    command = sines(random, np.arange(0.1, 1.4, 0.13), 36.0, t) * np.minimum(1, t / 2)
    command = np.clip(rounded(np.repeat(command[::3], 3)[:samples], 1), -100, 100)
    gusts = correlated(random, samples, interval, 0.5, 0.0006)
    thrust, wind = 0.0, 0.0

    def hold(sample: int, y: State) -> None:
        nonlocal thrust, wind
        at = min(samples - 1, sample // fine)
        over = soft * np.logaddexp(0, (abs(command[at]) - limit) / soft)
        thrust = factor * float(np.sign(command[at]) * (abs(command[at]) - over))
        wind = float(gusts[at])

    def field(t: float, y: State) -> list[float]:
        x, v, push = y
        return [v, (push + wind - k * x - c * v) / m, (thrust - push) / late]

    y = march(field, [0, 0, 0], interval / fine, samples * fine, 4, hold)
    heard = y[:, 0] * 1e3 + random.normal(size=samples * fine) * 1.4
    middle = np.clip(np.arange(samples) * fine, 1, None)
    read = (heard[middle - 1] + heard[middle] + heard[middle + 1]) / 3
    return [[run] * samples, np.arange(samples) * 40, command, rounded(read, 0.5)]


def trough() -> Record:
    """A ball in a trough that a servo tilts, two runs; hidden: a camera that shows it late."""
    random = np.random.default_rng(7474)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run in (1, 2):
        append(columns, trough_run(random, run))
    names = ("run", "t_ms", "told_deg", "tilt_deg", "ball_mm")
    return Record(names, ("%d", "%d", "%.1f", "%.2f", "%.1f"), columns)


def trough_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 30 s at 50 Hz under a controller; lines between frames of 60 Hz."""
    fall, radius, c, rolls, late, seen, bends = 5 / 7 * 9.81, 2.3, 0.09, 0.012, 0.11, 0.022, 0.02
    interval, samples = 0.02, 1500
    goal = np.repeat(random.uniform(-90, 90, 16), 100)[:samples] * 1e-3
    wanted = goal + sines(random, np.arange(0.15, 0.9, 0.15), 0.02, np.arange(samples) * interval)
    told, before, log = 0.0, 0.0, []

    def control(sample: int, y: State) -> None:
        nonlocal told, before
        x = y[0] + random.normal() * 1.5e-3
        rate, before = (x - before) / interval, x
        lead = wanted[sample] / radius + 0.25 * (wanted[sample] - x) - 0.06 * rate
        told = round(max(-6.0, min(6.0, lead / DEGREE)) / 0.1) * 0.1
        log.append(told)

    def field(t: float, y: State) -> list[float]:
        x, v, tilt = y
        pull = fall * (math.sin(tilt) - x / radius * (1 + bends * x * x))
        return [v, pull - c * v, (told * DEGREE - tilt) / late]

    y = march_dry(field, (rolls, rolls), 1, [0, 0, 0], interval, samples, 5, control)
    t = np.arange(samples) * interval
    frames = np.arange(-10, samples * 1.2 + 10) / 60
    filmed = np.interp(frames - seen, t, y[:, 0]) * 1e3 + random.normal(size=len(frames)) * 2.0
    ball = np.interp(t, frames, rounded(filmed, 0.8))
    tilt = y[:, 2] / DEGREE + random.normal(size=samples) * 0.02
    return [[run] * samples, t * 1e3, log, rounded(tilt, 0.09), ball]


def strung() -> Record:
    """Two pendulums with a thread between them, filmed three times; hidden: the thread, on both."""
    random = np.random.default_rng(7575)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, starts in enumerate(((14.0, 0.0), (0.0, -12.0), (-6.0, 11.0)), 1):
        append(columns, strung_run(random, run, starts))
    names = ("run", "t_s", "left_deg", "right_deg")
    return Record(names, ("%d", "%.4f", "%.2f", "%.2f"), columns)


def strung_run(random: np.random.Generator, run: int, starts: tuple[float, float]) -> list[Any]:
    """The columns of 50 s at 30 frames a second; air, and a camera that is a little askew."""
    one, two, c, air, left, right, askew = 27.4, 30.3, 0.016, 0.002, 0.17, 0.23, 3e-5
    interval, samples = 1 / 30, 1500

    def field(t: float, y: State) -> list[float]:
        q, w, p, r = y
        return [
            w,
            -one * math.sin(q) - left * (q - p) - c * w - air * w * abs(w),
            r,
            -two * math.sin(p) - right * (p - q) - c * r - air * r * abs(r),
        ]

    y = march(field, [starts[0] * DEGREE, 0, starts[1] * DEGREE, 0], interval, samples, 8)
    shown = []
    for q in (y[:, 0], y[:, 2]):
        seen = q / DEGREE * (1 + askew * q / DEGREE)
        noise = correlated(random, samples, interval, 0.3, 0.05) + random.normal(size=samples) * 0.1
        shown.append(rounded(seen + noise, 0.05))
    return [[run] * samples, np.arange(samples) * interval, *shown]
