"""The systems as hand-written equations: forces at every place, and how they turn to rates.

The accelerations are a = gain @ forces, with one force for each place in the order of `places`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Values = dict[str, float]
Numbers = list[float]
Forces = Callable[[Values, Numbers, Numbers, float], Numbers]


@dataclass(frozen=True)
class Plant:
    """A system. `known` and `true` are its parameters, `scatter` what a seed may change by 10 %.

    `coordinates`, `rates` and `places` are names of the diagram `systems/NAME.yaml`; `drive` is its
    input, or empty; `size` and `speed` are the ranges of the drive's amplitude and of its angular
    frequency, `begin` the largest start of each coordinate, `ratio` a typical signal over noise.
    """

    name: str
    coordinates: tuple[str, ...]
    rates: tuple[str, ...]
    places: tuple[str, ...]
    true: Values
    scatter: tuple[str, ...]
    forces: Forces
    gain: Callable[[Values], NDArray[np.float64]]
    levels: Callable[[Values], Numbers]
    begin: tuple[float, ...]
    drive: str = ""
    size: tuple[float, float] = (0.0, 0.0)
    speed: tuple[float, float] = (0.0, 0.0)
    stiff: bool = False


def _torsion(p: Values, q: Numbers, v: Numbers, u: float) -> Numbers:
    return [-p["k"] * q[0] - p["c"] * v[0]]


def _driven(p: Values, q: Numbers, v: Numbers, u: float) -> Numbers:
    return [u - p["k"] * q[0] - p["c"] * v[0]]


def _pendulum(p: Values, q: Numbers, v: Numbers, u: float) -> Numbers:
    return [u - p["weight"] * math.sin(q[0]) - p["c"] * v[0]]


def _voigt(q: float, v: float, limit: float, k: float, c: float) -> float:
    if q >= limit:
        return -k * (q - limit) - c * v
    if q <= -limit:
        return -k * (q + limit) - c * v
    return 0.0


def _stop(p: Values, q: Numbers, v: Numbers, u: float) -> Numbers:
    stop = _voigt(q[0], v[0], p["limit"], p["k_stop"], p["c_stop"])
    return [u - p["weight"] * math.sin(q[0]) - p["c"] * v[0] + stop]


def _smooth(p: Values, q: Numbers, v: Numbers, u: float) -> Numbers:
    return [u - p["k"] * q[0] - p["c"] * v[0] - p["level"] * math.tanh(v[0] / p["width"])]


def _duffing(p: Values, q: Numbers, v: Numbers, u: float) -> Numbers:
    return [u - p["k"] * q[0] - p["k3"] * q[0] ** 3 - p["c"] * v[0]]


def _chain(p: Values, q: Numbers, v: Numbers, u: float) -> Numbers:
    link = p["k2"] * (q[0] - q[1]) + p["c2"] * (v[0] - v[1])
    return [u - p["k1"] * q[0] - p["c1"] * v[0] - link, link]


def _double(p: Values, q: Numbers, v: Numbers, u: float) -> Numbers:
    """Torques on the column but for the reaction of the disk, and on the disk."""
    twist = u - q[0]
    pin = _voigt(q[0], v[0], p["phi1_s"], p["k1"], p["c1"])
    column = p["kappa1"] * twist + p["kappa2"] * twist**3 - p["T_v1"] * v[0] + pin
    z = p["alpha"] * v[1]
    decay = math.exp(-abs(z))
    sech = 2 * decay / (1 + decay * decay)
    plate = p["T_s2"] / (1 + p["T_02"] * abs(v[1])) * (1 + p["beta"] * sech) * math.tanh(z)
    return [column, -plate + _voigt(q[1], v[1], p["phi2_s"], p["k2"], p["c2"])]


def _one(name: str) -> Callable[[Values], NDArray[np.float64]]:
    return lambda p: np.array([[1 / p[name]]])


def _none(p: Values) -> Numbers:
    return [0.0]


def _level(p: Values) -> Numbers:
    return [p["level"]]


TORSION = {"J": 4e-4, "k": 0.0144, "c": 1.4e-4}
CART = {"m": 0.5, "k": 20.0, "c": 0.25, "level": 0.2}
PENDULUM = {"inertia": 0.01, "weight": 0.35, "c": 4e-3}
PLANTS = {
    plant.name: plant
    for plant in (
        Plant(
            "torsion",
            ("theta",),
            ("omega",),
            ("torque",),
            TORSION,
            ("k", "c"),
            _torsion,
            _one("J"),
            _none,
            (1.0,),
        ),
        Plant(
            "torsion_dry",
            ("theta",),
            ("omega",),
            ("torque",),
            TORSION | {"level": 3e-4},
            ("k", "c", "level"),
            _torsion,
            _one("J"),
            _level,
            (1.2,),
        ),
        Plant(
            "driven",
            ("theta",),
            ("omega",),
            ("torque",),
            {"J": 0.002, "k": 0.05, "c": 1e-3},
            ("k", "c"),
            _driven,
            _one("J"),
            _none,
            (0.3,),
            "u",
            (0.008, 0.02),
            (3.0, 7.5),
        ),
        Plant(
            "pendulum",
            ("phi",),
            ("phi_dot",),
            ("torque",),
            PENDULUM,
            ("c",),
            _pendulum,
            _one("inertia"),
            _none,
            (1.2,),
            "u",
            (0.02, 0.06),
            (2.5, 7.0),
        ),
        Plant(
            "stop",
            ("phi",),
            ("phi_dot",),
            ("torque",),
            PENDULUM | {"c": 2e-3, "k_stop": 16.0, "c_stop": 0.025, "limit": 0.45},
            ("weight", "c", "k_stop", "c_stop"),
            _stop,
            _one("inertia"),
            _none,
            (0.4,),
            "u",
            (0.06, 0.16),
            (3.0, 6.5),
        ),
        Plant(
            "cart",
            ("x",),
            ("x_dot",),
            ("force",),
            CART,
            ("k", "c", "level"),
            _driven,
            _one("m"),
            _level,
            (0.12,),
            "u",
            (0.9, 2.2),
            (3.0, 9.0),
        ),
        Plant(
            "cart_smooth",
            ("x",),
            ("x_dot",),
            ("force",),
            CART | {"width": 0.01},
            ("k", "c", "level"),
            _smooth,
            _one("m"),
            _none,
            (0.12,),
            "u",
            (0.9, 2.2),
            (3.0, 9.0),
        ),
        Plant(
            "duffing",
            ("x",),
            ("x_dot",),
            ("force",),
            {"m": 0.4, "k": 12.0, "k3": 600.0, "c": 0.18},
            ("k", "k3", "c"),
            _duffing,
            _one("m"),
            _none,
            (0.1,),
            "u",
            (0.5, 1.3),
            (3.5, 9.0),
        ),
        Plant(
            "chain",
            ("x1", "x2"),
            ("v1", "v2"),
            ("force1", "force2"),
            {"m1": 0.5, "m2": 0.3, "k1": 25.0, "k2": 18.0, "c1": 0.12, "c2": 0.12},
            ("k1", "k2", "c1", "c2"),
            _chain,
            lambda p: np.diag([1 / p["m1"], 1 / p["m2"]]),
            lambda p: [0.0, 0.0],
            (0.1, 0.1),
            "u",
            (0.5, 1.5),
            (3.0, 13.0),
        ),
        Plant(
            "double_torsion",
            ("phi1", "phi2"),
            ("phi1_dot", "phi2_dot"),
            ("column", "contact"),
            {
                "B1": 0.00135,
                "B2": 0.0003,
                "kappa1": 0.0169,
                "kappa2": 0.0304,
                "T_v1": 0.0044,
                "T_s2": 0.035,
                "T_02": 0.504,
                "alpha": 0.15,
                "beta": 2.2,
                "k1": 300.0,
                "c1": 120.0,
                "k2": 0.7,
                "c2": 0.019,
                "phi1_s": math.radians(13.6),
                "phi2_s": math.radians(1.1),
            },
            ("kappa1", "kappa2", "T_v1", "T_s2", "k2", "c2"),
            _double,
            lambda p: np.array(
                [[1 / p["B1"], -1 / p["B1"]], [-1 / p["B1"], 1 / p["B2"] + 1 / p["B1"]]]
            ),
            lambda p: [0.0, 0.0],
            (0.15, 0.01),
            "base",
            (0.45, 0.75),
            (3.0, 5.2),
            stiff=True,
        ),
    )
}
