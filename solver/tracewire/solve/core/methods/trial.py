"""What every method fills in a trial step, and how its error is measured."""

from __future__ import annotations

import math

from tracewire.solve.core.arrays import Vector, trial_of
from tracewire.solve.core.flow import rates
from tracewire.solve.core.units import helper, unit


@helper
def norm(error: Vector, x: Vector, x_end: Vector, rtol: float, atol: Vector) -> float:
    """The root mean square of error/(atol + rtol*max(|x|, |x_end|)); NaN where it is not finite."""
    total = 0.0
    for i in range(len(x)):
        part = error[i] / (atol[i] + rtol * max(abs(x[i]), abs(x_end[i])))
        total += part * part
    return math.sqrt(total / max(len(x), 1))


@unit
def move_end(core: int, change: float) -> None:
    """Let the trial be longer by so little that the trapezoidal rule is exact but for rounding.

    It costs one evaluation. The dense output is not moved: each method does that with its own.
    """
    trial = trial_of(core)
    end, rate, at, further = trial.x_end, trial.rate_end, trial.at, trial.stages[1]
    trial.ends[1] += change
    for i in range(len(end)):
        at[i] = end[i] + change * rate[i]
    rates(core, trial.ends[0] + trial.ends[1], at, further)
    for i in range(len(end)):
        end[i] += 0.5 * change * (rate[i] + further[i])
        rate[i] = further[i]
