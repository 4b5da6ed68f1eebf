"""Records of plants that are slow: a hot plate and a retention basin."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.rigs.integrate import State, march
from benchmarks.rigs.record import Record, append, correlated, rounded

MINUTE = 60.0
"""In s."""


def plate() -> Record:
    """A hot plate, two records of 10 s a sample; hidden: the cartridge passes its heat on late."""
    random = np.random.default_rng(1717)
    columns: list[list[Any]] = [[] for _ in range(4)]
    first = (0, 110, 40, 130, 0, 80, 120, 20)
    second = (60, 0, 125, 50, 100, 0, 90, 30)
    for run, powers in enumerate([first, second], 1):
        append(columns, plate_run(random, run, powers))
    return Record(
        ("run", "t_min", "P_W", "T_C"), ("%d", "%.4f", "%.0f", "%.2f"), columns, ";", True
    )


def plate_run(random: np.random.Generator, run: int, powers: tuple[int, ...]) -> list[Any]:
    """The columns of one run, 400 s each power in W; the room's air is not quite steady."""
    C, h, late, room = 420.0, 1.1, 34.0, 22.0
    interval, samples = 10.0, 320
    power = np.repeat(np.array(powers), 40)
    air = room + correlated(random, samples + 1, interval, 500.0, 0.4)
    heater = 0.0

    def switch(sample: int, y: State) -> None:
        nonlocal heater
        heater = float(power[sample])

    def field(t: float, y: State) -> list[float]:
        k = min(samples - 1, int(t / interval + 1e-9))
        ambient = air[k] + (air[k + 1] - air[k]) * (t / interval - k)
        return [(y[1] - h * (y[0] - ambient)) / C, (heater - y[1]) / late]

    start = room + powers[0] / h
    y = march(field, [start, powers[0]], interval, samples, 20, switch)
    read = rounded(y[:, 0] + random.normal(size=samples) * 0.03, 0.05)
    return [[run] * samples, np.arange(samples) * interval / MINUTE, power, read]


def basin() -> Record:
    """A retention basin of 25 h; hidden: the water comes 12 minutes later, and an overflow."""
    random = np.random.default_rng(2020)
    area, sluice, k, edge, late = 2.4e4, 4.2, 2.6e-4 * 2.4e4, 1.7, 12
    interval, samples = MINUTE, 1500
    before = 60  # minutes of the record of the inflow that nobody kept
    inflow = np.full(samples + before + 1, 3.0)
    t = np.arange(len(inflow))
    for at, size, rise in [(90, 9, 14), (310, 14, 22), (560, 6, 9), (700, 12, 16), (930, 15, 28),
                           (1180, 8, 10), (1330, 12, 18)]:  # fmt: skip
        since = np.maximum(0, t - before - at) / rise
        inflow += size * since * np.exp(1 - since)

    def field(s: float, y: State) -> list[float]:
        at = s / interval + before - late
        i = int(at)
        coming = inflow[i] + (inflow[i + 1] - inflow[i]) * (at - i)
        over = k * (y[0] - edge) if y[0] > edge else 0.0
        wide = area * (1 + 0.07 * (y[0] - 1) / 2)  # the banks are not quite upright
        return [(coming - sluice * max(y[0], 0) ** 0.5 - over) / wide]

    y = march(field, [(3.0 / sluice) ** 2], interval, samples, 4)
    slow = correlated(random, samples, interval, 15 * MINUTE, 0.004)  # waves and wind
    columns = (
        np.arange(samples) / 60,
        inflow[before:][:samples] * (1 + random.normal(size=samples) * 0.004),
        rounded(y[:, 0] + slow + random.normal(size=samples) * 0.003, 0.005),
    )
    return Record(("t_h", "inflow_m3s", "level_m"), ("%.5f", "%.3f", "%.3f"), columns)
