"""How far a model is from measured data: residuals of segments, derivatives, the criterion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.errors import DataError, Problem, SimulationError
from tracewire.fit.measured import Measured
from tracewire.solve import Interrupted, Limits, simulate

Vector = NDArray[np.float64]
DIFFERENCE, CENTRAL = 1e-4, 1e-5
PENALTY = 100.0


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

    @property
    def t(self) -> Vector:
        """The sample times, shape (N,) in s."""
        return self.measured.t[self.rows]

    @property
    def signals(self) -> tuple[str, ...]:
        """The measured signals."""
        return tuple(self.measured.values)


@dataclass(frozen=True)
class Unknown:
    """A number to be found: its name, value, bounds, and the size by which it is scaled.

    The name is that of a parameter, or `offset.SIGNAL` for the offset of a sensor.
    """

    name: str
    value: float
    low: float = -np.inf
    high: float = np.inf
    scale: float = 1.0


class Criterion:
    """Residuals of a model on segments, as a function of unknowns and of the segments' free starts.

    The vector of unknowns is scaled: parameters first, then the free starts of each segment. The
    residual of a sample is (model + offset - measured)/sigma. `parameters` holds what is fixed, by
    the names that unknowns have; `sigma` the noise of each signal instead of the declared one.

    Raises DataError where only some signals have a declared sigma.
    """

    def __init__(
        self,
        model: Model,
        segments: Sequence[Segment],
        unknowns: Sequence[Unknown],
        parameters: Mapping[str, float],
        rtol: float = 1e-7,
        sigma: Mapping[str, float] | None = None,
    ) -> None:
        self.model, self.unknowns = model, tuple(unknowns)
        self.segments = tuple(segments)
        self.parameters = dict(parameters)
        self.rtol = rtol
        self.sigma = _sigma_of(self.segments, sigma)
        self.evaluations = 0
        self.failure: SimulationError | None = None
        self.scales = np.array(
            [u.scale for u in self.unknowns]
            + [_start_scale(s, name) for s in self.segments for name in s.free]
        )

    def on(self, segments: Sequence[Segment]) -> Criterion:
        """The same criterion on other segments."""
        fresh = Criterion(self.model, segments, self.unknowns, self.parameters, self.rtol)
        fresh.sigma = {s.measured.name: self.sigma[s.measured.name] for s in segments}
        return fresh

    def begin(self) -> Vector:
        """The scaled unknowns to begin with."""
        values = [u.value for u in self.unknowns]
        values += [s.start[name] for s in self.segments for name in s.free]
        return np.asarray(np.array(values) / self.scales)

    def bounds(self) -> tuple[Vector, Vector]:
        """The scaled bounds; start values are free."""
        extra = sum(len(s.free) for s in self.segments)
        low = np.array([u.low for u in self.unknowns] + [-np.inf] * extra) / self.scales
        high = np.array([u.high for u in self.unknowns] + [np.inf] * extra) / self.scales
        return low, high

    def split(self, z: Vector) -> tuple[dict[str, float], list[dict[str, float]]]:
        """Scaled unknowns as values by name, and the free starts of each segment."""
        values = (z * self.scales).tolist()
        count = len(self.unknowns)
        named = dict(zip((u.name for u in self.unknowns), values[:count], strict=True))
        starts, at = [], count
        for segment in self.segments:
            starts.append(dict(zip(segment.free, values[at : at + len(segment.free)], strict=True)))
            at += len(segment.free)
        return named, starts

    def moved(self, z: Vector) -> tuple[list[Unknown], list[Segment]]:
        """The unknowns and segments with the values of z."""
        named, starts = self.split(z)
        unknowns = [replace(u, value=named[u.name]) for u in self.unknowns]
        segments = [
            replace(s, start={**s.start, **start})
            for s, start in zip(self.segments, starts, strict=True)
        ]
        return unknowns, segments

    def outputs(
        self, segment: Segment, named: Mapping[str, float], start: Mapping[str, float]
    ) -> Vector:
        """The simulated signals of a segment, shape (N, signals); offsets are added."""
        values = {**self.parameters, **named}
        t = segment.t
        run = simulate(
            self.model,
            parameters=without_offsets(values),
            start={**segment.start, **start},
            span=(min(segment.begin, float(t[0])), float(t[-1])),
            times=t,
            rtol=self.rtol,
            preset=segment.measured.preset,
            inputs=segment.measured.inputs,
            limits=Limits(steps=500_000, seconds=120.0),
        )
        offsets = [
            values.get(f"offset.{name}", segment.measured.offset.get(name, 0.0))
            for name in segment.signals
        ]
        simulated = np.stack([run[name] for name in segment.signals], axis=1)
        return np.asarray(simulated + np.array(offsets))

    def residuals(self, z: Vector) -> list[Vector]:
        """The residuals of each segment, shape (N, signals); a failed run counts as far away."""
        named, starts = self.split(z)
        pairs = zip(self.segments, starts, strict=True)
        return [self.residual(segment, named, start) for segment, start in pairs]

    def residual(
        self, segment: Segment, named: Mapping[str, float], start: Mapping[str, float]
    ) -> Vector:
        """The residuals of one segment, shape (N, signals)."""
        self.evaluations += 1
        measured = np.stack([v[segment.rows] for v in segment.measured.values.values()], axis=1)
        sigma = self.sigma[segment.measured.name]
        try:
            outputs = self.outputs(segment, named, start)
        except Interrupted as error:  # no failed run: the whole search shall stop
            raise KeyboardInterrupt from error
        except SimulationError as error:
            self.failure = error
            spread = PENALTY * np.maximum(np.std(measured, axis=0), sigma)
            return np.asarray(np.broadcast_to(spread / sigma, measured.shape))
        return np.asarray((outputs - measured) / sigma)

    def value(self, z: Vector) -> float:
        """The criterion: the sum over segments and signals of mean(residual^2)/2.

        For one series and one signal without sigma this is the criterion of paper A's appendix.
        """
        return float(sum(np.mean(r**2, axis=0).sum() / 2 for r in self.residuals(z)))

    def derivatives(
        self, z: Vector, residuals: Sequence[Vector], central: bool = False
    ) -> list[Vector]:
        """d residuals / d scaled unknowns, for each segment shape (N*signals, unknowns).

        By differences to one side, with `central` to both sides where the bounds leave room. A free
        start of one segment moves that segment only.
        """
        matrices = [np.zeros((r.size, len(z))) for r in residuals]
        everywhere = range(len(self.segments))
        moving = [(j, everywhere) for j in range(len(self.unknowns))]
        free = [n for n, segment in enumerate(self.segments) for _ in segment.free]
        moving += [(j, range(n, n + 1)) for j, n in enumerate(free, len(self.unknowns))]
        for j, segments in moving:
            ends = self._ends(z, j, central)
            for n in segments:
                low, high = (
                    residuals[n] if end is z else self._moved_residual(n, end) for end in ends
                )
                matrices[n][:, j] = ((high - low) / (ends[1][j] - ends[0][j])).ravel()
        return matrices

    def _moved_residual(self, n: int, z: Vector) -> Vector:
        named, starts = self.split(z)
        return self.residual(self.segments[n], named, starts[n])

    def _ends(self, z: Vector, j: int, central: bool) -> tuple[Vector, Vector]:
        """The unknowns with one of them moved to each side, or z itself at one side."""
        low, high = self.bounds()
        h = (CENTRAL if central else DIFFERENCE) * max(1.0, abs(z[j]))
        down, up = z.copy(), z.copy()
        down[j] -= h
        up[j] += h
        if up[j] > high[j]:
            return down, z
        return (down if central and down[j] >= low[j] else z), up


def without_offsets(values: Mapping[str, float]) -> dict[str, float]:
    """The parameters of the diagram among named unknowns: all but the offsets of sensors."""
    return {name: value for name, value in values.items() if not name.startswith("offset.")}


def _sigma_of(segments: Sequence[Segment], given: Mapping[str, float] | None) -> dict[str, Vector]:
    """The noise of the signals of each series: as given, else as declared, 1 where none is."""
    known = {
        (s.measured.name, signal): (s.measured.sigma if given is None else given).get(signal)
        for s in segments
        for signal in s.signals
    }
    missing = [f"{signal} in {series}" for (series, signal), x in known.items() if x is None]
    if missing and (given is not None or len(missing) < len(known)):
        what = f"no sigma is known of {', '.join(missing)}, but of others"
        raise DataError([Problem(what, hint="Give every measured signal a sigma, or none.")])
    return {
        s.measured.name: np.array([known[s.measured.name, signal] or 1.0 for signal in s.signals])
        for s in segments
    }


def _start_scale(segment: Segment, state: str) -> float:
    values = segment.measured.values.get(state)
    if values is not None:
        spread = float(np.std(values))
    else:
        spread = max(
            float(np.std(np.gradient(v, segment.measured.t)))
            for v in segment.measured.values.values()
        )
    return max(spread, abs(segment.start[state]), 1e-12)
