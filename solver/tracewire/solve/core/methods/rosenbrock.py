"""The L-stable, stiffly accurate Rosenbrock method Rodas5P, order 5(4), dense output of order 4.

Source: Steinebach, Construction of Rosenbrock-Wanner method Rodas5P and numerical benchmarks
within the Julia Differential Equations package, BIT Numerical Mathematics 63:27, 2023.
"""

from __future__ import annotations

import numpy as np

from tracewire.solve.core.arrays import Vector, copy, progress_of, trial_of
from tracewire.solve.core.flow import jacobian, stage_rates
from tracewire.solve.core.linear import factor, substitute, towards_one
from tracewire.solve.core.methods.method import Method
from tracewire.solve.core.units import inlined, unit

METHOD = Method("rosenbrock", stages=8, inner=3, implicit=True)

GAMMA = 0.21193756319429014
C = (
    0.0,
    0.6358126895828704,
    0.4095798393397535,
    0.9769306725060716,
    0.4288403609558664,
    1.0,
    1.0,
    1.0,
)
D = (
    GAMMA,
    -0.42387512638858027,
    -0.3384627126235924,
    1.8046452872882734,
    2.325825639765069,
    0.0,
    0.0,
    0.0,
)
A = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [2.849394379747939, 0.45842242204463923, 0.0, 0.0, 0.0, 0.0, 0.0],
        [-6.954028509809101, 2.489845061869568, -10.358996098473584, 0.0, 0.0, 0.0, 0.0],
        [
            2.8029986275628964,
            0.5072464736228206,
            -0.3988312541770524,
            -0.04721187230404641,
            0.0,
            0.0,
            0.0,
        ],
        [
            -7.502846399306121,
            2.561846144803919,
            -11.627539656261098,
            -0.18268767659942256,
            0.030198172008377946,
            0.0,
            0.0,
        ],
        [
            -7.502846399306121,
            2.561846144803919,
            -11.627539656261098,
            -0.18268767659942256,
            0.030198172008377946,
            1.0,
            0.0,
        ],
        [
            -7.502846399306121,
            2.561846144803919,
            -11.627539656261098,
            -0.18268767659942256,
            0.030198172008377946,
            1.0,
            1.0,
        ],
    ]
)
COUPLING = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [-14.155112264123755, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [-17.97296035885952, -2.859693295451294, 0.0, 0.0, 0.0, 0.0, 0.0],
        [147.12150275711716, -1.41221402718213, 71.68940251302358, 0.0, 0.0, 0.0, 0.0],
        [
            165.43517024871676,
            -0.4592823456491126,
            42.90938336958603,
            -5.961986721573306,
            0.0,
            0.0,
            0.0,
        ],
        [
            24.854864614690072,
            -3.0009227002832186,
            47.4931110020768,
            5.5814197821558125,
            -0.6610691825249471,
            0.0,
            0.0,
        ],
        [
            30.91273214028599,
            -3.1208243349937974,
            77.79954646070892,
            34.28646028294783,
            -19.097331116725623,
            -28.087943162872662,
            0.0,
        ],
        [
            37.80277123390563,
            -3.2571969029072276,
            112.26918849496327,
            66.9347231244047,
            -40.06618937091002,
            -54.66780262877968,
            -9.48861652309627,
        ],
    ]
)
INSIDE = np.array(
    [
        [
            25.948786856663858,
            -2.5579724845846235,
            10.433815404888879,
            -2.3679251022685204,
            0.524948541321073,
            1.1241088310450404,
            0.4272876194431874,
            -0.17202221070155493,
        ],
        [
            -9.91568850695171,
            -0.9689944594115154,
            3.0438037242978453,
            -24.495224566215796,
            20.176138334709044,
            15.98066361424651,
            -6.789040303419874,
            -6.710236069923372,
        ],
        [
            11.419903575922262,
            2.8879645146136994,
            72.92137995996029,
            80.12511834622643,
            -52.072871366152654,
            -59.78993625266729,
            -0.15582684282751913,
            4.883087185713722,
        ],
    ]
)


@unit
def step(core: int, t: float, x: Vector, rate: Vector, h: float) -> None:
    """A trial step: one Jacobian, one factorisation and eight solutions."""
    into = trial_of(core)
    n = len(x)
    stages, at, matrix, factors = into.stages, into.x_end, into.matrix, into.factors
    jacobian(core, t, x, matrix)
    sizes, scales = progress_of(core).sizes, into.error
    for i in range(n):  # each row in the unit of its state: a pivot is large beside its neighbours
        scales[i] = towards_one(max(abs(x[i]), sizes[n + i]))
        for j in range(n):
            factors[i, j] = -matrix[i, j] * scales[i]
        factors[i, i] += scales[i] / (GAMMA * h)
    into.ends[2] = 0.0
    if factor(factors, into.pivots) == 0.0:
        into.error[:] = np.nan
        into.x_end[:] = np.nan
        return
    slope = into.rate_end
    copy(x, at)
    copy(rate, slope)
    _stage(core, 0, t, x, h)
    _stage(core, 1, t, x, h)
    _stage(core, 2, t, x, h)
    _stage(core, 3, t, x, h)
    _stage(core, 4, t, x, h)
    _stage(core, 5, t, x, h)
    _stage(core, 6, t, x, h)
    _stage(core, 7, t, x, h)
    for i in range(n):
        into.error[i] = stages[7, i]
        at[i] += stages[7, i]
        for row in range(3):
            total = 0.0
            for k in range(8):
                total += INSIDE[row, k] * stages[k, i]
            into.inner[row, i] = total


@inlined
def _stage(core: int, stage: int, t: float, x: Vector, h: float) -> None:
    """One stage, built in with its number: a loop over the numbers would not be unrolled."""
    into = trial_of(core)
    n = len(x)
    stages, at, slope = into.stages, into.x_end, into.rate_end
    if stage:
        for i in range(n):
            total = 0.0
            for k in range(stage):
                total += A[stage, k] * stages[k, i]
            at[i] = x[i] + total
        stage_rates(core, t + C[stage] * h, at, slope)
    for i in range(n):
        total = 0.0
        for k in range(stage):
            total += COUPLING[stage, k] * stages[k, i]
        total = slope[i] + total / h + h * D[stage] * into.matrix[i, n]
        stages[stage, i] = total * into.error[i]  # the scale of the row
    substitute(into.factors, into.pivots, stages[stage])


@unit
def inside(core: int, theta: float, out: Vector) -> None:
    """The polynomial of degree 4 of the dense output."""
    trial = trial_of(core)
    inner, back = trial.inner, 1.0 - theta
    for i in range(len(out)):
        bent = inner[0, i] + theta * (inner[1, i] + theta * inner[2, i])
        out[i] = back * trial.x[i] + theta * (trial.x_end[i] + back * bent)
