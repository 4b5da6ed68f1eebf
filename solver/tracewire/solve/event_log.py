"""The log of a run: from the rows that the core writes to events."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import cast

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.solve.core.arrays import Arrays
from tracewire.solve.core.codes import EVENTS, LOG_HEAD, LOGGED
from tracewire.solve.run import Event, EventDirection, EventKind

UNASKED = [EVENTS.index("crossing"), EVENTS.index("scheduled")]  # a reset is logged as such


class Log:
    """What a run has logged: rows (LOG_HEAD + 2n + q,) as the core writes them, each of them with
    how the instant moves with what is asked for.

    What is made for events only is left out when somebody looks: many runs are never asked.
    """

    def __init__(self, model: Model, asked: tuple[str, ...]) -> None:
        self.model, self.asked = model, asked
        self._parts: list[Matrix] = []
        self._looked_through = 0  # of the parts
        self.most = 0
        """As many rows there are at most, before one has looked."""

    def take(self, arrays: Arrays) -> None:
        """Take what the core has logged."""
        logged = int(arrays.progress.ints[LOGGED])
        if logged:
            parts = [arrays.progress.log[:logged]]
            if self.asked:
                parts.append(arrays.sensitivity.times[:logged])
            self._parts.append(np.concatenate(parts, axis=1))
            arrays.progress.ints[LOGGED] = 0
            self.most += logged

    def copy(self) -> Log:
        """What is there now; the run may go on."""
        log = Log(self.model, self.asked)
        log._parts, log._looked_through, log.most = [*self._parts], self._looked_through, self.most
        return log

    def clear(self) -> None:
        """Forget all of it."""
        self._parts, self._looked_through, self.most = [], 0, 0

    @property
    def parts(self) -> list[Matrix]:
        """The rows, in the order in which they were taken."""
        parts = self._parts
        for number in range(self._looked_through, len(parts)):
            parts[number] = _shown(self.model, parts[number])
        self._looked_through, self.most = len(parts), sum(len(rows) for rows in parts)
        return parts

    def __len__(self) -> int:
        return sum(len(rows) for rows in self.parts)

    @property
    def rows(self) -> Matrix:
        """The rows in the order of time: (events, LOG_HEAD + 2n + q)."""
        width = LOG_HEAD + 2 * len(self.model.states) + len(self.asked)
        rows = np.concatenate(self.parts) if self._parts else np.empty((0, width))
        return rows[np.argsort(rows[:, 0], kind="stable")]

    @property
    def events(self) -> tuple[Event, ...]:
        """The events, in the order of time."""
        rows = self.rows
        events = (_event(self.model, row, self.asked) for row in rows)
        return tuple(_owned(self.model, events, rows))


def _shown(model: Model, rows: Matrix) -> Matrix:
    """The rows of a log without what is made for events: an event whose guard jumps is a reset, and
    one that waits for the other direction is none."""
    silent = np.isin(rows[:, 2], list(model.only_triggers))
    if np.any(silent):
        rows = rows[~(silent & np.isin(rows[:, 1], UNASKED))]
    rows = _once(model, rows)
    jumps = np.array([mode.jumps for mode in model.modes])
    if not np.any(jumps != ""):
        return rows
    of = jumps[rows[:, 2].astype(np.int64)]
    fires = ((of == "up") | (of == "down")) & (rows[:, 3] > 0)
    rows[fires, 1] = EVENTS.index("reset")
    rows[of == "down", 3] = -1
    kept: Matrix = rows[(of == "") | fires]
    return kept


def _once(model: Model, rows: Matrix) -> Matrix:
    """The rows of a log without comparisons of a signal whose crossing another row shows."""
    signals = np.array(model.compared_signals)
    if not len(signals):
        return rows
    of = rows[:, 2].astype(np.int64)
    compares = np.array([mode.compares for mode in model.modes])[of]
    order = np.lexsort((np.arange(len(rows)), compares, signals[of], rows[:, 0]))
    again = np.zeros(len(rows), dtype=bool)
    times, signals = rows[order, 0], signals[of[order]]
    again[order[1:]] = (times[1:] == times[:-1]) & (signals[1:] == signals[:-1])
    kept: Matrix = rows[~(again & compares & np.isin(rows[:, 1], UNASKED))]
    return kept


def _event(model: Model, row: Vector, asked: tuple[str, ...]) -> Event:
    time_, kind, mode, direction = float(row[0]), int(row[1]), int(row[2]), int(row[3])
    where, n = model.modes[mode], len(model.states)
    ways: dict[int, EventDirection] = {1: "up", -1: "down", 0: ""}
    sides = row[LOG_HEAD : LOG_HEAD + 2 * n].tolist()
    moved = row[LOG_HEAD + 2 * n :].tolist()
    return Event(
        time=time_,
        kind=cast(EventKind, EVENTS[kind]),
        block=where.signal,
        guard=where.text,
        direction=ways[direction],
        before=dict(zip(model.states, sides[:n], strict=True)),
        after=dict(zip(model.states, sides[n:], strict=True)),
        sensitivity=dict(zip(asked, moved, strict=True)),
    )


def _owned(model: Model, events: Iterable[Event], rows: Matrix) -> Iterator[Event]:
    """The events; of several with one guard each names its own block, in the order of the model."""
    shared, seen = model.shared_triggers, Counter[tuple[float, int]]()
    for event, row in zip(events, rows, strict=True):
        mode = int(row[2])
        if mode in shared and event.kind in ("reset", "impact"):
            fits = [r for r in shared[mode] if r.direction in ("both", event.direction)]
            yield replace(event, block=fits[seen[event.time, mode] % len(fits)].owner)
            seen[event.time, mode] += 1
        else:
            yield event
