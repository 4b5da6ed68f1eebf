"""Series beside the model: what the sensors show over whole series, before and after a fit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.fit.result import Comparison
from tracewire.fit.weighing import noise_instead_of_units
from tracewire.residual import (
    Criterion,
    Measured,
    Segment,
    own_unknowns,
    solve_least_squares,
    wrap_to_period,
)


def outputs_by_series(
    criterion: Criterion, z: Vector, others: Sequence[Segment]
) -> dict[str, Vector]:
    """What the sensors show (N, signals) by series, with samples that do not count; NaN where no
    segment is. `others` get free start values, and free parameters, of their own.

    Raises SimulationError where a run fails.
    """
    named, starts = criterion.unpack(z)
    found: dict[str, Vector] = {}
    for segment, start in zip(criterion.segments, starts, strict=True):
        _fill(found, criterion, segment, named, start)
    for segment in others:
        own: Mapping[str, float] = {}
        fixed = {**criterion.parameters, **named}
        free = [u for u in own_unknowns([segment.measured]) if u.name not in fixed]
        if segment.free or free:
            sigma = noise_instead_of_units(criterion.model, [segment.measured])
            alone = Criterion(criterion.model, [segment], free, fixed, criterion.rtol, sigma)
            numbers, (own,) = alone.unpack(solve_least_squares(alone, alone.initial_unknowns()).z)
            fixed |= numbers
        _fill(found, criterion, segment, fixed, own)
    return found


def _fill(
    found: dict[str, Vector],
    criterion: Criterion,
    segment: Segment,
    named: Mapping[str, float],
    start: Mapping[str, float],
) -> None:
    """Put what a segment shows into the rows of its series; rows before those that count, too."""
    measured = segment.measured
    rows = segment.rows
    before = np.flatnonzero((measured.t < measured.counts_from) & (measured.t >= segment.begin))
    if len(before) and len(rows) and before[-1] == rows[0] - 1:
        rows = np.concatenate((before, rows))
    shown = criterion.outputs(replace(segment, rows=rows), named, start)
    whole = found.setdefault(measured.name, np.full((len(measured.t), shown.shape[1]), np.nan))
    whole[rows] = shown


def compare_series(
    model: Model,
    series: Sequence[Measured],
    before: Mapping[str, Vector],
    after: Mapping[str, Vector],
) -> tuple[Comparison, ...]:
    """Every signal of every series beside what is shown before and after."""
    units = model.flat.units
    return tuple(
        Comparison(
            series=m.name,
            use=m.use,
            signal=signal,
            unit=units.get(signal, ""),
            t=m.t,
            measured=values,
            before=_on_turns(m, signal, before[m.name][:, n]),
            after=_on_turns(m, signal, after[m.name][:, n]),
            counts=m.t >= m.counts_from,
            period=m.periods.get(signal, 0.0),
            sigma=m.sigma.get(signal),
            users_unit=model.users_unit(signal),
        )
        for m in series
        for n, (signal, values) in enumerate(m.values.items())
    )


def _on_turns(series: Measured, signal: str, shown: Vector) -> Vector:
    """What a model shows of a signal (N,) on the turns of what was measured, those of the first
    sample that counts."""
    period = series.periods.get(signal, 0.0)
    if period <= 0:
        return shown
    measured, first = series.values[signal], int(np.argmax(series.t >= series.counts_from))
    return measured - wrap_to_period(measured - shown, period, first)
