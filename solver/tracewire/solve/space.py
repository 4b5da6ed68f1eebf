"""The arrays of runs, kept with the model: to make them takes as long as a short run."""

from __future__ import annotations

from typing import cast

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.solve.core.arrays import Arrays, table_of

Vector = NDArray[np.float64]
Key = tuple[int, int, tuple[str, ...], tuple[str, ...]]
MOST = 16  # kinds of spaces that a model keeps
MOST_NUMBERS = 500_000  # of samples and tables; larger arrays are not kept
ONLY_WRITTEN = ("address", "log", "stiff", "times")
"""What a run does not read before it has written it."""


class Space:
    """The arrays of one run, and their table for the core.

    `key` says which runs they fit: the number of samples and the numbers in their tables, the
    sensitivities, and the parameters that move with these.
    """

    def __init__(self, key: Key, arrays: Arrays) -> None:
        self.key, self.arrays, self.table = key, arrays, table_of(arrays)
        groups = [group for group in arrays if group is not arrays.plan]
        fields = [item for group in groups for item in group._asdict().items()]
        self.first = [(a, a.copy()) for name, a in fields if a.size and name not in ONLY_WRITTEN]

    def renew(self) -> None:
        """Let the arrays be as they were before their run."""
        for array, first in self.first:
            array[...] = first


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
    if size + space.key[1] > MOST_NUMBERS:
        return
    if space.key not in kept and len(kept) >= MOST:
        kept.clear()
    kept.setdefault(space.key, []).append(space)


def _kept(model: Model) -> dict[Key, list[Space]]:
    return cast(dict[Key, list[Space]], model.kept.setdefault("spaces", {}))
