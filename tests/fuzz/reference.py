"""A solution of a nonlinear system to about 1e-11, by another integrator and other events.

Between two events DOP853 of scipy goes on at rtol 1e-12; guards are sampled inside each of its
steps, and a change of sign is halved on its dense output. What is not clear raises `Unclear`: such
a system judges nobody. Nothing here knows the product.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from types import CodeType
from typing import Any

import numpy as np
from fuzz.elements import Unclear
from fuzz.smooth import Part, Smooth
from numpy.typing import NDArray
from scipy.integrate import DOP853

Vector = NDArray[np.float64]
CLOSE = 1e-7  # guards are of the size 1: what is nearer to zero is not told from it
SAMPLES = 12  # of the guards, in a step
BESIDE = 1e-3  # of the way to the next sample: where a guard is looked at beside either end
MOST_EVENTS = 200
SOON = 1e-5  # after a reset: it may be one of a sequence without end
SLOWEST = 1e-3  # after a wall: what is slower may be about to come to rest
FUNCTIONS = {name: getattr(math, name) for name in ("sin", "cos", "tanh", "exp", "sqrt")}


class Reference:
    """The solution of a system from a start: `at(times)` are its states."""

    def __init__(self, system: Smooth, start: Vector) -> None:
        self.system, self.names = system, list(system.starts)
        self.rates = {name: _code(system.rate(name)) for name in system.terms}
        self.reads = {part.name: _code(part.reads) for part in system.parts}
        self.sets = {p.name: {n: _code(f) for n, f in p.sets.items()} for p in system.parts}
        self.modes: dict[str, int] = {}
        self.fired: dict[str, float] = {}
        self.pieces: list[tuple[float, Any]] = []
        self.t, self.z = 0.0, start.copy()
        self._begin()
        count = 0
        while self.t < system.end:
            self._go_on()
            count += 1
            if count > MOST_EVENTS:
                raise Unclear("many events")

    def at(self, times: Sequence[float]) -> NDArray[np.float64]:
        """The states (N, n) at ascending times, those after an event at its instant."""
        found, number = [], 0
        for t in times:
            while number + 1 < len(self.pieces) and self.pieces[number + 1][0] <= t:
                number += 1
            found.append(self.pieces[number][1](t))
        return np.array(found)

    def values(self, t: float, z: Vector) -> dict[str, Any]:
        """All values by name, with the modes as they stand."""
        known: dict[str, Any] = {"t": t, **FUNCTIONS}
        known |= dict(zip(self.names, z.tolist(), strict=True))
        friction = ""
        for part in self.system.parts:
            mode = self.modes[part.name]
            match part.kind:
                case "relay":
                    known[part.name] = mode
                case "saturation":
                    ends = {-1: part.low, 1: part.high}
                    known[part.name] = ends[mode] if mode else eval(self.reads[part.name], known)
                case "abs":
                    known[part.name] = mode * eval(self.reads[part.name], known)
                case "friction":
                    known[part.name], friction = -part.high * mode, part.name
        if friction and self.modes[friction] == 0:
            known[friction] = -eval(self.rates["v"], known)
        return known

    def field(self, t: float, z: Vector) -> list[float]:
        """The rates."""
        known = self.values(t, z)
        return [eval(self.rates[n], known) if n in self.rates else 0.0 for n in self.names]

    def margins(self, t: float, z: Vector) -> Vector:
        """What is positive while the modes last: two for each element, the first for a mode below,
        the second for one above; infinite where there is none."""
        known, found = self.values(t, z), []
        for part in self.system.parts:
            mode = self.modes[part.name]
            value = eval(self.reads[part.name], known) if part.kind != "friction" else known["v"]
            pair = [math.inf, math.inf]
            match part.kind:
                case "relay":
                    pair[mode < 0] = value - part.low if mode > 0 else part.high - value
                case "saturation":
                    if mode >= 0:
                        pair[0] = value - (part.low if mode == 0 else part.high)
                    if mode <= 0:
                        pair[1] = (part.high if mode == 0 else part.low) - value
                case "abs":
                    pair[mode < 0] = mode * value
                case "friction" if mode:
                    pair[mode < 0] = mode * value
                case "friction":
                    pair = [part.high - known[part.name], part.high + known[part.name]]
                case "wall":
                    pair[1] = part.high - value
                case _:
                    pair[mode < 0] = mode * (value - part.high)
            found += pair
        return np.array(found)

    def _begin(self) -> None:
        for part in self.system.parts:
            self.modes[part.name] = 0 if part.kind in ("saturation", "wall") else 1
        for part in self.system.parts:  # those that read friction come behind it
            value = eval(self.reads[part.name], self.values(0.0, self.z))
            match part.kind:
                case "saturation":
                    self.modes[part.name] = int(value > part.high) - int(value < part.low)
                case "abs":
                    self.modes[part.name] = 1 if value > 0 else -1
                case "friction":
                    self.modes[part.name] = 1 if self.z[self.names.index("v")] > 0 else -1
                case "wall":
                    pass
                case _:
                    self.modes[part.name] = 1 if value >= part.high else -1
        margins = self.margins(0.0, self.z)
        if np.any(margins < CLOSE):
            raise Unclear("the start is on an edge")

    def _go_on(self) -> None:
        """To the next event, at the end at the latest, and let it happen."""
        end = self.system.end
        solver = DOP853(self.field, self.t, self.z, end, rtol=1e-12, atol=1e-13, max_step=end / 60)
        armed = self.margins(self.t, self.z) > CLOSE
        while solver.status == "running":
            solver.step()
            if solver.status == "failed":
                raise Unclear("the reference fails")
            line, low = solver.dense_output(), solver.t_old
            self.pieces.append((low, line))
            grid = np.linspace(low, solver.t, SAMPLES)
            beside = BESIDE * (grid[1] - grid[0])  # a dip between the last two samples is seen, too
            grid = np.r_[low, low + beside, grid[1:-1], grid[-1] - beside, grid[-1]]
            rows = np.array([self.margins(t, line(t)) for t in grid])
            inner = rows[1:-1]
            turns = (inner < rows[:-2]) & (inner < rows[2:])
            with np.errstate(invalid="ignore"):
                dips = inner - np.abs(rows[2:] - rows[:-2]) < 1e-4
            near = turns & dips & (inner < 1e-2)
            for k in range(1, len(grid)):
                if np.any((rows[k] < -CLOSE) & ~armed):
                    raise Unclear("a guard turns where a piece begins")
                if k > 1 and np.any(near[k - 2] & armed):
                    raise Unclear("a guard is nearly touched")
                if np.any(armed & (rows[k] < 0)):
                    self._happen(line, grid[k - 1], grid[k], armed)
                    return
                armed |= rows[k] > CLOSE
            self.t, self.z = float(solver.t), solver.y.copy()

    def _happen(self, line: Any, low: float, high: float, armed: NDArray[np.bool_]) -> None:
        for _ in range(80):
            middle = (low + high) / 2
            if np.any(armed & (self.margins(middle, line(middle)) < 0)):
                high = middle
            else:
                low = middle
        self.t, self.z = high, line(high)
        margins = self.margins(self.t, self.z)
        passed = np.flatnonzero(armed & (margins <= 0))
        if len(passed) != 1 or np.sum(np.abs(margins[armed]) < CLOSE) != 1:
            raise Unclear("two things at one instant")
        self._act(int(passed[0]))
        for _ in range(20):
            margins = self.margins(self.t, self.z)
            beyond = np.flatnonzero(margins < -CLOSE)
            if len(beyond) == 0:
                return
            if len(beyond) > 1:
                raise Unclear("two things follow")
            self._act(int(beyond[0]))
        raise Unclear("events without end")

    def _act(self, number: int) -> None:
        part, up = self.system.parts[number // 2], number % 2 == 1
        mode = self.modes[part.name]
        match part.kind:
            case "saturation":
                self.modes[part.name] += 1 if up else -1
            case "friction" if mode == 0:  # too much of a positive force pushes to the right
                self.modes[part.name] = -1 if not up else 1
            case "friction":
                self._meet(part)
            case "wall":
                self._write(part)
                if abs(self.z[self.names.index("v")]) < SLOWEST:
                    raise Unclear("a wall that is hardly left")
                self._turn_friction()
            case _:
                self.modes[part.name] = -mode
                if part.sets and mode < 0:
                    if 0 < self.t - self.fired.get(part.name, -math.inf) < SOON:
                        raise Unclear("resets that come ever closer")
                    self.fired[part.name] = self.t
                    self._write(part)

    def _write(self, part: Part) -> None:
        known = self.values(self.t, self.z)
        for name, code in self.sets[part.name].items():
            self.z[self.names.index(name)] = eval(code, known)

    def _turn_friction(self) -> None:
        for part in self.system.parts:
            if part.kind == "friction":
                self.modes[part.name] = 1 if self.z[self.names.index("v")] > 0 else -1

    def _meet(self, friction: Part) -> None:
        """Where the rate of a friction is zero it holds, or lets go to the side of the force."""
        self.z[self.names.index("v")] = 0.0
        old, self.modes[friction.name] = self.modes[friction.name], 0
        force = -float(self.values(self.t, self.z)[friction.name])
        if abs(abs(force) - friction.high) < CLOSE:
            raise Unclear("a decision on the edge")
        if abs(force) > friction.high:
            self.modes[friction.name] = 1 if force > 0 else -1
            if self.modes[friction.name] == old:
                raise Unclear("a rate that only touches zero")


def _code(formula: str) -> CodeType:
    return compile(formula, "<fuzz>", "eval")
