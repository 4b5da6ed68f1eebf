"""Records of what is let go and left alone: two pendulums, two wheels and a model of a ship."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import DEGREE, Record, append, correlated, rounded

FRAME = 1 / 60
"""Of a phone's film in s."""
LOST = (118, 119, 297, 455)
"""Frames that the phone did not keep."""
ASKEW = 9 * DEGREE
"""By which the phone does not look straight at the pendulum."""


def video() -> Record:
    """A bar on a bushing, filmed for 10 s until it rests; hidden: dry friction and nothing else."""
    random = np.random.default_rng(2121)
    w2, air, level, turns = 23.6, 0.03, 0.50, 0.8  # turns: the share that follows the load
    frames, fine = 606, 10

    def field(t: float, y: State) -> list[float]:
        return [y[1], -w2 * math.sin(y[0]) - air * y[1]]

    def levels(t: float, y: State) -> tuple[float, float]:
        load = math.cos(y[0]) + 0.75 * y[1] ** 2 / w2  # over the weight of the bar
        now = level * (1 - turns + turns * load)
        return now, now

    y = march_dry(field, levels, 1, [43 * DEGREE, 0], FRAME / fine, (frames + 1) * fine, 2)
    nominal = np.arange(frames) * FRAME
    exposed = np.maximum(0, nominal + random.normal(size=frames) * 0.3e-3)
    angle = np.interp(exposed, np.arange(len(y)) * FRAME / fine, y[:, 0])
    seen = np.arctan(np.tan(angle) * math.cos(ASKEW)) / DEGREE
    tracked = seen + random.normal(size=frames) * 0.08
    kept = np.setdiff1d(np.arange(frames), LOST)
    columns = (rounded(nominal * 1e3, 1.0)[kept], tracked[kept])
    return Record(("t_ms", "angle_deg"), ("%d", "%.2f"), columns, ";")


def flywheel() -> Record:
    """A flywheel that runs out three times; hidden: windage and dry friction of the seals."""
    random = np.random.default_rng(2828)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, (first, samples) in enumerate([(3000, 1280), (1400, 900), (2300, 1150)], 1):
        append(columns, runs_out(random, run, first, samples))
    return Record(("run", "t_s", "n_rpm"), ("%d", "%.1f", "%.2f"), columns)


def runs_out(random: np.random.Generator, run: int, first: float, samples: int) -> list[Any]:
    """The columns of one run from `first` rpm on: slots that pass in 0.1 s, of 360 on a turn."""
    grease, windage, seals = 0.008, 3.2e-5, 1.15  # over the inertia
    thin, warm, interval, slots = 0.09, 35.0, 0.1, 360  # the grease gets thinner as it warms up

    def field(t: float, y: State) -> list[float]:
        now = grease * (1 - thin * (1 - math.exp(-t / warm)))
        return [y[1], -now * y[1] - windage * y[1] * abs(y[1])]

    start = [random.uniform(0, 1), first * math.pi / 30]
    y = march_dry(field, (seals, seals), 1, start, interval, samples + 1, 6)
    passed = np.floor(y[:, 0] / (2 * math.pi) * slots)
    return [
        [run] * samples,
        np.arange(samples) * interval,
        np.diff(passed) / slots / interval * 60,
    ]


def magnets() -> Record:
    """A pendulum with a magnet in its bob, three angles; hidden: a magnet in the table below it."""
    random = np.random.default_rng(3030)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, angle in enumerate((47.0, -36.0, 42.0), 1):
        append(columns, magnets_run(random, run, angle))
    return Record(("run", "t_ms", "angle_deg"), ("%d", "%d", "%.2f"), columns)


def magnets_run(random: np.random.Generator, run: int, angle: float) -> list[Any]:
    """The columns of one run of 24 s; two dipoles, and currents that one drives in the other."""
    w2, c, pull, gap, currents = 27.4, 0.19, 13.0, 0.22, 0.02  # the gap over the length of the rod
    interval, samples = 0.01, 2400

    def field(t: float, y: State) -> list[float]:
        near = 1 + 2 * (1 + gap) / gap**2 * (1 - math.cos(y[0]))  # of the distance, its square
        slowed = c + currents / near**4
        return [y[1], -(w2 + pull / near**2.5) * math.sin(y[0]) - slowed * y[1]]

    y = march(field, [angle * DEGREE, 0], interval, samples, 8)
    read = y[:, 0] / DEGREE + random.normal(size=samples) * 0.02
    return [[run] * samples, np.arange(samples) * 10, rounded(read, 0.09)]


def ship() -> Record:
    """A model of a ship that rolls to its rest, four times; hidden: nothing."""
    random = np.random.default_rng(3131)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, heel in enumerate((24.0, -17.0, 20.0, -26.0), 1):
        append(columns, rolls(random, run, heel))
    return Record(("run", "t_s", "roll_deg"), ("%d", "%.2f", "%.2f"), columns, ";", True)


def rolls(random: np.random.Generator, run: int, heel: float) -> list[Any]:
    """The columns of one run from `heel` degrees on; its own waves come back to it a little."""
    k, softer, flat, linear, keels, waves, memory = 12.4, 7.5, 14.0, 0.065, 0.16, 0.05, 0.6
    interval, samples, window = 0.04, 1000, 5

    def field(t: float, y: State) -> list[float]:
        lever = k * y[0] - softer * y[0] ** 3 - flat * y[0] ** 5
        water = linear * y[1] + keels * y[1] * abs(y[1]) + waves * (y[1] - y[2])
        return [y[1], -lever - water, (y[1] - y[2]) / memory]

    y = march(field, [heel * DEGREE, 0, 0], interval, samples + window - 1, 6)
    read = y[:, 0] / DEGREE + random.normal(size=len(y)) * 0.09
    smooth = np.convolve(read, np.ones(window) / window, "valid")  # as the software of the tank
    slow = correlated(random, samples, interval, 0.5, 0.02)
    return [[run] * samples, np.arange(samples) * interval, rounded(smooth + slow, 0.01)]


def grindstone() -> Record:
    """A grindstone on its axle that runs out three times; hidden: its heavy side."""
    random = np.random.default_rng(4106)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, (first, samples) in enumerate([(7.1, 2400), (-6.2, 2150), (6.7, 2300)], 1):
        append(columns, heavy_side_runs_out(random, run, first, samples))
    return Record(("run", "t_s", "angle_deg"), ("%d", "%.2f", "%.1f"), columns, ";")


def heavy_side_runs_out(
    random: np.random.Generator, run: int, first: float, samples: int
) -> list[Any]:
    """The columns of one run from `first` rad/s on; 720 counts on a turn, a disc of the encoder
    that does not sit straight, and a strap that touches the rim over a part of a turn."""
    heavy, spot, bearing, oil, strap, interval = 0.42, 0.8, 0.11, 0.042, 0.015, 0.02
    lines, askew = 720, 0.003

    def field(t: float, y: State) -> list[float]:
        return [y[1], -oil * y[1] - heavy * math.sin(y[0] - spot)]

    def levels(t: float, y: State) -> tuple[float, float]:
        now = bearing + strap * max(math.sin(y[0] + 1.1), 0.0)
        return now, now

    y = march_dry(field, levels, 1, [random.uniform(0, 6), first], interval, samples, 10)
    seen = y[:, 0] + askew * np.sin(y[:, 0] - 2.0)
    return [
        [run] * samples,
        np.arange(samples) * interval,
        np.floor(seen / (2 * math.pi) * lines) * 360 / lines,
    ]
