"""Records of labs: a pendulum, a shaker table, a crane, a torsion pendulum and a flexure stage."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry, runge_kutta
from benchmarks.rigs.record import DEGREE, Array, Record, append, correlated, rounded


def pendulum() -> Record:
    """A pendulum of 45 s with an encoder of 0.09 degrees; hidden: drag of the air."""
    w2, c, d = 34.0, 0.11, 0.05
    interval, samples = 0.01, 4500

    def field(t: float, y: State) -> list[float]:
        return [y[1], -w2 * math.sin(y[0]) - c * y[1] - d * y[1] * abs(y[1])]

    y = march(field, [60 * DEGREE, 0], interval, samples, 5)
    angle = rounded(y[:, 0] / DEGREE, 0.09)
    return Record(("time_ms", "angle_deg"), ("%d", "%.2f"), (np.arange(samples) * 10, angle))


def shaker_table() -> Record:
    """A mass on a shaker table, swept up and down; hidden: a cubic spring and dry friction."""
    random = np.random.default_rng(202)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, (first, last, amplitude) in enumerate([(4, 13, 2.2), (13, 4, 2.4)], 1):
        append(columns, sweep(random, run, first, last, amplitude))
    names = ("run", "t_s", "base_ms2", "gap_mm")
    return Record(names, ("%d", "%.3f", "%.4f", "%.4f"), columns)


def sweep(
    random: np.random.Generator, run: int, first: float, last: float, amplitude: float
) -> list[Any]:
    """The columns of 8 s of the shaker table, from `first` to `last` Hz, amplitude in m/s^2."""
    w2, c, k3, level = (2 * math.pi * 8) ** 2, 3.0, 6.0e6, 0.25
    interval, samples = 0.002, 4000
    T = samples * interval

    def table(t: float) -> float:
        turns = first * t + (last - first) * t * t / (2 * T)
        return amplitude * math.sin(2 * math.pi * turns) * min(1, t / 0.3)

    def field(t: float, y: State) -> list[float]:
        return [y[1], -table(t) - w2 * y[0] - c * y[1] - k3 * y[0] ** 3]

    y = march_dry(field, (level, level), 1, [0, 0], interval, samples, 8)
    t = np.arange(samples) * interval
    base = np.array([table(s) for s in t]) + random.normal(size=samples) * 0.015
    gap = y[:, 0] * 1e3 + random.normal(size=samples) * 0.008
    return [[run] * samples, t, base, gap]


def crane() -> Record:
    """A crane in three runs of 10 s; hidden: an angle that comes late, damping of the pivot."""
    random = np.random.default_rng(707)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run in (1, 2, 3):
        append(columns, crane_run(random, run))
    names = ("run", "t_s", "force_N", "cart_mm", "angle_deg")
    return Record(names, ("%d", "%.3f", "%.3f", "%.2f", "%.3f"), columns)


def crane_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of one run of the crane, under a controller of the cart; steps of 1 ms."""
    M, m, length, J, g, c_cart, c_pivot = 1.2, 0.25, 0.35, 0.0025, 9.81, 4.0, 0.004
    interval, samples, steps, late = 0.005, 2000, 5, 12
    reference = np.repeat(random.uniform(-0.3, 0.3, 12), 170)[:samples]
    force, log = 0.0, []

    def field(t: float, y: State) -> list[float]:
        _, v, angle, w = y
        s, c = math.sin(angle), math.cos(angle)
        fx = force - c_cart * v + m * length * s * w * w
        ft = -m * g * length * s - c_pivot * w
        a, b, d = M + m, m * length * c, J + m * length * length
        D = a * d - b * b
        return [v, (d * fx - b * ft) / D, w, (a * ft - b * fx) / D]

    path: list[list[float]] = []
    y = [0.0, 0.0, 0.1 * run, 0.0]
    for k in range(samples):
        force = max(-9, min(9, 25 * (reference[k] - y[0]) - 6 * y[1]))
        log.append(force)
        for s in range(steps):
            path.append(list(y))
            y = runge_kutta(field, k * interval + s * interval / steps, y, interval / steps)
    fine: Array = np.array(path)
    angle = fine[np.maximum(np.arange(samples) * steps - late, 0), 2]
    angle[:3] = fine[0, 2]  # at rest before the start
    return [
        [run] * samples,
        np.arange(samples) * interval,
        np.array(log) + random.normal(size=samples) * 0.02,
        fine[::steps, 0] * 1e3 + random.normal(size=samples) * 0.2,
        angle / DEGREE + random.normal(size=samples) * 0.05,
    ]


def torsion() -> Record:
    """A torsion pendulum from three angles; hidden: a spring stiffer on one side, an offset."""
    random = np.random.default_rng(808)
    k, half, c, offset = 6.0, 0.35, 0.05, 1.3
    interval, samples = 0.02, 2000
    columns: list[list[Any]] = [[] for _ in range(3)]

    def field(t: float, y: State) -> list[float]:
        return [y[1], -k * y[0] - half * abs(y[0]) - c * y[1]]

    for run, angle in enumerate([80, -55, 35], 1):
        y = march(field, [angle * DEGREE, 0], interval, samples, 8)
        slow = correlated(random, samples, interval, 0.06, 0.12)
        phi = y[:, 0] / DEGREE + offset + slow + random.normal(size=samples) * 0.05
        append(columns, [[run] * samples, np.arange(samples) * interval, phi])
    return Record(("run", "t", "phi_deg"), ("%d", "%.2f", "%.3f"), columns)


def stage() -> Record:
    """A flexure stage of 60 s; hidden: nothing but a spring that drifts by 1 % and back."""
    random = np.random.default_rng(1010)
    m, k, c = 1.6, 2270.0, 9.0
    interval, samples = 0.01, 6000
    tones = np.arange(0.5, 15, 0.25)
    phases = random.uniform(0, 2 * math.pi, len(tones))
    amplitude = 1.2 * math.sqrt(2 / len(tones))
    half = interval / 4 / 2  # a step of the method looks at its middle, too
    times = np.arange(8 * samples + 16) * half
    force: Array = np.zeros(len(times))
    for f, phase in zip(tones, phases, strict=True):
        force = force + amplitude * np.sin(2 * math.pi * f * times + phase)

    def field(t: float, y: State) -> list[float]:
        spring = k * (1 + 0.01 * math.sin(2 * math.pi * t / 47 + 0.6))
        return [y[1], (force[round(t / half)] - spring * y[0] - c * y[1]) / m]

    y = march(field, [0, 0], interval, samples, 4)
    columns = (
        np.arange(samples) * interval,
        force[::8][:samples] + correlated(random, samples, interval, 0.05, 0.004),
        y[:, 0] * 1e6 + correlated(random, samples, interval, 0.04, 6.0),
    )
    return Record(("Zeit_s", "Kraft_N", "Weg_um"), ("%.2f", "%.4f", "%.2f"), columns, ";", True)
