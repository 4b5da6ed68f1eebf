"""Independent solution of paper B's triple physical pendulum under a square-wave torque.

    M(psi) psi'' + N(psi) (psi_i'^2) + C psi' + p(psi) = [f_e(t), 0, 0]

f_e is -q in the first half period of the torque and changes its sign in every other; the run is
integrated from one switch to the next, so that nothing jumps within a segment.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]

# Paper B, Eq 6, in kg m2, N m and N m s; B1 and M1 are lost in the print and inferred.
PARAMETERS = {
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
STATES = ("psi1", "psi2", "psi3", "psi1_dot", "psi2_dot", "psi3_dot")


def solve(
    times: ArrayLike,
    f: float,
    parameters: Mapping[str, float] | None = None,
    start: ArrayLike = (0.0,) * 6,
    begin: float = 0.0,
    rtol: float = 1e-11,
    atol: float = 1e-12,
) -> Array:
    """The states (6, N) at ascending times (N,) in s, from `start` (6,) at `begin`.

    f: frequency of the torque in Hz. parameters: values in SI in place of the paper's.
    """
    p = PARAMETERS | dict(parameters or {})
    inertia = np.array(
        [
            [p["B1"], p["N12"], p["N13"]],
            [p["N12"], p["B2"], p["N23"]],
            [p["N13"], p["N23"], p["B3"]],
        ]
    )
    c1, c2, c3 = p["c1"], p["c2"], p["c3"]
    damping = np.array([[c1 + c2, -c2, 0.0], [-c2, c2 + c3, -c3], [0.0, -c3, c3]])
    weights = np.array([p["M1"], p["M2"], p["M3"]])

    def rates(t: float, y: Array, torque: float) -> Array:
        psi, w = y[:3], y[3:]
        between = psi[:, None] - psi[None, :]
        right = -(inertia * np.sin(between)) @ w**2 - damping @ w - weights * np.sin(psi)
        right[0] += torque
        return np.concatenate([w, np.linalg.solve(inertia * np.cos(between), right)])

    samples = np.asarray(times, dtype=float)
    out = np.empty((6, samples.size))
    y, t, filled = np.array(start, dtype=float), float(begin), 0
    half = 0.5 / f
    number = int(np.floor(t / half + 1e-9))
    while filled < samples.size:
        end = min((number + 1) * half, float(samples[-1]))
        here = samples[filled:][samples[filled:] <= end]
        if end > t:
            torque = p["q"] if number % 2 else -p["q"]
            run: Any = solve_ivp(
                rates,
                (t, end),
                y,
                method="DOP853",
                t_eval=np.append(here[here < end], end),
                args=(torque,),
                rtol=rtol,
                atol=atol,
            )
            if not run.success:
                raise RuntimeError(f"segment from t={t}: {run.message}")
            out[:, filled : filled + here.size] = run.y[:, : here.size]
            y = run.y[:, -1]
        else:
            out[:, filled : filled + here.size] = y[:, None]
        filled += here.size
        t, number = end, number + 1
    return out
