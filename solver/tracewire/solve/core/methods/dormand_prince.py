"""The explicit pair of Dormand and Prince, order 5(4), with dense output of order 4.

Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, table
II.5.2, section II.6 for the dense output, and section IV.2 (volume II) for the stiffness estimate.
"""

from __future__ import annotations

import math

import numpy as np

from tracewire.solve.core.arrays import Vector, trial_of
from tracewire.solve.core.flow import stage_rates
from tracewire.solve.core.methods.method import Method
from tracewire.solve.core.methods.trial import norm
from tracewire.solve.core.units import inlined, unit

METHOD = Method("dormand_prince", stages=7, inner=3, edge=3.0, nearby=1e-5)

C = (0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0)
A = np.array(
    [
        [0, 0, 0, 0, 0, 0],
        [1 / 5, 0, 0, 0, 0, 0],
        [3 / 40, 9 / 40, 0, 0, 0, 0],
        [44 / 45, -56 / 15, 32 / 9, 0, 0, 0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0, 0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0],
        [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
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


@unit
def step(core: int, t: float, x: Vector, rate: Vector, h: float) -> None:
    """A trial step: six evaluations, the last is the rate at the end."""
    n = len(x)
    if n == 2:
        _step(core, t, x, rate, h, 2)
    elif n == 3:
        _step(core, t, x, rate, h, 3)
    elif n == 4:
        _step(core, t, x, rate, h, 4)
    elif n == 6:
        _step(core, t, x, rate, h, 6)
    else:
        _step(core, t, x, rate, h, n)


@inlined
def _step(core: int, t: float, x: Vector, rate: Vector, h: float, n: int) -> None:
    """The same, built in with the number of states: short loops are unrolled."""
    into = trial_of(core)
    k, at, end = into.stages, into.error, into.x_end
    for i in range(n):
        k[0, i] = rate[i]
        end[i] = x[i] + h * (A[1, 0] * k[0, i])
    stage_rates(core, t + C[1] * h, end, k[1])
    for i in range(n):
        end[i] = x[i] + h * (A[2, 0] * k[0, i] + A[2, 1] * k[1, i])
    stage_rates(core, t + C[2] * h, end, k[2])
    for i in range(n):
        end[i] = x[i] + h * (A[3, 0] * k[0, i] + A[3, 1] * k[1, i] + A[3, 2] * k[2, i])
    stage_rates(core, t + C[3] * h, end, k[3])
    for i in range(n):
        total = A[4, 0] * k[0, i] + A[4, 1] * k[1, i] + A[4, 2] * k[2, i] + A[4, 3] * k[3, i]
        end[i] = x[i] + h * total
    stage_rates(core, t + C[4] * h, end, k[4])
    for i in range(n):
        total = A[5, 0] * k[0, i] + A[5, 1] * k[1, i] + A[5, 2] * k[2, i] + A[5, 3] * k[3, i]
        at[i] = x[i] + h * (total + A[5, 4] * k[4, i])
    stage_rates(core, t + h, at, k[5])
    for i in range(n):
        total = A[6, 0] * k[0, i] + A[6, 2] * k[2, i] + A[6, 3] * k[3, i] + A[6, 4] * k[4, i]
        end[i] = x[i] + h * (total + A[6, 5] * k[5, i])
    stage_rates(core, t + h, end, k[6])
    change = apart = 0.0
    for i in range(n):
        apart += (end[i] - at[i]) ** 2
        change += (k[6, i] - k[5, i]) ** 2
    into.ends[2] = h * math.sqrt(change / apart) if apart > 0.0 else 0.0
    inner = into.inner
    for i in range(n):
        into.rate_end[i] = k[6, i]
        error = E[0] * k[0, i] + E[2] * k[2, i] + E[3] * k[3, i] + E[4] * k[4, i]
        rest = D[0] * k[0, i] + D[2] * k[2, i] + D[3] * k[3, i] + D[4] * k[4, i]
        into.error[i] = h * (error + E[5] * k[5, i] + E[6] * k[6, i])
        rise = end[i] - x[i]
        inner[0, i] = h * rate[i] - rise
        inner[1, i] = rise - h * k[6, i] - inner[0, i]
        inner[2, i] = h * (rest + D[5] * k[5, i] + D[6] * k[6, i])


@unit
def bend(core: int, part: float) -> None:
    """The dense output of a trial whose end has moved and that is so many times as long as it was.

    Its first two numbers are those of a step to this end. The last one is of the fourth order.
    """
    trial = trial_of(core)
    inner, h = trial.inner, trial.ends[1]
    for i in range(len(trial.x)):
        rise = trial.x_end[i] - trial.x[i]
        inner[0, i] = h * trial.stages[0, i] - rise
        inner[1, i] = rise - h * trial.rate_end[i] - inner[0, i]
        inner[2, i] *= part


@unit
def defect(core: int, rtol: float, atol: Vector) -> float:
    """The norm of h*(p' - f(t, p)) over the tolerance, p the polynomial of the step, at its middle.

    It does not share the accidents of the estimate, such as those of a first step of the length of
    a forcing's period. It costs one evaluation.
    """
    trial = trial_of(core)
    inner, rate, at = trial.inner, trial.stages[1], trial.at
    inside(core, 0.5, at)
    stage_rates(core, trial.ends[0] + 0.5 * trial.ends[1], at, rate)
    for i in range(len(at)):
        slope = trial.x_end[i] - trial.x[i] + 0.25 * inner[1, i]
        trial.error[i] = slope - trial.ends[1] * rate[i]
    return norm(trial.error, trial.x, trial.x_end, rtol, atol)


@unit
def inside(core: int, theta: float, out: Vector) -> None:
    """The polynomial of degree 4 through both ends and both rates."""
    trial = trial_of(core)
    inner, back = trial.inner, 1.0 - theta
    for i in range(len(out)):
        bent = inner[0, i] + theta * (inner[1, i] + back * inner[2, i])
        rise = trial.x_end[i] - trial.x[i]
        out[i] = trial.x[i] + theta * (rise + back * bent)
