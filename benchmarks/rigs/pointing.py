"""Records of what points at something: a piezo below a mirror and a telescope."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import DEGREE, Record, append, correlated, rounded
from benchmarks.rigs.waves import sines


def piezo() -> Record:
    """A piezo below a mirror, two runs; hidden: a part of its stretch that stays behind."""
    random = np.random.default_rng(7272)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, piezo_run(random, run))
    return Record(("run", "t_ms", "u_V", "x_um"), ("%d", "%d", "%.2f", "%.3f"), columns)


def piezo_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 8 s at 500 Hz; two smaller parts stay behind too, and it creeps a little."""
    factor, late, zero, creep, slow = 0.118, 0.0045, 2.4, 0.0006, 1.5
    gaps, shares = (7.0, 2.5, 15.0), (0.0100, 0.0007, 0.0005)  # in V, and in um/V
    interval, samples = 0.002, 4000
    t = np.arange(samples) * interval
    volts = 50 + sines(random, np.arange(0.5, 9, 0.7), 15.0, t) * np.minimum(1, t / 0.3)
    volts = rounded(np.clip(volts, 0, 100), 0.01)
    behind = [volts[0] - 0.3 * gap for gap in gaps]
    stretched, now = 0.0, 0.0

    def hold(sample: int, y: State) -> None:
        nonlocal stretched, now
        now = float(volts[sample])
        for i, gap in enumerate(gaps):
            behind[i] = min(now + gap, max(now - gap, behind[i]))
        stretched = sum(share * x for share, x in zip(shares, behind, strict=True))

    def field(t: float, y: State) -> list[float]:
        x, crept = y
        goal = factor * now + stretched + creep * crept + zero
        return [(goal - x) / late, (now - 50 - crept) / slow]

    first = factor * volts[0] + sum(s * b for s, b in zip(shares, behind, strict=True)) + zero
    y = march(field, [first, 0.0], interval, samples, 8, hold)
    read = y[:, 0] + correlated(random, samples, interval, 0.3, 0.008)
    read = read + random.normal(size=samples) * 0.02
    return [[run] * samples, t * 1e3, volts, rounded(read, 0.005)]


def telescope() -> Record:
    """The upright axis of a telescope, two runs; hidden: a warped board and a late drive."""
    random = np.random.default_rng(7979)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, telescope_run(random, run))
    return Record(("run", "t_s", "i_mA", "q_deg"), ("%d", "%.2f", "%.1f", "%.3f"), columns, ";")


def telescope_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 40 s at 100 Hz; two feet of the board are higher, the motor ripples."""
    J, K, c, dry, warped, pitch, phase = 2.3, 1.9, 2.1, 0.95, 0.15, 2 * math.pi / 3, 0.8
    late, second, ripple, teeth = 0.028, 0.0015, 0.002, 22
    interval, samples = 0.01, 4000
    t = np.arange(samples) * interval
    reference = sines(random, np.arange(0.03, 0.3, 0.03), 1.25, t)
    reference = (reference - reference[0]) * np.minimum(1, t / 2)
    before, rate, current = 0.0, 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, current
        angle = round(y[0] / DEGREE / 0.005) * 0.005 * DEGREE
        rate += 0.4 * ((angle - before) / interval - rate)
        before = angle
        after = reference[min(sample + 1, samples - 1)]
        wanted = (after - reference[sample]) / interval
        asked = 9 * (reference[sample] - angle) + 4 * (wanted - rate) + c / K * wanted
        current = round(max(-9.0, min(9.0, asked)) / 5e-3) * 5e-3
        log.append(current)

    def field(t: float, y: State) -> list[float]:
        q, w, flows = y
        return [w, (K * flows - c * w + ripple * math.sin(teeth * q)) / J, (current - flows) / late]

    def levels(t: float, y: State) -> tuple[float, float]:
        turn = 2 * math.pi * y[0] / pitch + phase
        level = (dry + warped * (1 + math.cos(turn)) / 2 + second * math.cos(2 * turn / 3)) / J
        return level, level

    y = march_dry(field, levels, 1, [0, 0, 0], interval, samples, 6, control)
    read = y[:, 0] / DEGREE + correlated(random, samples, interval, 0.2, 0.015)
    read = read + random.normal(size=samples) * 0.015
    return [[run] * samples, t, np.array(log) * 1e3, rounded(read, 0.044)]
