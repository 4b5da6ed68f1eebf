"""The classical method of Runge and Kutta, order 4, with steps of a fixed length.

It reproduces papers that were computed with it. It has no error estimate; inside a step stands the
cubic through both ends and both rates. Source: Hairer, Norsett, Wanner, Solving Ordinary
Differential Equations I, 2nd edition, sections II.1 and II.6.
"""

from __future__ import annotations

from tracewire.solve.core.arrays import Vector, trial_of
from tracewire.solve.core.flow import rates
from tracewire.solve.core.methods.method import Method
from tracewire.solve.core.units import unit

METHOD = Method("rk4", stages=4, inner=3, fixed=True)


@unit
def step(core: int, t: float, x: Vector, rate: Vector, h: float) -> None:
    """A step: four evaluations, and one for the rate at the end."""
    into = trial_of(core)
    k, at, inner = into.stages, into.error, into.inner
    k[0] = rate
    for stage in range(1, 4):
        part = h if stage == 3 else 0.5 * h
        at[:] = x + part * k[stage - 1]
        rates(core, t + part, at, k[stage])
    into.x_end[:] = x + h / 6 * (k[0] + 2 * k[1] + 2 * k[2] + k[3])
    rates(core, t + h, into.x_end, into.rate_end)
    for i in range(len(x)):
        rise = into.x_end[i] - x[i]
        inner[0, i] = h * rate[i] - rise
        inner[1, i] = rise - h * into.rate_end[i] - inner[0, i]
        inner[2, i] = 0.0
        # no estimate: only what is not finite is an error
        into.error[i] = 0.0 * (into.x_end[i] + into.rate_end[i])
    into.ends[2] = 0.0
