"""Paper A's double torsion pendulum, final model, in plain Python: the fastest that peers can get.

phi_f = A sin(omega t + phase) - phi1;  f_s = kappa1 phi_f + kappa2 phi_f^3              Eq 23
R_i = k_i d_i + c_i v_i beyond the barriers, else 0                                      Eq 4, 15
M_L = T_v1 v1 + sign(v1) T_b;  v1 = 0 is held while the rest is at most T_b              Eq 22
M_T = T_s2/(1 + T_02|v2|) (1 + beta/cosh(alpha v2)) tanh(alpha v2)                       Eq 24
v1' = (f_s - R1 + R2 - M_L + M_T)/B1;  v2' = -v1' - (R2 + M_T)/B2
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from benchmarks.systems.hybrid import Modes, State, Vector

CONSTANTS = {
    "B1": 0.00135,
    "B2": 0.0003,
    "A": math.radians(37.5),
    "omega": 3.9,
    "phase": math.radians(120.0),
    "kappa1_l": 0.0135,
    "kappa1_r": 0.0203,
    "kappa2_l": 0.0243,
    "kappa2_r": 0.0365,
    "T_v1_l": 0.0039,
    "T_v1_r": 0.0049,
    "T_b": 0.9 * 9.81 * 0.001126 * 0.008 / 2.0,
    "T_s2_l": 0.0250,
    "T_s2_r": 0.0450,
    "T_02_l": 0.5050,
    "T_02_r": 0.5030,
    "alpha": 0.15,
    "beta": 2.2,
    "k1": 300.0,
    "c1": 120.0,
    "k2": 0.7,
    "c2_l": 0.018,
    "c2_r": 0.020,
    "phi1_s": math.radians(13.6),
    "phi2_s": math.radians(1.1),
}
COLUMN, DISK, SPRING, V1, V2 = range(5)  # a mode is +1, -1 or 0: no contact, or v1 is held
Watched = tuple[int, int, Callable[[float, State], float]]


class Torsion:
    """The pendulum for one damping of the pin barrier."""

    file = "torsion.h"

    def __init__(self, c1: float) -> None:
        self.values = CONSTANTS | {"c1": c1}
        self.constants = np.array(list(self.values.values()))
        self.times: Vector = np.arange(401) / 100.0
        self._watched: dict[Modes, list[Watched]] = {}
        self._torques: dict[Modes, Callable[[float, State], tuple[float, float]]] = {}

    def begin(self) -> tuple[Vector, Modes]:
        """At rest on the barrier at -phi1_s, which it leaves."""
        return np.array([-self.values["phi1_s"], 0.0, 0.0, 0.0]), (0, 0, -1, 1, -1)

    def torques(self, on: Modes) -> Callable[[float, State], tuple[float, float]]:
        """Of t, x: torque [N m] on the column without M_L, and on the disk, for these modes."""
        if on not in self._torques:
            self._torques[on] = self._make_torques(on)
        return self._torques[on]

    def _make_torques(self, on: Modes) -> Callable[[float, State], tuple[float, float]]:
        p = self.values
        l1, l2, column, disk = on[SPRING] > 0, on[V2] > 0, on[COLUMN], on[DISK]
        kappa1, kappa2 = p["kappa1_l" if l1 else "kappa1_r"], p["kappa2_l" if l1 else "kappa2_r"]
        level, decay = p["T_s2_l" if l2 else "T_s2_r"], p["T_02_l" if l2 else "T_02_r"] * on[V2]
        A, omega, phase = p["A"], p["omega"], p["phase"]
        alpha, beta, k1, c1 = p["alpha"], p["beta"], p["k1"], p["c1"]
        k2, c2 = p["k2"], p["c2_l" if disk > 0 else "c2_r"]
        limit1, limit2 = column * p["phi1_s"], disk * p["phi2_s"]
        sin, exp, tanh = math.sin, math.exp, math.tanh

        def torques(t: float, x: State) -> tuple[float, float]:
            phi1, v1, phi2, v2 = x
            phi_f = A * sin(omega * t + phase) - phi1
            f_s = phi_f * (kappa1 + kappa2 * phi_f * phi_f)
            R1 = k1 * (phi1 - limit1) + c1 * v1 if column else 0.0
            R2 = k2 * (phi2 - limit2) + c2 * v2 if disk else 0.0
            z = alpha * v2
            fall = exp(-abs(z))  # 1/cosh without overflow in a rejected trial step
            M_T = level / (1 + decay * v2) * (1 + beta * 2 * fall / (1 + fall * fall)) * tanh(z)
            return f_s - R1 + R2 + M_T, -R2 - M_T

        return torques

    def rates(self, t: float, x: State, on: Modes) -> tuple[float, float, float, float]:
        """phi1', v1', phi2', v2'."""
        p = self.values
        column, disk = self.torques(on)(t, x)
        side, acceleration = on[V1], 0.0
        if side:
            viscous = p["T_v1_l" if side > 0 else "T_v1_r"]
            acceleration = (column - viscous * x[1] - side * p["T_b"]) / p["B1"]
        return x[1], acceleration, x[3], disk / p["B2"] - acceleration

    def watched(self, on: Modes) -> list[Watched]:
        """(mode, its next value, margin) of everything that can end these modes."""
        if on not in self._watched:
            self._watched[on] = self._make_watched(on)
        return self._watched[on]

    def _make_watched(self, on: Modes) -> list[Watched]:
        column, disk, spring, side1, side2 = on
        limit1, limit2, T_b = (self.values[name] for name in ("phi1_s", "phi2_s", "T_b"))
        found: list[Watched] = []
        if column:
            found.append((COLUMN, 0, lambda t, x: column * x[0] - limit1))
        else:
            found.append((COLUMN, 1, lambda t, x: limit1 - x[0]))
            found.append((COLUMN, -1, lambda t, x: limit1 + x[0]))
            found.append((SPRING, -spring, lambda t, x: spring * x[0]))
        if disk:
            found.append((DISK, 0, lambda t, x: disk * x[2] - limit2))
        else:
            found.append((DISK, 1, lambda t, x: limit2 - x[2]))
            found.append((DISK, -1, lambda t, x: limit2 + x[2]))
        found.append((V2, -side2, lambda t, x: side2 * x[3]))
        if side1:
            found.append((V1, -side1, lambda t, x: side1 * x[1]))
        else:
            torques = self.torques(on)
            found.append((V1, 1, lambda t, x: T_b - torques(t, x)[0]))
            found.append((V1, -1, lambda t, x: T_b + torques(t, x)[0]))
        return found

    def margins(self, t: float, x: State, on: Modes) -> list[float]:
        """All margins."""
        return [margin(t, x) for _, _, margin in self.watched(on)]

    def margin(self, index: int, t: float, x: State, on: Modes) -> float:
        """One margin."""
        return self.watched(on)[index][2](t, x)

    def count(self, on: Modes) -> int:
        """How many margins there are."""
        return len(self.watched(on))

    def happen(self, t: float, x: Vector, on: Modes, index: int) -> tuple[Vector, Modes]:
        """The state exactly on the surface, and the modes behind it."""
        mode, to, _ = self.watched(on)[index]
        p, x, after = self.values, np.array(x), list(on)
        side = to or on[mode]
        if mode == COLUMN:
            x[0] = side * p["phi1_s"]
        elif mode == DISK:
            x[2] = side * p["phi2_s"]
        elif mode == SPRING:
            x[0] = 0.0
        elif mode == V2:
            x[3] = 0.0
            to = int(np.sign(self.rates(t, x, on)[3])) or to
        elif on[V1]:
            x[1] = 0.0
            column = self.torques(on)(t, x)[0]
            to = 0 if abs(column) <= p["T_b"] else int(np.sign(column))
        after[mode] = to
        return x, tuple(after)

    def due(self, on: Modes) -> float:
        """Nothing is scheduled."""
        return math.inf

    def tick(self, on: Modes) -> Modes:
        """Nothing changes."""
        return on
