"""`rises`: when a wave rises through its middle, also where it decays, grows or is off zero."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tracewire.analyse.signal import vertex
from tracewire.array_types import Vector

Indices = NDArray[np.int64]


def rises(t: Vector, values: Vector, floor: Vector) -> Vector:
    """The times at which a wave rises through its middle; NaN where `floor` (N,) hides it.

    The waves are those about the mean. The middle of each follows from three turning points, as
    that of exp(r t) cos(w t) + c is c: the mean of such a wave is not, and a rise through the mean
    is late or early by a part of the period that changes as the wave decays.
    """
    off = values - values.mean()
    above = off >= 0
    first = np.concatenate([[0], np.flatnonzero(above[1:] != above[:-1]) + 1])
    turn = _turning_points(np.abs(off), first)
    middle = _middles(off, turn)
    found = []
    for n in np.flatnonzero(above[first[1:]]).tolist():
        low, high = int(turn[n]), int(turn[n + 1])
        if off[high] - off[low] <= 2 * floor[high]:
            found.append(np.nan)
            continue
        part = off[low : high + 1] - middle[n]
        up = np.flatnonzero((part[:-1] < 0) & (part[1:] >= 0))
        if len(up):
            k, a, b = low + up[0], part[up[0]], part[up[0] + 1]
            found.append(float(t[k] + a / (a - b) * (t[k + 1] - t[k])))
    return np.array(found)


def _turning_points(size: Vector, first: Indices) -> Indices:
    """The sample farthest from the mean in each half wave, of which the first samples are given."""
    ends = [*first[1:].tolist(), len(size)]
    pairs = zip(first.tolist(), ends, strict=True)
    return np.array([begin + int(np.argmax(size[begin:end])) for begin, end in pairs])


def _middles(off: Vector, turn: Indices) -> Vector:
    """The middle of the wave at each turning point but the last."""
    inside = (turn > 0) & (turn < len(off) - 1)  # the record's ends are none
    whole = turn[inside]
    if len(whole) < 3:
        return np.full(max(len(turn) - 1, 0), off[whole].mean() if len(whole) == 2 else 0.0)
    low, at, high = off[whole - 1], off[whole], off[whole + 1]
    sign = np.sign(at)
    top = at - 0.25 * (low - high) * vertex(sign * low, sign * at, sign * high)
    before, after = top[:-2] - top[1:-1], top[2:] - top[1:-1]
    middle = top[1:-1] + before * after / (before + after)
    number = np.cumsum(inside) - 2  # of the three about each turning point
    chosen: Vector = middle[np.clip(number[:-1], 0, len(middle) - 1)]
    return chosen
