"""The arrays of runs, kept with the model: to make them takes as long as a short run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.solve.core.arrays import Arrays, table_of
from tracewire.solve.history import GROWING, has_grown
from tracewire.solve.sensitivities import Moving, new_sensitivity
from tracewire.solve.setup import (
    Tolerance,
    kept_plan,
    new_arrays,
    new_flow,
    new_progress,
    prepare,
)

Vector = NDArray[np.float64]
Key = tuple[int, int, tuple[str, ...], tuple[str, ...]]
MOST = 16  # kinds of spaces that a model keeps
MOST_NUMBERS = 500_000  # of samples and tables; larger arrays are not kept
ONLY_WRITTEN = ("address", "c", "k", "log", "stiff", "times", *GROWING)
"""What is written before each run, or not read before the run has written it."""


class Space:
    """The arrays of one run, and their table for the core.

    `key` says which runs they fit: the number of samples and the numbers in their tables, the
    sensitivities, and the parameters that move with these. `block` is the memory of all that a run
    changes, `first` what was there before.
    """

    def __init__(self, key: Key, arrays: Arrays) -> None:
        self.key = key
        self.arrays, self.block = _in_one_block(arrays)
        self.table, self.first = table_of(self.arrays), self.block.copy()

    def renew(self) -> None:
        """Let the arrays be as they were before their run."""
        self.block[:] = self.first

    def keep(self) -> None:
        """Let them be before each further run as they are now."""
        self.first[:] = self.block


def _in_one_block(arrays: Arrays) -> tuple[Arrays, Vector]:
    """The arrays with all that a run changes in one block of memory, and that block."""
    groups: list[Any] = list(arrays)
    fields = [
        (number, name, array)
        for number, group in enumerate(groups)
        for name, array in group._asdict().items()
        if group is not arrays.plan and name not in ONLY_WRITTEN
    ]
    block = np.empty(sum(array.size for *_, array in fields))
    first = 0
    for number, name, array in fields:
        part = block[first : first + array.size].view(array.dtype).reshape(array.shape)
        part[...] = array
        groups[number] = groups[number]._replace(**{name: part})
        first += array.size
    return Arrays(*groups), block


def space_for(
    model: Model,
    values: Mapping[str, float],
    tables: Vector,
    asked: tuple[str, ...],
    moving: Moving,
    count: int,
) -> Space:
    """A free space for `count` samples, whose field has these parameters and packed tables; start,
    span and sensitivities are for the caller to set."""
    vector = np.array([*values.values(), 0.0])  # never empty
    key = count, len(tables), asked, moving.names
    space = take(model, key)
    if space is None:
        flow = new_flow(model, vector, tables)
        nowhere, times = np.zeros(model.sizes.states), np.zeros(count)
        tolerance = Tolerance(1.0, np.ones(len(nowhere)))
        progress = new_progress(model, nowhere, (0.0, 1.0), times, "auto", tolerance)
        sensitivity = new_sensitivity(model, flow, progress, asked, moving, {}, values)
        return Space(key, new_arrays(model, flow, kept_plan(model), progress, sensitivity))
    flow = space.arrays.flow
    flow.k[:] = tables
    prepare(model, flow, vector)
    return space


def take(model: Model, key: Key) -> Space | None:
    """A space that is kept and free, renewed; None where there is none."""
    try:
        space = _kept(model)[key].pop()  # at once, as another thread may want it too
    except (KeyError, IndexError):
        return None
    space.renew()
    return space


def give_back(model: Model, space: Space) -> None:
    """Let the next run have a space; nobody may look into its arrays any more."""
    kept = _kept(model)
    progress = space.arrays.progress
    sensitivity = space.arrays.sensitivity
    size = progress.samples.size + sensitivity.samples.size
    if size + space.key[1] > MOST_NUMBERS or has_grown(space.arrays):
        return
    if space.key not in kept and len(kept) >= MOST:
        kept.clear()
    kept.setdefault(space.key, []).append(space)


def release(model: Model) -> None:
    """Free the memory that runs of a model keep for the next one."""
    _kept(model).clear()


def _kept(model: Model) -> dict[Key, list[Space]]:
    return cast(dict[Key, list[Space]], model.kept.setdefault("spaces", {}))
