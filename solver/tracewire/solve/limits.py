"""What keeps a run from hanging, and the words when it stops: block, signal, time, remedy."""

from __future__ import annotations

import math
import time
from collections import Counter, deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.errors import Place, Problem, SimulationError
from tracewire.solve.flow import Flow
from tracewire.solve.methods import Step

Vector = NDArray[np.float64]
CHATTER_EVENTS = 50
CHATTER_PART = 1e-6


@dataclass(frozen=True)
class Limits:
    """Limits of one run: accepted and rejected steps, and wall time in s."""

    steps: int = 2_000_000
    seconds: float = 600.0


def place_of(model: Model, name: str) -> Place:
    """The place of the block behind a signal or a state."""
    block = model.flat.blocks.get(name)
    place = block.place if block else Place()
    return Place(place.file, place.line, place.column, name)


class Guardian:
    """Counts steps, events and seconds of a run."""

    def __init__(self, flow: Flow, span: float, limits: Limits) -> None:
        self.flow, self.span, self.limits = flow, span, limits
        self.steps = 0
        self.rejected = 0
        self.stiff_steps = 0
        self.began = time.perf_counter()
        self.recent: deque[tuple[float, int]] = deque(maxlen=CHATTER_EVENTS)

    @property
    def seconds(self) -> float:
        """Wall time since the run began."""
        return time.perf_counter() - self.began

    def smallest_step(self, t: float) -> float:
        """The step below which a run cannot go on."""
        return max(1e-15 * self.span, 16 * float(np.spacing(abs(t))))

    def tried(self, t: float, x: Vector) -> None:
        """Count a trial step."""
        self.steps += 1
        if self.steps > self.limits.steps:
            raise self.stopped(t, x, f"more than {self.limits.steps} steps", "Loosen rtol.")
        if self.steps % 64 == 0 and self.seconds > self.limits.seconds:
            what = f"more than {self.limits.seconds:g} s of wall time"
            raise self.stopped(t, x, what, "Shorten the span, loosen rtol or raise the limit.")

    def happened(self, t: float, mode: int, x: Vector) -> None:
        """Count an event; many in next to no time are chatter."""
        self.recent.append((t, mode))
        full = len(self.recent) == CHATTER_EVENTS
        if full and t - self.recent[0][0] < CHATTER_PART * self.span:
            often = Counter(m for _, m in self.recent).most_common(1)[0][0]
            where = self.flow.model.modes[often]
            what = (
                f"the guard '{where.text}' changed its mode again and again: "
                f"{CHATTER_EVENTS} events within {t - self.recent[0][0]:.3g} s"
            )
            hint = "Give the block hysteresis or a stick level, or let the contact lose its energy."
            raise self.stopped(t, x, what, hint, where.signal)

    def stopped(self, t: float, x: Vector, what: str, hint: str, name: str = "") -> SimulationError:
        """The error of a run that cannot go on: time, values, block and remedy."""
        states = zip(self.flow.model.states, x.tolist(), strict=True)
        values = ", ".join(f"{state} = {value:.6g}" for state, value in states)
        place = place_of(self.flow.model, name) if name else Place()
        text = f"the run stopped at t = {t:.9g} s: {what}; {values}"
        return SimulationError([Problem(text, place, (), hint)])

    def underflow(self, t: float, x: Vector, step: Step, scale: Vector) -> SimulationError:
        """The error of a step that became too small: not finite, or an error that stays large."""
        if not np.isfinite(step.error).all():
            name, value = self.not_finite(t, step.x)
            if not name:
                name, value = self.not_finite(t + step.h, step.x_end)
            what = f"'{name}' is not finite ({value})" if name else "the rates are not finite"
            hint = "Look for a division by zero, the root of a negative number, or a run-away."
            return self.stopped(t, x, what, hint, name)
        worst = int(np.argmax(np.abs(step.error) / scale))
        name = self.flow.model.states[worst]
        what = f"the step became smaller than {self.smallest_step(t):.3g} s because of '{name}'"
        hint = "The state may run away, or jump without a guard; try method='rosenbrock'."
        return self.stopped(t, x, what, hint, name)

    def not_finite(self, t: float, x: Vector) -> tuple[str, float]:
        """The first signal that is not finite, in the order in which they are computed."""
        for name, value in zip(self.flow.model.states, x.tolist(), strict=True):
            if not math.isfinite(value):
                return name, value
        names, values = self.flow.model.all_signals(
            t,
            x.tolist(),
            (self.flow.modes, self.flow.holds),
            self.flow.parameters,
            self.flow.tables,
        )
        for name, value in zip(names, values, strict=True):
            if not math.isfinite(value):
                return name, value
        return "", math.nan
