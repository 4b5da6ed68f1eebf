"""A slow and plain integration of systems that switch, by scipy, restarted at every switch.

It knows nothing of sliding, sticking or touching: there it says `Unclear` and leaves the judgement
to others. A field is a function of (t, x, switches) that asks `switches` at every relation and
always asks all of them.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise, product

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq, minimize_scalar

Vector = NDArray[np.float64]
ZERO = 1e-9
STEEP = 1e-3
SAMPLES = np.linspace(0, 1, 9)


class Unclear(Exception):
    """Something happens that this integration does not judge."""


@dataclass
class Switches:
    """The frozen side of every relation, and its guard as it was seen last.

    `piece` is the interval between two known times, in whose middle sources that jump are read;
    `sticking` names the relations whose dry friction shows its level of sticking.
    """

    on: dict[Hashable, bool] = field(default_factory=dict)
    guards: dict[Hashable, float] = field(default_factory=dict)
    quiet: set[Hashable] = field(default_factory=set)
    relays: dict[Hashable, tuple[float, float, float]] = field(default_factory=dict)
    piece: tuple[float, float] = (0.0, 0.0)
    sticking: frozenset[Hashable] = frozenset()

    def ask(self, key: Hashable, guard: float, quiet: bool = False) -> bool:
        """Whether guard >= 0, as frozen; a quiet one is no event."""
        self.guards[key] = guard
        if quiet:
            self.quiet.add(key)
        return self.on.setdefault(key, guard >= 0)

    def relay(self, key: Hashable, of: float, on_at: float, off_at: float) -> bool:
        """Whether a relay is on, that starts off between its thresholds."""
        on = self.on.setdefault(key, of >= on_at)
        self.guards[key] = of - (off_at if on else on_at)
        self.relays[key] = of, on_at, off_at
        return on


Field = Callable[[float, Vector, Switches], Vector]


def integrate(
    rates: Field, start: Sequence[float], known: Sequence[float], end: float
) -> tuple[Vector, list[float]]:
    """The states at `end` and the times of all switches from 0 on; `known` times end pieces.

    Raises Unclear.
    """
    run = _Run(rates, np.array(start, dtype=float), Switches())
    pieces = [0.0, *sorted({time for time in known if 0 < time < end}), end]
    for begin, until in pairwise(pieces):
        run.switches.piece = (begin, until)
        run.settle()
        while run.t < until:
            run.advance(until)
    return run.x, run.times


@dataclass
class _Run:
    rates: Field
    x: Vector
    switches: Switches
    t: float = 0.0
    times: list[float] = field(default_factory=list)

    def guards(self, t: float, x: Vector) -> dict[Hashable, float]:
        """All guards, positive on the frozen side."""
        self.rates(t, x, self.switches)
        on = self.switches.on
        return {key: g if on[key] else -g for key, g in self.switches.guards.items()}

    def settle(self) -> None:
        """Take the one set of sides that lasts from here on."""
        switches = self.switches
        before = dict(switches.on)
        for _ in range(20):
            guards = self.guards(self.t, self.x)
            wrong = [key for key, guard in guards.items() if guard < -ZERO]
            wrong += [key for key in switches.relays if abs(guards[key]) <= ZERO]
            for key in wrong:
                switches.on[key] = not switches.on[key]
            if not wrong:
                break
        else:
            raise Unclear("the sides do not stand still")
        zero = [key for key, guard in guards.items() if abs(guard) <= ZERO]
        if zero:
            self.decide(zero)
        changed = [key for key, on in switches.on.items() if before and on != before[key]]
        self.times += [self.t for key in changed if key not in switches.quiet]

    def decide(self, zero: list[Hashable]) -> None:
        if len(zero) > 5:
            raise Unclear("too many guards are zero")
        choices = [
            dict(zip(zero, sides, strict=True))
            for sides in product((True, False), repeat=len(zero))
        ]
        lasting = [choice for choice in choices if self.lasts(choice, sticking=True)]
        if len(lasting) != 1:
            raise Unclear("none or several ways on")
        for key in zero:  # beside the way on, a friction may hold, with other sides of the others
            for choice in choices:
                ways = [self.speeds(choice | {key: side}, True)[key] for side in (True, False)]
                if max(ways) < 0:
                    raise Unclear("a way on, and something that may hold")
        if not self.lasts(lasting[0], sticking=False):
            raise Unclear("none or several ways on")

    def lasts(self, choice: dict[Hashable, bool], sticking: bool) -> bool:
        """Whether every guard that is zero moves to its side; leaves the sides as chosen."""
        speeds = self.speeds(choice, sticking).values()
        if min(map(abs, speeds)) < STEEP:
            raise Unclear("a guard is touched")
        return min(speeds) > 0

    def speeds(self, choice: dict[Hashable, bool], sticking: bool) -> dict[Hashable, float]:
        """How fast each guard of a choice moves to its side; leaves the sides as chosen."""
        self.switches.on |= choice
        self.switches.sticking = frozenset(choice if sticking else ())
        h = 1e-7
        now = self.guards(self.t, self.x)
        later = self.guards(self.t + h, self.x + h * self.rates(self.t, self.x, self.switches))
        self.switches.sticking = frozenset()
        if min(now.values()) < -ZERO or any(abs(now[key]) > ZERO for key in choice):
            raise Unclear("a guard jumps")
        return {key: (later[key] - now[key]) / h for key in choice}

    def advance(self, until: float) -> None:
        """Integrate to the next switch, or to the end of the piece."""
        solver = DOP853(
            lambda t, x: self.rates(t, x, self.switches),
            self.t,
            self.x,
            until,
            rtol=1e-11,
            atol=1e-13,
            max_step=0.05,
        )
        while solver.status == "running":
            solver.step()
            if solver.status == "failed":
                raise Unclear("a step failed")
            path = solver.dense_output()
            times = solver.t_old + SAMPLES * (solver.t - solver.t_old)
            rows = [self.guards(t, path(t)) for t in times]
            hit = min(
                (t for key in rows[0] for t in self.roots(key, times, rows, path)), default=None
            )
            if hit is not None:
                self.t, self.x = hit, path(hit)
                self.settle()
                return
        self.t, self.x = solver.t, solver.y

    def roots(
        self,
        key: Hashable,
        times: Vector,
        rows: Sequence[dict[Hashable, float]],
        path: Callable[[float], Vector],
    ) -> list[float]:
        """The first zero of a guard in a step, if there is one."""

        def guard(t: float) -> float:
            return self.guards(t, path(t))[key]

        values = [row[key] for row in rows]
        for n in range(1, len(values)):
            low = n if values[n] < 0 else None
            inner = n + 1 < len(values) and values[n] <= min(values[n - 1], values[n + 1])
            left, right = times[n - 1], times[n]
            if low is None and inner and values[n] < 1e-3:
                found = minimize_scalar(
                    guard, bounds=(left, times[n + 1]), method="bounded", options={"xatol": 1e-9}
                )
                if abs(found.fun) < 1e-7:
                    raise Unclear("a guard is touched")
                if found.fun < 0:
                    low, right = n, float(found.x)
            if low is not None:
                if (values[n - 1] <= 0 and n > 1) or guard(left + 1e-3 * (right - left)) <= 0:
                    raise Unclear("a guard turns at once")
                if values[n - 1] <= 0:
                    left += 1e-3 * (right - left)
                return [float(brentq(guard, left, right, xtol=1e-15, rtol=1e-14))]
        return []
