"""The cases: what is hidden where. Sizes and series follow from the name and the draw."""

from __future__ import annotations

import fnmatch
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

NULLS = 150
ONE_SIDED = ("barrier_hi @ torque", "barrier_lo @ torque")
ONE_SIDED_WHY = (
    "-|q| = q - 2*max(q, 0): a barrier on one side that begins at 0, and the spring is free"
)
# 1 DOF nulls take seconds, the double torsion pendulum minutes: it has 4 of 150
SYSTEMS_OF_NULLS = (
    "torsion",
    "torsion_dry",
    "driven",
    "pendulum",
    "stop",
    "cart",
    "cart_smooth",
    "duffing",
    "chain",
    "chain",
    "driven",
    "pendulum",
    "cart",
    "duffing",
    "torsion_dry",
)
DOUBLE_TORSION_NULLS = (20, 60, 100, 140)


@dataclass(frozen=True)
class Spec:
    """A hidden effect before it has a size: its share of the force's rms at the place (of the
    signal's rms for a sensor), and shapes as multiples of Q = max|q| or V = rms(v)."""

    name: str
    place: int | str = 0
    share: float = 0.1
    shapes: tuple[tuple[str, str], ...] = ()
    width: float = 0.0  # of smoothed friction, in V; 0: it is set-valued
    absolute: float = 0.0  # the coefficient itself where a share means nothing


@dataclass(frozen=True)
class Case:
    """A name, a system, what is hidden, and what a right answer may be."""

    name: str
    system: str
    hidden: tuple[Spec, ...] = ()
    group: str = "single"
    alike: tuple[str, ...] = ()  # structurally identical: `name @ place`
    why: str = ""  # they are
    variables: tuple[tuple[str, ...], ...] = ()  # of an unexplained effect: each is right
    seconds: float = 10.0
    bad: str = ""  # what is wrong with the input
    draw: int = 0  # other sizes, parameters, series and noise of the same case

    @property
    def seed(self) -> int:
        """Of every random number of the case."""
        return zlib.crc32(f"{self.name}{f'#{self.draw}' if self.draw else ''}".encode())


def spec(
    name: str,
    place: int | str = 0,
    share: float = 0.1,
    width: float = 0.0,
    absolute: float = 0.0,
    **shapes: str,
) -> Spec:
    """A Spec with its shapes as keywords."""
    return Spec(name, place, share, tuple(shapes.items()), width, absolute)


def single(system: str, hidden: Spec, alike: Sequence[str] = (), why: str = "") -> Case:
    """A case of one effect."""
    kind = "_smooth" if hidden.width else ""
    return Case(
        f"single/{hidden.name}{kind}@{system}", system, (hidden,), alike=tuple(alike), why=why
    )


