"""Records of guided motion: a gear, a pin on a disc, a motor, a scooter and a wheel."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import DEGREE, TURNS_PER_MINUTE, Record, append, correlated, rounded
from benchmarks.rigs.waves import sines, tabulated


def gearbox() -> Record:
    """A gear between a servo and a disc, two trajectories; hidden: its play."""
    random = np.random.default_rng(6060)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run, size in enumerate((19.0, 23.0), 1):
        append(columns, gearbox_run(random, run, size))
    names = ("run", "t_ms", "servo_deg", "servo_deg_s", "disc_deg")
    return Record(names, ("%d", "%d", "%.4f", "%.3f", "%.3f"), columns)


def gearbox_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 8 s at 500 Hz; the servo goes as it is told, its teeth are not quite even."""
    J, k, d, b, gap, harder, uneven, teeth = 0.020, 60.0, 0.35, 0.35, 0.008, 1.2, 1.2e-5, 24
    interval, samples, steps = 0.002, 4000, 4
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    way = sines(random, np.arange(0.3, 3.4, 0.22), size * DEGREE, times)
    way = way * (1 - np.exp(-((times / 0.4) ** 2)))
    speed = np.gradient(way, half)
    a, wa = tabulated(way, half), tabulated(speed, half)

    def field(t: float, y: State) -> list[float]:
        twist = y[0] - a(t) - uneven * math.sin(teeth * a(t))
        beyond = max(0.0, twist - gap) - max(0.0, -twist - gap)
        spring = k * beyond * (1 + harder * beyond * beyond)
        return [y[1], (-spring - d * (y[1] - wa(t)) - b * y[1]) / J]

    y = march(field, [0, 0], interval, samples, steps)
    at = slice(0, 2 * steps * samples, 2 * steps)
    read = y[:, 0] / DEGREE + random.normal(size=samples) * 0.008
    return [
        [run] * samples,
        np.arange(samples) * 2,
        way[at] / DEGREE,
        speed[at] / DEGREE,
        rounded(read, 0.005),
    ]


def pin() -> Record:
    """A pin on an oiled disc that turns one way, two runs; hidden: it rubs more at low speeds."""
    random = np.random.default_rng(6161)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run, middle in enumerate((4.0, 5.0), 1):
        append(columns, pin_run(random, run, middle))
    names = ("run", "t_ms", "x_mm", "v_mm_s", "F_N")
    return Record(names, ("%d", "%d", "%.4f", "%.4f", "%.2f"), columns)


def pin_run(random: np.random.Generator, run: int, middle: float) -> list[Any]:
    """The columns of 12 s at 500 Hz; the disc is worn a little, the load cell drifts."""
    c, dry, more, speed, slow, worn, wave = 160.0, 12.0, 6.0, 0.004, 0.004, 0.004, 0.007
    interval, samples, steps = 0.002, 6000, 4
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    speeds = middle * 1e-3 * np.exp(sines(random, np.arange(0.12, 1.2, 0.15), 0.95, times))
    way = np.cumsum(speeds) * half
    x, v = tabulated(way, half), tabulated(speeds, half)

    def rubs(t: float) -> float:
        rate = v(t)
        level = dry + more * math.exp(-((rate / speed) ** 2))
        return c * rate + level * (1 + worn * math.sin(2 * math.pi * x(t) / wave))

    def field(t: float, y: State) -> list[float]:
        return [(-rubs(t) - y[0]) / slow]

    y = march(field, [-rubs(0.0)], interval, samples, steps)
    at = slice(0, 2 * steps * samples, 2 * steps)
    read = y[:, 0] + correlated(random, samples, interval, 0.8, 0.03)
    return [
        [run] * samples,
        np.arange(samples) * 2,
        way[at] * 1e3,
        speeds[at] * 1e3,
        rounded(read + random.normal(size=samples) * 0.15, 0.02),
    ]


def magnets() -> Record:
    """A motor on a torsion bar, two runs; hidden: its magnets and its bearing."""
    random = np.random.default_rng(6262)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, magnets_run(random, run))
    names = ("run", "t_ms", "torque_mNm", "angle_deg")
    return Record(names, ("%d", "%d", "%.2f", "%.3f"), columns, ";")


