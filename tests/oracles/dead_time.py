"""`motor_with_dead_time` of the gallery by hand: scipy between switches, samples as a difference.

It shares no code with the solver. A friction and the teeth are modes that events of scipy end.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Vector = NDArray[np.float64]
PERIOD, LATE, STEP = 0.004, 0.01, 0.05  # s
R, L, K, MOTOR, LOAD = 1.2, 2e-3, 0.05, 2e-4, 3e-4
KP, KI, KD, N, LIMIT = 6.0, 8.0, 0.35, 200.0, 12.0
TEETH, DAMPING, HALF = 30.0, 0.02, np.radians(2.0) / 2
SLIP, STICK = (0.01, 0.008), (0.015, 0.012)
CURRENT, MOTOR_RATE, MOTOR_ANGLE, LOAD_RATE, LOAD_ANGLE = range(5)
RATES = (MOTOR_RATE, LOAD_RATE)


@dataclass
class Modes:
    """The signs of both frictions, 0 where one sticks; the side of the teeth; whether they push."""

    friction: list[int] = field(default_factory=lambda: [0, 0])
    side: int = 0
    push: bool = False


def integrated(end: float, every: float) -> Vector:
    """The states (N, 5) at the times 0, every, ... end: current, motor rate and angle, load."""
    times = np.arange(round(end / every) + 1) * every
    found = np.zeros((len(times), 5))
    modes, z, t, voltage = Modes(), np.zeros(5), 0.0, 0.0
    integral = smooth = 0.0
    before: float | None = None
    direct = KD * N / (1 + N * PERIOD)
    count = int(end / PERIOD) + 1
    ticks = [(round(i * PERIOD, 9), "tick", i) for i in range(count)]
    arrivals = [(round(i * PERIOD + LATE, 9), "arrival", i) for i in range(count)]
    commands = np.zeros(count)
    for time, kind, i in sorted([*ticks, *arrivals, (end, "end", 0)]):
        if time > end:
            break
        z = _flown(t, time, z, voltage, modes, times, found)
        t = time
        if kind == "arrival":
            voltage = commands[i]
        elif kind == "tick":
            if before is not None:
                integral += PERIOD * KI * before
                smooth = (smooth + direct * before) / (1 + N * PERIOD) - direct * before
            before = float(t >= STEP) - z[LOAD_ANGLE]
            command = KP * before + integral + smooth + direct * before
            commands[i] = min(max(command, -LIMIT), LIMIT)
    found[-1] = z
    return found


def _push(z: Vector, side: int) -> float:
    """What the teeth of a side do to the load, if they do not pull."""
    apart = z[MOTOR_ANGLE] - z[LOAD_ANGLE] - side * HALF
    return float(TEETH * apart + DAMPING * (z[MOTOR_RATE] - z[LOAD_RATE]))


def _without_friction(z: Vector, modes: Modes) -> tuple[float, float]:
    """The torques on motor and load but for the frictions."""
    teeth = _push(z, modes.side) if modes.push else 0.0
    return K * z[CURRENT] - teeth, teeth


def _events(modes: Modes) -> list[tuple[Callable[[Vector], float], int, tuple[str, int]]]:
    """What ends the modes: a function, the direction of its crossing, and what it is."""
    found: list[tuple[Callable[[Vector], float], int, tuple[str, int]]] = []
    for body, rate in enumerate(RATES):
        sign = modes.friction[body]
        if sign:
            found.append((lambda z, rate=rate: z[rate], -sign, ("stop", body)))
            continue
        for way in (1, -1):

            def beyond(z: Vector, body: int = body, way: int = way) -> float:
                return way * _without_friction(z, modes)[body] - STICK[body]

            found.append((beyond, 1, ("forward" if way > 0 else "back", body)))
    if not modes.side:
        for side in (1, -1):

            def depth(z: Vector, side: int = side) -> float:
                return float(side * (z[MOTOR_ANGLE] - z[LOAD_ANGLE]) - HALF)

            found.append((depth, 1, ("touch", side)))
        return found
    side = modes.side
    found.append((lambda z: side * (z[MOTOR_ANGLE] - z[LOAD_ANGLE]) - HALF, -1, ("leave", 0)))
    found.append((lambda z: side * _push(z, side), -1 if modes.push else 1, ("turn", 0)))
    return found


def _break_away(z: Vector, modes: Modes) -> None:
    for body, torque in enumerate(_without_friction(z, modes)):
        if not modes.friction[body] and abs(torque) > STICK[body]:
            modes.friction[body] = int(np.sign(torque))


def _flown(
    t: float, end: float, z: Vector, voltage: float, modes: Modes, times: Vector, found: Vector
) -> Vector:
    """The states at `end`; those at the times before it go into `found`."""
    _break_away(z, modes)
    while t < end:

        def rates(_: float, z: Vector) -> list[float]:
            torques = _without_friction(z, modes)
            rest = [
                (torque - sign * SLIP[body]) if sign else 0.0
                for body, (torque, sign) in enumerate(zip(torques, modes.friction, strict=True))
            ]
            electric = (voltage - K * z[MOTOR_RATE] - R * z[CURRENT]) / L
            return [electric, rest[0] / MOTOR, z[MOTOR_RATE], rest[1] / LOAD, z[LOAD_RATE]]

        events, functions = _events(modes), []
        for function, direction, _ in events:

            def event(_: float, z: Vector, function: Callable[[Vector], float] = function) -> float:
                return function(z)

            event.terminal, event.direction = True, direction  # type: ignore[attr-defined]
            functions.append(event)
        run = solve_ivp(
            rates, (t, end), z, method="DOP853", rtol=1e-11, atol=1e-14, events=functions,
            dense_output=True,
        )  # fmt: skip
        inside = np.flatnonzero((times >= t) & (times < run.t[-1]))
        if len(inside):
            found[inside] = run.sol(times[inside]).T
        t, z = float(run.t[-1]), run.y[:, -1].copy()
        for (_, _, what), hits in zip(events, run.t_events, strict=True):
            if len(hits):
                _switch(what, z, modes)
        _break_away(z, modes)
    return z


def _switch(what: tuple[str, int], z: Vector, modes: Modes) -> None:
    kind, which = what
    if kind == "stop":
        z[RATES[which]] = 0.0
        modes.friction[which] = 0
    elif kind in ("forward", "back"):
        modes.friction[which] = 1 if kind == "forward" else -1
    elif kind == "touch":
        modes.side, modes.push = which, which * _push(z, which) >= 0
    elif kind == "leave":
        modes.side, modes.push = 0, False
    else:
        modes.push = not modes.push