SINGLES = (
    single("pendulum", spec("bias", share=0.06)),
    single("torsion", spec("coulomb", share=0.03)),
    single("driven", spec("coulomb", share=0.1, width=0.03)),
    single("chain", spec("viscous", 1, share=0.06)),
    single("pendulum", spec("quad_drag", share=0.06)),
    single("double_torsion", spec("quad_drag", 1, share=0.1)),
    single("chain", spec("quad_drag", 1, share=0.08)),
    single("cart", spec("cubic_damping", share=0.1)),
    single("torsion_dry", Spec("asym_coulomb", share=0.02, shapes=(("width", "0.03V"),))),
    single("double_torsion", spec("asym_viscous", 0, share=0.1)),
    single("cart", spec("stribeck", share=0.08, s="0.35V")),
    single("pendulum", spec("stribeck", share=0.08, width=0.04, s="0.5V")),
    single("torsion", spec("disp_friction", share=0.03)),
    single("pendulum", spec("stiffness", share=0.2)),
    single("driven", spec("cubic_stiffness", share=0.15)),
    single("cart_smooth", spec("quad_stiffness", share=0.1)),
    single("double_torsion", spec("asym_stiffness", 0, share=0.1)),
    single(
        "torsion",
        spec("backlash", share=0.12, s="0.25Q"),
        ["barrier @ torque"],
        "clip(q) = q - barrier(q) and the spring is free",
    ),
    single(
        "driven",
        spec("barrier", share=0.15, s="0.55Q"),
        ["backlash @ torque"],
        "barrier(q) = q - clip(q) and the spring is free",
    ),
    single("duffing", spec("barrier_hi", share=0.12, s="0.5Q")),
    single("pendulum", spec("barrier_lo", share=0.12, s="0.5Q")),
    single(
        "torsion",
        spec("hysteresis", share=0.04, s="0.1Q"),
        ["dahl @ torque", "lugre @ torque", "bouc_wen @ torque"],
        "Dahl's law with its default exponent is a special case of each",
    ),
    single("pendulum", spec("harmonic", share=0.1, frequency="1.7")),
    single("duffing", spec("parametric", share=0.12, frequency="2.3")),
    single("driven", spec("stiffness_drift", share=0.08)),
    single("cart_smooth", spec("viscous_drift", share=0.08)),
    single("torsion_dry", spec("friction_drift", share=0.02)),
    single("chain", spec("coupling_q", 1, share=0.1)),
    single("chain", spec("coupling_v", 0, share=0.08)),
    single("pendulum", spec("drive_gain", "drive.u", absolute=0.12)),
    single("pendulum", spec("drive_lag", "drive.u", absolute=0.025)),
    single("driven", spec("drive_2nd_harm", "drive.u", absolute=0.12)),
    single("cart", spec("drive_3rd_harm", "drive.u", absolute=0.12)),
    single("pendulum", spec("inertia", absolute=0.0012)),
    single("pendulum", spec("sensor_offset", "phi", share=0.06)),
    single("double_torsion", spec("coulomb", 0, share=0.1)),
    single(
        "duffing",
        spec("sensor_delay", "x", absolute=0.015),
        ["drive_lag @ drive.u"],
        "to first order: a late drive gives the same motion, later",
    ),
    single("duffing", spec("sensor_quad", "x", share=0.05)),
    single("torsion", spec("sensor_drift", "theta", share=0.03)),
    single("driven", spec("cogging", share=0.12, n="12", phase="0.5")),
)
# further ones, beside the forty
EXTRA = tuple(
    replace(case, group="extra", name=case.name.replace("single", "extra"))
    for case in (
        single("pendulum", spec("sensor_gain", "phi", absolute=0.06)),
        single("pendulum", spec("hunt_crossley", share=0.15, s="0.5Q", n="1.5", damping="0.4")),
        single("driven", spec("asym_stiffness", share=0.1), ONE_SIDED, ONE_SIDED_WHY),
        single("cart", spec("drive_2nd_harm", "drive.u", absolute=0.12, psi="0.7")),
        single("duffing", spec("drive_3rd_harm", "drive.u", absolute=0.12, psi="0.7")),
        single("duffing", spec("asym_viscous", share=0.08)),
        single("cart_smooth", spec("lugre", share=0.08, s="0.05Q", vs="0.4V", ratio="0.5")),
        single("pendulum", spec("drive_saturation", "drive.u", absolute=0.6, limit="0.6U")),
        single("duffing", spec("drive_dead_zone", "drive.u", absolute=0.6, zone="0.2U")),
        single("driven", spec("load_friction", share=0.06)),
        single("driven", spec("bouc_wen", share=0.06, s="0.15Q", n="1.5")),
        single("chain", spec("stiffness", 1, share=0.1)),
        single(
            "driven",
            spec("inertia", absolute=2.5e-4),
            ["drive_gain @ drive.u", "sensor_gain @ sensor.theta"],
            "spring and damper are free and the system is linear: only the scale of u counts",
        ),
    )
)


def double(system: str, *hidden: Spec, alike: Sequence[str] = (), why: str = "") -> Case:
    """A case of two effects."""
    names = "+".join(h.name for h in hidden)
    return Case(f"double/{names}@{system}", system, hidden, "double", tuple(alike), why)


