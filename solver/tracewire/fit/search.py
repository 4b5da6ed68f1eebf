"""The two ways to the minimum of a criterion: Scilab's simplex, and least squares."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tracewire.fit.criterion import Criterion
from tracewire.fit.descent import Descent, descend
from tracewire.fit.fminsearch import fminsearch
from tracewire.fit.optimset import OptimValues, Options, optimset

Vector = NDArray[np.float64]
GROWING = ((0.2, 6), (0.5, 6), (1.0, 20))
"""Parts of each series and the most steps on them, for least squares."""
LEAST_SAMPLES = 10


@dataclass(frozen=True)
class Progress:
    """How far a fit is: evaluations of the model, best criterion, seconds spent and still to go.

    `remaining` is what the limits still allow; a search that converges is done before.
    """

    evaluations: int
    best: float
    seconds: float
    remaining: float


@dataclass(frozen=True, eq=False)
class Ended:
    """Where a search ended, in scaled unknowns, and why."""

    z: Vector
    iterations: int
    exitflag: int
    message: str


def by_simplex(
    criterion: Criterion, options: Options | None, progress: Callable[[Progress], None] | None
) -> Ended:
    """The minimum by `fminsearch`, on the values as the user knows them; infinite out of bounds."""
    chosen = options or optimset(Display="off")
    low, high = criterion.bounds()
    first = criterion.begin() * criterion.scales
    began = time.perf_counter()

    def fun(x: Vector) -> float:
        z = x / criterion.scales
        return criterion.value(z) if np.all((z >= low) & (z <= high)) else np.inf

    def report(x: Vector, values: OptimValues, state: str) -> bool:
        if progress is not None and state == "iter":
            share = max(
                values.funccount / chosen.evaluations(len(first)),
                values.iteration / chosen.iterations(len(first)),
            )
            progress(_progress(criterion, values.fval, share, began))
        return False

    watched = replace(chosen, OutputFcn=[*chosen.output_functions(), report])
    found = fminsearch(fun, first, watched)
    z = np.clip(np.asarray(found.x) / criterion.scales, low, high)
    return Ended(z, found.output.iterations, found.exitflag, found.output.message)


def by_least_squares(criterion: Criterion, progress: Callable[[Progress], None] | None) -> Ended:
    """Least squares over a growing part of each series, so that long records do not lead astray.

    Where they did, the whole series are tried from the start.
    """
    began = time.perf_counter()
    allowed = sum(most for _, most in GROWING)
    first = z = criterion.begin()
    before = criterion.value(first)
    taken = 0

    def descended(stage: Criterion, begin: Vector, steps: int, tolerance: float) -> Descent:
        best, earlier = np.inf, criterion.evaluations if stage is not criterion else 0

        def told(value: float) -> None:
            nonlocal best, taken
            best, taken = min(best, value), taken + 1
            if progress is not None:
                now = _progress(stage, best, min(taken / allowed, 1.0), began)
                progress(replace(now, evaluations=earlier + stage.evaluations))

        return descend(stage, _mean_square, steps, tolerance, begin, told)

    for part, steps in GROWING[:-1]:
        stage = _shortened(criterion, part)
        z = descended(stage, z, steps, 1e-2).z
        criterion.evaluations += stage.evaluations
    steps = GROWING[-1][1]
    ended = descended(criterion, z, steps, 1e-5)
    if ended.after > 0.5 * before:
        again = descended(criterion, first, steps, 1e-5)
        ended = again if again.after < ended.after else ended
    message = "converged" if ended.converged else f"stopped at the limit of {steps} steps"
    return Ended(ended.z, taken, int(ended.converged), message)


def _shortened(criterion: Criterion, part: float) -> Criterion:
    """The criterion on the first part of each of its segments."""
    segments = [
        replace(s, rows=s.rows[: max(int(len(s.rows) * part), LEAST_SAMPLES)])
        for s in criterion.segments
    ]
    return criterion.on(segments)


def _mean_square(count: int) -> float:
    """The weight of a residual by which half the sum of squares is the criterion."""
    return float(1 / np.sqrt(count))


def _progress(criterion: Criterion, best: float, share: float, began: float) -> Progress:
    spent = time.perf_counter() - began
    remaining = spent * (1 / share - 1) if share > 0 else np.inf
    return Progress(criterion.evaluations, best, spent, max(remaining, 0.0))
