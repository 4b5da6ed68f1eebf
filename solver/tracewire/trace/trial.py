"""A trial: a model with some effects added, fitted to stretches of data; how trials are made."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model, compile
from tracewire.diagram import Diagram
from tracewire.errors import FitError
from tracewire.fit.criterion import Criterion
from tracewire.fit.descent import Descent, descend
from tracewire.fit.measured import Measured, measured_signals
from tracewire.fit.segment import Segment, Unknown, of_diagram
from tracewire.fit.unknowns import free_unknowns, sensor_unknowns
from tracewire.solve import parameter_values
from tracewire.trace.candidates import Candidate
from tracewire.trace.statistics import effective_part

Vector = NDArray[np.float64]
GROWING = (0.3, 0.6, 1.0)
FEWEST = 8
TOLERANCE = 1e-4


@dataclass(frozen=True, eq=False)
class Trial:
    """A model with some effects added, fitted to the segments of its criterion.

    `part` is N_eff/N of its residuals.
    """

    model: Model
    effects: tuple[Candidate, ...]
    criterion: Criterion
    descent: Descent
    part: float

    @property
    def rss(self) -> float:
        """The sum of squared residuals in sigma."""
        return 2 * self.descent.after

    @property
    def count(self) -> int:
        """The number of residuals."""
        return len(self.descent.residual)

    @property
    def unknowns(self) -> int:
        """How many numbers were fitted."""
        return len(self.descent.z)

    @property
    def values(self) -> dict[str, float]:
        """The fitted parameters and offsets by name."""
        return self.criterion.split(self.descent.z)[0]

    @property
    def segments(self) -> list[Segment]:
        """The segments with their fitted starts."""
        return self.criterion.moved(self.descent.z)[1]

    @property
    def s2(self) -> float:
        """RSS per degree of freedom; 1 is at the noise."""
        return self.rss / max(self.count - self.unknowns, 1)

    def residuals(self) -> list[Vector]:
        """The residuals in sigma, by segment, shape (N, signals)."""
        return self.criterion.residuals(self.descent.z)


@dataclass(frozen=True, eq=False)
class Bench:
    """What the trials of a trace share: declared model, series, their noise, tolerance."""

    declared: Model
    measured: tuple[Measured, ...]
    sigma: Mapping[str, float]
    rtol: float

    def compiled(self, diagram: Diagram) -> Model:
        """A diagram as a model that records what is measured."""
        return compile(diagram, record=measured_signals(diagram))

    def refit(
        self,
        model: Model,
        effects: Sequence[Candidate],
        segments: Sequence[Segment],
        values: Mapping[str, float],
        scales: Mapping[str, float] | None = None,
        steps: int = 20,
    ) -> Trial:
        """A model with effects, fitted from the values given.

        Raises FitError where the model cannot be simulated.
        """
        unknowns = self._unknowns(model, effects, values, scales or {})
        criterion = self._criterion(model, segments, unknowns, {})
        return self._descended(model, effects, criterion, steps)

    def grown(
        self,
        model: Model,
        effects: Sequence[Candidate],
        segments: Sequence[Segment],
        values: Mapping[str, float],
        scales: Mapping[str, float] | None = None,
    ) -> Trial:
        """Refitted over a growing part of each segment: a long run leads astray from afar."""
        trial = None
        for part in GROWING:
            shorter = [
                replace(s, rows=s.rows[: max(int(len(s.rows) * part), FEWEST)]) for s in segments
            ]
            trial = self.refit(model, effects, shorter, values, scales)
            values = trial.values
            segments = [
                replace(s, start=m.start) for s, m in zip(segments, trial.segments, strict=True)
            ]
        if trial is None:
            raise AssertionError("GROWING is not empty")
        return trial

    def without(self, trial: Trial, name: str) -> Trial:
        """The trial refitted with one coefficient fixed at zero."""
        unknowns, segments = trial.criterion.moved(trial.descent.z)
        kept = [u for u in unknowns if u.name != name]
        fixed = dict(trial.criterion.parameters)
        if not name.startswith("offset."):
            fixed[name] = 0.0
        criterion = self._criterion(trial.model, segments, kept, fixed)
        effects = [e for e in trial.effects if e.unknown != name]
        return self._descended(trial.model, effects, criterion, 12)

    def elsewhere(self, trial: Trial, segments: Sequence[Segment]) -> list[Vector]:
        """Residuals in sigma on other segments, where only their free starts are fitted."""
        fixed = dict(trial.criterion.parameters)
        fixed |= of_diagram(trial.values)
        offsets = {
            n.removeprefix("offset."): v for n, v in trial.values.items() if n.startswith("offset.")
        }
        found = []
        for segment in segments:
            measured = segment.measured
            sensors = {n: replace(measured.sensor(n), offset=v) for n, v in offsets.items()}
            shifted = replace(measured, sensors={**measured.sensors, **sensors})
            alone = [replace(segment, measured=shifted)]
            criterion = self._criterion(trial.model, alone, [], fixed)
            z = criterion.begin()
            if segment.free:
                z = descend(criterion, z, steps=12, tolerance=TOLERANCE).z
            found.append(criterion.residuals(z)[0])
        return found

    def in_units(self, segments: Sequence[Segment], residuals: Sequence[Vector]) -> list[Vector]:
        """Residuals in SI."""
        pairs = zip(segments, residuals, strict=True)
        return [r * np.array([self.sigma[n] for n in s.signals]) for s, r in pairs]

    def _criterion(
        self,
        model: Model,
        segments: Sequence[Segment],
        unknowns: Sequence[Unknown],
        fixed: Mapping[str, float],
    ) -> Criterion:
        """The sum of squares in sigma, which is what a likelihood needs."""
        return Criterion(model, segments, unknowns, fixed, self.rtol, self.sigma, weighting="sum")

    def _descended(
        self, model: Model, effects: Sequence[Candidate], criterion: Criterion, steps: int
    ) -> Trial:
        descent = descend(criterion, criterion.begin(), steps=steps, tolerance=TOLERANCE)
        criterion.failure = None  # a trial step may fail; where the descent ends it must run
        part = effective_part(criterion.residuals(descent.z))
        if criterion.failure is not None:
            raise FitError(criterion.failure.problems)
        return Trial(model, tuple(effects), criterion, descent, part)

    def _unknowns(
        self,
        model: Model,
        effects: Sequence[Candidate],
        values: Mapping[str, float],
        scales: Mapping[str, float],
    ) -> list[Unknown]:
        given = parameter_values(model, {})
        names = [n for n, p in self.declared.flat.parameters.items() if p.fit is not None]
        free = free_unknowns(model, names, given) if names else []
        free += sensor_unknowns([m for m in self.measured if m.use == "train"])
        known = {u.name for u in free}
        free += [
            e.as_unknown(values.get(e.unknown, 0.0), scales.get(e.unknown, 1.0))
            for e in effects
            if e.unknown not in known
        ]
        return [
            replace(u, value=min(max(values.get(u.name, u.value), u.low), u.high)) for u in free
        ]
