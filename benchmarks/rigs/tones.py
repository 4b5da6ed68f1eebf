"""Records of what is shaken: a bottle, a shaft with a keyway and a beam with a crack."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import Record, append, correlated, rounded
from benchmarks.rigs.waves import sines, tabulated


def bottle() -> Record:
    """A bottle before a loudspeaker, four tones; hidden: the octave of the loudspeaker."""
    random = np.random.default_rng(9696)
    columns: list[list[Any]] = [[] for _ in range(4)]
    tones = ((88.0, 1.2, 0.4), (150.0, 0.8, 2.1), (185.0, 0.5, -1.3), (105.0, 1.0, 1.0))
    for run, (hertz, size, begin) in enumerate(tones, 1):
        append(columns, bottle_run(random, run, hertz, size, begin))
    names = ("run", "t_ms", "u_V", "p_Pa")
    return Record(names, ("%d", "%.1f", "%.4f", "%.3f"), columns)


def bottle_run(
    random: np.random.Generator, run: int, hertz: float, size: float, begin: float
) -> list[Any]:
    """The columns of 0.2 s at 10 kHz, once it has settled; air that is harder when pressed."""
    w2, c, factor, share, phase, harder = (2 * math.pi * 180) ** 2, 63.0, 5.7e5, 0.042, 0.6, 80.0
    interval, samples, settles = 1e-4, 2000, 3000

    def field(t: float, y: State) -> list[float]:
        turn = 2 * math.pi * hertz * (t - settles * interval) + begin
        speaker = size * (math.sin(turn) + share * math.sin(2 * turn + phase))
        return [y[1], factor * speaker - w2 * y[0] - harder * y[0] ** 2 - c * y[1]]

    y = march(field, [0.0, 0.0], interval, samples + settles, 4)[settles:]
    t = np.arange(samples) * interval
    volts = size * np.sin(2 * math.pi * hertz * t + begin) + random.normal(size=samples) * 0.0005
    read = y[:, 0] + correlated(random, samples, interval, 0.002, 0.008)
    read = read + random.normal(size=samples) * 0.012
    return [[run] * samples, t * 1e3, volts, rounded(read, 0.004)]


def keyway() -> Record:
    """An upright shaft that turns, two multisines; hidden: its keyway, and it is not balanced."""
    random = np.random.default_rng(9797)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, size in enumerate((4.2, 3.4), 1):
        append(columns, keyway_run(random, run, size))
    names = ("run", "t_ms", "force_N", "x_um")
    return Record(names, ("%d", "%.1f", "%.3f", "%.1f"), columns)


def keyway_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 1.6 s at 2 kHz from a mark on the shaft; a coupling that is askew."""
    m, k, c, keyway, heavy, askew, hertz = 2.1, 1.9e5, 24.0, 4300.0, 0.36, 0.012, 13.7
    interval, samples, steps = 5e-4, 3200, 4
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 32) * half
    table = sines(random, np.arange(9.0, 78.0, 2.3), size, times)
    force = tabulated(table, half)

    def field(t: float, y: State) -> list[float]:
        turn = 2 * math.pi * hertz * t
        stiff = k + keyway * math.sin(2 * turn + 0.9)
        push = heavy * math.sin(turn - 0.7) + askew * math.sin(2 * turn + 2.0)
        return [y[1], (force(t) + push - stiff * y[0] - c * y[1]) / m]

    y = march(field, [2.5e-5 * (3 - 2 * run), 0.004], interval, samples, steps)
    cell = table[: 2 * steps * samples : 2 * steps] + random.normal(size=samples) * 0.006
    read = y[:, 0] * 1e6 + correlated(random, samples, interval, 0.005, 0.25)
    read = read + random.normal(size=samples) * 0.45
    return [[run] * samples, np.arange(samples) * 0.5, cell, rounded(read, 0.2)]


def crack() -> Record:
    """A beam with a crack, three multisines; hidden: the crack, which opens on one side."""
    random = np.random.default_rng(10101)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run, size in enumerate((0.80, 0.34, 0.56), 1):
        append(columns, crack_run(random, run, size))
    names = ("run", "t_ms", "force_N", "tip_um")
    return Record(names, ("%d", "%d", "%.3f", "%.0f"), columns, ";", True)


def crack_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 2.5 s at 1 kHz; its edges meet softly over 8 um, and the beam hardens."""
    m, k, c, opens, soft, harder = 0.39, 5150.0, 1.1, 120.0, 8e-6, 1.0e6
    interval, samples, steps = 1e-3, 2500, 5
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 32) * half
    table = sines(random, np.arange(5.0, 42.0, 1.3), size, times)
    table = table * np.minimum(1, 0.1 + times / 0.3)
    force = tabulated(table, half)

    def field(t: float, y: State) -> list[float]:
        x, v = y
        away = math.sqrt(x * x + soft * soft)
        return [v, (force(t) - k * x - opens * away - harder * x**3 - c * v) / m]

    y = march(field, [0.0, 0.0], interval, samples, steps)
    cell = table[: 2 * steps * samples : 2 * steps] + random.normal(size=samples) * 0.004
    read = y[:, 0] * 1e6 - 85 + correlated(random, samples, interval, 0.02, 1.2)
    read = read + random.normal(size=samples) * 1.8
    return [[run] * samples, np.arange(samples), cell, rounded(read, 1)]
