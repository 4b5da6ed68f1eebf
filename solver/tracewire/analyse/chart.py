"""`stability_chart`: where in a plane of two parameters a periodic motion is stable."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracewire.analyse.floquet_multipliers import Tries
from tracewire.analyse.grid import grid_of
from tracewire.analyse.partial import Partial, fingerprint
from tracewire.analyse.work import work_through
from tracewire.arguments import checked
from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem
from tracewire.result import Result
from tracewire.solve import ProgressCallback, StopFlag


@dataclass(frozen=True, eq=False, repr=False)
class StabilityChart(Result):
    """The largest |Floquet multiplier| over two parameters, `radius` (ny, nx).

    `x_name` and `x` (nx,), `y_name` and `y` (ny,): the parameters in SI. `exponent` (ny, nx) is
    ln(radius)/T in 1/s. `margin` (ny, nx) goes evenly through zero at the edge: see
    `Floquet.margin`. `errors` holds, by (row, column), why a point has none (NaN).
    """

    title: str
    x_name: str
    x: Vector
    y_name: str
    y: Vector
    radius: Matrix
    exponent: Matrix
    margin: Matrix
    units: Mapping[str, str]
    tolerance: float = 1e-4
    errors: Mapping[tuple[int, int], str] = field(default_factory=dict)

    @property
    def unstable(self) -> NDArray[np.bool_]:
        """Where a multiplier is outside of the unit circle (ny, nx)."""
        return np.nan_to_num(self.radius) > 1.0 + self.tolerance


@checked
def stability_chart(
    model: Model,
    x: tuple[str, ArrayLike],
    y: tuple[str, ArrayLike],
    period: float | str,
    *,
    begin: float | str = 0.0,
    start: Mapping[str, float] | None = None,
    parameters: Mapping[str, float] | None = None,
    preset: str = "",
    method: str = "auto",
    rtol: float = 1e-9,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: ProgressCallback | None = None,
    partial: str | Path | None = None,
) -> StabilityChart:
    """The stability of a periodic motion over the values of two parameters, ("a", values).

    At each point the Floquet multipliers of `floquet`, for its arguments: of rates that are linear
    in the states (Hill, Mathieu, Meissner) those of zero; of others those of the motion through the
    start states, which must be periodic at each point, as an equilibrium is. Points are made in
    parallel, as in `simulate_many`; with `partial`, a .npz file, an interrupted chart goes on
    where it was.

    Raises OptionError; AnalysisError where no point could be made.
    """
    if x[0] == y[0]:
        what = f"a chart over '{x[0]}' and '{y[0]}' has one axis only"
        raise OptionError([Problem(what, hint="Name two parameters.")])
    grid = grid_of(model, dict([x, y]))
    xs, ys = grid[x[0]], grid[y[0]]
    identity = {
        "diagram": fingerprint(model),
        "kind": "chart",
        "grid": [[x[0], xs.tolist()], [y[0], ys.tolist()]],
        "options": [period, begin, dict(start or {}), dict(parameters or {}), preset, method, rtol],
    }
    store = Partial(partial, identity, len(xs) * len(ys), 3)

    tries = Tries(model, period, begin, start, parameters, preset, method, rtol)
    point = _Point(tries, (x[0], xs), (y[0], ys))
    work_through(point, store, workers, progress, executor)
    radius, lengths, margin = store.rows.reshape(len(ys), len(xs), 3).transpose(2, 0, 1)
    with np.errstate(divide="ignore"):
        exponent = np.log(radius) / lengths
    errors = {divmod(number, len(xs)): text for number, text in sorted(store.errors.items())}
    units = {name: model.flat.parameters[name].unit for name in grid}
    return StabilityChart(
        model.flat.title, x[0], xs, y[0], ys, radius, exponent, margin, units, errors=errors
    )


@dataclass(frozen=True)
class _Point:
    """Radius, period and margin at a point of a chart, by its number."""

    tries: Tries
    x: tuple[str, Vector]
    y: tuple[str, Vector]

    def __call__(self, number: int, stop_flag: StopFlag) -> Vector:
        (x, xs), (y, ys) = self.x, self.y
        row, column = divmod(number, len(xs))
        found = self.tries.floquet({x: float(xs[column]), y: float(ys[row])})
        return np.array([found.radius, found.period, found.margin])
