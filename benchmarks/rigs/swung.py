"""Records of what was let go: a paddle in paste, a ball on a wire and a pendulum with a rotor."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import DEGREE, Record, append, correlated, rounded


def paste() -> Record:
    """A paddle in a paste of starch, let go four times; hidden: a paste that thickens."""
    random = np.random.default_rng(8181)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, first in enumerate((72.0, -58.0, 44.0, 65.0), 1):
        append(columns, paste_run(random, run, first))
    return Record(("run", "t_s", "angle_deg"), ("%d", "%.2f", "%.1f"), columns, ";", True)


def paste_run(random: np.random.Generator, run: int, first: float) -> list[Any]:
    """The columns of 18 s at 50 Hz, until it rests; the starch settles, the clock is uneven."""
    w2, c, thick, settles, slow = 9.4, 0.115, 0.009, 0.02, 9.0
    interval, samples = 0.02, 900

    def field(t: float, y: State) -> list[float]:
        thins = 1 - settles * (1 - math.exp(-t / slow))
        return [y[1], -w2 * y[0] - (c * y[1] + thick * y[1] ** 3) * thins]

    y = march(field, [first * DEGREE, 0.0], interval, samples, 6)
    late = random.normal(size=samples) * 4e-4
    read = (y[:, 0] + y[:, 1] * late) / DEGREE + correlated(random, samples, interval, 0.4, 0.12)
    read = read + random.normal(size=samples) * 0.25
    return [[run] * samples, np.arange(samples) * interval, rounded(read, 0.3)]


def wire() -> Record:
    """A ball with a sail on a wire, let go three times; hidden: a wire that hardens, and air."""
    random = np.random.default_rng(8383)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, first in enumerate((17.5, -13.0, 15.5), 1):
        append(columns, wire_run(random, run, first))
    return Record(("run", "t_ms", "x_mm"), ("%d", "%d", "%.2f"), columns, ";")


def wire_run(random: np.random.Generator, run: int, first: float) -> list[Any]:
    """The columns of 12 s at 200 Hz behind a filter of 60 Hz; the wire warms and gets softer."""
    w2, c, harder, air, softer = 386.0, 0.07, 2.6e4, 0.55, 2e-5
    interval, samples = 0.005, 2400
    corner = 2 * math.pi * 60

    def field(t: float, y: State) -> list[float]:
        x, v, shown, rate = y
        pull = w2 * (1 - softer * t) * x + harder * x**3
        rise = corner * corner * (x - shown) - 1.414 * corner * rate
        return [v, -pull - c * v - air * v * abs(v), rate, rise]

    y = march(field, [first * 1e-3, 0.0, first * 1e-3, 0.0], interval, samples, 8)
    read = y[:, 2] * 1e3 + correlated(random, samples, interval, 0.03, 0.04)
    read = read + random.normal(size=samples) * 0.05
    return [[run] * samples, np.arange(samples) * 5, rounded(read, 0.02)]


def rotor() -> Record:
    """A pendulum in two axes, let go three times; hidden: a rotor in its bob that still spins."""
    random = np.random.default_rng(8585)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, starts in enumerate(((11.0, 0.5), (-0.6, -9.0), (7.5, -6.0)), 1):
        append(columns, rotor_run(random, run, starts))
    return Record(("run", "t_s", "east_deg", "north_deg"), ("%d", "%.3f", "%.2f", "%.2f"), columns)


def rotor_run(random: np.random.Generator, run: int, starts: tuple[float, float]) -> list[Any]:
    """The columns of 24 s at 50 Hz; the rotor runs out slowly, the air brakes the bob."""
    east, north, c, d, spin, other, slows, air = (
        20.6,
        22.9,
        0.021,
        0.034,
        0.031,
        0.027,
        0.0012,
        0.002,
    )
    interval, samples = 0.02, 1200

    def field(t: float, y: State) -> list[float]:
        q, w, p, r = y
        left = 1 - slows * t
        return [
            w,
            -east * math.sin(q) - c * w - spin * left * r - air * w * abs(w),
            r,
            -north * math.sin(p) - d * r + other * left * w - air * r * abs(r),
        ]

    y = march(field, [starts[0] * DEGREE, 0.0, starts[1] * DEGREE, 0.0], interval, samples, 6)
    shown = []
    for q in (y[:, 0], y[:, 2]):
        noise = correlated(random, samples, interval, 0.2, 0.04) + random.normal(size=samples) * 0.1
        shown.append(rounded(q / DEGREE + noise, 0.06))
    return [[run] * samples, np.arange(samples) * interval, *shown]
