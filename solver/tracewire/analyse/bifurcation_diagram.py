"""`bifurcation`: points of a section over a parameter, the state carried from value to value."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracewire.analyse.clusters import count_clusters, is_irregular
from tracewire.analyse.grid import grid_of
from tracewire.analyse.limits import SECTION
from tracewire.analyse.partial import Partial, fingerprint
from tracewire.analyse.plane import Plane, span_of
from tracewire.analyse.poincare_section import extent_of, take_points
from tracewire.analyse.turns import units_of
from tracewire.analyse.work import work_through
from tracewire.arguments import checked
from tracewire.array_types import Cube, Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, unknown
from tracewire.options import options_of
from tracewire.result import Result
from tracewire.solve import Passage, ProgressCallback, StopFlag, parameter_values

Carried = tuple[float, Vector] | None
"""Time and states at the end of the value before."""
Direction = Literal["up", "down", "both", "up_down", "down_up", "apart"]
BRANCHES: dict[str, tuple[tuple[str, ...], ...]] = {
    "up": (("up",),),
    "down": (("down",),),
    "both": (("up",), ("down",)),
    "up_down": (("up", "down"),),
    "down_up": (("down", "up"),),
    "apart": (("apart",),),
}
"""By direction, the chains of branches: within a chain the state is carried on."""


@dataclass(frozen=True, eq=False)
class Branch:
    """The points of a section at each value: `points` (m, keep, n), in the order of `values` (m,).

    `clusters` (m,) counts different points, `irregular` (m,) where no short period is there;
    `extent` (m, n) is how far the motion goes, `final` (m, n) where it ended. NaN and 0 where a
    value failed; `errors` says why, by its index.
    """

    direction: str
    values: Vector
    points: Cube
    clusters: NDArray[np.int64]
    irregular: NDArray[np.bool_]
    extent: Matrix
    final: Matrix
    errors: Mapping[int, str]

    @property
    def bands(self) -> tuple[tuple[float, float], ...]:
        """From and to of each range of values without a gap at which the motion is irregular."""
        order = np.argsort(self.values)
        marks = np.concatenate([[0], self.irregular[order].astype(int), [0]])
        begins, ends = np.flatnonzero(np.diff(marks) == 1), np.flatnonzero(np.diff(marks) == -1)
        x = self.values[order]
        return tuple((float(x[i]), float(x[j - 1])) for i, j in zip(begins, ends, strict=True))


@dataclass(frozen=True, eq=False, repr=False)
class Bifurcation(Result):
    """A bifurcation diagram: one branch for each direction in which the parameter goes.

    `modulo` holds the turns of states that turn.
    """

    title: str
    parameter: str
    unit: str
    states: tuple[str, ...]
    units: Mapping[str, str]
    branches: tuple[Branch, ...] = field(default_factory=tuple)
    modulo: Mapping[str, float] = field(default_factory=dict)

    def __getitem__(self, direction: str) -> Branch:
        for branch in self.branches:
            if branch.direction == direction:
                return branch
        raise OptionError([unknown("branch", direction, [b.direction for b in self.branches])])


@checked
def bifurcation(
    model: Model,
    parameter: str,
    values: ArrayLike,
    plane: Plane | Mapping[str, Any],
    *,
    direction: Direction = "up",
    skip: int = 200,
    keep: int = 100,
    near: float = SECTION.near,
    modulo: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None,
    parameters: Mapping[str, float] | None = None,
    preset: str = "",
    method: str = "auto",
    rtol: float = 1e-6,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: ProgressCallback | None = None,
    partial: str | Path | None = None,
) -> Bifurcation:
    """A bifurcation diagram: at each value of a parameter, points of a section after a transient.

    At each value `skip` points are passed over and `keep` kept. `direction`: "up" or "down" through
    the values, where the state at the last point is carried on to the next value; "both" of them,
    each from the start values, side by side; "down_up" and "up_down" one after the other, the
    second from the final state of the first; "apart" each value from the start values, in parallel.
    `workers` and `executor` are those of `simulate_many`. Memories of blocks begin anew at each
    value. A motion is irregular when its points make more
    clusters than a quarter of their number: see `count_clusters` for `near`. States of `modulo` are
    compared modulo that: {"phi": 6.283185307179586}. With `partial`, a .npz file, an interrupted
    diagram goes on where it was; a value that fails leaves the state as it was.

    Raises OptionError; the error of the first value where all of them fail.
    """
    plane = options_of(Plane, plane, "a section")
    plane.check(model)
    if parameter not in model.flat.parameters:
        raise OptionError([unknown("parameter", parameter, model.flat.parameters)])
    if direction not in BRANCHES:
        raise OptionError([unknown("direction", direction, BRANCHES)])
    if skip < 0 or keep < 1:
        what = f"{skip} points skipped and {keep} kept make no diagram"
        raise OptionError([Problem(what, hint="Skip 0 or more, keep 1 or more.")])
    grid = np.sort(grid_of(model, {parameter: values})[parameter])
    unit = units_of(model, modulo or {})
    work = _Work(
        model, parameter, plane, skip, keep, dict(start or {}), dict(parameters or {}), preset,
        method, rtol,
    )  # fmt: skip
    chains = BRANCHES[direction]
    names = [name for chain in chains for name in chain]
    identity = {
        "diagram": fingerprint(model),
        "kind": "bifurcation",
        "grid": [parameter, grid.tolist(), direction],
        "section": [plane.period, plane.edge, plane.guard, plane.phase, plane.direction],
        "options": [
            skip, keep, work.start, work.parameters, preset, method, rtol,
        ],
    }  # fmt: skip
    count, n = len(grid), len(model.states)
    store = Partial(partial, identity, len(names) * count, work.width)
    tasks: list[list[tuple[int, float]]] = []
    for chain in chains:
        rows: list[tuple[int, float]] = []
        for name in chain:
            first = names.index(name) * count
            order = range(count - 1, -1, -1) if name == "down" else range(count)
            rows += [(first + i, float(grid[i])) for i in order]
        tasks += [[row] for row in rows] if direction == "apart" else [rows]
    _carry_out(work, tasks, store, workers, executor, progress)
    points = store.rows[:, : keep * n].reshape(len(names), count, keep, n)
    final = store.rows[:, keep * n : (keep + 1) * n].reshape(len(names), count, n)
    extent = store.rows[:, (keep + 1) * n : (keep + 2) * n].reshape(len(names), count, n)
    branches = []
    for b, name in enumerate(names):
        errors = {
            number - b * count: text
            for number, text in sorted(store.errors.items())
            if 0 <= number - b * count < count
        }
        clusters = np.array(
            [
                0 if i in errors else count_clusters(points[b, i], extent[b, i], unit, near)
                for i in range(count)
            ],
            dtype=np.int64,
        )
        irregular = np.array([is_irregular(int(c), keep) for c in clusters], dtype=bool)
        branches.append(
            Branch(name, grid, points[b], clusters, irregular, extent[b], final[b], errors)
        )
    flat = model.flat
    return Bifurcation(
        title=flat.title,
        parameter=parameter,
        unit=flat.parameters[parameter].unit,
        states=model.states,
        units={state.name: state.unit for state in flat.states},
        branches=tuple(branches),
        modulo=dict(modulo or {}),
    )


@dataclass
class _Work:
    """What all values have in common."""

    model: Model
    parameter: str
    plane: Plane
    skip: int
    keep: int
    start: dict[str, float]
    parameters: dict[str, float]
    preset: str
    method: str
    rtol: float

    @property
    def width(self) -> int:
        """The numbers that are kept of a value: points, final states, extents, the final time."""
        return (self.keep + 2) * len(self.model.states) + 1

    def value(self, number: int, value: float, carried: Carried, stop_flag: StopFlag) -> Vector:
        """What is kept of one value; `carried` are time and states from the value before."""
        given = {**self.parameters, self.parameter: value}
        rhythm = self.plane.rhythm(self.model, given, self.preset)
        values = parameter_values(self.model, given, self.preset)
        low, high = span_of(self.model, values)
        begin = low if carried is None else carried[0] if rhythm is None else rhythm[0]
        length = abs(high - low) / 20 or 1.0 if rhythm is None else rhythm[1]
        start: Mapping[str, float] = self.start
        if carried is not None:
            start = dict(zip(self.model.states, carried[1].tolist(), strict=True))
        passage = Passage(
            self.model,
            length=length,
            begin=begin,
            parameters=given,
            start=start,
            preset=self.preset,
            method=self.method,
            rtol=self.rtol,
            inner=max(self.keep, 100),
            stop_flag=stop_flag,
        )
        _, points, mean = take_points(passage, self.plane, rhythm, self.skip, self.keep)
        end, final = passage.t, passage.x
        extent = extent_of(passage, points, mean)
        return np.concatenate([points.ravel(), final, extent, [end]])


def _carry_out(
    work: _Work,
    chains: Sequence[Sequence[tuple[int, float]]],
    store: Partial,
    workers: int | None,
    executor: Executor | None,
    progress: ProgressCallback | None,
) -> None:
    """Go through the chains side by side, through the values of each one after the other."""
    n, first = len(work.model.states), work.keep * len(work.model.states)
    rest: dict[int, Iterator[tuple[int, float]]] = {}

    def after(number: int, carried: Carried) -> Carried:
        """What a value carries to the next."""
        if number in store.errors:
            return carried
        kept = store.rows[number]
        return float(kept[-1]), kept[first : first + n].copy()

    def next_of(
        chain: Iterator[tuple[int, float]], carried: Carried
    ) -> tuple[int, float, Carried] | None:
        """The first value in the rest of a chain that is not done."""
        for number, value in chain:
            if not store.done[number]:
                rest[number] = chain
                return number, value, carried
            carried = after(number, carried)
        return None

    def follow(task: tuple[int, float, Carried]) -> tuple[int, float, Carried] | None:
        number, _, carried = task
        return next_of(rest.pop(number), after(number, carried))

    firsts = [next_of(iter(chain), None) for chain in chains]
    tasks = [task for task in firsts if task is not None]
    work_through(work.value, store, workers, progress, executor, tasks=tasks, follow=follow)
