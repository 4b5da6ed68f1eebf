"""Records of houses and schools: a washing machine, two tanks, a tennis ball, two carts."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import TURNS_PER_MINUTE, Record, append, correlated, rounded
from benchmarks.rigs.waves import Times, sines, tabulated


def drum() -> Record:
    """A washing machine that spins up twice; hidden: its dampers rub, and give before they slip."""
    random = np.random.default_rng(3636)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run, (first, last) in enumerate([(70.0, 330.0), (110.0, 260.0)], 1):
        append(columns, drum_run(random, run, first, last))
    names = ("run", "t_s", "n_rpm", "angle_turn", "x_mm")
    return Record(names, ("%d", "%.2f", "%.2f", "%.4f", "%.2f"), columns, ";", True)


def drum_run(random: np.random.Generator, run: int, first: float, last: float) -> list[Any]:
    """The columns of 30 s from `first` to `last` rpm; the springs harden, the laundry settles."""
    m, k, c, load, level, bend = 48.0, 11500.0, 130.0, 0.21, 15.0, 2.5e-3
    harder, settles = 8.0e4, 0.004
    interval, samples = 0.01, 3000
    T = interval * samples
    up = (last - first) * TURNS_PER_MINUTE / T

    def turn(t: float) -> float:
        return first * TURNS_PER_MINUTE * t + up * t * t / 2

    def field(t: float, y: State) -> list[float]:
        x, v, z = y
        w, a = first * TURNS_PER_MINUTE + up * t, turn(t)
        now = load * (1 - settles * t / T) * min(1.0, t / 0.5)
        push = now * (w * w * math.cos(a) + up * math.sin(a))
        spring = k * x + harder * x**3
        return [v, (push - spring - c * v - level * z) / m, (v - abs(v) * z) / bend]

    y = march(field, [0, 0, 0], interval, samples, 6)
    t = np.arange(samples) * interval
    speed = first + (last - first) * t / T
    read = y[:, 0] * 1e3 + correlated(random, samples, interval, 0.05, 0.02)
    return [
        [run] * samples,
        t,
        speed + random.normal(size=samples) * 0.05,
        np.array([turn(s) for s in t]) / (2 * math.pi) + random.normal(size=samples) * 2e-4,
        rounded(read + random.normal(size=samples) * 0.05, 0.02),
    ]


def tanks() -> Record:
    """Two tanks in a row, two runs of 50 min; hidden: a pump that knows twenty speeds only."""
    random = np.random.default_rng(3838)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run in (1, 2):
        append(columns, tanks_run(random, run))
    names = ("run", "t_min", "duty_pct", "upper_cm", "lower_cm")
    return Record(names, ("%d", "%.4f", "%.1f", "%.2f", "%.2f"), columns)


def tanks_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of one run; the outlets have a bit of a tube, and the pump gets warm."""
    area, upper, lower, full, step, tube, warm = 0.030, 3.3e-5, 3.6e-5, 1.55e-4, 0.05, 0.50, 0.004
    interval, samples = 2.0, 1500
    t = np.arange(samples) * interval
    duty = np.repeat(random.uniform(0.32, 0.74, 18), 84)[:samples]
    duty = duty + 0.06 * np.sin(2 * math.pi * t / (310 + 40 * run))
    duty = rounded(duty, 0.001)
    flow = 0.0

    def hold(sample: int, y: State) -> None:
        nonlocal flow
        flow = full * step * math.floor(duty[sample] / step + 0.5)

    def field(t: float, y: State) -> list[float]:
        first = upper * math.sqrt(2 * 9.81) * max(y[0], 0.0) ** tube
        second = lower * math.sqrt(2 * 9.81) * max(y[1], 0.0) ** tube
        given = flow * (1 - warm * (1 - math.exp(-t / 900)))
        return [(given - first) / area, (first - second) / area]

    y = march(field, [0.26, 0.24], interval, samples, 4, hold)
    read = [y[:, n] * 100 + correlated(random, samples, interval, 4.0, 0.03) for n in (0, 1)]
    return [
        [run] * samples,
        t / 60,
        duty * 100,
        *(rounded(x + random.normal(size=samples) * 0.08, 0.05) for x in read),
    ]


