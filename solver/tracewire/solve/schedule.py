"""Known times: guards that only read t change at times that are computed, not searched."""

from __future__ import annotations

import math

from tracewire.solve.flow import Flow
from tracewire.solve.settle import right_limit

TOGETHER = 1e-13


class Schedule:
    """The next change of every timed mode of a flow."""

    def __init__(self, flow: Flow) -> None:
        self.flow = flow
        self.timed = [i for i, mode in enumerate(flow.model.modes) if mode.timed is not None]

    def lines(self, t: float) -> list[tuple[int, float, float]]:
        """(mode, slope a, value b) of every timed guard a*t + b."""
        if not self.timed:
            return []
        flow = self.flow
        frozen = (flow.modes, flow.holds)
        zeros = [0.0] * len(flow.model.states)
        values = flow.functions["timed"](t, zeros, frozen, flow.constants, flow.tables)
        pairs = zip(values[::2], values[1::2], strict=True)
        return [(i, a, b) for i, (a, b) in zip(self.timed, pairs, strict=True)]

    def begin(self, t: float) -> None:
        """Set the timed modes to their right limit at t."""
        for _ in range(len(self.timed) + 1):  # the times of one mode may depend on another
            for i, slope, offset in self.lines(t):
                guard = slope * t + offset
                mode = self.flow.model.modes[i]
                self.flow.modes[i] = right_limit(self.flow, mode, slope, guard)

    def next(self, t: float) -> tuple[float, list[tuple[int, float]]]:
        """The next time at which modes change, and (mode, new value) of each; infinity if none.

        A change that an event has overtaken by rounding is due now.
        """
        best = math.inf
        due: list[tuple[float, int, float]] = []
        for i, slope, offset in self.lines(t):
            change = self.change(i, slope)
            if change is None:
                continue
            level, value = change
            time = max(t, (level - offset) / slope)
            due.append((time, i, value))
            best = min(best, time)
        near = best + TOGETHER * max(1.0, abs(best))
        return best, [(i, value) for time, i, value in due if time <= near]

    def change(self, i: int, slope: float) -> tuple[float, float] | None:
        """The level that a timed guard reaches next, and the mode beyond it."""
        mode, value = self.flow.model.modes[i], self.flow.modes[i]
        if slope == 0.0 or not math.isfinite(slope):
            return None
        if mode.kind == "sign":
            beyond = 1.0 if slope > 0 else 0.0
            return None if value == beyond else (0.0, beyond)
        if mode.kind == "floor":
            return (value + 1.0, value + 1.0) if slope > 0 else (value, value - 1.0)
        points = self.flow.tables[mode.table][0]
        piece = int(value)
        if slope > 0:
            return None if piece >= len(points) else (points[piece], value + 1.0)
        return None if piece <= 0 else (points[piece - 1], value - 1.0)
