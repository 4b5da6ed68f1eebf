"""Records of machines and plants: a drive, a motor, a heater, a tank and a coil."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march, march_dry
from benchmarks.rigs.record import TURNS_PER_MINUTE, Record, append, correlated, rounded

# fmt: off
VOLTAGES = (
    0.4, 1.0, 1.6, 2.4, 1.2, 0.7, 0.3, -0.3, -0.8, -1.4, -2.4, -1.0, -0.5, 0.2, 0.9, -0.9, 1.8,
    -1.8, 0, 2.2, -0.6, 1.1, -1.6, 0.8, 0, -2.2, 1.4, -1.2, 2.0, -0.7, 0.6, -2.0, 1.0, 0.1, -1.1,
    1.5, -0.4, 0.75, -1.5, 0.0,
)
# fmt: on
"""Of the motor in V, 1.5 s each."""
KELVIN = 273.15
STEFAN_BOLTZMANN = 5.670374e-8


def drive() -> Record:
    """A motor and a load under a speed controller, twice 6 s; hidden: backlash."""
    random = np.random.default_rng(303)
    columns: list[list[Any]] = [[] for _ in range(6)]
    for run in (1, 2):
        append(columns, drive_run(random, run))
    names = ("run", "t", "n_ref", "torque_Nm", "n_motor", "n_load")
    return Record(names, ("%d", "%.3f", "%.1f", "%.4f", "%.2f", "%.2f"), columns)


def drive_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of one run of the drive: reference and speeds in rpm, the torque in N m."""
    Jm, Jl, k, d, bm, bl, gap = 0.002, 0.004, 60.0, 0.02, 0.004, 0.010, 0.010
    interval, samples = 0.002, 3000
    levels = random.uniform(-200, 200, 14)
    levels[1::2] = -np.sign(levels[::2]) * abs(levels[1::2])
    reference = np.repeat(levels, 220)[:samples]
    torque, integral, log = 0.0, 0.0, []

    def control(sample: int, y: State) -> None:
        nonlocal torque, integral
        measured = y[1] + random.normal() * 0.5 * TURNS_PER_MINUTE
        error = reference[sample] * TURNS_PER_MINUTE - measured
        integral += 1.0 * error * interval
        torque = max(-1.5, min(1.5, 0.08 * error + integral))
        log.append(torque)

    def field(t: float, y: State) -> list[float]:
        twist, wm, wl = y
        bent = twist - gap if twist > gap else twist + gap if twist < -gap else 0.0
        shaft = -k * bent - d * (wm - wl)
        return [wm - wl, (torque + shaft - bm * wm) / Jm, (-shaft - bl * wl) / Jl]

    y = march(field, [0.001, 0, 0], interval, samples, 40, control)
    return [
        [run] * samples,
        np.arange(samples) * interval,
        reference,
        np.array(log) + random.normal(size=samples) * 0.005,
        y[:, 1] / TURNS_PER_MINUTE + random.normal(size=samples) * 0.5,
        y[:, 2] / TURNS_PER_MINUTE + random.normal(size=samples) * 0.5,
    ]


def motor() -> Record:
    """A motor of 60 s; hidden: dry friction other by direction. The tachometer reads 4 % more."""
    random = np.random.default_rng(404)
    J, kt, R, b, up, down = 1.2e-4, 0.045, 2.1, 1e-5, 0.012, 0.008
    interval, samples = 0.01, 6000
    voltage = np.repeat(np.array(VOLTAGES), 150)[:samples]

    def field(t: float, y: State) -> list[float]:
        u = voltage[min(samples - 1, int(t / interval + 1e-6))]
        return [y[1], (kt / R * (u - kt * y[1]) - b * y[1]) / J]

    y = march_dry(field, (up / J, down / J), 1, [0, 0], interval, samples, 10)
    rate = 1.04 * y[:, 1] * (1 + 0.004 * np.cos(7 * y[:, 0]))
    read = rate / TURNS_PER_MINUTE + random.normal(size=samples) * 1.5
    columns = (np.arange(samples) * interval, voltage, read)
    return Record(("t", "u_V", "tacho_rpm"), ("%.2f", "%.2f", "%.1f"), columns)


def heater() -> Record:
    """A heated block on a plate, two records of 1 s a sample; hidden: radiation of the block."""
    random = np.random.default_rng(505)
    columns: list[list[Any]] = [[] for _ in range(6)]
    first = [(0, 120), (900, 45), (1400, 150), (2100, 0), (2600, 90)]
    second = [(0, 60), (500, 140), (1200, 20), (1600, 110)]
    append(columns, heater_run(random, 1, 3000, first, 21.0))
    append(columns, heater_run(random, 2, 2000, second, 34.0))
    names = ("run", "t_s", "heater_W", "ambient_C", "block_C", "plate_C")
    return Record(names, ("%d", "%d", "%.1f", "%.1f", "%.1f", "%.1f"), columns)


