"""A case with numbers, and its true motion."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from benchmarks.tracing.cases import Case
from benchmarks.tracing.floor.fields import DRY, LEVELS
from benchmarks.tracing.floor.scenario import Scenario
from benchmarks.tracing.floor.unmodelled import Floor
from benchmarks.tracing.floor.windows import Array, System, Trajectory, half_step
from benchmarks.tracing.integrate import Motion
from benchmarks.tracing.laws import Hidden
from benchmarks.tracing.make import LEAD, Series
from benchmarks.tracing.plants import Plant, Values

ROUGH = 1e-7
"""Relative tolerance of the runs that size a floor."""


@dataclass(frozen=True, eq=False)
class Rig:
    """A case with numbers. `series` ends with the one for validation; `control` is (kp, kd)."""

    case: Case
    scenario: Scenario
    plant: Plant
    values: Values
    hidden: tuple[Hidden, ...]
    floor: Floor
    series: tuple[Series, ...]
    control: tuple[float, float] | None
    system: System

    @property
    def trains(self) -> tuple[Series, ...]:
        """The series for training."""
        return tuple(s for s in self.series if s.use == "train")


def motion(rig: Rig, series: Series, factor: float = 1.0) -> Motion:
    """The rig in one of its series, its floor times a factor."""
    hidden = []
    for h in rig.hidden:
        shapes = dict(h.shapes)
        if h.name in ("harmonic", "parametric"):
            shapes["phase"] = series.phase
        if h.name.endswith("_harm"):
            shapes["size"] = series.drive.amplitude[0]
        hidden.append(replace(h, shapes=shapes))
    number = 0 if rig.scenario.continued else rig.series.index(series)
    floor = rig.floor.scaled(factor).during(number) if rig.floor.size else None
    return Motion(rig.plant, rig.values, hidden, series.drive, floor=floor, control=rig.control)


def _sticks(rig: Rig) -> bool:
    return rig.case.system in DRY or any(x.name in LEVELS and not x.width for x in rig.case.hidden)


def states(
    rig: Rig, series: Series, times: Array, factor: float = 1.0, rtol: float = ROUGH
) -> tuple[Array, Array]:
    """True states at `times` (N, n), and what a perfect sensor of the coordinate shows (N,)."""
    moving = motion(rig, series, factor)
    delay = next((h.coefficient for h in rig.hidden if h.name == "sensor_delay"), 0.0)
    late = np.unique(np.concatenate([times, times - delay]))
    rows = moving.run(series.start, late, -LEAD if delay else 0.0, rtol)
    y = rows[np.searchsorted(late, times - delay), 0]
    shown = y.copy()
    for h in rig.hidden:
        added = {
            "sensor_offset": np.ones_like(y), "sensor_gain": y, "sensor_quad": y**2,
            "sensor_drift": times,
        }  # fmt: skip
        if h.name in added:
            shown = shown + h.coefficient * added[h.name]
    return rows[np.searchsorted(late, times)], shown


def recorded_drive(rig: Rig, series: Series, times: Array, rows: Array) -> Array:
    """The drive as it is recorded: the reference, what the controller puts out, or the drive."""
    u = np.array([series.drive(float(t)) for t in times])
    if rig.control and rig.scenario.drive == "output":
        kp, kd = rig.control
        u = kp * (u - rows[:, 0]) - kd * rows[:, 1]
    return u


def trajectory(rig: Rig, factor: float) -> Trajectory:
    """The clean train series on a grid of half steps."""
    half, every = half_step(rig.scenario.every, _sticks(rig))
    samples = round(rig.scenario.seconds / rig.scenario.every)
    times = np.arange(samples * every + 1, dtype=np.float64) * half
    parts: dict[str, list[Array]] = {
        k: [] for k in ("q", "v", "u", "z", "shown", "phase", "own", "tone")
    }
    memories = sum(1 for h in rig.hidden if h.effect.memory or h.name == "drive_lag")
    for series in rig.trains:
        rows, shown = states(rig, series, times, factor)
        single = len(series.drive.omega) == 1
        phase = series.drive.omega[0] * times + series.drive.phase[0] if single else 0 * times
        one = np.ones_like(times)
        for key, value in {
            "q": rows[:, 0], "v": rows[:, 1], "z": rows[:, 2 : 2 + memories], "shown": shown,
            "u": recorded_drive(rig, series, times, rows), "phase": phase,
            "own": series.phase * one, "tone": series.drive.amplitude[0] * one if single else phase,
        }.items():  # fmt: skip
            parts[key].append(value)
    count = len(rig.trains)
    return Trajectory(
        np.tile(times, count),
        half=half,
        every=every,
        first=tuple(k * len(times) for k in range(count)),
        counts=(samples + 1,) * count,
        **{key: np.concatenate(value) for key, value in parts.items()},
    )
