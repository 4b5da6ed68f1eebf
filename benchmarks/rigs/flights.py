"""Records of what is let go: a table tennis ball, a wheel with a weight, a telephone on a rod."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import DEGREE, Record, append, correlated, rounded


def flight() -> Record:
    """A table tennis ball that a robot throws, six flights; hidden: the lift of its backspin."""
    random = np.random.default_rng(5151)
    columns: list[list[Any]] = [[] for _ in range(4)]
    throws = [(6.2, 22), (8.4, 12), (5.1, 38), (7.4, 25), (9.1, 17), (5.8, 31)]
    for run, (speed, angle) in enumerate(throws, 1):
        append(columns, flight_run(random, run, speed, angle * DEGREE))
    names = ("run", "t_ms", "x_mm", "z_mm")
    return Record(names, ("%d", "%.2f", "%.1f", "%.1f"), columns)


def flight_run(random: np.random.Generator, run: int, speed: float, angle: float) -> list[Any]:
    """The columns of 0.65 s at 200 Hz; the spin slows, the lens bends, the shutter trembles."""
    m, gravity, drag, lift, slower, bent = 2.7e-3, 9.81, 3.4e-4, 8.5e-4, 25.0, 4e-5
    frames, frame, fine = 130, 0.005, 5
    spun = lift * (1 + 0.006 * random.normal())

    def field(t: float, y: State) -> list[float]:
        _, _, vx, vz = y
        air = drag * math.hypot(vx, vz)
        now = spun * math.exp(-t / slower)
        return [vx, vz, (-air * vx - now * vz) / m, (-air * vz + now * vx) / m - gravity]

    start = [0.0, 0.25, speed * math.cos(angle), speed * math.sin(angle)]
    y = march(field, start, frame / fine, (frames + 1) * fine, 2)
    nominal = np.arange(frames) * frame
    exposed = np.maximum(0, nominal + random.normal(size=frames) * 3e-5)
    at = np.arange(len(y)) * frame / fine
    x, z = (np.interp(exposed, at, y[:, n]) for n in (0, 1))
    far = 1 + bent * ((x - 1.8) ** 2 + (z - 0.8) ** 2)
    read = [(1.8 + (x - 1.8) * far) * 1e3, (0.8 + (z - 0.8) * far) * 1e3]
    tracked = (rounded(p + random.normal(size=frames) * 1.2, 0.1) for p in read)
    return [[run] * frames, nominal * 1e3, *tracked]


def rolling() -> Record:
    """A wheel with a weight at its rim that rolls on a rail, four times; hidden: nothing."""
    random = np.random.default_rng(5252)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, (angle, rate) in enumerate([(118, 0.4), (-35, 4.3), (138, -0.6), (20, -4.9)], 1):
        append(columns, rolling_run(random, run, angle * DEGREE, rate))
    names = ("run", "t_s", "gyro_deg_s", "angle_deg")
    return Record(names, ("%d", "%.2f", "%.2f", "%.1f"), columns)


def rolling_run(random: np.random.Generator, run: int, angle: float, rate: float) -> list[Any]:
    """The columns of 16 s at 100 Hz; the rail leans by a very little, the sensor is 0.6 ms late."""
    m, radius, off, own, dry, c = 2.6, 0.171, 0.031, 0.0262, 0.0085, 0.0036
    leans, late = 2.0e-5, 0.0006
    interval, samples = 0.01, 1600

    def inertia(q: float) -> float:
        return own + m * (radius**2 + off**2 - 2 * radius * off * math.cos(q))

    def field(t: float, y: State) -> list[float]:
        q, w, shown = y
        weight = -m * 9.81 * off * math.sin(q) + m * 9.81 * leans * radius
        turn = m * radius * off * math.sin(q) * w * w
        return [w, (weight - turn - c * w) / inertia(q), (w - shown) / late]

    def levels(t: float, y: State) -> tuple[float, float]:
        level = dry / inertia(y[0])
        return level, level

    y = march_dry(field, levels, 1, [angle, rate, rate], interval, samples, 20)
    slow = correlated(random, samples, interval, 0.3, 0.1)
    read = y[:, 2] / DEGREE + slow + random.normal(size=samples) * 0.4
    filmed = y[:, 0] / DEGREE + random.normal(size=samples) * 1.2
    t = np.arange(samples) * interval
    return [[run] * samples, t, rounded(read, 0.06), rounded(filmed, 0.5)]


def telephone() -> Record:
    """A telephone on a rod, let go by hand three times; hidden: a gyroscope that shows too much."""
    random = np.random.default_rng(5454)
    columns: list[list[Any]] = [[] for _ in range(3)]
    for run, angle in enumerate((118, -84, 132), 1):
        append(columns, telephone_run(random, run, angle * DEGREE))
    return Record(("run", "t_s", "gyro_rad_s"), ("%d", "%.5f", "%.4f"), columns)


def telephone_run(random: np.random.Generator, run: int, angle: float) -> list[Any]:
    """The columns of 20 s, near 100 Hz at uneven times; the rod bends, the hand lets go slowly."""
    swing, c, drag, more, bent = 14.4, 0.028, 0.021, 0.065, 3e-4
    frame, fine, samples = 0.0099, 4, 2020

    def field(t: float, y: State) -> list[float]:
        q, w = y
        held = math.exp(-((t / 0.1) ** 2)) * 0.6 * swing * math.sin(q) if t < 0.5 else 0.0
        away = 1 - bent * w * w / swing
        return [w, held - swing * away * math.sin(q) - c * w - drag * w * abs(w)]

    y = march(field, [angle, 0], frame / fine, (samples + 60) * fine, 2)
    seen = np.arange(samples) * frame + random.normal(size=samples) * 8e-4 + 0.5
    seen = np.sort(seen)
    rates = np.interp(seen, np.arange(len(y)) * frame / fine, y[:, 1]) * (1 + more)
    read = rates + correlated(random, samples, frame, 0.05, 0.002)
    read = rounded(read + random.normal(size=samples) * 0.008, 0.0011)
    return [[run] * samples, seen - 0.5 + 0.01, read]
