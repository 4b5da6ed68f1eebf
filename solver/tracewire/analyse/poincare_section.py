"""`section`: the points of a Poincaré section of one run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tracewire.analyse.clusters import count_clusters, is_irregular
from tracewire.analyse.limits import SECTION
from tracewire.analyse.plane import Plane, crossings, span_of
from tracewire.analyse.turns import units_of
from tracewire.arguments import checked
from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, unknown
from tracewire.options import options_of
from tracewire.result import Result
from tracewire.solve import Passage, parameter_values


@dataclass(frozen=True, eq=False, repr=False)
class PoincareSection(Result):
    """The points of a Poincaré section: times `t` (K,) in s and states `points` (K, n) in SI.

    `clusters` counts different points, and `irregular` tells that no short period is there: see
    `count_clusters`. `modulo` holds the turns of states that turn.
    """

    title: str
    states: tuple[str, ...]
    units: Mapping[str, str]
    t: Vector
    points: Matrix
    clusters: int
    irregular: bool
    modulo: Mapping[str, float] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Vector:
        if name not in self.states:
            raise OptionError([unknown("state", name, self.states)])
        return np.asarray(self.points[:, self.states.index(name)])


@checked
def section(
    model: Model,
    plane: Plane | Mapping[str, Any],
    *,
    skip: int = 0,
    keep: int = 100,
    near: float = SECTION.near,
    modulo: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None,
    parameters: Mapping[str, float] | None = None,
    preset: str = "",
    inputs: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
    method: str = "auto",
    rtol: float = 1e-6,
) -> PoincareSection:
    """The points of a section from the start values on: `skip` are passed over, `keep` kept.

    The run begins where the diagram's span does, and goes on as far as the points need it. `near`
    and `modulo` are for the count of clusters: see `bifurcation`. Raises OptionError; AnalysisError
    where a guard does not cross as often; SimulationError.
    """
    plane = options_of(Plane, plane, "a section")
    plane.check(model)
    if skip < 0 or keep < 1:
        what = f"{skip} points skipped and {keep} kept make no section"
        raise OptionError([Problem(what, hint="Skip 0 or more, keep 1 or more.")])
    unit = units_of(model, modulo or {})
    values = parameter_values(model, parameters or {}, preset)
    begin, end = span_of(model, values)
    rhythm = plane.rhythm(model, parameters or {}, preset)
    length = abs(end - begin) / 20 or 1.0 if rhythm is None else rhythm[1]
    passage = Passage(
        model,
        length=length,
        begin=begin,
        parameters=parameters,
        start=start,
        preset=preset,
        inputs=inputs,
        method=method,
        rtol=rtol,
        inner=max(keep, 100),
    )
    t, points, mean = take_points(passage, plane, rhythm, skip, keep)
    extent = extent_of(passage, points, mean)
    clusters = count_clusters(points, extent, unit, near)
    return PoincareSection(
        title=model.flat.title,
        states=model.states,
        units={state.name: state.unit for state in model.flat.states},
        t=t,
        points=points,
        clusters=clusters,
        irregular=is_irregular(clusters, keep),
        modulo=dict(modulo or {}),
    )


def take_points(
    passage: Passage, plane: Plane, rhythm: tuple[float, float] | None, skip: int, keep: int
) -> tuple[Vector, Matrix, float]:
    """Times (keep,), states (keep, n) and the mean time between points, after `skip` of them."""
    begin = passage.t
    if rhythm is None:
        t, points = crossings(passage, plane, skip, keep)
        return t, points, float((t[-1] - begin) / (skip + keep))
    first, period = rhythm
    first += period * np.ceil((begin - first) / period - 1e-9)
    t = first + period * (skip + np.arange(keep))
    passage.go_to(t[0])
    points = np.empty((keep, len(passage.x)))
    points[0] = passage.x
    if keep > 1:
        room = len(passage.inside)
        passage.go_to(t[-1], np.append(t[1:], np.full(room - keep + 1, np.inf)))
        points[1:] = passage.inside[: keep - 1]
    return t, points, period


def extent_of(passage: Passage, points: Matrix, mean: float) -> Vector:
    """How far each state goes (n,), over a few points on and at the points."""
    room = len(passage.inside)
    later = passage.t + SECTION.around * mean * np.arange(1, room + 1) / room
    passage.go_to(later[-1], later)
    return np.asarray(np.ptp(np.vstack([passage.inside, points]), axis=0), dtype=float)
