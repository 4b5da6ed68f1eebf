"""Records of benches: a resonator, a beam with a stop, an eddy-current brake and a filter."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import DEGREE, Record, append, correlated, rounded


def resonator() -> Record:
    """A resonator of 25 kHz, bursts of 1 ms at six frequencies; hidden: a cubic spring."""
    random = np.random.default_rng(1212)
    columns: list[list[Any]] = [[] for _ in range(4)]
    first = (24.6, 25.2, 24.9, 25.6, 24.2, 25.35)
    second = (25.4, 24.4, 25.1, 24.75, 25.5, 25.0)
    for run, kilohertz in enumerate([first, second], 1):
        append(columns, resonator_run(random, run, kilohertz))
    return Record(("run", "t_us", "u_mV", "x_nm"), ("%d", "%d", "%.3f", "%.2f"), columns)


def resonator_run(random: np.random.Generator, run: int, kilohertz: tuple[float, ...]) -> list[Any]:
    """The columns of one run; the generator holds its voltage for 2 us, the spring warms up."""
    m, k, c, k3, factor = 2.0e-9, 49.35, 3.9e-6, 4.0e11, 1.5e-5
    warm, slowly = 1.6e9, 2.5e-3  # softer by 1/m^2 of the mean square, and how late
    interval, samples = 2e-6, 3000
    frequency = np.repeat(np.array(kilohertz) * 1e3, samples // len(kilohertz))
    voltage = 0.1 * np.sin(2 * math.pi * np.cumsum(frequency) * interval)
    u = 0.0

    def hold(sample: int, y: State) -> None:
        nonlocal u
        u = float(voltage[sample])

    def field(t: float, y: State) -> list[float]:
        spring = k * (1 - warm * y[2]) * y[0] + k3 * y[0] ** 3
        return [y[1], (factor * u - spring - c * y[1]) / m, (y[0] ** 2 - y[2]) / slowly]

    y = march(field, [0, 0, 0], interval, samples, 8, hold)
    slow = correlated(random, samples, interval, 40e-6, 2.0)
    return [
        [run] * samples,
        np.arange(samples) * 2,
        voltage * 1e3,
        y[:, 0] * 1e9 + slow + random.normal(size=samples) * 5.0,
    ]


def beam() -> Record:
    """A beam under a sine in three sizes, twice 3 s; hidden: a stop on one side."""
    random = np.random.default_rng(1616)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, (hertz, sizes) in enumerate([(16.0, (1.5, 3.2, 4.2)), (13.0, (3.0, 4.4, 2.2))], 1):
        append(columns, beam_run(random, run, hertz, sizes))
    return Record(("run", "t", "F_N", "x_mm"), ("%d", "%.4f", "%.3f", "%.4f"), columns)


def beam_run(
    random: np.random.Generator, run: int, hertz: float, sizes: tuple[float, ...]
) -> list[Any]:
    """The columns of one run; the tip of the beam draws in as it bends."""
    m, k, c, wall, gap, draw = 0.35, 5500.0, 1.6, 9000.0, 0.6e-3, 6000.0
    interval, samples = 0.001, 3000
    ends = samples * interval / len(sizes)

    def force(t: float) -> float:
        n = min(len(sizes) - 1, int(t / ends))
        last = sizes[n - 1] if n else 0.0
        share = min(1.0, (t - n * ends) / 0.1)  # a new size comes in 0.1 s
        size = last + (sizes[n] - last) * share * share * (3 - 2 * share)
        return size * math.sin(2 * math.pi * hertz * t)

    def field(t: float, y: State) -> list[float]:
        x, v = y
        stop = wall * (x - gap) if x > gap else 0.0
        pull = force(t) - k * x - c * v - stop - m * draw * x * v * v
        return [v, pull / (m * (1 + draw * x * x))]

    y = march(field, [0, 0], interval, samples, 16)
    t = np.arange(samples) * interval
    return [
        [run] * samples,
        t,
        np.array([force(s) for s in t]) + random.normal(size=samples) * 0.01,
        y[:, 0] * 1e3 + random.normal(size=samples) * 0.004,
    ]


def brake() -> Record:
    """A torsion pendulum with an eddy-current brake, 90 s to its rest; hidden: nothing."""
    random = np.random.default_rng(1818)
    w2, c, fast = 4.1, 0.17, 60.0
    interval, samples = 0.05, 1800

    def field(t: float, y: State) -> list[float]:
        return [y[1], -w2 * y[0] - c * y[1] / (1 + (y[1] / fast) ** 2)]

    y = march(field, [105 * DEGREE, 0], interval, samples, 10)
    slow = correlated(random, samples, interval, 0.3, 0.05)
    angle = rounded(y[:, 0] / DEGREE + slow + random.normal(size=samples) * 0.08, 0.1)
    return Record(("t_s", "phi_deg"), ("%.2f", "%.1f"), (np.arange(samples) * interval, angle))


def ladder() -> Record:
    """A filter of 107 kHz on an oscilloscope of 8 bits, a multisine; hidden: nothing."""
    random = np.random.default_rng(1919)
    L, R, C, skin_L, skin_R = 220e-6, 18.0, 10e-9, 0.4e-6, 1.2
    interval, samples, steps = 0.2e-6, 2500, 2
    tones = np.arange(10e3, 260e3, 10e3)  # all repeat after 100 us
    phases = random.uniform(0, 2 * math.pi, len(tones))
    amplitude = 1.0 * math.sqrt(2 / len(tones))
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    voltage = amplitude * np.sin(2 * math.pi * np.outer(times, tones) + phases).sum(axis=1)

    def field(t: float, y: State) -> list[float]:
        i, u, inner = y  # the current of the skin effect's resistor is i - inner
        skin = skin_R * (i - inner)
        return [(voltage[round(t / half)] - R * i - u - skin) / L, i / C, skin / skin_L]

    y = march(field, [0, 0, 0], interval, samples, steps)
    u = voltage[:: 2 * steps][:samples]
    columns = (
        np.arange(samples) * 0.2,
        rounded(u + random.normal(size=samples) * 0.01, 8 / 256),
        rounded(y[:, 1] + random.normal(size=samples) * 0.02, 16 / 256),
    )
    return Record(("t_us", "u_in_V", "u_C_V"), ("%.1f", "%.5f", "%.4f"), columns)
