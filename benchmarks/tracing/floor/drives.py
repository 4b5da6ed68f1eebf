"""Drives of real tests: multisines and levels, beside the sine, and references of controllers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.tracing.integrate import Drive

RISE = 4.0  # samples that a step takes


@dataclass(frozen=True)
class Levels(Drive):
    """Levels that are held, with straight ramps between: `levels` at `times` [s]."""

    times: tuple[float, ...] = ()
    levels: tuple[float, ...] = ()

    def __call__(self, t: float) -> float:
        return float(np.interp(t, self.times, self.levels))


def sine(size: float, speed: float, rng: np.random.Generator) -> Drive:
    """One tone of an amplitude."""
    return Drive((size,), (speed,), (float(rng.uniform(0, 2 * np.pi)),))


def multisine(
    size: float, low: float, high: float, seconds: float, rng: np.random.Generator
) -> Drive:
    """Four to eight tones, harmonics of the record's length, with the rms of a sine of `size`."""
    base = 2 * np.pi / seconds
    lines = np.arange(max(1, np.ceil(low / base)), np.floor(high / base) + 1)
    count = min(len(lines), int(rng.integers(4, 9)))
    chosen = np.sort(rng.choice(lines, count, replace=False)) * base
    weights = rng.uniform(0.5, 1.0, count)
    weights *= size / np.sqrt(np.sum(weights**2))
    phases = rng.uniform(0, 2 * np.pi, count)
    return Drive(tuple(weights.tolist()), tuple(chosen.tolist()), tuple(phases.tolist()))


def steps(
    size: float, period: float, every: float, seconds: float, rng: np.random.Generator
) -> Drive:
    """Random levels up to `size`, each held for 0.4 to 2 periods."""
    times, levels, t = [0.0], [float(rng.uniform(-size, size))], 0.0
    rise = RISE * every
    while t < seconds:
        t = round((t + float(rng.uniform(0.4, 2.0)) * period) / every) * every
        times += [t, t + rise]
        levels += [levels[-1], float(rng.uniform(0.3, 1.0) * rng.choice([-size, size]))]
    return Levels(times=tuple(times), levels=tuple(levels))
