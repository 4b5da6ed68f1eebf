"""Sensors: what the column of a file shows of its signal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from tracewire.array_types import Vector
from tracewire.diagram import Channel, Value
from tracewire.formula import CONSTANTS, evaluate, names_of
from tracewire.library import SENSOR_TERMS


@dataclass(frozen=True)
class Sensor:
    """What a channel shows of a signal y(t): gain*z + offset + quad*z^2 + drift*(t - t0).

    z = y(t - delay), t0 the first sample of the series; all in SI: offset as the signal, quad one
    over that, drift as the signal in a second, delay in s. `free` holds the bounds of those that a
    fit may change.
    """

    offset: float = 0.0
    gain: float = 1.0
    delay: float = 0.0
    quad: float = 0.0
    drift: float = 0.0
    free: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def observe(self, delayed: Vector, since: Vector) -> Vector:
        """What the sensor shows (N,) of a signal y(t - delay), at the times t - t0."""
        gain = self.gain + self.quad * delayed if self.quad else self.gain
        shown = gain * delayed
        shown += self.offset
        return shown + self.drift * since if self.drift else shown

    def signal(self, shown: Vector, since: Vector) -> Vector:
        """y(t - delay), (N,), of what the sensor shows at the times t - t0.

        Of two signals that quad*z^2 makes look alike the one nearer to zero; where it shows what no
        signal can, the nearest that one can.
        """
        linear = shown - self.offset - self.drift * since
        gain = self.gain or 1.0
        if self.quad:
            vertex = -(gain**2) / (4 * self.quad)
            linear = np.maximum(linear, vertex) if self.quad > 0 else np.minimum(linear, vertex)
        root = np.sqrt(np.maximum(gain**2 + 4 * self.quad * linear, 0.0))
        return np.asarray(2 * linear / (gain + np.copysign(root, gain)))


PLAIN = Sensor()
"""A sensor that shows the signal itself."""


def read_sensor(channel: Channel, values: Mapping[str, float], factor: float) -> Sensor:
    """What a channel's sensor does; `factor` puts numbers in the unit of the header into SI."""
    free, numbers = {}, {}
    for name, term in SENSOR_TERMS.items():
        given: Value | None = getattr(channel, name)
        if given is None:
            continue
        own = 1.0 if given.unit else term.factor(factor)
        plain = all(symbol in CONSTANTS for symbol in names_of(given.formula))
        value = evaluate(given.formula, values) * given.factor
        numbers[name] = value * own if plain else value
        if given.fit is not None:
            free[name] = (given.fit[0] * own, given.fit[1] * own)
    return Sensor(**numbers, free=free)
