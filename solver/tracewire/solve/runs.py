"""What `simulate_many` gives: many runs of one model in arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Cube, Matrix, Vector
from tracewire.errors import OptionError, Problem, unknown
from tracewire.result import Result


@dataclass(frozen=True, eq=False, repr=False)
class Runs(Result):
    """Many runs of one model: `runs["name"]` (rows, N) in SI at `runs.t` (N,) in s.

    `parameters` holds the rows, by name (rows,), NaN where a row does not have it. `final` (rows,
    states) and `event_counts` (rows,) are always kept; `samples` (rows, N, signals), `points` (per
    row K times 1 + states: time and states of the section) and `criterion` (rows, ...) if they are
    observed, else they are empty. Of a row that failed all values are NaN, it has no points, and
    `errors` holds the message by row.
    """

    t: Vector
    signals: tuple[str, ...]
    states: tuple[str, ...]
    parameters: Mapping[str, Vector]
    samples: Cube
    final: Matrix
    event_counts: Vector
    points: tuple[Matrix, ...]
    criterion: NDArray[np.float64]
    errors: Mapping[int, str]

    def __len__(self) -> int:
        return len(self.final)

    def __getitem__(self, name: str) -> Matrix:
        if not isinstance(name, str):
            what = f"runs[{name!r}]: runs are read by the name of a signal"
            first = next(iter(self.signals), "x")
            hint = (
                f'Write runs["{first}"][{name!r}] for one row, runs["{first}"] for all (rows, N).'
            )
            raise OptionError.one(what, exists=self.signals, hint=hint)
        if name not in self.signals:
            hint = "Add it to `record:` of the diagram, or to `record=` of compile."
            raise OptionError([unknown("recorded signal", name, self.signals, hint=hint)])
        if not len(self.t):
            what = "the samples of these runs were not kept"
            raise OptionError([Problem(what, hint="Add 'samples' to `observe`.")])
        return self.samples[:, :, self.signals.index(name)]