def heater_run(
    random: np.random.Generator,
    run: int,
    samples: int,
    switched: list[tuple[int, int]],
    start: float,
) -> list[Any]:
    """The columns of one run: from `start` in degrees C, power in W from a time in s on."""
    C1, C2, h1, h2, g, ea = 150.0, 300.0, 0.22, 0.15, 0.8, STEFAN_BOLTZMANN * 0.010

    def power(t: float) -> float:
        return [p for s, p in switched if t >= s - 1e-9][-1]

    def ambient(t: float) -> float:
        return 21.5 + 0.7 * math.sin(2 * math.pi * t / 2500 + run)

    def field(t: float, y: State) -> list[float]:
        glow = ea * ((y[0] + KELVIN) ** 4 - (ambient(t) + KELVIN) ** 4)
        block = power(t) - h1 * (y[0] - ambient(t)) - g * (y[0] - y[1]) - glow
        return [block / C1, (g * (y[0] - y[1]) - h2 * (y[1] - ambient(t))) / C2]

    y = march(field, [start, start], 1.0, samples, 4)
    t = np.arange(samples) * 1.0
    air = np.array([ambient(s) for s in t])
    return [
        [run] * samples,
        t,
        [power(s) for s in t],
        rounded(air + random.normal(size=samples) * 0.03, 0.1),
        rounded(y[:, 0] + random.normal(size=samples) * 0.06, 0.1),
        rounded(y[:, 1] + random.normal(size=samples) * 0.06, 0.1),
    ]


def tank() -> Record:
    """A tank of 800 s; hidden: an outflow with the root of the level instead of the level."""
    random = np.random.default_rng(606)
    A, a, interval, samples = 0.0080, 3.6e-5, 0.2, 4000
    pumped, begin = np.empty(samples), 0
    while begin < samples:
        length = int(random.uniform(35, 90) / interval)
        pumped[begin : begin + length] = random.uniform(1.6, 8.0)
        begin += length
    for k in range(1, samples):  # the pump follows in 1.5 s
        share = 1 - math.exp(-interval / 1.5)
        pumped[k] = pumped[k - 1] + (pumped[k] - pumped[k - 1]) * share
    liter_per_minute = 1e-3 / 60

    def field(t: float, y: State) -> list[float]:
        k = min(samples - 2, int(t / interval))
        inflow = pumped[k] + (pumped[k + 1] - pumped[k]) * (t / interval - k)
        outflow = a * math.sqrt(2 * 9.81 * max(y[0], 0))
        return [(liter_per_minute * inflow - outflow) / A]

    y = march(field, [0.30], interval, samples, 2)
    pressure = 998 * 9.81 * y[:, 0] / 1e3
    slow = correlated(random, samples, interval, 0.5, 0.012)
    noisy = pressure + slow + random.normal(size=samples) * 0.008
    inflow = pumped + random.normal(size=samples) * 0.03
    columns = (np.arange(samples) * interval, inflow, rounded(noisy, 10 / 4096))
    return Record(("t_s", "inflow_lpm", "pressure_kPa"), ("%.1f", "%.3f", "%.4f"), columns)


def coil() -> Record:
    """Coil, capacitor and resistor in series, 4 s; hidden: the coil saturates."""
    random = np.random.default_rng(909)
    L, R, C, k3 = 0.5, 12.0, 100e-6, 10.0
    interval, samples = 0.001, 4000
    tones = np.arange(0.5, 80, 0.5)  # all repeat after 2 s
    tones = tones[random.uniform(size=len(tones)) < 0.6]
    phases = random.uniform(0, 2 * math.pi, len(tones))
    amplitude = 6.5 * math.sqrt(2 / len(tones))
    half = interval / 2 / 2  # a step of the method looks at its middle, too

    def voltage(t: float) -> float:
        return float(amplitude * np.sin(2 * math.pi * tones * t + phases).sum())

    u = np.array([voltage(k * (interval / 2) / 2) for k in range(4 * samples + 8)])

    def field(t: float, y: State) -> list[float]:
        current = y[0] / L + k3 * y[0] ** 3
        return [u[round(t / half)] - R * current - y[1], current / C]

    y = march(field, [0, 0], interval, samples, 2)
    current = y[:, 0] / L + k3 * y[:, 0] ** 3
    columns = (
        np.arange(samples),
        u[::4][:samples] + random.normal(size=samples) * 0.003,
        current * 1e3 + random.normal(size=samples) * 1.0,
        rounded(y[:, 1] + random.normal(size=samples) * 0.01, 40 / 4096),
    )
    return Record(("t_ms", "u_V", "i_mA", "uC_V"), ("%d", "%.4f", "%.2f", "%.4f"), columns)
