"""A recorded signal at even times, as spectra and growth rates want it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracewire.analyse.limits import SIGNAL
from tracewire.array_types import Vector
from tracewire.errors import OptionError, Problem
from tracewire.solve import Run

SI = ("", 1.0)


def users_unit_of(run: Run, name: str) -> tuple[str, float]:
    """The unit in which tables and figures show a signal, and its factor to SI."""
    shown = run.look(name)
    return shown.unit, shown.factor


@dataclass(frozen=True, eq=False)
class Signal:
    """A signal: its name, unit, times (N,) in s and values (N,) in SI."""

    name: str
    unit: str
    t: Vector
    values: Vector

    @property
    def step(self) -> float:
        """The time between two samples in s."""
        return float((self.t[-1] - self.t[0]) / (len(self.t) - 1))


def vertex(low: Vector, middle: Vector, high: Vector) -> Vector:
    """How far from the middle one of three samples, in samples, the parabola through them is
    largest; 0 where it is so nowhere."""
    bend = low - 2 * middle + high
    return np.where(bend < 0, 0.5 * (low - high) / np.where(bend < 0, bend, 1.0), 0.0)


def floor_of(run: Run, name: str) -> Vector:
    """The sizes (N,) below which a signal is noise of the run: a part of the largest so far.

    That of a state follows from its tolerances, that of a formula from the coarsest of all states.
    """
    part = run.resolved.get(name)
    if part is None:
        part = max((p for p in run.resolved.values() if p < 1), default=0.0)
    return part * np.maximum.accumulate(np.abs(run[name]))


def signal_of(
    run: Run, name: str, since: float | None, until: float | None, even: bool = True
) -> Signal:
    """A recorded signal of a run between two times in s. Raises OptionError."""
    values = run[name]
    low, high = -np.inf if since is None else since, np.inf if until is None else until
    chosen = (run.t >= low) & (run.t <= high)
    if chosen.sum() < SIGNAL.fewest_samples:
        what = f"'{name}' has {int(chosen.sum())} samples there, too few to say anything"
        hint = f"Take {SIGNAL.fewest_samples} at least: a longer time, or every=."
        raise OptionError([Problem(what, hint=hint)])
    t = run.t[chosen]
    steps = np.diff(t)
    if even and np.any(np.abs(steps - steps.mean()) > SIGNAL.even * steps.mean()):
        what = f"the samples of '{name}' are not at even times"
        raise OptionError([Problem(what, hint="Simulate with `every`, or even times=.")])
    return Signal(name, run.units.get(name, ""), t, values[chosen])
