"""Effects as formulas of their own: what acts on a body per unit of the coefficient.

q, v are the coordinate and rate at the place, u the drive, oq and ov the other body's. `level` laws
are dry friction: set-valued, -c*level*sign(v), or -c*level*tanh(v/width) where a width is given.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple


class At(NamedTuple):
    """What a law may read at one instant, in SI."""

    t: float
    q: float
    v: float
    u: float
    oq: float
    ov: float
    z: float
    omega: float  # of the drive's first harmonic, rad/s
    phase: float  # of the drive now, rad


Law = Callable[[At, dict[str, float]], float]


@dataclass(frozen=True)
class Effect:
    """A law per unit coefficient. `memory` is the rate of its own state z."""

    force: Law | None = None
    level: Law | None = None
    memory: Law | None = None
    kind: str = "sum"  # sum, drive, sensor or mass


def _clip(x: float, s: float) -> float:
    return max(-s, min(s, x))


def _asymmetric(at: At, s: dict[str, float]) -> float:
    return -(math.tanh(at.v / s["width"]) ** 2)


def _lugre(at: At, s: dict[str, float]) -> float:
    """Bristle deflection in units of its steady value; g falls from 1 to `ratio` with speed."""
    g = s["ratio"] + (1 - s["ratio"]) * math.exp(-((at.v / s["vs"]) ** 2))
    return (at.v - abs(at.v) * at.z / g) / s["s"]


def _contact(at: At, s: dict[str, float]) -> float:
    """Hunt and Crossley 1975 beyond `s` on the upper side: -d^n*(1 + lambda*v), never pulling."""
    d = at.q - s["s"]
    return -(d ** s["n"]) * max(0.0, 1 + s["damping"] * at.v) if d > 0 else 0.0


EFFECTS: dict[str, Effect] = {
    "bias": Effect(lambda a, s: 1.0),
    "coulomb": Effect(level=lambda a, s: 1.0),
    "viscous": Effect(lambda a, s: -a.v),
    "quad_drag": Effect(lambda a, s: -a.v * abs(a.v)),
    "cubic_damping": Effect(lambda a, s: -(a.v**3)),
    "asym_coulomb": Effect(_asymmetric),
    "asym_viscous": Effect(lambda a, s: -abs(a.v)),
    "stribeck": Effect(level=lambda a, s: math.exp(-((a.v / s["s"]) ** 2))),
    "disp_friction": Effect(level=lambda a, s: abs(a.q)),
    "stiffness": Effect(lambda a, s: -a.q),
    "cubic_stiffness": Effect(lambda a, s: -(a.q**3)),
    "quad_stiffness": Effect(lambda a, s: -(a.q**2)),
    "asym_stiffness": Effect(lambda a, s: -abs(a.q)),
    "backlash": Effect(lambda a, s: _clip(a.q, s["s"])),
    "barrier": Effect(lambda a, s: -(a.q - _clip(a.q, s["s"]))),
    "barrier_hi": Effect(lambda a, s: -max(0.0, a.q - s["s"])),
    "barrier_lo": Effect(lambda a, s: -min(0.0, a.q + s["s"])),
    "hysteresis": Effect(lambda a, s: -a.z, memory=lambda a, s: (a.v - abs(a.v) * a.z) / s["s"]),
    "harmonic": Effect(lambda a, s: math.sin(2 * math.pi * s["frequency"] * a.t + s["phase"])),
    "parametric": Effect(
        lambda a, s: a.q * math.sin(2 * math.pi * s["frequency"] * a.t + s["phase"])
    ),
    "stiffness_drift": Effect(lambda a, s: -a.q * a.t),
    "viscous_drift": Effect(lambda a, s: -a.v * a.t),
    "friction_drift": Effect(level=lambda a, s: max(a.t, 0.0)),
    "coupling_q": Effect(lambda a, s: -a.oq),
    "coupling_v": Effect(lambda a, s: -a.ov),
    "drive_gain": Effect(lambda a, s: a.u, kind="drive"),
    "drive_lag": Effect(kind="drive"),
    "drive_2nd_harm": Effect(
        lambda a, s: s["size"] * math.sin(2 * a.phase + s["psi"]), kind="drive"
    ),
    "drive_3rd_harm": Effect(
        lambda a, s: s["size"] * math.sin(3 * a.phase + s["psi"]), kind="drive"
    ),
    "drive_saturation": Effect(lambda a, s: _clip(a.u, s["limit"]) - a.u, kind="drive"),
    "drive_dead_zone": Effect(lambda a, s: -_clip(a.u, s["zone"]), kind="drive"),
    "load_friction": Effect(level=lambda a, s: abs(a.u)),
    "inertia": Effect(kind="mass"),
    "sensor_offset": Effect(kind="sensor"),
    "sensor_gain": Effect(kind="sensor"),
    "sensor_delay": Effect(kind="sensor"),
    "sensor_quad": Effect(kind="sensor"),
    "sensor_drift": Effect(kind="sensor"),
    # beyond the first library
    "lugre": Effect(
        lambda a, s: -a.z,
        memory=_lugre,
    ),
    "bouc_wen": Effect(
        lambda a, s: -a.z,
        memory=lambda a, s: (
            (
                a.v
                - abs(a.v)
                * abs(a.z) ** s["n"]
                * (0.5 * math.copysign(1, a.z * a.v) + 0.5)
                * a.z
                / max(abs(a.z), 1e-12)
            )
            / s["s"]
        ),
    ),
    "hunt_crossley": Effect(_contact),
    "cogging": Effect(lambda a, s: math.sin(s["n"] * a.q + s["phase"])),
    # outside every library
    "cross_drag": Effect(lambda a, s: -a.q * a.v**2),
    "maxwell": Effect(lambda a, s: -(a.q - a.z), memory=lambda a, s: (a.q - a.z) / s["tau"]),
    "rough_patch": Effect(level=lambda a, s: math.exp(-(((a.q - s["at"]) / s["s"]) ** 2))),
    "two_ripples": Effect(
        lambda a, s: math.sin(s["n"] * a.q + 0.4) + 0.8 * math.sin(math.sqrt(5) * s["n"] * a.q)
    ),
    "mixed": Effect(lambda a, s: -math.tanh(a.v / s["vs"]) * math.exp(a.q / s["s"])),
    "root_drag": Effect(
        lambda a, s: (
            -math.copysign(abs(a.v) ** 0.5, a.v) if abs(a.v) > s["w"] else -a.v / s["w"] ** 0.5
        )
    ),
    "wells": Effect(
        lambda a, s: (a.q - s["at"]) / s["s"] * math.exp(-(((a.q - s["at"]) / s["s"]) ** 2))
    ),
    "speed_ripple": Effect(lambda a, s: math.sin(a.v / s["vs"])),
    "window_drag": Effect(lambda a, s: -a.v * (1.0 if a.q > s["s"] else 0.0)),
}


@dataclass(frozen=True)
class Hidden:
    """An effect that acts in the record: its law, place (index of the body, or a channel's name),
    coefficient, shapes, and the width of its friction (0: set-valued)."""

    name: str
    place: int | str
    coefficient: float
    shapes: dict[str, float] = field(default_factory=dict)
    width: float = 0.0

    @property
    def effect(self) -> Effect:
        """Its law."""
        return EFFECTS[self.name]