def magnets_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 8 s at 500 Hz; the second wave of its magnets, an amplifier that bends."""
    J, c, k, dry, teeth, pitch, phase = 6e-4, 1.1e-3, 0.055, 0.010, 0.006, 2 * math.pi / 30, 0.4
    second, bent = 0.006, 0.02
    interval, samples = 0.002, 4000
    t = np.arange(samples) * interval
    reference = sines(random, np.arange(0.4, 2.6, 0.24), 1.1, t)
    reference = (reference - reference[0]) * np.minimum(1, t / 0.5)
    before, rate, torque = 0.0, 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal before, rate, torque
        angle = round(y[0] / DEGREE / 0.045) * 0.045 * DEGREE
        rate += 0.4 * ((angle - before) / interval - rate)
        before = angle
        after = reference[min(sample + 1, samples - 1)]
        wanted = (after - reference[sample]) / interval
        asked = 0.9 * (reference[sample] - angle) + 0.03 * (wanted - rate) + k * angle
        torque = round(max(-0.3, min(0.3, asked)) / 1e-4) * 1e-4
        log.append(torque)

    def field(t: float, y: State) -> list[float]:
        at = 2 * math.pi * y[0] / pitch
        pull = teeth * (math.sin(at + phase) + second * math.sin(2 * at))
        given = torque * (1 - bent * torque * torque)
        return [y[1], (given + pull - k * y[0] - c * y[1]) / J]

    y = march_dry(field, (dry / J, dry / J), 1, [0, 0], interval, samples, 8, control)
    read = y[:, 0] / DEGREE + correlated(random, samples, interval, 0.05, 0.01)
    read = read + random.normal(size=samples) * 0.02
    return [[run] * samples, np.arange(samples) * 2, np.array(log) * 1e3, rounded(read, 0.045)]


def scooter() -> Record:
    """An electric scooter on a flat road, 240 s; hidden: its motor turns with it."""
    random = np.random.default_rng(6363)
    m, more, rolls, drag, hills, wave, gusts = 98.0, 11.0, 14.0, 0.31, 0.25, 130.0, 0.03
    interval, samples, steps, window = 0.05, 4800, 4, 3
    t = np.arange(samples + window) * interval
    levels = random.uniform(-4, 68, 42)
    wanted = np.repeat(levels, 120)[: samples + window]
    force = wanted + sines(random, np.arange(0.08, 0.9, 0.11), 9.0, t)
    wind = correlated(random, samples + window, interval, 6.0, gusts)
    push, blows = 0.0, 0.0

    def hold(sample: int, y: State) -> None:
        nonlocal push, blows
        push, blows = float(force[sample]), float(wind[sample])

    def field(t: float, y: State) -> list[float]:
        air = drag * (y[1] + blows) * abs(y[1] + blows)
        hill = hills * math.sin(2 * math.pi * y[0] / wave)
        return [y[1], (push - rolls - air - hill) / (m + more)]

    y = march(field, [0, 7.0], interval, samples + window, steps, hold)
    speed = y[:, 1] + random.normal(size=len(y)) * 0.03
    smooth = np.convolve(speed, np.ones(window) / window, "same")[1 : samples + 1]
    shown = force[1 : samples + 1] + random.normal(size=samples) * 0.4
    columns = (np.arange(samples) * interval, shown, rounded(smooth * 3.6, 0.02))
    return Record(("t_s", "F_N", "v_km_h"), ("%.2f", "%.1f", "%.2f"), columns)


def wheel() -> Record:
    """A reaction wheel under a speed controller, two runs of 80 s; hidden: nothing."""
    random = np.random.default_rng(6868)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, wheel_run(random, run))
    return Record(("run", "t_s", "i_mA", "n_rpm"), ("%d", "%.2f", "%.1f", "%.1f"), columns)


def wheel_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of one run at 50 Hz; the grease thins a little, air brakes it by a trace."""
    J, K, c, dry, thins, air = 1.2e-3, 0.024, 1.1e-5, 2.4e-3, 4e-5, 4e-10
    interval, samples = 0.02, 4000
    t = np.arange(samples) * interval
    reference = np.interp(t, np.arange(0, 81, 4), random.uniform(-900, 900, 21))
    reference = reference + 60 * np.sin(2 * math.pi * 0.7 * t)
    current, integral = 0.0, 0.0
    log: list[float] = []

    def control(sample: int, y: State) -> None:
        nonlocal current, integral
        error = (reference[sample] - y[0] / TURNS_PER_MINUTE + random.normal() * 2) * 1e-3
        integral = max(-0.5, min(0.5, integral + 0.4 * error * interval))
        current = round(max(-1.5, min(1.5, 4 * error + integral)) / 0.001) * 0.001
        log.append(current)

    def field(t: float, y: State) -> list[float]:
        w = y[0]
        return [(K * current - c * (1 - thins * t) * w - air * w * abs(w)) / J]

    y = march_dry(field, (dry / J, dry / J), 0, [0], interval, samples, 4, control)
    read = y[:, 0] / TURNS_PER_MINUTE + correlated(random, samples, interval, 0.2, 0.3)
    read = read + random.normal(size=samples) * 2.0
    return [[run] * samples, t, np.array(log) * 1e3, rounded(read, 0.5)]
