"""Zeno: a contact whose impacts come faster and faster closes, and is held until it is pulled open.

An impact is a reset that turns the rate of its guard: g' < 0 before, g' >= 0 after (on the side
where g >= 0). With g'' < 0 the next flight lasts 2g'/|g''|. Where two flights in a row are below
what can be resolved and the second is the shorter one, or where the next could not be seen at all,
the contact closes at t + flight/(1 - ratio), the sum of the geometric series, and rests.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tracewire.solve.flow import Flow, Rest
from tracewire.solve.limits import Guardian
from tracewire.solve.settle import noise

Vector = NDArray[np.float64]
RESOLVED = 32.0  # a flight is resolved if it rises over so many times the noise of a guard
SHORTEST = 1e-11  # of the span
STOPPED = 1e-12  # of the rate before the impact


class Contacts:
    """The impacts of a run, and the contacts that come to rest."""

    def __init__(self, flow: Flow, guardian: Guardian) -> None:
        self.flow, self.guardian = flow, guardian
        self.flights: dict[int, tuple[float, bool]] = {}

    def turns(self, t: float, before: Vector, after: Vector, mode: int, up: bool) -> bool:
        """Whether a reset at a guard that went `up` (or down) is an impact."""
        side = -1.0 if up else 1.0
        slope, _ = self.flow.curve(t, after, mode)
        old = side * float(self.flow.guard_rates(t, before)[mode])
        new = side * float(self.flow.guard_rates(t, after)[mode])
        stays = abs(self.flow.guards(t, after)[mode] - self.flow.guards(t, before)[mode])
        pushed = side * float(slope @ (after - before)) > 0
        return bool(old < 0 and new >= STOPPED * old and pushed and stays <= noise(before))

    def waits(self, t: float, before: Vector, after: Vector, mode: int, up: bool) -> float | None:
        """The time until the contact closes; None where it flies on."""
        side = -1.0 if up else 1.0
        slope, late = self.flow.curve(t, after, mode)
        rate = max(0.0, side * float(self.flow.guard_rates(t, after)[mode]))
        bend = side * (float(slope @ self.flow.rates(t, after)) + late)
        old = side * float(self.flow.guard_rates(t, before)[mode])
        if not bend < 0:
            self.flights.pop(mode, None)
            return None
        flight = -2 * rate / bend
        height = rate * flight / 4
        small = height <= RESOLVED * noise(after) or flight <= SHORTEST * self.guardian.span
        last, was_small = self.flights.get(mode, (np.inf, False))
        self.flights[mode] = flight, small
        if rate <= -STOPPED * old:
            return 0.0
        lost = height <= noise(after)  # the next impact could not be seen
        closes = flight < last and (lost or (small and was_small))
        return flight / (1 - flight / last) if closes else None

    def struck(self, t: float, before: Vector, after: Vector) -> set[int]:
        """Let the contacts go that a reset has torn open; their modes.

        Raises SimulationError where a reset drives a contact that rests into its surface.
        """
        flow = self.flow
        jump = after - before
        opened: set[int] = set()
        for rest in flow.rests if jump.any() else ():
            slope, _ = flow.curve(t, after, rest.mode)
            change = float(slope @ jump) * float(np.sign(slope @ rest.push))
            if abs(change) <= STOPPED * float(np.abs(slope) @ np.abs(jump)):
                continue
            if change < 0:
                mode = flow.model.modes[rest.mode]
                what = f"a reset drives the contact '{mode.text}', which rests, into its surface"
                hint = (
                    "Impacts that pass through a contact at rest are not known: give it a spring."
                )
                raise self.guardian.stopped(t, before, what, hint, mode.signal)
            opened.add(rest.mode)
        flow.release(opened)
        return opened

    def shrinks(self, mode: int) -> bool:
        """Whether the flights of a contact are being followed: its many impacts are no chatter."""
        return mode in self.flights

    def close(self, t: float, before: Vector, after: Vector, mode: int) -> Vector:
        """Let the contact rest; the states with its guard's rate zero."""
        push = (after - before) / np.max(np.abs(after - before))
        slope, _ = self.flow.curve(t, after, mode)
        rate = float(self.flow.guard_rates(t, after)[mode])
        self.flow.rests = (*self.flow.rests, Rest(mode, push))
        self.flights.pop(mode, None)
        return np.asarray(after - push * (rate / float(slope @ push)))
