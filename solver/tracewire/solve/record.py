"""What a run keeps: samples of the recorded signals, and the log of events."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tracewire.solve.flow import Flow
from tracewire.solve.methods import Method, Step
from tracewire.solve.run import Event, EventDirection, EventKind

Vector = NDArray[np.float64]


class Recorder:
    """Samples at given times and the events of one run."""

    def __init__(self, flow: Flow, times: Vector) -> None:
        model = flow.model
        self.flow, self.times = flow, times
        self.states = model.states
        self.signals = np.full((len(times), len(model.recorded)), np.nan)
        positions = {name: i for i, name in enumerate(model.states)}
        self.direct = [(n, positions[r]) for n, r in enumerate(model.recorded) if r in positions]
        self.computed = [n for n, r in enumerate(model.recorded) if r not in positions]
        self.done = 0
        self.events: list[Event] = []

    def inside(self, method: Method, step: Step, end: float) -> None:
        """Fill the samples of a step that lie before `end`."""
        stop = int(np.searchsorted(self.times, end, side="left"))
        if stop <= self.done:
            return
        times = self.times[self.done : stop]
        thetas = (times - step.t) / step.h
        self.fill(self.done, method.inside(step, thetas[:, np.newaxis]), times)
        self.done = stop

    def last(self, t: float, x: Vector) -> None:
        """Fill the samples that lie at the end of the run."""
        count = len(self.times) - self.done
        if count:
            self.fill(self.done, np.tile(x, (count, 1)), np.full(count, t))
            self.done = len(self.times)

    def fill(self, row: int, at: Vector, times: Vector) -> None:
        """Fill the samples from `row` on with states `at` (m, n) and what is computed of them."""
        rows = slice(row, row + len(at))
        for column, state in self.direct:
            self.signals[rows, column] = at[:, state]
        if self.computed:
            values = np.stack([self.flow.outputs(t, x) for t, x in zip(times, at, strict=True)])
            self.signals[rows, self.computed] = values[:, self.computed]

    def log(
        self,
        time: float,
        kind: EventKind,
        mode: int,
        direction: EventDirection,
        before: Vector,
        after: Vector,
    ) -> None:
        """Add an event to the log."""
        where = self.flow.model.modes[mode]
        names = self.states
        self.events.append(
            Event(
                time=float(time),
                kind=kind,
                block=where.signal,
                guard=where.text,
                direction=direction,
                before=dict(zip(names, before.tolist(), strict=True)),
                after=dict(zip(names, after.tolist(), strict=True)),
            )
        )
