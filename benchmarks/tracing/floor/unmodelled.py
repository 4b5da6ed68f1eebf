"""The floor: smooth forces that are no block of the library, mixed, and scaled by one size."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.tracing.laws import At

KINDS = ("drift", "mode", "relaxation")  # beside bumps


@dataclass(frozen=True)
class Bumps:
    """A smooth map of (q, v): size * sum of weight * exp(-((q-a)/wq)^2 - ((v-b)/wv)^2)."""

    size: float
    places: tuple[tuple[float, float, float, float, float], ...]  # weight, a, 1/wq, b, 1/wv
    states: int = 0

    def force(self, at: At, z: Sequence[float]) -> float:
        """The force now."""
        return self.size * sum(
            weight * math.exp(-(((at.q - a) * p) ** 2) - ((at.v - b) * r) ** 2)
            for weight, a, p, b, r in self.places
        )

    def rates(self, at: At, z: Sequence[float]) -> list[float]:
        """None: it has no states."""
        return []

    def begin(self, q: float, v: float) -> list[float]:
        """None: it has no states."""
        return []


@dataclass(frozen=True)
class Drift:
    """A slow random force: size * sum of weight * sin(omega*t + phase), of other phases in each
    series (`phases` by series); `series` is the one that runs."""

    size: float
    omegas: tuple[float, ...]
    weights: tuple[float, ...]
    phases: tuple[tuple[float, ...], ...]
    series: int = 0
    states: int = 0

    def force(self, at: At, z: Sequence[float]) -> float:
        """The force now."""
        own = self.phases[self.series]
        waves = zip(self.weights, self.omegas, own, strict=True)
        return self.size * sum(a * math.sin(w * at.t + p) for a, w, p in waves)

    def rates(self, at: At, z: Sequence[float]) -> list[float]:
        """None: it has no states."""
        return []

    def begin(self, q: float, v: float) -> list[float]:
        """None: it has no states."""
        return []


@dataclass(frozen=True)
class Mode:
    """A weak flexible mode: a small mass on a spring at the body, less its rigid mass.

    w'' = omega^2 (q - w) - 2 zeta omega (w' - v); the force is size * omega^2 * (w - q). The rigid
    mass, which a declared inertia has in it, is a second, stiff mode of the other sign.
    """

    size: float  # the mass
    omega: float
    zeta: float
    states: int = 4
    stiff: float = 3.0

    def force(self, at: At, z: Sequence[float]) -> float:
        """The force now."""
        stiff = self.stiff * self.omega
        return self.size * (self.omega**2 * (z[0] - at.q) - stiff**2 * (z[2] - at.q))

    def rates(self, at: At, z: Sequence[float]) -> list[float]:
        """The rates of the positions and speeds of both."""
        found = []
        for w, rate, omega in ((z[0], z[1], self.omega), (z[2], z[3], self.stiff * self.omega)):
            found += [rate, omega**2 * (at.q - w) - 2 * self.zeta * omega * (rate - at.v)]
        return found

    def begin(self, q: float, v: float) -> list[float]:
        """Both go with the body."""
        return [q, v, q, v]


@dataclass(frozen=True)
class Relaxation:
    """A spring that gives way: size * (z - q) with z' = (q - z)/tau."""

    size: float
    tau: float
    states: int = 1

    def force(self, at: At, z: Sequence[float]) -> float:
        """The force now."""
        return self.size * (z[0] - at.q)

    def rates(self, at: At, z: Sequence[float]) -> list[float]:
        """The rate of z."""
        return [(at.q - z[0]) / self.tau]

    def begin(self, q: float, v: float) -> list[float]:
        """It is relaxed."""
        return [q]


Part = Bumps | Drift | Mode | Relaxation


@dataclass(frozen=True)
class Floor:
    """size * the sum of some parts."""

    size: float
    parts: tuple[Part, ...]

    @property
    def states(self) -> int:
        """Of all parts."""
        return sum(part.states for part in self.parts)

    def _own(self, z: Sequence[float]) -> list[tuple[Part, Sequence[float]]]:
        found, k = [], 0
        for part in self.parts:
            found.append((part, z[k : k + part.states]))
            k += part.states
        return found

    def force(self, at: At, z: Sequence[float]) -> float:
        """The force now."""
        return self.size * sum(part.force(at, own) for part, own in self._own(z))

    def rates(self, at: At, z: Sequence[float]) -> list[float]:
        """The rates of all states."""
        return [rate for part, own in self._own(z) for rate in part.rates(at, own)]

    def begin(self, q: float, v: float) -> list[float]:
        """All states at the start of a record."""
        return [x for part in self.parts for x in part.begin(q, v)]

    def scaled(self, factor: float) -> Floor:
        """The floor times a factor."""
        return replace(self, size=self.size * factor)

    def during(self, series: int) -> Floor:
        """The floor in one of the series."""
        parts = (replace(p, series=series) if isinstance(p, Drift) else p for p in self.parts)
        return replace(self, parts=tuple(parts))


NONE = Floor(0.0, ())


def draw_parts(
    kinds: Sequence[str], Q: float, V: float, force: float, series: int, rng: np.random.Generator
) -> list[Part]:
    """Parts of random shape whose force is about `force`; Q and V are the largest |q|, |v|."""
    counts = {"bumps": 10, "drift": 3, "mode": 2, "relaxation": 2}
    return [_part(kind, Q, V, force, series, rng) for kind in kinds for _ in range(counts[kind])]


def _part(
    kind: str, Q: float, V: float, force: float, series: int, rng: np.random.Generator
) -> Part:
    omega = V / Q
    if kind == "bumps":
        p, r = 1 / (rng.uniform(0.25, 0.8, 2) * (Q, V))
        a, b = rng.uniform(-1, 1, 2)
        return Bumps(force, ((1.0, float(a * Q), float(p), float(b * V), float(r)),))
    if kind == "drift":
        omegas = omega * np.exp(rng.uniform(np.log(0.04), np.log(0.5), 6))
        weights = rng.uniform(0.4, 1.0, 6) / 1.5
        phases = rng.uniform(0, 2 * np.pi, (series, 6))
        return Drift(
            force,
            tuple(map(float, omegas)),
            tuple(map(float, weights)),
            tuple(tuple(map(float, row)) for row in phases),
        )
    if kind == "mode":
        own = omega * float(rng.uniform(2.5, 5.0))
        return Mode(force / (Q * omega**2), own, float(rng.uniform(0.02, 0.1)))
    return Relaxation(force / Q, float(rng.uniform(0.3, 2.0)) / omega)
