"""Independent solutions of those of C19 to C31 of paper C that have no events, on scipy alone.

Each system is the line of its equations of motion as first-order rates; a case is a system with
parameters, start values and an end, in the order of the paper's symbols. Numbers are written here
once more, not read from the diagrams.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import cos, sin, sqrt
from types import SimpleNamespace

import numpy as np
from numpy.typing import NDArray
from oracles.c_common import smooth

Array = NDArray[np.float64]
Rates = Callable[[float, Array, SimpleNamespace], list[float]]


@dataclass(frozen=True)
class Case:
    """A row of the table of cases: `states` names what `start` and the rates are the values of."""

    rates: Rates
    states: tuple[str, ...]
    start: tuple[float, ...]
    end: float
    parameters: Mapping[str, float] = field(default_factory=dict)
    tolerance: float = 1e-6

    def solve(self, times: Array) -> dict[str, Array]:
        """Every state at each time (N,)."""
        p = SimpleNamespace(**self.parameters)
        found = smooth(lambda t, y: self.rates(t, y, p), self.start, times)
        return dict(zip(self.states, found, strict=True))


G = 9.81


def c19(t: float, y: Array, p: SimpleNamespace) -> list[float]:
    """Eq 35, the angle from the upright position."""
    phi, w = y
    length = p.l0 * (1 + p.eps * cos(p.Om * t))
    rate = -p.l0 * p.eps * p.Om * sin(p.Om * t)
    a0 = -p.a * p.omega**2 * sin(p.omega * t)
    return [w, -2 * rate / length * w + (G + a0) / length * sin(phi)]


def c20(t: float, y: Array, p: SimpleNamespace) -> list[float]:
    """Eqs 36 and 37."""
    x, v, phi, w = y
    r, force = p.l + x, -p.Q0 * cos(p.omega * t)
    spring = -p.k1 * x - p.k2 * x**3 - p.b * v
    a = r * w**2 + G * cos(phi) + (spring + force * sin(phi)) / p.m
    b = (-2 * v * w - G * sin(phi)) / r - p.b * w / p.m + force * cos(phi) / (p.m * r)
    return [v, a, w, b]


def c21(t: float, y: Array, p: SimpleNamespace) -> list[float]:
    """Eqs 38 to 40."""
    _, u, length, v, phi, w = y
    s, c = sin(phi), cos(phi)
    pull = p.c * v + p.k * (length - p.l0)
    a = (pull * s + p.Q0 * cos(p.omega * t)) / p.M
    return [
        u,
        a,
        v,
        -pull / p.m + length * w**2 - a * s + G * c,
        w,
        -(2 * v * w + a * c + G * s) / length,
    ]


def c21r(t: float, y: Array, p: SimpleNamespace) -> list[float]:
    """The rigid pendulum on a slider, solved for the accelerations by hand."""
    _, u, phi, w = y
    s, c = sin(phi), cos(phi)
    force = p.Q0 * cos(p.omega * t) + p.m * p.l * w**2 * s + p.m * G * s * c
    a = force / (p.M + p.m * s**2)
    return [u, a, w, -(a * c + G * s) / p.l]


def c24(t: float, y: Array, p: SimpleNamespace) -> list[float]:
    """The absorber's rigid limit, by Cramer's rule."""
    h, v, phi, w = y
    ml, s, c = p.m * p.l, sin(phi), cos(phi)
    f1 = -p.c * v - p.k * h - ml * w**2 * c + p.F0 * cos(p.Om * t)
    f2 = -p.cp * w - ml * G * s
    a11, a12, a22 = p.M + p.m, ml * s, ml * p.l
    det = a11 * a22 - a12**2
    return [v, (f1 * a22 - a12 * f2) / det, w, (a11 * f2 - a12 * f1) / det]


def c25(t: float, y: Array, p: SimpleNamespace) -> list[float]:
    """Eqs 48 and 49, with g = 9.8 as printed."""
    phi1, w1, phi2, w2 = y
    q, g = p.k * p.l3**2 * (phi1 - phi2), 9.8
    return [
        w1,
        -g / p.l1 * phi1 - q / (p.m1 * p.l1**2),
        w2,
        -g / p.l2 * phi2 + q / (p.m2 * p.l2**2),
    ]


def c26(t: float, y: Array, p: SimpleNamespace) -> list[float]:
    """Eqs 50 to 52: `sb` = 1 and `MR2` = 0 without plane and flywheel."""
    phi, w = y
    heave = -p.A * p.omega**2 * cos(p.omega * t)
    torque = -p.c * w + p.m * p.l * (heave - G * p.sb) * sin(phi)
    return [w, torque / (p.m * p.l**2 + p.MR2)]


def c28(t: float, y: Array, p: SimpleNamespace) -> list[float]:
    """Eqs 53 and 55."""
    phi, w = y
    a = p.omega**2 * p.r * (cos(p.omega * t) + cos(2 * p.omega * t) / p.jc)
    torque = -p.c * w - p.m * (p.l1 - p.l2) * (G + a) * sin(phi)
    return [w, torque / (p.Ic + p.m * (p.l1**2 + 2 * p.l2**2))]


def c31(t: float, y: Array, p: SimpleNamespace) -> list[float]:
    """The crane, with the inertia matrix derived from its Lagrangian; the drive has 1 rad/s."""
    _, u, length, v, th, w = y
    s, c = sin(th), cos(th)
    mass = [
        [p.Mt + p.m, p.m * s, p.m * length * c],
        [p.m * s, p.Mh + p.m, 0.0],
        [p.m * length * c, 0.0, p.m * length**2],
    ]
    hoist = -p.m * G + p.kp * (p.lref - length)
    forces = [
        p.Fx * sin(t) - p.cx * u - 2 * p.m * c * v * w + p.m * length * s * w**2,
        hoist - p.cl * v + p.m * length * w**2 + p.m * G * c,
        -p.ct * w - 2 * p.m * length * v * w - p.m * G * length * s,
    ]
    a, b, d = np.linalg.solve(mass, forces)
    return [u, a, v, b, w, d]


ANGLE = ("phi", "phi_dot")
SPRING = ("x", "x_dot", "phi", "phi_dot")
ABSORBER = ("y", "y_dot", "phi", "phi_dot")
PAIR = ("phi1", "phi1_dot", "phi2", "phi2_dot")
CRANE = ("x", "x_dot", "l", "l_dot", "theta", "theta_dot")
SLIDER = ("x", "x_dot", "l", "l_dot", "phi", "phi_dot")
P19 = {"l0": 1, "eps": 0.1, "Om": 2, "a": 0.05, "omega": 5}
P20 = {"m": 1, "l": 1, "k1": 40, "k2": 50, "b": 0.1, "Q0": 1, "omega": 2}
P21 = {"M": 2, "m": 1, "k": 50, "c": 0.5, "l0": 1, "Q0": 3, "omega": 2}
P24 = {"M": 5, "m": 0.5, "l": 0.25, "k": 863.28, "c": 3, "cp": 0.002, "F0": 5, "Om": 12.528}
P25 = {"m1": 0.5, "m2": 0.5, "l3": 0.55, "k": 19.7, "l1": 1, "l2": 1}
P26 = {"m": 1, "l": 0.5, "c": 0.02, "A": 0.05, "omega": 2 * sqrt(G / 0.5), "sb": 1, "MR2": 0}
P27 = P26 | {"A": 0.1, "omega": 4, "sb": 0.5, "MR2": 0.1}
P28 = {"m": 1, "l1": 0.4, "l2": 0.3, "Ic": 0.05, "c": 0.01, "r": 0.15, "jc": 4, "omega": 3.17}
P31 = {"Mt": 5, "Mh": 2, "m": 1, "cx": 1, "cl": 4, "ct": 0.05, "Fx": 5, "kp": 10, "lref": 1.5}

CASES = {
    "C19": Case(c19, ANGLE, (3, 0), 20, P19),
    "C19up": Case(c19, ANGLE, (0.1, 0), 10, P19),
    "C20": Case(c20, SPRING, (0.2, 0, 0.5, 0), 40, P20),
    "C20c": Case(c20, SPRING, (0.2, 0, 0.5, 0), 40, P20 | {"b": 0, "Q0": 0}),
    "C21": Case(c21, SLIDER, (0, 0, 1.2, 0, 0.3, 0), 40, P21),
    "C21c": Case(c21, SLIDER, (0, 0, 1.2, 0, 0.3, 0), 20, P21 | {"c": 0, "Q0": 0}),
    "C21r": Case(c21r, SPRING, (0, 0, 0.3, 0), 40, {"M": 2, "m": 1, "l": 1, "Q0": 3, "omega": 2}),
    "C24": Case(c24, ABSORBER, (0, 0, 0.05, 0), 40, P24, 2e-4),
    "C25m1": Case(c25, PAIR, (0.1, 0, 0.1, 0), 20, P25),
    "C25m2": Case(c25, PAIR, (0.1, 0, -0.1, 0), 20, P25),
    "C25mix": Case(c25, PAIR, (0.1, 0, 0, 0), 20, P25),
    "C25ne": Case(c25, PAIR, (0.1, 0, 0, 0), 20, P25 | {"l2": 0.8}),
    "C26": Case(c26, ANGLE, (0.1, 0), 20, P26),
    "C26r": Case(c26, ANGLE, (0, 8), 5, P26 | {"A": 0.2, "omega": 8}, 2e-4),
    "C27": Case(c26, ANGLE, (0.2, 0), 20, P27),
    "C28": Case(c28, ANGLE, (0.2, 0), 50, P28),
    "C31": Case(c31, CRANE, (0, 0, 1, 0, 0.2, 0), 20, P31),
}
