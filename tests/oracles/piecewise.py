"""Exact piecewise solutions of systems with dry friction and impacts, to judge the product.

Between two events each of these has a closed solution (a line, a parabola, a circle), and the
events are roots of it; nothing is integrated. Written on numpy alone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike, NDArray

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Oscillator:
    """x'' = -x - friction (slip, stick) from rest at x0: half circles about +-slip, each of pi s.

    `turns` are the positions at 0, pi, 2 pi, ...; at the last one the mass stays.
    """

    turns: tuple[float, ...]
    slip: float

    @property
    def reversals(self) -> list[float]:
        """The times at which the rate is zero and the mass goes on."""
        return [math.pi * n for n in range(1, len(self.turns) - 1)]

    @property
    def rest(self) -> float:
        """The time from which the mass is held."""
        return math.pi * (len(self.turns) - 1)

    def x(self, times: ArrayLike) -> Vector:
        """The position at each time."""
        last = len(self.turns) - 1
        found = []
        for t in np.ravel(times):
            n = min(int(t // math.pi), last)
            turn = self.turns[n]
            centre = math.copysign(self.slip, turn)
            found.append(
                turn if n == last else centre + (turn - centre) * math.cos(t - math.pi * n)
            )
        return np.array(found)


def oscillator(x0: float, slip: float, stick: float | None = None) -> Oscillator:
    """The mass on a spring, m = k = 1, with dry friction."""
    turns = [x0]
    while abs(turns[-1]) > (slip if stick is None else stick):
        turns.append(-turns[-1] + 2 * math.copysign(slip, turns[-1]))
    return Oscillator(tuple(turns), slip)


@dataclass(frozen=True)
class Ball:
    """A ball dropped from rest at a height: parabolas whose flights shrink by the restitution."""

    height: float
    restitution: float
    g: float = 9.81

    @property
    def fall(self) -> float:
        """The time of the first impact."""
        return math.sqrt(2 * self.height / self.g)

    @property
    def rest(self) -> float:
        """The limit of the impacts' times."""
        return self.fall * (1 + self.restitution) / (1 - self.restitution)

    def impacts(self, count: int) -> list[float]:
        """The times of the first impacts."""
        e = self.restitution
        return [self.fall * (1 + 2 * sum(e**k for k in range(1, n + 1))) for n in range(count)]

    def x(self, times: ArrayLike) -> Vector:
        """The height at each time."""
        found = []
        for t in np.ravel(times):
            if t >= self.rest:
                found.append(0.0)
                continue
            since, flight = t + self.fall, 2 * self.fall  # as if thrown up one fall before
            while since > flight > 1e-12:
                since, flight = since - flight, flight * self.restitution
            found.append(max(0.5 * self.g * since * (flight - since), 0.0))
        return np.array(found)


def meissner(times: ArrayLike, omega: float, depth: float) -> Vector:
    """States (N, 2) of x'' = -(1 + depth*sgn sin(omega t)) x from (1, 0): products of rotations."""
    half = math.pi / omega

    def turned(state: Vector, dt: float, sign: float) -> Vector:
        w = math.sqrt(1 + depth * sign)
        c, s = math.cos(w * dt), math.sin(w * dt)
        return np.array([[c, s / w], [-w * s, c]]) @ state

    found = []
    for t in np.ravel(times):
        state, sign, left = np.array([1.0, 0.0]), 1.0, float(t)
        while left > half:
            state, sign, left = turned(state, half, sign), -sign, left - half
        found.append(turned(state, left, sign))
    return np.array(found)


def stick_slip(speed: float, slip: float, stick: float, count: int) -> list[tuple[float, float]]:
    """(breakaway, stop) of the first slips of a mass drawn by a spring whose end moves at `speed`.

    m = k = 1; from rest with a loose spring. While it slips, the spring's length u has
    u - slip = (stick - slip) cos s + speed sin s, and the mass stops where u' = speed again.
    """
    lasting = 2 * math.pi - 2 * math.atan2(stick - slip, speed)
    waiting = 2 * (stick - slip) / speed
    begins = [stick / speed + n * (lasting + waiting) for n in range(count)]
    return [(begin, begin + lasting) for begin in begins]


@dataclass(frozen=True)
class Blocks:
    """Two blocks, the upper (1) on the lower (2) on the ground; each friction (slip, stick).

    m1 v1' = F1 + f, m2 v2' = F2 - f + h, where f opposes v1 - v2 and h opposes v2; the forces are
    lines (value at t = 0, slope) in t.
    """

    between: tuple[float, float]
    ground: tuple[float, float]
    rates: tuple[float, float] = (0.0, 0.0)
    masses: tuple[float, float] = (1.0, 1.0)
    forces: tuple[tuple[float, float], tuple[float, float]] = ((0.0, 0.0), (0.0, 0.0))

    def solve(self, end: float) -> Slides:
        """The exact solution from 0 to `end`."""
        return _solve(self, end)


