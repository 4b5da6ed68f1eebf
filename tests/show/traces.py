"""Made-up results of traces, with arrays of an oscillator whose dry friction was not declared."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from tracewire.diagram import read_text
from tracewire.trace import Found, FoundEffect
from tracewire.trace.found import (
    CandidateScore,
    ChannelError,
    Curve,
    Dependence,
    Experiment,
    Force,
    Missing,
    ParameterChange,
    Power,
    SearchStep,
    Tie,
)

Vector = NDArray[np.float64]

TEXT = """\
title: Swing & rest   # as found
span: [0, 10]
parameters:
  k: {value: 4, unit: N m/rad, fit: [0, 10]}
  c: {value: 0.3, unit: N m s/rad, fit: [0, 9]}
blocks:
  theta: {type: integrator, of: omega, start: 1, unit: rad}
  omega: {type: integrator, of: torque, unit: rad/s}
  column: {type: gain, of: theta, k: -k}
  damper: {type: viscous, rate: omega, c: c}
  torque: {type: sum, of: [column, damper]}
"""
ADDED = TEXT.replace("[column, damper]}", "[column, damper, coulomb]}\n"
                     "  coulomb: {type: coulomb, rate: omega, level: {value: 0.25}}")  # fmt: skip
SIGMA = 0.004
STEP = 0.02


def swing(start: float, level: float, c: float = 0.05) -> tuple[Vector, Vector, Vector]:
    """t, theta and omega of theta'' = -4 theta - c omega - level sign(omega), by short steps."""
    t = np.arange(0, 10 + STEP / 2, STEP)
    theta, omega = np.empty_like(t), np.empty_like(t)
    x, v, h = start, 0.0, STEP / 20
    for n in range(len(t)):
        theta[n], omega[n] = x, v
        for _ in range(20):
            v += h * (-4 * x - c * v - level * math.tanh(v / 0.01))
            x += h * v
    return t, theta, omega


def curve(name: str, use: str, start: float, seed: int, near: bool = True) -> Curve:
    """A series of the swing: the true law with noise, too much viscous friction before, and after
    the true one (`near`), or something between the two."""
    t, theta, _ = swing(start, 0.25)
    _, before, _ = swing(start, 0.0, 0.3)
    _, after, _ = swing(start, 0.25 if near else 0.2, 0.051 if near else 0.1)
    noise = SIGMA * np.random.default_rng(seed).standard_normal(len(t))
    phase = np.mod(t, 1.0)
    inside = (theta - before) / SIGMA * phase**2 / 3
    left = noise / SIGMA
    return Curve(
        name, use, "theta", "rad", t, theta + noise, before, after, np.arange(0.0, 10.0),
        inside + left, left if near else 0.2 * inside + left,
    )  # fmt: skip


def force() -> Force:
    """The torque that dry friction needs at the sum, over coordinate and rate."""
    _, theta, omega = swing(1.0, 0.25)
    noise = 0.03 * np.random.default_rng(5).standard_normal(len(theta))
    law = -0.25 * np.tanh(omega / 0.01)
    return Force("torque", theta, omega, law + noise, law, ("theta", "omega"))


def missing_of_q() -> Missing:
    """A ripple in the coordinate."""
    q = np.linspace(-1, 1, 161)
    return Missing("torque", ("q",), 0.97, (q,), 0.2 * np.sin(12 * q), 60 * np.exp(-4 * q**2))


def missing_of_two() -> Missing:
    """A torque over coordinate and rate."""
    q, v = np.linspace(-1, 1, 21), np.linspace(-2, 2, 25)
    torque = np.outer(q, v**2)
    density = 40 * np.exp(-4 * np.add.outer(q**2, v**2 / 4 - 0.3) ** 2)
    return Missing("torque", ("q", "v"), 0.91, (q, v), torque, density)


TIES = (Tie("bias", "torque", 0.991, {"level": -0.21}, 4.2), Tie("sensor_offset", "sensor.theta",
        0.987, {"offset": 0.012}, 11.8))  # fmt: skip
TRIED = (
    CandidateScore("coulomb @ torque", 812.0, 905.3, 0.97, 0.62, 1.01,
           "gate: squared error falls by 99 %, passed"),
    CandidateScore("bias @ torque", 640.0, 640.5, 0.03, 0.21, 90.0, ""),
    CandidateScore("stribeck @ torque", 510.0, 433.0, 0.0, 0.71, 310.0, ""),
    CandidateScore("quad_drag @ torque", 120.0, 88.0, 0.0, 0.97, 900.0, ""),
    CandidateScore("sensor_offset @ sensor.theta", 30.0, masked=0.12),
    CandidateScore("cubic_stiffness @ torque", 12.0, masked=0.9),
)  # fmt: skip


def errors(after: float = 1.02, validated: bool = True) -> tuple[ChannelError, ...]:
    """Errors of three series, in SI, of which one played no part."""
    uses = {"swing_1": "train", "swing_2": "gate", "swing_3": "validate"}
    found = []
    for series, use in uses.items():
        for kind, before in (("windowed", 9.0), ("free run", 46.0)):
            if use != "validate" or validated:
                found.append(
                    ChannelError(series, use, "theta", "rad", kind,  # type: ignore[arg-type]
                                 before * SIGMA, after * SIGMA, SIGMA)
                )  # fmt: skip
    return tuple(found)


FOUND = Found(
    verdict="effect",
    effects=(
        FoundEffect(
            "coulomb", "torque", {"level": 0.25, "width": 0.011}, TIES, "coulomb", "level",
            {"level": (0.243, 0.257), "width": (0.004, 0.018)}, 905.3, 0.62, 0.97,
        ),
    ),
    dropped=(),
    values={"k": 4.0, "c": 0.051, "coulomb.level": 0.25, "coulomb.width": 0.011},
    declared={"k": 4.01, "c": 0.3},
    rmse_before=46 * SIGMA,
    rmse_after=1.02 * SIGMA,
    sigma={"theta": SIGMA},
    s2_before=81.0,
    s2_after=1.01,
    moved=(
        ParameterChange("k", "N m/rad", 4.01, 4.0, 0.01),
        ParameterChange("c", "N m s/rad", 0.3, 0.051, 0.002),
    ),
    errors=errors(),
    steps=(
        SearchStep(0.5, 81.0, 0.0, TRIED, "accepted: coulomb @ torque"),
        SearchStep(1.5, 1.01, 0.4, (), "nothing stands out (p = 0.4)"),
    ),
    power=(),
    dependences=(),
    missing=None,
    experiments=(
        Experiment(
            "coulomb @ torque", "bias @ torque", {"start.theta": 0.2, "start.omega": 0.0}, 6.9,
            "To decide between coulomb @ torque and bias @ torque: release it from rest at theta = "
            "0.2 rad and omega = 0 rad/s. The predictions then differ by 6.9 times the sensor "
            "noise.",
            tuple({"start.theta": float(a), "separation": float(7 * np.exp(-8 * (a - 0.2) ** 2))}
                  for a in np.linspace(0.05, 2, 12)),
        ),
    ),
    confusable=(
        ("coulomb @ torque", "bias @ torque", "sensor_offset @ sensor.theta", "stribeck @ torque"),
        np.array([[1.0, 0.991, 0.987, 0.92], [0.991, 1, 0.999, 0.5], [0.987, 0.999, 1, 0.45],
                  [0.92, 0.5, 0.45, 1]]),
    ),
    curves=(
        curve("swing_1", "train", 1.0, 1), curve("swing_2", "gate", 0.6, 2),
        curve("swing_3", "validate", 1.3, 3),
    ),
    find_forces=lambda: (force(),),
    words=("every third window of the train series is kept back as the gate",),
    original=read_text(TEXT),
    diagram=read_text(ADDED),
    units={"theta": "rad", "omega": "rad/s", "torque": "N m", "coulomb.level": "N m",
           "coulomb.width": "rad/s", "k": "N m/rad", "c": "N m s/rad"},
)  # fmt: skip
"""An effect with two ties."""

NULL = replace(
    FOUND, verdict="null", effects=(), s2_before=1.02, s2_after=1.02, moved=(), find_forces=tuple,
    values={"k": 4.0, "c": 0.05}, declared={"k": 4.0, "c": 0.05},
    steps=(SearchStep(0.5, 1.02, 0.4, (), "nothing stands out (p = 0.4)"),), experiments=(),
    confusable=((), np.zeros((0, 0))), diagram=FOUND.original,
    power=(Power("bias", "torque", "bias.level", 0.0013),
           Power("coulomb", "torque", "coulomb.level", 0.0021),
           Power("sensor_offset", "sensor.theta", "offset.theta", 0.0004)),
)  # fmt: skip
"""Nothing is missing."""

UNEXPLAINED = replace(
    FOUND, verdict="unexplained", effects=(), s2_before=81.0, s2_after=81.0, moved=(),
    find_forces=tuple, values=FOUND.declared,
    steps=(SearchStep(0.5, 81.0, 0.0, TRIED[1:4], "no effect passes"),),
    experiments=(), diagram=FOUND.original, missing=missing_of_q(),
    dependences=(
        Dependence("torque", ("q",), 0.97), Dependence("torque", ("v",), 0.04),
        Dependence("torque", ("q", "v"), 0.74), Dependence("torque", ("t",), -0.02),
        Dependence("torque", ("history",), 0.31), Dependence("torque", ("a",), 0.39),
        Dependence("sensor.theta", ("t",), 0.0), Dependence("sensor.theta", ("y",), 0.62),
    ),
)  # fmt: skip
"""Something is missing that depends on the coordinate."""
