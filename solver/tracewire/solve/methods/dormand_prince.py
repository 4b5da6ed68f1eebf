"""The explicit pair of Dormand and Prince, order 5(4), with dense output of order 4.

Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, table
II.5.2, section II.6 for the dense output, and section IV.2 (volume II) for the stiffness estimate.
"""

from __future__ import annotations

import numpy as np

from tracewire.solve.methods.step import Field, Step, Vector

C = (0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0)
A = [
    np.array(row)
    for row in (
        [1 / 5],
        [3 / 40, 9 / 40],
        [44 / 45, -56 / 15, 32 / 9],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    )
]
E = np.array([71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
D = np.array(
    [
        -12715105075 / 11282082432,
        0,
        87487479700 / 32700410799,
        -10690763975 / 1880347072,
        701980252875 / 199316789632,
        -1453857185 / 822651844,
        69997945 / 29380423,
    ]
)


class DormandPrince:
    """The explicit method: six evaluations a step."""

    def step(self, field: Field, t: float, x: Vector, rate: Vector, h: float) -> Step:
        """A trial step; the seventh stage is the rate at the end."""
        slopes = np.empty((7, len(x)))
        slopes[0] = rate
        before_last = at = x
        for stage in range(1, 7):
            before_last = at
            at = x + h * (A[stage - 1] @ slopes[:stage])
            slopes[stage] = field.rates(t + C[stage] * h, at)
        apart = at - before_last
        distance = float(apart @ apart)
        change = slopes[6] - slopes[5]
        ratio = float(change @ change) / distance if distance > 0 else 0.0
        stiffness = h * ratio**0.5
        inner = np.empty((3, len(x)))
        rise = at - x
        inner[0] = h * rate - rise
        inner[1] = rise - h * slopes[6] - inner[0]
        inner[2] = h * (D @ slopes)
        return Step(t, h, x, at, slopes[6], h * (E @ slopes), inner, stiffness)

    def inside(self, step: Step, theta: float | Vector) -> Vector:
        """The polynomial of degree 4 through both ends and both rates."""
        rise, back, rest = step.x_end - step.x, 1.0 - theta, step.inner
        bent = rest[0] + theta * (rest[1] + back * rest[2])
        return np.asarray(step.x + theta * (rise + back * bent))
