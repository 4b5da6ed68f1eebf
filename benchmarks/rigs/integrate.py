"""Motion in time by the classical method of Runge and Kutta, also with dry friction that sticks."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
State = Sequence[float]
Field = Callable[[float, State], Sequence[float]]
"""The rates of the states at a time [s]."""
Hook = Callable[[int, State], None]
"""What a controller does at a sample, of which it gets the number and the states."""
Levels = Callable[[float, State], tuple[float, float]]
"""Of dry friction at a time [s], while the rate is above zero and below it."""

MOST_PIECES = 20
"""Of one step: reversals, sticking and breaking loose."""
SHORTEST_STEP = 1e-13
"""In s: what is left of a step is taken for done below it."""
BISECTIONS = 45


def runge_kutta(field: Field, t: float, y: State, h: float) -> list[float]:
    """The states one step of `h` seconds after `t`, by the method of fourth order."""
    a = field(t, y)
    b = field(t + h / 2, [p + h / 2 * q for p, q in zip(y, a, strict=True)])
    c = field(t + h / 2, [p + h / 2 * q for p, q in zip(y, b, strict=True)])
    d = field(t + h, [p + h * q for p, q in zip(y, c, strict=True)])
    return [
        p + h / 6 * (q + 2 * r + 2 * s + w) for p, q, r, s, w in zip(y, a, b, c, d, strict=True)
    ]


def march(
    field: Field, y: State, interval: float, samples: int, steps: int, hook: Hook | None = None
) -> Array:
    """The states (samples, n) every `interval` seconds, with `steps` steps between two samples."""
    y = list(y)
    out = [list(y)]
    if hook:
        hook(0, y)
    h = interval / steps
    for k in range(1, samples):
        for s in range(steps):
            y = runge_kutta(field, (k - 1) * interval + s * h, y, h)
        if hook:
            hook(k, y)
        out.append(list(y))
    return np.array(out)


def march_dry(
    smooth: Field,
    levels: tuple[float, float] | Levels,
    rate: int,
    y: State,
    interval: float,
    samples: int,
    steps: int,
    hook: Hook | None = None,
) -> Array:
    """The states (samples, n) every `interval` seconds, with dry friction on the state `rate`.

    The friction takes levels[0] from the acceleration while the rate is above zero, and adds
    levels[1] while it is below zero. The side (1, -1, or 0 where friction holds the rate at zero)
    is the same all through a step; a reversal is found by bisection, and ends the step there.
    `levels` may depend on the time and the states.
    """

    def level(t: float, y: State) -> tuple[float, float]:
        return levels(t, y) if callable(levels) else levels

    def field_of(side: int) -> Field:
        def field(t: float, y: State) -> list[float]:
            rates = list(smooth(t, y))
            if side > 0:
                rates[rate] -= level(t, y)[0]
            elif side < 0:
                rates[rate] += level(t, y)[1]
            else:
                rates[rate] = 0.0
            return rates

        return field

    def side_from_rest(t: float, y: State) -> int:
        a = smooth(t, y)[rate]
        up, down = level(t, y)
        return 1 if a > up else -1 if a < -down else 0

    fields = {side: field_of(side) for side in (1, -1, 0)}
    y = list(y)
    if hook:
        hook(0, y)
    side = 1 if y[rate] > 0 else -1 if y[rate] < 0 else side_from_rest(0.0, y)
    out = [list(y)]
    h = interval / steps
    for k in range(1, samples):
        for s in range(steps):
            t, left = (k - 1) * interval + s * h, h
            for _ in range(MOST_PIECES):
                if left <= SHORTEST_STEP:
                    break
                if side == 0:
                    side = side_from_rest(t, y)
                new = runge_kutta(fields[side], t, y, left)
                if side == 0:
                    new[rate] = 0.0
                if new[rate] * side >= 0:
                    y, t, left = new, t + left, 0.0
                    continue
                done = reversal(fields[side], side, rate, t, y, left)
                y = runge_kutta(fields[side], t, y, done)
                y[rate] = 0.0
                t, left = t + done, left - done
                side = side_from_rest(t, y)
        if hook:
            hook(k, y)
        out.append(list(y))
    return np.array(out)


def reversal(field: Field, side: int, rate: int, t: float, y: State, left: float) -> float:
    """The seconds after `t`, at most `left`, in which the rate still has the sign of `side`."""
    low, high = 0.0, left
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        if runge_kutta(field, t, y, middle)[rate] * side >= 0:
            low = middle
        else:
            high = middle
    return low
