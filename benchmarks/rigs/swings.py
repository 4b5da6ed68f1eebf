"""Records of what swings: a foam ball on a rod, a seismometer, a needle and a circuit."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import DEGREE, Record, append, correlated, rounded
from benchmarks.rigs.waves import sines, tabulated


def foam() -> Record:
    """A foam ball on a rod, 240 s of a free decay; hidden: the drag of the ball."""
    random = np.random.default_rng(5757)
    w2, c, drag, stretch, fades = 16.35, 0.006, 0.020, 1e-5, 1e-4
    interval, samples = 0.02, 12000

    def field(t: float, y: State) -> list[float]:
        load = math.cos(y[0]) + y[1] * y[1] / w2  # over the weight of the ball
        pull = w2 * (1 - stretch * load) * math.sin(y[0])
        return [y[1], -pull - c * (1 - fades * t) * y[1] - drag * y[1] * abs(y[1])]

    y = march(field, [41 * DEGREE, 0], interval, samples, 4)
    trembles = correlated(random, samples, interval, 2.0, 0.02)
    read = y[:, 0] / DEGREE + trembles + random.normal(size=samples) * 0.03
    lost = random.choice(np.arange(1, samples), 40, replace=False)
    kept = np.setdiff1d(np.arange(samples), lost)
    columns = (np.arange(samples)[kept] * interval, rounded(read, 0.18)[kept])
    return Record(("t_s", "angle_deg"), ("%.2f", "%.2f"), columns)


def seismometer() -> Record:
    """A seismometer on a floor that trembles, 90 s; hidden: a fan that shakes its mass."""
    random = np.random.default_rng(5858)
    w2, c, fan, hertz, phase, wobble, harder = 57.0, 3.2, 0.011, 4.13, 0.9, 0.01, 2e4
    interval, samples, steps = 0.01, 9000, 3
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    floor = np.zeros(len(times))
    for tone in np.arange(0.15, 9.0, 0.11):  # softer at high frequencies, as floors are
        floor += sines(random, np.array([tone]), 0.006 / math.sqrt(tone), times)
    base = tabulated(floor, half)

    def field(t: float, y: State) -> list[float]:
        size = fan * (1 + wobble * math.sin(2 * math.pi * t / 31))
        push = size * math.sin(2 * math.pi * hertz * t + phase)
        return [y[1], push - base(t) - w2 * y[0] - harder * y[0] ** 3 - c * y[1]]

    y = march(field, [0, 0], interval, samples, steps)
    shown = floor[: 2 * steps * samples : 2 * steps] * 1e3 + random.normal(size=samples) * 0.15
    read = y[:, 0] * 1e6 + correlated(random, samples, interval, 5.0, 1.0)
    read = read + random.normal(size=samples) * 3.0
    columns = (np.arange(samples) * 10, shown, rounded(read, 2.0))
    return Record(("t_ms", "base_mm_s2", "x_um"), ("%d", "%.3f", "%.0f"), columns, ";")


def needle() -> Record:
    """A needle on a torsion wire, let go three times; hidden: its pivot rubs, its zero is off."""
    random = np.random.default_rng(5959)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, angle in enumerate((52.0, -39.0, 45.0), 1):
        append(columns, needle_run(random, run, angle))
    return Record(("run", "t_s", "phi_deg"), ("%d", "%.2f", "%.1f"), columns, ";", True)


def needle_run(random: np.random.Generator, run: int, angle: float) -> list[Any]:
    """The columns of 20 s, until it rests; the wire hardens a little."""
    w2, c, dry, zero, harder = 30.0, 0.12, 0.25, 1.4, 1.2e-3
    interval, samples = 0.01, 2000

    def field(t: float, y: State) -> list[float]:
        return [y[1], -w2 * y[0] * (1 + harder * y[0] ** 2) - c * y[1]]

    y = march_dry(field, (dry, dry), 1, [angle * DEGREE, 0], interval, samples, 6)
    read = y[:, 0] / DEGREE + zero + correlated(random, samples, interval, 0.4, 0.02)
    read = read + random.normal(size=samples) * 0.07
    return [[run] * samples, np.arange(samples) * interval, rounded(read, 0.1)]


def capacitor() -> Record:
    """A coil and a ceramic capacitor under two chirps; hidden: it holds less at high voltages."""
    random = np.random.default_rng(6666)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, (volts, first, last) in enumerate([(2.2, 250.0, 1500.0), (2.6, 1400.0, 300.0)], 1):
        append(columns, capacitor_run(random, run, volts, first, last))
    return Record(("run", "t_us", "u_V", "i_mA"), ("%d", "%d", "%.4f", "%.2f"), columns)


def capacitor_run(
    random: np.random.Generator, run: int, volts: float, first: float, last: float
) -> list[Any]:
    """The columns of 0.1 s at 20 kHz; the wire warms up, a share of the charge comes late."""
    L, R, C, k3, warms, late, soaks = 0.010, 12.0, 4.7e-6, 7.5e12, 0.06, 0.004, 8e-4
    interval, samples, steps = 5e-5, 2000, 4
    T = interval * samples

    def u(t: float) -> float:
        return volts * math.sin(2 * math.pi * (first * t + (last - first) * t * t / (2 * T)))

    def field(t: float, y: State) -> list[float]:
        q, i, soaked = y
        across = q / C + k3 * q**3
        return [
            i,
            (u(t) - R * (1 + warms * i * i) * i - across + soaked) / L,
            (soaks * across - soaked) / late,
        ]

    y = march(field, [0, 0, 0], interval, samples, steps)
    t = np.arange(samples) * interval
    shown = np.array([u(s) for s in t]) + random.normal(size=samples) * 0.002
    read = y[:, 1] * 1e3 + random.normal(size=samples) * 0.5
    return [[run] * samples, np.arange(samples) * 50, shown, rounded(read, 0.25)]
