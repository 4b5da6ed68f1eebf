"""Cutting a measured series into segments that a model can follow from their starts."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.errors import SimulationError
from tracewire.fit.methods.following import PARTS, followed, spread_of
from tracewire.formula import evaluate
from tracewire.residual import Criterion, Segment, difference, of_diagram, start_from_data
from tracewire.solve import Run, parameter_values

Vector = NDArray[np.float64]
FEWEST = 10
"""Samples of a segment, at least."""
MOST = 300
"""Segments of a series, at most."""
LONGER = 4
"""How many times longer than the longest so far the next segment may be."""


def cut(model: Model, whole: Criterion, segment: Segment) -> list[Segment]:
    """A segment in parts, each as long as the model follows it from its start; all but the first
    have free starts.

    They begin at the states that the data tell; the other states are those to which the part before
    has come. `model` records all states.
    """
    named, starts = whole.split(whole.begin())
    follower = Criterion(model, [], whole.unknowns, whole.parameters, whole.rtol)
    values = {**whole.parameters, **named}
    own = starts[whole.segments.index(segment)]
    spread = spread_of(segment, PARTS)
    least = max(FEWEST, -(-len(segment.rows) // MOST))
    now = _begin(model, values, segment, own)
    firsts, guessed, longest = [0], [now], least
    while firsts[-1] + least < len(segment.rows):
        first = firsts[-1]
        last = min(first + LONGER * longest, len(segment.rows) - 1)
        rows = segment.rows[first : last + 1]
        part = replace(segment, begin=float(segment.t[first]), rows=rows)
        length = least
        run: Run | None = None
        with suppress(SimulationError):
            run, sensing = follower.run(part, named, own if first == 0 else now)
            off = difference(part.measured, part.samples(), sensing.shown(run))
            length = max(least, followed(off, spread))
        longest = max(longest, min(length, last - first))
        after = min(first + length, last)
        if after + least >= len(segment.rows):
            break  # the last part is rather longer than too short
        if run is not None:
            row = int(np.searchsorted(run.t, segment.t[after]))
            now = {name: float(run[name][min(row, len(run.t) - 1)]) for name in model.states}
        now = now | start_from_data(model, segment.measured, int(segment.rows[after]))
        firsts.append(after)
        guessed.append(now)
    return [
        _part(model, whole, segment, slice(first, after), start)
        for first, after, start in zip(
            firsts, [*firsts[1:], len(segment.rows)], guessed, strict=True
        )
    ]


def _part(
    model: Model, whole: Criterion, segment: Segment, rows: slice, start: dict[str, float]
) -> Segment:
    """A part of a segment, which counts as much as its samples do in the whole."""
    taken = segment.rows[rows]
    share = segment.measured.weight
    if whole.weighting == "mean":
        share *= len(taken) / len(segment.rows)
    measured = replace(segment.measured, weight=share)
    if rows.start == 0:
        return replace(segment, measured=measured, rows=taken)
    begin = float(segment.t[rows.start])
    return Segment(measured, begin, taken, start, tuple(model.states))


def _begin(
    model: Model, values: dict[str, float], segment: Segment, own: dict[str, float]
) -> dict[str, float]:
    """The states at the begin of a segment."""
    known = parameter_values(model, of_diagram(values, segment.measured), segment.measured.preset)
    there = {s.name: evaluate(s.start, known, s.place) for s in model.flat.states}
    return {**there, **segment.start, **own}
