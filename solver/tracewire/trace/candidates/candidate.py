"""The noun of a trace: an effect at a place, wired, and the unknowns that it has."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from tracewire.library import Scale
from tracewire.residual import Unknown
from tracewire.trace.candidates.places import Place

PHASE = "phase"
"""A shape of this name turns a sine into a cosine: the two together span all phases."""


@dataclass(frozen=True)
class Candidate:
    """An effect that may be missing at a place, with its wires.

    block: the name of the block to add, '' for what a sensor does. signals: the signal that each
    port reads. coefficient: the name of the unknown, `coulomb.level` or `offset.theta`. shapes: the
    values of the other unknowns that are tried first, by parameter, in SI. scale: a coefficient
    that matters: where the effect is as large as the sum at its place (at a drive: as the drive, at
    a sensor: as the signal). at: the coefficient at which a screen takes the output where that is
    not linear, the first of `at_sizes`, from each of which a refit of it alone begins. neutral: the
    coefficient at which the effect vanishes, 1 for the gain of a sensor. of: the place of the other
    body that it reads, or the drive, where there are several.
    """

    effect: str
    place: Place
    block: str
    signals: Mapping[str, str] = field(hash=False)
    coefficient: str
    sign: int
    shapes: Mapping[str, tuple[float, ...]] = field(default_factory=dict, hash=False)
    scale: float = 1.0
    at: float = 1.0
    neutral: float = 0.0
    of: str = ""
    at_sizes: tuple[float, ...] = ()
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict, hash=False)
    """The bounds of each unknown by its parameter."""
    own: Mapping[str, Mapping[str, float]] = field(default_factory=dict, hash=False)
    """What each series has of its own and no fit changes: by series and parameter."""
    resolved: Mapping[str, float] = field(default_factory=dict, hash=False)
    """The values of shapes, by parameter, up to which the record shows the same as at 0."""
    scales: Mapping[str, Scale] = field(default_factory=dict, hash=False)
    """What the shapes are sizes of, by parameter."""
    fixed: tuple[str, ...] = ()
    """Shapes that no fit changes."""
    waves: tuple[str, ...] = ()
    """Shapes that are lengths of a wave along the coordinate."""
    lines: tuple[str, ...] = ()
    """Shapes that are periods in time, as of a line in the spectrum of the residual."""
    modulated: Mapping[str, str] = field(default_factory=dict, hash=False)
    """The signals that waves of such periods multiply, by shape."""
    scan_grid: Mapping[str, tuple[float, ...]] = field(default_factory=dict, hash=False)
    """Values of shapes of which a screen looks for the best, by parameter."""
    alias: tuple[str, ...] = ()
    """Effects that imitate this one on many records."""
    each: tuple[str, ...] = ()
    """Shapes that each series may have of its own: `phase@run_1` among values, not `phase`."""
    lasting: tuple[str, ...] = ()
    """States of its block, by their names in the model, that a run hardly forgets."""

    def __str__(self) -> str:
        return f"{self.effect} @ {self.place.name}" + (f" (of {self.of})" if self.of else "")

    @property
    def parameter(self) -> str:
        """The name of the coefficient in its block or sensor."""
        if not self.block:
            return self.coefficient.partition(".")[0]
        return self.coefficient.removeprefix(f"{self.block}.")

    @property
    def scanned(self) -> tuple[str, ...]:
        """Shapes that a scan finds and no fit changes."""
        return tuple(name for name in self.waves if name in self.fixed)

    @property
    def most(self) -> float:
        """How far the coefficient may be from where the effect vanishes. A fit may make up for more
        by its shapes, but not by those that are scanned."""
        if not self.scanned:
            return math.inf
        return self.limits[self.parameter][1] - self.neutral

    @property
    def imitated(self) -> frozenset[str]:
        """The effects at its place that it imitates, as `name @ place`."""
        return frozenset(f"{alias} @ {self.place.name}" for alias in self.alias)


def unknowns_of(candidate: Candidate, values: Mapping[str, float]) -> list[Unknown]:
    """The coefficient and the shapes of a candidate as unknowns of a fit, begun at `values`.

    A shape that is not in `values` has the first value that is tried. One that is off is no
    unknown: see `is_default`.
    """
    start = values.get(candidate.parameter, candidate.neutral)
    low = candidate.limits.get(candidate.parameter, (-math.inf, math.inf))
    size = abs(start - candidate.neutral) or candidate.scale
    found = [Unknown(candidate.coefficient, start, *low, size)]
    for name, grid in candidate.shapes.items():
        if name in candidate.fixed:
            continue
        own = {key: value for key, value in values.items() if key.startswith(f"{name}@")}
        found += [
            Unknown(f"{candidate.block}.{key}", value, *candidate.limits[name], 1.0)
            for key, value in own.items()
        ]
        value = values.get(name, grid[0])
        if own or is_default(candidate, name, value):
            continue
        size = max(abs(value), min((abs(v) for v in grid if v), default=1.0))
        found.append(Unknown(f"{candidate.block}.{name}", value, *candidate.limits[name], size))
    return found


def is_default(candidate: Candidate, shape: str, value: float) -> bool:
    """Whether a shape is off at this value, as a width that is 0, or so small that the record does
    not show it: it is then not written, nor fitted."""
    if 0.0 not in candidate.shapes[shape] or candidate.limits[shape][0] < 0.0:
        return False
    return 0.0 <= value <= candidate.resolved.get(shape, 0.0)


def without_defaults(candidate: Candidate, values: Mapping[str, float]) -> dict[str, float]:
    """The values with 0 for each shape that is off."""
    return {
        name: 0.0 if name in candidate.shapes and is_default(candidate, name, value) else value
        for name, value in values.items()
    }
