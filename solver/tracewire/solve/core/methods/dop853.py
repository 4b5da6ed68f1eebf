"""The explicit method of Dormand and Prince of order 8(5,3), with dense output of order 7.

Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, sections
II.5 and II.6.
"""

from __future__ import annotations

import math

from tracewire.solve.core.arrays import Matrix, Vector, trial_of
from tracewire.solve.core.flow import rates
from tracewire.solve.core.methods.dop853_coefficients import E3, E5, A, C, D
from tracewire.solve.core.methods.method import Method
from tracewire.solve.core.methods.trial import norm
from tracewire.solve.core.units import unit

MAIN, STAGES, INNER = 12, 16, 7
METHOD = Method(
    "dop853", STAGES, inner=INNER, bent=1, exponent=-1 / 8, safety=0.85, edge=6.1, nearby=1e-5
)
"""Of the tolerated error 0.85 to the power of 8 is 0.27, and 0.9 is 0.43. The edge is Hairer's."""
PROBE = 0.4  # of a step: there the polynomial's defect is about ten times the error of a good step


@unit
def _stage(core: int, t: float, x: Vector, h: float, stage: int, at: Vector, k: Matrix) -> None:
    for i in range(len(x)):
        total = 0.0
        for j in range(stage):
            total += A[stage, j] * k[j, i]
        at[i] = x[i] + h * total
    rates(core, t + C[stage] * h, at, k[stage])


@unit
def step(core: int, t: float, x: Vector, rate: Vector, h: float) -> None:
    """A trial step: twelve evaluations, the last is the rate at the end, and three more inside."""
    into = trial_of(core)
    n, k, inner = len(x), into.stages, into.inner
    k[0] = rate
    for stage in range(1, MAIN + 1):
        if stage == MAIN:
            into.error[:] = into.x_end
        _stage(core, t, x, h, stage, into.x_end, k)
    change = apart = 0.0
    for i in range(n):
        apart += (into.x_end[i] - into.error[i]) ** 2
        change += (k[MAIN, i] - k[MAIN - 1, i]) ** 2
    into.ends[2] = h * math.sqrt(change / apart) if apart > 0.0 else 0.0
    for stage in range(MAIN + 1, STAGES):
        _stage(core, t, x, h, stage, into.error, k)
    for i in range(n):
        into.rate_end[i] = k[MAIN, i]
        rise = into.x_end[i] - x[i]
        inner[0, i] = rise
        inner[1, i] = h * k[0, i] - rise
        inner[2, i] = 2 * rise - h * (k[MAIN, i] + k[0, i])
        for row in range(4):
            total = 0.0
            for j in range(STAGES):
                total += D[row, j] * k[j, i]
            inner[3 + row, i] = h * total
        into.error[i] = 0.0
        for j in range(MAIN + 1):
            into.error[i] += h * E5[j] * k[j, i]


@unit
def bend(core: int, part: float) -> None:
    """The dense output of a trial whose end has moved and that is so many times as long as it was.

    Its first three numbers are those of a step to this end. The others are of the fourth order.
    """
    trial = trial_of(core)
    inner, h = trial.inner, trial.ends[1]
    for i in range(len(trial.x)):
        rise = trial.x_end[i] - trial.x[i]
        inner[0, i] = rise
        inner[1, i] = h * trial.stages[0, i] - rise
        inner[2, i] = 2 * rise - h * (trial.rate_end[i] + trial.stages[0, i])
        for row in range(3, INNER):
            inner[row, i] *= part


@unit
def correction(core: int, rtol: float, atol: Vector) -> float:
    """What the norm of the error of order 5 is multiplied with to be an error of order 8."""
    trial = trial_of(core)
    fifth = third = 0.0
    for i in range(len(trial.x)):
        scale = atol[i] + rtol * max(abs(trial.x[i]), abs(trial.x_end[i]))
        total = 0.0
        for j in range(MAIN + 1):
            total += E3[j] * trial.stages[j, i]
        third += (trial.ends[1] * total / scale) ** 2
        fifth += (trial.error[i] / scale) ** 2
    return math.sqrt(fifth / (fifth + 0.01 * third)) if fifth > 0.0 else 0.0


@unit
def defect(core: int, rtol: float, atol: Vector) -> float:
    """The norm of h*(p' - f(t, p)) over the tolerance, p the polynomial of the step, in one point.

    `correction` is squared in the error of order 5: where that one is small by accident, at a step
    of twice a forcing's period, say, a step of 1000 times the tolerance is accepted. The defect
    does not share that accident. It costs one evaluation.
    """
    trial = trial_of(core)
    inner, rate, at = trial.inner, trial.stages[STAGES - 1], trial.at
    for i in range(len(at)):
        value = slope = 0.0
        for row in range(INNER - 1, -1, -1):
            value += inner[row, i]
            part, way = (PROBE, 1.0) if row % 2 == 0 else (1.0 - PROBE, -1.0)
            slope = slope * part + value * way
            value *= part
        at[i] = trial.x[i] + value
        trial.error[i] = slope
    rates(core, trial.ends[0] + PROBE * trial.ends[1], at, rate)
    for i in range(len(at)):
        trial.error[i] -= trial.ends[1] * rate[i]
    return norm(trial.error, trial.x, trial.x_end, rtol, atol)


@unit
def inside(core: int, theta: float, out: Vector) -> None:
    """The polynomial of degree 7."""
    trial = trial_of(core)
    inner, back = trial.inner, 1.0 - theta
    for i in range(len(out)):
        value = inner[6, i] * theta
        value = (value + inner[5, i]) * back
        value = (value + inner[4, i]) * theta
        value = (value + inner[3, i]) * back
        value = (value + inner[2, i]) * theta
        value = (value + inner[1, i]) * back
        out[i] = trial.x[i] + (value + inner[0, i]) * theta
