"""Signals along a fitted run, and their sizes, by which shapes and coefficients are scaled."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tracewire.array_types import Vector
from tracewire.trace.candidates.places import Place
from tracewire.trace.thresholds import CandidateOptions


@dataclass(frozen=True, eq=False)
class Trajectory:
    """The signals of a model along one series: times t (N,) in s, and each signal (N,) in SI."""

    t: Vector
    signals: Mapping[str, Vector]
    series: str = ""


@dataclass(frozen=True)
class SignalScale:
    """The size of a signal: its root mean square and its largest absolute value.

    stroke: the longest way in one direction. step: the way from one sample to the next, the median
    of those that move. slowest: of a rate the smallest absolute value that is resolved. other_side:
    the largest absolute value on the side of zero where it is smaller; infinite: not known. least:
    the smallest absolute value.
    """

    rms: float
    max: float
    stroke: float = 0.0
    step: float = 0.0
    slowest: float = 0.0
    other_side: float = np.inf
    least: float = 0.0


@dataclass(frozen=True)
class SignalScales:
    """The sizes of signals, the duration of the longest series and the sample interval in s."""

    signals: Mapping[str, SignalScale]
    duration: float
    interval: float

    def of(self, name: str) -> SignalScale:
        """The size of a signal; 0 where it is not known."""
        return self.signals.get(name, SignalScale(0.0, 0.0))


def signals_at(places: Sequence[Place]) -> tuple[str, ...]:
    """The signals that the scales and outputs of candidates at these places need."""
    found: dict[str, None] = {}
    for place in places:
        own = place.name if place.kind == "sum" else place.definition
        others = [signal for body in place.others for signal in body]
        found |= dict.fromkeys((own, place.q, place.v, place.a, *others, *place.drive))
    return tuple(name for name in found if name)


def signal_scales_of(trajectories: Sequence[Trajectory], options: CandidateOptions) -> SignalScales:
    """The sizes of all signals over all series."""
    parts: dict[str, list[Vector]] = {}
    for run in trajectories:
        for name, values in run.signals.items():
            parts.setdefault(name, []).append(values)
    return SignalScales(
        {name: _signal_scale(values, options) for name, values in parts.items()},
        max(float(run.t[-1] - run.t[0]) for run in trajectories),
        float(np.median(np.concatenate([np.diff(run.t) for run in trajectories]))),
    )


def _signal_scale(parts: Sequence[Vector], options: CandidateOptions) -> SignalScale:
    """The size of a signal from its values (N,) in each series."""
    x = np.concatenate(parts)
    ways = np.concatenate([_ways(part) for part in parts])
    steps = np.abs(np.concatenate([np.diff(part) for part in parts]))
    return SignalScale(
        float(np.sqrt(np.mean(x**2))),
        float(np.max(np.abs(x))),
        float(np.max(ways, initial=0.0)),
        float(np.median(_moving(steps, options.moves))),
        float(np.quantile(_moving(np.abs(x), options.moves), options.resolved_rates)),
        max(min(float(np.max(x)), -float(np.min(x))), 0.0),
        float(np.min(np.abs(x))),
    )


def _ways(x: Vector) -> Vector:
    """The ways that a signal goes from one turn to the next."""
    steps = np.diff(x)
    steps = steps[steps != 0]
    turns = np.flatnonzero(np.diff(np.signbit(steps))) + 1
    return np.abs([float(np.sum(part)) for part in np.split(steps, turns)])


def _moving(sizes: Vector, part: float) -> Vector:
    """Absolute values without those of rest; [0] where there are none."""
    kept = sizes[sizes > part * float(np.max(sizes, initial=0.0))]
    return kept if kept.size else np.zeros(1)
