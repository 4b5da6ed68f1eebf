"""What every method fills in a trial step, and how its error is measured."""

from __future__ import annotations

import math

from tracewire.solve.core.arrays import Vector
from tracewire.solve.core.units import helper


@helper
def norm(error: Vector, x: Vector, x_end: Vector, rtol: float, atol: Vector) -> float:
    """The root mean square of error/(atol + rtol*max(|x|, |x_end|)); NaN where it is not finite."""
    total = 0.0
    for i in range(len(x)):
        part = error[i] / (atol[i] + rtol * max(abs(x[i]), abs(x_end[i])))
        total += part * part
    return math.sqrt(total / max(len(x), 1))
