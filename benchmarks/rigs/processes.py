"""Records of processes and benches: a dryer, an accumulator of oil and a strut."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import Record, append, correlated, rounded
from benchmarks.rigs.waves import sines, tabulated


def dryer() -> Record:
    """Air that is heated in a tube, two runs of 60 s; hidden: the way from heater to sensor."""
    random = np.random.default_rng(6464)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, dryer_run(random, run))
    return Record(("run", "t_s", "u_V", "T_C"), ("%d", "%.2f", "%.3f", "%.2f"), columns, ";", True)


def dryer_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of one run at 20 Hz; the room warms up and a hotter tube loses more."""
    gain, tau, room, dead, warms, loses = 9.0, 0.85, 23.4, 0.25, 0.0015, 2e-4
    interval, samples, steps, before = 0.05, 1200, 4, 200
    t = np.arange(samples + before) * interval
    voltage = 2.5 + sines(random, np.arange(0.04, 0.95, 0.09), 0.8, t)
    voltage = np.clip(rounded(voltage, 0.005), 0.0, 5.0)
    voltage[:before] = 2.5  # until the record begins
    ahead = round(dead / interval)  # the dead time is whole samples
    u = 0.0

    def hold(sample: int, y: State) -> None:
        nonlocal u
        u = float(voltage[max(0, sample - ahead)])

    def field(t: float, y: State) -> list[float]:
        rise = y[0] - room - warms * max(0.0, t - before * interval)
        return [(gain * u - rise * (1 + loses * rise)) / tau]

    y = march(field, [45.0], interval, before + samples, steps, hold)[before:, 0]
    read = y + correlated(random, samples, interval, 0.5, 0.02)
    read = read + random.normal(size=samples) * 0.06
    return [[run] * samples, t[:samples], voltage[before:], rounded(read, 0.05)]


def accumulator() -> Record:
    """An accumulator of oil between a pump and a throttle, two runs of 40 s; hidden: nothing."""
    random = np.random.default_rng(6565)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, accumulator_run(random, run))
    return Record(("run", "t_ms", "u_V", "p_bar"), ("%d", "%d", "%.3f", "%.2f"), columns)


def accumulator_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of one run at 100 Hz; the gas is stiffer when it is full, the oil warms up."""
    pump, leak, throttle, stiffer, thins = 9.0, 0.09, 3.6, 2e-5, 3e-5
    interval, samples, steps = 0.01, 4000, 4
    t = np.arange(samples) * interval
    voltage = np.repeat(random.uniform(2.0, 4.8, 20), 200)[:samples]
    voltage = voltage + sines(random, np.arange(0.1, 2.4, 0.3), 0.3, t)
    voltage = np.convolve(voltage, np.ones(10) / 10, "same")
    voltage[-6:] = voltage[-7]
    u = tabulated(np.append(voltage, voltage[-1:]), interval)

    def field(t: float, y: State) -> list[float]:
        p = y[0]
        flow = pump * u(t) - leak * (1 + thins * t) * p - throttle * math.sqrt(max(0.0, p))
        return [flow * (1 + stiffer * (p - 25))]

    y = march(field, [25.0], interval, samples, steps)[:, 0]
    shown = voltage + random.normal(size=samples) * 0.004
    read = y + correlated(random, samples, interval, 1.0, 0.005)
    read = read + random.normal(size=samples) * 0.03
    return [[run] * samples, np.arange(samples) * 10, shown, rounded(read, 0.02)]


def strut() -> Record:
    """A strut of a motorcycle on a bench, two runs; hidden: it brakes more on its way out."""
    random = np.random.default_rng(6767)
    columns: list[list[Any]] = [[] for _ in range(5)]
    for run, size in enumerate((9.0, 11.0), 1):
        append(columns, strut_run(random, run, size))
    names = ("run", "t_ms", "x_mm", "v_mm_s", "F_N")
    return Record(names, ("%d", "%d", "%.3f", "%.2f", "%.1f"), columns)


def strut_run(random: np.random.Generator, run: int, size: float) -> list[Any]:
    """The columns of 16 s at 250 Hz; the oil thins and the valves choke a little."""
    k, c, sided, gas, slow, thins, chokes = 8200.0, 1250.0, 430.0, -110.0, 0.002, 2.5e-4, 0.03
    interval, samples, steps = 0.004, 4000, 6
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    way = sines(random, np.arange(0.5, 5.2, 0.27), size * 1e-3, times)
    way = way * (1 - np.exp(-((times / 0.5) ** 2)))
    speed = np.gradient(way, half)
    x, v = tabulated(way, half), tabulated(speed, half)

    def field(t: float, y: State) -> list[float]:
        rate = v(t)
        oil = (c * rate + sided * abs(rate)) * (1 - thins * t) * (1 + chokes * rate * rate)
        return [(gas - k * x(t) - oil - y[0]) / slow]

    y = march(field, [gas], interval, samples, steps)
    at = slice(0, 2 * steps * samples, 2 * steps)
    read = y[:, 0] + correlated(random, samples, interval, 0.5, 0.3)
    return [
        [run] * samples,
        np.arange(samples) * 4,
        way[at] * 1e3 + random.normal(size=samples) * 0.01,
        speed[at] * 1e3 + random.normal(size=samples) * 0.3,
        rounded(read + random.normal(size=samples) * 2.0, 0.5),
    ]
