"""The cases with a floor: one or two hidden effects, or none, in systems of one degree of freedom.

What differs between rigs (drive, noise, record) is drawn for each (`scenario`), and so are sizes.
`alike` has reasons of structure alone: the two laws are the same motion, whatever the record.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

import numpy as np

from benchmarks.tracing.cases import ONE_SIDED_WHY, Case, Spec, spec

NULLS = 60
QUICK = 15
EACH = 5  # of these cases one is traced in other units, too
ANGLES = ("torsion", "torsion_dry", "driven", "pendulum")  # turn; others go straight
SENSORS = {"torsion": "theta", "driven": "theta", "pendulum": "phi"}  # others: x
SPRINGS = ("torsion", "torsion_dry", "driven", "cart", "cart_smooth", "duffing")  # k is free
LINEAR = ("torsion", "torsion_dry", "driven", "cart", "cart_smooth")  # their spring is
# effect: its systems
SINGLES: tuple[tuple[Spec, tuple[str, ...]], ...] = (
    (spec("bias", share=0.08), ("pendulum", "duffing", "torsion", "cart")),
    (spec("coulomb", share=0.08), ("torsion", "driven", "pendulum", "duffing")),
    (spec("coulomb", share=0.1, width=0.04), ("driven", "pendulum", "torsion", "duffing")),
    (spec("quad_drag", share=0.1), ("pendulum", "torsion", "driven", "cart", "cart_smooth")),
    (spec("cubic_damping", share=0.1), ("cart", "driven", "torsion")),
    (spec("asym_viscous", share=0.1), ("duffing", "driven", "pendulum", "torsion")),
    (spec("stribeck", share=0.1, s="0.35V"), ("cart", "pendulum", "torsion_dry")),
    (spec("stribeck", share=0.1, width=0.05, s="0.5V"), ("pendulum", "driven")),
    (spec("disp_friction", share=0.08), ("torsion", "driven", "pendulum")),
    (spec("stiffness", share=0.15), ("pendulum", "pendulum")),
    (spec("cubic_stiffness", share=0.15), ("driven", "torsion", "cart", "cart_smooth", "driven")),
    (spec("quad_stiffness", share=0.12), ("cart_smooth", "torsion", "driven", "cart")),
    (spec("asym_stiffness", share=0.1), ("driven", "torsion", "cart", "pendulum")),
    (spec("backlash", share=0.12, s="0.25Q"), ("torsion", "driven", "cart")),
    (spec("barrier", share=0.15, s="0.55Q"), ("driven", "torsion", "cart_smooth")),
    (spec("barrier_hi", share=0.12, s="0.5Q"), ("duffing", "pendulum", "cart", "driven")),
    (spec("barrier_lo", share=0.12, s="0.5Q"), ("pendulum", "torsion", "cart_smooth", "driven")),
    (spec("hysteresis", share=0.06, s="0.1Q"), ("torsion", "driven", "pendulum", "duffing")),
    (spec("harmonic", share=0.1, frequency="1.7"), ("pendulum", "driven", "cart")),
    (spec("parametric", share=0.12, frequency="2.3"), ("duffing", "driven", "pendulum")),
    (spec("drive_gain", "drive.u", absolute=0.12), ("pendulum", "pendulum")),
    (spec("drive_lag", "drive.u", absolute=0.03), ("pendulum", "driven", "duffing")),
    (spec("drive_2nd_harm", "drive.u", absolute=0.12), ("driven", "pendulum")),
    (spec("drive_3rd_harm", "drive.u", absolute=0.12), ("cart", "duffing")),
    (spec("inertia", absolute=0.0015), ("pendulum", "pendulum")),
    (spec("sensor_offset", "phi", share=0.08), ("pendulum",)),
    (spec("sensor_delay", "x", absolute=0.02), ("duffing", "cart")),
    (spec("sensor_quad", "x", share=0.06), ("duffing",)),
    (spec("cogging", share=0.12, n="6", phase="0.5"), ("driven", "pendulum", "torsion", "cart")),
    (spec("bouc_wen", share=0.08, s="0.15Q", n="1.5"), ("driven",)),
    (spec("lugre", share=0.1, s="0.05Q", vs="0.4V", ratio="0.5"), ("cart_smooth",)),
    (spec("viscous_drift", share=0.1), ("driven",)),
    (spec("stiffness_drift", share=0.1), ("driven",)),
)
COULOMB = spec("coulomb", share=0.08)
QUAD_DRAG = spec("quad_drag", share=0.1)
CUBIC = spec("cubic_stiffness", share=0.15)
BARRIER_HI = spec("barrier_hi", share=0.12, s="0.5Q")
DOUBLES: tuple[tuple[tuple[Spec, ...], tuple[str, ...]], ...] = (
    ((COULOMB, QUAD_DRAG), ("pendulum", "driven", "pendulum", "duffing")),
    ((COULOMB, CUBIC), ("driven", "torsion")),
    ((COULOMB, spec("asym_viscous", share=0.1)), ("driven", "duffing")),
    ((COULOMB, spec("bias", share=0.08)), ("duffing",)),
    ((QUAD_DRAG, spec("quad_stiffness", share=0.12)), ("driven", "cart")),
    ((COULOMB, spec("quad_stiffness", share=0.12)), ("torsion", "driven")),
    ((COULOMB, BARRIER_HI), ("duffing", "pendulum")),
    ((QUAD_DRAG, BARRIER_HI), ("cart", "pendulum")),
    ((QUAD_DRAG, CUBIC), ("torsion", "cart", "driven", "cart_smooth")),
    ((QUAD_DRAG, spec("bias", share=0.08)), ("duffing",)),
    ((QUAD_DRAG, spec("cogging", share=0.12, n="6", phase="0.5")), ("driven", "pendulum")),
    ((CUBIC, spec("harmonic", share=0.1, frequency="2.9")), ("driven", "cart_smooth")),
    ((CUBIC, spec("stribeck", share=0.1, s="0.35V")), ("torsion_dry", "cart")),
    ((CUBIC, spec("hysteresis", share=0.06, s="0.1Q")), ("torsion", "driven")),
    ((CUBIC, spec("asym_viscous", share=0.1)), ("driven",)),
    ((spec("inertia", absolute=0.0015), COULOMB), ("pendulum",)),
    ((spec("drive_lag", "drive.u", absolute=0.03), QUAD_DRAG), ("pendulum",)),
    ((spec("asym_stiffness", share=0.1), COULOMB), ("driven", "torsion")),
)
SYSTEMS = ("torsion", "torsion_dry", "driven", "pendulum", "cart", "cart_smooth", "duffing")


def place(system: str) -> str:
    """The sum of the forces, as a trace names it."""
    return "torque" if system in ANGLES else "force"


def alike(hidden: Spec, system: str) -> tuple[tuple[str, ...], str]:
    """What is structurally the same as a hidden effect in a system, and why."""
    at, sensor = f" @ {place(system)}", f" @ sensor.{SENSORS.get(system, 'x')}"
    name, spring = hidden.name, system in SPRINGS
    if name == "backlash" and spring:
        return ("barrier" + at,), "clip(q) = q - barrier(q) and the spring is free"
    if name == "barrier" and spring:
        return ("backlash" + at,), "barrier(q) = q - clip(q) and the spring is free"
    if name == "asym_stiffness" and spring:
        return ("barrier_hi" + at, "barrier_lo" + at), ONE_SIDED_WHY
    if name == "hysteresis":
        same = tuple(f"{x}{at}" for x in ("dahl", "lugre", "bouc_wen"))
        return same, "Dahl's law with its default exponent is a special case of each"
    if name == "bias" and system in LINEAR:
        why = "the spring is linear, and nothing else reads q: a force moves its zero, as an offset"
        return ("sensor_offset" + sensor,), why
    if name == "sensor_delay":
        why = "a late drive gives the same motion, later (to first order in the lag)"
        return ("drive_lag @ drive.u",), why
    return (), ""


def _case(number: int, system: str, hidden: tuple[Spec, ...]) -> Case:
    same = [alike(h, system) for h in hidden]
    names = "+".join(h.name + ("_smooth" if h.width else "") for h in hidden)
    why = "; ".join(reason for _, reason in same if reason)
    return Case(
        f"floor/{number:03d}-{names}@{system}",
        system,
        hidden,
        "floor",
        tuple(label for labels, _ in same for label in labels),
        why,
    )


def floor_cases() -> tuple[Case, ...]:
    """Every case with a hidden effect."""
    chosen: list[tuple[str, tuple[Spec, ...]]]
    chosen = [(system, (one,)) for one, systems in SINGLES for system in systems]
    chosen += [(system, pair) for pair, systems in DOUBLES for system in systems]
    return tuple(_case(k, system, hidden) for k, (system, hidden) in enumerate(chosen))


def floor_nulls(count: int = NULLS) -> tuple[Case, ...]:
    """Cases in which nothing of the library is hidden, and a floor is."""
    found = []
    for number in range(count):
        digest = hashlib.sha256(f"floor-null {number}".encode()).digest()
        system = SYSTEMS[int.from_bytes(digest) % len(SYSTEMS)]
        name = f"floor-null/{number:03d}@{system}"
        found.append(Case(name, system, (), "floor-null"))
    return tuple(found)


def size_of_null(case: Case, rng: np.random.Generator) -> tuple[Spec, ...]:
    """An effect that gives the floor of a null its size, and is left out afterwards."""
    fits = [one for one, systems in SINGLES if case.system in systems and one.place == 0]
    return (fits[int(rng.integers(len(fits)))],)


def quick() -> tuple[Case, ...]:
    """A sample of all."""
    cases, nulls = floor_cases(), floor_nulls()
    step = len(cases) / (QUICK - 4)
    return (*(cases[int(k * step + step / 2)] for k in range(QUICK - 4)), *nulls[:4])


def in_units(cases: Sequence[Case], units: str) -> list[tuple[Case, bool]]:
    """The cases, and whether each is in other units; `both`: every fifth floor case is in both."""
    found = []
    number = 0
    for case in cases:
        floor = case.group in ("floor", "floor-null")
        found.append((case, floor and units == "other"))
        if floor and units == "both":
            found += [(case, True)] if number % EACH == 0 else []
            number += 1
    return found
