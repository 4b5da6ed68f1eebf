"""Independent solutions of those of C19 to C31 of paper C that have events, on scipy alone.

Each is a set of modes with smooth rates, integrated from event to event. Numbers are written here
once more, not read from the diagrams.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, exp, pi, sin

import numpy as np
from oracles.c_common import Array, Exit, Known, Leave, Mode, Path, integrate

G = 9.81


def to(mode: str) -> Leave:
    """Go on in another mode from the same states."""
    return lambda t, x: (mode, x)


# --- C22: the length is 1.1 in the mode `long` and 0.9 in `short`


def step_length(times: Array, kept: bool, omega: float = 6.0) -> Path:
    """phi and phi' of the pendulum whose length jumps; `kept`: l^2 phi' is, else phi'."""
    lengths = {"long": 1.1, "short": 0.9}

    def swing(length: float) -> Mode:
        return Mode(lambda t, x: [x[1], -G / length * sin(x[0])])

    def jump(before: str, after: str) -> Leave:
        factor = (lengths[before] / lengths[after]) ** 2 if kept else 1.0
        return lambda t, x: (after, np.array([x[0], x[1] * factor]))

    out, back = jump("long", "short"), jump("short", "long")
    count = int(times[-1] * omega / pi)
    known = [Known(n * pi / omega, out if n % 2 else back) for n in range(1, count + 1)]
    modes = {name: swing(length) for name, length in lengths.items()}
    return integrate(modes, "long", [0.2, 0.0], times, known=known)


# --- C23: phi, phi', theta, theta'

I1, C1, I2, C2, TF = 0.0725, 0.01, 0.02, 0.002, 0.05


def torque(t: float, phi: float) -> float:
    """Of gravity and excitation on the pendulum."""
    m, length, amplitude, omega = 1.0, 0.25, 0.05, 12.0
    return -(m * omega**2 * amplitude * length * cos(omega * t) + m * G * length) * sin(phi)


def free(t: float, x: Array) -> list[float]:
    """The clutch open, the flywheel turning."""
    return [x[1], (torque(t, x[0]) - C1 * x[1]) / I1, x[3], (-C2 * x[3] - TF) / I2]


def standing(t: float, x: Array) -> list[float]:
    """The clutch open, the flywheel at rest."""
    return [x[1], (torque(t, x[0]) - C1 * x[1]) / I1, 0.0, 0.0]


def engaged(t: float, x: Array) -> list[float]:
    """Both as one body."""
    a = (torque(t, x[0]) - (C1 + C2) * x[1] - TF) / (I1 + I2)
    return [x[1], a, x[1], a]


def held(t: float, x: Array) -> float:
    """The torque that the clutch has to carry while it is engaged."""
    return float(I2 * engaged(t, x)[1] + C2 * x[1] + TF)


def stopped(t: float, x: Array) -> tuple[str, Array]:
    return "standing", np.array([x[0], x[1], x[2], 0.0])


def caught(t: float, x: Array) -> tuple[str, Array]:
    """The pendulum has the rate of the flywheel, and drives it on."""
    x = np.array([x[0], x[3], x[2], x[3]])
    assert held(t, x) > 0
    return "engaged", x


def printed_harvester(times: Array) -> Path:
    """C23a: the flywheel runs down from 10 rad/s, whatever the pendulum does."""
    modes = {"free": Mode(free, [Exit(lambda t, x: x[3], stopped)]), "standing": Mode(standing)}
    return integrate(modes, "free", [0.5, 0.0, 0.0, 10.0], times)


def clutched_harvester(times: Array) -> Path:
    """C23b: at the start the pendulum swings away from the flywheel, which is at rest."""
    modes = {
        "standing": Mode(standing, [Exit(lambda t, x: -x[1], caught)]),
        "engaged": Mode(engaged, [Exit(held, to("free"))]),
        "free": Mode(
            free, [Exit(lambda t, x: x[3] - x[1], caught), Exit(lambda t, x: x[3], stopped)]
        ),
    }
    return integrate(modes, "standing", [0.5, 0.0, 0.0, 0.0], times, max_step=0.05)


