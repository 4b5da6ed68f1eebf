"""Records of circuits: an electronic oscillator and a large cell of a battery."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import Record, append, correlated, rounded
from benchmarks.rigs.waves import Times, sines, tabulated


def oscillator() -> Record:
    """An oscillator of amplifiers, noise that grows and a multisine; hidden: it hardens."""
    random = np.random.default_rng(4646)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, oscillator_run(random, run))
    names = ("run", "t_ms", "in_mV", "out_mV")
    return Record(names, ("%d", "%.4f", "%.2f", "%.2f"), columns)


def oscillator_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 4000 samples; a diode bends the scale, the converters have 14 bits."""
    w2, c, harder, fifth = (2 * math.pi * 68.2) ** 2, 43.0, 5.2e5, 1.5e5
    interval, samples, steps = 8.192e-4, 4000, 4
    half = interval / steps / 2
    times = np.arange(2 * steps * samples + 16) * half
    table = drive(random, run, times, samples * interval)
    volts = tabulated(table, half)

    def field(t: float, y: State) -> list[float]:
        x, v = y
        pull = w2 * x + harder * x**3 + fifth * x**5 + c * v
        return [v, w2 * volts(t) - pull]

    y = march(field, [0, 0], interval, samples, steps)
    out = y[:, 0] * 1e3 * (1 + 1.5e-3 * y[:, 0])
    out = (
        out + random.normal(size=samples) * 0.25 + correlated(random, samples, interval, 0.02, 0.05)
    )
    read = table[:: 2 * steps][:samples] * 1e3 + random.normal(size=samples) * 0.1
    t = np.arange(samples) * interval * 1e3
    return [[run] * samples, t, rounded(read, 0.06), rounded(out, 0.06)]


def drive(random: np.random.Generator, run: int, times: Times, last: float) -> Times:
    """In V: tones up to 130 Hz together; in the first run they grow, as an arrow does."""
    table: Times = sines(random, np.arange(3, 130, 1.7), 0.037 if run == 1 else 0.031, times)
    grows = np.minimum(1, 0.25 + times / last) if run == 1 else np.minimum(1, times / 0.05)
    return np.asarray(table * grows)


def cell() -> Record:
    """A cell of 10 Ah under pulses of current, two runs of 25 min; hidden: nothing."""
    random = np.random.default_rng(5656)
    columns: list[list[Any]] = [[] for _ in range(4)]
    for run in (1, 2):
        append(columns, cell_run(random, run))
    names = ("run", "t_min", "I_A", "U_V")
    return Record(names, ("%d", "%.5f", "%.2f", "%.4f"), columns)


def cell_run(random: np.random.Generator, run: int) -> list[Any]:
    """The columns of 1500 s; the voltage at rest bends, and a slow diffusion is left."""
    full, rest, slope, own, film, plates = 3.6e4, 3.52, 0.34, 4.2e-3, 3.1e-3, 1.9e4
    bent, slower, diffusion = 0.003, 1.0e-5, 700.0
    interval, samples = 1.0, 1500
    current = np.zeros(samples)
    begun = 0
    while begun < samples:
        long = int(random.integers(12, 130))
        current[begun : begun + long] = rounded(random.uniform(-16, 16), 0.05)
        begun += long
    current -= 0.35 * current.mean()
    current = rounded(current, 0.01)
    now = 0.0

    def hold(sample: int, y: State) -> None:
        nonlocal now
        now = float(current[sample])

    def field(t: float, y: State) -> list[float]:
        _, shown, deep = y
        return [now / full, (now - shown / film) / plates, (slower * now - deep) / diffusion]

    y = march(field, [0.0, 0.0, 0.0], interval, samples, 3, hold)
    charge = y[:, 0]
    volts = rest + slope * charge + bent * charge**2 + own * current + y[:, 1] + y[:, 2]
    read = (
        volts
        + correlated(random, samples, interval, 40.0, 4e-5)
        + random.normal(size=samples) * 3e-4
    )
    return [[run] * samples, np.arange(samples) / 60, current, rounded(read, 1e-4)]
