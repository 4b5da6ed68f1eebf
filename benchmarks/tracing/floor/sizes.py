"""The series of a rig, and the sizes of its hidden effects."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmarks.tracing.cases import Spec
from benchmarks.tracing.floor.choosing import Unfit
from benchmarks.tracing.floor.drives import multisine, sine, steps
from benchmarks.tracing.floor.fields import MASSES, MEMORIES, Now, force_of
from benchmarks.tracing.floor.rig import Rig
from benchmarks.tracing.floor.scenario import Scenario
from benchmarks.tracing.floor.windows import Array, Trajectory
from benchmarks.tracing.integrate import Drive
from benchmarks.tracing.laws import Hidden
from benchmarks.tracing.make import SIZES, Series, number
from benchmarks.tracing.plants import Plant


def draw_series(
    scenario: Scenario, plant: Plant, control: tuple[float, float] | None, rng: np.random.Generator
) -> tuple[Series, ...]:
    """The series: train, gate and validate, or one for training and its continuation."""
    scale = float(rng.uniform(0.8, 1.0))
    uses = ["train"] * scenario.trains + ([] if scenario.alone else ["gate"]) + ["validate"]
    sizes = [*SIZES[: scenario.trains], *([] if scenario.alone else [SIZES[3]]), SIZES[4]]
    low, high = plant.speed if plant.drive else (0.0, 0.0)
    speeds = low + (high - low) * (
        rng.permutation(len(uses)) + rng.uniform(0.2, 0.8, len(uses))
    ) / len(uses)
    found = []
    for own, use, speed in zip(sizes, uses, speeds, strict=True):
        size, drive = scale * own, Drive()
        if plant.drive:
            amplitude = plant.size[0] + (plant.size[1] - plant.size[0]) * (size - 0.28) / 0.72
            kind = scenario.drive
            if control:
                amplitude = 0.8 * size * plant.begin[0]
                kind = str(rng.choice(["multisine", "steps", "sine"]))
            if kind == "sine":
                drive = sine(amplitude, float(speed), rng)
            elif kind == "multisine":
                drive = multisine(amplitude, 0.5 * low, 1.2 * high, scenario.seconds, rng)
            else:
                period = 4 * np.pi / (low + high)
                drive = steps(amplitude, period, scenario.every, 2 * scenario.seconds, rng)
        begin = plant.begin[0] * size
        start = (
            float(rng.choice([-1.0, 1.0]) * rng.uniform(0.7, 1.0) * begin),
            float(rng.uniform(-1, 1) * 2.0 * begin),
        )
        if control and rng.random() < 0.5:
            start = (0.0, 0.0)
        found.append(Series(use, drive, start, float(rng.uniform(0, 2 * np.pi))))
    if scenario.continued:
        found[-1] = replace(found[0], use="validate")
    return tuple(found)


def sized(rig: Rig, spec: Spec, declared: Trajectory, rng: np.random.Generator) -> Hidden:
    """The coefficient of an effect, from the motion of the declared system."""
    factor = float(rng.uniform(0.8, 1.4))
    n = slice(0, round(rig.scenario.seconds / rig.scenario.every) * declared.every + 1)
    t, q, v = declared.t[n], declared.q[n], declared.v[n]
    Q, V = float(np.max(np.abs(q))), float(np.sqrt(np.mean(v**2)))
    shapes = {name: number(text, Q, V, 0.0) for name, text in spec.shapes}
    if "n" in shapes and spec.name == "cogging":  # ripples over the largest stroke
        shapes["n"] = shapes["n"] * np.pi / (2 * Q)
    if spec.name in ("harmonic", "parametric"):  # in units of the motion's own frequency
        shapes = {"frequency": shapes["frequency"] * V / Q / (2 * np.pi), "phase": 0.0}
    if spec.name.endswith("_harm"):
        shapes = {"size": 1.0, "psi": shapes.get("psi", 0.0)}
    if spec.name.startswith("sensor"):
        rms = float(np.std(q))
        unit = {"sensor_offset": 1.0, "sensor_quad": rms**2, "sensor_drift": t[-1]}
        size = spec.absolute or spec.share * rms / unit[spec.name]
        return Hidden(spec.name, rig.plant.coordinates[0], factor * size)
    place = spec.place
    if spec.absolute:
        return Hidden(spec.name, place, factor * spec.absolute, shapes)
    width = spec.width * V
    rub = np.asarray(width or 0.003 * float(np.max(np.abs(v))))
    now = Now(t, q, v, np.zeros_like(q), declared.phase[n], rub)
    if spec.name in MEMORIES:
        now = now._replace(z=_remembered(spec.name, now, shapes, declared.half))
    law = force_of(spec.name, now, {k: np.asarray(x) for k, x in shapes.items()})
    usual = float(np.sqrt(np.mean(law**2)))
    if not usual > 0:
        raise Unfit(f"this motion never meets {spec.name}")
    size = spec.share * force_of_rig(rig, declared, n) / usual
    return Hidden(spec.name, 0, factor * size, shapes, width)


def _remembered(name: str, now: Now, shapes: dict[str, float], step: float) -> Array:
    s = {k: np.asarray(x) for k, x in shapes.items()}
    z, found = 0.0, np.empty_like(now.q)
    for k in range(len(found)):
        found[k] = z
        point = Now(*(np.asarray(x if x.ndim == 0 else x[k]) for x in now))
        z += step * float(MEMORIES[name](point._replace(z=np.asarray(z)), s))
    return found


def force_of_rig(rig: Rig, data: Trajectory, n: slice) -> float:
    """The rms of the whole force."""
    mass = rig.values[MASSES[rig.case.system]]
    return mass * float(np.sqrt(np.mean(np.gradient(data.v[n], data.half) ** 2)))
