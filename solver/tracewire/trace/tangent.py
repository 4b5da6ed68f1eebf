"""The tangent: what a small torque at any place, at any time, does to what is measured.

The fitted windows are run again in pieces of a few samples. In each, hat functions in time enter at
every place, and the sensitivities of the run, events included, say what the states and the measured
signals make of them. Pieces are then joined: the answer to any history of a torque, and to any
number of them, is a product of small matrices, without another run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model, compile
from tracewire.diagram import Diagram
from tracewire.fit.criterion import LIMITS
from tracewire.fit.segment import Segment, of_diagram, parameter_in
from tracewire.solve import Run, simulate
from tracewire.trace.levels import Trajectory, signals_at
from tracewire.trace.places import Place
from tracewire.trace.probe import probed
from tracewire.trace.windows import Windows

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
NODES = 13
"""Samples of a piece: few hats at a time keep a run cheap, many pieces cost runs."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A few samples of a window: how outputs and states there answer to its start, the unknowns and
    the hats, shapes (nodes, outputs + states, ...); `nodes` index the nodes of the window."""

    nodes: slice
    start: Matrix
    unknowns: Matrix
    hats: Matrix


@dataclass(frozen=True, eq=False)
class Joined:
    """A window in pieces. `times` are its nodes, `samples` the rows of the series behind them,
    `counts` says which nodes are residuals."""

    window: int
    times: Vector
    samples: NDArray[np.intp]
    counts: NDArray[np.bool_]
    pieces: tuple[Piece, ...]


class Tangent:
    """The windows of a fit, linearised in torques at places."""

    def __init__(
        self, diagram: Diagram, windows: Windows, places: Sequence[Place], rtol: float
    ) -> None:
        self.windows = windows
        self.places = [place for place in places if place.kind != "sensor"]
        criterion = windows.criterion
        self.outputs = criterion.segments[0].signals
        self.states = criterion.model.states
        self.probes: tuple[tuple[str, ...], ...]
        text, self.probes = probed(diagram, self.places, NODES)
        self.hats = [name for name in text.inputs if name not in diagram.inputs]
        record = list(dict.fromkeys((*self.outputs, *self.states)))
        self.model = compile(text, record=record, backend="quick")
        wanted = dict.fromkeys((*record, *signals_at(self.places)))
        observer = compile(diagram, record=list(wanted), backend="quick")
        self.rtol = rtol
        self.series = series_of(windows)
        runs = observed(observer, windows, rtol)
        self.trajectories = stitched(windows, runs)
        pairs = enumerate(zip(windows.segments, runs, strict=True))
        self.joined = [self._joined(n, segment, run) for n, (segment, run) in pairs]

    def answer(self, histories: Mapping[str, Sequence[Matrix]]) -> Matrix:
        """What torques do to the residuals in sigma, shape (M, K), before anything is projected.

        `histories` gives, for some places, for each series, (N, k) torques at its samples; the
        columns stand in the order of the places given.
        """
        return np.concatenate([self.window_answer(joined, histories) for joined in self.joined])

    @property
    def size(self) -> int:
        """The number of residuals."""
        return sum(near.residual.size for near in self.windows.near)

    def sensed(self, effect: str, signal: str) -> Vector:
        """What a small coefficient of a sensor's effect does to the residuals, shape (M,)."""
        parts = []
        for joined, number in zip(self.joined, self.series, strict=True):
            run = self.trajectories[number]
            segment = self.windows.criterion.segments[joined.window]
            rows = joined.samples[joined.counts]
            y, t = run.signals[signal], run.t
            shown = {
                "sensor_offset": np.ones(len(t)),
                "sensor_gain": y,
                "sensor_delay": -np.gradient(y, t),
                "sensor_quad": y**2,
                "sensor_drift": t - t[0],
            }[effect]
            column = np.zeros((len(rows), len(self.outputs)))
            at = self.outputs.index(signal)
            sigma = self.windows.criterion.sigma[segment.measured.name][at]
            column[:, at] = shown[rows] / sigma
            parts.append(column.ravel())
        return np.concatenate(parts)

    def window_answer(self, joined: Joined, histories: Mapping[str, Sequence[Matrix]]) -> Matrix:
        """The same for one window."""
        order = {place.name: n for n, place in enumerate(self.places)}
        number = self.series[joined.window]
        columns = sum(given[number].shape[1] for given in histories.values())
        m = len(self.outputs)
        state = np.zeros((len(self.states), columns))
        rows = np.zeros((len(joined.times), m, columns))
        for piece in joined.pieces:
            out = piece.start @ state
            samples = joined.samples[piece.nodes]
            first = 0
            for name, given in histories.items():
                last = first + given[number].shape[1]
                hats = piece.hats[:, :, order[name], :]
                out[:, :, first:last] += hats @ given[number][samples]
                first = last
            rows[piece.nodes] = out[:, :m]
            state = out[-1, m:]
        segment = self.windows.criterion.segments[joined.window]
        scale = self._shown(segment)[:, None]
        return np.asarray((rows[joined.counts] * scale).reshape(-1, columns))

    def _shown(self, segment: Segment) -> Vector:
        """By how many sigma the sensors show a change of each signal."""
        values = {**self.windows.criterion.parameters, **self.windows.values}
        sigma = self.windows.criterion.sigma[segment.measured.name]
        gains = [
            values.get(f"gain.{signal}", segment.measured.sensor(signal).gain)
            for signal in segment.signals
        ]
        return np.asarray(np.array(gains) / sigma)

    def _joined(self, n: int, segment: Segment, run: Run) -> Joined:
        times, samples, counts = nodes_of(segment)
        pieces = []
        for first in range(0, max(len(times) - 1, 1), NODES - 1):
            nodes = slice(first, min(first + NODES, len(times)))
            pieces.append(self._piece(segment, run, times, nodes))
        return Joined(n, times, samples, counts, tuple(pieces))

    def _piece(self, segment: Segment, run: Run, times: Vector, nodes: slice) -> Piece:
        t = times[nodes]
        start = {name: float(run[name][nodes.start]) for name in self.states}
        count = len(t)
        identity = np.eye(NODES)
        hats = {name: (t, identity[j, :count]) for j, name in enumerate(self.hats[:count])}
        known = (parameter_in(name, segment.measured) for name in self.windows.values)
        own = [name for name in known if name]
        starts = [f"start.{name}" for name in self.states]
        probes = [name for names in self.probes for name in names[:count]]
        found = run_of(
            self.model, self.windows, segment, start, t, self.rtol, hats, [*starts, *own, *probes]
        )
        signals = found.sensitivities.signals
        rows = [signals.index(name) for name in (*self.outputs, *self.states)]
        answers = found.sensitivities.array[:, rows].transpose(2, 1, 0)
        of_starts, of_unknowns, of_hats = np.split(
            answers, [len(starts), len(starts) + len(own)], axis=2
        )
        shape = count, len(rows), len(self.places), count
        return Piece(nodes, of_starts, of_unknowns, of_hats.reshape(shape))