# --- C29 and C30: the tank on a belt

MT, K, VB, MUS, MUD, VS = 10.0, 100.0, 0.2, 0.4, 0.2, 0.1
M1, L1, CS = 2.0, 0.3, 0.02


def falling(slip: float) -> float:
    """The coefficient of friction while the belt runs ahead of the tank."""
    return MUD + (MUS - MUD) * exp(-slip / VS)


def solid_tank(times: Array, kinetic: bool = False) -> Path:
    """C30: x and x'; `kinetic` (C30k): it slips at the lower coefficient alone."""

    def slipping(t: float, x: Array) -> list[float]:
        mu = MUD if kinetic else falling(VB - x[1])
        return [x[1], -K * x[0] / MT + mu * G]

    def holds(t: float, x: Array) -> float:
        return float(MUS * MT * G - abs(K * x[0]))

    return on_the_belt(slipping, lambda t, x: [VB, 0.0], holds, [0.0, VB], times)


def liquid_tank(times: Array) -> Path:
    """C29: x, x', phi, phi'."""

    def slipping(t: float, x: Array) -> list[float]:
        s, c, w = sin(x[2]), cos(x[2]), x[3]
        mu = falling(VB - x[1])
        mass = [[MT, M1 * L1 * (c - mu * s)], [M1 * L1 * c, M1 * L1**2]]
        right = [
            mu * (MT * G + M1 * L1 * w**2 * c) + M1 * L1 * w**2 * s - K * x[0],
            -M1 * G * L1 * s - CS * w,
        ]
        a, b = np.linalg.solve(mass, right)
        return [x[1], a, w, b]

    def sticking(t: float, x: Array) -> list[float]:
        return [VB, 0.0, x[3], -G / L1 * sin(x[2]) - CS * x[3] / (M1 * L1**2)]

    def holds(t: float, x: Array) -> float:
        s, c, w, b = sin(x[2]), cos(x[2]), x[3], sticking(t, x)[3]
        load = MT * G + M1 * L1 * (b * s + w**2 * c)
        return float(MUS * load - abs(K * x[0] + M1 * L1 * (b * c - w**2 * s)))

    return on_the_belt(slipping, sticking, holds, [0.0, VB, 0.1, 0.0], times)


def on_the_belt(
    slipping: Callable[[float, Array], list[float]],
    sticking: Callable[[float, Array], list[float]],
    holds: Callable[[float, Array], float],
    start: list[float],
    times: Array,
) -> Path:
    """Stick until `holds` falls to zero, slip until the tank has the belt's speed again."""

    def stuck(t: float, x: Array) -> tuple[str, Array]:
        x = np.array([x[0], VB, *x[2:]])
        assert holds(t, x) > 0
        return "stick", x

    modes = {
        "stick": Mode(sticking, [Exit(holds, to("slip"))]),
        "slip": Mode(slipping, [Exit(lambda t, x: VB - x[1], stuck)]),
    }
    return integrate(modes, "stick", start, times, max_step=0.05)


ANGLE = ("phi", "phi_dot")
HARVESTER = (*ANGLE, "theta", "theta_dot")
TANK = ("x", "x_dot")
CASES: dict[str, tuple[Callable[[Array], Path], tuple[str, ...], float]] = {
    "C22_l2w": (lambda times: step_length(times, True), ANGLE, 20),
    "C22_w": (lambda times: step_length(times, False), ANGLE, 20),
    "C23a": (printed_harvester, HARVESTER, 5),
    "C23b": (clutched_harvester, HARVESTER, 5),
    "C29": (liquid_tank, (*TANK, *ANGLE), 10),
    "C30": (solid_tank, TANK, 10),
    "C30k": (lambda times: solid_tank(times, kinetic=True), TANK, 10),
}
"""By case: the solution, the names of its states, and the end in s."""
