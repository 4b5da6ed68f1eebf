"""From runs to what the sensors of segments show, and its derivatives.

A sensor shows gain*z + offset + quad*z^2 + drift*(t - t0) of its signal y, with z = y(t - delay).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Cube, Vector
from tracewire.library import SENSOR_TERMS
from tracewire.residual.limits import CRITERION
from tracewire.residual.segment import Segment
from tracewire.residual.sensor import Sensor
from tracewire.solve import SpanRuns


class ObservationModel:
    """The sensors of segments of one series with the values of unknowns, and when they look at
    their signals.

    `named` holds unknowns by name (`offset.SIGNAL` ...), which replace those of the series. With
    `rates`, signals are sampled for d y/dt, too. `times` are the sample times that a run of each
    segment needs; a sensor that looks back before its begin sees the signal there.
    """

    def __init__(
        self, segments: Sequence[Segment], named: Mapping[str, float], rates: bool = False
    ) -> None:
        self.segments, self.rates = segments, rates
        self.signals = segments[0].signals
        self.sensors = [_sensor(segments[0], signal, named) for signal in self.signals]
        self.since = np.concatenate([segment.t for segment in segments])
        self.since -= segments[0].measured.zero
        self.begins = [min(segment.begin, float(segment.t[0])) for segment in segments]
        self.at: Sequence[slice | NDArray[np.intp]]
        if not rates and not any(sensor.delay for sensor in self.sensors):
            self.times = [segment.t for segment in segments]
            self.at = [slice(len(self.since))] * len(self.sensors)
            return
        self.times, parts, first = [], [], 0
        for segment, begin in zip(segments, self.begins, strict=True):
            looks = self._looks(segment)
            times, at = np.unique(np.maximum(looks, begin), return_inverse=True)
            self.times.append(times)
            parts.append(first + at.reshape(looks.shape))
            first += len(times)
        self.at = list(np.concatenate(parts, axis=1))

    def _looks(self, segment: Segment) -> Vector:
        """When the sensors look to show what they do at the samples (N,): (looks, N)."""
        looks: Vector = np.array([segment.t - sensor.delay for sensor in self.sensors])
        if not self.rates:
            return looks
        step = CRITERION.rate_step * segment.interval
        return np.concatenate([looks, looks - step, looks + step])

    @property
    def ends(self) -> list[float]:
        """Where runs may end: at the last time that is looked at, and after the begin."""
        return [
            float(times[-1]) if times[-1] > begin else float(segment.t[-1])
            for segment, times, begin in zip(self.segments, self.times, self.begins, strict=True)
        ]

    def observe(self, run: SpanRuns) -> Vector:
        """What the sensors show, shape (N, signals)."""
        shown = np.empty((len(self.since), len(self.signals)))
        columns = zip(self.signals, self.sensors, self.at, strict=False)
        for number, (signal, sensor, at) in enumerate(columns):
            shown[:, number] = sensor.observe(run[signal][at], self.since)
        return shown

    def derivatives(self, run: SpanRuns, unknowns: Mapping[str, str]) -> Cube:
        """d shown/d unknowns, shape (N, signals, unknowns).

        `unknowns` gives each unknown by name the name under which the run has the derivatives of
        the signals in it; of a sensor it is ''.
        """
        found = np.zeros((len(self.since), len(self.signals), len(unknowns)))
        if not unknowns:
            return found
        rows = {name: row for row, name in enumerate(run.sensitivities)}
        moving = [column for column, name in enumerate(unknowns.values()) if name]
        moved = [rows[name] for name in unknowns.values() if name]
        for number, (signal, sensor) in enumerate(zip(self.signals, self.sensors, strict=True)):
            at = self.at[number]
            if moved:
                slopes = run.sensitivities.array[moved, run.sensitivities.signals.index(signal)]
                found[:, number, moving] = (self._slope(sensor, run[signal][at]) * slopes[:, at]).T
            for column, name in enumerate(unknowns):
                kind, _, of = name.partition(".")
                if of == signal and not unknowns[name]:
                    found[:, number, column] = self._of_sensor(kind, run, number)
        return found

    def _of_sensor(self, kind: str, run: SpanRuns, number: int) -> Vector | float:
        """d shown/d an unknown of the sensor of a signal."""
        signal = self.signals[number]
        delayed = run[signal][self.at[number]]
        if kind == "delay":
            return -self._slope(self.sensors[number], delayed) * self._rate(run, signal, number)
        term = SENSOR_TERMS.get(kind)
        slope: Vector | float = term.slope(delayed, self.since) if term and term.slope else 0.0
        return slope

    def _slope(self, sensor: Sensor, delayed: Vector) -> Vector | float:
        """d shown/d y(t - delay)."""
        return sensor.gain + 2 * sensor.quad * delayed if sensor.quad else sensor.gain

    def _rate(self, run: SpanRuns, signal: str, column: int) -> Vector:
        count, times = len(self.signals), np.concatenate(self.times)
        down, up = self.at[count + column], self.at[2 * count + column]
        width = np.maximum(times[up] - times[down], 1e-300)
        return np.asarray((run[signal][up] - run[signal][down]) / width)


def _sensor(segment: Segment, signal: str, named: Mapping[str, float]) -> Sensor:
    own = segment.measured.sensor(signal)
    names = _terms_of(signal)
    if named.keys().isdisjoint(names):
        return own
    changed: dict[str, Any] = {k: named[name] for name, k in names.items() if name in named}
    return replace(own, **changed)


@cache
def _terms_of(signal: str) -> dict[str, str]:
    """The terms of the sensor of a signal, by the names of their unknowns."""
    return {f"{term}.{signal}": term for term in SENSOR_TERMS}
