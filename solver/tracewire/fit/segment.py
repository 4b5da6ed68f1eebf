"""What a criterion compares and what it may change: stretches of series, and unknown numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tracewire.fit.measured import Measured

Vector = NDArray[np.float64]
SENSED = ("offset.", "gain.", "delay.")
"""What the names of a sensor's unknowns begin with; all other names are the diagram's."""


@dataclass(frozen=True, eq=False)
class Segment:
    """A stretch of a measured series that one run is compared with.

    The run begins at `begin` with the states of `start` (those not named: the diagram's); the
    states in `free` are unknowns. `rows` are the samples of the series that count.
    """

    measured: Measured
    begin: float
    rows: NDArray[np.intp]
    start: Mapping[str, float] = field(default_factory=dict)
    free: tuple[str, ...] = ()

    @cached_property
    def t(self) -> Vector:
        """The sample times, shape (N,) in s."""
        return self.measured.t[self.rows]

    @property
    def signals(self) -> tuple[str, ...]:
        """The measured signals."""
        return tuple(self.measured.values)

    def samples(self) -> Vector:
        """The measured values, shape (N, signals) in SI."""
        return np.stack([v[self.rows] for v in self.measured.values.values()], axis=1)

    def start_scale(self, state: str) -> float:
        """The size of a free start value: what its signal, or the fastest rate of one, spreads."""
        values = self.measured.values.get(state)
        if values is not None:
            spread = float(np.std(values))
        else:
            t = self.measured.t
            spread = max(float(np.std(np.gradient(v, t))) for v in self.measured.values.values())
        return max(spread, abs(self.start[state]), 1e-12)


@dataclass(frozen=True)
class Unknown:
    """A number to be found: its name, value, bounds, and the size by which it is scaled.

    The name is that of a parameter, or `offset.SIGNAL`, `gain.SIGNAL`, `delay.SIGNAL` of a sensor.
    """

    name: str
    value: float
    low: float = -np.inf
    high: float = np.inf
    scale: float = 1.0


def of_diagram(values: Mapping[str, float]) -> dict[str, float]:
    """The parameters of the diagram among named unknowns: all but those of sensors."""
    return {name: value for name, value in values.items() if not name.startswith(SENSED)}
