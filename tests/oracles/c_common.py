"""Integration with restarts for the independent solutions of paper C: plain scipy, DOP853.

A smooth system needs `smooth`. A system with events is a set of modes, each with rates of its own
and exits: a mode is left where the guard of an exit falls through zero, or at a known time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
Rates = Callable[[float, Array], ArrayLike]
Leave = Callable[[float, Array], tuple[str, Array]]
"""From the time and the states before an event to the next mode and the states after it."""


class Exit(NamedTuple):
    """`guard(t, x)` is positive while the mode lasts; `leave` is asked where it falls to zero."""

    guard: Callable[[float, Array], float]
    leave: Leave


class Known(NamedTuple):
    """A time [s] at which the mode changes whatever the states are."""

    time: float
    leave: Leave


@dataclass(frozen=True)
class Mode:
    """Rates and exits while nothing happens."""

    rates: Rates
    exits: Sequence[Exit] = ()


class Change(NamedTuple):
    """An event: its time [s], the mode before it and the mode after it."""

    time: float
    before: str
    after: str


@dataclass(frozen=True)
class Path:
    """States (n, N) at the times (N,) in s, the right limit at an event; and the events."""

    t: Array
    states: Array
    changes: tuple[Change, ...] = ()


def smooth(
    rates: Rates,
    start: ArrayLike,
    times: ArrayLike,
    *,
    begin: float = 0.0,
    rtol: float = 1e-12,
    atol: float = 1e-13,
    method: str = "DOP853",
) -> Array:
    """The states (n, N) at ascending times (N,) of a system without events, from `begin` in s."""
    samples = np.asarray(times, dtype=float)
    run: Any = solve_ivp(
        rates,
        (begin, float(samples[-1])),
        np.asarray(start, dtype=float),
        method=method,
        t_eval=samples,
        rtol=rtol,
        atol=atol,
    )
    if not run.success:
        raise RuntimeError(run.message)
    return np.asarray(run.y)


def integrate(
    modes: Mapping[str, Mode],
    mode: str,
    start: ArrayLike,
    times: ArrayLike,
    *,
    known: Sequence[Known] = (),
    begin: float = 0.0,
    max_step: float = np.inf,
    rtol: float = 1e-12,
    atol: float = 1e-13,
) -> Path:
    """Integrate from event to event.

    mode: the first one. known: ascending times of changes after `begin`. max_step: in s, so short
    that no guard crosses twice within it.
    """
    samples = np.asarray(times, dtype=float)
    x, t, end = np.array(start, dtype=float), float(begin), float(samples[-1])
    out = np.empty((x.size, samples.size))
    filled = 0
    changes: list[Change] = []
    ahead = [change for change in known if begin < change.time <= end]
    while True:
        until = ahead[0].time if ahead else end
        exits = modes[mode].exits
        if until > t:
            run: Any = solve_ivp(
                modes[mode].rates,
                (t, until),
                x,
                method="DOP853",
                dense_output=True,
                events=[_terminal(leave.guard, t) for leave in exits],
                max_step=max_step,
                rtol=rtol,
                atol=atol,
            )
            if not run.success:
                raise RuntimeError(f"mode {mode} from t={t}: {run.message}")
            here = (samples >= t) & (samples < run.t[-1])
            if here.any():
                out[:, here] = run.sol(samples[here])
            filled = int(np.searchsorted(samples, run.t[-1]))
            hit = [n for n, found in enumerate(run.t_events or ()) if found.size]
            t, x = float(run.t[-1]), run.y[:, -1].copy()
        else:
            hit = []
        if hit:
            after, x = exits[hit[0]].leave(t, x)
        elif ahead:
            after, x = ahead.pop(0).leave(t, x)
        else:
            out[:, filled:] = x[:, None]
            return Path(samples, out, tuple(changes))
        changes.append(Change(t, mode, after))
        mode, x = after, np.asarray(x, dtype=float)


def _terminal(
    guard: Callable[[float, Array], float], begin: float
) -> Callable[[float, Array], float]:
    """End a segment where the guard falls through zero after its start, where it may be zero."""

    def event(t: float, x: Array) -> float:
        value = guard(t, x)
        return max(value, 1e-300) if t == begin else value

    event.terminal = True  # type: ignore[attr-defined]
    event.direction = -1.0  # type: ignore[attr-defined]
    return event