@dataclass
class Slides:
    """Events (time, kind, surface), and pieces (begin, curves of v1, v2, x1, x2 in t - begin)."""

    events: list[tuple[float, str, str]] = field(default_factory=list)
    pieces: list[tuple[float, list[Polynomial]]] = field(default_factory=list)

    def states(self, times: ArrayLike) -> Vector:
        """v1, v2, x1, x2 at each time (N, 4)."""
        found = []
        for t in np.ravel(times):
            begin, curves = next(piece for piece in reversed(self.pieces) if piece[0] <= t)
            found.append([curve(t - begin) for curve in curves])
        return np.array(found)


Modes = tuple[int, int]
"""For the surfaces between and ground: +1 or -1 for the sign of the slip, 0 where it is held."""
ROUNDING = 1e-12


def _frictions(blocks: Blocks, forces: list[Polynomial], on: Modes) -> list[Polynomial]:
    """f and h [N] for these modes, as lines in the time."""
    (m1, m2), (F1, F2) = blocks.masses, forces
    f = Polynomial([-blocks.between[0] * on[0]])
    h = Polynomial([-blocks.ground[0] * on[1]])
    if on == (0, 0):
        f, h = -F1, -F1 - F2
    elif on[0] == 0:  # both move together
        f = (F1 + F2 + h) * (m1 / (m1 + m2)) - F1
    elif on[1] == 0:
        h = f - F2
    return [f, h]


def _rates(blocks: Blocks, forces: list[Polynomial], on: Modes) -> list[Polynomial]:
    """The rates of v1 - v2 and of v2."""
    f, h = _frictions(blocks, forces, on)
    a1 = (forces[0] + f) / blocks.masses[0]
    a2 = (forces[1] - f + h) / blocks.masses[1]
    return [a1 - a2, a2]


def _lasts(line: Polynomial) -> bool:
    """Whether a line is positive just after 0."""
    value, slope = (*line.coef, 0.0)[:2]
    return bool(value > ROUNDING or (abs(value) <= ROUNDING and slope > 0))


def _modes(blocks: Blocks, forces: list[Polynomial], slips: Sequence[float]) -> Modes:
    """The modes from now on; of several that are possible the one that holds most surfaces."""
    choices = [(0, 1, -1) if slip == 0.0 else (int(math.copysign(1, slip)),) for slip in slips]
    sticks = (blocks.between[1], blocks.ground[1])
    for on in sorted(product(*choices), key=lambda on: sum(map(abs, on))):
        frictions = _frictions(blocks, forces, on)
        rates = _rates(blocks, forces, on)
        possible = True
        for s, slip, stick, friction, rate in zip(on, slips, sticks, frictions, rates, strict=True):
            if s == 0:
                lines = [stick - friction, stick + friction]
                possible &= all(_lasts(line) or not _lasts(-line) for line in lines)
            elif slip == 0.0:
                possible &= _lasts(s * rate)
        if possible:
            return on
    raise AssertionError("one of the modes is always possible")


def _first_root(curve: Polynomial) -> float:
    """The first time after 0 at which a curve that is positive just after 0 reaches zero."""
    coefficients = np.where(np.abs(curve.coef) < ROUNDING, 0.0, curve.coef)
    (filled,) = np.nonzero(coefficients)
    if not len(filled):
        return math.inf
    roots = Polynomial(coefficients[filled[0] : filled[-1] + 1]).roots()  # but those at 0
    return min((float(r.real) for r in roots if r.imag == 0 and r.real > 0), default=math.inf)


def _solve(blocks: Blocks, end: float) -> Slides:
    out = Slides()
    t, on = 0.0, None
    v1, v2 = blocks.rates
    x1 = x2 = 0.0
    while True:
        forces = [Polynomial([value + slope * t, slope]) for value, slope in blocks.forces]
        after = _modes(blocks, forces, (v1 - v2, v2))
        for was, now, name in zip(on or after, after, ("between", "ground"), strict=True):
            if was != now:
                kind = "slip" if was == 0 else "stick" if now == 0 else "crossing"
                out.events.append((t, kind, name))
        on = after
        relative, ground = _rates(blocks, forces, on)
        w2 = ground.integ(1, [v2])
        slips = (relative.integ(1, [v1 - v2]), w2)
        w1 = w2 + slips[0]
        curves = [w1, w2, w1.integ(1, [x1]), w2.integ(1, [x2])]
        out.pieces.append((t, curves))
        frictions, sticks = _frictions(blocks, forces, on), (blocks.between[1], blocks.ground[1])
        stops, breaks = [math.inf, math.inf], [math.inf]
        for k, slip in enumerate(slips):
            if on[k]:
                stops[k] = _first_root(on[k] * slip)
            else:
                breaks += [_first_root(sticks[k] - s * frictions[k]) for s in (1, -1)]
        dt = min(*stops, *breaks)
        if t + dt > end:
            return out
        t += dt
        v1, v2, x1, x2 = (float(curve(dt)) for curve in curves)
        if on[1] == 0 or stops[1] - dt < ROUNDING:
            v2 = 0.0
        if on[0] == 0 or stops[0] - dt < ROUNDING:
            v1 = v2
