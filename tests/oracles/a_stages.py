"""Independent solutions of the stages S1 to S5 of the double torsion pendulum (paper A).

Equations of motion as in double_torsion.py; the laws of a stage are

    column  Eq 8   M_L = T_v1 v1 + T_s1 (2/pi) atan(eps1 v1) + sign(v1) T_b          S1, S2
            Eq 22  M_L = T_v1(sign v1) v1 + sign(v1) T_b                             S3, S4, S5
    disk    Eq 10  M_T = T_v2 v2 + T_s2 (2/pi) atan(eps2 v2)                         S1
            Eq 21  the same with T_v2, T_s2 by the sign of v2                        S2, S3
            Eq 24  as in double_torsion.py                                           S4, S5
    pin     Eqs 4, 15, a Voigt element; adhesive: 0 lets it push only                S1 to S4
            Eq 20  v1 -> -c_r v1; `consistent` keeps v1 + v2                         S5

On plain scipy: every branch is frozen between events, which are located and restarted from. In S5
the flights shrink; where one starts below SMALL the rest of them is summed as a geometric series,
and the column rests on the pin until the torque on it exceeds T_b outward.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from oracles.double_torsion import PARAMETERS, Array, Event, Solution, State
from scipy.integrate import solve_ivp

SMALL = 1e-5  # rad/s
TINY = 1e-300
SOON = 1e-9  # s: no flight is shorter

BOTH = {"T_v1": 0.0044, "T_s1": 0.0005, "eps1": 100.0, "eps2": 100.0}
S1 = {"kappa1": 0.0169, "kappa2": 0.0304, "c2": 0.019, "T_s2": 0.012, "T_v2": 0.001}
S2_FRICTION = {"T_s2_l": 0.008, "T_s2_r": 0.012, "T_v2_l": 0.0005, "T_v2_r": 0.0009}
TABLE = dict(PARAMETERS)


def _sided(values: Mapping[str, float]) -> dict[str, float]:
    """The same value for both sides, under the names of the two."""
    return {f"{name}_{side}": value for name, value in values.items() for side in "lr"}


@dataclass(frozen=True)
class Stage:
    """The laws and the parameters of a stage."""

    parameters: Mapping[str, float]
    disk_law: str = "stribeck"  # Eq 24; arctan: Eqs 10 and 21
    impacts: bool = False  # Eq 20


STAGES = {
    "S1": Stage(TABLE | _sided(S1) | _sided({"T_v1": 0.0044}) | BOTH, "arctan"),
    "S2": Stage(TABLE | _sided(S1) | _sided({"T_v1": 0.0044}) | BOTH | S2_FRICTION, "arctan"),
    "S3": Stage(TABLE | S2_FRICTION | {"T_s1": 0.0, "eps1": 100.0, "eps2": 100.0}, "arctan"),
    "S4": Stage(TABLE | {"T_s1": 0.0, "eps1": 100.0}),
    "S5": Stage(TABLE | {"T_s1": 0.0, "eps1": 100.0, "c_r": 0.5, "consistent": 1.0}, impacts=True),
}


@dataclass(frozen=True)
class Branches:
    """The branch of every law: the side, or 0 for none; v1 = 0 sticks; `held` rests on the pin.

    pushes, disk_pushes: whether the Voigt element acts while the body is beyond the limit.
    """

    pin: int = 0
    pushes: bool = True
    disk: int = 0
    disk_pushes: bool = True
    spring: int = 1
    v1: int = 1
    v2: int = 1
    held: int = 0


class Guard(NamedTuple):
    """Falls through zero where `kind` happens on the side `detail`."""

    function: Callable[[float, State], float]
    kind: str
    detail: int


def _first_sign(*derivatives: float) -> int:
    return next((1 if value > 0.0 else -1 for value in derivatives if value != 0.0), 0)


class _System:
    def __init__(self, stage: Stage, p: Mapping[str, float], nT: float, adhesive: bool) -> None:
        self.p, self.stage, self.nT, self.adhesive = SimpleNamespace(**p), stage, nT, adhesive

    def pin(self, state: State, on: Branches) -> float:
        """R1 [N m], by the spring and the damper, whether they act or not."""
        if self.stage.impacts or not on.pin:
            return 0.0
        return float(self.p.k1 * (state[0] - on.pin * self.p.phi1_s) + self.p.c1 * state[1])

    def beams(self, state: State, on: Branches) -> float:
        """R2 [N m], likewise."""
        if not on.disk:
            return 0.0
        c2 = self.p.c2_l if on.disk > 0 else self.p.c2_r
        return float(self.p.k2 * (state[2] - on.disk * self.p.phi2_s) + c2 * state[3])

    def disk_friction(self, v2: float, side: int) -> float:
        p, left = self.p, side > 0
        T_s2 = p.T_s2_l if left else p.T_s2_r
        if self.stage.disk_law == "arctan":
            T_v2 = p.T_v2_l if left else p.T_v2_r
            return float(T_v2 * v2 + T_s2 * 2 / math.pi * math.atan(p.eps2 * v2))
        T_02 = p.T_02_l if left else p.T_02_r
        z = p.alpha * v2
        decay = math.exp(-abs(z))
        sech = 2 * decay / (1 + decay * decay)
        return float(T_s2 / (1 + T_02 * side * v2) * (1 + p.beta * sech) * math.tanh(z))

    def column(self, t: float, state: State, on: Branches) -> float:
        """The torque [N m] on the column but for the pin in S5 and its own friction."""
        p = self.p
        kappa1, kappa2 = (p.kappa1_l, p.kappa2_l) if on.spring > 0 else (p.kappa1_r, p.kappa2_r)
        phi_f = p.A * math.sin(p.omega * t + p.phase) - state[0]
        f_s = kappa1 * phi_f + kappa2 * phi_f**3
        R1 = self.pin(state, on) if on.pushes else 0.0
        R2 = self.beams(state, on) if on.disk_pushes else 0.0
        return float(f_s - R1 + R2 + self.nT * self.disk_friction(float(state[3]), on.v2))

    def rates(self, t: float, state: State, on: Branches) -> Array:
        state = np.asarray(state).tolist()  # numbers of Python are faster one by one
        p, v1, v2 = self.p, state[1], state[3]
        a1 = 0.0
        if on.v1 and not on.held:
            T_v1 = p.T_v1_l if on.v1 > 0 else p.T_v1_r
            smooth = T_v1 * v1 + p.T_s1 * 2 / math.pi * math.atan(p.eps1 * v1)
            a1 = (self.column(t, state, on) - smooth - on.v1 * p.T_b) / p.B1
        R2 = self.beams(state, on) if on.disk_pushes else 0.0
        return np.array([v1, a1, v2, (-R2 - self.disk_friction(v2, on.v2)) / p.B2 - a1])

    def guards(self, on: Branches) -> list[Guard]:
        p = self.p
        found = [Guard(lambda t, y: on.v2 * y[3], "v2 zero", -on.v2)]
        if on.disk:
            s = on.disk
            found.append(Guard(lambda t, y: s * y[2] - p.phi2_s, "disk contact end", s))
            if not self.adhesive:
                w = 1 if on.disk_pushes else -1
                found.append(Guard(lambda t, y: w * s * self.beams(y, on), "disk pushes", -w))
        else:
            found += [
                Guard(lambda t, y: p.phi2_s - y[2], "disk contact begin", 1),
                Guard(lambda t, y: p.phi2_s + y[2], "disk contact begin", -1),
            ]
        if on.held:
            h = on.held
            return [*found, Guard(lambda t, y: h * self.column(t, y, on) + p.T_b, "release", -h)]
        if on.pin:
            s1 = on.pin
            found.append(Guard(lambda t, y: s1 * y[0] - p.phi1_s, "column contact end", s1))
            if not self.adhesive:
                w1 = 1 if on.pushes else -1
                found.append(Guard(lambda t, y: w1 * s1 * self.pin(y, on), "column pushes", -w1))
        else:
            found += [
                Guard(lambda t, y: p.phi1_s - y[0], "column contact begin", 1),
                Guard(lambda t, y: p.phi1_s + y[0], "column contact begin", -1),
                Guard(lambda t, y: on.spring * y[0], "phi1 zero", -on.spring),
            ]
        if on.v1:
            return [*found, Guard(lambda t, y: on.v1 * y[1], "v1 zero", -on.v1)]
        return [
            *found,
            Guard(lambda t, y: p.T_b - self.column(t, y, on), "stick end", 1),
            Guard(lambda t, y: p.T_b + self.column(t, y, on), "stick end", -1),
        ]

    def slips_to(self, t: float, y: State, on: Branches) -> int:
        torque = self.column(t, y, on)
        return 0 if abs(torque) <= self.p.T_b else _first_sign(torque)

    def switch(
        self, t: float, y: Array, on: Branches, guard: Guard
    ) -> tuple[float, Array, Branches, list[Event]]:
        """What follows an event: its time, the states, the branches, and what to log."""
        p, side = self.p, guard.detail
        log = [Event(t, guard.kind, "+" if side > 0 else "-")]
        match guard.kind:
            case "v2 zero":
                y[3] = 0.0
                on = replace(on, v2=_first_sign(self.rates(t, y, on)[3]) or -on.v2)
            case "disk contact begin":
                y[2] = side * p.phi2_s
                on = replace(on, disk=side, disk_pushes=True)
            case "disk contact end":
                y[2] = side * p.phi2_s
                on = replace(on, disk=0)
            case "disk pushes":
                on = replace(on, disk_pushes=side > 0)
            case "column pushes":
                on = replace(on, pushes=side > 0)
            case "phi1 zero":
                y[0] = 0.0
                on = replace(on, spring=side)
            case "column contact begin" if self.stage.impacts:
                return self.impact(t, y, on, side, log)
            case "column contact begin":
                y[0] = side * p.phi1_s
                on = replace(on, pin=side, pushes=True)
            case "column contact end":
                y[0] = side * p.phi1_s
                on = replace(on, pin=0)
            case "release":
                on = replace(on, held=0, v1=side)
            case "v1 zero":
                y[1] = 0.0
                on = replace(on, v1=self.slips_to(t, y, on))
                if not on.v1:
                    log.append(Event(t, "stick begin", ""))
            case "stick end":
                on = replace(on, v1=side)
        return t, y, on, log

    def impact(
        self, t: float, y: Array, on: Branches, side: int, log: list[Event]
    ) -> tuple[float, Array, Branches, list[Event]]:
        """Eq 20, and the end of the bounces."""
        p = self.p
        before = y[1]
        y[0], y[1] = side * p.phi1_s, -p.c_r * before
        if p.consistent:
            y[3] += (1 + p.c_r) * before
            on = replace(on, v2=_first_sign(y[3]) or on.v2)
        on = replace(on, v1=-side)
        if abs(y[1]) < SMALL:
            pull = -side * self.rates(t, y, on)[1]
            if pull < 0:
                lasts = 2 * abs(y[1]) / -pull / (1 - p.c_r)
                if p.consistent:
                    y[3] += y[1]  # the sum of the jumps that are left
                y[1] = 0.0
                on = replace(on, held=side)
                y = y + lasts * self.rates(t, y, on)
                t += lasts
                log.append(Event(t, "rest", log[0].detail))
        return t, y, on, log


def _terminal(
    function: Callable[[float, State], float], origin: Array, begin: float, soon: float
) -> Callable[[float, Array], float]:
    """End a segment where the function falls through zero after its start, where it may be zero.

    Just after the start of a flight its height is rounding.
    """

    def event(t: float, z: Array) -> float:
        value = function(t, z + origin)
        return max(value, TINY) if t - begin < soon else value

    event.terminal = True  # type: ignore[attr-defined]
    event.direction = -1.0  # type: ignore[attr-defined]
    return event


def solve(
    name: str,
    times: ArrayLike,
    parameters: Mapping[str, float] | None = None,
    *,
    as_printed: bool = False,
    adhesive: bool = True,
    start: State | None = None,
    rtol: float = 1e-10,
    max_step: float = 0.01,
) -> Solution:
    """Solve a stage at `times` (N,) in s from the first of them.

    start: phi1, v1, phi2, v2, by default the column at rest on its pin at -phi1_s. as_printed: the
    factor 2 on the friction, kappa2_r on both sides, and in S5 a reset of v1 only.
    """
    stage = STAGES[name]
    p = dict(stage.parameters)
    if as_printed:
        p |= {"kappa2_l": p["kappa2_r"]}
        p |= {"consistent": 0.0} if stage.impacts else {}
    p |= dict(parameters or {})
    system = _System(stage, p, 2.0 if as_printed else 1.0, adhesive)
    samples = np.asarray(times, dtype=float)
    y = np.array([-p["phi1_s"], 0.0, 0.0, 0.0] if start is None else start, dtype=float)
    t, end = float(samples[0]), float(samples[-1])
    on = _first(system, t, y)
    soon = SOON if stage.impacts else TINY
    states, filled = np.empty((4, samples.size)), 0
    events: list[Event] = []
    while True:
        guards = system.guards(on)
        stiff = on.pin != 0 and on.pushes and p["c1"] / p["B1"] > 2000.0
        # the column creeps off its pin at 1e-4 rad/s: its angle counts from there
        origin = np.array([(on.pin or on.held) * p["phi1_s"], 0.0, 0.0, 0.0])
        run: Any = solve_ivp(
            lambda t, z, on=on, origin=origin: system.rates(t, z + origin, on),
            (t, end),
            y - origin,
            method="LSODA" if stiff else "DOP853",
            events=[_terminal(guard.function, origin, t, soon) for guard in guards],
            dense_output=True,
            rtol=rtol,
            atol=1e-15,
            max_step=max_step,
        )
        if not run.success:
            raise RuntimeError(f"{name} from t={t} with {on}: {run.message}")
        last = float(run.t[-1])
        count = int(np.searchsorted(samples, last if run.status == 1 else np.inf))
        if count > filled:
            states[:, filled:count] = run.sol(samples[filled:count]) + origin[:, None]
            filled = count
        if run.status == 0:
            return Solution(samples, states, tuple(events))
        which = next(n for n, hit in enumerate(run.t_events) if hit.size)
        y = run.y_events[which][0] + origin
        t, y, on, log = system.switch(last, y, on, guards[which])
        events += log
        passed = int(np.searchsorted(samples, t))  # samples within the sum of the last bounces
        states[:, filled:passed] = y[:, None]
        filled = passed
        if end - t <= 4 * np.spacing(end):
            states[:, filled:] = y[:, None]
            return Solution(samples, states, tuple(events))


def _first(system: _System, t: float, y: Array) -> Branches:
    """The branches at a start off the limits, or at rest on the pin and driven off it."""
    p = system.p
    beyond = [
        _first_sign(y[n]) * (abs(y[n]) > limit) for n, limit in ((0, p.phi1_s), (2, p.phi2_s))
    ]
    on = Branches(pin=beyond[0], disk=beyond[1], spring=_first_sign(y[0], y[1]) or 1)
    on = replace(on, v1=_first_sign(y[1]), v2=_first_sign(y[3]) or 1)
    on = replace(on, v1=on.v1 or system.slips_to(t, y, on))
    if abs(y[0]) == p.phi1_s and y[1] == 0.0 and on.v1 * y[0] > 0:
        raise ValueError("the start presses on the pin")
    return replace(on, v2=_first_sign(y[3], system.rates(t, y, on)[3]) or 1)
