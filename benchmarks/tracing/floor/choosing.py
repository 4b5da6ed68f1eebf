"""The shape of a floor: drawn until no law of the library passes for it, to first order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.signal import bilinear, lfilter

from benchmarks.tracing.floor.rivals import Laws, responses, shares
from benchmarks.tracing.floor.unmodelled import Bumps, Drift, Floor, Mode, Part, Relaxation
from benchmarks.tracing.floor.windows import Array, Trajectory

TRIES = 300
LIKE_A_LAW, AT_MOST = 0.3, 0.37
"""Of the floor: what a law of the library may explain, to first order, and where none is found."""
ABSORBED = 0.01
"""Of a part's response in squares: what starts and free parameters must leave."""


class Unfit(Exception):
    """This draw makes no case."""


def choose_floor(
    laws: Laws, data: Trajectory, parts: Sequence[Part], rss: float, rng: np.random.Generator
) -> Floor:
    """A random mix of some parts whose response has about the sum of squares `rss`."""
    columns, kept = responses(laws, [force_along(part, data) for part in parts])
    able = np.flatnonzero(kept > ABSORBED)
    if len(able) < 3:
        raise Unfit("the declared model explains the floor")
    norms = np.linalg.norm(columns[:, able], axis=0)
    least, best = np.inf, np.zeros(len(able))
    for _ in range(TRIES):
        weights = rng.standard_normal(len(able)) * (rng.random(len(able)) < 0.7) / norms
        if not np.any(weights):
            continue
        taken = max(shares(laws, columns[:, able] @ weights).values())
        if taken < least:
            least, best = taken, weights
        if least < LIKE_A_LAW:
            break
    if least > AT_MOST:
        raise Unfit(f"a law explains {least:.2f} of the floor")
    best = best * np.sqrt(rss) / np.linalg.norm(columns[:, able] @ best)
    chosen = [
        replace(parts[k], size=parts[k].size * float(w))
        for k, w in zip(able.tolist(), best, strict=True)
        if w
    ]
    return Floor(1.0, tuple(chosen))


def force_along(part: Part, data: Trajectory) -> Array:
    """The force of a part along a motion, series by series."""
    found = np.empty_like(data.q)
    ends = (*data.first[1:], len(data.t))
    for series, (first, end) in enumerate(zip(data.first, ends, strict=True)):
        rows = slice(first, end)
        found[rows] = part.size * _along(
            part, data.t[rows], data.q[rows], data.v[rows], data.half, series
        )
    return found


def _along(part: Part, t: Array, q: Array, v: Array, step: float, series: int) -> Array:
    if isinstance(part, Bumps):
        waves = (
            w * np.exp(-(((q - a) * p) ** 2) - ((v - b) * r) ** 2) for w, a, p, b, r in part.places
        )
        return np.asarray(sum(waves))
    if isinstance(part, Drift):
        own = zip(part.weights, part.omegas, part.phases[series], strict=True)
        return np.asarray(sum(a * np.sin(w * t + p) for a, w, p in own))
    x = q - q[0]
    if isinstance(part, Relaxation):
        b, a = bilinear([1.0], [part.tau, 1.0], 1 / step)
        return np.asarray(lfilter(b, a, x) - x)
    assert isinstance(part, Mode)
    force = np.zeros_like(q)
    for sign, omega in ((1.0, part.omega), (-1.0, part.stiff * part.omega)):
        damping = 2 * part.zeta * omega
        b, a = bilinear([damping, omega**2], [1.0, damping, omega**2], 1 / step)
        force += sign * omega**2 * (lfilter(b, a, x) - x)
    return force
