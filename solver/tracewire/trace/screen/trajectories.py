"""The signals of a model along fitted windows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.residual import LIMITS, Segment, Windows, absolute_tolerances, of_diagram
from tracewire.solve import Span, SpanRuns, simulate_spans
from tracewire.trace.candidates.signal_scales import Trajectory

Signals = Mapping[str, Vector]


def series_of(windows: Windows) -> list[int]:
    """The number of the series behind each window, in the order of the windows."""
    names = list(dict.fromkeys(s.measured.name for s in windows.criterion.segments))
    return [names.index(s.measured.name) for s in windows.criterion.segments]


def nodes_of(segment: Segment) -> tuple[Vector, NDArray[np.intp], NDArray[np.bool_]]:
    """The times of a window's nodes, the samples behind them, and which of them count."""
    t = segment.measured.t
    inside = np.flatnonzero((t >= segment.begin) & (t <= segment.t[-1]))
    counts = np.isin(inside, segment.rows)
    times = t[inside]
    if times[0] > segment.begin:
        times = np.concatenate(([segment.begin], times))
        inside = np.concatenate((inside[:1], inside))
        counts = np.concatenate(([False], counts))
    return times, inside, counts


def simulate_signals(model: Model, windows: Windows, rtol: float) -> list[Signals]:
    """The recorded signals in fitted windows, at their nodes."""
    segments, numbers = windows.segments, series_of(windows)
    found: dict[int, Signals] = {}
    for number in range(max(numbers) + 1):
        mine = [n for n, of in enumerate(numbers) if of == number]
        spans = []
        for n in mine:
            times = nodes_of(segments[n])[0]
            spans.append(Span(float(times[0]), float(times[-1]), times, segments[n].start))
        runs = simulate_windows(model, windows, segments[mine[0]], spans, rtol)
        for row, n in enumerate(mine):
            rows = slice(int(runs.rows[row]), int(runs.rows[row + 1]))
            found[n] = {name: values[rows] for name, values in runs.signals.items()}
    return [found[n] for n in range(len(segments))]


def join_windows(windows: Windows, runs: Sequence[Signals]) -> list[Trajectory]:
    """The signals of each series along its windows.

    Where one window begins at the end of another, the end counts: a speed that its window hardly
    shows may begin far from any that the body has.
    """
    found: list[Trajectory] = []
    segments, numbers = windows.criterion.segments, series_of(windows)
    for number in range(max(numbers) + 1):
        mine = [n for n, of in enumerate(numbers) if of == number]
        t = segments[mine[0]].measured.t
        signals = {name: np.full(len(t), np.nan) for name in runs[mine[0]]}
        nodes = [nodes_of(segments[n])[1:] for n in mine]
        for inside in (False, True):
            for n, (samples, counts) in zip(mine, nodes, strict=True):
                written = counts == inside
                for name, values in signals.items():
                    values[samples[written]] = runs[n][name][written]
        known = np.flatnonzero(np.isfinite(next(iter(signals.values()), np.zeros(len(t)))))
        joined = {name: np.interp(t, t[known], values[known]) for name, values in signals.items()}
        of = segments[mine[0]].measured
        found.append(Trajectory(t, joined, of.series or of.name))
    return found


def simulate_windows(
    model: Model,
    windows: Windows,
    segment: Segment,
    spans: Sequence[Span],
    rtol: float,
    inputs: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
    asked: Sequence[str] = (),
) -> SpanRuns:
    """Runs of a model with the values of fitted windows, and what the series of a segment has.

    Raises SimulationError where one of them fails.
    """
    values = {**windows.criterion.parameters, **windows.values}
    runs = simulate_spans(
        model,
        spans,
        parameters=of_diagram(model, values, segment.measured),
        rtol=rtol,
        atol=absolute_tolerances(model, segment.measured, rtol),
        preset=segment.measured.preset,
        inputs={**segment.measured.inputs, **(inputs or {})},
        past=segment.measured.past,
        limits=LIMITS,
        sensitivities=asked,
    )
    for error in runs.errors.values():
        raise error
    return runs