def series_of(windows: Windows) -> list[int]:
    """The number of the series behind each window, in the order of the windows."""
    names = list(dict.fromkeys(s.measured.name for s in windows.criterion.segments))
    return [names.index(s.measured.name) for s in windows.criterion.segments]


def trajectories(model: Model, windows: Windows, rtol: float) -> list[Trajectory]:
    """The recorded signals of a model along fitted windows, for each series."""
    return stitched(windows, observed(model, windows, rtol))


def observed(model: Model, windows: Windows, rtol: float) -> list[Run]:
    """The runs of fitted windows, sampled at their nodes."""
    return [
        run_of(model, windows, segment, segment.start, nodes_of(segment)[0], rtol)
        for segment in windows.segments
    ]


def stitched(windows: Windows, runs: Sequence[Run]) -> list[Trajectory]:
    """The signals of each series along its windows."""
    found: list[Trajectory] = []
    segments, numbers = windows.criterion.segments, series_of(windows)
    for number in range(max(numbers) + 1):
        mine = [n for n, of in enumerate(numbers) if of == number]
        t = segments[mine[0]].measured.t
        signals = {name: np.full(len(t), np.nan) for name in runs[mine[0]].signals}
        for n in mine:
            samples = nodes_of(segments[n])[1]
            for name, values in signals.items():
                values[samples] = runs[n][name]
        known = np.flatnonzero(np.isfinite(next(iter(signals.values()), np.zeros(len(t)))))
        joined = {name: np.interp(t, t[known], values[known]) for name, values in signals.items()}
        of = segments[mine[0]].measured
        found.append(Trajectory(t, joined, of.series or of.name))
    return found


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


def run_of(
    model: Model,
    windows: Windows,
    segment: Segment,
    start: Mapping[str, float],
    times: Vector,
    rtol: float,
    hats: Mapping[str, tuple[Vector, Vector]] | None = None,
    asked: Sequence[str] = (),
) -> Run:
    """A run of a model with the values of fitted windows."""
    values = {**windows.criterion.parameters, **windows.values}
    return simulate(
        model,
        parameters=of_diagram(values, segment.measured),
        start=start,
        span=(float(times[0]), float(times[-1])),
        times=times,
        rtol=rtol,
        preset=segment.measured.preset,
        inputs={**segment.measured.inputs, **(hats or {})},
        limits=LIMITS,
        sensitivities=asked,
    )
