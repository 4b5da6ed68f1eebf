"""Cutting a measured series into segments that a model can follow from their starts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.errors import SimulationError
from tracewire.fit.methods.following import PARTS, followed, spread_of
from tracewire.formula import evaluate
from tracewire.residual import LIMITS, Criterion, Segment, Sensing, of_diagram, start_from_data
from tracewire.solve import Interrupted, Run, parameter_values, simulate

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
        run = _run(model, whole, values, part, {**segment.start, **own} if first == 0 else now)
        length = least
        if run is not None:
            sensing = Sensing([part], values)
            off = _around(part, sensing.shown(run) - part.samples())
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


def _around(segment: Segment, off: Vector) -> Vector:
    """Differences of signals with a period, the shortest way around."""
    for column, signal in enumerate(segment.signals):
        period = segment.measured.periods.get(signal, 0.0)
        if period > 0:
            off[:, column] -= period * np.round(off[:, column] / period)
    return off


def _run(
    model: Model,
    whole: Criterion,
    values: dict[str, float],
    part: Segment,
    start: dict[str, float],
) -> Run | None:
    """The run of a part, None where it fails."""
    sensing = Sensing([part], values)
    try:
        return simulate(
            model,
            parameters=of_diagram(values, part.measured),
            start=start,
            span=(sensing.begins[0], sensing.ends[0]),
            times=sensing.times[0],
            rtol=whole.rtol,
            preset=part.measured.preset,
            inputs=part.measured.inputs,
            limits=LIMITS,
        )
    except Interrupted as error:
        raise KeyboardInterrupt from error
    except SimulationError:
        return None
