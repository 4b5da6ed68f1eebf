"""The torque linearisation: what a small torque at any place, at any time, does to what is
measured.

The fitted windows are run again in pieces of a few samples. In each, hat functions in time enter at
every place, and the sensitivities of the run, events included, say what the states and the measured
signals make of them. Pieces are then joined: the answer to any history of a torque, and to any
number of them, is a product of small matrices, without another run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Matrix, Vector
from tracewire.compile import compile
from tracewire.diagram import Diagram
from tracewire.library import SENSOR_TERMS
from tracewire.residual import Segment, Windows
from tracewire.solve import Span
from tracewire.trace.candidates.places import Place
from tracewire.trace.candidates.signal_scales import signals_at
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.probes import add_probes
from tracewire.trace.screen.trajectories import (
    Signals,
    join_windows,
    nodes_of,
    series_of,
    simulate_signals,
    simulate_windows,
)


@dataclass(frozen=True, eq=False)
class Piece:
    """A few samples of a window: how outputs and states there answer to its start and to the hats,
    shapes (nodes, outputs + states, ...); `nodes` index the nodes of the window."""

    nodes: slice
    start: Matrix
    hats: Matrix


@dataclass(frozen=True, eq=False)
class WindowPieces:
    """A window in pieces. `times` are its nodes, `samples` the rows of the series behind them,
    `counts` says which nodes are residuals."""

    index: int
    times: Vector
    samples: NDArray[np.intp]
    counts: NDArray[np.bool_]
    pieces: tuple[Piece, ...]


class TorqueLinearisation:
    """The windows of a fit, linearised in torques at places."""

    def __init__(
        self,
        diagram: Diagram,
        windows: Windows,
        places: Sequence[Place],
        rtol: float,
        options: TraceOptions,
    ) -> None:
        self.windows = windows
        self.options = options
        self.along_data = False
        """Whether the windows follow the data, by torques that are to be explained."""
        self.places = [place for place in places if place.kind != "sensor"]
        criterion = windows.criterion
        self.outputs = criterion.segments[0].signals
        self.states = criterion.model.states
        self.probes: tuple[tuple[str, ...], ...]
        text, self.probes = add_probes(diagram, self.places, options.screen.nodes)
        self.hats = [name for name in text.inputs if name not in diagram.inputs]
        record = list(dict.fromkeys((*self.outputs, *self.states)))
        self.model = compile(text, record=record, backend="quick")
        wanted = dict.fromkeys((*record, *signals_at(self.places)))
        observer = compile(diagram, record=list(wanted), backend="quick")
        self.rtol = rtol
        self.series = series_of(windows)
        runs = simulate_signals(observer, windows, rtol)
        self.trajectories = join_windows(windows, runs)
        groups: dict[tuple[int, float], list[int]] = {}
        for n, segment in enumerate(windows.segments):
            early = min(segment.begin, float(segment.measured.t[0]))
            groups.setdefault((self.series[n], early), []).append(n)
        window_pieces = [
            one for group in groups.values() for one in self._linearise_group(group, runs)
        ]
        self.window_pieces = sorted(window_pieces, key=lambda one: one.index)

    def along_torques(self, torques: Mapping[str, Sequence[Matrix]]) -> TorqueLinearisation:
        """The same windows along the data: the residual is what the torques given, (N, 1) for each
        series by place, did to bring them there."""
        near = []
        for window, one in zip(self.window_pieces, self.windows.linearisations, strict=True):
            done = self.window_response(window, torques).sum(axis=1)
            near.append(replace(one, residual=one.residual - np.reshape(done, one.residual.shape)))
        found = copy(self)
        found.windows = replace(self.windows, linearisations=tuple(near))
        found.along_data = True
        return found

    def samples_in(self, windows: Sequence[int]) -> list[NDArray[np.intp]]:
        """The samples of each series in these windows, by number."""
        found = [[np.zeros(0, dtype=np.intp)] for _ in self.trajectories]
        for n in windows:
            found[self.series[n]].append(self.window_pieces[n].samples)
        return [np.unique(np.concatenate(samples)) for samples in found]

    @property
    def size(self) -> int:
        """The number of residuals."""
        return sum(near.residual.size for near in self.windows.linearisations)

    def sensor_response(self, effect: str, signal: str) -> Vector:
        """What a small coefficient of a sensor's effect does to the residuals, shape (M,)."""
        parts = []
        for window, number in zip(self.window_pieces, self.series, strict=True):
            run = self.trajectories[number]
            segment = self.windows.criterion.segments[window.index]
            rows = window.samples[window.counts]
            y, t = run.signals[signal], run.t
            term = SENSOR_TERMS[effect.removeprefix("sensor_")]
            slope = -np.gradient(y, t) if term.slope is None else term.slope(y, t - t[0])
            shown = np.broadcast_to(slope, len(t))
            column = np.zeros((len(rows), len(self.outputs)))
            at = self.outputs.index(signal)
            sigma = self.windows.criterion.sigma[segment.measured.name][at]
            column[:, at] = shown[rows] / sigma
            parts.append(self.windows.criterion.whiten(window.index, column.ravel()))
        return np.concatenate(parts)

    def window_response(
        self, window: WindowPieces, torques: Mapping[str, Sequence[Matrix]]
    ) -> Matrix:
        """What torques do to the residuals of a window in sigma, shape (m, K), before anything is
        projected.

        `torques` gives, for some places, for each series, (N, k) torques at its samples; the
        columns stand in the order of the places given.
        """
        order = {place.name: n for n, place in enumerate(self.places)}
        number = self.series[window.index]
        columns = sum(given[number].shape[1] for given in torques.values())
        m = len(self.outputs)
        state = np.zeros((len(self.states), columns))
        rows = np.zeros((len(window.times), m, columns))
        for piece in window.pieces:
            out = piece.start @ state
            samples = window.samples[piece.nodes]
            first = 0
            for name, given in torques.items():
                last = first + given[number].shape[1]
                hats = piece.hats[:, :, order[name], :]
                out[:, :, first:last] += hats @ given[number][samples]
                first = last
            rows[piece.nodes] = out[:, :m]
            state = out[-1, m:]
        segment = self.windows.criterion.segments[window.index]
        scale = self._sensor_gains(segment)[:, None]
        answer = (rows[window.counts] * scale).reshape(-1, columns)
        return self.windows.criterion.whiten(window.index, answer)

    def _sensor_gains(self, segment: Segment) -> Vector:
        """By how many sigma the sensors show a change of each signal."""
        values = {**self.windows.criterion.parameters, **self.windows.values}
        sigma = self.windows.criterion.sigma[segment.measured.name]
        gains = [
            values.get(f"gain.{signal}", segment.measured.sensor(signal).gain)
            for signal in segment.signals
        ]
        return np.asarray(np.array(gains) / sigma)

    def _linearise_group(self, group: Sequence[int], runs: Sequence[Signals]) -> list[WindowPieces]:
        """Windows of one series, which have their nodes in common.

        Each hat is one every few nodes and zero between, so that in a piece all are different,
        and the runs of all pieces have the same inputs.
        """
        count = self.options.screen.nodes
        first_one = self.windows.criterion.segments[group[0]]
        nodes = [nodes_of(self.windows.criterion.segments[n]) for n in group]
        known = [first_one.measured.t, *(times for times, *_ in nodes)]
        common = np.unique(np.concatenate(known))
        turn = np.arange(len(common)) % count
        hats = {name: (common, (turn == j).astype(float)) for j, name in enumerate(self.hats)}
        parts, spans = [], []
        for n, (times, *_) in zip(group, nodes, strict=True):
            for first in range(0, max(len(times) - 1, 1), count - 1):
                here = slice(first, min(first + count, len(times)))
                start = {name: float(runs[n][name][first]) for name in self.states}
                t = times[here]
                spans.append(Span(float(t[0]), float(t[-1]), t, start))
                parts.append((n, here, turn[np.searchsorted(common, t)]))
        starts = [f"start.{name}" for name in self.states]
        probes = [name for names in self.probes for name in names]
        asked = [*starts, *probes]
        found = simulate_windows(self.model, self.windows, first_one, spans, self.rtol, hats, asked)
        signals = found.sensitivities.signals
        rows = [signals.index(name) for name in (*self.outputs, *self.states)]
        answers = found.sensitivities.array[:, rows].transpose(2, 1, 0)
        pieces: dict[int, list[Piece]] = {n: [] for n in group}
        for row, (n, here, order) in enumerate(parts):
            mine = answers[found.rows[row] : found.rows[row + 1]]
            of_starts, of_hats = np.split(mine, [len(starts)], axis=2)
            shape = len(mine), len(rows), len(self.places), count
            at_nodes = of_hats.reshape(shape)[:, :, :, order]
            # a view would keep all answers in memory
            pieces[n].append(Piece(here, of_starts.copy(), at_nodes))
        return [
            WindowPieces(n, times, samples, counts, tuple(pieces[n]))
            for n, (times, samples, counts) in zip(group, nodes, strict=True)
        ]
