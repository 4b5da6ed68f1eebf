"""Finding the guards that cross zero inside a step, and the time of the first of them.

A crossing is on the half-open interval (t0, t1]: a guard that is zero where a step begins does not
fire there. Guards are sampled inside the step, and a sampled minimum is refined by a parabola, so
that two crossings inside one step are not missed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from tracewire.solve.flow import Flow
from tracewire.solve.methods import Method, Step
from tracewire.solve.settle import noise

Vector = NDArray[np.float64]
THETAS = (0.0, 0.25, 0.5, 0.75, 1.0)
INNER = np.array(THETAS[1:-1])[:, np.newaxis]
NONE = np.empty(0, dtype=int)
HELD_NOISE = 1e-9
ROOT_TOLERANCE = 1e-14


@dataclass(frozen=True)
class Watched:
    """A margin that is positive while its mode holds: sign * (guard - level) of a guard.

    Of a fraction on a slide it is the distance to 0 or 1, of a contact its force.
    """

    mode: int
    to: float
    level: float
    sign: float
    kind: Literal["guard", "fraction", "force"] = "guard"


@dataclass(frozen=True)
class Found:
    """Crossings inside a step: where (theta in (0, 1]) and what; `at_once`: right at its start."""

    theta: float
    watched: tuple[int, ...]
    at_once: bool = False


class Watch:
    """The margins to watch while one mode combination lasts.

    A margin is armed once it has been positive: only then may it cross.
    """

    def __init__(self, flow: Flow) -> None:
        self.flow = flow
        self.items = list(_watched(flow))
        self.guards = [w for w in self.items if w.kind == "guard"]
        self.modes = np.array([w.mode for w in self.guards], dtype=int)
        self.levels = np.array([w.level for w in self.guards])
        self.signs = np.array([w.sign for w in self.guards])
        self.armed = np.zeros(len(self.items), dtype=bool)

    def margins(self, t: float, x: Vector) -> Vector:
        """All margins, in the order of `items`."""
        if not self.items:
            return np.empty(0)
        values = np.array(self.flow.guards(t, x))[self.modes] if self.guards else np.empty(0)
        margins: Vector = self.signs * (values - self.levels)
        if not (self.flow.sliding or self.flow.rests):
            return margins
        fractions, forces = self.flow.held(t, x)
        pairs = np.stack((fractions, 1.0 - fractions), axis=1).ravel()
        return np.concatenate((margins, pairs, forces))

    def floor(self, x: Vector) -> Vector:
        """Below this a margin counts as zero."""
        level = noise(x)
        return np.array([level if w.kind == "guard" else HELD_NOISE for w in self.items])

    def reached(self, t: float, x: Vector, margins: Vector, reach: float) -> list[Watched]:
        """The guards whose level is passed, or will be within the time `reach`."""
        if not self.guards:
            return []
        falls = -self.signs * np.array(self.flow.guard_rates(t, x))[self.modes]
        near = margins[: len(self.guards)]
        at = (near < -noise(x)) | ((falls > 0) & (near <= reach * falls))
        return [item for item, here in zip(self.guards, at.tolist(), strict=True) if here]

    def find(self, method: Method, step: Step, at_start: Vector) -> Found | None:
        """The first crossings inside a step whose margins at the start are `at_start`."""
        if not self.items:
            return None

        def margins(theta: float) -> Vector:
            inside = step.x_end if theta == 1.0 else method.inside(step, theta)
            return self.margins(step.t + theta * step.h, inside)

        floor = self.floor(step.x)
        inside = method.inside(step, INNER)
        rows = np.empty((len(THETAS), len(self.items)))
        rows[0] = at_start
        for k, states in enumerate(inside, start=1):
            rows[k] = self.margins(step.t + THETAS[k] * step.h, states)
        rows[-1] = self.margins(step.t + step.h, step.x_end)
        above = rows > floor
        if above[1:].all():
            crossed = fresh = NONE
            first = len(THETAS) - 1
        else:
            armed = self.armed | np.maximum.accumulate(above, axis=0)[:-1]
            wrong = rows[1:] < np.minimum(at_start, 0.0) - floor
            hit = wrong.any(axis=1)
            first = int(np.argmax(hit)) if hit.any() else len(THETAS) - 1
            at = min(first, len(THETAS) - 2)
            crossed = np.flatnonzero(wrong[at] & armed[at])
            fresh = np.flatnonzero(wrong[at] & ~armed[at])
        if len(fresh):
            return Found(0.0, tuple(map(int, fresh)), at_once=True)
        roots = dict(self.dips(margins, rows[: first + 2], floor))
        for item in map(int, crossed):
            roots[item] = self.root(margins, item, THETAS[first], THETAS[first + 1])
        if not roots:
            self.armed |= above.any(axis=0)
            return None
        theta = min(roots.values())
        return Found(theta, tuple(i for i, r in roots.items() if r - theta <= 4 * ROOT_TOLERANCE))

    def root(self, margins: Callable[[float], Vector], item: int, low: float, high: float) -> float:
        """Where a margin falls through zero between two samples."""
        if margins(low)[item] <= 0.0:
            return low
        if margins(high)[item] >= 0.0:
            return high

        def margin(theta: float) -> float:
            return float(margins(theta)[item])

        return float(brentq(margin, low, high, xtol=ROOT_TOLERANCE))

    def dips(
        self, margins: Callable[[float], Vector], rows: Vector, floor: Vector
    ) -> Iterator[tuple[int, float]]:
        """(item, theta) of dips below zero between positive samples, foretold by a parabola."""
        bend = rows[2:] - 2 * rows[1:-1] + rows[:-2]
        slope = rows[2:] - rows[:-2]
        dip = (bend > 0) & (slope**2 > 8 * bend * rows[1:-1]) & (np.abs(slope) <= 2 * bend)
        if not dip.any():
            return
        seen: set[int] = set()
        for row, item in np.argwhere(dip & (rows[:-2] > floor)).tolist():
            k = row + 1
            shift = float(-slope[row, item] / (2 * bend[row, item]))
            theta = THETAS[k] + shift * (THETAS[k + 1] - THETAS[k])
            if item not in seen and margins(theta)[item] < -floor[item]:
                seen.add(item)
                yield item, self.root(margins, item, THETAS[k - 1 if shift <= 0 else k], theta)


def _watched(flow: Flow) -> list[Watched]:
    items: list[Watched] = []
    for i, mode in enumerate(flow.model.modes):
        if mode.timed is not None or flow.is_bound(i):
            continue
        value = flow.modes[i]
        if mode.kind == "sign":
            items.append(Watched(i, 1.0 - value, 0.0, 1.0 if value else -1.0))
        elif mode.kind == "floor":
            items.append(Watched(i, value - 1.0, value, 1.0))
            items.append(Watched(i, value + 1.0, value + 1.0, -1.0))
        else:
            points, piece = flow.tables[mode.table][0], int(value)
            if piece > 0:
                items.append(Watched(i, value - 1.0, points[piece - 1], 1.0))
            if piece < len(points):
                items.append(Watched(i, value + 1.0, points[piece], -1.0))
    for i in flow.sliding:
        items.append(Watched(i, 0.0, 0.0, 1.0, "fraction"))
        items.append(Watched(i, 1.0, 1.0, -1.0, "fraction"))
    items += [Watched(rest.mode, flow.modes[rest.mode], 0.0, 1.0, "force") for rest in flow.rests]
    return items
