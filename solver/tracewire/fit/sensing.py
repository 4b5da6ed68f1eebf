"""From a run to what the sensors of a segment show, and its derivatives.

A sensor shows gain*z + offset + quad*z^2 + drift*(t - t0) of its signal y, with z = y(t - delay).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.diagram import SENSOR
from tracewire.fit.segment import Segment
from tracewire.fit.sensor import Sensor
from tracewire.solve import Run

Vector = NDArray[np.float64]
Cube = NDArray[np.float64]
STEP = 1e-3
"""Of a sample interval: how far to each side a signal is sampled for its rate."""


class Sensing:
    """The sensors of a segment with the values of unknowns, and when they look at their signals.

    `named` holds unknowns by name (`offset.SIGNAL` ...), which replace those of the series. With
    `rates`, signals are sampled for d y/dt, too. `times` are the sample times that a run needs; a
    sensor that looks back before its begin sees the signal there.
    """

    def __init__(self, segment: Segment, named: Mapping[str, float], rates: bool = False) -> None:
        self.segment = segment
        self.sensors = [_sensor(segment, signal, named) for signal in segment.signals]
        self.rates = rates
        t = segment.t
        self.since = t - segment.measured.zero
        self.begin = min(segment.begin, float(t[0]))
        self.at: Sequence[slice | NDArray[np.intp]]
        if not rates and not any(sensor.delay for sensor in self.sensors):
            self.times, self.at = t, [slice(len(t))] * len(self.sensors)
            return
        looks: Vector = np.array([t - sensor.delay for sensor in self.sensors])
        if rates:
            self.step = STEP * float(np.median(np.diff(t))) if len(t) > 1 else STEP
            looks = np.concatenate([looks, looks - self.step, looks + self.step])
        self.times, at = np.unique(np.maximum(looks, self.begin), return_inverse=True)
        self.at = list(at.reshape(looks.shape))

    @property
    def end(self) -> float:
        """Where a run may end: at the last time that is looked at, and after the begin."""
        last = float(self.times[-1])
        return last if last > self.begin else float(self.segment.t[-1])

    def shown(self, run: Run) -> Vector:
        """What the sensors show, shape (N, signals)."""
        columns = [
            sensor.shown(run[signal][at], self.since)
            for signal, sensor, at in zip(self.segment.signals, self.sensors, self.at, strict=False)
        ]
        return np.stack(columns, axis=1)

    def derivatives(self, run: Run, unknowns: Mapping[str, str]) -> Cube:
        """d shown/d unknowns, shape (N, signals, unknowns).

        `unknowns` gives each unknown by name the name under which the run has the derivatives of
        the signals in it; of a sensor it is ''.
        """
        found = np.zeros((len(self.segment.rows), len(self.segment.signals), len(unknowns)))
        rows = {name: row for row, name in enumerate(run.sensitivities)}
        moving = [column for column, name in enumerate(unknowns.values()) if name]
        moved = [rows[name] for name in unknowns.values() if name]
        for number, (signal, sensor) in enumerate(
            zip(self.segment.signals, self.sensors, strict=True)
        ):
            at = self.at[number]
            if moved:
                slopes = run.sensitivities.array[moved, run.sensitivities.signals.index(signal)]
                found[:, number, moving] = (self._slope(sensor, run[signal][at]) * slopes[:, at]).T
            for column, name in enumerate(unknowns):
                kind, _, of = name.partition(".")
                if of == signal and not unknowns[name]:
                    found[:, number, column] = self._of_sensor(kind, run, number)
        return found

    def _of_sensor(self, kind: str, run: Run, number: int) -> Vector | float:
        """d shown/d an unknown of the sensor of a signal."""
        signal = self.segment.signals[number]
        delayed = run[signal][self.at[number]]
        if kind == "delay":
            return -self._slope(self.sensors[number], delayed) * self._rate(run, signal, number)
        known: dict[str, Vector | float] = {
            "offset": 1.0,
            "gain": delayed,
            "quad": delayed**2,
            "drift": self.since,
        }
        return known.get(kind, 0.0)

    def _slope(self, sensor: Sensor, delayed: Vector) -> Vector | float:
        """d shown/d y(t - delay)."""
        return sensor.gain + 2 * sensor.quad * delayed if sensor.quad else sensor.gain

    def _rate(self, run: Run, signal: str, column: int) -> Vector:
        count = len(self.segment.signals)
        down, up = self.at[count + column], self.at[2 * count + column]
        width = np.maximum(self.times[up] - self.times[down], 1e-300)
        return np.asarray((run[signal][up] - run[signal][down]) / width)


def _sensor(segment: Segment, signal: str, named: Mapping[str, float]) -> Sensor:
    own = segment.measured.sensor(signal)
    names = {kind: f"{kind}.{signal}" for kind in SENSOR}
    changed: dict[str, Any] = {k: named[name] for k, name in names.items() if name in named}
    return replace(own, **changed) if changed else own