DOUBLES = (
    double(
        "torsion_dry",
        spec("asym_stiffness"),
        spec("stribeck", share=0.03, s="0.3V"),
        alike=ONE_SIDED,
        why=ONE_SIDED_WHY,
    ),
    double("pendulum", spec("coulomb", share=0.06), spec("quad_drag", share=0.06)),
    double("driven", spec("cubic_stiffness", share=0.15), spec("coulomb", width=0.03)),
    double("cart", spec("quad_drag", share=0.1), spec("barrier_hi", share=0.12, s="0.5Q")),
    double(
        "duffing",
        spec("coulomb", share=0.08),
        spec("asym_stiffness"),
        alike=["barrier_hi @ force", "barrier_lo @ force"],
        why=ONE_SIDED_WHY,
    ),
    double("chain", spec("cubic_stiffness", 0, 0.12), spec("coulomb", 1, 0.06)),
    double(
        "chain",
        spec("quad_drag", 0, 0.08),
        spec("barrier", 1, 0.12, s="0.5Q"),
    ),
    double("pendulum", spec("sensor_offset", "phi", 0.06), spec("coulomb", share=0.06)),
    double(
        "torsion",
        spec("hysteresis", share=0.04, s="0.1Q"),
        spec("cubic_stiffness", share=0.1),
        alike=["dahl @ torque", "lugre @ torque", "bouc_wen @ torque"],
        why="Dahl's law with its default exponent is a special case of each",
    ),
    double("cart_smooth", spec("quad_stiffness"), spec("harmonic", frequency="2.9")),
    double("stop", spec("coulomb", share=0.05), spec("bias", share=0.08)),
    double("double_torsion", spec("asym_stiffness", 0, 0.12), spec("quad_drag", 1, 0.1)),
)


def outside(system: str, hidden: Spec, *variables: tuple[str, ...]) -> Case:
    """A case that no block of the library explains; `variables` are right answers."""
    name = f"outside/{hidden.name}@{system}"
    return Case(name, system, (hidden,), "outside", variables=variables)


OUTSIDE = (
    outside("driven", spec("cross_drag", share=0.15), ("q", "v")),
    outside("cart", spec("maxwell", share=0.15, tau="0.2"), ("history",), ("history q",)),
    outside(
        "cart_smooth", spec("rough_patch", share=0.1, width=0.04, at="0.35Q", s="0.12Q"), ("q", "v")
    ),
    outside("driven", spec("two_ripples", share=0.12, n="9"), ("q",)),
    outside("duffing", spec("mixed", share=0.12, vs="0.3V", s="0.5Q"), ("q", "v")),
    outside("pendulum", spec("speed_ripple", share=0.1, vs="0.25V"), ("v",)),
    outside("chain", spec("wells", 1, share=0.12, at="0.3Q", s="0.15Q"), ("q",)),
    outside("torsion", spec("window_drag", share=0.12, s="0.2Q"), ("q", "v")),
)
BAD = tuple(
    Case(f"bad/{kind}@{system}", system, (), "bad", bad=kind)
    for kind, system in (
        ("too_short", "pendulum"),
        ("constant", "torsion"),
        ("wrong_units", "pendulum"),
        ("other_rig", "driven"),
        ("misaligned", "duffing"),
        ("process_noise", "driven"),
    )
)


def nulls(count: int = NULLS) -> tuple[Case, ...]:
    """Cases in which nothing is missing: random system, size and length."""
    found = []
    for number in range(count):
        rng = np.random.default_rng([7, number])
        system = SYSTEMS_OF_NULLS[int(rng.integers(len(SYSTEMS_OF_NULLS)))]
        if number in DOUBLE_TORSION_NULLS:
            system = "double_torsion"
        seconds = float(np.round(rng.uniform(4, 6), 1))
        found.append(Case(f"null/{number:03d}@{system}", system, (), "null", seconds=seconds))
    return tuple(found)


def chosen(
    pattern: str = "",
    null_count: int = NULLS,
    quick: bool = False,
    draw: int = 0,
    further: Sequence[Case] = (),
) -> list[Case]:
    """The cases whose name matches a pattern such as `single/*@cart`; `quick`: a sample of all.

    `draw` numbers repetitions with other random numbers. `further` cases are of other files.
    """
    cases = [*SINGLES, *EXTRA, *DOUBLES, *OUTSIDE, *BAD, *nulls(null_count)]
    if quick:
        cases = [
            *SINGLES[1::4],
            *DOUBLES[1::4],
            *OUTSIDE[::3],
            *BAD[:3],
            *nulls(min(10, null_count)),
        ]
        cases = [case for case in cases if case.system != "double_torsion"]
    cases += further
    if pattern:
        every = pattern if any(c in pattern for c in "*?[") else f"*{pattern}*"
        cases = [case for case in cases if fnmatch.fnmatch(case.name, every)]
    return [replace(case, draw=draw) for case in cases]
