"""The arrays of runs, kept with the model: to make them takes as long as a short run."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.solve.core.arrays import Arrays, table_of
from tracewire.solve.history import GROWING, has_grown
from tracewire.solve.once_per_model import once_per_model
from tracewire.solve.problem import InitialValueProblem
from tracewire.solve.setup import Kind, Records, new_arrays

Vector = NDArray[np.float64]
MOST = 16  # kinds of workspaces that a model keeps
MOST_NUMBERS = 500_000  # of samples and tables; larger arrays are not kept
ONLY_WRITTEN = ("address", "c", "k", "log", "stiff", "times", *GROWING)
"""What is written before each run, or not read before the run has written it."""


class Workspace:
    """The arrays of one run, and their table for the core.

    `block` is the memory of all that a run changes, `first` what was there before.
    """

    def __init__(self, kind: Kind, arrays: Arrays) -> None:
        self.kind = kind
        self.arrays, self.block = _in_one_block(arrays)
        self.table, self.first = table_of(self.arrays), self.block.copy()
        self.address: int = self.table.__array_interface__["data"][0]

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


def acquire(problem: InitialValueProblem, records: Records) -> Workspace:
    """A workspace that fits a problem: one that is kept and free, or a new one."""
    moved = problem.moving.names
    kind = Kind(len(problem.times), records, len(problem.tables), problem.sensitivities, moved)
    try:
        space = _kept(problem.model)[kind].pop()  # at once, as another thread may want it too
    except (KeyError, IndexError):
        return Workspace(kind, new_arrays(problem.model, kind))
    space.renew()
    return space


def give_back(model: Model, space: Workspace) -> None:
    """Let the next run have a workspace; nobody may look into its arrays any more."""
    kept = _kept(model)
    size = space.arrays.progress.samples.size + space.arrays.sensitivity.samples.size
    if size + space.kind.tables > MOST_NUMBERS or has_grown(space.arrays):
        return
    if space.kind not in kept and len(kept) >= MOST:
        kept.clear()
    kept.setdefault(space.kind, []).append(space)


def release(model: Model) -> None:
    """Free the memory that runs of a model keep for the next one."""
    _kept(model).clear()


@once_per_model
def _kept(model: Model) -> dict[Kind, list[Workspace]]:
    return {}