def ball() -> Record:
    """A tennis ball that falls and bounces, filmed at 240 Hz three times; hidden: drag."""
    random = np.random.default_rng(3939)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, height in enumerate((1.72, 1.35, 1.95), 1):
        append(columns, ball_run(random, run, height))
    return Record(("run", "t_ms", "height_mm"), ("%d", "%.2f", "%.1f"), columns)


def ball_run(random: np.random.Generator, run: int, height: float) -> list[Any]:
    """The columns of 1.8 s; the felt is a bit harder deep in, the shutter is not quite even."""
    m, gravity, c, k, loss, harder = 0.0577, 9.81, 1.15e-3, 2.1e4, 4.6, 4.0
    frames, frame, fine = 432, 1 / 240, 20

    def field(t: float, y: State) -> list[float]:
        x, v = y
        floor = max(0.0, -k * x * (1 - harder * x) - loss * v) if x < 0 else 0.0
        return [v, (floor - c * v * abs(v)) / m - gravity]

    y = march(field, [height, 0], frame / fine, (frames + 1) * fine, 4)
    nominal = np.arange(frames) * frame
    exposed = np.maximum(0, nominal + random.normal(size=frames) * 5e-5)
    seen = np.interp(exposed, np.arange(len(y)) * frame / fine, y[:, 0]) * 1e3
    tracked = seen + random.normal(size=frames) * 0.8
    return [[run] * frames, nominal * 1e3, rounded(tracked, 0.1)]


def carts() -> Record:
    """Two carts on springs moved by hand, two runs of 24 s; hidden: a bumper, and dry friction."""
    random = np.random.default_rng(4343)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run, size in enumerate((13.0, 15.0), 1):
        append(columns, carts_run(random, run, size))
    names = ("run", "t_s", "hand_mm", "first_mm", "second_mm")
    return Record(names, ("%d", "%.3f", "%.2f", "%.1f", "%.1f"), columns, ";", True)


def carts_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of one run at 50 Hz; the springs harden, and the camera's clock trembles."""
    m1, m2, left, middle, right, c1, c2 = 0.52, 0.48, 32.0, 24.0, 30.0, 0.34, 0.28
    bumper, gap, dry, harder = 48.0, 0.021, 0.085, 90.0
    interval, samples, fine, steps = 0.02, 1200, 10, 1
    half = interval / fine / steps / 2
    times = np.arange(2 * steps * fine * (samples + 2)) * half
    hand = tabulated(np.asarray(hand_moves(random, size * 1e-3, times), dtype=np.float64), half)

    def field(t: float, y: State) -> list[float]:
        x1, v1, x2, v2 = y
        pulled, apart = hand(t) - x1, x1 - x2
        stop = bumper * max(0.0, -x1 - gap)
        first = left * pulled + harder * pulled**3 - middle * apart - c1 * v1 + stop
        second = middle * apart - right * x2 - harder * x2**3 - c2 * v2
        return [v1, first / m1, v2, second / m2]

    level = dry / m2
    y = march_dry(field, (level, level), 3, [0] * 4, interval / fine, (samples + 1) * fine, steps)
    nominal = np.arange(samples) * interval
    seen = np.maximum(0, nominal + random.normal(size=samples) * 2e-4)
    at = np.arange(len(y)) * interval / fine
    read = [
        np.interp(seen, at, y[:, n]) * 1e3
        + correlated(random, samples, interval, 0.2, 0.05)
        + random.normal(size=samples) * 0.2
        for n in (0, 2)
    ]
    moved = np.array([hand(s) for s in nominal]) * 1e3 + random.normal(size=samples) * 0.02
    return [[run] * samples, nominal, moved, *(rounded(x, 0.1) for x in read)]


def hand_moves(random: np.random.Generator, size: float, times: Times) -> Times:
    """To and fro as a hand does it [m]: near 0.9 Hz, never twice the same, with a rest in it."""
    slow = sines(random, np.arange(0.2, 0.7, 0.09), size * 0.6, times)
    fast = sines(random, np.arange(0.75, 1.9, 0.13), size, times)
    rest = 1 / (1 + np.exp(-np.abs(times - 15.0) * 4 + 6))
    moved: Times = (slow + fast) * np.minimum(1, times / 0.6) * rest
    return moved
