"""What a criterion compares and what it may change: stretches of series, and unknown numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.formula import Name
from tracewire.residual.measured import Measured

OWN = "@"
"""Stands between a parameter and the series that has it of its own: `harmonic.phase@run_1`."""


@dataclass(frozen=True, eq=False)
class Segment:
    """A stretch of a measured series that one run is compared with.

    The run begins at `begin` with the states of `start` (those not named: the diagram's); the
    states in `free` are unknowns. `rows` are the samples of the series that count. `memory` are
    states at `begin` that are not free, as a run up to there has left them.
    """

    measured: Measured
    begin: float
    rows: NDArray[np.intp]
    start: Mapping[str, float] = field(default_factory=dict)
    free: tuple[str, ...] = ()
    memory: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def t(self) -> Vector:
        """The sample times, shape (N,) in s."""
        return self.measured.t[self.rows]

    @property
    def time_in_samples(self) -> int:
        """The samples from the begin of the run on, or as many as there would be without gaps."""
        t = self.measured.t
        inside = t[np.searchsorted(t, self.begin) : self.rows[-1] + 1]
        if len(inside) < 2:
            return len(inside)
        return max(len(inside), int((inside[-1] - inside[0]) / self.measured.interval))

    @property
    def signals(self) -> tuple[str, ...]:
        """The measured signals."""
        return tuple(self.measured.values)

    def continues(self, before: Segment) -> bool:
        """Whether it begins where another one of its series ends, with a free start: not behind a
        gap that is longer than the other one."""
        if not self.free or before.measured.name != self.measured.name:
            return False
        near = int(before.rows[-1]) + 1 == int(self.rows[0])
        return near and self.begin - before.t[-1] <= before.t[-1] - before.begin

    def samples(self) -> Vector:
        """The measured values, shape (N, signals) in SI."""
        return np.stack([v[self.rows] for v in self.measured.values.values()], axis=1)

    @cached_property
    def interval(self) -> float:
        """The median time between samples in s; 1 where there is one sample."""
        return float(np.median(np.diff(self.t))) if len(self.rows) > 1 else 1.0

    @cached_property
    def start_scales(self) -> Mapping[str, float]:
        """The sizes of start values: what the signal of each, or the fastest rate of one,
        spreads."""
        spreads, fastest = self.measured.spreads, self.measured.fastest
        return {
            name: max(spreads.get(name, fastest), abs(value)) or 1.0
            for name, value in self.start.items()
        }


@dataclass(frozen=True)
class Unknown:
    """A number to be found: its name, value, bounds, and the size by which it is scaled.

    The name is that of a parameter, or of a sensor: `offset.SIGNAL`, `gain.SIGNAL`, `delay.SIGNAL`,
    `quad.SIGNAL`, `drift.SIGNAL`; or that of a parameter in one series, `harmonic.phase@run_1`.
    """

    name: str
    value: float
    low: float = -np.inf
    high: float = np.inf
    scale: float = 1.0


def of_diagram(model: Model, values: Mapping[str, float], measured: Measured) -> dict[str, float]:
    """The parameters of a model's diagram among named unknowns, in a run of a series.

    Those that the series has of its own go before: as it gives them, and as an unknown of that
    series (`harmonic.phase@run_1`) says. Unknowns of sensors and of other series are left out.
    """
    known = {n: v for n, v in values.items() if n in model.flat.parameters}
    known |= measured.parameters
    names = {name: own_name(name, measured) for name in measured.parameters}
    return known | {name: values[own] for name, own in names.items() if own in values}


def absolute_tolerances(model: Model, measured: Measured, rtol: float) -> dict[str, float]:
    """The absolute tolerance of each state in runs of a series, for `simulate_spans`.

    rtol/1000 of the spread of its signal; of a state that is the rate of a measured one, of the
    spread of that rate; of another one, of the least of all these. Sizes are rounded down to a
    power of ten, and at most 1: a record in m is run as exactly as the same record in mm.
    """
    sizes = {name: size for name, size in measured.spreads.items() if size > 0}
    least = min([1.0, *sizes.values(), *([measured.fastest] if measured.fastest > 0 else [])])
    for state in model.flat.states:
        size = measured.rate_spreads.get(state.name, 0.0)
        if isinstance(state.rate, Name) and size > 0:
            sizes.setdefault(state.rate.name, size)
    known = {name: min(sizes.get(name, least), 1.0) for name in model.states}
    return {name: rtol * 10.0 ** (math.floor(math.log10(size)) - 3) for name, size in known.items()}


def own_name(parameter: str, measured: Measured) -> str:
    """The name of the unknown that a parameter is where a series has it of its own."""
    return f"{parameter}{OWN}{measured.series or measured.name}"


def is_of_sensor(model: Model, unknown: str) -> bool:
    """Whether an unknown is a number of a sensor, as `offset.SIGNAL`, and not the model's."""
    return OWN not in unknown and unknown not in model.flat.parameters


def parameter_in(model: Model, unknown: str, measured: Measured) -> str:
    """The parameter of a model's diagram that an unknown is in a run of a series; '' where it is
    none, as of a sensor or another series, or where the series has a value of its own."""
    if is_of_sensor(model, unknown):
        return ""
    parameter, _, series = unknown.partition(OWN)
    if not series:
        return "" if parameter in measured.parameters else parameter
    return parameter if own_name(parameter, measured) == unknown else ""
