"""Runs of windows with free starts, all at once: numpy alone, fixed steps."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.tracing.floor.fields import DRY, FORCES, LEVELS, MASSES, MEMORIES, Now, force_of
from benchmarks.tracing.laws import Hidden

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
LONGEST_STEP = 0.005  # s


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Clean series end to end on a grid of half steps: q, v, u (what is recorded), memories.

    `every` half steps make a sample; `first` are where series begin, `counts` their samples.
    """

    t: Array
    q: Array
    v: Array
    u: Array
    z: Array  # (N, memories)
    shown: Array  # what the sensor of q shows
    phase: Array  # of the drive
    own: Array  # phase of a disturbance, which each series has for itself
    tone: Array  # its amplitude, where it is a sine
    half: float  # s
    every: int
    first: tuple[int, ...]
    counts: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class System:
    """A declared plant, with a controller (kp, kd) where the drive is a reference."""

    name: str
    values: Mapping[str, float]
    free: Sequence[str]
    control: tuple[float, float] = (0.0, 0.0)


def half_step(every: float, sticks: bool) -> tuple[float, int]:
    """The half step [s] of a sampling interval, and how many make a sample."""
    count = 2 * int(np.ceil(every / (LONGEST_STEP / 2 if sticks else LONGEST_STEP) - 1e-9))
    return every / count, count


def cut(data: Trajectory, horizon: float) -> tuple[Indices, int]:
    """Where windows of a horizon [s] begin on the grid, and their samples."""
    samples = max(8, round(horizon / (data.half * data.every)))
    samples = min(samples, *(count - 1 for count in data.counts))
    begins = [
        first + k * data.every
        for first, count in zip(data.first, data.counts, strict=True)
        for k in range(0, count - samples, samples)
    ]
    return np.array(begins), samples


def run(
    system: System,
    terms: Sequence[Hidden],
    data: Trajectory,
    lanes: Indices,
    samples: int,
    values: Mapping[str, Array],
    starts: Array,
    push: tuple[Array, Indices] | None = None,
    path: list[Array] | None = None,
) -> Array:
    """What the sensor shows (lanes, samples) of windows that begin at `lanes` from `starts` (q, v).

    `values` are parameters by lane, of terms as `0.c` and `0.s`. `push` has forces on the data's
    grid (N, forces), and which of them acts in each lane. `path` is filled with the states (q, v)
    at every step.
    """
    force = FORCES[system.name]
    mass = values[MASSES[system.name]]
    h = 2 * data.half
    kp, kd = system.control
    own = [
        {key: values[f"{number}.{key}"] for key in ("c", *term.shapes)}
        for number, term in enumerate(terms)
    ]
    memory = {
        number: k
        for k, number in enumerate(
            n for n, h in enumerate(terms) if h.effect.memory or h.name == "drive_lag"
        )
    }
    added = sum(s["c"] for h, s in zip(terms, own, strict=True) if h.effect.kind == "mass")
    sticks = system.name in DRY or any(x.name in LEVELS and not x.width for x in terms)
    phases, tones = data.own[lanes], data.tone[lanes]

    def rates(k: Indices, x: Array) -> Array:
        q, v, t = x[0], x[1], data.t[k]
        u = data.u[k]
        if kp:
            u = kp * (u - q) - kd * v
        measured, out = u, np.empty_like(x)
        extra: Array | float = 0.0 if push is None else push[0][k, push[1]]
        level: Array | float = values["level"] if system.name in DRY else 0.0
        for number, (term, s) in enumerate(zip(terms, own, strict=True)):
            if term.effect.kind in ("sensor", "mass"):
                continue
            z = x[2 + memory[number]] if number in memory else q
            if term.name == "drive_lag":
                out[2 + memory[number]] = (measured - z) / s["c"]
                u = u + z - measured
                continue
            if term.name == "drive_gain":
                u = u + s["c"] * measured
                continue
            if term.name in ("harmonic", "parametric"):
                s = {**s, "phase": phases}
            if "size" in s:
                s = {**s, "size": tones}
            now = Now(t, q, v, z, data.phase[k], np.asarray(term.width))
            if number in memory:
                out[2 + memory[number]] = MEMORIES[term.name](now, s)
            if term.name in LEVELS and not term.width:
                level = level + s["c"] * LEVELS[term.name](now, s)
            else:
                extra = extra + s["c"] * force_of(term.name, now, s)
        total = force(values, q, v, u) + extra
        if sticks:  # what would stop the body within a step, and at most the level
            total = total - np.clip(total + (mass + added) * v / h, -level, level)
        out[0] = v
        out[1] = total / (mass + added)
        return out

    x = np.empty((2 + len(memory), len(lanes)))
    x[:2] = starts
    x[2:] = data.z[lanes].T[: len(memory)]
    shown = np.empty((samples, len(lanes)))
    k = lanes.copy()
    for row in range(samples):
        shown[row] = _seen(terms, own, data, k, x, rates)
        for _ in range(data.every // 2 if row < samples - 1 else 0):
            if path is not None:
                path.append(x[:2].copy())
            a = rates(k, x)
            b = rates(k + 1, x + h / 2 * a)
            c = rates(k + 1, x + h / 2 * b)
            d = rates(k + 2, x + h * c)
            x = x + h / 6 * (a + 2 * b + 2 * c + d)
            k = k + 2
    if path is not None:
        path.append(x[:2].copy())
    return shown.T


def _seen(
    terms: Sequence[Hidden],
    own: Sequence[Mapping[str, Array]],
    data: Trajectory,
    k: Indices,
    x: Array,
    rates: Callable[[Indices, Array], Array],
) -> Array:
    y: Array = x[0]
    for h, s in zip(terms, own, strict=True):
        if h.name == "sensor_delay":
            a = rates(k, x)[1]
            y = y - s["c"] * x[1] + s["c"] ** 2 / 2 * a
        elif h.name == "sensor_offset":
            y = y + s["c"]
        elif h.name == "sensor_gain":
            y = y + s["c"] * x[0]
        elif h.name == "sensor_quad":
            y = y + s["c"] * x[0] ** 2
        elif h.name == "sensor_drift":
            y = y + s["c"] * data.t[k]
    return y
