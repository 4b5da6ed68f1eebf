"""Paper B's triple physical pendulum under a square-wave torque, in plain Python.

M(psi) psi'' + N(psi) (psi_i'^2) + C psi' + p(psi) = [f_e(t), 0, 0];  M_ii = B_i,
M_ij = N_ij cos(psi_i - psi_j), N(psi)_ij = N_ij sin(psi_i - psi_j), p_i = M_i sin psi_i;
f_e = -q in the first half period. B1 and M1 are inferred: the print has lost them.
"""

from __future__ import annotations

import math

import numpy as np

from benchmarks.systems.hybrid import Modes, State, Vector

CONSTANTS = {
    "B1": 0.190,
    "B2": 0.1602,
    "B3": 0.01675,
    "N12": 0.1262,
    "N13": 0.02116,
    "N23": 0.02736,
    "M1": 9.88,
    "M2": 7.198,
    "M3": 1.158,
    "c1": 0.06825,
    "c2": 0.02216,
    "c3": 0.001840,
    "q": 2.0,
}


class Triple:
    """The pendulum at one frequency of the torque, in Hz, from rest; the mode counts half periods.

    It is solved by hand (adjugate of M) as one would for speed.
    """

    file = "triple.h"

    def __init__(self, frequency: float, end: float) -> None:
        self.frequency = frequency
        self.values = CONSTANTS
        self.constants = np.array([*CONSTANTS.values(), frequency])
        self.times: Vector = np.linspace(0.0, end, round(end * 100) + 1)
        self._numbers = tuple(CONSTANTS.values())

    def begin(self) -> tuple[Vector, Modes]:
        """Hanging at rest."""
        return np.zeros(6), (0,)

    def rates(self, t: float, x: State, on: Modes) -> tuple[float, ...]:
        """psi1', psi2', psi3' and their rates."""
        B1, B2, B3, N12, N13, N23, M1, M2, M3, c1, c2, c3, q = self._numbers
        psi1, psi2, psi3, w1, w2, w3 = x.tolist() if isinstance(x, np.ndarray) else x
        cos, sin = math.cos, math.sin
        d12, d13, d23 = psi1 - psi2, psi1 - psi3, psi2 - psi3
        b, c, e = N12 * cos(d12), N13 * cos(d13), N23 * cos(d23)
        s12, s13, s23 = N12 * sin(d12), N13 * sin(d13), N23 * sin(d23)
        q1, q2, q3 = w1 * w1, w2 * w2, w3 * w3
        torque = q if on[0] & 1 else -q
        r1 = torque - s12 * q2 - s13 * q3 - (c1 + c2) * w1 + c2 * w2 - M1 * sin(psi1)
        r2 = s12 * q1 - s23 * q3 + c2 * w1 - (c2 + c3) * w2 + c3 * w3 - M2 * sin(psi2)
        r3 = s13 * q1 + s23 * q2 + c3 * w2 - c3 * w3 - M3 * sin(psi3)
        A, B, C = B2 * B3 - e * e, c * e - b * B3, b * e - c * B2
        D, E, F = B1 * B3 - c * c, b * c - B1 * e, B1 * B2 - b * b
        determinant = B1 * A + b * B + c * C
        return (
            w1,
            w2,
            w3,
            (A * r1 + B * r2 + C * r3) / determinant,
            (B * r1 + D * r2 + E * r3) / determinant,
            (C * r1 + E * r2 + F * r3) / determinant,
        )

    def margins(self, t: float, x: State, on: Modes) -> list[float]:
        """There are none."""
        return []

    def margin(self, index: int, t: float, x: State, on: Modes) -> float:
        """There is none."""
        raise IndexError(index)

    def count(self, on: Modes) -> int:
        """There are none."""
        return 0

    def happen(self, t: float, x: Vector, on: Modes, index: int) -> tuple[Vector, Modes]:
        """Nothing of that kind does."""
        raise IndexError(index)

    def due(self, on: Modes) -> float:
        """The end of this half period, in s."""
        return (on[0] + 1) / (2.0 * self.frequency)

    def tick(self, on: Modes) -> Modes:
        """The next half period."""
        return (on[0] + 1,)
