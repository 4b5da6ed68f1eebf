"""Independent solution of the double torsion pendulum (paper A, final model S4).

Written from the equations on numpy and scipy alone, so that it can judge the product:

    f_s = kappa1*phi_f + kappa2*phi_f^3,   phi_f = A sin(omega t + phase) - phi1        Eq 23
    R_i = k_i*d_i + c_i*v_i while |phi_i| >= phi_is, else 0                             Eq 4, 15
    M_L = T_v1*v1 + sign(v1)*T_b                                                        Eq 22
    M_T = T_s2/(1 + T_02|v2|) * (1 + beta/cosh(alpha v2)) * tanh(alpha v2)              Eq 24
    v1' = (f_s - R1 + R2 - M_L + nT*M_T)/B1
    v2' = -v1' - (R2 + M_T)/B2

Between events every branch is frozen, so each segment is smooth; a segment ends where a guard of
its branches reaches zero. At v1 = 0 the dry friction T_b holds the column (v1' = 0) as long as the
other torques on it sum to at most T_b.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp

PARAMETERS: dict[str, float] = {
    "B1": 0.00135,  # kg m2
    "B2": 0.0003,
    "A": math.radians(37.5),  # rad
    "omega": 3.9,  # rad/s
    "phase": math.radians(120.0),
    "kappa1_l": 0.0135,  # N m/rad, l: phi1 >= 0
    "kappa1_r": 0.0203,
    "kappa2_l": 0.0243,  # N m/rad3
    "kappa2_r": 0.0365,
    "T_v1_l": 0.0039,  # N m s/rad, l: v1 >= 0
    "T_v1_r": 0.0049,
    "T_b": 0.9 * 9.81 * 0.001126 * 0.008 / 2.0,  # N m, m g mu D_m/2
    "T_s2_l": 0.0250,  # N m, l: v2 >= 0
    "T_s2_r": 0.0450,
    "T_02_l": 0.5050,  # s/rad
    "T_02_r": 0.5030,
    "alpha": 0.15,  # s/rad
    "beta": 2.2,
    "k1": 300.0,  # N m/rad
    "c1": 120.0,  # N m s/rad
    "k2": 0.7,
    "c2_l": 0.018,  # l: phi2 > 0
    "c2_r": 0.020,
    "phi1_s": math.radians(13.6),  # rad
    "phi2_s": math.radians(1.1),
}

TINY = 1e-300
Method = Literal["DOP853", "LSODA", "Radau"]
Array = NDArray[np.float64]
State = Sequence[float] | Array


class Event(NamedTuple):
    """One located event: time [s], kind such as `column contact begin`, detail `+` or `-`."""

    time: float
    kind: str
    detail: str


@dataclass(frozen=True)
class Solution:
    """Times [s] (N), states phi1 [rad], v1 [rad/s], phi2 [rad], v2 [rad/s] (4 x N), events."""

    t: Array
    states: Array
    events: tuple[Event, ...]

    def intervals(self, name: str, side: str | None = None) -> list[tuple[float, float]]:
        """The (begin, end) times of `name` (`column contact`, `disk contact`, `stick`)."""
        begins = [e for e in self.events if e.kind == f"{name} begin" and side in (None, e.detail)]
        ends = [e.time for e in self.events if e.kind == f"{name} end"]
        return [(b.time, min((e for e in ends if e > b.time), default=math.inf)) for b in begins]


@dataclass(frozen=True)
class Branches:
    """The frozen branch of every piecewise law: +1, -1, or 0 for no contact and for stick."""

    column: int
    disk: int
    spring: int
    v1: int
    v2: int


class Guard(NamedTuple):
    """A function that falls through zero where `kind` happens and `after` takes over."""

    function: Callable[[float, State], float]
    kind: str
    detail: str
    branch: str
    after: int | None  # None: decided by the derivatives


def _mark(sign: int) -> str:
    return "+" if sign > 0 else "-"


def _first_sign(*derivatives: float) -> int:
    """The sign of a guard just after now: that of its first non-zero derivative."""
    return next((1 if value > 0.0 else -1 for value in derivatives if value != 0.0), 0)


class _Pendulum:
    """The right-hand side and its guards for one parameter set."""

    def __init__(self, parameters: Mapping[str, float], nT: float) -> None:
        self.p = SimpleNamespace(**parameters)
        self.nT = nT

    def torques(self, t: float, state: State, on: Branches) -> tuple[float, float]:
        """Torque [N m] on the column without its own friction M_L, and on the disk."""
        p = self.p
        phi1, v1, phi2, v2 = state
        kappa1, kappa2 = (p.kappa1_l, p.kappa2_l) if on.spring > 0 else (p.kappa1_r, p.kappa2_r)
        T_s2, T_02 = (p.T_s2_l, p.T_02_l) if on.v2 > 0 else (p.T_s2_r, p.T_02_r)
        phi_f = p.A * math.sin(p.omega * t + p.phase) - phi1
        f_s = phi_f * (kappa1 + kappa2 * phi_f * phi_f)
        R1 = p.k1 * (phi1 - on.column * p.phi1_s) + p.c1 * v1 if on.column else 0.0
        c2 = p.c2_l if on.disk > 0 else p.c2_r
        R2 = p.k2 * (phi2 - on.disk * p.phi2_s) + c2 * v2 if on.disk else 0.0
        z = p.alpha * v2
        decay = math.exp(-abs(z))  # 1/cosh without overflow in a rejected trial step
        sech = 2.0 * decay / (1.0 + decay * decay)
        M_T = T_s2 / (1.0 + T_02 * on.v2 * v2) * (1.0 + p.beta * sech) * math.tanh(z)
        return f_s - R1 + R2 + self.nT * M_T, -R2 - M_T

    def rates(self, t: float, state: State, on: Branches) -> tuple[float, float, float, float]:
        """Time derivatives of (phi1, v1, phi2, v2)."""
        p = self.p
        column, disk = self.torques(t, state, on)
        if on.v1:
            T_v1 = p.T_v1_l if on.v1 > 0 else p.T_v1_r
            a1 = (column - T_v1 * state[1] - on.v1 * p.T_b) / p.B1
        else:
            a1 = 0.0
        return float(state[1]), a1, float(state[3]), disk / p.B2 - a1

    def guards(self, on: Branches) -> list[Guard]:
        """All guards that can end a segment with these branches; each falls through zero."""
        found = self._edges("column", on.column, 0, self.p.phi1_s)
        found += self._edges("disk", on.disk, 2, self.p.phi2_s)
        if on.column == 0:
            found.append(
                Guard(
                    lambda t, y: on.spring * y[0],
                    "phi1 zero",
                    _mark(-on.spring),
                    "spring",
                    -on.spring,
                )
            )
        found.append(Guard(lambda t, y: on.v2 * y[3], "v2 zero", _mark(-on.v2), "v2", None))
        if on.v1:
            found.append(Guard(lambda t, y: on.v1 * y[1], "v1 zero", _mark(-on.v1), "v1", None))
        else:
            found += [self._release(on, s) for s in (1, -1)]
        return found

    @staticmethod
    def _edges(part: str, side: int, index: int, limit: float) -> list[Guard]:
        """The end of the contact on `side`, or without contact its begin on both sides."""

        def edge(s: int) -> Guard:
            if side:  # depth in the barrier
                return Guard(
                    lambda t, y: s * y[index] - limit, f"{part} contact end", _mark(s), part, 0
                )
            return Guard(  # gap to the barrier
                lambda t, y: limit - s * y[index], f"{part} contact begin", _mark(s), part, s
            )

        return [edge(s) for s in ((side,) if side else (1, -1))]

    def _release(self, on: Branches, s: int) -> Guard:
        """The end of the stick of v1 towards side s."""
        return Guard(
            lambda t, y: self.p.T_b - s * self.torques(t, y, on)[0], "stick end", _mark(s), "v1", s
        )

    def slip_sign(self, t: float, state: State, on: Branches) -> int:
        """The sign of v1 just after v1 = 0; 0 where dry friction holds the column."""
        torque = self.torques(t, state, on)[0]
        if abs(torque) <= self.p.T_b:
            return 0
        return 1 if torque > 0.0 else -1

    def settle(self, t: float, state: State) -> Branches:
        """Choose every branch at a start; a guard at zero goes by its first non-zero derivative."""
        p = self.p
        phi1, v1, phi2, v2 = state

        def side(phi: float, limit: float, v: float, a: float) -> int:
            gap = abs(phi) - limit
            s = 1 if phi > 0.0 else -1
            return s if _first_sign(gap, s * v, s * a) > 0 else 0

        on = Branches(
            side(phi1, p.phi1_s, v1, 0.0),
            side(phi2, p.phi2_s, v2, 0.0),
            _first_sign(phi1, v1) or 1,
            _first_sign(v1),
            _first_sign(v2) or 1,
        )
        # d_i = v_i = 0 on a guard with zero rate, so the torques do not depend on what is open.
        on = replace(on, v1=on.v1 or self.slip_sign(t, state, on))
        _, a1, _, a2 = self.rates(t, state, on)
        return replace(
            on,
            column=side(phi1, p.phi1_s, v1, a1),
            disk=side(phi2, p.phi2_s, v2, a2),
            spring=_first_sign(phi1, v1, a1) or 1,
            v2=_first_sign(v2, a2) or 1,
        )


def _terminal(
    function: Callable[[float, State], float], origin: Array, start: float
) -> Callable[[float, Array], float]:
    """End a segment where `function` falls through zero after its start.

    A guard that is zero at the start has just been crossed: there it counts as open, or the root
    finder would return the start in place of a later crossing within the first step.
    """

    def event(t: float, z: Array) -> float:
        value = function(t, z + origin)
        return max(value, TINY) if t == start else value

    event.terminal = True  # type: ignore[attr-defined]
    event.direction = -1.0  # type: ignore[attr-defined]
    return event


def solve(
    parameters: Mapping[str, float] | None = None,
    times: ArrayLike | None = None,
    nT: float = 1.0,
    as_printed: bool = False,
    *,
    start: State | None = None,
    rtol: float = 1e-11,
    atol: float = 1e-15,
    max_step: float = 0.01,
    stiff_method: Method = "LSODA",
) -> Solution:
    """Solve the pendulum segment by segment from event to event.

    `parameters` override PARAMETERS; `times` [s] default to 0..4 s every 0.01 s and start the run
    at times[0]; `as_printed` takes nT = 2 and kappa2_r in both branches of the spring; `start` is
    (phi1, v1, phi2, v2), by default the column at rest on its barrier at -phi1_s.
    `stiff_method` serves the column's contact where c1/B1 is too fast for DOP853.
    """
    p = PARAMETERS | dict(parameters or {})
    if unknown := set(p) - set(PARAMETERS):
        raise KeyError(f"unknown parameters {sorted(unknown)}")
    if as_printed:
        nT = 2.0
        p["kappa2_l"] = p["kappa2_r"]
    system = _Pendulum(p, nT)
    samples = np.arange(401) / 100.0 if times is None else np.asarray(times, dtype=float)
    y = np.array([-p["phi1_s"], 0.0, 0.0, 0.0] if start is None else start, dtype=float)
    t, t_end = float(samples[0]), float(samples[-1])
    on = system.settle(t, y)
    states = np.empty((4, samples.size))
    events: list[Event] = []
    filled = 0
    while True:
        guards = system.guards(on)
        stiff = on.column != 0 and p["c1"] / p["B1"] > 2000.0
        # In contact phi1 counts from the barrier: the column creeps off it at about 1e-4 rad/s, so
        # the tolerance must be relative to the depth or the end of the contact is lost.
        origin = np.array([on.column * p["phi1_s"], 0.0, 0.0, 0.0])
        run: Any = solve_ivp(
            lambda t, z, on=on, origin=origin: system.rates(t, z + origin, on),
            (t, t_end),
            y - origin,
            method=stiff_method if stiff else "DOP853",
            t_eval=samples[filled:],
            events=[_terminal(guard.function, origin, t) for guard in guards],
            rtol=rtol,
            atol=atol,
            max_step=max_step,
        )
        if not run.success:
            raise RuntimeError(f"segment from t={t} with {on}: {run.message}")
        if len(run.t):
            states[:, filled : filled + len(run.t)] = run.y + origin[:, None]
            filled += len(run.t)
        if run.status == 0:
            return Solution(samples, states, tuple(events))
        which = next(i for i, hit in enumerate(run.t_events) if hit.size)
        guard = guards[which]
        t, y = float(run.t_events[which][0]), run.y_events[which][0] + origin
        on, y, happened = _switch(system, t, y, on, guard)
        events.extend(happened)
        if t_end - t <= 4.0 * np.spacing(t_end):  # no segment left after an event at the end
            states[:, filled:] = y[:, None]
            return Solution(samples, states, tuple(events))


def _switch(
    system: _Pendulum, t: float, y: Array, on: Branches, guard: Guard
) -> tuple[Branches, Array, list[Event]]:
    """Branches and state just after an event; the guard's own state is set exactly on it."""
    happened = [Event(t, guard.kind, guard.detail)]
    sign = 1 if guard.detail == "+" else -1
    if guard.kind == "v1 zero":
        y[1] = 0.0
        after = system.slip_sign(t, y, on)
        if after == 0:
            happened.append(Event(t, "stick begin", guard.detail))
    elif guard.kind == "v2 zero":
        y[3] = 0.0
        after = _first_sign(system.rates(t, y, on)[3]) or -on.v2
    else:
        assert guard.after is not None
        after = guard.after
        if guard.branch == "column":
            y[0] = sign * system.p.phi1_s
        elif guard.branch == "disk":
            y[2] = sign * system.p.phi2_s
        elif guard.branch == "spring":
            y[0] = 0.0
    return replace(on, **{guard.branch: after}), y, happened
