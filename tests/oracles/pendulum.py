"""Independent solution of one damped pendulum with true dry friction.

    theta'' = -w0_squared sin(theta) - c theta' - f_c sign(theta') - c_q theta'|theta'|
              + (A/J) sin(2 pi f t)

The sign of theta' is frozen in each segment, which ends where theta' reaches zero. There the
pendulum stays (theta' = 0) as long as |(A/J) sin(2 pi f t) - w0_squared sin(theta)| <= f_c.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
Guard = Callable[[float, Array], float]
Rates = Callable[[float, Array], tuple[float, float]]


class Event(NamedTuple):
    """One located event: time [s] and kind (`turn`, `stick begin`, `stick end`)."""

    time: float
    kind: str


@dataclass(frozen=True)
class Swing:
    """Times [s], angle theta [rad] and rate omega [rad/s] at them (N each), and the events."""

    t: Array
    theta: Array
    omega: Array
    events: tuple[Event, ...]


def _terminal(function: Guard, start: float) -> Guard:
    """End a segment where `function` falls through zero after its start.

    A guard that is zero at the start has just been crossed: there it counts as open, or the root
    finder would return the start in place of a later crossing within the first step.
    """

    def event(t: float, y: Array) -> float:
        value = function(t, y)
        return max(value, 1e-300) if t == start else value

    event.terminal = True  # type: ignore[attr-defined]
    event.direction = -1.0  # type: ignore[attr-defined]
    return event


def solve(
    times: ArrayLike,
    theta: float,
    omega: float = 0.0,
    *,
    w0_squared: float,
    c: float = 0.0,
    f_c: float = 0.0,
    c_q: float = 0.0,
    A: float = 0.0,
    J: float = 1.0,
    f: float = 0.0,
    rtol: float = 1e-12,
    atol: float = 1e-13,
) -> Swing:
    """Solve from (theta, omega) at times[0].

    Units: times s, theta rad, omega rad/s, w0_squared 1/s2, c 1/s, f_c rad/s2, c_q 1/rad,
    A N m, J kg m2, f Hz.
    """
    samples = np.asarray(times, dtype=float)
    drive = A / J

    def pull(t: float, angle: float) -> float:
        """The acceleration [rad/s2] without any friction."""
        return drive * math.sin(2.0 * math.pi * f * t) - w0_squared * math.sin(angle)

    def pull_rate(t: float) -> float:
        """The time derivative of `pull` at rest."""
        return drive * 2.0 * math.pi * f * math.cos(2.0 * math.pi * f * t)

    def sign_from_rest(t: float, angle: float) -> int:
        """The sign of theta' just after theta' = 0; 0 where friction holds."""
        a = pull(t, angle)
        if abs(a) < f_c or a == 0.0:
            return 0
        if abs(a) == f_c and a * pull_rate(t) <= 0.0:
            return 0
        return 1 if a > 0.0 else -1

    def segment(s: int, start: float) -> tuple[Rates, list[Guard]]:
        """Rates of (theta, theta') and terminal guards for a sign of theta', or 0 for sticking."""
        if s == 0:
            right = _terminal(lambda t, y: f_c - pull(t, y[0]), start)
            left = _terminal(lambda t, y: f_c + pull(t, y[0]), start)
            return lambda t, y: (0.0, 0.0), [right, left]

        def rates(t: float, y: Array) -> tuple[float, float]:
            w = float(y[1])
            return w, pull(t, y[0]) - c * w - s * (f_c + c_q * w * w)

        return rates, [_terminal(lambda t, y: s * y[1], start)]

    t, t_end = float(samples[0]), float(samples[-1])
    y = np.array([theta, omega], dtype=float)
    sign = int(np.sign(omega)) or sign_from_rest(t, theta)
    events = [Event(t, "stick begin")] if sign == 0 else []
    out = np.empty((2, samples.size))
    filled = 0
    while True:
        rates, guards = segment(sign, t)
        run: Any = solve_ivp(
            rates,
            (t, t_end),
            y,
            method="DOP853",
            t_eval=samples[filled:],
            events=guards,
            rtol=rtol,
            atol=atol,
            # A guard must not cross twice within one step.
            max_step=0.05 / max(math.sqrt(w0_squared), f, 1e-3),
        )
        if not run.success:
            raise RuntimeError(f"segment from t={t}: {run.message}")
        if len(run.t):
            out[:, filled : filled + len(run.t)] = run.y
            filled += len(run.t)
        if run.status == 0:
            return Swing(samples, out[0], out[1], tuple(events))
        which = next(i for i, hit in enumerate(run.t_events) if hit.size)
        t, y = float(run.t_events[which][0]), run.y_events[which][0].copy()
        y[1] = 0.0
        if sign:
            sign = sign_from_rest(t, y[0])
            events.append(Event(t, "turn" if sign else "stick begin"))
        else:
            sign = (1, -1)[which]
            events.append(Event(t, "stick end"))
        if t_end - t <= 4.0 * np.spacing(t_end):  # no segment left after an event at the end
            out[:, filled:] = y[:, None]
            return Swing(samples, out[0], out[1], tuple(events))
