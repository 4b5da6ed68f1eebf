"""The plants of one degree of freedom and the laws once more, for arrays: for refits alone.

The records themselves come from `benchmarks.tracing.laws` and `integrate`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Numbers = Mapping[str, Array]
MASSES = {
    "torsion": "J",
    "torsion_dry": "J",
    "driven": "J",
    "pendulum": "inertia",
    "cart": "m",
    "cart_smooth": "m",
    "duffing": "m",
}
DRY = ("torsion_dry", "cart")  # their friction `level` is set-valued


class Now(NamedTuple):
    """Arrays that a law may read; `width` is of smoothed friction."""

    t: Array
    q: Array
    v: Array
    z: Array
    phase: Array  # of the drive, rad
    width: Array


def _linear(p: Numbers, q: Array, v: Array, u: Array) -> Array:
    return u - p["k"] * q - p["c"] * v


def _pendulum(p: Numbers, q: Array, v: Array, u: Array) -> Array:
    return u - p["weight"] * np.sin(q) - p["c"] * v


def _smooth(p: Numbers, q: Array, v: Array, u: Array) -> Array:
    return u - p["k"] * q - p["c"] * v - p["level"] * np.tanh(v / p["width"])


def _duffing(p: Numbers, q: Array, v: Array, u: Array) -> Array:
    return u - p["k"] * q - p["k3"] * q**3 - p["c"] * v


FORCES: dict[str, Callable[[Numbers, Array, Array, Array], Array]] = {
    "torsion": _linear,
    "torsion_dry": _linear,
    "driven": _linear,
    "pendulum": _pendulum,
    "cart": _linear,
    "cart_smooth": _smooth,
    "duffing": _duffing,
}
Law = Callable[[Now, Numbers], Array]


def _bouc_wen(n: Now, s: Numbers) -> Array:
    own = np.abs(n.z) ** (s["n"] - 1) * n.z
    return (n.v - np.abs(n.v) * own * (0.5 * np.sign(n.z * n.v) + 0.5)) / s["s"]


def _lugre(n: Now, s: Numbers) -> Array:
    g = s["ratio"] + (1 - s["ratio"]) * np.exp(-((n.v / s["vs"]) ** 2))
    return (n.v - np.abs(n.v) * n.z / g) / s["s"]


LEVELS: dict[str, Law] = {  # of dry friction: set-valued, or times tanh(v/width)
    "coulomb": lambda n, s: np.ones_like(n.v),
    "stribeck": lambda n, s: np.exp(-((n.v / s["s"]) ** 2)),
    "disp_friction": lambda n, s: np.abs(n.q),
    "friction_drift": lambda n, s: np.maximum(n.t, 0.0),
}
LAWS: dict[str, Law] = {
    "bias": lambda n, s: np.ones_like(n.q),
    "viscous": lambda n, s: -n.v,
    "quad_drag": lambda n, s: -n.v * np.abs(n.v),
    "cubic_damping": lambda n, s: -(n.v**3),
    "asym_coulomb": lambda n, s: -(np.tanh(n.v / s["width"]) ** 2),
    "asym_viscous": lambda n, s: -np.abs(n.v),
    "stiffness": lambda n, s: -n.q,
    "cubic_stiffness": lambda n, s: -(n.q**3),
    "quad_stiffness": lambda n, s: -(n.q**2),
    "asym_stiffness": lambda n, s: -np.abs(n.q),
    "backlash": lambda n, s: np.clip(n.q, -s["s"], s["s"]),
    "barrier": lambda n, s: np.clip(n.q, -s["s"], s["s"]) - n.q,
    "barrier_hi": lambda n, s: -np.maximum(0.0, n.q - s["s"]),
    "barrier_lo": lambda n, s: -np.minimum(0.0, n.q + s["s"]),
    "cogging": lambda n, s: np.sin(s["n"] * n.q + s["phase"]),
    "harmonic": lambda n, s: np.sin(2 * np.pi * s["frequency"] * n.t + s["phase"]),
    "parametric": lambda n, s: n.q * np.sin(2 * np.pi * s["frequency"] * n.t + s["phase"]),
    "stiffness_drift": lambda n, s: -n.q * n.t,
    "viscous_drift": lambda n, s: -n.v * n.t,
    "hysteresis": lambda n, s: -n.z,
    "lugre": lambda n, s: -n.z,
    "bouc_wen": lambda n, s: -n.z,
    "drive_2nd_harm": lambda n, s: s["size"] * np.sin(2 * n.phase + s["psi"]),
    "drive_3rd_harm": lambda n, s: s["size"] * np.sin(3 * n.phase + s["psi"]),
}
MEMORIES: dict[str, Law] = {
    "hysteresis": lambda n, s: (n.v - np.abs(n.v) * n.z) / s["s"],
    "lugre": _lugre,
    "bouc_wen": _bouc_wen,
}


def force_of(name: str, now: Now, shapes: Numbers) -> Array:
    """What a law does per unit of its coefficient, dry friction smoothed."""
    if name in LEVELS:
        return -LEVELS[name](now, shapes) * np.tanh(now.v / now.width)
    return LAWS[name](now, shapes)
