"""What happens at an instant: resets from x⁻ to x⁺, then the modes come to rest, then the log."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tracewire.errors import Problem, SimulationError
from tracewire.solve.flow import Flow, Rest
from tracewire.solve.limits import Guardian, place_of
from tracewire.solve.record import Recorder
from tracewire.solve.rest import Contacts
from tracewire.solve.run import EventDirection, EventKind
from tracewire.solve.settle import noise, settle

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Crossing:
    """A level that is reached: by a guard, a fraction of a slide, a contact's force, the time.

    `to` is the value of the mode beyond, `up` the way the guard went.
    """

    mode: int
    to: float
    up: bool
    kind: Literal["guard", "fraction", "force", "timed"] = "guard"


class Transition:
    """Carries a flow over the events of one instant."""

    def __init__(self, flow: Flow, recorder: Recorder, guardian: Guardian) -> None:
        self.flow, self.recorder, self.guardian = flow, recorder, guardian
        self.contacts = Contacts(flow, guardian)

    def happen(self, t: float, x: Vector, crossings: Sequence[Crossing]) -> Vector:
        """Fire what is due, settle the modes and log it; x⁺."""
        flow, contacts = self.flow, self.contacts
        old = (tuple(flow.modes), flow.sliding, flow.rests)
        due = self.due({c.mode: c.up for c in crossings if c.kind in ("guard", "timed")})
        after = self.reset(t, x, due)
        fired = {flow.model.lowered.resets[number][0] for number in due}
        impacts = [
            c
            for c in crossings
            if c.kind == "guard" and c.mode in fired and contacts.turns(t, x, after, c.mode, c.up)
        ]
        turned = {c.mode for c in impacts}
        zero, left = self.cross(t, x, after, [c for c in crossings if c.mode not in turned])
        left |= contacts.struck(t, x, after)
        settle(flow, t, after, zero, left | turned)
        waits: dict[int, float] = {}
        for c in impacts:
            wait = contacts.waits(t, x, after, c.mode, c.up)
            if wait is not None:
                waits[c.mode] = wait
        for mode in waits:
            after = contacts.close(t, x, after, mode)
        if waits:
            settle(flow, t, after, (), left | turned)
        self.log(t, x, after, crossings, fired, old, waits)
        for c in crossings:
            if c.kind != "timed" and not contacts.shrinks(c.mode):
                self.guardian.happened(t, c.mode, after)
        return after

    def due(self, ups: Mapping[int, bool]) -> list[int]:
        """The numbers of the resets whose guard crossed in their direction."""
        resets = self.flow.model.lowered.resets
        return [
            number
            for number, (mode, crosses, _) in enumerate(resets)
            if mode in ups and crosses in ("both", "up" if ups[mode] else "down")
        ]

    def overlooked(self, t: float, x: Vector) -> list[str]:
        """Warnings of resets whose guard is zero at the start and leaves as if it fired."""
        flow = self.flow
        guards, level = flow.guards(t, x), noise(x)
        resets = zip(flow.model.flat.events, flow.model.lowered.resets, strict=True)
        return [
            f"the start at t = {t:g} s lies on the guard of {event.name}, which does not fire there"
            for event, (mode, crosses, _) in resets
            if abs(guards[mode]) <= level
            and flow.model.modes[mode].timed is None
            and not flow.is_bound(mode)
            and crosses == ("up" if flow.modes[mode] else "down")
        ]

    def reset(self, t: float, x: Vector, due: Sequence[int]) -> Vector:
        """The states after all resets, each of which reads x⁻."""
        model = self.flow.model
        after = x.copy()
        written: dict[int, tuple[str, float]] = {}
        for number in due:
            _, _, values = model.lowered.resets[number]
            name = model.flat.events[number].name
            for state, value in zip(values, self.flow.call(f"reset_{number}", t, x), strict=True):
                which = model.states[state]
                if not math.isfinite(value):
                    what = f"{name} sets '{which}' to {value}"
                    raise self.guardian.stopped(t, x, what, "Correct its formula.", which)
                old = written.setdefault(state, (name, value))
                if old[1] != value:
                    what = (
                        f"two resets write '{which}' at t = {t:.9g} s: "
                        f"{old[0]} gives {old[1]:.6g}, {name} gives {value:.6g}"
                    )
                    place = place_of(model, which)
                    raise SimulationError([Problem(what, place, (), "Merge the two events.")])
                after[state] = value
        return after

    def cross(
        self, t: float, x: Vector, after: Vector, crossings: Sequence[Crossing]
    ) -> tuple[list[int], set[int]]:
        """Set the modes that are known; the guards that are zero, and the slides that were left."""
        flow = self.flow
        guards, moved = flow.guards(t, x), flow.guards(t, after)
        zero: list[int] = []
        left: set[int] = set()
        for crossing in crossings:
            mode = crossing.mode
            if crossing.kind == "fraction":  # to the side that it reached, stored
                flow.sliding = tuple(i for i in flow.sliding if i != mode)
                flow.modes[mode], flow.holds[mode] = crossing.to, 0.0
                left.add(mode)
            elif crossing.kind == "force":
                flow.release([mode])
                left.add(mode)
            elif crossing.kind == "timed" or flow.model.modes[mode].kind != "sign":
                flow.modes[mode] = crossing.to
            elif abs(moved[mode] - guards[mode]) <= noise(x):
                zero.append(mode)
        return zero, left

    def log(
        self,
        t: float,
        before: Vector,
        after: Vector,
        crossings: Sequence[Crossing],
        fired: set[int],
        old: tuple[Sequence[float], tuple[int, ...], tuple[Rest, ...]],
        waits: Mapping[int, float],
    ) -> None:
        """Log what crossed, and every other mode that changed with it."""
        flow = self.flow
        modes, sliding, rests = old
        held = {*sliding, *(rest.mode for rest in rests)}
        entered = set(flow.sliding) - held
        gone = {mode for mode in held if not flow.is_bound(mode)}

        def add(kind: EventKind, mode: int, direction: EventDirection, time: float = t) -> None:
            self.recorder.log(time, kind, mode, direction, before, after)

        for crossing in crossings:
            mode, silent = crossing.mode, flow.model.modes[crossing.mode].kind == "segment"
            direction: EventDirection = "up" if crossing.up else "down"
            if mode in fired:
                add("reset", mode, direction)
            elif not (silent or mode in gone or mode in entered):
                add("scheduled" if crossing.kind == "timed" else "crossing", mode, direction)
        known = {crossing.mode for crossing in crossings}
        for mode, value in enumerate(modes):
            up = flow.modes[mode] > (0.5 if mode in gone else value)
            changed = flow.modes[mode] != value and flow.model.modes[mode].kind != "segment"
            if mode in entered:
                add("stick", mode, "")
            elif mode in gone:
                add("slip", mode, "up" if up else "down")
            elif mode in waits:
                add("rest", mode, "", t + waits[mode])
            elif changed and mode not in known and not flow.is_bound(mode):
                add("crossing", mode, "up" if up else "down")
